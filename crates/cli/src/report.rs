//! What came out, in the few lines that a person reads first.

use frfit::identify::{
    Calibrated, Explained, Leverage, Line, ModeError, ModelErrorsFound, NoiseSource, SmoothCurve, Status,
    Variation,
};
use frfit::model::FactorPart;
use frfit_workflow::check::findings_text;
use frfit_workflow::job::IdentifyJob;
use frfit_workflow::load::Layout;
use frfit_workflow::output::{Words, laws_text, several_text};
use std::path::Path;

/// That the model is the one behind an exponential window.
fn window(job: &IdentifyJob) -> Option<String> {
    let decay_per_s = job.case.model.decay_per_s();
    (decay_per_s > 0.0).then(|| format!("decay_per_s = {decay_per_s}, taken into the model"))
}

/// The verdict of an identification and where its files are.
pub(crate) fn identified(job: &IdentifyJob, out: &Path) -> Words {
    let mut words = Words::default();
    let Some(identify) = job.identify() else { return words };
    let run = &job.run;
    if identify.layout == Layout::Named {
        words = several_text(identify, run);
        words.warn(&job.diagnosis.as_ref().map_or(String::new(), |found| findings_text(&job.case, found)));
        if let Some(errors) = &run.found.model_errors {
            words.warn(&format!("  {:<18}{}\n", "model errors", model_errors(job, errors)));
        }
        leverage(job).iter().for_each(|sentence| words.say(&format!("  {:<18}{sentence}\n", "leverage")));
        contradictions(job).for_each(|sentence| words.warn(&format!("  {:<18}{sentence}\n", "sensor")));
        window(job).iter().for_each(|sentence| words.say(&format!("  {:<18}{sentence}\n", "window")));
        words.say(&format!(
            "  {:<18}{}: identified.csv, response.csv, updated.uff, summary.json, figures/, report.html\n",
            "wrote",
            out.display()
        ));
        return words;
    }
    let band = match (run.found.lines.first(), run.found.lines.last()) {
        (Some(first), Some(last)) => format!("{} to {} Hz", first.frequency_hz, last.frequency_hz),
        _ => String::new(),
    };
    words.say(&format!(
        "{}: factor of {} at {} frequencies, {band}\n",
        job.case.title,
        identify.unknowns[0].name,
        run.found.lines.len()
    ));
    // What is wrong with the data comes before what was made of them.
    words.warn(&job.diagnosis.as_ref().map_or(String::new(), |found| findings_text(&job.case, found)));
    let mut add = |is_warning: bool, label: &str, value: String| {
        words.add(is_warning, &format!("  {label:<18}{value}\n"));
    };
    let statuses = Status::ALL.into_iter().filter(|&status| run.count(status) > 0);
    add(
        false,
        "status",
        statuses
            .map(|status| format!("{} {}", run.count(status), status.name()))
            .collect::<Vec<_>>()
            .join(", "),
    );
    if let Some(sentence) = window(job) {
        add(false, "window", sentence);
    }
    let ok = |outcome: &&Line| outcome.status == Status::Ok;
    let range = |number: &dyn Fn(&Line) -> Option<f64>| {
        let values = run.found.lines.iter().filter(ok).filter_map(number);
        values.fold(None, |range: Option<(f64, f64)>, v| {
            Some(range.map_or((v, v), |(low, high)| (low.min(v), high.max(v))))
        })
    };
    let real = identify.unknowns[0].real;
    if let Some((low, high)) = range(&|outcome| outcome.storage()) {
        let (label, unit) = if real { ("factor", "") } else { ("storage modulus", identify.units[0].unit()) };
        let unit = if unit.is_empty() { String::new() } else { format!(" {unit}") };
        add(false, label, format!("{low:.6e} to {high:.6e}{unit} (where ok)"));
    }
    if let (Some((low, high)), false) = (range(&|outcome| outcome.loss_factor()), real) {
        add(false, "loss factor", format!("{low:.6} to {high:.6} (where ok)"));
    }
    if let Some((_, high)) = range(&|outcome| outcome.error) {
        add(false, "error", format!("at most {high:.1e} (where ok)"));
    }
    for (is_warning, label, sentence) in doubts(job) {
        add(is_warning, label, sentence);
    }
    let largest = run.found.lines.iter().filter_map(|outcome| outcome.spectral_radius).reduce(f64::max);
    if let Some(radius) = largest {
        add(false, "spectral radius", format!("up to {radius:.4}"));
    }
    for status in Status::ALL.into_iter().filter(|&status| status != Status::Ok) {
        let bands = run.bands_hz(status);
        if !bands.is_empty() {
            // What the user left out is no surprise.
            add(status != Status::OutOfBand, status.name(), bands_hz(&bands));
        }
    }
    let reference = &job.summary["reference"];
    if let Some(all) = reference["fraction_right"].as_f64() {
        let of_ok = reference["fraction_right_of_ok"]
            .as_f64()
            .map_or(String::new(), |f| format!(", {} of ok", percent(f)));
        let off = match reference["deviation"]["max_ok"].as_f64() {
            Some(off) if all < 1.0 => format!("; off by at most {off:.1e} where ok"),
            _ => String::new(),
        };
        add(
            false,
            "right",
            format!(
                "{} of all{of_ok} (the reference is known; within {}{off})",
                percent(all),
                reference["within"]
            ),
        );
    }
    add(
        false,
        "work",
        format!(
            "{} factorisations, {} solves, {:.2} s",
            run.found.search.work.factorisations,
            run.found.search.work.solves,
            run.seconds.identify()
        ),
    );
    if let (Some(size), Some(error)) = (run.found.search.reduced_size, run.found.reduction_error()) {
        add(
            false,
            "subspace",
            format!("{size} vectors, error of the response at most {error:.1e} (estimated)"),
        );
    }
    if let Some(curve) = &run.found.curve {
        let settled = if curve.converged { "" } else { ", not settled" };
        let odd = match curve.unexplained {
            0 => String::new(),
            count => format!("; {count} frequencies that it does not explain have no say in it"),
        };
        let SmoothCurve { parameters, width_octaves, .. } = curve;
        add(
            !curve.converged || curve.unexplained > 0,
            "smooth",
            format!("{parameters:.1} parameters, one for {width_octaves:.2} octaves{settled}{odd}"),
        );
    }
    let more = match &identify.unknowns[0].varies {
        Variation::Law(_) => "free.csv, law.json, ",
        Variation::Smooth => "free.csv, ",
        _ => "",
    };
    add(
        false,
        "wrote",
        format!(
            "{}: identified.csv, {more}candidates.csv, response.csv, updated.uff, summary.json, figures/, report.html",
            out.display()
        ),
    );
    if !run.found.laws.is_empty() {
        words.say(&laws_text(&run.found.laws, &vec![None; run.found.laws.len()], identify.units[0]));
    }
    words
}

/// The sensors that contradict all others, and what was done with them.
fn contradictions(job: &IdentifyJob) -> impl Iterator<Item = String> {
    let fits = job.case.sensors.iter().zip(&job.run.found.sensors).filter(|(_, fit)| fit.contradicts);
    fits.map(|(sensor, fit)| {
        let done = if fit.left_out { "left out" } else { "kept, as reject_outliers = false says" };
        format!("{} contradicts all others: {done}", sensor.label)
    })
}

/// What is known of the noise, and what speaks against sensors or model: whether it must not be missed, what it is about, and a sentence.
fn doubts(job: &IdentifyJob) -> Vec<(bool, &'static str, String)> {
    let run = &job.run;
    let mut lines = Vec::new();
    if let Some(level) = run.found.noise.level {
        let known = run.found.lines.iter().filter(|outcome| outcome.status == Status::Ok);
        let relative = known.filter_map(|o| Some(o.uncertainty()?.correction_std / o.factor()?.norm()));
        let mut relative: Vec<f64> = relative.collect();
        relative.sort_by(f64::total_cmp);
        let bar = relative.get(relative.len() / 2).map_or(String::new(), |median| {
            format!("; standard deviation of the factor {} (median where ok)", percent_of(*median))
        });
        let source = match run.found.noise.source {
            NoiseSource::Given => "as given".to_owned(),
            NoiseSource::Sensors => format!("{level:.1e} of what is assumed, from the misfit of the sensors"),
            NoiseSource::Scatter => {
                format!("{level:.1e} of what is assumed, from the scatter of the answers")
            }
            NoiseSource::Curve => {
                format!("{level:.1e} of what is assumed, from what the smooth curve leaves")
            }
            other => other.name().to_owned(),
        };
        lines.push((false, "noise", format!("{source}{bar}")));
    }
    if let Some(errors) = &run.found.model_errors {
        lines.push((true, "model errors", model_errors(job, errors)));
    }
    if let Some(sentence) = leverage(job) {
        lines.push((false, "leverage", sentence));
    }
    lines.extend(contradictions(job).map(|sentence| (true, "sensor", sentence)));
    lines.extend(channels(job));
    match run.found.fit {
        Some(fit) if fit.verdict == Explained::No => {
            let left = run.found.sensors.iter().filter(|sensor| !sensor.left_out).count();
            let who = match left {
                _ if !run.found.laws.is_empty() => "the law, or the model, cannot explain the measurements",
                2 => {
                    "the two sensors contradict one another, or the model cannot explain them; two cannot tell which"
                }
                _ => "the model cannot explain the measurements",
            };
            let told = match run.found.noise.source {
                NoiseSource::Given => {
                    format!(" (χ² is {:.1} times what noise gives)", fit.chi_squared / fit.freedom as f64)
                }
                _ => " (what is left over is no noise)".to_owned(),
            };
            lines.push((true, "not explained", format!("{who}{told}")));
        }
        Some(fit) if fit.verdict == Explained::Nearly => {
            let times = (fit.chi_squared / fit.freedom as f64).sqrt();
            lines.push((
                true,
                "fit",
                format!("misfit {times:.2} times the given noise: error bars may be too short by that"),
            ));
        }
        _ => {}
    }
    lines
}

/// The errors of the model that are taken out of the values, and are in their error bars.
fn model_errors(job: &IdentifyJob, errors: &ModelErrorsFound) -> String {
    let size = |one: &&ModeError| one.error.abs() / one.std;
    let worst = errors.modes.iter().max_by(|a, b| size(a).total_cmp(&size(b))).map(|mode| {
        format!(
            "; the mode at {:.0} Hz is off by {:+.2} ± {:.2} %",
            mode.frequency_hz,
            100.0 * mode.error,
            100.0 * mode.std
        )
    });
    let known = errors.factors.iter().filter(|factor| factor.error.abs() > 2.0 * factor.std).map(|factor| {
        let name = &job.case.model.terms()[factor.term].name;
        match factor.part {
            FactorPart::Storage => {
                format!("; {name} is off by {:+.2} ± {:.2} %", 100.0 * factor.error, 100.0 * factor.std)
            }
            FactorPart::LossFactor => {
                format!("; the loss factor of {name} is off by {:+.1e} ± {:.1e}", factor.error, factor.std)
            }
        }
    });
    let [frequency, shape] = [errors.frequency_std, errors.shape_std].map(|std| 100.0 * std);
    let sizes = match errors.modes.is_empty() {
        true => "known factors are".to_owned(),
        false => format!("natural frequencies {frequency:.2} %, mode shapes {shape:.1} %:"),
    };
    let known = known.collect::<String>();
    format!("{sizes} taken out, and in the error bars{}{known}", worst.unwrap_or_default())
}

/// The known factors of which an error moves an unknown by more than itself, the worst first.
fn leverage(job: &IdentifyJob) -> Option<String> {
    const SHOWN: usize = 2;
    let mut large: Vec<&Leverage> = job.run.found.leverage.iter().filter(|one| one.change > 1.0).collect();
    large.sort_by(|a, b| b.change.total_cmp(&a.change));
    let unknowns = job.identify().map_or(&[][..], |identify| identify.unknowns.as_slice());
    let one = |one: &&Leverage| {
        let unknown = unknowns.get(one.unknown).map_or("the factor", |unknown| unknown.name.as_str());
        format!("1 % in {} moves {unknown} by {:.1} %", job.case.model.terms()[one.term].name, one.change)
    };
    let said: Vec<String> = large.iter().take(SHOWN).map(one).collect();
    (!said.is_empty()).then(|| said.join("; "))
}

/// What was found of channels whose scale or delay was unknown.
fn channels(job: &IdentifyJob) -> Vec<(bool, &'static str, String)> {
    let unknown = job.identify().map_or(&[][..], |identify| identify.channels.as_slice());
    let mut lines = Vec::new();
    for ((sensor, unknown), found) in job.case.sensors.iter().zip(unknown).zip(&job.run.found.channels) {
        let mut tell = |label, found: Option<Calibrated>, what: &str| {
            let told = match found {
                Some(Calibrated { value, std }) => {
                    let std = std.map_or(String::new(), |std| format!(" ± {std:.1e}"));
                    format!("{value:.6e}{std} {what}, at {}", sensor.label)
                }
                None => format!("not identifiable, at {}: left out", sensor.label),
            };
            lines.push((found.is_none(), label, told));
        };
        if unknown.scale {
            tell("scale", found.scale, "times what the file says");
        }
        if unknown.delay {
            tell("delay", found.delay_s, "s late");
        }
    }
    lines
}

/// With as many digits as an error bar deserves.
fn percent_of(fraction: f64) -> String {
    let percent = 100.0 * fraction;
    if percent < 0.01 { format!("{percent:.0e} %") } else { format!("{percent:.2} %") }
}

fn percent(fraction: f64) -> String {
    format!("{:.1} %", 100.0 * fraction)
}

/// The widest bands, and how many more.
fn bands_hz(bands: &[[f64; 2]]) -> String {
    const SHOWN: usize = 6;
    let shown: Vec<String> = bands
        .iter()
        .take(SHOWN)
        .map(
            |[first, last]| {
                if first == last { format!("{first:.1}") } else { format!("{first:.1}–{last:.1}") }
            },
        )
        .collect();
    let more = bands.len().saturating_sub(SHOWN);
    let rest = if more > 0 { format!(" and {more} more bands (see summary.json)") } else { String::new() };
    format!("{} Hz{rest}", shown.join(", "))
}
