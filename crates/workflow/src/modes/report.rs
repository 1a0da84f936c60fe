//! The words on the screen.

use super::ModesRun;
use super::run::MeasuredRun;
use crate::load::Case;
use crate::output::{Words, corrections_text};
use crate::terminal::short;

/// A factor on the stiffness nearer to one than this is not worth a word.
const MIN_FACTOR_OFF: f64 = 0.02;

/// The smallest reduction error of a pole that is worth a word.
const MAX_POLE_ERROR: f64 = 1e-6;

/// The table of modes, and what measurement and model have in common.
pub(super) fn text(case: &Case, run: &ModesRun) -> Words {
    let mut words = Words::default();
    let [first, last] = run.band_hz.map(short);
    let factors = match case.modes.as_ref().and_then(|modes| modes.identified.as_deref()) {
        Some(file) => format!("factors of {file}"),
        None => "nominal factors".to_owned(),
    };
    words.say(&format!("{}: modes from {first} to {last} Hz, {factors}\n", case.title));
    words.say(&table(run));
    let mut add = |is_warning: bool, label: &str, value: String| {
        words.add(is_warning, &format!("  {label:<18}{value}\n"));
    };
    let missing = run.model.count.saturating_sub(run.model.modes.len());
    if missing > 0 {
        add(true, "missing", format!("{missing} of {} modes of the model were not found", run.model.count));
    }
    let error = run.model.modes.iter().map(|mode| mode.error).fold(0.0, f64::max);
    if error > MAX_POLE_ERROR {
        add(true, "reduction", format!("a pole of the model may be off by {error:.1e} of itself"));
    }
    for (is_warning, label, text) in corrections_text(case.corrections()) {
        add(is_warning, label, text);
    }
    let has_unknown = case.modes.as_ref().is_some_and(|modes| modes.has_unknown);
    if let Some(measured) = &run.measured {
        for (is_warning, label, value) in compared(case, has_unknown, measured) {
            add(is_warning, label, value);
        }
    } else {
        let (is_warning, why) = match case.modes.as_ref().and_then(|modes| modes.measured.as_ref()) {
            Some(band) => {
                let count = band.frequency_hz.len();
                (true, format!("{count} frequency in the band, to which no pole can be fitted"))
            }
            None => (false, "none: not every [[measurement]] has a file".to_owned()),
        };
        add(is_warning, "measured", why);
    }
    add(
        false,
        "work",
        format!(
            "{} factorisations, {} solves, {} vectors, {:.2} s",
            run.work.factorisations, run.work.solves, run.subspace_size, run.seconds
        ),
    );
    words
}

/// A ratio in per cent with its sign; nothing is above zero.
fn signed_percent(ratio: f64) -> String {
    let text = format!("{:+.2} %", 100.0 * ratio);
    if text == "-0.00 %" { "+0.00 %".to_owned() } else { text }
}

/// A row for each mode.
fn table(run: &ModesRun) -> String {
    let mut rows: Vec<(f64, String)> = Vec::new();
    let percent = |ratio: f64| format!("{:.3}", 100.0 * ratio);
    let measured = run.measured.as_ref().map_or(&[][..], |measured| &measured.modes.modes);
    let of_measured = |j: usize| {
        let mode = &measured[j];
        // An error bar below the last digit is not zero.
        let bar = |std: Option<f64>, digits: usize| {
            let unit = 0.1_f64.powi(digits as i32);
            match std {
                Some(std) if std < 0.5 * unit => format!(" ± <{unit:.digits$}"),
                Some(std) => format!(" ± {std:.digits$}"),
                None => String::new(),
            }
        };
        [
            format!("{:.2}{}", mode.frequency_hz(), bar(mode.frequency_std_hz, 2)),
            format!(
                "{}{}",
                percent(mode.damping_ratio()),
                bar(mode.damping_ratio_std.map(|std| 100.0 * std), 3)
            ),
        ]
    };
    let row = |model: [String; 2], measured: [String; 2], difference: String, mac: String, note: &str| {
        let [f, zeta] = model;
        let [fm, zeta_m] = measured;
        match run.measured {
            Some(_) => {
                format!("  {f:>10}  {zeta:>8}  {fm:>18}  {zeta_m:>16}  {difference:>8}  {mac:>5}  {note}")
            }
            None => format!("  {f:>10}  {zeta:>8}  {note}"),
        }
    };
    let dash = || "-".to_owned();
    for i in run.shown() {
        let mode = &run.model.modes[i];
        let own = [format!("{:.2}", mode.frequency_hz()), percent(mode.damping_ratio())];
        let pair = run.partner_of_model(i);
        let line = match pair {
            _ if mode.is_rigid_body() => {
                row(["0".into(), dash()], [dash(), dash()], dash(), dash(), "rigid body")
            }
            Some(pair) => {
                let difference = signed_percent(pair.frequency_difference);
                let mac = pair.assurance.map_or_else(dash, |mac| format!("{mac:.2}"));
                let note = if pair.is_crossing { "order changed" } else { "" };
                row(own, of_measured(pair.measured), difference, mac, note)
            }
            None => {
                let note = if run.measured.is_some() { "model only" } else { "" };
                row(own, [dash(), dash()], dash(), dash(), note)
            }
        };
        rows.push((mode.frequency_hz(), line));
    }
    for j in (0..measured.len()).filter(|&j| run.partner_of_measured(j).is_none()) {
        let line = row([dash(), dash()], of_measured(j), dash(), dash(), "measured only");
        rows.push((measured[j].frequency_hz(), line));
    }
    rows.sort_by(|a, b| a.0.total_cmp(&b.0));
    let heading = row(
        ["model, Hz".into(), "ζ, %".into()],
        ["measured, Hz".into(), "ζ, %".into()],
        "Δf".into(),
        "MAC".into(),
        "",
    );
    let lines = std::iter::once(heading).chain(rows.into_iter().map(|(_, line)| line));
    lines.map(|line| line.trim_end().to_owned() + "\n").collect()
}

/// Label and sentence, and whether it must not be missed.
fn compared(case: &Case, has_unknown: bool, measured: &MeasuredRun) -> Vec<(bool, &'static str, String)> {
    let mut said = Vec::new();
    let count = measured.modes.modes.len();
    if count == 0 {
        said.push((
            true,
            "measured",
            "no pole is there at one order after another: no mode was found".to_owned(),
        ));
        return said;
    }
    if let Some(level) = measured.modes.level {
        said.push((
            false,
            "remainder",
            format!("{level:.2e} times the assumed noise is left beside {count} mode(s)"),
        ));
    }
    let pairs = &measured.pairing;
    if (pairs.stiffness_factor - 1.0).abs() > MIN_FACTOR_OFF {
        let unknown = if has_unknown { "the unknown stiffness" } else { "all stiffness" };
        let value = format!("{:.2} on {unknown} brings the frequencies nearest", pairs.stiffness_factor);
        said.push((false, "stiffness factor", value));
    }
    said.push((false, "pairs", format!("{} of {count} measured modes", pairs.pairs.len())));
    let labels = case.sensors.iter().map(|sensor| sensor.label.as_str());
    let listed = |values: &[Option<f64>]| -> String {
        let each = labels.clone().zip(values);
        each.filter_map(|(label, value)| value.map(|value| format!("{label} {value:.2}")))
            .collect::<Vec<_>>()
            .join(", ")
    };
    for (label, values) in [("FRAC", &measured.frac), ("COMAC", &measured.comac)] {
        let text = listed(values);
        if !text.is_empty() {
            said.push((false, label, text));
        }
    }
    said
}
