//! Moduli at real frequencies, of those that were found through an exponential window.
//!
//! Records with a window e^{−αt} show the model at s = iω + α, and so they show E(s). Everything else compares moduli at iω.

use super::identification::Identification;
use super::outcome::Line;
use super::problem::Problem;
use super::unknown::{Dependence, Unknown};
use crate::c64;
use crate::laws::LawFit;
use crate::material::{Law, at_real_frequency, loss_factor};
use crate::model::{DynamicStiffness, Role};
use crate::roots::Bounds;

/// The same with all moduli at real frequencies.
pub(super) fn at_real_frequencies(found: Identification, problem: &Problem<'_>) -> Identification {
    let model = problem.model();
    if model.decay_per_s() == 0.0 {
        return found;
    }
    let law_of = |j: usize| found.constants.iter().find(|one| one.unknowns == j).map(|one| one.law.clone());
    let seen: Vec<Seen> = (problem.unknowns().iter().enumerate())
        .map(|(j, unknown)| Seen { unknown, law: law_of(j), decay_per_s: decay(model, unknown) })
        .collect();
    let lines = |lines: Vec<Line>, with_law: bool| -> Vec<Line> {
        lines.into_iter().map(|line| line_at_real_frequency(line, &seen, with_law)).collect()
    };
    Identification {
        lines: lines(found.lines, true),
        free: lines(found.free, false),
        laws: found.laws.into_iter().map(LawFit::at_real_frequencies).collect(),
        ..found
    }
}

/// An unknown as it is seen through the window.
struct Seen<'p> {
    unknown: &'p Unknown,
    /// What it is over the band, where it is a law.
    law: Option<Law>,
    decay_per_s: f64,
}

/// The decay of the window for an unknown: only a modulus depends on frequency.
fn decay(model: &DynamicStiffness, unknown: &Unknown) -> f64 {
    let is_stiffness = |&term: &usize| model.terms()[term].role == Role::Stiffness;
    match &unknown.dependence {
        Dependence::Factor(terms) if terms.iter().all(is_stiffness) => model.decay_per_s(),
        _ => 0.0,
    }
}

impl Seen<'_> {
    /// The value at iω of one at s.
    fn at(&self, value: c64, frequency_hz: f64) -> c64 {
        at_real_frequency(value, frequency_hz, self.decay_per_s)
    }
}

fn line_at_real_frequency(mut line: Line, seen: &[Seen<'_>], with_law: bool) -> Line {
    let f = line.frequency_hz;
    let nominal_at_s = line.nominal();
    for (value, one) in line.values.iter_mut().zip(seen) {
        value.nominal = one.unknown.nominal.at(f).unwrap_or(value.nominal);
        let law = one.law.as_ref().filter(|_| with_law).and_then(|law| law.at(f).ok());
        let Some(at_s) = value.value else { continue };
        let at_f = law.unwrap_or_else(|| within(&one.unknown.bounds, at_s, one.at(at_s, f)));
        (value.value, value.correction) = (Some(at_f), Some(at_f - value.nominal));
        if let Some(bars) = &mut value.uncertainty {
            let ratio = loss_factor(at_f) / loss_factor(at_s);
            bars.loss_factor_std =
                bars.loss_factor_std.map(|std| if ratio > 0.0 { ratio * std } else { std });
        }
    }
    // Rounded alike, a rival is still equal to its root.
    let nominal = line.nominal();
    for root in &mut line.roots {
        root.correction = seen[0].at(nominal_at_s + root.correction, f) - nominal;
    }
    let all = line.rivals.iter_mut().chain(line.solutions.iter_mut().map(|solution| &mut solution.values));
    for values in all {
        for ((value, one), of_line) in values.iter_mut().zip(seen).zip(&line.values) {
            *value = of_line.nominal + (one.at(*value, f) - of_line.nominal);
        }
    }
    line
}

/// A value at iω that is no farther out than that at s: bounds were those of what was found.
fn within(bounds: &Bounds, at_s: c64, at_f: c64) -> c64 {
    if bounds.broken_by(at_f).is_none() || bounds.broken_by(at_s).is_some() {
        return at_f;
    }
    let clamp =
        |value: f64, bound: Option<[f64; 2]>| bound.map_or(value, |[low, high]| value.clamp(low, high));
    let storage = clamp(at_f.re, bounds.storage);
    c64::new(storage, storage * clamp(loss_factor(at_f), bounds.loss_factor))
}
