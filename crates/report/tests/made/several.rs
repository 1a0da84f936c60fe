//! Results of several unknowns in the form of `frfit identify`: a modulus at every frequency beside a mass and a complex constant.

use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::fmt::Write;

/// What to make.
pub(crate) struct MadeSeveral {
    pub(crate) name: &'static str,
    pub(crate) frequencies: usize,
    /// The last so many frequencies are not identifiable.
    pub(crate) bad: usize,
    pub(crate) fit: &'static str,
    /// Whether the core varies over the band; else there are constants only.
    pub(crate) varies: bool,
    /// How many of the mass and the complex constant there are: none, the mass, both.
    pub(crate) constants: usize,
    /// The mass is not identifiable, and a sentence says beside what.
    pub(crate) unclear: bool,
}

impl Default for MadeSeveral {
    fn default() -> Self {
        Self {
            name: "mass",
            frequencies: 50,
            bad: 0,
            fit: "explained",
            varies: true,
            constants: 2,
            unclear: false,
        }
    }
}

/// The files.
pub(crate) fn several(made: &MadeSeveral) -> BTreeMap<&'static str, Vec<u8>> {
    const SHARED: &str = "error,chi2,candidate_count,status,spectral_radius,order,convergence_radius,required_order,reduction_error";
    let quoted = |text: &str| format!("\"{}\"", text.replace('"', "\"\""));
    let mut heads = [
        vec!["frequency_hz".to_owned(), SHARED.to_owned()],
        vec!["frequency_hz".to_owned()],
        vec!["frequency_hz".to_owned()],
    ];
    let is_only = usize::from(made.varies) + made.constants == 1;
    let mut add = |name: &str| {
        let value = ["storage", "loss_factor", "correction_re", "correction_im"];
        let bars = [
            "storage_std",
            "loss_factor_std",
            "storage_loss_correlation",
            "storage_std_noise",
            "storage_std_model",
            "storage_std_known_factors",
        ];
        let reference = ["nominal_re", "nominal_im", "true_re", "true_im"];
        let prefix = if is_only { String::new() } else { format!("{name}.") };
        let named = |part: &&str| quoted(&format!("{prefix}{part}"));
        heads[0].extend(value.iter().chain(&bars).map(named));
        heads[1].extend(reference.iter().map(named));
        heads[2].extend(value.iter().map(named));
    };
    let names = [(made.varies, "core"), (made.constants > 0, made.name), (made.constants > 1, "skins")];
    names.iter().filter(|(there, _)| *there).for_each(|(_, name)| add(name));
    heads[2].push("verdict".to_owned());
    let [mut identified, mut reference, mut candidates] = heads.map(|head| head.join(",") + "\n");
    let mut response =
        "frequency_hz,sensor,quantity,nominal_re,nominal_im,measured_re,measured_im,updated_re,updated_im,measured_std\n".to_owned();
    for i in 0..made.frequencies {
        let f = 20.0 + 0.5 * i as f64;
        let status = if i + made.bad >= made.frequencies { "not_identifiable" } else { "ok" };
        // Writing to a string does not fail.
        let _ = write!(identified, "{f:?},1e-3,1.01,2,{status},,0,,,1e-9");
        let _ = write!(reference, "{f:?}");
        let (mut chosen, mut rival) = (format!("{f:?}"), format!("{f:?}"));
        let mut add = |value: [f64; 4], bars: &str, known: &str| {
            let [storage, loss_factor, re, im] = value;
            let _ = write!(identified, ",{storage:?},{loss_factor:?},{re:?},{im:?},{bars}");
            let _ = write!(reference, ",{known}");
            let _ = write!(chosen, ",{storage:?},{loss_factor:?},{re:?},{im:?}");
            let _ = write!(rival, ",{:?},{loss_factor:?},{re:?},{im:?}", 2.0 * storage);
        };
        if made.varies {
            add([1e6 + 1e4 * i as f64, 0.4, -1e6, 0.0], "1e3,1e-3,0.1,6e2,8e2,0", "2e6,1e5,1e6,4e5");
        }
        if made.constants > 0 {
            add([0.065, 0.0, 0.025, 0.0], "1e-5,,,1e-5,0,0", "0.04,0.0,0.065,0.0");
        }
        if made.constants > 1 {
            add([6.9e10, 0.003, -4e9, 0.0], "9e5,1e-5,0.0,9e5,0,0", "7.3e10,7.3e7,6.9e10,2.07e8");
        }
        identified += "\n";
        reference += "\n";
        candidates += &format!("{chosen},chosen\n{rival},alternative\n");
        for sensor in ["S1", "S2"] {
            let _ = writeln!(response, "{f:?},{sensor},receptance,2e-6,-1e-6,1e-6,-2e-6,1e-6,-2e-6,1e-9");
        }
    }
    let mut unknowns = Vec::new();
    let mut coordinates: Vec<String> = Vec::new();
    if made.varies {
        let reference = json!({"within": 1e-5, "fraction_right": 1.0, "wrong_and_ok": 0, "deviation": {"median_ok": 1e-7, "max_ok": 2e-7}});
        unknowns.push(json!({"name": "core", "matrices": ["core"], "varies": "frequency", "real": false, "numbers": null, "status": null, "reference": reference}));
    }
    if made.constants > 0 {
        let (std, status) =
            if made.unclear { (Value::Null, "not_identifiable") } else { (json!(1e-5), "ok") };
        let numbers = json!([{"name": "value", "value": 0.065, "std": std}]);
        let reference = json!({"relative": 1e-4, "deviations": 0.8});
        unknowns.push(json!({"name": made.name, "matrices": ["mass"], "varies": "constant", "real": true, "numbers": numbers, "status": status, "reference": reference}));
        coordinates.push(made.name.to_owned());
    }
    if made.constants > 1 {
        let numbers = json!([{"name": "storage", "value": 6.9e10, "std": 9e5}, {"name": "loss_factor", "value": 0.003, "std": 1e-5}]);
        unknowns.push(json!({"name": "skins", "matrices": ["skins"], "varies": "constant", "real": false, "numbers": numbers, "status": "ok", "reference": null}));
        coordinates.extend(["skins storage", "skins loss_factor"].map(str::to_owned));
    }
    let count = coordinates.len();
    let correlation: Vec<Vec<f64>> =
        (0..count).map(|i| (0..count).map(|j| if i == j { 1.0 } else { 0.25 }).collect()).collect();
    let weights: Vec<Value> = coordinates
        .iter()
        .enumerate()
        .map(|(k, name)| json!({"of": name, "weight": if k == 0 { 0.9 } else { -0.3 }}))
        .collect();
    let profile: Vec<[f64; 2]> = (-5..=5).map(|k| [f64::from(k) * 1e-4, f64::from(k * k)]).collect();
    let unclear = made.unclear && count > 0;
    let not_identifiable: Vec<String> = unclear
        .then(|| format!("{} larger with skins storage smaller: not identifiable", made.name))
        .into_iter()
        .collect();
    let summary = json!({
        "frfit": "0.1.0", "title": "Made", "tables": ["identified.csv", "candidates.csv", "reference.csv", "response.csv"],
        "inputs": [{"file": "K.mtx", "bytes": 1000, "sha256": "00".repeat(32)}],
        "model": {"dofs": 10, "nonzeros": 28, "matrices": [{"name": "core", "role": "stiffness"}]},
        "sensors": [{"label": "S1", "quantity": "receptance"}, {"label": "S2", "quantity": "receptance"}],
        "identify": {"method": "rational", "selection": "joint"}, "findings": null, "unknowns": unknowns, "trusted": !unclear, "coordinates": coordinates, "correlation": correlation,
        "directions": if count > 0 { json!([{"std": if unclear { Value::Null } else { json!(1e-4) }, "weights": weights}]) } else { json!([]) },
        "profile": if count > 0 { json!(profile) } else { Value::Null },
        "not_identifiable": not_identifiable,
        "noise": {"source": "given", "level": 1.0},
        "fit": {"chi2": 100.0, "freedom": 98, "chi2_per_freedom": 1.02, "deviate": 0.1, "verdict": made.fit},
        "search": {"converged": true, "starts": 4, "agreeing": 4},
        "counts": {"factorisations": 1, "solves": 20, "subspace_size": 12, "reduction_error": 1e-9},
        "seconds": {"load": 0.1, "identify": 0.5},
    });
    let files = [
        ("identified.csv", identified),
        ("candidates.csv", candidates),
        ("reference.csv", reference),
        ("response.csv", response),
        ("summary.json", format!("{summary:#}\n")),
    ];
    files.into_iter().map(|(name, text)| (name, text.into_bytes())).collect()
}
