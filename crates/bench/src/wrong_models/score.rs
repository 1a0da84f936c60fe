//! How far the values are from the truth, and whether their error bars say so.

use super::Failure;
use super::case::Case;
use super::natural::median;
use frfit::identify::{Identification, Status};
use frfit::material::loss_factor;

/// One number of a line: storage modulus or loss factor.
#[derive(Debug, Clone, Copy)]
pub struct Part {
    /// The truth.
    pub truth: f64,
    /// What was found.
    pub found: f64,
    /// Its standard deviation; `None` where there is no error bar.
    pub bar: Option<f64>,
}

impl Part {
    /// The error in standard deviations.
    pub fn deviations(&self) -> Option<f64> {
        // No bar and no error is no surprise; no bar and an error is a large one.
        self.bar.map(|bar| (self.found - self.truth).abs() / bar.max(f64::MIN_POSITIVE))
    }

    fn relative(&self, value: f64) -> f64 {
        value / self.truth.abs()
    }
}

/// A line that has a value.
#[derive(Debug, Clone, Copy)]
pub struct Judged {
    /// Its frequency.
    pub frequency_hz: f64,
    /// Its status.
    pub status: Status,
    /// Storage modulus and loss factor.
    pub parts: [Part; 2],
}

/// Every line of an identification that has a value; of several unknowns each that is constant counts once.
///
/// # Errors
/// Where the true law has no value.
pub fn judged(case: &Case, found: &Identification) -> Result<Vec<Judged>, Failure> {
    let mut all = Vec::new();
    let several = case.unknowns.len() > 1;
    let middle = found.lines.len() / 2;
    for (j, (_, law)) in case.unknowns.iter().enumerate() {
        let constant = found.constants.iter().find(|one| several && one.unknowns == j);
        let lines = match constant {
            Some(_) => &found.lines[middle..=middle],
            None => &found.lines,
        };
        for line in lines {
            let status = constant.map_or(line.status, |one| one.status);
            let Some(value) = line.values[j].value else { continue };
            let truth = law.at(line.frequency_hz)?;
            let bars = line.values[j].uncertainty;
            let storage = Part { truth: truth.re, found: value.re, bar: bars.map(|bars| bars.storage_std) };
            let loss_bar = bars.and_then(|bars| bars.loss_factor_std);
            let loss = Part { truth: loss_factor(truth), found: loss_factor(value), bar: loss_bar };
            all.push(Judged { frequency_hz: line.frequency_hz, status, parts: [storage, loss] });
        }
    }
    Ok(all)
}

/// What some lines say together; each of storage modulus and loss factor.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Summary {
    /// How many there are.
    pub count: usize,
    /// How many of them have no error bar.
    pub without_bar: usize,
    /// Part of those with an error bar that are within two of it.
    pub covered: [Option<f64>; 2],
    /// Part of those with error bars where E′ or η is more than four of it off.
    pub far: Option<f64>,
    /// Median of the error bar over the truth.
    pub bar: [Option<f64>; 2],
    /// Median of the error over the truth.
    pub error: [Option<f64>; 2],
}

/// Within so many standard deviations a value is covered: 95.4 of 100 normal ones.
const COVERED: f64 = 2.0;

/// Beyond so many a bar is not believed: 6 of 100 000 normal ones.
const FAR: f64 = 4.0;

impl Summary {
    /// Of some lines.
    pub fn of<'a>(lines: impl Iterator<Item = &'a Judged> + Clone) -> Self {
        let share = |flags: Vec<bool>| {
            let yes = flags.iter().filter(|flag| **flag).count();
            (!flags.is_empty()).then(|| yes as f64 / flags.len() as f64)
        };
        let each = |part: usize| lines.clone().map(move |line| line.parts[part]);
        let covered = |part| share(each(part).filter_map(|one| Some(one.deviations()? <= COVERED)).collect());
        let bar = |part| median(each(part).filter_map(|one| Some(one.relative(one.bar?))).collect());
        let error =
            |part| median(each(part).map(|one| one.relative((one.found - one.truth).abs())).collect());
        let is_far = |line: &Judged| {
            let [storage, loss] = line.parts.map(|part| part.deviations());
            let most = storage.into_iter().chain(loss).reduce(f64::max)?;
            Some(most > FAR)
        };
        Self {
            count: lines.clone().count(),
            without_bar: lines.clone().filter(|line| line.parts[0].bar.is_none()).count(),
            covered: [covered(0), covered(1)],
            far: share(lines.clone().filter_map(is_far).collect()),
            bar: [bar(0), bar(1)],
            error: [error(0), error(1)],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn line(status: Status, off: [f64; 2], bar: Option<f64>) -> Judged {
        let part = |off: f64| Part { truth: 2.0, found: 2.0 + off, bar };
        Judged { frequency_hz: 1.0, status, parts: off.map(part) }
    }

    #[test]
    fn lines_without_a_bar_count_for_the_error_alone() {
        let lines = [
            line(Status::Ok, [0.1, -0.1], Some(0.1)),
            line(Status::Ok, [0.3, 0.5], Some(0.1)),
            line(Status::Ambiguous, [0.2, 0.1], None),
        ];
        let all = Summary::of(lines.iter());
        assert_eq!((all.count, all.without_bar, all.covered, all.far), (3, 1, [Some(0.5); 2], Some(0.5)));
        assert_eq!(all.bar, [Some(0.05); 2]);
        assert!((all.error[0].unwrap() - 0.1).abs() < 1e-12 && (all.error[1].unwrap() - 0.05).abs() < 1e-12);
        let none = Summary::of(lines[2..].iter());
        assert_eq!((none.covered, none.far, none.bar), ([None; 2], None, [None; 2]));
    }
}
