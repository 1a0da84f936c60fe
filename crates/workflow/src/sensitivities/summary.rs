//! `sensitivities.json`.

use super::words::{inseparable as in_words, monomial};
use super::{NoiseFrom, Place, SensitivityRun};
use crate::load::{Case, InputFile};
use frfit::sensitivity::{Change, Variable, WorstBar, inseparable};
use frfit_linalg::solve::Breakdown;
use serde_json::{Value, json};

/// Where nothing could be solved.
pub(super) fn unsolved(case: &Case, breakdown: &Breakdown) -> Value {
    json!({"title": case.title, "unsolved": breakdown.to_string()})
}

/// What came out, in a form that programs read.
pub(super) fn json(case: &Case, run: &SensitivityRun) -> Value {
    let bars = run.resolved.as_ref().map(frfit::sensitivity::Resolved::bars);
    let parameters = run.ranking.iter().map(|ranking| {
        let variable = &run.variables[ranking.variable];
        json!({
            "name": variable.name,
            "kind": kind(variable),
            "rms": ranking.rms,
            "largest": ranking.largest.map(|largest| json!({
                "value": largest.value, "frequency_hz": largest.frequency_hz,
                "sensor": case.sensors[largest.sensor].label,
            })),
            "std": bars.as_ref().and_then(|bars| bars[ranking.variable]),
        })
    });
    let all: Vec<&str> = run.variables.iter().map(|variable| variable.name.as_str()).collect();
    let names = &all;
    let combinations = run.resolved.iter().flat_map(|resolved| resolved.combinations()).map(|(v, std)| {
        let largest = v.iter().fold(0.0, |l: f64, x| if x.abs() > l.abs() { *x } else { l });
        let exponents: Vec<f64> = v.iter().map(|x| x / largest).collect();
        json!({
            "product": monomial(names, &exponents),
            "exponents": names.iter().zip(&exponents).map(|(name, e)| ((*name).to_owned(), json!(e))).collect::<serde_json::Map<_, _>>(),
            "std": std.map(|std| std / largest.abs()),
        })
    });
    let groups = run.resolved.iter().flat_map(|resolved| {
        inseparable(resolved).into_iter().map(move |group| {
            json!({
                "parameters": group.variables.iter().map(|&p| names[p]).collect::<Vec<_>>(),
                "unknown": group.unknown,
                "direction": group.direction,
                "std": group.std,
                "words": in_words(&case.model, &run.variables, resolved, &group),
            })
        })
    });
    let worst = |bar: &WorstBar| {
        json!({
            "unseen": bar.unseen,
            "parameter": bar.worst.map(|worst| names[worst.variable]),
            "std": bar.worst.map(|worst| worst.std),
        })
    };
    let next = run.next.as_ref().map(|next| {
        let one = |place: &Place| {
            json!({
                "dof": case.row_name(place.row), "row": case.row_number(place.row), "after": worst(&place.after),
                "as_good": place.as_good.iter().map(|&row| case.row_name(row)).collect::<Vec<_>>(),
            })
        };
        json!({
            "compared": next.compared,
            "before": worst(&next.before),
            "best": next.best.iter().map(one).collect::<Vec<_>>(),
            "error": next.trained.error,
            "converged": next.trained.converged,
        })
    });
    let noise = match run.noise {
        NoiseFrom::Given(noise) => json!({"source": "given", "relative": noise}),
        NoiseFrom::Assumed(noise) => json!({"source": "assumed", "relative": noise}),
        NoiseFrom::Files => json!({"source": "files"}),
    };
    json!({
        "frfit": env!("CARGO_PKG_VERSION"),
        "title": case.title,
        "inputs": InputFile::json(&case.inputs),
        "dofs": case.model.dim(),
        "sensors": case.sensors.iter().map(|sensor| &sensor.label).collect::<Vec<_>>(),
        "frequencies": run.frequency_hz.len(),
        "band_hz": run.frequency_hz.first().zip(run.frequency_hz.last()),
        "noise": noise,
        "parameters": parameters.collect::<Vec<_>>(),
        "combinations": combinations.collect::<Vec<_>>(),
        "inseparable": groups.collect::<Vec<_>>(),
        "next_sensor": next,
        "counts": {
            "factorisations": run.work.factorisations, "solves": run.work.solves,
            "subspace_size": run.subspace_size,
        },
        "error": run.trained.error,
        "converged": run.trained.converged,
        "seconds": run.seconds,
    })
}

fn kind(variable: &Variable) -> &'static str {
    match variable.change {
        Change::Factor(_) => "factor",
        Change::Powers(_) => "dimension",
        Change::LossFactor(_) => "loss_factor",
        Change::Scale(_) => "scale",
    }
}
