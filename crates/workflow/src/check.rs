//! What is wrong with a case's data, in words, with the key of the case file to change.

use crate::error::{InputError, Place};
use crate::job_error::JobError;
use crate::load::{Case, IdentifyCase, Overrides, Purpose, load};
use crate::memory::fit_identify;
use crate::output::{Words, corrections_json, corrections_text};
use crate::run::{Used, in_parallel, problem_of, reduced_of};
use crate::units::UnitSystem;
use frfit::diagnostics::{
    Depth, Diagnosis, Evidence, Fault, KNOWN_FACTOR_RTOL, KnownFactor, MIN_MARGIN_NATS, NotJudged,
    OtherExplanation, OtherRow, diagnose_on,
};
use frfit::identify::{ChannelUnknowns, Problem, ProblemError, ReducedBand};
use frfit::quantity::Quantity;
use serde_json::{Value, json};
use std::path::Path;

/// A finding as a person reads it.
#[derive(Debug, Clone, PartialEq)]
pub struct FindingText {
    /// A word for programs: `conjugated`, `sign`, `quantity`, `factor`, `delay`, `response_dof`, `load_dof`, `axis`, `nominal`, `no_signal`, `mesh`.
    pub kind: &'static str,
    /// The sensors' labels; empty where it is no matter of sensors.
    pub sensors: Vec<String>,
    /// What is wrong.
    pub what: String,
    /// The numbers that say so.
    pub evidence: String,
    /// The key of the case file, and the change to make.
    pub change: String,
}

/// A case whose data were looked at.
#[derive(Debug)]
pub struct CheckJob {
    /// The case.
    pub case: Case,
    /// What came of it.
    pub diagnosis: Diagnosis,
}

impl CheckJob {
    /// What `frfit check --json` prints.
    pub fn json(&self) -> Value {
        let [window, shifts, cut_off] = corrections_json(self.case.corrections());
        json!({
            "title": self.case.title,
            "window": window,
            "frequency_shifts": shifts,
            "cut_off": cut_off,
            "findings": findings_json(&self.case, &self.diagnosis),
            "other_explanations": others_json(&self.case, &self.diagnosis),
            "misfit": self.diagnosis.misfit,
            "not_judged": self.diagnosis.not_judged.map(not_judged),
            "frequencies": self.diagnosis.frequencies,
        })
    }

    /// Whether no fault was found, and no other explanation is as likely.
    pub fn is_clean(&self) -> bool {
        self.diagnosis.findings.is_empty() && self.diagnosis.others.is_empty()
    }
}

/// Loads a case and looks for what is wrong with its data; nothing is written.
///
/// # Errors
/// [`JobError`]: as an identification of this case would be refused.
pub fn check_case(
    case_file: &Path,
    overrides: &Overrides,
    memory_bytes: Option<u64>,
) -> Result<CheckJob, JobError> {
    check_loaded(load(case_file, overrides, Purpose::Identify)?, memory_bytes)
}

/// The same of a case that was loaded, or made of arrays.
///
/// # Errors
/// [`JobError`], also where the case has nothing to identify.
pub fn check_loaded(mut case: Case, memory_bytes: Option<u64>) -> Result<CheckJob, JobError> {
    fit_identify(&mut case, memory_bytes)?;
    let Some(wanted) = &case.identify else {
        return Err(InputError::at(&Place::option("case"), "something to identify", "none").into());
    };
    let used = Used::of(wanted);
    let problem = problem_of(&case, wanted, &used)?;
    let mut reduced = reduced_of(&case, wanted, &problem)?;
    let diagnosis = check_on(&mut reduced, Depth::Full, &problem, &case, wanted)?;
    Ok(CheckJob { case, diagnosis })
}

/// Looks for what is wrong with a case's data, as far as is asked, on the reduced model with which the case is identified. It runs on all cores; the result does not depend on
/// their number.
///
/// # Errors
/// [`ProblemError`] where the case has a fault that was not seen when it was loaded.
pub(crate) fn check_on<'a>(
    reduced: &mut ReducedBand<'a>,
    depth: Depth,
    problem: &'a Problem<'a>,
    case: &Case,
    identify: &IdentifyCase,
) -> Result<Diagnosis, ProblemError> {
    let diagnosis = diagnose_on(reduced, depth, problem, &quantities(case), &identify.options, &in_parallel)?;
    Ok(without_looked_for(identify, diagnosis))
}

fn quantities(case: &Case) -> Vec<Quantity> {
    case.sensors.iter().map(|sensor| sensor.quantity).collect()
}

/// Without the unknowns of the identification itself: a real factor or a delay.
fn without_looked_for(identify: &IdentifyCase, mut diagnosis: Diagnosis) -> Diagnosis {
    let is_looked_for = |fault: &Fault, sensors: &[usize]| {
        let real = matches!(fault, Fault::Factor { .. } | Fault::Sign);
        let late = matches!(fault, Fault::Delay { .. });
        let looked_for = |unknown: ChannelUnknowns| (real && unknown.scale) || (late && unknown.delay);
        let channel = |&m: &usize| identify.channels.get(m).copied().unwrap_or_default();
        sensors.iter().map(channel).all(looked_for)
    };
    diagnosis.findings.retain(|finding| !is_looked_for(&finding.fault, &finding.sensors));
    diagnosis
        .others
        .retain(|other| !other.faults.iter().all(|(fault, sensors)| is_looked_for(fault, sensors)));
    diagnosis
}

/// The findings in words.
pub fn finding_texts(case: &Case, diagnosis: &Diagnosis) -> Vec<FindingText> {
    let text = |finding: &frfit::diagnostics::Finding| {
        let (kind, what, change) = words(case, &finding.fault, &finding.sensors);
        let own = finding.evidence.as_ref().map_or(String::new(), numbers);
        let evidence = [more_numbers(&finding.fault), own].into_iter().filter(|text| !text.is_empty());
        let evidence = evidence.collect::<Vec<_>>().join("; ");
        FindingText { kind, sensors: labels(case, &finding.fault, &finding.sensors), what, evidence, change }
    };
    diagnosis.findings.iter().map(text).collect()
}

/// The sensors that a fault concerns; none where it is no matter of sensors.
fn labels(case: &Case, fault: &Fault, sensors: &[usize]) -> Vec<String> {
    match fault {
        Fault::Mesh { .. } | Fault::LoadDof { .. } | Fault::Axis { .. } | Fault::Nominal { .. } => Vec::new(),
        _ => sensors.iter().map(|&m| case.sensors[m].label.clone()).collect(),
    }
}

/// Kind, what is wrong, and what to change.
fn words(case: &Case, fault: &Fault, sensors: &[usize]) -> (&'static str, String, String) {
    let is_of_arrays = case.first_number == 0;
    let measurements = match sensors {
        [m] => case.measurement_name(*m),
        _ if is_of_arrays => "every measurement".to_owned(),
        _ => "every [[measurement]]".to_owned(),
    };
    match fault {
        Fault::Conjugated => (
            "conjugated",
            "the FRF is the complex conjugate (time convention e^(-iωt)): loss factors would be negative"
                .to_owned(),
            match is_of_arrays {
                true => format!("response of {measurements}: its complex conjugate"),
                false => format!("file of {measurements}: change the sign of its imaginary part"),
            },
        ),
        Fault::Sign => (
            "sign",
            "the FRF has the opposite sign".to_owned(),
            match sensors {
                [_] if is_of_arrays => format!("sign of {measurements} (or of load): the opposite one"),
                _ if is_of_arrays => "load: the opposite sign".to_owned(),
                [_] => {
                    format!("dof of {measurements} (or of [load]): the opposite sense, as in 34-Z for 34+Z")
                }
                _ => "dof of [load]: the opposite sense, as in 34-Z for 34+Z".to_owned(),
            },
        ),
        Fault::Quantity { taken_for, is, .. } => (
            "quantity",
            format!("{is} is taken for {taken_for}"),
            format!("quantity of {measurements}: \"{is}\""),
        ),
        Fault::Factor { factor, known, relative_std } => (
            "factor",
            match known {
                Some(known) => {
                    format!("the FRF is {} times what it should be: {}", number(*factor), unit(*known))
                }
                None => format!(
                    "the FRF is {} times what it should be, by a factor without a name",
                    number(*factor)
                ),
            },
            {
                // The number that has a name, in place of the one that was measured.
                let scale = 1.0 / known.map_or(*factor, KnownFactor::value);
                match sensors {
                    // Where other sensors are right, the model is in the units that the case says.
                    [_] if case.sensors.len() > 1 => format!(
                        "scale of {measurements}: times {}, or units and sensitivity of its file; SI is expected",
                        number(scale)
                    ),
                    _ => format!(
                        "scale of {measurements}: times {}, or units and the hammer's sensitivity in their files; SI is expected. Or {}",
                        number(scale),
                        of_the_model(case.units, *factor, *relative_std)
                    ),
                }
            },
        ),
        Fault::Delay { seconds, .. } => (
            "delay",
            match *seconds > 0.0 {
                true => format!(
                    "the response is late by {} s: its phase falls in proportion to frequency",
                    number(*seconds)
                ),
                false => format!(
                    "the response is early by {} s: its phase rises in proportion to frequency",
                    number(-seconds)
                ),
            },
            format!("delay_s of {measurements}: {} (filters, triggers)", number(*seconds)),
        ),
        Fault::ResponseDof { rows } => {
            let sensor = sensors.first().map_or("", |&m| case.sensors[m].label.as_str());
            let what =
                format!("the response was not measured at {sensor}: {} would explain it", listed(case, rows));
            let key = if is_of_arrays { "row" } else { "dof (or row)" };
            ("response_dof", what, format!("{key} of {measurements}"))
        }
        Fault::LoadDof { rows } => {
            let load = if is_of_arrays { "load" } else { "[load]" };
            let what = format!(
                "the structure was not driven where {load} says: {} would explain it",
                listed(case, rows)
            );
            ("load_dof", what, if is_of_arrays { load.to_owned() } else { format!("dof (or row) of {load}") })
        }
        Fault::Axis { factor } => (
            "axis",
            match *factor > 1.0 {
                true => "the frequencies are 2π times what they should be: rad/s taken for Hz".to_owned(),
                false => "the frequencies are 1/2π of what they should be: Hz taken for rad/s".to_owned(),
            },
            "the frequency column (or axis) of the measured files; then identify.band_hz".to_owned(),
        ),
        Fault::Nominal { ratio } => (
            "nominal",
            format!("the nominal value is far off: about {} times as large would explain the data", number(*ratio)),
            "factor of the unknown matrices (Pa, or relative to what is in the file), or bounds of [identify]".to_owned(),
        ),
        Fault::NoSignal => (
            "no_signal",
            "the channel shows nothing: at most 1e-9 of what another one shows; it is left out".to_owned(),
            format!("cable and channel of {measurements}, or take it out of the case"),
        ),
        Fault::Mesh { row_hz, top_hz } => (
            "mesh",
            format!(
                "the band goes up to {} Hz, where the mesh is too coarse: the natural frequency of a single row, all others held, is {} Hz",
                number(*top_hz),
                number(*row_hz)
            ),
            format!(
                "upper end of identify.band_hz: below {} Hz; or matrices of a finer mesh",
                number(0.5 * row_hz)
            ),
        ),
    }
}

/// The key that says in which units the model is, with the system in which it would agree, where there is one.
fn of_the_model(units: UnitSystem, factor: f64, relative_std: f64) -> String {
    let off = |system: UnitSystem| Some((factor / units.measured_over_model(system)?).ln().abs());
    let near =
        |system: &UnitSystem| off(*system).is_some_and(|off| off <= KNOWN_FACTOR_RTOL + 3.0 * relative_std);
    let others = UnitSystem::ALL.into_iter().filter(|system| *system != units).filter(near);
    let named: Vec<String> = others.map(|system| format!("{:?}", system.name())).collect();
    match named.as_slice() {
        [] => format!("units of the case (now {:?})", units.name()),
        named => format!("units = {} of the case (now {:?})", named.join(" or "), units.name()),
    }
}

/// The best row first, then those that cannot be distinguished from it.
fn listed(case: &Case, rows: &[OtherRow]) -> String {
    let names: Vec<String> = rows.iter().map(|other| case.row_name(other.row)).collect();
    match names.as_slice() {
        [best, others @ ..] if !others.is_empty() => {
            format!("{best} (or, indistinguishable from it, {})", others.join(", "))
        }
        names => names.join(", "),
    }
}

fn unit(known: KnownFactor) -> &'static str {
    match known {
        KnownFactor::StandardGravity => "9.80665, g made m/s² twice, or kilogram-force taken for newtons",
        KnownFactor::PerStandardGravity => "1/9.80665, values in g taken for m/s²",
        KnownFactor::Thousand => "1e3, millimetres taken for metres, or kilonewtons taken for newtons",
        KnownFactor::Thousandth => "1e-3, metres taken for millimetres, or newtons taken for kilonewtons",
        KnownFactor::Million => "1e6, micrometres taken for metres",
        KnownFactor::Millionth => "1e-6, metres taken for micrometres",
        KnownFactor::GravityInMillimetres => "9806.65, g and millimetres",
        KnownFactor::PerGravityInMillimetres => "1/9806.65, g and millimetres",
        KnownFactor::InchesPerMetre => "39.37, inches taken for metres",
        KnownFactor::MetresPerInch => "0.0254, metres taken for inches",
        KnownFactor::PoundForce => "4.448, a force in pounds taken for newtons",
        KnownFactor::PerPoundForce => "1/4.448, a force in newtons taken for pounds",
        KnownFactor::GravityInInches => "386.1, g and inches",
        KnownFactor::PerGravityInInches => "1/386.1, g and inches",
        KnownFactor::TwoPi => "2π, a value per Hz taken for one per rad/s",
        KnownFactor::PerTwoPi => "1/2π, a value per rad/s taken for one per Hz",
    }
}

/// What a fault's own numbers say.
fn more_numbers(fault: &Fault) -> String {
    match fault {
        Fault::Quantity { slope, slope_std, .. } if slope.is_finite() => {
            format!("|measured/model| goes like ω^{slope:.2} ± {slope_std:.2}")
        }
        Fault::Factor { factor, relative_std, .. } if *relative_std > 0.0 => {
            format!("factor {} ± {:.1} %", number(*factor), 100.0 * relative_std)
        }
        Fault::Delay { seconds, std } => format!("delay {} ± {:.0e} s", number(*seconds), std),
        _ => String::new(),
    }
}

fn numbers(evidence: &Evidence) -> String {
    let Evidence { before, after, nats, margin } = evidence;
    let other = match margin {
        Some(margin) => format!("{margin:.0} nats to the best other explanation"),
        None => "nothing else explains it".to_owned(),
    };
    format!(
        "misfit of ln(measured/model) {before:.2} before, {after:.2} after; log-likelihood ratio {nats:.0} nats; {other}"
    )
}

/// Four digits.
fn number(value: f64) -> String {
    let shown = format!("{value:.3e}").parse::<f64>().unwrap_or(value);
    if (1e-3..1e5).contains(&shown.abs()) { format!("{shown}") } else { format!("{shown:e}") }
}

/// Why data were not judged, in words.
pub fn not_judged(reason: NotJudged) -> &'static str {
    match reason {
        NotJudged::Parameter => "no unknown factor has a positive real part to begin with",
        NotJudged::FewValues => "too few values",
        _ => "no reduced model of the band could be made",
    }
}

/// `findings` of `summary.json`.
pub fn findings_json(case: &Case, diagnosis: &Diagnosis) -> Value {
    let evidence = |k: usize| {
        diagnosis.findings[k].evidence.as_ref().map(|e| {
            json!({
                "misfit_before": e.before, "misfit_after": e.after, "nats": e.nats, "margin_nats": e.margin,
            })
        })
    };
    let own = |k: usize| match &diagnosis.findings[k].fault {
        Fault::Quantity { taken_for, is, slope, slope_std } => json!({
            "taken_for": taken_for.name(), "is": is.name(),
            "slope": Some(slope).filter(|s| s.is_finite()), "slope_std": Some(slope_std).filter(|s| s.is_finite()),
        }),
        Fault::Factor { factor, relative_std, known } => json!({
            "factor": factor, "relative_std": relative_std, "known": known.map(|known| known.value()),
        }),
        Fault::Delay { seconds, std } => json!({"seconds": seconds, "std": std}),
        Fault::ResponseDof { rows } | Fault::LoadDof { rows } => {
            let one = |other: &OtherRow| json!({"row": case.row_number(other.row), "dof": case.row_name(other.row), "misfit": other.misfit});
            json!({"candidates": rows.iter().map(one).collect::<Vec<_>>()})
        }
        Fault::Mesh { row_hz, top_hz } => json!({"row_hz": row_hz, "top_hz": top_hz}),
        Fault::Axis { factor } => json!({"factor": factor}),
        Fault::Nominal { ratio } => json!({"ratio": ratio}),
        Fault::Conjugated | Fault::Sign | Fault::NoSignal => json!({}),
    };
    let findings = finding_texts(case, diagnosis).into_iter().enumerate().map(|(k, finding)| {
        json!({
            "kind": finding.kind, "sensors": finding.sensors, "what": finding.what, "change": finding.change,
            "numbers": own(k), "evidence": evidence(k),
        })
    });
    Value::from(findings.collect::<Vec<_>>())
}

/// `other_explanations` of `summary.json`.
pub fn others_json(case: &Case, diagnosis: &Diagnosis) -> Value {
    let fault = |(fault, sensors): &(Fault, Vec<usize>)| {
        let (kind, what, _) = words(case, fault, sensors);
        json!({"kind": kind, "sensors": labels(case, fault, sensors), "what": what})
    };
    let one = |other: &OtherExplanation| {
        let faults: Vec<Value> = other.faults.iter().map(fault).collect();
        json!({"faults": faults, "misfit": other.misfit, "nats_behind": other.nats_behind})
    };
    diagnosis.others.iter().map(one).collect()
}

/// The faults of an explanation in words.
pub fn faults_text(case: &Case, other: &OtherExplanation) -> Vec<String> {
    let said = |(fault, sensors): &(Fault, Vec<usize>)| {
        let who = labels(case, fault, sensors).join(", ");
        let what = words(case, fault, sensors).1;
        if who.is_empty() { what } else { format!("{who}: {what}") }
    };
    other.faults.iter().map(said).collect()
}

/// The explanations between which the data do not decide, a few lines each.
fn undecided_text(case: &Case, others: &[OtherExplanation]) -> String {
    let mut text = format!(
        "  {:<18}one of these would explain the data; too few nats are between them ({MIN_MARGIN_NATS} for each fault):\n",
        "not decided"
    );
    for other in others {
        let faults = faults_text(case, other);
        let left = format!("(misfit {:.2}, {:.1} nats behind)", other.misfit, other.nats_behind);
        text += &format!("  {:<18}- {} {left}\n", "", faults.join("; and "));
    }
    text
}

/// The findings for a person, a few lines each; without any, one line that says how well the data agree with the model.
pub fn findings_text(case: &Case, diagnosis: &Diagnosis) -> String {
    let mut text = String::new();
    for finding in finding_texts(case, diagnosis) {
        let who = if finding.sensors.is_empty() {
            String::new()
        } else {
            format!("{}: ", finding.sensors.join(", "))
        };
        text += &format!("  {:<18}{who}{}\n", finding.kind, finding.what);
        if !finding.evidence.is_empty() {
            text += &format!("  {:<18}{}\n", "", finding.evidence);
        }
        text += &format!("  {:<18}change: {}\n", "", finding.change);
    }
    let is_decided = diagnosis.findings.iter().any(|finding| finding.evidence.is_some());
    if !is_decided && !diagnosis.others.is_empty() {
        text += &undecided_text(case, &diagnosis.others);
    }
    text
}

/// What `frfit check` says.
pub fn check_text(job: &CheckJob) -> Words {
    let CheckJob { case, diagnosis } = job;
    let mut words = Words::default();
    words.say(&format!("{}: {} frequencies of the band looked at\n", case.title, diagnosis.frequencies));
    for (is_warning, label, text) in corrections_text(case.corrections()) {
        words.add(is_warning, &format!("  {label:<18}{text}\n"));
    }
    words.warn(&findings_text(case, diagnosis));
    match (diagnosis.not_judged, diagnosis.misfit) {
        (Some(reason), _) => words.warn(&format!("  not judged        {}\n", not_judged(reason))),
        (None, Some(misfit)) => {
            let left = format!("ln(measured/model) is left with {misfit:.2} by the likeliest modulus");
            let (label, end) = match (diagnosis.findings.is_empty(), misfit > LARGE_MISFIT) {
                (true, false) => ("no finding", ""),
                (true, true) if diagnosis.others.is_empty() => ("no finding", NO_FAULT_EXPLAINS_THEM),
                (true, true) => ("no finding", ": that is much"),
                (false, false) => ("left", ""),
                (false, true) => ("left", ": that is much, and no other fault that frfit knows explains it"),
            };
            words.add(misfit > LARGE_MISFIT, &format!("  {label:<18}{left}{end}\n"));
        }
        (None, None) => {}
    }
    words
}

/// Of data that nothing explains, with the way on.
const NO_FAULT_EXPLAINS_THEM: &str = ": that is much. The data do not fit the model, and no single or double fault explains it; \
                                 `frfit modes` shows natural frequencies and shapes of both side by side";

/// A misfit beyond this is more than noise from which a modulus can be identified: a factor of 1.3, or 17 degrees.
const LARGE_MISFIT: f64 = 0.3;
