//! `summary.json`: what went in, what was done, what came out, in a form that programs read.

use super::laws_json;
use crate::load::{Case, IdentifyCase};
use crate::run::IdentifyRun;
use frfit::identify::Status;
use serde_json::{Map, Value, json};

/// A modulus within this of the truth counts as right.
pub const RIGHT_WITHIN: f64 = 1e-6;

/// The summary of an identification. `seconds_load` and `seconds_figures` are the stages outside the run.
pub fn summary_json(
    case: &Case,
    identify: &IdentifyCase,
    run: &IdentifyRun,
    seconds_load: f64,
    seconds_figures: f64,
) -> Value {
    let mut statuses = Map::new();
    let mut bands = Map::new();
    for status in Status::ALL.into_iter().filter(|&status| run.count(status) > 0) {
        statuses.insert(status.name().into(), json!(run.count(status)));
        bands.insert(status.name().into(), json!(run.bands_hz(status)));
    }
    let inputs: Vec<Value> = case
        .inputs
        .iter()
        .map(|input| json!({"file": input.path.display().to_string(), "bytes": input.bytes, "sha256": input.sha256}))
        .collect();
    let matrices: Vec<Value> = case
        .model
        .terms()
        .iter()
        .map(|term| json!({"name": term.name, "role": format!("{:?}", term.role).to_lowercase()}))
        .collect();
    let options = &identify.options;
    let mut summary = json!({
        "frfit": env!("CARGO_PKG_VERSION"),
        "title": case.title,
        "inputs": inputs,
        "model": {
            "dofs": case.model.dim(),
            "nonzeros": case.model.analysis().pattern().nonzeros(),
            "matrices": matrices,
        },
        "sensors": case.sensors.iter().map(|sensor| json!({
            "label": sensor.label, "quantity": sensor.quantity.name(),
        })).collect::<Vec<_>>(),
        "identify": {
            "matrix": identify.names,
            "varies": if identify.laws.is_empty() { "frequency" } else { "law" },
            "law": identify.laws.iter().map(|family| family.to_string()).collect::<Vec<_>>(),
            "band_hz": identify.band_hz,
            "method": options.method.name(),
            "order": options.order,
            "selection": options.selection.name(),
            "space": options.space.name(),
            "bounds": {"storage": options.bounds.storage, "loss_factor": options.bounds.loss_factor},
            "real": options.real,
        },
        "frequencies": run.outcomes.len(),
        "status": statuses,
        "bands_hz": bands,
        "error": spread(run, |outcome| outcome.error),
        "series_order": series_order(run),
        "spectral_radius": spread(run, |outcome| outcome.spectral_radius),
        "counts": {
            "factorisations": run.work.factorisations,
            "solves": run.work.solves,
            "subspace_size": run.subspace_size,
            "explored": run.explored,
            "certificate": run.certificate(),
        },
        "seconds": {
            "load": seconds_load,
            "subspace": run.seconds.subspace,
            "solutions": run.seconds.solutions,
            "selection": run.seconds.selection,
            "laws": run.seconds.laws,
            "identify": run.seconds.identify(),
            "error_map": run.seconds.error_map,
            "figures": seconds_figures,
        },
    });
    if let Some(laws) = &run.laws {
        summary["laws"] = laws_json(laws);
    }
    if let Some(truth) = truth(identify, run) {
        summary["truth"] = truth;
    }
    summary
}

/// The order that the paper's series would need for a truncation error of 1e-6, and at how many answers no order is enough; null where that was not
/// asked of any.
fn series_order(run: &IdentifyRun) -> Value {
    let asked =
        run.outcomes.iter().filter(|outcome| outcome.certificate.is_some() && outcome.correction.is_some());
    let orders: Vec<Option<usize>> = asked.map(|outcome| outcome.series_order).collect();
    if orders.is_empty() {
        return Value::Null;
    }
    let most = orders.iter().flatten().max();
    json!({"most": most, "never": orders.iter().filter(|order| order.is_none()).count()})
}

/// Median and largest of a number over the frequencies with status `ok`; null where there is none.
fn spread(run: &IdentifyRun, number: impl Fn(&frfit::identify::Identified) -> Option<f64>) -> Value {
    let ok = run.outcomes.iter().filter(|outcome| outcome.status == Status::Ok);
    let mut values: Vec<f64> = ok.filter_map(number).collect();
    values.sort_by(f64::total_cmp);
    json!({"median_ok": values.get(values.len() / 2), "max_ok": values.last()})
}

/// Where the truth is known: the fraction of frequencies with the right factor, of all and of those called `ok`.
fn truth(identify: &IdentifyCase, run: &IdentifyRun) -> Option<Value> {
    let law = identify.truth.as_ref()?;
    let right = run.right(|frequency_hz| law.at(frequency_hz).ok(), RIGHT_WITHIN)?;
    let ok: Vec<bool> = run
        .outcomes
        .iter()
        .zip(&right)
        .filter(|(outcome, _)| outcome.status == Status::Ok)
        .map(|(_, &right)| right)
        .collect();
    let fraction = |flags: &[bool]| {
        let count = flags.iter().filter(|&&flag| flag).count();
        (!flags.is_empty()).then(|| count as f64 / flags.len() as f64)
    };
    // Where the measurement is not one of the model itself, the mesh decides how near the truth an answer can be.
    let deviation = |outcome: &frfit::identify::Identified| {
        let truth = law.at(outcome.frequency_hz).ok()?;
        Some((outcome.factor()? - truth).norm() / truth.norm())
    };
    Some(json!({
        "deviation": spread(run, deviation),
        "within": RIGHT_WITHIN,
        "fraction_right": fraction(&right),
        "fraction_right_of_ok": fraction(&ok),
    }))
}
