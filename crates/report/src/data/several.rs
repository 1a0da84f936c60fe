//! What the plots of several unknowns show.

use super::{DIGITS, modulus};
use crate::number::rounded;
use crate::results::{Results, Several};
use frfit::c64;
use serde_json::{Value, json};

/// The unknowns that are curves over frequency, in the order of their plots.
pub(super) fn unknowns(several: &Several, table: &[usize]) -> Vec<Value> {
    let curves = several.unknowns.iter().filter(|one| one.is_curve()).enumerate();
    let one = |(k, one): (usize, &crate::results::Unknown)| {
        let [storage, storage_std, loss_factor, loss_factor_std] = one.columns();
        let of = |values: &[Option<c64>]| modulus(values, table);
        json!({
            "id": format!("modulus-{}", k + 1), "label": one.name, "real": one.real, "unit": "",
            "varies": if one.varies == "frequency" { "frequency" } else { "law" },
            "columns": {
                "storage": storage, "storage_std": storage_std, "loss_factor": loss_factor, "loss_factor_std": loss_factor_std,
            },
            "nominal": of(&one.nominal), "reference": of(&one.reference),
        })
    };
    curves.map(one).collect()
}

/// Correlation, and the misfit along what is told worst, beside what its error bar makes of it.
pub(super) fn together(results: &Results) -> Value {
    let Some(several) = &results.several else { return Value::Null };
    let std = several.worst.as_ref().and_then(|worst| worst.std);
    let profile = &several.profile;
    let numbers = |values: &mut dyn Iterator<Item = Option<f64>>| -> Vec<Value> {
        values.map(|value| rounded(value, DIGITS)).collect()
    };
    json!({
        "coordinates": several.coordinates,
        "correlation": several.correlation.iter().map(|row| numbers(&mut row.iter().copied())).collect::<Vec<_>>(),
        "profile": {
            "distance": numbers(&mut profile.iter().map(|point| Some(point.0))),
            "chi2": numbers(&mut profile.iter().map(|point| Some(point.1))),
            "linear": numbers(&mut profile.iter().map(|point| Some((point.0 / std?).powi(2)))),
        },
    })
}
