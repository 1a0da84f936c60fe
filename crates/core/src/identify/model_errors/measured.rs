//! What was measured over a band, and what it says by itself.

use super::curve::Curves;
use super::mesh::Coarser;
use super::whitening::{Deviations, Rest, Whitening};
use crate::c64;
use crate::frfs::Noise;
use crate::identify::goodness_of_fit::{GoodnessOfFit, MIN_DOUBTFUL_MISFIT};
use crate::identify::local_fit::of_responses;
use crate::identify::options::ErrorSizes;
use crate::identify::outcome::Line;
use crate::median::median;
use crate::subspace::Point;

/// The model at a line with these values of its unknowns.
pub(in crate::identify) type PointAt<'t, 'a> = &'t (dyn Fn(usize, &[c64]) -> Option<Point<'a>> + Sync);

/// What is known of the noise.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::identify) enum NoiseScale {
    /// σ is that of the noise.
    Known,
    /// σ is what the noise is in proportion to.
    Relative,
}

impl NoiseScale {
    pub(in crate::identify) fn of(noise: Noise<'_>) -> Self {
        if noise.is_known() { Self::Known } else { Self::Relative }
    }
}

/// What was measured, and where to begin.
pub(in crate::identify) struct Measured<'t, 'a> {
    pub(in crate::identify) point: PointAt<'t, 'a>,
    pub(in crate::identify) omegas: &'t [f64],
    /// `[frequency][unknown]`.
    pub(in crate::identify) nominal: &'t [Vec<c64>],
    /// θ of what holds for the band: as a right model has it, then where else to begin.
    pub(in crate::identify) given: &'t [Vec<f64>],
    pub(in crate::identify) measured: &'t [Vec<c64>],
    /// Of real and imaginary part each, `[frequency][sensor]`; infinite of a sensor that is left out.
    pub(in crate::identify) sigma: &'t [Vec<f64>],
    /// The responses themselves, as standard deviations.
    pub(in crate::identify) size: &'t [Vec<f64>],
    /// The levels of the responses, of which a rest beside the noise is a part.
    pub(in crate::identify) levels: &'t [Vec<f64>],
    pub(in crate::identify) noise_scale: NoiseScale,
    /// What the user says of the sizes of errors.
    pub(in crate::identify) given_sizes: ErrorSizes,
    /// A coarser mesh, which says what the mesh has of them.
    pub(in crate::identify) coarser: Option<Coarser<'t>>,
    /// The value of each frequency alone, and the noise over σ that follows from it.
    pub(in crate::identify) free: &'t [Line],
    /// The unknowns that have a value of their own at each frequency.
    pub(in crate::identify) own: &'t [usize],
    pub(in crate::identify) level_per_frequency: Option<f64>,
    /// What the values of the lines say of the band.
    pub(in crate::identify) fit: Option<GoodnessOfFit>,
    /// Whether the model may have errors at all.
    pub(in crate::identify) may_be_wrong: bool,
    /// Whether the curves are the answer, of a right model too.
    pub(in crate::identify) wants_curves: bool,
}

/// Noise over response that is usual, where the responses themselves do not show it.
pub(super) const USUAL_NOISE: f64 = 0.01;

/// The residual is noise up to this multiple of the noise that the responses alone show.
const MAX_NOISE_RATIO: f64 = 1.1;

/// No measured response is better than this part of itself: what is smaller is no reason to doubt a model.
pub(super) const MIN_NOISE_OVER_RESPONSE: f64 = 5e-4;

/// What roundoff leaves of a response at most: no error of a model is as small.
const MAX_ROUNDOFF_OVER_RESPONSE: f64 = 1e-5;

/// Beside a given noise and the errors of modes, shapes and factors a response may be off by this part of itself: no model is
/// better between resonances. What is more is not explained.
pub(super) const MAX_REST: f64 = 0.05;

/// The residual is noise up to this number of standard deviations of χ².
pub(super) const NOISE_CHI_SQUARED_STD: f64 = 3.0;

/// Starts no farther apart than this, in logarithms, are one.
pub(super) const SAME_START: f64 = 0.01;

impl<'a> Measured<'_, 'a> {
    /// The model at a line of some curves.
    pub(super) fn on(&self, curves: &Curves, theta: &[f64], line: usize) -> Option<Point<'a>> {
        let (values, _) = curves.values(theta, line, self.omegas[line])?;
        (self.point)(line, &values)
    }

    /// Real numbers that were measured.
    pub(super) fn numbers(&self, lines: &[usize]) -> usize {
        2 * lines.iter().flat_map(|&i| &self.sigma[i]).filter(|sigma| sigma.is_finite()).count()
    }

    /// The values of an unknown at the frequencies that have an answer of their own, with weights (inverse variances of ln p).
    fn answered(&self, unknown: usize) -> Vec<(usize, c64, f64)> {
        let one = |(i, line): (usize, &Line)| {
            let own = &line.values[unknown];
            let value = own.value.filter(|value| line.on_path && value.re > 0.0)?;
            let std = own.uncertainty.map_or(1.0, |bars| bars.correction_std / value.norm());
            Some((i, value, 1.0 / (std * std + 1e-4)))
        };
        self.free.iter().enumerate().filter_map(one).collect()
    }

    /// θ with these coordinates of constants, laws and channels, and smooth curves through the values of each frequency alone.
    pub(in crate::identify) fn through_answers(&self, curves: &Curves, given: &[f64]) -> Option<Vec<f64>> {
        curves.through(given, |unknown| self.answered(unknown))
    }

    /// θ to begin with: through the values of each frequency alone, and the nominal.
    pub(in crate::identify) fn starts(&self, curves: &Curves) -> Vec<Vec<f64>> {
        // Where modes are narrow most lines are right and some are far off.
        type Values = Vec<(usize, c64, f64)>;
        let usual: &dyn Fn(usize) -> Values = &|j| {
            let all = self.answered(j);
            let middle = |part: &dyn Fn(c64) -> f64| median(all.iter().map(|one| part(one.1.ln())).collect());
            let value = middle(&|log| log.re).zip(middle(&|log| log.im));
            let value = value.map(|(size, phase)| c64::new(size, phase).exp());
            value.map_or(Vec::new(), |value| all.iter().map(|one| (one.0, value, 1e4)).collect())
        };
        let nominal: &dyn Fn(usize) -> Values = &|j| {
            let positive = (0..self.omegas.len()).filter(|&i| self.nominal[i][j].re > 0.0);
            positive.map(|i| (i, self.nominal[i][j], 1e4)).collect()
        };
        let smooth = curves.smooth();
        let few = smooth.iter().any(|&j| self.answered(j).len() <= 2);
        let mut starts: Vec<Vec<f64>> = Vec::new();
        let mut add = |start: Option<Vec<f64>>| {
            let is_new = |start: &Vec<f64>| starts.iter().all(|other| distance(start, other) > SAME_START);
            let start = start.filter(is_new);
            starts.extend(start);
        };
        let Some((right, others)) = self.given.split_first() else { return starts };
        if !few {
            add(self.through_answers(curves, right));
            add(curves.through(right, usual));
        }
        add(curves.through(right, nominal));
        for given in others {
            add(curves.through(given, if few { nominal } else { usual }));
        }
        starts.iter_mut().for_each(|start| curves.keep_within_bounds(start));
        starts
    }

    pub(super) fn known(&self) -> bool {
        self.noise_scale == NoiseScale::Known
    }

    /// Whether several sensors agree at each frequency to roundoff: the model is right then, whatever the modulus does.
    pub(super) fn is_exact(&self) -> bool {
        let level = self.level_per_frequency.filter(|_| !self.known() && self.counted_sensors().count() > 1);
        level.is_some_and(|level| level <= MAX_ROUNDOFF_OVER_RESPONSE)
    }

    /// Sensors that are not left out.
    pub(super) fn counted_sensors(&self) -> impl Iterator<Item = usize> {
        (0..self.sigma[0].len()).filter(|&m| self.sigma[0][m].is_finite())
    }

    /// The most that noise leaves where it is not given: a little more than the responses alone show.
    pub(super) fn usual_noise(&self) -> f64 {
        let of_responses =
            if self.known() { None } else { of_responses((self.omegas, self.measured), self.sigma) };
        of_responses.map_or(USUAL_NOISE, |noise| (MAX_NOISE_RATIO * noise).max(MIN_DOUBTFUL_MISFIT))
    }

    /// σ of the noise at a level, with some part of the response added.
    pub(super) fn sigma_at(&self, lines: &[usize], level: f64, added: f64) -> Vec<Vec<f64>> {
        let one = |&i: &usize| {
            let each = self.sigma[i].iter().zip(&self.size[i]);
            each.map(|(sigma, size)| (level * sigma).hypot(added.max(MIN_NOISE_OVER_RESPONSE) * size))
                .collect()
        };
        lines.iter().map(one).collect()
    }

    /// Noise at a level, with some part of the response added.
    pub(super) fn noise_at(&self, lines: &[usize], level: f64, added: f64) -> Whitening {
        Whitening::of_noise(self.sigma_at(lines, level, added))
    }

    /// Noise at a level, with what the response has beside it.
    pub(super) fn noise_and_rest(&self, lines: &[usize], level: f64, rest: Rest) -> Whitening {
        self.deviations(lines, level).whitening(rest)
    }

    fn deviations(&self, lines: &[usize], level: f64) -> Deviations {
        Deviations {
            omegas: lines.iter().map(|&i| self.omegas[i]).collect(),
            noise: self.sigma_at(lines, level, 0.0),
            levels: lines.iter().map(|&i| self.levels[i].clone()).collect(),
        }
    }

    /// What the response has beside a given noise: none where noise leaves these residuals of n numbers by chance.
    pub(super) fn rest(&self, lines: &[usize], residuals: &[Vec<c64>], n: f64) -> Rest {
        let deviations = self.deviations(lines, 1.0);
        let is_noise = is_chance(deviations.whitening(Rest::NONE).chi_squared(residuals), n);
        if is_noise { Rest::NONE } else { deviations.likeliest_rest(residuals, n) }
    }
}

/// Whether noise leaves this χ² of n numbers.
pub(super) fn is_chance(chi_squared: f64, n: f64) -> bool {
    chi_squared <= n + NOISE_CHI_SQUARED_STD * (2.0 * n).sqrt()
}

pub(super) fn distance(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}
