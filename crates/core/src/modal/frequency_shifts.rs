//! Natural frequencies that differ from sensor to sensor: those of a mass that moves with the sensor, or of a structure that warms up between measurements.
//!
//! A linear structure has one set of poles for all sensors. Here each sensor m has its own,
//! $$ s_{mr} = s_r + i\,|s_r|\,\delta_{mr} , \qquad \delta_{mr} \sim N(0, S^2) . $$
//! Residues and smooth terms are free. With them eliminated, h is what is left of a sensor's weighted responses and Z what is left of their slopes by δ, and
//! $$ -2 \ln L(S) = \sum_m \ln\det(I + \kappa^2 Z_m^T Z_m) + f \ln \sum_m h_m^T (I + \kappa^2 Z_m Z_m^T)^{-1} h_m , \qquad \kappa = S/\text{level} , $$
//! the likelihood of a mixed model with f degrees of freedom and the noise level free.
//!
//! # Source
//! D. A. Harville, J. Am. Stat. Assoc. 72 (1977) 320–338 (restricted likelihood).

use super::pieces::{Shown, UNDECIDED_PIECES, pieces};
use super::rational_fit::{Fit, Measured};
use crate::c64;
use crate::for_each::{ForEach, map};
use crate::frequency::laplace_per_s;
use crate::frfs::Frfs;
use frfit_linalg::dense::{NoConvergence, symmetric_eigen};
use frfit_linalg::vector::transpose_dot;

/// Differences of natural frequencies between sensors.
#[derive(Debug, Clone, PartialEq)]
pub struct FrequencyShifts {
    /// By how many nats the responses are likelier with them than without.
    pub nats: f64,
    /// S, relative: the largest of the pieces of the band.
    pub relative_std: f64,
    /// What the responses have more than with the natural frequencies that all sensors have in common, `[frequency][sensor]`.
    pub values: Vec<Vec<c64>>,
}

/// Values of S that are tried: from the first on, each larger than the one before by this factor, up to one per cent.
const FIRST_STD: f64 = 1e-6;
const STD_STEP: f64 = 1.6;
const STDS: i32 = 20;

/// Rounds of the search: the shifts of one are the expansion point of the next. They may be half of a half-width.
const ROUNDS: usize = 5;

/// Poles nearer to each other than this part of their frequency may be one mode that sensors have at different frequencies.
const ONE_MODE_RTOL: f64 = 0.012;

/// Degrees of freedom that are needed.
const MIN_FREEDOM: usize = 10;

/// How natural frequencies differ from sensor to sensor; nothing of a single sensor, or where the responses show no resonance.
///
/// # Errors
/// [`NoConvergence`] where a response is not finite.
///
/// # Limits
/// Damping that differs is not found. Two modes side by side that are taken for one look like shifts too.
pub fn frequency_shifts(
    frfs: Frfs<'_>,
    decay_per_s: f64,
    for_each: ForEach<'_>,
) -> Result<FrequencyShifts, NoConvergence> {
    let (shown, all) = (Shown::of_some(frfs, decay_per_s), Shown::of_all(frfs, decay_per_s));
    let sensors = all.sensors();
    let values = vec![vec![c64::default(); sensors]; frfs.frequency_hz.len()];
    let mut found = FrequencyShifts { nats: 0.0, relative_std: 0.0, values };
    if sensors < 2 {
        return Ok(found);
    }
    for (k, piece) in pieces(frfs.frequency_hz).into_iter().enumerate() {
        if k >= UNDECIDED_PIECES && found.nats == 0.0 {
            break;
        }
        let Some(plain) = shown.resonances(&piece.lines, for_each)? else { continue };
        let merged = Fit { poles: merged(&plain.fit.poles), ..plain.fit.clone() };
        let fits = [plain.fit, merged];
        let best_of = |some: &Shown<'_>| Shifted::best(&some.measured(&piece.lines, None), &fits, for_each);
        // Some sensors show whether it is worth to ask all.
        let best = match best_of(&shown) {
            Some(_) if shown.sensors() < sensors => best_of(&all),
            best => best,
        };
        let Some((nats, best)) = best else { continue };
        found.nats += nats;
        found.relative_std = found.relative_std.max(best.std);
        for i in piece.own {
            let s = laplace_per_s(frfs.frequency_hz[i], decay_per_s);
            found.values[i] = (0..sensors).map(|m| best.value(m, s)).collect();
        }
    }
    Ok(found)
}

/// One pole in place of several that are near to each other, with the least damping: that of several peaks side by side is too large.
fn merged(poles: &[c64]) -> Vec<c64> {
    let mut sorted = poles.to_vec();
    sorted.sort_by(|a, b| a.im.total_cmp(&b.im));
    let near = |a: &c64, b: &c64| b.im - a.im < ONE_MODE_RTOL * b.im;
    let one = |group: &[c64]| {
        let mean = group.iter().map(|pole| pole.im).sum::<f64>() / group.len() as f64;
        c64::new(group.iter().map(|pole| pole.re).fold(f64::NEG_INFINITY, f64::max), mean)
    };
    sorted.chunk_by(near).map(one).collect()
}

/// Poles with a shift at each sensor.
struct Shifted {
    fit: Fit,
    /// δ, `[sensor][mode]`.
    shifts: Vec<Vec<f64>>,
    /// `[sensor][mode]`.
    residues: Vec<Vec<c64>>,
    std: f64,
    /// −2 ln of the likelihood, and what poles and linear terms cost (BIC); and the same without shifts.
    information: f64,
    without: f64,
}

impl Shifted {
    /// The likeliest poles and shifts, and by how many nats they are likelier than none; `None` where none are.
    fn best(measured: &Measured<'_>, fits: &[Fit; 2], for_each: ForEach<'_>) -> Option<(f64, Self)> {
        let each = fits.iter().filter_map(|fit| Self::new(measured, fit.clone(), for_each));
        let each: Vec<Self> = each.collect();
        // Two modes side by side are no shifts: what has none may have as many poles as it needs.
        let without = each.iter().map(|shifted| shifted.without).fold(f64::INFINITY, f64::min);
        let best = each.into_iter().min_by(|a, b| a.information.total_cmp(&b.information))?;
        let nats = 0.5 * (without - best.information);
        (nats > 0.0).then_some((nats, best))
    }

    /// The shifts of largest likelihood; `None` where there are too few numbers.
    fn new(measured: &Measured<'_>, fit: Fit, for_each: ForEach<'_>) -> Option<Self> {
        let (sensors, numbers) = (measured.sensors(), measured.numbers());
        let freedom = numbers.checked_sub(measured.unknowns(&fit)).filter(|&free| free >= MIN_FREEDOM)?;
        let mut found = Self {
            shifts: vec![vec![0.0; fit.poles.len()]; sensors],
            residues: Vec::new(),
            std: 0.0,
            information: f64::INFINITY,
            without: f64::INFINITY,
            fit,
        };
        for round in 0..ROUNDS {
            let of_sensor = |m: usize| {
                let slopes = measured.shift_slopes(m, &found.at(m), &found.shifts[m])?;
                Some((Left::new(&slopes.0)?, slopes.1))
            };
            let each = map(for_each, sensors, of_sensor).into_iter().collect::<Option<Vec<_>>>()?;
            let likelihood = |kappa: f64, freedom: f64| -> f64 {
                let log_det: f64 = each.iter().map(|(left, _)| left.log_det(kappa)).sum();
                let misfit: f64 = each.iter().map(|(left, _)| left.misfit(kappa)).sum();
                log_det + freedom * misfit.ln()
            };
            let rest: f64 = each.iter().map(|(left, _)| left.rest).sum();
            let level = (rest / freedom as f64).sqrt();
            let kappas = (0..STDS).map(|k| FIRST_STD * STD_STEP.powi(k) / level);
            let likely = |kappa: f64| (kappa, likelihood(kappa, freedom as f64));
            let (kappa, _) = kappas.map(likely).min_by(|a, b| a.1.total_cmp(&b.1))?;
            let price = (numbers - freedom) as f64 * (numbers as f64).ln();
            if round == 0 {
                found.without = likelihood(0.0, numbers as f64) + price;
            }
            found.std = kappa * level;
            found.information = likelihood(kappa, numbers as f64) + price;
            found.shifts = each.iter().map(|(left, _)| left.shifts(kappa)).collect();
            found.residues = each.into_iter().map(|(_, residues)| residues).collect();
            if found.information >= found.without || round + 1 == ROUNDS {
                break;
            }
            // The poles that sensors have in common are those of responses without the shifts.
            let without = found.without_shifts(measured);
            let common = Measured { responses: &without, ..*measured };
            found.fit = common.refined(&found.fit, for_each).unwrap_or(found.fit);
        }
        Some(found)
    }

    /// The poles of a sensor.
    fn at(&self, m: usize) -> Fit {
        let poles = self.fit.poles.iter().zip(&self.shifts[m]);
        Fit { poles: poles.map(|(pole, shift)| shifted(*pole, *shift)).collect(), ..self.fit }
    }

    /// The responses without the shifts.
    fn without_shifts(&self, measured: &Measured<'_>) -> Vec<Vec<c64>> {
        let of_line = |(f, row): (&f64, &Vec<c64>)| {
            let s = laplace_per_s(*f, measured.decay_per_s);
            row.iter().enumerate().map(|(m, response)| response - self.value(m, s)).collect()
        };
        measured.frequency_hz.iter().zip(measured.responses).map(of_line).collect()
    }

    /// What a sensor has more at s than without its shifts.
    fn value(&self, m: usize, s: c64) -> c64 {
        let of = |pole: c64, residue: c64| residue / (s - pole) + residue.conj() / (s - pole.conj());
        let modes = self.fit.poles.iter().zip(&self.shifts[m]).zip(&self.residues[m]);
        modes.map(|((&pole, &shift), &residue)| of(shifted(pole, shift), residue) - of(pole, residue)).sum()
    }
}

/// s_r + i|s_r|δ.
fn shifted(pole: c64, shift: f64) -> c64 {
    pole + pole.norm() * shift * c64::I
}

/// Z and h of a sensor on the principal axes of ZᵀZ.
struct Left {
    /// Eigenvalues λ of ZᵀZ, and vᵀZᵀh.
    axes: Vec<(f64, f64)>,
    /// Their vectors v, one after the other.
    vectors: Vec<f64>,
    /// hᵀh, and what of it is outside of Z.
    length: f64,
    rest: f64,
}

impl Left {
    /// Of the columns of Z, and h last.
    fn new(columns: &[Vec<f64>]) -> Option<Self> {
        let (h, z) = columns.split_last()?;
        let products: Vec<f64> = z.iter().flat_map(|a| z.iter().map(|b| transpose_dot(a, b))).collect();
        let (values, vectors) = symmetric_eigen(z.len(), &products).ok()?;
        let overlap: Vec<f64> = z.iter().map(|column| transpose_dot(column, h)).collect();
        let along = |v: &[f64]| transpose_dot(v, &overlap);
        let axes: Vec<(f64, f64)> = values
            .iter()
            .map(|value| value.max(0.0))
            .zip(vectors.chunks(z.len().max(1)).map(along))
            .collect();
        let rest = h.get(z.len()..)?.iter().map(|x| x * x).sum();
        Some(Self { axes, vectors, length: transpose_dot(h, h), rest })
    }

    fn log_det(&self, kappa: f64) -> f64 {
        self.axes.iter().map(|(value, _)| (kappa * kappa * value).ln_1p()).sum()
    }

    fn misfit(&self, kappa: f64) -> f64 {
        let explained = |(value, along): &(f64, f64)| (kappa * along).powi(2) / (1.0 + kappa * kappa * value);
        self.length - self.axes.iter().map(explained).sum::<f64>()
    }

    fn shifts(&self, kappa: f64) -> Vec<f64> {
        let n = self.axes.len();
        let mut shifts = vec![0.0; n];
        for ((value, along), vector) in self.axes.iter().zip(self.vectors.chunks(n.max(1))) {
            let size = kappa * kappa * along / (1.0 + kappa * kappa * value);
            shifts.iter_mut().zip(vector).for_each(|(shift, v)| *shift += size * v);
        }
        shifts
    }
}
