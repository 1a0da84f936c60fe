//! Natural frequencies, damping and shapes that measured responses show.

use super::left_over::resonances_left;
use super::rational_fit::{Fit, Fitted, Measured, PoleCovariance};
use super::stabilisation::{MAX_DAMPING_RATIO, ORDER_STEP, PoleAtOrder, stabilisation};
use crate::c64;
use crate::for_each::ForEach;
use crate::frequency::{damping_ratio, natural_frequency_hz, omega_rad_s};
use crate::frfs::{Frfs, standard_deviations};
use crate::with_fields::with_fields;
use frfit_linalg::dense::NoConvergence;

/// How poles are searched.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct PoleOptions {
    /// The largest order of the stabilisation diagram. Default 60: some three for each mode.
    pub max_order: usize,
    /// The decay α of a window on the records, 1/s. Default 0.
    pub decay_per_s: f64,
}

impl Default for PoleOptions {
    fn default() -> Self {
        Self { max_order: 60, decay_per_s: 0.0 }
    }
}

with_fields!(PoleOptions { with_max_order: max_order as usize, with_decay_per_s: decay_per_s as f64 });

/// A mode of a measured structure.
#[derive(Debug, Clone, PartialEq)]
pub struct MeasuredMode {
    /// s, 1/s.
    pub pole_per_s: c64,
    /// Standard deviation of |s|/2π, Hz.
    pub frequency_std_hz: Option<f64>,
    /// Standard deviation of −Re s/|s|.
    pub damping_ratio_std: Option<f64>,
    /// R_m of each sensor: H_m has R_m/(iω − s) and its conjugate.
    pub residues: Vec<c64>,
}

impl MeasuredMode {
    /// The natural frequency |s|/2π.
    pub fn frequency_hz(&self) -> f64 {
        natural_frequency_hz(self.pole_per_s)
    }

    /// The damping ratio −Re s/|s|; half of a loss factor.
    pub fn damping_ratio(&self) -> f64 {
        damping_ratio(self.pole_per_s)
    }
}

/// What measured responses show.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct MeasuredModes {
    /// Modes in the band, lowest first.
    pub modes: Vec<MeasuredMode>,
    /// All poles at all orders.
    pub diagram: Vec<PoleAtOrder>,
    /// What the modes leave over the assumed deviations, for real and imaginary part each; `None` where there are no more numbers than unknowns.
    pub level: Option<f64>,
    /// The lines that were fitted.
    pub frequency_hz: Vec<f64>,
    /// What is fitted there, `[sensor][frequency]`; empty where there is no mode.
    pub fitted: Vec<Vec<c64>>,
}

/// Lines that are fitted at most: of more, evenly spaced ones.
const MAX_LINES: usize = 8000;

/// A pole at one order and that of the next are one within this part of its distance from the axis, or this part of its frequency.
const SAME_POLE_HALF_WIDTHS: f64 = 0.5;
const SAME_POLE_RTOL: f64 = 1e-5;

/// Poles nearer to each other than this part of a half-width are one mode found twice.
const TWIN_HALF_WIDTHS: f64 = 0.1;

/// Orders, one after the other but for one that may fail, at which a pole is there to be tried, and to be tried first.
const MIN_ORDERS: usize = 3;
const MANY_ORDERS: usize = 6;

/// Orders of the polynomials beside the poles that are tried, one after the other until they gain nothing.
const DEGREES: [usize; 7] = [1, 2, 4, 6, 10, 16, 24];

/// A level below this is roundoff of the responses: poles and polynomials that would be needed for it do not belong to a structure.
const MIN_LEVEL: f64 = 1e-7;

/// Rounds of leaving out what gains nothing, and of adding what is missing.
const MAX_ROUNDS: usize = 60;

/// The modes of measured responses, from all sensors together. Lines at 0 Hz must not be among them.
///
/// Poles that a stabilisation diagram shows at several orders are fitted to all lines at once, and so are poles where the residual has a resonance.
/// Those that gain less than their number of unknowns bears (BIC) are left out.
///
/// # Errors
/// [`NoConvergence`] where a response is not finite.
///
/// # Limits
/// Of modes nearer to each other than a tenth of their half-width one may be found. A mode with a node at all sensors is not there. Modes in the outermost
/// half-widths of the band are uncertain, as half of their resonance is missing.
pub fn measured_modes(
    frfs: Frfs<'_>,
    options: &PoleOptions,
    for_each: ForEach<'_>,
) -> Result<MeasuredModes, NoConvergence> {
    let mut weights = standard_deviations(frfs.frequency_hz, frfs.receptance, frfs.noise);
    weights.iter_mut().flatten().for_each(|std| *std = std.recip());
    let count = frfs.frequency_hz.len();
    let used: Vec<usize> = (0..count).step_by(count.div_ceil(MAX_LINES).max(1)).collect();
    let frequency_hz: Vec<f64> = used.iter().map(|&k| frfs.frequency_hz[k]).collect();
    let responses: Vec<Vec<c64>> = used.iter().map(|&k| frfs.receptance[k].clone()).collect();
    let weights: Vec<Vec<f64>> = used.iter().map(|&k| weights[k].clone()).collect();
    let measured = Measured {
        frequency_hz: &frequency_hz,
        responses: &responses,
        weights: &weights,
        decay_per_s: options.decay_per_s,
        hann_record_s: None,
    };
    let diagram = stabilisation(&measured, options.max_order, for_each)?;
    let noise_known = frfs.noise.is_known();
    let search = PoleSearch { measured, noise_known, for_each };
    let candidates = candidates(&diagram);
    let found = search.selected(&candidates);
    let Some((fit, fitted)) = found.filter(|(fit, _)| !fit.poles.is_empty()) else {
        return Ok(MeasuredModes { diagram, ..MeasuredModes::default() });
    };
    let level = search.level(&fit, &fitted);
    let noise = level.map(|level| if noise_known { level.max(1.0) } else { level });
    let covariance = search.measured.covariance(&fit, for_each);
    let mode = |r: usize| {
        let pole_per_s = fit.poles[r];
        let bars =
            covariance.as_ref().zip(noise).map(|(each, noise)| deviations(pole_per_s, &each[r], noise));
        MeasuredMode {
            pole_per_s,
            frequency_std_hz: bars.map(|bars| bars[0]),
            damping_ratio_std: bars.map(|bars| bars[1]),
            residues: fitted.residues[r].clone(),
        }
    };
    let mut modes: Vec<MeasuredMode> = (0..fit.poles.len()).map(mode).collect();
    modes.sort_by(|a, b| a.pole_per_s.norm().total_cmp(&b.pole_per_s.norm()));
    Ok(MeasuredModes { modes, diagram, level, frequency_hz, fitted: fitted.responses })
}

/// Standard deviations of |s|/2π and −Re s/|s|.
fn deviations(s: c64, [rr, ri, ii]: &PoleCovariance, level: f64) -> [f64; 2] {
    let size = s.norm();
    let along = |[a, b]: [f64; 2]| (a * a * rr + 2.0 * a * b * ri + b * b * ii).max(0.0).sqrt() * level;
    let frequency = [s.re / size, s.im / size].map(|slope| slope / omega_rad_s(1.0));
    let damping = [-s.im * s.im / size.powi(3), s.re * s.im / size.powi(3)];
    [along(frequency), along(damping)]
}

/// A pole that several orders have.
struct Chain {
    last: PoleAtOrder,
    orders: usize,
}

/// Poles of the diagram that are there at several orders: those of many orders, then those of few.
pub(super) fn candidates(diagram: &[PoleAtOrder]) -> [Vec<c64>; 2] {
    let mut chains: Vec<Chain> = Vec::new();
    for &pole in diagram {
        let distance = |chain: &Chain| {
            let last = chain.last.pole_per_s;
            let most = SAME_POLE_HALF_WIDTHS * last.re.abs() + SAME_POLE_RTOL * last.norm();
            let is_next = chain.last.order < pole.order && pole.order <= chain.last.order + 2 * ORDER_STEP;
            Some((last - pole.pole_per_s).norm() / most).filter(|ratio| is_next && *ratio <= 1.0)
        };
        let near = chains.iter_mut().filter_map(|chain| Some((distance(chain)?, chain)));
        match near.min_by(|a, b| a.0.total_cmp(&b.0)) {
            Some((_, chain)) => *chain = Chain { last: pole, orders: chain.orders + 1 },
            None => chains.push(Chain { last: pole, orders: 1 }),
        }
    }
    chains.sort_by_key(|chain| std::cmp::Reverse(chain.orders));
    let mut found = [Vec::new(), Vec::new()];
    for chain in chains.iter().filter(|chain| chain.orders >= MIN_ORDERS) {
        let pole = chain.last.pole_per_s;
        if found.iter().flatten().all(|other| !is_same(pole, *other)) {
            found[usize::from(chain.orders < MANY_ORDERS)].push(pole);
        }
    }
    found
}

/// Whether two poles stand for one mode.
fn is_same(a: c64, b: c64) -> bool {
    (a - b).norm() < TWIN_HALF_WIDTHS * a.re.abs().max(b.re.abs())
}

/// Which poles there are.
pub(super) struct PoleSearch<'a> {
    pub(super) measured: Measured<'a>,
    pub(super) noise_known: bool,
    pub(super) for_each: ForEach<'a>,
}

impl PoleSearch<'_> {
    /// The residual over the assumed deviations.
    fn level(&self, fit: &Fit, fitted: &Fitted) -> Option<f64> {
        let freedom =
            self.measured.numbers().checked_sub(self.measured.unknowns(fit)).filter(|&free| free > 0)?;
        Some((fitted.misfit / freedom as f64).sqrt())
    }

    /// By how much the misfit must be smaller with a pole (BIC).
    fn price(&self, fit: &Fit, fitted: &Fitted) -> Option<f64> {
        let noise = self.level(fit, fitted)?.max(if self.noise_known { 1.0 } else { MIN_LEVEL });
        let own = (2 + 2 * self.measured.sensors()) as f64;
        Some(own * (self.measured.numbers() as f64).ln() * noise * noise)
    }

    /// −2 ln of the likelihood, and what the unknowns cost (BIC).
    pub(super) fn information(&self, fit: &Fit, fitted: &Fitted) -> f64 {
        let numbers = self.measured.numbers() as f64;
        let floor = numbers * MIN_LEVEL * MIN_LEVEL;
        // The level is free also where the noise is known: between resonances no rational function of few poles is as good as a coherence.
        let likelihood = numbers * (fitted.misfit.max(floor) / numbers).ln();
        likelihood + self.measured.unknowns(fit) as f64 * numbers.ln()
    }

    /// The fit of the poles that are there.
    pub(super) fn selected(&self, [often, seldom]: &[Vec<c64>; 2]) -> Option<(Fit, Fitted)> {
        let first = self.with_degree(often)?;
        let mut best = self.pruned(first)?;
        // A weak mode next to a strong one shows once that one is fitted.
        let new = |pole: &&c64| best.0.poles.iter().all(|other| !is_same(**pole, *other));
        let added: Vec<c64> = seldom.iter().filter(new).copied().collect();
        best = self.with_more(&best, &added).unwrap_or(best);
        for _ in 0..MAX_ROUNDS {
            let Some(price) = self.price(&best.0, &best.1) else { break };
            let missing = resonances_left(&self.measured, &best.0, &best.1, price);
            let Some(more) = self.with_more(&best, &missing) else { break };
            best = more;
        }
        // Poles that are right need other polynomials than those that were not yet.
        let again = self.with_degree(&best.0.poles).and_then(|fit| self.pruned(fit));
        Some(again.filter(|again| self.is_better(again, &best)).unwrap_or(best))
    }

    /// The fit with these poles added; `None` without poles to add, or if the fit is no better.
    fn with_more(&self, best: &(Fit, Fitted), poles: &[c64]) -> Option<(Fit, Fitted)> {
        if poles.is_empty() {
            return None;
        }
        let more = Fit { poles: [&best.0.poles[..], poles].concat(), ..best.0.clone() };
        self.pruned(more).filter(|more| self.is_better(more, best))
    }

    fn is_better(&self, new: &(Fit, Fitted), old: &(Fit, Fitted)) -> bool {
        self.information(&new.0, &new.1) < self.information(&old.0, &old.1)
    }

    /// These poles with polynomials of the order that the responses bear.
    fn with_degree(&self, poles: &[c64]) -> Option<Fit> {
        let mut best: Option<(f64, Fit)> = None;
        for degree in DEGREES {
            let fit = Fit { poles: poles.to_vec(), degree };
            if self.measured.unknowns(&fit) >= self.measured.numbers() / 2 {
                break;
            }
            let Some(fitted) = self.measured.fitted(&fit, self.for_each) else { continue };
            let information = self.information(&fit, &fitted);
            if best.as_ref().is_some_and(|(least, _)| information >= *least) {
                break;
            }
            best = Some((information, fit));
        }
        best.map(|(_, fit)| fit)
    }

    /// Refined, and without those that gain nothing.
    fn pruned(&self, mut fit: Fit) -> Option<(Fit, Fitted)> {
        for _ in 0..MAX_ROUNDS {
            // Where the search fails a pole is going where none is: the weakest is left out all the same.
            let refined = self.measured.refined(&fit, self.for_each);
            let failed = refined.is_none();
            fit = refined.unwrap_or(fit);
            let fitted = self.measured.fitted(&fit, self.for_each)?;
            let Some(price) = self.price(&fit, &fitted) else {
                fit.poles.pop()?;
                continue;
            };
            let stays = |r: usize| {
                let pole = fit.poles[r];
                let is_mode = self.measured.is_in_band(pole) && damping_ratio(pole) < MAX_DAMPING_RATIO;
                let twin = fit.poles[..r].iter().any(|other| is_same(pole, *other));
                if is_mode && !twin { fitted.gains[r] / price } else { 0.0 }
            };
            let weakest = (0..fit.poles.len()).map(|r| (stays(r), r)).min_by(|a, b| a.0.total_cmp(&b.0));
            match weakest {
                Some((gain, r)) if gain < 1.0 || failed => drop(fit.poles.remove(r)),
                _ => return Some((fit, fitted)),
            }
        }
        None
    }
}
