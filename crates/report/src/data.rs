//! What the plots and the table show, as JSON: numbers rounded to what can be seen, fewer of them where there are many.

use crate::number::rounded;
use crate::results::{Candidates, ErrorMap, Results, Sensor, Unknown, Verdict as Kind};
use crate::status::{label, pattern};
use crate::stretches::stretches;
use crate::thin::{every, rows};
use crate::verdict::Verdict;
use frfit::c64;
use frfit::identify::Status;
use serde_json::{Value, json};

/// Digits of a frequency: lines of a thousandth of a hertz stay apart.
const FREQUENCY_DIGITS: usize = 9;
/// Digits of everything else.
const DIGITS: usize = 6;
/// Rows of the table at most. With all columns a row takes some 180 bytes.
pub(crate) const TABLE_ROWS: usize = 12_000;
/// Rows of it that are drawn: as many as a plot has pixels across.
const DRAWN_ROWS: usize = 1_500;
/// Rows of all sensors together, some 70 bytes each.
const SENSOR_ROWS: usize = 20_000;
/// Sensors that are drawn.
pub(crate) const SENSORS: usize = 40;
/// Solutions of each kind that are drawn.
const SOLUTIONS: usize = 2_000;

/// What a page draws, and of how much of it there is.
pub(crate) struct Data {
    pub(crate) json: Value,
    /// Sentences that name the values left out of plots and table.
    pub(crate) notes: Vec<String>,
}

/// The data of a page.
pub(crate) fn data(results: &Results, verdict: &Verdict) -> Data {
    let mut notes = Vec::new();
    let band = &results.band;
    let all: Vec<usize> = (0..band.len()).collect();
    let table: Vec<usize> = thinned(results, &all, TABLE_ROWS);
    if table.len() < band.len() {
        notes.push(format!(
            "The table has {} of {} frequencies, among them the extremes of every band; identified.csv has all.",
            table.len(),
            band.len()
        ));
    }
    let drawn = thinned(results, &table, DRAWN_ROWS);
    if drawn.len() < band.len() {
        notes.push(format!(
            "Curves over frequency are drawn with {} of {} points: of each narrow band the smallest and the largest.",
            drawn.len(),
            band.len()
        ));
    }
    let pick =
        |values: &[Option<f64>]| table.iter().map(|&row| rounded(values[row], DIGITS)).collect::<Vec<_>>();
    let of_real = |name: &str| {
        results.unknowns.iter().any(|one| one.real && name.starts_with(&one.column("loss_factor")))
    };
    let columns: serde_json::Map<String, Value> = band
        .names()
        .filter(|name| band.has(name) && !of_real(name))
        .map(|name| (name.to_owned(), json!(pick(band.column(name)))))
        .collect();
    // Positions in the table.
    let drawn: Vec<usize> = drawn.iter().filter_map(|row| table.binary_search(row).ok()).collect();
    let sensors = sensors(results, &mut notes);
    let curves = results.curves();
    let unknowns: Vec<Value> =
        curves.map(|(suffix, j, one)| unknown(results, (&suffix, j, one), &table, &mut notes)).collect();
    let json = json!({
        "unknowns": unknowns,
        "together": together(results),
        "statuses": Status::ALL.map(|status| json!({
            "name": status.name(), "label": label(status, verdict.own), "trust": status.trust().name(),
            "pattern": pattern(status),
        })),
        "frequency_hz": table.iter().map(|&row| rounded(Some(band.frequency_hz[row]), FREQUENCY_DIGITS)).collect::<Vec<_>>(),
        "status": table.iter().map(|&row| band.class(row)).collect::<Vec<_>>(),
        "stretches": stretches(band).iter().map(|one| json!([
            Status::ALL.iter().position(|&status| status == one.status),
            rounded(Some(one.from), FREQUENCY_DIGITS),
            rounded(Some(one.to), FREQUENCY_DIGITS),
        ])).collect::<Vec<_>>(),
        "columns": columns,
        "nominal_error": pick(&verdict.nominal_error),
        "drawn": drawn,
        "sensors": sensors,
        "error_map": results.error_map.as_ref().map(error_map),
    });
    Data { json, notes }
}

/// An unknown that is a curve over frequency: where its numbers are, and what they are compared with.
fn unknown(
    results: &Results,
    (suffix, j, one): (&str, usize, &Unknown),
    table: &[usize],
    notes: &mut Vec<String>,
) -> Value {
    let parts = [
        "storage",
        "storage_std",
        "loss_factor",
        "loss_factor_std",
        "correction_re",
        "correction_im",
        "storage_std_noise",
        "storage_std_model",
        "storage_std_known_factors",
    ];
    let columns: serde_json::Map<String, Value> =
        parts.iter().map(|part| ((*part).to_owned(), one.column(part).into())).collect();
    let free = results.free.as_ref().filter(|free| free.len() == results.band.len()).map(|free| {
        let pick = |part: &str| {
            let column = free.column(&one.column(part));
            table.iter().map(|&row| rounded(column[row], DIGITS)).collect::<Vec<_>>()
        };
        json!({
            "storage": pick("storage"),
            "loss_factor": pick("loss_factor"),
            "status": table.iter().map(|&row| free.class(row)).collect::<Vec<_>>(),
        })
    });
    json!({
        "suffix": suffix, "label": if one.prefix.is_empty() { "" } else { &one.name },
        "real": one.real, "unit": one.unit(), "varies": one.varies, "columns": columns,
        "nominal": modulus(&one.nominal, table), "reference": modulus(&one.reference, table),
        "free": free, "candidates": candidates(&results.candidates, j, notes),
    })
}

/// Correlation, and the misfit along the least identifiable direction beside what its error bar makes of it; null where no number holds for the band.
fn together(results: &Results) -> Value {
    let found = &results.identifiability;
    if found.coordinates.is_empty() {
        return Value::Null;
    }
    let std = found.least.as_ref().and_then(|least| least.std);
    let numbers = |values: &mut dyn Iterator<Item = Option<f64>>| -> Vec<Value> {
        values.map(|value| rounded(value, DIGITS)).collect()
    };
    json!({
        "coordinates": found.coordinates,
        "correlation": found.correlation.iter().map(|row| numbers(&mut row.iter().copied())).collect::<Vec<_>>(),
        "profile": {
            "distance": numbers(&mut found.profile.iter().map(|point| Some(point.0))),
            "chi2": numbers(&mut found.profile.iter().map(|point| Some(point.1))),
            "linear": numbers(&mut found.profile.iter().map(|point| Some((point.0 / std?).powi(2)))),
        },
    })
}

/// Storage modulus and loss factor at some rows; null where no row has any.
fn modulus(values: &[Option<c64>], rows: &[usize]) -> Value {
    let pick = |part: &dyn Fn(c64) -> f64| -> Vec<Value> {
        rows.iter().map(|&row| rounded(values[row].map(part), DIGITS)).collect()
    };
    match values.iter().any(Option::is_some) {
        true => json!({"storage": pick(&|e| e.re), "loss_factor": pick(&frfit::material::loss_factor)}),
        false => Value::Null,
    }
}

/// Those of some rows of the band that show modulus, errors and every status.
fn thinned(results: &Results, among: &[usize], most: usize) -> Vec<usize> {
    let band = &results.band;
    // Errors of values are nowhere an extreme that a reader looks for.
    let shown = |name: &&str| ["error", "spectral_radius"].contains(name) || is_value(name);
    let columns = band.names().filter(shown).map(|name| band.column(name));
    let curves: Vec<_> = columns.map(|column| move |k: usize| column[among[k]]).collect();
    let curves: Vec<&dyn Fn(usize) -> Option<f64>> = curves.iter().map(|curve| curve as _).collect();
    let kept = rows(among.len(), most, &curves, Status::ALL.len(), &|k| band.class(among[k]));
    kept.into_iter().map(|k| among[k]).collect()
}

/// Whether a column is a value that was identified: `storage`, or `core.storage` of several unknowns.
fn is_value(name: &str) -> bool {
    let part = name.rsplit('.').next().unwrap_or(name);
    ["storage", "loss_factor"].contains(&part)
}

fn sensors(results: &Results, notes: &mut Vec<String>) -> Vec<Value> {
    let shown = results.sensors.len().min(SENSORS);
    if shown < results.sensors.len() {
        notes.push(format!("{shown} of {} sensors are drawn; response.csv has all.", results.sensors.len()));
    }
    let most = SENSOR_ROWS / shown.max(1);
    if most < results.band.len() {
        notes.push(format!(
            "Responses are drawn with up to {most} of {} frequencies: of each narrow band the smallest and the largest of every curve.",
            results.band.len()
        ));
    }
    results
        .sensors
        .iter()
        .take(SENSORS)
        .map(|sensor| one_sensor(sensor, &results.band.frequency_hz, most))
        .collect()
}

fn one_sensor(sensor: &Sensor, frequency_hz: &[f64], most: usize) -> Value {
    let size = |values: &'_ [Option<c64>]| -> Vec<Option<f64>> {
        values.iter().map(|value| Some((*value)?.norm())).collect()
    };
    let (nominal, measured, updated) = (size(&sensor.nominal), size(&sensor.measured), size(&sensor.updated));
    let kept = rows(
        frequency_hz.len(),
        most,
        &[&|row| nominal[row], &|row| measured[row], &|row| updated[row]],
        1,
        &|_| 0,
    );
    let parts = |values: &[Option<c64>]| match values.iter().any(Option::is_some) {
        true => json!({
            "re": kept.iter().map(|&row| rounded(values[row].map(|v| v.re), DIGITS)).collect::<Vec<_>>(),
            "im": kept.iter().map(|&row| rounded(values[row].map(|v| v.im), DIGITS)).collect::<Vec<_>>(),
        }),
        false => Value::Null,
    };
    let std = &sensor.measured_std;
    json!({
        "label": sensor.label,
        "quantity": sensor.quantity.name(),
        "frequency_hz": kept.iter().map(|&row| rounded(Some(frequency_hz[row]), FREQUENCY_DIGITS)).collect::<Vec<_>>(),
        "nominal": parts(&sensor.nominal),
        "measured": parts(&sensor.measured),
        "updated": parts(&sensor.updated),
        "measured_std": std.iter().any(Option::is_some).then(|| kept.iter().map(|&row| rounded(std[row], 3)).collect::<Vec<_>>()),
        "frac": {"nominal": rounded(sensor.frac(&sensor.nominal), DIGITS), "updated": rounded(sensor.frac(&sensor.updated), DIGITS)},
    })
}

/// The solutions of each kind of the j-th unknown but the chosen ones, which the table has.
fn candidates(candidates: &Candidates, j: usize, notes: &mut Vec<String>) -> Value {
    let [storage, loss_factor] = &candidates.values[j];
    let mut of_kind = |kind: Kind, word: &str| {
        let all: Vec<usize> =
            (0..candidates.verdict.len()).filter(|&row| candidates.verdict[row] == kind).collect();
        let kept: Vec<usize> = every(all.len(), SOLUTIONS).map(|k| all[k]).collect();
        if kept.len() < all.len() {
            let note = format!(
                "Of {} {word} solutions {} are drawn, at even steps; candidates.csv has all.",
                all.len(),
                kept.len()
            );
            if !notes.contains(&note) {
                notes.push(note);
            }
        }
        json!({
            "frequency_hz": kept.iter().map(|&row| rounded(Some(candidates.frequency_hz[row]), FREQUENCY_DIGITS)).collect::<Vec<_>>(),
            "storage": kept.iter().map(|&row| rounded(storage[row], DIGITS)).collect::<Vec<_>>(),
            "loss_factor": kept.iter().map(|&row| rounded(loss_factor[row], DIGITS)).collect::<Vec<_>>(),
        })
    };
    json!({
        "alternative": of_kind(Kind::Alternative, "alternative"),
        "admissible": of_kind(Kind::Admissible, "admissible"),
        "refused": of_kind(Kind::Refused, "refused"),
    })
}

/// log₁₀ ε, not below roundoff: colours are for errors that differ.
fn error_map(map: &ErrorMap) -> Value {
    let log = |error: &Option<f64>| rounded(error.map(|error| error.max(1e-16).log10()), 4);
    json!({
        "frequency_hz": map.frequency_hz.iter().map(|&f| rounded(Some(f), FREQUENCY_DIGITS)).collect::<Vec<_>>(),
        "order": map.order,
        "log_error": map.error.iter().map(|row| row.iter().map(log).collect::<Vec<_>>()).collect::<Vec<_>>(),
    })
}
