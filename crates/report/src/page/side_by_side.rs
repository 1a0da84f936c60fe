//! Natural frequencies of model and measurement side by side, for a band that is not explained: which modes have a partner, and how far their frequencies are apart.

use super::model_errors::{number, table};
use super::section;
use crate::escape::escape;
use crate::number::significant;
use crate::results::Results;
use serde_json::Value;
use std::fmt::Write;

/// A common stiffness factor is mentioned if it differs from one by more than this.
const MIN_FACTOR_OFF: f64 = 0.02;

/// Size of the picture, and where its rows are.
const WIDTH: f64 = 960.0;
const HEIGHT: f64 = 150.0;
const LEFT: f64 = 110.0;
const RIGHT: f64 = 20.0;
const OF_MODEL: [f64; 2] = [18.0, 50.0];
const OF_MEASUREMENT: [f64; 2] = [90.0, 122.0];

/// A mode of either: its number, frequency and damping ratio.
#[derive(Clone, Copy)]
struct Mode {
    number: u64,
    hz: f64,
    damping: f64,
}

/// Modes that are one: their numbers, the difference of their frequencies at the nominal stiffness and with a common factor on it, and how alike their shapes are.
struct Pair {
    model: u64,
    measured: u64,
    difference: f64,
    at_factor: f64,
    assurance: Option<f64>,
}

impl Pair {
    /// By how much the common factor changes the model's frequency.
    fn change(&self) -> f64 {
        (1.0 + self.at_factor) / (1.0 + self.difference)
    }
}

/// The section; nothing where the summary has no modes.
pub(super) fn side_by_side(results: &Results) -> String {
    let summary = &results.summary;
    let model: Vec<Mode> = summary.array("/modes/model/modes").iter().filter_map(mode).collect();
    let measured: Vec<Mode> = summary.array("/modes/measured/modes").iter().filter_map(mode).collect();
    let pairs: Vec<Pair> = summary.array("/modes/measured/pairs").iter().filter_map(pair).collect();
    if measured.is_empty() {
        return String::new();
    }
    let factor = summary.number("/modes/measured/stiffness_factor");
    let factor = factor.filter(|factor| (factor - 1.0).abs() > MIN_FACTOR_OFF);
    let said = factor.map_or(String::new(), |factor| {
        format!(
            " In the picture the unknown stiffness of the model is multiplied by {}, where the frequencies fit best.",
            significant(factor, 3)
        )
    });
    let content = format!(
        "<p>The identified values do not explain the measurement, so compare the modes one by one. All frequencies off in one direction point at a mass, a thickness or a nominal value. \
         Single ones point at a support or a joint. Modes without a partner point at the mesh, a missing part or a wrong sensor position.{said} \
         <code>frfit modes</code> gives figures, mode shapes and the response of both.</p>\n{}{}{}",
        picture(&model, &measured, &pairs),
        rows(&model, &measured, &pairs, factor.is_some()),
        shapes(results)
    );
    section("modes", "Natural frequencies of model and measurement", &content)
}

/// How alike the shapes of the pairs are at each sensor; nothing where there are too few of either.
fn shapes(results: &Results) -> String {
    let comac = results.summary.0.pointer("/modes/measured/comac").and_then(Value::as_object);
    let one = |(sensor, value): (&String, &Value)| Some(format!("{} {:.2}", escape(sensor), value.as_f64()?));
    let all: Vec<String> = comac.into_iter().flatten().filter_map(one).collect();
    if all.is_empty() {
        return String::new();
    }
    format!(
        "<p>Agreement of the mode shapes at each sensor (COMAC, 1 is full agreement): {}. A sensor far below the others has a wrong position or direction.</p>\n",
        all.join(", ")
    )
}

fn mode(of: &Value) -> Option<Mode> {
    let is_rigid_body = of.get("is_rigid_body").and_then(Value::as_bool) == Some(true);
    let number_of = of.get("mode").and_then(Value::as_u64).filter(|_| !is_rigid_body)?;
    Some(Mode { number: number_of, hz: number(of, "frequency_hz")?, damping: number(of, "damping_ratio")? })
}

fn pair(of: &Value) -> Option<Pair> {
    Some(Pair {
        model: of.get("model")?.as_u64()?,
        measured: of.get("measured")?.as_u64()?,
        difference: number(of, "frequency_difference")?,
        at_factor: number(of, "difference_at_factor")?,
        assurance: number(of, "mac"),
    })
}

/// Two rows of strokes, and a line between those that are one mode.
fn picture(model: &[Mode], measured: &[Mode], pairs: &[Pair]) -> String {
    // The summary has no change of a mode without a partner: it gets the mean of the others.
    let sum: f64 = pairs.iter().map(Pair::change).sum();
    let mean = if pairs.is_empty() { 1.0 } else { sum / pairs.len() as f64 };
    let shown = |mode: &Mode| {
        let own = pairs.iter().find(|pair| pair.model == mode.number);
        Mode { hz: own.map_or(mean, Pair::change) * mode.hz, ..*mode }
    };
    let model: &[Mode] = &model.iter().map(shown).collect::<Vec<_>>();
    let all = || model.iter().chain(measured).map(|mode| mode.hz);
    let (first, last) =
        all().fold((f64::INFINITY, 0.0f64), |(first, last), hz| (first.min(hz), last.max(hz)));
    let margin = 0.03 * (last - first).max(0.1 * last);
    let (first, last) = ((first - margin).max(0.0), last + margin);
    let x = |hz: f64| LEFT + (WIDTH - LEFT - RIGHT) * (hz - first) / (last - first);
    let of =
        |modes: &[Mode], number: u64| modes.iter().find(|mode| mode.number == number).map(|mode| mode.hz);
    let mut svg = format!(
        "<div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"Natural frequencies of model and measurement\">\
         <svg class=\"modes\" viewBox=\"0 0 {WIDTH} {HEIGHT}\" role=\"img\" aria-label=\"{} of {} measured natural frequencies have a partner in the model\">",
        pairs.len(),
        measured.len()
    );
    // Writing to a string does not fail.
    for pair in pairs {
        if let (Some(own), Some(other)) = (of(model, pair.model), of(measured, pair.measured)) {
            let [(x1, y1), (x2, y2)] = [(x(own), OF_MODEL[1]), (x(other), OF_MEASUREMENT[0])];
            let _ =
                write!(svg, "<line class=\"pair\" x1=\"{x1:.1}\" y1=\"{y1}\" x2=\"{x2:.1}\" y2=\"{y2}\"/>");
        }
    }
    let is_paired = |is_of_model: bool, number: u64| {
        pairs.iter().any(|pair| number == if is_of_model { pair.model } else { pair.measured })
    };
    for (is_of_model, class, modes, [top, end]) in
        [(true, "model", model, OF_MODEL), (false, "measured", measured, OF_MEASUREMENT)]
    {
        let (word, middle) = (if is_of_model { "model" } else { "measured" }, 0.5 * (top + end) + 4.0);
        let _ = write!(svg, "<text x=\"0\" y=\"{middle}\">{word}</text>");
        for mode in modes {
            let alone = if is_paired(is_of_model, mode.number) { "" } else { " alone" };
            let _ = write!(
                svg,
                "<line class=\"{class}{alone}\" x1=\"{0:.1}\" y1=\"{top}\" x2=\"{0:.1}\" y2=\"{end}\"><title>{1} Hz</title></line>",
                x(mode.hz),
                significant(mode.hz, 5)
            );
        }
    }
    for hz in [first, last] {
        let anchor = if hz == first { "start" } else { "end" };
        let _ = write!(
            svg,
            "<text x=\"{:.1}\" y=\"{}\" text-anchor=\"{anchor}\">{} Hz</text>",
            x(hz),
            HEIGHT - 6.0,
            significant(hz, 3)
        );
    }
    svg + "</svg></div>\n<p class=\"note\">Lines join modes that belong together by frequency and shape. Dashed strokes have no partner.</p>\n"
}

/// All modes of the measurement, and those of the model that have no partner, by frequency.
fn rows(model: &[Mode], measured: &[Mode], pairs: &[Pair], has_factor: bool) -> String {
    let none = || "–".to_owned();
    let hz = |mode: Option<&Mode>| mode.map_or_else(none, |mode| significant(mode.hz, 5));
    let damping = |mode: Option<&Mode>| mode.map_or_else(none, |mode| significant(100.0 * mode.damping, 3));
    let mut rows: Vec<(f64, Vec<String>)> = Vec::new();
    let mut add = |own: Option<&Mode>, other: Option<&Mode>, pair: Option<&Pair>| {
        let percent = |value: f64| format!("{:+.2}", 100.0 * value).replace('-', "−");
        let difference = pair.map_or_else(none, |pair| percent(pair.difference));
        let at_factor = pair.map_or_else(none, |pair| percent(pair.at_factor));
        let mac = pair.and_then(|pair| pair.assurance).map_or_else(none, |mac| format!("{mac:.2}"));
        let at = other.or(own).map_or(0.0, |mode| mode.hz);
        let mut row = vec![hz(own), hz(other), difference];
        row.extend(has_factor.then_some(at_factor));
        row.extend([damping(own), damping(other), mac]);
        rows.push((at, row));
    };
    for mode in measured {
        let pair = pairs.iter().find(|pair| pair.measured == mode.number);
        let own = pair.and_then(|pair| model.iter().find(|own| own.number == pair.model));
        add(own, Some(mode), pair);
    }
    for mode in model.iter().filter(|mode| pairs.iter().all(|pair| pair.model != mode.number)) {
        add(Some(mode), None, None);
    }
    rows.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut heads = vec!["Nominal model, Hz", "Measured, Hz", "Difference, %"];
    heads.extend(has_factor.then_some("With the factor, %"));
    heads.extend(["Damping ratio of the model, %", "Measured, %", "MAC"]);
    table(
        "Natural frequencies of model and measurement, in numbers",
        &heads,
        &rows.into_iter().map(|(_, row)| row).collect::<Vec<_>>(),
    )
}
