//! Tables for programs that know no cards: CSV and JSON.

use super::modulus::Modulus;
use crate::units::UnitSystem;
use frfit_formats::csv::{Cell, write};
use serde_json::{Map, Value, json};

/// Frequency, E′, η, their standard deviations where there are any, and the status; the units are in the line below the names, which `frfit fit` reads; relative factors have none.
pub(super) fn csv(modulus: &Modulus, units: UnitSystem) -> String {
    let (hz, pascal) = ("Hz", modulus.unit(units));
    let has_std = modulus.rows.iter().any(|row| row.std.is_some());
    let mut columns = vec!["frequency_hz", "storage", "loss_factor"];
    let mut named = vec![Cell::Text(hz), Cell::Text(pascal), Cell::Text("1")];
    if has_std {
        columns.extend(["storage_std", "loss_factor_std"]);
        named.extend([Cell::Text(pascal), Cell::Text("1")]);
    }
    columns.push("status");
    // What has no unit has no status either: the line must not be taken for one that is left out.
    named.push(Cell::Empty);
    let rows = modulus.rows.iter().map(|row| {
        let mut cells = vec![
            Cell::Number(row.frequency_hz),
            Cell::Number(modulus.in_units(units, row.storage)),
            Cell::Number(row.loss_factor),
        ];
        if has_std {
            cells.push(row.std.map(|[storage, _]| modulus.in_units(units, storage)).into());
            cells.push(row.std.map(|[_, eta]| eta).into());
        }
        cells.push(Cell::Text(&row.status));
        cells
    });
    // A line of units would make moduli in Pa of relative factors.
    let rows = Some(named).filter(|_| !modulus.is_relative).into_iter().chain(rows);
    write(&columns, rows).expect("every row has the columns, and no status of a table a line break")
}

/// The same as arrays, with what was left out and the law.
pub(super) fn json(modulus: &Modulus, units: UnitSystem, source: &str) -> String {
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
            "storage": modulus.unit(units),
            "loss": modulus.unit(units),
            "loss_factor": "1",
            "storage_std": modulus.unit(units),
            "loss_factor_std": "1",
        },
        "law": modulus.law,
        "left_out": left_out,
        "frequency_hz": column(&|row| json!(row.frequency_hz)),
        "storage": column(&|row| json!(modulus.in_units(units, row.storage))),
        "loss": column(&|row| json!(modulus.in_units(units, row.storage) * row.loss_factor)),
        "loss_factor": column(&|row| json!(row.loss_factor)),
        "storage_std": column(&|row| json!(row.std.map(|[storage, _]| modulus.in_units(units, storage)))),
        "loss_factor_std": column(&|row| json!(row.std.map(|[_, eta]| eta))),
        "status": column(&|row| json!(row.status)),
    });
    format!("{text:#}\n")
}
