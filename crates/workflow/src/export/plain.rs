//! Tables for programs that know no cards: CSV and JSON.

use super::modulus::Modulus;
use super::options::ExportOptions;
use frfit_formats::csv::{Cell, write};
use serde_json::{Map, Value, json};

/// Frequency, E′, η, their deviations where there are any, and the status; the units are in the line below the names, which `frfit fit` reads.
pub(super) fn csv(modulus: &Modulus, options: &ExportOptions) -> String {
    let (hz, pascal) = ("Hz", options.units.modulus_unit());
    let has_std = modulus.rows.iter().any(|row| row.std.is_some());
    let mut columns = vec!["frequency_hz", "storage", "loss_factor"];
    let mut units = vec![Cell::Text(hz), Cell::Text(pascal), Cell::Text("1")];
    if has_std {
        columns.extend(["storage_std", "loss_factor_std"]);
        units.extend([Cell::Text(pascal), Cell::Text("1")]);
    }
    columns.push("status");
    // What has no unit has no status either: the line must not be taken for one that is left out.
    units.push(Cell::Empty);
    let rows = modulus.rows.iter().map(|row| {
        let mut cells = vec![
            Cell::Number(row.frequency_hz),
            Cell::Number(options.units.modulus(row.storage)),
            Cell::Number(row.loss_factor),
        ];
        if has_std {
            cells.push(row.std.map(|[storage, _]| options.units.modulus(storage)).into());
            cells.push(row.std.map(|[_, eta]| eta).into());
        }
        cells.push(Cell::Text(&row.status));
        cells
    });
    let rows = std::iter::once(units).chain(rows);
    write(&columns, rows).expect("every row has the columns, and no status of a table a line break")
}

/// The same as arrays, with what was left out and the law.
pub(super) fn json(modulus: &Modulus, options: &ExportOptions, source: &str) -> String {
    let units = options.units;
    let column = |value: &dyn Fn(&frfit_formats::csv::ModulusRow) -> Value| {
        modulus.rows.iter().map(value).collect::<Value>()
    };
    let left_out: Map<String, Value> =
        modulus.left_out.iter().map(|(status, count)| (status.clone(), json!(count))).collect();
    let text = json!({
        "frfit": env!("CARGO_PKG_VERSION"),
        "source": source,
        "convention": "E = storage * (1 + i loss_factor), exp(+i omega t)",
        "unit_system": units.name(),
        "units": {
            "frequency_hz": "Hz",
            "storage": units.modulus_unit(),
            "loss": units.modulus_unit(),
            "loss_factor": "1",
            "storage_std": units.modulus_unit(),
            "loss_factor_std": "1",
        },
        "law": modulus.law,
        "left_out": left_out,
        "frequency_hz": column(&|row| json!(row.frequency_hz)),
        "storage": column(&|row| json!(units.modulus(row.storage))),
        "loss": column(&|row| json!(units.modulus(row.storage) * row.loss_factor)),
        "loss_factor": column(&|row| json!(row.loss_factor)),
        "storage_std": column(&|row| json!(row.std.map(|[storage, _]| units.modulus(storage)))),
        "loss_factor_std": column(&|row| json!(row.std.map(|[_, eta]| eta))),
        "status": column(&|row| json!(row.status)),
    });
    format!("{text:#}\n")
}
