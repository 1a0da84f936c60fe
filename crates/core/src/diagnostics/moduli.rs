//! The values of all unknowns over a band, by few numbers.

use crate::c64;
use crate::identify::{Dependence, Options, Problem, Variation};
use crate::material::OutsideTable;
use std::f64::consts::FRAC_2_PI;

/// An angle of loss beyond this is that of a fluid.
const MAX_LOSS_ANGLE: f64 = 1.3;

/// E_j(ω) = |Ē_j(ω)| a_j x^β exp(d_j(ω) + iδ_j(ω)) with δ_j = min(q x^γ δ̄_j(ω), 1.3), x = ω/ω₀, and the dispersion that belongs to a loss that changes,
/// $$ d_j = \frac{2}{\pi} q \bar{\delta}_j(\omega_0) \left( \frac{x^\gamma - 1}{\gamma} - \ln x \right) $$
///
/// Ē_j is the nominal and δ̄_j its angle, one where it has none: what is unknown of a law is its size, its slope over
/// log ω, how much it damps, and the slope of that. Slopes and damping are common to all unknowns.
///
/// # Source
/// H. C. Booij, G. P. J. M. Thoone, Rheol. Acta 21 (1982) 15–24: d ln|E|/d ln ω = 2δ/π nearly.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Moduli {
    /// ln a_j, zero of unknowns that stay at their nominal values.
    pub(super) ln_sizes: Vec<f64>,
    /// ln q.
    pub(super) ln_loss: f64,
    /// β.
    pub(super) slope: f64,
    /// γ.
    pub(super) loss_slope: f64,
}

impl Moduli {
    /// The largest difference of any ln a_j.
    pub(super) fn ln_size_distance(&self, other: &Self) -> f64 {
        self.ln_sizes.iter().zip(&other.ln_sizes).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
    }
}

/// An unknown at the frequencies that are looked at.
#[derive(Debug, Clone)]
struct UnknownAt {
    nominal: Vec<c64>,
    /// ln a from … to; `None` of one that stays at its nominal value, for it is absent there.
    ln_size: Option<[f64; 2]>,
    /// ln a from … to by the bounds alone.
    bounds: Option<[f64; 2]>,
    /// Whether it is a geometric parameter: no one is mistaken by powers of ten about these alone.
    is_dimension: bool,
    /// tan δ from … to.
    loss: [f64; 2],
    /// Whether its nominal has damping at every frequency.
    damps: bool,
    is_real: bool,
    has_slope: bool,
}

/// What is unknown: ln a_j, ln q, β, γ.
#[derive(Debug, Clone)]
pub(super) struct Parametrization {
    each: Vec<UnknownAt>,
    /// ln(ω/ω₀).
    ln_omega: Vec<f64>,
    /// ln a where sizes are expected: zero, but where nominal values are taken to be far off.
    pub(super) expected_ln_size: f64,
}

impl Parametrization {
    /// About sizes that are larger by a factor, given by its logarithm, as far as the bounds allow; `None` where they do not.
    pub(super) fn about(&self, ln_size: f64) -> Option<Self> {
        let half = 0.5 * std::f64::consts::LN_10;
        let mut moved = Self { expected_ln_size: ln_size, ..self.clone() };
        for one in &mut moved.each {
            let Some(bounds) = one.bounds.filter(|_| one.ln_size.is_some() && !one.is_dimension) else {
                continue;
            };
            let [low, high] = [(ln_size - half).max(bounds[0]), (ln_size + half).min(bounds[1])];
            if high <= low {
                return None;
            }
            one.ln_size = Some([low, high]);
        }
        Some(moved)
    }

    /// `None` where no unknown has a positive real part to begin with and something that bounds it.
    pub(super) fn new(
        problem: &Problem<'_>,
        frequency_hz: &[f64],
        options: &Options,
    ) -> Result<Option<Self>, OutsideTable> {
        let unknowns = problem.unknowns();
        let middle = frequency_hz.len() / 2;
        let mut each = Vec::with_capacity(unknowns.len());
        for unknown in unknowns {
            let nominal = |&f: &f64| unknown.nominal.at_laplace(f, problem.model().decay_per_s());
            let nominal: Vec<c64> = frequency_hz.iter().map(nominal).collect::<Result<_, _>>()?;
            let range = match unknown.dependence {
                Dependence::Factor(_) => options.search_box(unknown, nominal[middle]),
                Dependence::Powers(_) => Some(unknown.range(nominal[middle])),
            };
            let is_there = nominal.iter().all(|p| p.re > 0.0);
            let bounded = unknown.bounds.loss_factor.unwrap_or([0.0, f64::INFINITY]);
            let positive = range.filter(|[low, high]| is_there && *low > 0.0 && high >= low);
            let [low, high] = unknown.bounds.storage.unwrap_or([0.0, f64::INFINITY]);
            let ln = |value: f64| (value.max(0.0) / nominal[middle].re).ln();
            each.push(UnknownAt {
                bounds: is_there.then(|| [ln(low), ln(high)]),
                is_dimension: matches!(unknown.dependence, Dependence::Powers(_)),
                ln_size: positive.map(|range| range.map(|s| (s / nominal[middle].re).ln())),
                damps: nominal.iter().all(|p| p.arg() > 1e-9),
                nominal,
                // Damping takes energy: a negative loss factor is a finding, not an answer.
                loss: bounded.map(|eta| eta.max(0.0)),
                is_real: unknown.real,
                has_slope: unknowns.len() == 1 || unknown.varies != Variation::Constant,
            });
        }
        let ln_omega = frequency_hz.iter().map(|f| (f / frequency_hz[middle]).ln()).collect();
        let is_free = each.iter().any(|one| one.ln_size.is_some());
        Ok(is_free.then_some(Self { each, ln_omega, expected_ln_size: 0.0 }))
    }

    /// The nominal values.
    pub(super) fn nominal(&self) -> Moduli {
        Moduli { ln_sizes: vec![0.0; self.each.len()], ln_loss: 0.0, slope: 0.0, loss_slope: 0.0 }
    }

    /// Each free unknown's number, with its ln a from … to.
    pub(super) fn free(&self) -> impl Iterator<Item = (usize, [f64; 2])> + '_ {
        self.each.iter().enumerate().filter_map(|(j, one)| Some((j, one.ln_size?)))
    }

    /// ln a from … to that all free unknowns have in common.
    pub(super) fn common(&self) -> [f64; 2] {
        self.free().fold([f64::NEG_INFINITY, f64::INFINITY], |[low, high], (_, own)| {
            [own[0].max(low).min(high), own[1].min(high).max(low)]
        })
    }

    /// All free unknowns by the same ratio.
    pub(super) fn all_by(&self, ln_size: f64, ln_loss: f64, slope: f64) -> Moduli {
        let mut moduli = Moduli { ln_loss, slope, ..self.nominal() };
        self.free().for_each(|(j, [low, high])| moduli.ln_sizes[j] = ln_size.clamp(low, high));
        moduli
    }

    /// All free unknowns larger by a ratio than they are.
    pub(super) fn moved(&self, moduli: &Moduli, by: f64) -> Moduli {
        let mut moved = moduli.clone();
        self.free()
            .for_each(|(j, [low, high])| moved.ln_sizes[j] = (moduli.ln_sizes[j] + by).clamp(low, high));
        moved
    }

    /// Whether any unknown has damping, and whether any may have a slope.
    pub(super) fn has_loss(&self) -> [bool; 2] {
        let free = || self.each.iter().filter(|one| one.ln_size.is_some() && !one.is_real);
        [free().count() > 0, free().any(|one| one.has_slope)]
    }

    /// ln q of an angle in the middle of the band.
    pub(super) fn ln_loss(&self, angle: f64) -> f64 {
        let first = self.each.iter().find(|one| one.ln_size.is_some() && !one.is_real);
        first.map_or(0.0, |one| (angle / one.angle(one.nominal.len() / 2)).ln())
    }

    /// ln q of the nominal's own damping, or of one per cent where it has none.
    pub(super) fn usual_loss(&self) -> f64 {
        let damps = self.each.iter().any(|one| one.ln_size.is_some() && !one.is_real && one.damps);
        if damps { 0.0 } else { self.ln_loss(0.01) }
    }

    /// The values of all unknowns at the i-th frequency.
    pub(super) fn values(&self, moduli: &Moduli, i: usize) -> Vec<c64> {
        let value = |(one, ln_size): (&UnknownAt, &f64)| match one.ln_size {
            None => one.nominal[i],
            Some(_) => one.at(*ln_size, moduli, self.ln_omega[i], i),
        };
        self.each.iter().zip(&moduli.ln_sizes).map(value).collect()
    }

    /// Slopes of the values of all unknowns at the i-th frequency by the [`Self::coordinates`], `[coordinate][unknown]`.
    pub(super) fn slopes(&self, moduli: &Moduli, i: usize) -> Vec<Vec<c64>> {
        let values = self.values(moduli, i);
        let none = vec![c64::default(); values.len()];
        let mut slopes: Vec<Vec<c64>> = Vec::new();
        for (j, _) in self.free() {
            let mut own = none.clone();
            own[j] = values[j];
            slopes.push(own);
        }
        let mut of_all = |slope: &dyn Fn(&UnknownAt) -> c64| {
            let each = self.each.iter().zip(&values);
            slopes.push(
                each.map(|(one, value)| value * one.ln_size.map_or(c64::default(), |_| slope(one))).collect(),
            );
        };
        let [loss, slope] = self.has_loss();
        let ln_omega = self.ln_omega[i];
        if loss {
            let dispersion = |one: &UnknownAt| one.dispersion(moduli, ln_omega)[0];
            of_all(&|one| c64::new(dispersion(one), one.angle_slope(moduli, ln_omega, i)));
        }
        if slope {
            of_all(&|one| if one.has_slope { ln_omega.into() } else { c64::default() });
            let by_loss_slope = |one: &UnknownAt| {
                c64::new(one.dispersion(moduli, ln_omega)[1], one.angle_slope(moduli, ln_omega, i) * ln_omega)
            };
            of_all(&|one| if one.has_slope { by_loss_slope(one) } else { c64::default() });
        }
        slopes
    }

    /// Numbers that are free: ln a_j of the free unknowns, ln q, β and γ where there is damping.
    pub(super) fn coordinates(&self, moduli: &Moduli) -> Vec<f64> {
        let mut at: Vec<f64> = self.free().map(|(j, _)| moduli.ln_sizes[j]).collect();
        let [loss, slope] = self.has_loss();
        at.extend(loss.then_some(moduli.ln_loss));
        if slope {
            at.extend([moduli.slope, moduli.loss_slope]);
        }
        at
    }

    /// Which of the [`Self::coordinates`] is γ, if any.
    pub(super) fn loss_slope_at(&self) -> Option<usize> {
        let [loss, slope] = self.has_loss();
        slope.then(|| self.free().count() + usize::from(loss) + 1)
    }

    /// What [`Self::coordinates`] are of, from the first of some numbers; the others are left.
    pub(super) fn of<'c>(&self, at: &'c [f64]) -> (Moduli, &'c [f64]) {
        let mut moduli = self.nominal();
        let mut rest = at;
        let mut next = || {
            let (first, others) = rest.split_first().expect("as many numbers as coordinates");
            rest = others;
            *first
        };
        self.free().for_each(|(j, _)| moduli.ln_sizes[j] = next());
        let [loss, slope] = self.has_loss();
        if loss {
            moduli.ln_loss = next();
        }
        if slope {
            moduli.slope = next();
            moduli.loss_slope = next();
        }
        (moduli, rest)
    }
}

impl UnknownAt {
    /// The nominal's angle at the i-th frequency, one where it has none.
    fn angle(&self, i: usize) -> f64 {
        if self.damps { self.nominal[i].arg() } else { 1.0 }
    }

    fn at(&self, ln_size: f64, moduli: &Moduli, ln_omega: f64, i: usize) -> c64 {
        let slope = if self.has_slope { moduli.slope } else { 0.0 };
        let [dispersion, _] = self.dispersion(moduli, ln_omega);
        let size = self.nominal[i].norm() * (ln_size + slope * ln_omega + dispersion).exp();
        if self.is_real {
            return c64::new(size, 0.0);
        }
        let [low, high] = self.angles();
        c64::from_polar(size, self.free_angle(moduli, ln_omega, i).clamp(low, high))
    }

    /// γ, zero of what has no slope.
    fn loss_slope(&self, moduli: &Moduli) -> f64 {
        if self.has_slope { moduli.loss_slope } else { 0.0 }
    }

    /// δ without its bounds.
    fn free_angle(&self, moduli: &Moduli, ln_omega: f64, i: usize) -> f64 {
        self.angle(i) * (moduli.ln_loss + self.loss_slope(moduli) * ln_omega).exp()
    }

    /// d, which is its slope by ln q too, and its slope by γ; none of a real unknown.
    fn dispersion(&self, moduli: &Moduli, ln_omega: f64) -> [f64; 2] {
        if self.is_real {
            return [0.0; 2];
        }
        let scale =
            FRAC_2_PI * (moduli.ln_loss.exp() * self.angle(self.nominal.len() / 2)).min(MAX_LOSS_ANGLE);
        let gamma = self.loss_slope(moduli);
        let step = gamma * ln_omega;
        // ((eˢ − 1)/s − 1) and its slope by s; by series near zero.
        let (part, slope) = match step.abs() < 1e-3 {
            true => (0.5 * step + step * step / 6.0, 0.5 + step / 3.0),
            false => {
                let part = step.exp_m1() / step;
                (part - 1.0, (step.exp() - part) / step)
            }
        };
        [scale * ln_omega * part, scale * ln_omega * ln_omega * slope]
    }

    /// Angles from … to.
    fn angles(&self) -> [f64; 2] {
        self.loss.map(|eta| eta.atan().min(MAX_LOSS_ANGLE))
    }

    /// ∂δ/∂ln q: none of a real unknown, nor at a bound.
    fn angle_slope(&self, moduli: &Moduli, ln_omega: f64, i: usize) -> f64 {
        let [low, high] = self.angles();
        let angle = self.free_angle(moduli, ln_omega, i);
        if self.is_real || angle <= low || angle >= high { 0.0 } else { angle }
    }
}
