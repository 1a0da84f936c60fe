//! Where another sensor would add most.

use super::{Resolved, SensitivityBand, StandardDeviations};
use crate::c64;
use crate::for_each::{ForEach, map};
use frfit_linalg::column_block::product;
use frfit_linalg::dense::{NoConvergence, symmetric_eigen};

/// Frequencies at which candidates are compared at most, evenly drawn from the band: the few best are to be looked at over all of it.
const MAX_COMPARED_FREQUENCIES: usize = 128;

/// Candidates of one piece of work.
const CANDIDATES_PER_PIECE: usize = 256;

/// Eigenvalues of the information below this part of the largest are roundoff, each variable in units of its own information.
const EIGENVALUE_RTOL: f64 = 1e-12;

/// A variable with its error bar.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VariableStd {
    /// Its index.
    pub variable: usize,
    /// Standard deviation of its logarithm.
    pub std: f64,
}

/// How badly the worst variable is known.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WorstBar {
    /// How many variables have no error bar, because something of them is not seen at all.
    pub unseen: usize,
    /// Of the others the one with the largest error bar; `None` without others.
    pub worst: Option<VariableStd>,
}

impl WorstBar {
    /// Fewer without a bar first, then the smaller worst bar.
    pub fn total_cmp(&self, other: &Self) -> std::cmp::Ordering {
        let bar = |this: &Self| this.worst.map_or(0.0, |worst| worst.std);
        self.unseen.cmp(&other.unseen).then(bar(self).total_cmp(&bar(other)))
    }

    fn of(bars: &[Option<f64>]) -> Self {
        let known = bars
            .iter()
            .enumerate()
            .filter_map(|(variable, bar)| Some(VariableStd { variable, std: (*bar)? }));
        Self {
            unseen: bars.iter().filter(|bar| bar.is_none()).count(),
            worst: known.max_by(|a, b| a.std.total_cmp(&b.std)),
        }
    }
}

/// The worst error bar of all variables.
pub fn worst_bar(resolved: &Resolved) -> WorstBar {
    WorstBar::of(&resolved.bars())
}

/// A row where a sensor might be.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ranked {
    /// Row of the model, from 0.
    pub row: usize,
    /// The worst bar with a sensor there.
    pub after: WorstBar,
}

/// Candidate rows by the worst error bar that is left with one more sensor there, the best first.
///
/// A new sensor has, at each frequency, the median of the sensors' standard deviations relative to their responses, and not less noise than the quietest of them: a row that
/// hardly moves is no good place for proportional noise alone to say so. With V at the rows of candidates, x_i and ∂x_i/∂ln p = e_iᵀw_p need no solve.
///
/// # Limits
/// As good as the subspace is at rows that it was not trained for ([`crate::subspace::Changed::everywhere`]), and compared at some hundred frequencies: the best ones are to be
/// looked at again as sensors of a subspace of their own.
///
/// # Panics
/// Where a standard deviation is missing at a frequency with a response, or there is no such row.
pub fn next_sensors(
    band: &SensitivityBand<'_>,
    std: &StandardDeviations,
    candidates: &[usize],
    for_each: ForEach<'_>,
) -> Vec<Ranked> {
    let count = band.variables.len();
    let drawn = Drawn::of(band, std);
    let base = drawn.present(band, std);
    let chunks: Vec<&[usize]> = candidates.chunks(CANDIDATES_PER_PIECE).collect();
    let ranked = map(for_each, chunks.len(), |k| {
        let rows = chunks[k];
        let answers = product(&band.subspace.rows(rows), rows.len(), &drawn.coordinates);
        let one = |(i, &row): (usize, &usize)| {
            let at = |column: usize| answers[i + column * rows.len()];
            let mut information = base.clone();
            for (f, noise) in drawn.noise.iter().enumerate() {
                let complex = |k: usize| {
                    let column = 2 * (f * (count + 1) + k);
                    c64::new(at(column), at(column + 1))
                };
                let std = noise.at(complex(0));
                let slopes: Vec<c64> = (1..=count).map(complex).collect();
                add(&mut information, &slopes, drawn.step * 2.0 / (std * std));
            }
            Ranked { row, after: WorstBar::of(&bars(&information, count)) }
        };
        rows.iter().enumerate().map(one).collect::<Vec<_>>()
    });
    let mut ranked: Vec<Ranked> = ranked.into_iter().flatten().collect();
    ranked.sort_by(|a, b| a.after.total_cmp(&b.after));
    ranked
}

/// The worst error bar with each of a band's last sensors added, one at a time, to the first ones, for which there are standard deviations: the check of [`next_sensors`], by a subspace
/// that was trained for them, over all frequencies.
///
/// # Errors
/// [`NoConvergence`] where singular values are not found.
///
/// # Panics
/// Where the band has fewer sensors than `present`.
pub fn with_each_added(
    band: &SensitivityBand<'_>,
    std: &StandardDeviations,
    present: usize,
) -> Result<Vec<WorstBar>, NoConvergence> {
    let mut sensors: Vec<usize> = (0..present).collect();
    let all = band.at.iter().flatten().next().map_or(present, |changed| changed.response.len());
    let extended: StandardDeviations = band
        .at
        .iter()
        .zip(std)
        .map(|(at, std)| {
            let (Some(changed), Some(there)) = (at, std.get(..present)) else {
                // No standard deviation, no say.
                return vec![0.0; all];
            };
            let noise = Noise::of(there, &changed.response);
            let new =
                changed.response[present..].iter().map(|x| noise.as_ref().map_or(0.0, |noise| noise.at(*x)));
            there.iter().copied().chain(new).collect()
        })
        .collect();
    let mut bars = Vec::new();
    for m in present..all {
        sensors.push(m);
        bars.push(worst_bar(&band.resolved(&extended, &sensors)?));
        sensors.pop();
    }
    Ok(bars)
}

/// Noise of a sensor that is not there yet, at one frequency.
struct Noise {
    relative: f64,
    least: f64,
}

impl Noise {
    /// As of the sensors that are there; `None` where none of them has any.
    fn of(std: &[f64], response: &[c64]) -> Option<Self> {
        let usable = |(s, x): &(f64, f64)| *s > 0.0 && s.is_finite() && *x > 0.0;
        let sensors = std.iter().copied().zip(response.iter().map(|x| x.norm()));
        let sensors: Vec<(f64, f64)> = sensors.filter(usable).collect();
        let mut relative: Vec<f64> = sensors.iter().map(|(s, x)| s / x).collect();
        relative.sort_by(f64::total_cmp);
        let least = sensors.iter().map(|(s, _)| *s).fold(f64::INFINITY, f64::min);
        Some(Self { relative: *relative.get(relative.len() / 2)?, least })
    }

    fn at(&self, response: c64) -> f64 {
        (self.relative * response.norm()).max(self.least)
    }
}

/// Some of the band's frequencies.
struct Drawn {
    /// Which.
    frequencies: Vec<usize>,
    /// How many of the band each stands for.
    step: f64,
    noise: Vec<Noise>,
    /// Real and imaginary part of y and of each w_p, frequency after frequency, r rows.
    coordinates: Vec<f64>,
}

impl Drawn {
    fn of(band: &SensitivityBand<'_>, std: &StandardDeviations) -> Self {
        let there: Vec<usize> = (0..band.at.len()).filter(|&i| band.at[i].is_some()).collect();
        let drawn = there.len().min(MAX_COMPARED_FREQUENCIES);
        let pick = |k: usize| there[k * there.len() / drawn.max(1)];
        let mut this = Self {
            frequencies: Vec::new(),
            step: there.len() as f64 / drawn.max(1) as f64,
            noise: Vec::new(),
            coordinates: Vec::new(),
        };
        for i in (0..drawn).map(pick) {
            let Some(changed) = &band.at[i] else { continue };
            let Some(noise) = Noise::of(&std[i], &changed.response) else { continue };
            this.frequencies.push(i);
            this.noise.push(noise);
            for y in &changed.coordinates {
                this.coordinates.extend(y.iter().map(|y| y.re));
                this.coordinates.extend(y.iter().map(|y| y.im));
            }
        }
        this
    }

    /// Information of the sensors that are there, at the drawn frequencies.
    fn present(&self, band: &SensitivityBand<'_>, std: &StandardDeviations) -> Vec<f64> {
        let count = band.variables.len();
        let mut information = vec![0.0; count * count];
        for &i in &self.frequencies {
            let Some(changed) = &band.at[i] else { continue };
            for (m, std) in std[i].iter().enumerate() {
                let weight = self.step * 2.0 / (std * std);
                if weight.is_finite() {
                    let slopes: Vec<c64> = (0..count).map(|p| changed.slopes[p][m]).collect();
                    add(&mut information, &slopes, weight);
                }
            }
        }
        information
    }
}

/// N += weight · Re s sᴴ.
fn add(information: &mut [f64], slopes: &[c64], weight: f64) {
    for (row, a) in information.chunks_exact_mut(slopes.len().max(1)).zip(slopes) {
        for (sum, b) in row.iter_mut().zip(slopes) {
            *sum += weight * (a.re * b.re + a.im * b.im);
        }
    }
}

/// √(N⁻¹)_pp; `None` where something of a variable is not seen.
fn bars(information: &[f64], count: usize) -> Vec<Option<f64>> {
    let unit: Vec<f64> = (0..count).map(|p| information[p * (count + 1)].sqrt()).collect();
    let entry = |p: usize, q: usize| match unit[p] * unit[q] {
        0.0 => 0.0,
        both => information[p * count + q] / both,
    };
    let scaled: Vec<f64> = (0..count * count).map(|k| entry(k / count, k % count)).collect();
    let Ok((values, vectors)) = symmetric_eigen(count, &scaled) else { return vec![None; count] };
    let largest = values.last().copied().unwrap_or(0.0);
    let bar = |p: usize| {
        let mut variance = 0.0;
        for (value, v) in values.iter().zip(vectors.chunks_exact(count)) {
            // Vectors of what is not seen are good to the root of the roundoff of values.
            match *value > EIGENVALUE_RTOL * largest {
                true => variance += v[p] * v[p] / value,
                false if v[p].abs() < 1e-5 => {}
                false => return None,
            }
        }
        (unit[p] > 0.0).then(|| variance.sqrt() / unit[p])
    };
    (0..count).map(bar).collect()
}
