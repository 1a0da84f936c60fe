//! What came out, in the few lines that a person reads first.

use frfit::identify::{
    BandValue, Calibrated, CausalityBreach, Dependence, Explained, Leverage, LeverageOf, Line, ModeError,
    ModelErrorsFound, NoiseSource, Number, SmoothCurve, Status, Trust, Unknown, Variation,
};
use frfit::model::FactorPart;
use frfit_workflow::check::findings_text;
use frfit_workflow::job::IdentifyJob;
use frfit_workflow::load::{IdentifyCase, MeasuredNoise};
use frfit_workflow::output::{Words, contradicted, corrections_text, laws_text, not_identifiable};
use frfit_workflow::terminal::{listed, short};
use serde_json::Value;
use std::path::Path;

/// The verdict of an identification and where its files are.
pub(crate) fn identified(job: &IdentifyJob, out: &Path) -> Words {
    let Some(identify) = job.identify() else { return Words::default() };
    let mut text = Text(Words::default());
    text.0.say(&head(job, identify));
    // What is wrong with the data comes before what was made of them.
    text.0.warn(&job.diagnosis.as_ref().map_or(String::new(), |found| findings_text(&job.case, found)));
    statuses(&mut text, job, identify);
    for j in 0..identify.unknowns.len() {
        value(&mut text, job, identify, j);
    }
    for sentence in not_identifiable(identify, &job.run.found) {
        text.warn("not identifiable", &sentence);
    }
    error(&mut text, job);
    doubts(&mut text, job, identify);
    bands(&mut text, job);
    for j in 0..identify.unknowns.len() {
        reference(&mut text, job, identify, j);
    }
    work(&mut text, job);
    wrote(&mut text, job, identify, out);
    let laws = &job.run.found.laws;
    if !laws.is_empty() {
        text.0.say(&laws_text(laws, &vec![None; laws.len()], identify.units[0]));
    }
    text.0
}

/// Lines of a label and a sentence.
struct Text(Words);

impl Text {
    fn say(&mut self, label: &str, sentence: &str) {
        self.add(false, label, sentence);
    }

    /// What must not be missed.
    fn warn(&mut self, label: &str, sentence: &str) {
        self.add(true, label, sentence);
    }

    fn add(&mut self, is_warning: bool, label: &str, sentence: &str) {
        self.0.add(is_warning, &format!("  {label:<17} {sentence}\n"));
    }
}

/// What was identified, and where.
fn head(job: &IdentifyJob, identify: &IdentifyCase) -> String {
    let lines = &job.run.found.lines;
    let band = match (lines.first(), lines.last()) {
        (Some(first), Some(last)) => {
            format!("{} to {} Hz", short(first.frequency_hz), short(last.frequency_hz))
        }
        _ => String::new(),
    };
    let names: Vec<&str> = identify.unknowns.iter().map(|one| one.name.as_str()).collect();
    let what = match &identify.unknowns[..] {
        [Unknown { dependence: Dependence::Factor(_), name, .. }] => format!("factor of {name}"),
        _ => names.join(", "),
    };
    format!("{}: {what} at {} frequencies, {band}\n", job.case.title, lines.len())
}

fn statuses(text: &mut Text, job: &IdentifyJob, identify: &IdentifyCase) {
    let run = &job.run;
    for (reason, count) in run.found.breakdowns() {
        text.warn("no answer", &format!("at {count} frequencies: {reason}"));
    }
    let there = Status::ALL.into_iter().filter(|&status| run.count(status) > 0);
    let counts: Vec<String> =
        there.map(|status| format!("{} {}", run.count(status), status.name())).collect();
    text.say("status", &counts.join(", "));
    for sensor in &job.case.sensors {
        if let Some(elsewhere) = sensor.elsewhere {
            let file = sensor.file.as_ref().map_or_else(String::new, |file| format!("{}: ", file.display()));
            text.warn(
                "dof",
                &format!(
                    "{file}measured at {elsewhere} as the file says, at {} as the case says: the case counts",
                    sensor.label
                ),
            );
        }
    }
    let (not_common, used) = (identify.not_common, identify.frequency_hz.len());
    if not_common > 0 {
        let all = used + not_common;
        text.warn(
            "lines",
            &format!("{used} of {all} in the band are used: the sensors have no others in common"),
        );
    }
    for sentence in short_of_band(identify) {
        text.warn("band", &sentence);
    }
    let decay_per_s = job.case.model.decay_per_s();
    if decay_per_s > 0.0 {
        text.say("window", &format!("decay_per_s = {decay_per_s}, taken into the model"));
    }
    for (is_warning, label, sentence) in corrections_text(job.case.corrections()) {
        text.add(is_warning, label, &sentence);
    }
}

/// Where the measurements begin or end inside of the band, by more than a step of theirs.
fn short_of_band(identify: &IdentifyCase) -> Vec<String> {
    let (hz, [low, high]) = (&identify.frequency_hz, identify.band_hz);
    let [first, .., last] = hz[..] else { return Vec::new() };
    // Steps may grow with frequency.
    let (first_step, last_step) = (hz[1] - first, last - hz[hz.len() - 2]);
    let ends = [
        (first - low > 1.5 * first_step)
            .then(|| format!("asked for from {} Hz, measured from {} Hz", short(low), short(first))),
        (high - last > 1.5 * last_step)
            .then(|| format!("asked for to {} Hz, measured to {} Hz", short(high), short(last))),
    ];
    ends.into_iter().flatten().collect()
}

/// The numbers of a constant, or the range of what varies.
fn value(text: &mut Text, job: &IdentifyJob, identify: &IdentifyCase, j: usize) {
    let one = &identify.unknowns[j];
    let only = identify.unknowns.len() == 1;
    if let Some(band) = job.run.found.constants.iter().find(|band| band.unknowns == j)
        && !(only && identify.is_law())
    {
        let doubt = doubt_of(band);
        let numbers: Vec<String> = band.numbers.iter().map(number).collect();
        text.add(!doubt.is_empty(), &one.name, &format!("{}{doubt}", numbers.join(", ")));
    }
    if one.varies == Variation::Constant {
        return;
    }
    let unit = match identify.units[j].unit() {
        "" => String::new(),
        _ if one.real => String::new(),
        unit => format!(" {unit}"),
    };
    let Some((low, high)) = range(job, &|line| line.values[j].storage()) else { return };
    let storage = format!("{low:.6e} to {high:.6e}{unit}");
    let loss = range(job, &|line| line.values[j].loss_factor()).filter(|_| !one.real);
    let loss = loss.map(|(low, high)| format!("{low:.6} to {high:.6}"));
    if only {
        let label = if one.real { "factor" } else { "storage modulus" };
        text.say(label, &format!("{storage} (where ok)"));
        loss.iter().for_each(|loss| text.say("loss factor", &format!("{loss} (where ok)")));
    } else {
        let loss = loss.map_or(String::new(), |loss| format!(", loss factor {loss}"));
        text.say(&one.name, &format!("{storage}{loss} (where ok)"));
    }
}

/// Least and greatest of a number where ok.
fn range(job: &IdentifyJob, number: &dyn Fn(&Line) -> Option<f64>) -> Option<(f64, f64)> {
    let ok = job.run.found.lines.iter().filter(|line| line.status == Status::Ok);
    ok.filter_map(number).fold(None, |range, v| {
        Some(range.map_or((v, v), |(low, high): (f64, f64)| (low.min(v), high.max(v))))
    })
}

/// A number that holds for the band, with its standard deviation.
fn number(number: &Number) -> String {
    let name = if number.name == "value" { String::new() } else { format!("{} ", number.name) };
    match number.std.filter(|std| std.is_finite()) {
        Some(std) if std < number.value.abs() => format!("{name}{:.6e} ± {std:.1e}", number.value),
        Some(_) => format!("{name}{:.2e}, not identifiable", number.value),
        None => format!("{name}{:.6e}", number.value),
    }
}

/// Why what holds for the band is not trusted.
fn doubt_of(band: &BandValue) -> String {
    match band.status {
        Status::Ok => String::new(),
        _ if band.at_bound => " (at its bounds: the measurements ask for a value beyond them)".into(),
        status => format!(" ({})", status.meaning()),
    }
}

fn error(text: &mut Text, job: &IdentifyJob) {
    if let Some((_, high)) = range(job, &|line| line.error) {
        text.say("error", &format!("at most {high:.1e} (where ok)"));
    }
}

/// What is known of the noise, and what speaks against sensors or model.
fn doubts(text: &mut Text, job: &IdentifyJob, identify: &IdentifyCase) {
    let found = &job.run.found;
    noise(text, job);
    if let Some(errors) = &found.model_errors {
        text.warn("model errors", &model_errors(job, errors));
    }
    let mesh = found.model_errors.as_ref().and_then(|errors| errors.mesh);
    if job.case.coarser_mesh.is_some() && mesh.is_none() {
        text.warn("coarser mesh", UNPAIRED);
    }
    leverage(job).iter().for_each(|sentence| text.say("leverage", sentence));
    breaches(job).iter().for_each(|sentence| text.warn("causality", sentence));
    contradictions(text, job);
    channels(text, job, identify);
    fit(text, job);
    modes(text, &job.summary["modes"]);
    if let Some(sentence) = far_nominals(&found.search.about, identify) {
        text.say("nominal", &sentence);
    }
    if !found.search.converged {
        text.warn("search", "did not settle: more frequencies, sensors or narrower bounds may help");
    }
    let largest = found.lines.iter().filter_map(|line| line.spectral_radius).reduce(f64::max);
    if let Some(radius) = largest {
        text.say("spectral radius", &format!("up to {radius:.4}"));
    }
}

/// A coarser mesh that says nothing.
const UNPAIRED: &str = "not used: fewer than half of the modes of the band could be paired (is it the same structure, driven and measured at the same points?)";

fn noise(text: &mut Text, job: &IdentifyJob) {
    let found = &job.run.found;
    let Some(level) = found.noise.level else { return };
    let of_the_only = |line: &Line| match line.values[..] {
        [value] => Some(value.uncertainty?.correction_std / value.value?.norm()),
        _ => None,
    };
    let ok = found.lines.iter().filter(|line| line.status == Status::Ok);
    let mut relative: Vec<f64> = ok.filter_map(of_the_only).collect();
    relative.sort_by(f64::total_cmp);
    let bar = relative.get(relative.len() / 2).map_or(String::new(), |median| {
        format!("; standard deviation of the factor {} (median where ok)", percent_of(*median))
    });
    let of = match job.identify().map(|identify| &identify.noise) {
        Some(MeasuredNoise::Unknown) if found.noise.floor.is_some() => {
            "of a response of median size (with a floor that does not grow with the response)"
        }
        Some(MeasuredNoise::Unknown) => "of the response",
        _ => "times the assumed noise",
    };
    let source = match found.noise.source {
        NoiseSource::Given => match found.noise.correlation {
            Some(c) => format!(
                "as given; the sensors have it in common (correlation {c:.2}), which makes error bars longer"
            ),
            None => "as given".to_owned(),
        },
        NoiseSource::Sensors => {
            format!("{level:.1e} {of}, from the misfit of the sensors")
        }
        NoiseSource::Scatter => {
            format!("{level:.1e} {of}, from the scatter of the answers")
        }
        NoiseSource::Curve => {
            format!("{level:.1e} {of}, from the residual of the smooth curve")
        }
        _ => "unknown".to_owned(),
    };
    text.say("noise", &format!("{source}{bar}"));
}

/// The sensors that contradict all others or show nothing, and what was done with them.
fn contradictions(text: &mut Text, job: &IdentifyJob) {
    let all = || job.case.sensors.iter().zip(&job.run.found.sensors);
    for (sensor, _) in all().filter(|(_, fit)| fit.dead) {
        text.warn("sensor", &format!("{} shows nothing beside the others: left out", sensor.label));
    }
    for (sensor, fit) in all().filter(|(_, fit)| fit.contradicts) {
        let done = if fit.left_out { "left out" } else { "kept, as reject_outliers = false says" };
        text.warn("sensor", &format!("{} contradicts all others: {done}", sensor.label));
    }
}

/// Measured natural frequencies without a partner that are named.
const MAX_ALONE: usize = 5;

/// Natural frequencies of model and measurement side by side, where nothing is explained.
fn modes(text: &mut Text, modes: &Value) {
    let Some(measured) = modes["measured"]["modes"].as_array() else { return };
    let pairs = modes["measured"]["pairs"].as_array().map_or(&[][..], Vec::as_slice);
    let off = pairs.iter().filter_map(|pair| pair["difference_at_factor"].as_f64());
    let factor = modes["measured"]["stiffness_factor"].as_f64().unwrap_or(1.0);
    let [least, most] =
        off.fold([f64::INFINITY, f64::NEG_INFINITY], |[least, most], off| [least.min(off), most.max(off)]);
    let by = match pairs.is_empty() {
        true => String::new(),
        false => {
            format!(
                "; with {factor:.3} times the nominal stiffness the model's are {:+.1} to {:+.1} % off",
                100.0 * least,
                100.0 * most
            )
        }
    };
    let is_paired = |mode: &&Value| pairs.iter().any(|pair| pair["measured"] == mode["mode"]);
    let alone =
        measured.iter().filter(|mode| !is_paired(mode)).filter_map(|mode| mode["frequency_hz"].as_f64());
    let alone: Vec<String> = alone.map(|hz| format!("{hz:.1}")).collect();
    let without = match alone.is_empty() {
        true => String::new(),
        false => {
            let named = listed(&alone, MAX_ALONE);
            format!("; {named} Hz have none, and exclude_hz leaves such resonances out")
        }
    };
    text.say(
        "modes",
        &format!(
            "{} of {} measured natural frequencies have a partner in the model{by}{without}: see report.html, or frfit modes",
            pairs.len(),
            measured.len()
        ),
    );
}

/// Whether noise is all that the model leaves.
fn fit(text: &mut Text, job: &IdentifyJob) {
    let found = &job.run.found;
    let Some(fit) = found.fit else { return };
    let per_freedom = fit.chi_squared / fit.freedom as f64;
    match fit.verdict {
        Explained::No => {
            let left = found.sensors.iter().filter(|sensor| !sensor.left_out).count();
            let who = match left {
                _ if !found.laws.is_empty() => "the law, or the model, cannot explain the measurements",
                2 => {
                    "the two sensors contradict one another, or the model cannot explain them; with two it is not known which"
                }
                _ => "the model cannot explain the measurements",
            };
            let by = match found.noise.source {
                NoiseSource::Given => format!("χ² is {per_freedom:.1} times that of noise"),
                _ => "the misfit is larger than the noise seems to be; a column std in the files would say how large that is".to_owned(),
            };
            let errors = found.model_errors.iter();
            let assumptions: Vec<_> = errors.flat_map(|errors| &errors.contradicted_assumptions).collect();
            match assumptions.is_empty() {
                true => text.warn("not explained", &format!("{who} ({by})")),
                false => {
                    text.warn("not explained", "only by errors beyond what the case takes for known");
                }
            }
            assumptions.iter().for_each(|one| text.warn("contradicted", &contradicted(&job.case, one)));
        }
        Explained::Nearly => {
            let rest = found.model_errors.as_ref().map_or(0.0, |errors| errors.response_std);
            let sentence = match rest > 0.0 {
                true => format!(
                    "{:.1} % of the response is left beside noise and errors of the model, and in the error bars",
                    100.0 * rest
                ),
                false => {
                    let times = per_freedom.sqrt();
                    format!("misfit {times:.2} times the given noise: error bars are longer by that")
                }
            };
            text.warn("fit", &sentence);
        }
        Explained::Yes => {
            let sentence =
                format!("explained (χ² {:.4e} with {} degrees of freedom)", fit.chi_squared, fit.freedom);
            text.say("fit", &sentence);
        }
        _ => {}
    }
}

/// Where values are not ok.
fn bands(text: &mut Text, job: &IdentifyJob) {
    for status in Status::ALL.into_iter().filter(|&status| status != Status::Ok) {
        let bands = job.run.bands_hz(status);
        if !bands.is_empty() {
            // What the user left out is no surprise.
            text.add(status.trust() != Trust::NotAsked, status.name(), &bands_hz(&bands));
        }
    }
}

/// How near an unknown is to what a simulated measurement was made with.
fn reference(text: &mut Text, job: &IdentifyJob, identify: &IdentifyCase, j: usize) {
    let reference = &job.summary["unknowns"][j]["reference"];
    let number = |pointer: &str| reference.pointer(pointer).and_then(Value::as_f64);
    let one = &identify.unknowns[j];
    if one.varies == Variation::Constant {
        let Some(off) = number("/relative") else { return };
        let deviations =
            number("/deviations").map_or(String::new(), |d| format!(", {d:.1} of its standard deviations"));
        text.say("reference", &format!("{}: {off:.1e} off{deviations}", one.name));
        return;
    }
    let Some(all) = number("/fraction_right") else { return };
    let of_ok = number("/fraction_right_of_ok").map_or(String::new(), |f| format!(", {} of ok", percent(f)));
    let off = match number("/deviation/max_ok") {
        Some(off) if all < 1.0 => format!("; off by at most {off:.1e} where ok"),
        _ => String::new(),
    };
    let who = if identify.unknowns.len() == 1 { String::new() } else { format!("{}: ", one.name) };
    let within = number("/within").map_or(String::new(), |within| format!("; within {within:e}"));
    let sentence = format!("{who}{} of all{of_ok} (the reference is known{within}{off})", percent(all));
    text.say("right", &sentence);
}

fn work(text: &mut Text, job: &IdentifyJob) {
    let found = &job.run.found;
    let (work, seconds) = (&found.search.work, job.run.seconds.identify());
    text.say(
        "work",
        &format!("{} factorisations, {} solves, {seconds:.2} s", work.factorisations, work.solves),
    );
    if job.case.model.analysis().is_single_precision() {
        text.say(
            "memory",
            "factors in single precision, since those in double do not fit: half the memory, more time",
        );
    }
    if let (Some(size), Some(error)) = (found.search.reduced_size, found.reduction_error()) {
        let sentence = format!("{size} vectors, error of the response at most {error:.1e} (estimated)");
        text.say("subspace", &sentence);
    }
    if let Some(curve) = &found.curve {
        smooth(text, curve);
    }
}

fn smooth(text: &mut Text, curve: &SmoothCurve) {
    let SmoothCurve { parameters, width_octaves, .. } = curve;
    let settled = if curve.converged { "" } else { ", not settled" };
    let odd = match curve.outliers {
        0 => String::new(),
        count => format!("; {count} frequencies that it does not explain have no say in it"),
    };
    let sentence = format!("{parameters:.1} parameters, one for {width_octaves:.2} octaves{settled}{odd}");
    text.add(!curve.converged || curve.outliers > 0, "smooth", &sentence);
}

fn wrote(text: &mut Text, job: &IdentifyJob, identify: &IdentifyCase, out: &Path) {
    let free = if job.run.found.free.is_empty() { "" } else { "free.csv, " };
    let law = if identify.is_law() { "law.json, " } else { "" };
    let sentence = format!(
        "{}: identified.csv, {free}{law}candidates.csv, response.csv, updated.uff, summary.json, figures/, report.html",
        out.display()
    );
    text.say("wrote", &sentence);
}

/// The errors of the model for which the values are corrected, and which are in their error bars.
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
    let masses = job.case.sensors.iter().zip(&errors.masses).filter(|(_, one)| one.mass > 2.0 * one.std);
    let masses = masses.map(|(sensor, one)| {
        format!("; {} carries {:.1e} ± {:.1e} kg that the model lacks", sensor.label, one.mass, one.std)
    });
    let channels = std::iter::once("the force").chain(job.case.sensors.iter().map(|sensor| &*sensor.label));
    let calibrations = channels.zip(&errors.calibrations).filter(|(_, one)| one.error.abs() > 2.0 * one.std);
    let calibrations = calibrations.map(|(channel, one)| {
        format!(
            "; the calibration of {channel} is off by {:+.1} ± {:.1} %",
            100.0 * one.error,
            100.0 * one.std
        )
    });
    let mesh = errors.mesh.map(|mesh| {
        format!(
            "; {} modes are paired with the coarser mesh, and this one has {:.2} ± {:.2} of the difference between the meshes",
            mesh.paired, mesh.remainder, mesh.std
        )
    });
    let known = mesh.into_iter().chain(known).chain(masses).chain(calibrations).collect::<String>();
    format!("{sizes} corrected for, and in the error bars{}{known}", worst.unwrap_or_default())
}

/// What an unknown is called.
fn unknown_name(job: &IdentifyJob, unknown: usize) -> Option<&str> {
    Some(job.identify()?.unknowns.get(unknown)?.name.as_str())
}

/// The known factors of which an error moves an unknown by more than itself, the worst first, and the mesh where it moves one by more than it does a modulus alone.
fn leverage(job: &IdentifyJob) -> Option<String> {
    let is_large = |one: &&Leverage| one.change > one.of.large();
    let mut large: Vec<&Leverage> = job.run.found.leverage.iter().filter(is_large).collect();
    large.sort_by(|a, b| (b.change / b.of.large()).total_cmp(&(a.change / a.of.large())));
    let one = |one: &&Leverage| {
        let unknown = unknown_name(job, one.unknown).unwrap_or("the factor");
        match one.of {
            LeverageOf::Factor(term) => {
                format!("1 % in {} moves {unknown} by {:.1} %", job.case.model.terms()[term].name, one.change)
            }
            LeverageOf::Mesh => format!(
                "a mesh with natural frequencies 1 % high at the end of the band moves {unknown} there by {:.1} %",
                one.change
            ),
        }
    };
    // The largest two, of which the mesh is one where it is large: its error is the one that no FRF shows.
    let mesh = large.iter().position(|one| one.of == LeverageOf::Mesh);
    if let Some(mesh) = mesh.filter(|at| *at > 1) {
        large.swap(1, mesh);
    }
    large.truncate(2);
    let said: Vec<String> = large.iter().map(one).collect();
    (!said.is_empty()).then(|| said.join("; "))
}

/// Where moduli are those of no causal material.
fn breaches(job: &IdentifyJob) -> Vec<String> {
    let one = |breach: &CausalityBreach| {
        let unknown = unknown_name(job, breach.unknown).unwrap_or("the modulus");
        let [from, to] = breach.range_hz;
        format!(
            "{unknown} is not the modulus of a causal material at {from:.0} to {to:.0} Hz: it falls, or rises faster than its loss factor allows"
        )
    };
    job.run.found.causality_breaches.iter().map(one).collect()
}

/// Of which unknowns the nominal values are far off, and by how much.
fn far_nominals(factors: &[f64], identify: &IdentifyCase) -> Option<String> {
    let far = identify.unknowns.iter().zip(factors).filter(|(_, factor)| **factor != 1.0);
    let each: Vec<String> =
        far.map(|(one, factor)| format!("{factor:.2} times that of {}", one.name)).collect();
    (!each.is_empty()).then(|| {
        format!(
            "far off: the measured natural frequencies are those of {}, and the search began there",
            each.join(", ")
        )
    })
}

/// What was found of channels whose scale or delay was unknown.
fn channels(text: &mut Text, job: &IdentifyJob, identify: &IdentifyCase) {
    let all = job.case.sensors.iter().zip(&identify.channels).zip(&job.run.found.channels);
    for ((sensor, unknown), found) in all {
        let mut add = |label, found: Option<Calibrated>, what: &str| match found {
            Some(Calibrated { value, std }) => {
                let std = std.map_or(String::new(), |std| format!(" ± {std:.1e}"));
                text.say(label, &format!("{value:.6e}{std} {what}, at {}", sensor.label));
            }
            None => text.warn(label, &format!("not identifiable, at {}: left out", sensor.label)),
        };
        if unknown.scale {
            add("scale", found.scale, "times what the file says");
        }
        if unknown.delay {
            add("delay", found.delay_s, "s late");
        }
    }
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
