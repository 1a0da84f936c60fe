//! `modes.json`.

use super::ModesRun;
use crate::load::{Case, InputFile};
use crate::output::corrections_json;
use frfit::subspace::NaturalMode;
use serde_json::{Value, json};

/// What came out, in a form that programs read.
pub(super) fn json(case: &Case, run: &ModesRun) -> Value {
    let of_model = |i: usize| {
        let mode: &NaturalMode = &run.model.modes[i];
        let shares = case.model.terms().iter().zip(&mode.energy_shares).filter(|(_, share)| **share != 0.0);
        json!({
            "mode": i + 1,
            "frequency_hz": mode.frequency_hz(),
            "damping_ratio": mode.damping_ratio(),
            "is_rigid_body": mode.is_rigid_body(),
            "energy_shares": shares.map(|(term, share)| (term.name.clone(), json!(share))).collect::<serde_json::Map<_, _>>(),
            "reduction_error": mode.error,
        })
    };
    let labels = || case.sensors.iter().map(|sensor| &sensor.label);
    let by_sensor = |values: &[Option<f64>]| -> Value {
        labels()
            .zip(values)
            .map(|(label, value)| (label.clone(), json!(value)))
            .collect::<serde_json::Map<_, _>>()
            .into()
    };
    let [window, shifts, cut_off] = corrections_json(case.corrections());
    let measured = run.measured.as_ref().map(|measured| {
        let modes = measured.modes.modes.iter().enumerate().map(|(j, mode)| {
            json!({
                "mode": j + 1,
                "frequency_hz": mode.frequency_hz(),
                "frequency_std_hz": mode.frequency_std_hz,
                "damping_ratio": mode.damping_ratio(),
                "damping_ratio_std": mode.damping_ratio_std,
            })
        });
        let pairs = measured.pairing.pairs.iter().map(|pair| {
            json!({
                "model": pair.model + 1,
                "measured": pair.measured + 1,
                "frequency_difference": pair.frequency_difference,
                "difference_at_factor": pair.difference_at_factor,
                "mac": pair.assurance,
                "is_crossing": pair.is_crossing,
            })
        });
        json!({
            "modes": modes.collect::<Vec<_>>(),
            "noise_level": measured.modes.level,
            "window": window,
            "frequency_shifts": shifts,
            "cut_off": cut_off,
            "pairs": pairs.collect::<Vec<_>>(),
            "stiffness_factor": measured.pairing.stiffness_factor,
            "frac": by_sensor(&measured.frac),
            "comac": by_sensor(&measured.comac),
        })
    });
    json!({
        "frfit": env!("CARGO_PKG_VERSION"),
        "title": case.title,
        "inputs": InputFile::json(&case.inputs),
        "dofs": case.model.dim(),
        "sensors": labels().collect::<Vec<_>>(),
        "band_hz": run.band_hz,
        "factors": case.modes.as_ref().and_then(|modes| modes.identified.clone()).unwrap_or_else(|| "nominal".into()),
        "model": {
            "modes": run.shown().map(of_model).collect::<Vec<_>>(),
            "found": run.model.modes.len(),
            "counted": run.model.count,
        },
        "measured": measured,
        "counts": {
            "factorisations": run.work.factorisations, "solves": run.work.solves,
            "subspace_size": run.subspace_size,
        },
        "seconds": run.seconds,
    })
}
