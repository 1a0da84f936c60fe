//! Results in the form of `frfit identify`, of an oscillator whose stiffness was half of what it should be.

pub(crate) mod several;

use serde_json::json;
use std::collections::BTreeMap;
use std::fmt::Write;

/// What to make.
pub(crate) struct Made {
    pub(crate) title: &'static str,
    pub(crate) label: &'static str,
    pub(crate) file: &'static str,
    pub(crate) frequencies: usize,
    pub(crate) sensors: usize,
    /// The last so many frequencies are not identifiable.
    pub(crate) bad: usize,
    pub(crate) fit: &'static str,
    pub(crate) finding: bool,
    pub(crate) free: bool,
    pub(crate) std: bool,
    pub(crate) error_map: bool,
    pub(crate) reduction_error: bool,
    pub(crate) real: bool,
}

impl Default for Made {
    fn default() -> Self {
        Self {
            title: "Made",
            label: "",
            file: "K.mtx",
            frequencies: 100,
            sensors: 2,
            bad: 0,
            fit: "explained",
            finding: false,
            free: false,
            std: false,
            error_map: false,
            reduction_error: true,
            real: false,
        }
    }
}

impl Made {
    fn frequency(&self, i: usize) -> f64 {
        20.0 + 0.5 * i as f64
    }

    /// A modulus that rises, with a peak in the middle that one frequency has.
    fn storage(&self, i: usize) -> f64 {
        let peak = if i == self.frequencies / 2 { 0.5 } else { 0.0 };
        2e6 * (1.0 + 0.3 * i as f64 / self.frequencies as f64 + peak)
    }

    /// The largest storage modulus.
    pub(crate) fn largest(&self) -> f64 {
        (0..self.frequencies).map(|i| self.storage(i)).fold(0.0, f64::max)
    }

    fn status(&self, i: usize) -> &'static str {
        if i + self.bad >= self.frequencies { "not_identifiable" } else { "ok" }
    }
}

/// The files.
pub(crate) fn results(made: &Made) -> BTreeMap<&'static str, Vec<u8>> {
    let columns = "frequency_hz,storage,loss_factor,factor_re,factor_im,correction_re,correction_im,error,spectral_radius,order,candidate_count,status,\
                   convergence_radius,required_order,reduction_error,storage_std,loss_factor_std,storage_loss_correlation,storage_std_noise,storage_std_model,storage_std_known_factors,chi2\n";
    let (mut identified, mut reference) =
        (columns.to_owned(), "frequency_hz,nominal_re,nominal_im,true_re,true_im\n".to_owned());
    let mut response =
        "frequency_hz,sensor,quantity,nominal_re,nominal_im,measured_re,measured_im,updated_re,updated_im,measured_std\n".to_owned();
    let mut candidates = "frequency_hz,storage,loss_factor,correction_re,correction_im,verdict\n".to_owned();
    let label = |m: usize| {
        if m == 0 && !made.label.is_empty() { made.label.to_owned() } else { format!("S{}", m + 1) }
    };
    let quoted = |text: &str| format!("\"{}\"", text.replace('"', "\"\""));
    for i in 0..made.frequencies {
        let (f, e) = (made.frequency(i), made.storage(i));
        let (status, reduction_error) = (made.status(i), if made.reduction_error { "1e-9" } else { "" });
        // Writing to a string does not fail.
        let _ = writeln!(
            identified,
            "{f:?},{e:?},0.2,{e:?},{:?},{:?},1e5,1e-5,0.7,16,2,{status},0.9,12,{reduction_error},{:?},0.001,0.1,{:?},0.0,0.0,1.02",
            0.2 * e,
            e - 1e6,
            1e-3 * e,
            1e-3 * e
        );
        let _ = writeln!(reference, "{f:?},1e6,2e5,{e:?},{:?}", 0.2 * e);
        for m in 0..made.sensors {
            // 1/(E − ω²m) of two moduli, seen with another weight by each sensor.
            let of = |e: f64| {
                let (re, im) = (e - 30.0 * (std::f64::consts::TAU * f).powi(2), 0.2 * e);
                let weight = (m + 1) as f64 / (re * re + im * im);
                (weight * re, -weight * im)
            };
            let ((a, b), (x, y)) = (of(1e6), of(e));
            let std = if made.std { format!("{:?}", 1e-3 * x.hypot(y)) } else { String::new() };
            let label = label(m);
            let label = if m == 0 && !made.label.is_empty() { quoted(&label) } else { label };
            let _ = writeln!(response, "{f:?},{label},receptance,{a:?},{b:?},{x:?},{y:?},{x:?},{y:?},{std}");
        }
        let kinds = ["chosen", "admissible", "alternative", "far"];
        for (k, kind) in kinds.into_iter().enumerate() {
            let _ = writeln!(candidates, "{f:?},{:?},0.2,0.0,0.0,{kind}", (k + 1) as f64 * e);
        }
    }
    let mut tables = vec!["identified.csv", "candidates.csv", "response.csv", "reference.csv"];
    let mut files = BTreeMap::new();
    if made.free {
        files.insert("free.csv", identified.clone().into_bytes());
        tables.push("free.csv");
    }
    if made.error_map {
        let mut map = "frequency_hz,order,error\n".to_owned();
        for i in 0..made.frequencies.min(60) {
            (1..30).for_each(|order| {
                let _ = writeln!(
                    map,
                    "{:?},{order},{}",
                    made.frequency(i),
                    if order == 3 { String::new() } else { format!("1e-{order}") }
                );
            });
        }
        files.insert("error_map.csv", map.into_bytes());
        tables.push("error_map.csv");
    }
    let findings = match made.finding {
        true => json!([{
            "kind": "quantity", "sensors": ["S2"], "what": "accelerance is taken for mobility", "change": "quantity of [[measurement]] 2",
            "numbers": {}, "evidence": {"misfit_before": 2.6, "misfit_after": 0.01, "nats": 1000.0},
        }]),
        false => json!([]),
    };
    let sensors: Vec<_> = (0..made.sensors)
        .map(|m| json!({"label": label(m), "quantity": "receptance", "misfit": 1.0, "contradicts": false, "left_out": false}))
        .collect();
    let summary = json!({
        "frfit": "0.1.0", "title": made.title, "tables": tables, "findings": findings, "sensors": sensors,
        "inputs": [{"file": made.file, "bytes": 1000, "sha256": "00".repeat(32)}],
        "units": {"system": "SI"},
        "model": {"dofs": 10, "nonzeros": 28, "matrices": [{"name": "core", "role": "stiffness"}]},
        "identify": {"method": "rational", "selection": "joint"},
        "unknowns": [{
            "name": "core", "matrices": ["core"], "unit": "Pa", "varies": if made.free { "smooth" } else { "frequency" }, "real": made.real,
            "numbers": null, "status": null, "reference": null,
        }],
        "coordinates": [], "correlation": [], "directions": [], "not_identifiable": [], "profile": null,
        "search": {"converged": true, "starts": 0, "agreeing": 0},
        "fit": {"chi2": 100.0, "freedom": 98, "chi2_per_freedom": 1.02, "deviate": 0.1, "verdict": made.fit},
        "noise": {"source": "given", "level": 1.0},
        "counts": {"subspace_size": 12, "solves": 40},
    });
    files.insert("summary.json", format!("{summary:#}\n").into_bytes());
    for (name, text) in [
        ("identified.csv", identified),
        ("reference.csv", reference),
        ("response.csv", response),
        ("candidates.csv", candidates),
    ] {
        files.insert(name, text.into_bytes());
    }
    files
}
