//! `summary.json`: what went in, what was done, what came out, in a form that programs read.

use super::{laws_json, smooth_json};
use crate::load::{Case, IdentifyCase, MeasuredNoise};
use crate::run::IdentifyRun;
use frfit::c64;
use frfit::identify::{
    FactorError, GoodnessOfFit, Identification, Leverage, ModeError, ModelErrors, ModelErrorsFound,
    NoiseLevel, Status, Variation,
};
use frfit::material::loss_factor;
use frfit::model::{FactorPart, Term};
use serde_json::{Map, Value, json};

/// A modulus within this of the reference counts as right.
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
    let options = &identify.options;
    let unknown = &identify.unknowns[0];
    let (varies, laws) = match &unknown.varies {
        Variation::Smooth => ("smooth", &[][..]),
        Variation::Law(laws) => ("law", laws.as_slice()),
        _ => ("frequency", &[][..]),
    };
    let mut summary = json!({
        "frfit": env!("CARGO_PKG_VERSION"),
        "title": case.title,
        "inputs": inputs_json(case),
        "units": case.units.json(),
        "decay_per_s": case.model.decay_per_s(),
        "factor_unit": identify.units[0].word(),
        "model": model_json(case),
        "sensors": (0..case.sensors.len()).map(|m| sensor(case, run, m)).collect::<Vec<_>>(),
        "identify": {
            "matrix": identify.matrices(&case.model),
            "varies": varies,
            "law": laws.iter().map(|family| family.to_string()).collect::<Vec<_>>(),
            "band_hz": identify.band_hz,
            "left_out": identify.left_out.iter().filter(|&&out| out).count(),
            "method": options.method.name(),
            "order": options.order,
            "selection": options.selection.name(),
            "reduction": options.reduction.name(),
            "bounds": {"storage": unknown.bounds.storage, "loss_factor": unknown.bounds.loss_factor},
            "real": unknown.real,
            "reject_outliers": options.reject_outliers,
            "model_error": model_error_json(options.model_errors),
        },
        "frequencies": run.found.lines.len(),
        "status": statuses,
        "bands_hz": bands,
        "noise": noise(identify, run),
        "fit": fit_json(run.found.fit.as_ref()),
        "model_errors": run.found.model_errors.as_ref().map(|errors| model_errors_json(case, errors)),
        "leverage": leverage_json(case, &run.found),
        "error": spread(run, |outcome| outcome.error),
        "storage_std": spread(run, |outcome| Some(outcome.uncertainty()?.storage_std)),
        "loss_factor_std": spread(run, |outcome| outcome.uncertainty()?.loss_factor_std),
        "required_order": required_order(run),
        "spectral_radius": spread(run, |outcome| outcome.spectral_radius),
        "counts": {
            "factorisations": run.found.search.work.factorisations,
            "solves": run.found.search.work.solves,
            "subspace_size": run.found.search.reduced_size,
            "explored": run.found.search.explored,
            "reduction_error": run.found.reduction_error(),
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
    match &unknown.varies {
        Variation::Smooth => summary["smooth"] = run.found.curve.as_ref().map_or(Value::Null, smooth_json),
        Variation::Law(_) => summary["laws"] = laws_json(&run.found.laws, identify.units[0], case.units),
        _ => {}
    }
    if let Some(reference) = reference(identify, run) {
        summary["reference"] = reference;
    }
    summary
}

/// How large the model is, and what its matrices are.
pub(super) fn model_json(case: &Case) -> Value {
    let matrix = |term: &Term| json!({"name": term.name, "role": format!("{:?}", term.role).to_lowercase()});
    json!({
        "dofs": case.model.dim(),
        "nonzeros": case.model.analysis().pattern().nonzeros(),
        "matrices": case.model.terms().iter().map(matrix).collect::<Vec<_>>(),
    })
}

/// Every file that was read.
pub(super) fn inputs_json(case: &Case) -> Vec<Value> {
    case.inputs
        .iter()
        .map(|input| json!({"file": input.path.display().to_string(), "bytes": input.bytes, "sha256": input.sha256}))
        .collect()
}

/// A sensor, and what it says of the answers: its misfit over its deviation (root mean square).
pub(super) fn sensor(case: &Case, run: &IdentifyRun, m: usize) -> Value {
    let sensor = &case.sensors[m];
    let mut told = json!({"label": sensor.label, "quantity": sensor.quantity.name()});
    let channels = case.identify.as_ref().map_or(&[][..], |identify| &identify.channels);
    let unknown = channels.get(m).copied().unwrap_or_default();
    let found = run.found.channels.get(m).copied().unwrap_or_default();
    let asked = [("scale", unknown.scale, found.scale), ("delay_s", unknown.delay, found.delay_s)];
    for (key, _, found) in asked.into_iter().filter(|(_, asked, _)| *asked) {
        told[key] = json!(found.map(|found| found.value));
        told[format!("{key}_std")] = json!(found.and_then(|found| found.std));
    }
    if let Some(fit) = run.found.sensors.get(m) {
        told["misfit"] = json!(fit.misfit);
        told["contradicts"] = json!(fit.contradicts);
        told["left_out"] = json!(fit.left_out);
    }
    told
}

/// How large the noise is, and what tells it: `level` is in units of what `deviation` names.
fn noise(identify: &IdentifyCase, run: &IdentifyRun) -> Value {
    let NoiseLevel { level, source, of_sensors, of_scatter } = run.found.noise;
    let deviation = match &identify.noise {
        MeasuredNoise::Known(_) => "std, or coherence and averages, of the measurements",
        MeasuredNoise::Relative(_) => "coherence of the measurements, as of one average",
        MeasuredNoise::Unknown => "size of the response, a tenth of its median at least",
    };
    json!({
        "level": level, "source": source.name(), "deviation": deviation,
        "level_of_sensors": of_sensors, "level_of_scatter": of_scatter,
    })
}

/// What the case says of the errors of the model, as its key does.
fn model_error_json(known: ModelErrors) -> Value {
    match known {
        ModelErrors::Estimated => json!("estimated"),
        ModelErrors::None => json!("none"),
        ModelErrors::Given(sizes) => json!({"frequency": sizes.frequency, "shape": sizes.shape}),
    }
}

/// How far 1 % of each known factor moves each unknown, in per cent.
pub(super) fn leverage_json(case: &Case, found: &Identification) -> Vec<Value> {
    let names = case.identify.as_ref().map_or(&[][..], |identify| identify.unknowns.as_slice());
    let one = |one: &Leverage| {
        let unknown = names.get(one.unknown).map(|unknown| unknown.name.as_str());
        json!({"matrix": case.model.terms()[one.term].name, "unknown": unknown, "percent_by_percent": one.change})
    };
    found.leverage.iter().map(one).collect()
}

/// The errors of the model that were taken out.
pub(super) fn model_errors_json(case: &Case, errors: &ModelErrorsFound) -> Value {
    let mode =
        |mode: &ModeError| json!({"frequency_hz": mode.frequency_hz, "error": mode.error, "std": mode.std});
    let part = |part: FactorPart| match part {
        FactorPart::Storage => "storage",
        FactorPart::LossFactor => "loss_factor",
    };
    let matrix = |factor: &FactorError| json!({"matrix": case.model.terms()[factor.term].name, "part": part(factor.part), "error": factor.error, "std": factor.std});
    json!({
        "frequency_std": errors.frequency_std,
        "loss_factor_std": errors.loss_factor_std,
        "shape_std": errors.shape_std,
        "evidence_nats": errors.evidence,
        "modes": errors.modes.iter().map(mode).collect::<Vec<_>>(),
        "matrices": errors.factors.iter().map(matrix).collect::<Vec<_>>(),
    })
}

/// χ² over the band and what it says; null where nothing can tell.
pub(super) fn fit_json(fit: Option<&GoodnessOfFit>) -> Value {
    let Some(fit) = fit else { return Value::Null };
    json!({
        "chi2": fit.chi_squared, "freedom": fit.freedom, "chi2_per_freedom": fit.chi_squared / fit.freedom as f64,
        "deviate": fit.deviate, "verdict": fit.verdict.name(),
    })
}

/// The order that the paper's series would need for a truncation error of 1e-6, and at how many answers no order is enough; null where that was not
/// asked of any.
fn required_order(run: &IdentifyRun) -> Value {
    let asked = run
        .found
        .lines
        .iter()
        .filter(|outcome| outcome.reduction_error.is_some() && outcome.correction().is_some());
    let orders: Vec<Option<usize>> = asked.map(|outcome| outcome.required_order).collect();
    if orders.is_empty() {
        return Value::Null;
    }
    let most = orders.iter().flatten().max();
    json!({"most": most, "never": orders.iter().filter(|order| order.is_none()).count()})
}

/// Median and largest of a number over the frequencies with status `ok`; null where there is none.
fn spread(run: &IdentifyRun, number: impl Fn(&frfit::identify::Line) -> Option<f64>) -> Value {
    let ok = run.found.lines.iter().filter(|outcome| outcome.status == Status::Ok);
    let mut values: Vec<f64> = ok.filter_map(number).collect();
    values.sort_by(f64::total_cmp);
    json!({"median_ok": values.get(values.len() / 2), "max_ok": values.last()})
}

/// Where the reference is known: the fraction of frequencies with the right factor, of all and of those called `ok`.
fn reference(identify: &IdentifyCase, run: &IdentifyRun) -> Option<Value> {
    let law = identify.reference[0].as_ref()?;
    let right = run.right(|frequency_hz| law.at(frequency_hz).ok(), RIGHT_WITHIN)?;
    let ok: Vec<bool> = run
        .found
        .lines
        .iter()
        .zip(&right)
        .filter(|(outcome, _)| outcome.status == Status::Ok)
        .map(|(_, &right)| right)
        .collect();
    let fraction = |flags: &[bool]| {
        let count = flags.iter().filter(|&&flag| flag).count();
        (!flags.is_empty()).then(|| count as f64 / flags.len() as f64)
    };
    // Where the measurement is not one of the model itself, the mesh decides how near the reference an answer can be.
    let deviation = |outcome: &frfit::identify::Line| {
        let reference = law.at(outcome.frequency_hz).ok()?;
        Some((outcome.factor()? - reference).norm() / reference.norm())
    };
    // Of the answers with error bars that are called ok, those that have the reference within two standard deviations: 0.95 is right.
    let covered = |off: &dyn Fn(&frfit::identify::Line, c64) -> Option<f64>| {
        let ok = run.found.lines.iter().filter(|outcome| outcome.status == Status::Ok);
        let within: Vec<bool> =
            ok.filter_map(|o| Some(off(o, law.at(o.frequency_hz).ok()?)? <= 2.0)).collect();
        fraction(&within)
    };
    Some(json!({
        "covered": {
            "storage": covered(&|o, reference| Some((o.storage()? - reference.re).abs() / o.uncertainty()?.storage_std)),
            "loss_factor": covered(&|o, reference| {
                Some((o.loss_factor()? - loss_factor(reference)).abs() / o.uncertainty()?.loss_factor_std?)
            }),
        },
        "deviation": spread(run, deviation),
        "within": RIGHT_WITHIN,
        "fraction_right": fraction(&right),
        "fraction_right_of_ok": fraction(&ok),
    }))
}
