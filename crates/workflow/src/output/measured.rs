//! The FRF of a hammer test as UFF or table, and its summary.

use super::words::Words;
use crate::convert::{companion, frf_dataset, windowed};
use crate::load::{InputFile, decay_line};
use crate::records::{Records, Sensor};
use crate::terminal::short;
use frfit::dof::DofName;
use frfit::signal::{Channel, Fault, Frf, Impact, Measured, Options, added_loss_factor, decaying_within};
use frfit_formats::FormatError;
use frfit_formats::csv::{Cell, write};
use frfit_formats::uff::{Dof, Form, FunctionHeader, FunctionType, Units, write as uff};
use serde_json::{Value, json};

/// Share of the force's largest spectral value down to which a frequency counts as excited: 20 dB.
const EXCITED: f64 = 0.1;

/// Units; of each sensor the FRF, its coherence and its standard deviation. The third ID line has the decay rate of an exponential window, `decay_per_s = 6`, in 1/s.
///
/// # Errors
/// A degree of freedom that does not fit its columns.
pub fn measured_uff(records: &Records, measured: &Measured, title: &str) -> Result<Vec<u8>, FormatError> {
    let mut bytes = uff::units(&Units::default())?;
    let averages = measured.averages();
    for ((number, sensor), frf) in (1..).zip(&records.responses).zip(&measured.frfs) {
        let header = FunctionHeader {
            id: [
                title.chars().filter(|c| !c.is_control()).take(80).collect(),
                format!("Hammer test, {averages} impacts averaged, {:.6} s each", length_s(measured)),
                measured.added_decay_per_s.map(decay_line).unwrap_or_default(),
                String::new(),
                String::new(),
            ],
            function_id: number,
            response: dof(sensor.dof)?,
            reference: dof(records.force.dof)?,
            ..FunctionHeader::default()
        };
        let (frequency_hz, form) = (&measured.frequency_hz, Form::Ascii);
        let values = frf.response.clone();
        bytes.extend(frf_dataset(frequency_hz, values, header.clone(), sensor.quantity(), form)?);
        let companions =
            [(FunctionType::Coherence, frf.coherence.clone()), (FunctionType::General, std(frf))];
        for (function_type, values) in companions {
            if let Some(values) = values {
                bytes.extend(companion(frequency_hz, values, header.clone(), function_type, form)?);
            }
        }
    }
    Ok(bytes)
}

/// Columns frequency_hz, re, im, and of more than one impact coherence and std, of the first sensor: a table has one FRF. A comment line before them has the
/// decay rate of an exponential window, `# decay_per_s = 6`, in 1/s.
///
/// `std` is √E|δH|² of the complex value, √2 times that of its real and imaginary parts (B-6).
pub fn measured_csv(measured: &Measured) -> String {
    let Some(frf) = measured.frfs.first() else { return String::new() };
    let std = std(frf);
    let optional: Vec<(&str, &Vec<f64>)> = [("coherence", &frf.coherence), ("std", &std)]
        .into_iter()
        .filter_map(|(n, v)| Some((n, v.as_ref()?)))
        .collect();
    let columns: Vec<&str> =
        ["frequency_hz", "re", "im"].into_iter().chain(optional.iter().map(|(name, _)| *name)).collect();
    let rows = measured.frequency_hz.iter().zip(&frf.response).enumerate().map(|(k, (&f, value))| {
        let more = optional.iter().map(|(_, values)| values[k]);
        [f, value.re, value.im].into_iter().chain(more).map(Cell::from).collect::<Vec<_>>()
    });
    windowed(measured.added_decay_per_s, write(&columns, rows).expect("every row has the columns"))
}

/// √E|δH|²: √2 times the standard deviation of either part.
fn std(frf: &Frf) -> Option<Vec<f64>> {
    let std = |variance: &f64| (2.0 * variance).sqrt();
    // A line without any coherence has no finite variance: as uncertain as a number can be.
    frf.variance.as_ref().map(|values| values.iter().map(std).map(|std| std.min(f64::MAX.sqrt())).collect())
}

fn dof(name: Option<DofName>) -> Result<Dof, FormatError> {
    let Some(name) = name else { return Ok(Dof::default()) };
    let node = i64::try_from(name.node)
        .map_err(|_| FormatError::whole("a node of at most ten digits", name.to_string()))?;
    Ok(Dof { node, direction: name.uff_direction(), ..Dof::default() })
}

fn length_s(measured: &Measured) -> f64 {
    measured.samples as f64 * measured.step_s
}

/// The name of a channel as its file has it.
fn channel_name(records: &Records, channel: Channel) -> &str {
    match channel {
        Channel::Force => &records.force.name,
        Channel::Response(k) => records.responses.get(k).map_or("", |sensor| &sensor.name),
    }
}

/// A fault in words, with the name of its channel.
fn reason(records: &Records, fault: &Fault) -> String {
    fault.describe(fault.channel().map_or("", |channel| channel_name(records, channel)))
}

/// Every impact with what speaks against it, in one line.
pub fn impact_reasons(records: &Records, impacts: &[Impact]) -> String {
    let of = |(k, impact): (usize, &Impact)| {
        let reasons: Vec<String> = impact.faults.iter().map(|fault| reason(records, fault)).collect();
        format!("impact {}: {}", k + 1, reasons.join(", "))
    };
    impacts.iter().enumerate().map(of).collect::<Vec<_>>().join("; ")
}

/// What the user ought to know that is no fault of a single impact.
fn warnings(records: &Records, measured: &Measured) -> Vec<String> {
    let mut warnings = Vec::new();
    for (k, sensor) in records.responses.iter().enumerate() {
        let kept = measured.impacts.iter().filter(|impact| impact.is_kept());
        let rest = kept.filter_map(|impact| impact.undecayed(k)).reduce(f64::max);
        if let Some(rest) = rest.filter(|_| measured.added_decay_per_s.is_none()) {
            warnings.push(format!(
                "{} has not decayed: {:.1} % of its largest value is left at the end of the record and wraps around \
                 (record longer, or use --exponential-window {:.1e}: it leaves at most 0.1 %, and frfit identify takes it into the model)",
                sensor.name,
                100.0 * rest,
                decaying_within(measured.samples as f64 * measured.step_s)
            ));
        }
    }
    if measured.averages() == 1 {
        warnings.push("a single impact: no coherence, and no estimate of the noise".to_owned());
    }
    let excited = excited_to_hz(measured);
    if let (Some(excited), Some(last)) = (excited, measured.frequency_hz.last())
        && excited < *last
    {
        warnings.push(format!(
            "the hammer excites up to {excited:.0} Hz (a tenth of its largest spectral value); beyond, noise counts more"
        ));
    }
    if let (Some(decay), Some(first)) = (measured.added_decay_per_s, measured.frequency_hz.first()) {
        warnings.push(format!(
            "the exponential window's decay_per_s = {decay:.4} belongs to the FRF, and frfit identify takes it into the model; \
             another program would see it as a loss factor of {:.4} at {first:.1} Hz, less in proportion above",
            added_loss_factor(decay, *first)
        ));
    }
    warnings
}

/// The first frequency from which on the force stays below a tenth of its largest spectral value, or else the last one.
fn excited_to_hz(measured: &Measured) -> Option<f64> {
    let most = measured.force.iter().copied().fold(0.0, f64::max);
    let past = measured.force.iter().position(|&force| force < EXCITED * most);
    past.map_or(measured.frequency_hz.last(), |k| measured.frequency_hz.get(k)).copied()
}

/// Everything about the impacts and the FRF but its values.
pub fn measured_summary(records: &Records, measured: &Measured, options: &Options) -> Value {
    let inputs = InputFile::json(&records.inputs);
    let impact = |(k, impact): (usize, &Impact)| impact_json(k + 1, impact, records, measured);
    let coherence = |frf: &Frf| {
        let excited = excited_to_hz(measured).unwrap_or(0.0);
        let mut values: Vec<f64> = (measured.frequency_hz.iter())
            .zip(frf.coherence.iter().flatten())
            .filter(|(f, _)| **f <= excited)
            .map(|(_, coherence)| *coherence)
            .collect();
        values.sort_by(f64::total_cmp);
        values.get(values.len() / 2).copied()
    };
    let responses = records.responses.iter().zip(&measured.frfs).map(|(sensor, frf)| {
        let mut object = sensor_json(sensor);
        object["quantity"] = json!(sensor.quantity().name());
        object["coherence_median_excited"] = json!(coherence(frf));
        object
    });
    json!({
        "frfit": env!("CARGO_PKG_VERSION"),
        "inputs": inputs,
        "force": sensor_json(&records.force),
        "responses": responses.collect::<Vec<_>>(),
        "step_s": measured.step_s,
        "samples": measured.samples,
        "length_s": length_s(measured),
        "estimator": options.estimator.name(),
        "windows": {
            "force_s": options.windows.force_s,
            "exponential_s": options.windows.exponential_s,
            "added_decay_per_s": measured.added_decay_per_s,
        },
        "impacts": measured.impacts.iter().enumerate().map(impact).collect::<Vec<_>>(),
        "found": measured.impacts.len(),
        "averages": measured.averages(),
        "frequencies": measured.frequency_hz.len(),
        "range_hz": [measured.frequency_hz.first(), measured.frequency_hz.last()],
        "excited_to_hz": excited_to_hz(measured),
        "warnings": warnings(records, measured),
    })
}

fn impact_json(number: usize, impact: &Impact, records: &Records, measured: &Measured) -> Value {
    let fault = |fault: &Fault| {
        json!({
            "fault": fault.name(),
            "channel": fault.channel().map(|channel| channel_name(records, channel)),
            "reason": reason(records, fault),
        })
    };
    json!({
        "impact": number,
        "file": records.origins.get(impact.recording).map(|path| path.display().to_string()),
        "recording": impact.recording + 1,
        "first_sample": impact.range.start,
        "samples": impact.range.len(),
        "time_s": impact.onset as f64 * measured.step_s,
        "peak_n": impact.peak_n,
        "contact_s": impact.contact_s(measured.step_s),
        "kept": impact.is_kept(),
        "faults": impact.faults.iter().map(fault).collect::<Vec<_>>(),
        "residual": impact.residual,
        "noise": impact.noise,
    })
}

fn sensor_json(sensor: &Sensor) -> Value {
    json!({
        "channel": sensor.name,
        "dof": sensor.dof.map(|dof| dof.to_string()),
        "unit": sensor.kind.unit(),
        "si_units_per_unit_of_file": sensor.scale,
    })
}

/// The impacts, the FRF and the warnings in a few lines.
pub fn measured_text(records: &Records, measured: &Measured, options: &Options) -> Words {
    let mut words = Words::default();
    words.say(&format!(
        "{} found, {} averaged, {} samples each ({} s at {} Hz)\n",
        plural(measured.impacts.len(), "impact"),
        measured.averages(),
        measured.samples,
        short(length_s(measured)),
        short(1.0 / measured.step_s),
    ));
    for (number, impact) in (1..).zip(&measured.impacts) {
        let reasons: Vec<String> = impact.faults.iter().map(|fault| reason(records, fault)).collect();
        let (verdict, reasons) = match (impact.is_kept(), reasons.is_empty()) {
            (true, true) => ("averaged", String::new()),
            (true, false) => ("averaged", format!("  as asked, although: {}", reasons.join("; "))),
            (false, _) => ("left out", format!("  {}", reasons.join("; "))),
        };
        let contact_ms = 1e3 * impact.contact_s(measured.step_s);
        let line = format!(
            "  impact {number:<3} {verdict}  {:>8.1} N  {contact_ms:>6.2} ms{reasons}\n",
            impact.peak_n
        );
        words.add(!reasons.is_empty(), &line);
    }
    let (first, last) = (measured.frequency_hz.first(), measured.frequency_hz.last());
    for sensor in &records.responses {
        words.say(&format!(
            "  {:<8}{} of {} over {}, {} to {} Hz, {}\n",
            "frf",
            sensor.quantity(),
            sensor.name,
            records.force.name,
            short(first.copied().unwrap_or(0.0)),
            short(last.copied().unwrap_or(0.0)),
            options.estimator,
        ));
    }
    for warning in warnings(records, measured) {
        words.warn(&format!("  {:<8}{warning}\n", "note"));
    }
    words
}

fn plural(count: usize, noun: &str) -> String {
    format!("{count} {noun}{}", if count == 1 { "" } else { "s" })
}
