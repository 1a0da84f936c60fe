//! What is written to the screen.

use super::words::{bar, inseparable as in_words};
use super::{NextSensor, NoiseFrom, Place, SensitivityRun};
use crate::load::Case;
use crate::output::Words;
use crate::terminal::{listed, short};
use frfit::sensitivity::{KNOWN_LN_STD, VariableStd, WorstBar, inseparable};
use frfit_linalg::solve::Breakdown;

/// Table, what is identifiable, and the next sensor.
pub(super) fn text(case: &Case, run: &SensitivityRun) -> Words {
    let (first, last) = (run.frequency_hz.first(), run.frequency_hz.last());
    let band = first.zip(last).map_or(String::new(), |(a, b)| format!(", {} to {} Hz", short(*a), short(*b)));
    let mut words = Words::default();
    words.say(&format!(
        "{}: sensitivities to {} parameter(s) at {} sensor(s), {} frequencies{band}\n",
        case.title,
        run.variables.len(),
        case.sensors.len(),
        run.frequency_hz.len()
    ));
    words.say(&table(case, run));
    let mut add = |is_warning: bool, label: &str, value: String| {
        words.add(is_warning, &format!("  {label:<18}{value}\n"));
    };
    add(
        false,
        "noise",
        match run.noise {
            NoiseFrom::Given(noise) => format!("{} % of the response", 100.0 * noise),
            NoiseFrom::Assumed(noise) => {
                format!("{} % of the response, assumed (--noise says otherwise)", 100.0 * noise)
            }
            NoiseFrom::Files => "as the files of the measurements say".to_owned(),
        },
    );
    match &run.resolved {
        Some(resolved) => {
            let groups = inseparable(resolved);
            if groups.is_empty() {
                add(
                    false,
                    "identifiable",
                    format!("all parameters, each to {} or better", percent(KNOWN_LN_STD)),
                );
            }
            for group in &groups {
                add(true, "inseparable", in_words(&case.model, &run.variables, resolved, group));
            }
        }
        None => add(true, "identifiable", "the singular values of the Jacobian were not found".to_owned()),
    }
    if let Some(next) = &run.next {
        for (k, sentence) in next_in_words(case, run, next).into_iter().enumerate() {
            add(false, if k == 0 { "next sensor" } else { "" }, sentence);
        }
    }
    let unanswered = run.values.iter().filter(|at| at.iter().flatten().all(Option::is_none)).count();
    if unanswered > 0 {
        add(true, "no answer", format!("at {unanswered} frequencies: the system is singular there"));
    }
    let good = if run.trained.converged { "" } else { "; that is more than was asked for" };
    add(
        !run.trained.converged,
        "subspace",
        format!(
            "{} vectors, derivatives at the sensors to {:.1e} (estimated){good}",
            run.subspace_size, run.trained.error
        ),
    );
    add(
        false,
        "work",
        format!(
            "{} factorisations, {} solves, {:.2} s",
            run.work.factorisations, run.work.solves, run.seconds
        ),
    );
    words
}

fn table(case: &Case, run: &SensitivityRun) -> String {
    let bars = run.resolved.as_ref().map(frfit::sensitivity::Resolved::bars);
    let names = run.variables.iter().map(|variable| variable.name.chars().count());
    let width = names.fold("parameter".len(), usize::max);
    let mut text =
        format!("  {:<width$}  {:>9}  {:>9}  {:<24}  error bar\n", "parameter", "rms", "largest", "at");
    for ranking in &run.ranking {
        let number = |value: Option<f64>| value.map_or("-".to_owned(), |value| format!("{value:.3}"));
        let at = ranking.largest.map_or(String::new(), |largest| {
            format!("{:.5} Hz, {}", Shown(largest.frequency_hz), case.sensors[largest.sensor].label)
        });
        text += &format!(
            "  {:<width$}  {:>9}  {:>9}  {at:<24}  {}\n",
            run.variables[ranking.variable].name,
            number(ranking.rms),
            number(ranking.largest.map(|largest| largest.value)),
            bars.as_ref().map_or(String::new(), |bars| bar(bars[ranking.variable])),
        );
    }
    text
}

/// Where nothing could be solved.
pub(super) fn unsolved(case: &Case, breakdown: &Breakdown) -> Words {
    let mut words = Words::default();
    words.warn(&format!("{}: no sensitivities: {breakdown}\n", case.title));
    words
}

/// A number with as many digits as the precision says, without zeros behind.
struct Shown(f64);

impl std::fmt::Display for Shown {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let digits = f.precision().unwrap_or(4).saturating_sub(1);
        let rounded = format!("{:.digits$e}", self.0).parse::<f64>().unwrap_or(self.0);
        write!(f, "{rounded}")
    }
}

/// Places as good as the best that are named.
const SHOWN: usize = 4;

fn next_in_words(case: &Case, run: &SensitivityRun, next: &NextSensor) -> Vec<String> {
    let Some((best, others)) = next.best.split_first() else {
        return vec!["no candidate is left".to_owned()];
    };
    if best.after.total_cmp(&next.before) != std::cmp::Ordering::Less {
        return vec![format!("none of {} candidates lowers the worst error bar", next.compared)];
    }
    let of = |bar: &WorstBar| {
        let worst = bar.worst.map_or(String::new(), |VariableStd { variable, std }| {
            format!("{} ({})", self::bar(Some(std)), run.variables[variable].name)
        });
        match bar.unseen {
            0 => worst,
            unseen => format!("{worst}, with {unseen} not seen"),
        }
    };
    let parameter = |bar: &WorstBar| bar.worst.map(|worst| worst.variable);
    let mut lines = vec![format!(
        "{}: the worst error bar goes from {} to {}",
        case.row_name(best.row),
        of(&next.before),
        of(&best.after)
    )];
    if !best.as_good.is_empty() {
        let names: Vec<String> = best.as_good.iter().map(|&row| case.row_name(row)).collect();
        lines.push(format!("as good: {}", listed(&names, SHOWN)));
    }
    if !others.is_empty() {
        // The parameter is named again only where it is another.
        let named =
            |bar: &WorstBar| bar.unseen == best.after.unseen && parameter(bar) == parameter(&best.after);
        let other = |place: &Place| match place.after.worst.filter(|_| named(&place.after)) {
            Some(worst) => format!("{} {}", case.row_name(place.row), self::bar(Some(worst.std))),
            None => format!("{} {}", case.row_name(place.row), of(&place.after)),
        };
        lines.push(format!("then {}", others.iter().map(other).collect::<Vec<_>>().join(", ")));
    }
    let good = if next.trained.converged { "" } else { "; that is more than was asked for" };
    lines.push(format!(
        "{} places compared; the best ones were computed again with a sensor there: derivatives to {:.1e} (estimated){good}",
        next.compared, next.trained.error
    ));
    lines
}

fn percent(part: f64) -> String {
    format!("{:.0} %", 100.0 * part)
}
