//! Laws: fitted to tables of moduli, and straight to FRFs.

use crate::common;
use crate::outside::python_with;
use crate::picture::assert_shows_something;
use crate::tier::of_tier;

use common::{column, data, done, refused};
use frfit::c64;
use frfit::laws::LawKind;
use frfit::material::{Law, loss_factor};
use serde_json::Value;
use std::path::Path;
use std::process::Command;

fn json(text: &str) -> Value {
    serde_json::from_str(text).unwrap()
}

/// A table of a law as `identified.csv` has it, with a deterministic scatter of one percent of either part.
fn table(law: &Law, deviations: bool) -> String {
    let mut text = String::from("frequency_hz,storage,loss_factor,status");
    text += if deviations { ",storage_std,loss_factor_std\n" } else { "\n" };
    for k in 0..60u32 {
        let f = 10.0 * 10f64.powf(f64::from(k) / 20.0);
        let exact: c64 = law.at(f).unwrap();
        // Multiples of the golden section fill an interval evenly; uniform in ±√3 has standard deviation one.
        let spread = |by: f64| 3f64.sqrt() * (2.0 * (f64::from(k + 1) * by).fract() - 1.0);
        let (s, t) = (0.01 * exact.re, 0.01 * loss_factor(exact));
        let storage = exact.re + s * spread(0.618_033_988_749_894_8);
        let eta = loss_factor(exact) + t * spread(0.754_877_666_246_692_7);
        let status = if k % 10 == 9 { "ambiguous" } else { "ok" };
        // A wrong value that its status excludes.
        let storage = if status == "ok" { storage } else { 100.0 * storage };
        text += &format!("{f},{storage},{eta},{status}");
        text += &if deviations { format!(",{s},{t}\n") } else { "\n".into() };
    }
    text
}

fn zener() -> Law {
    Law::FractionalZener { e0: 4e6, e_infinity: 2.9e7, tau_s: 1e-3, alpha: 0.7 }
}

fn law<'a>(summary: &'a Value, name: &str) -> &'a Value {
    summary["laws"].as_array().unwrap().iter().find(|law| law["law"] == name).unwrap()
}

#[test]
fn a_table_of_moduli_tells_its_law() {
    let folder = tempfile::tempdir().unwrap();
    for deviations in [true, false] {
        std::fs::write(folder.path().join("identified.csv"), table(&zener(), deviations)).unwrap();
        let said = done(folder.path(), &["fit", "identified.csv", "--out", "laws", "--json"]);
        let summary = json(&said);
        assert_eq!((&summary["best"], &summary["left_out"]), (&json("\"zener\""), &json("6")));
        assert_eq!(summary["laws"].as_array().unwrap().len(), LawKind::ALL.len());
        let zener = law(&summary, "zener");
        for (name, value) in [("e0", 4e6), ("e_infinity", 2.9e7), ("tau", 1e-3), ("alpha", 0.7)] {
            let parameter = &zener["parameters"][name];
            let off = (parameter["value"].as_f64().unwrap() - value) / parameter["std"].as_f64().unwrap();
            // Scatter that is evener than noise is nearer than noise would be.
            assert!(off.abs() < 3.0, "{name}: {parameter}");
        }
        let written = std::fs::read_to_string(folder.path().join("laws/law.json")).unwrap();
        assert_eq!(json(&written), summary);
        assert!(folder.path().join("laws/figures/laws.svg").exists());
        assert_shows_something(&folder.path().join("laws/figures/laws.png"));
    }
    let said = done(folder.path(), &["fit", "identified.csv", "--law", "zener,constant"]);
    assert!(said.contains("factor = { law = \"zener\", e0 = "), "{said}");
    assert!(!folder.path().join("law.json").exists());
}

#[test]
fn a_law_with_more_parameters_than_the_table_shows_is_not_settled_and_the_words_say_what_helps() {
    let folder = tempfile::tempdir().unwrap();
    // A constant without damping: any Zener body that is stiff enough has it.
    let lines: String = (1..30).map(|k| format!("{},2e9,0\n", 100 * k)).collect();
    std::fs::write(folder.path().join("flat.csv"), "frequency_hz,storage,loss_factor\n".to_owned() + &lines)
        .unwrap();
    let said = done(folder.path(), &["fit", "flat.csv", "--law", "zener"]);
    assert!(said.contains("agree, not settled"), "{said}");
    assert!(said.contains("the search for zener did not converge"), "{said}");
    assert!(said.contains("take a law with fewer parameters"), "{said}");
    let said = done(folder.path(), &["fit", "flat.csv", "--law", "constant"]);
    assert!(!said.contains("did not converge"), "{said}");
}

#[test]
fn what_is_no_table_or_no_law_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("one.csv"), "frequency_hz,storage,loss_factor\n1,2,3\n").unwrap();
    let message = refused(folder.path(), &["fit", "one.csv", "--law", "zener"]);
    assert_eq!(message, "frfit: one.csv: expected at least 2 moduli, for 4 parameters, found 1\n");
    let message = refused(folder.path(), &["fit", "one.csv", "--law", "zenner"]);
    assert!(message.contains("\"zener\""), "{message}");
    let message = refused(folder.path(), &["fit", "none.csv"]);
    assert!(message.contains("none.csv: expected a file"), "{message}");
}

/// A table of dynamic mechanical analysis: 26 decades of a polymer, E′ and E″ in MPa.
#[test]
#[ignore = "needs the data of ../shared/data"]
fn tables_of_dynamic_mechanical_analysis_are_read_as_they_are_needs_data() {
    let folder = tempfile::tempdir().unwrap();
    let master = data("viscoelastic/freq_user_master.csv");
    let arguments = ["fit", master.to_str().unwrap(), "--law", "fractional,zener,maxwell:8", "--json"];
    let summary = json(&done(folder.path(), &arguments));
    assert_eq!(summary["moduli"], 206);
    // MPa are converted: the glassy modulus is some GPa.
    let glassy = law(&summary, "zener")["parameters"]["e_infinity"]["value"].as_f64().unwrap();
    assert!((1e9..1e11).contains(&glassy), "{glassy:e}");
    // Raw data are those of several temperatures, one after the other.
    let raw = data("viscoelastic/freq_user_raw.csv");
    let message = refused(folder.path(), &["fit", raw.to_str().unwrap()]);
    assert!(message.contains("expected each frequency once"), "{message}");
    // The column Set numbers the temperatures.
    let one = ["fit", raw.to_str().unwrap(), "--where", "Set=3", "--law", "fractional", "--json"];
    let summary = json(&done(folder.path(), &one));
    assert!((5..40).contains(&summary["moduli"].as_u64().unwrap()), "{summary:#}");
    let message = refused(folder.path(), &["fit", raw.to_str().unwrap(), "--where", "Set=99"]);
    assert!(
        message.contains("expected a row with \"99\" in column \"Set\", found only 0, 1, 2"),
        "{message}"
    );
}

const SCRIPT: &str = "
import sys, json
import numpy as np
from scipy.optimize import curve_fit
t = np.genfromtxt(sys.argv[1], delimiter=',', names=True, dtype=None, encoding=None)
t = t[t['status'] == 'ok']
w = 2*np.pi*t['frequency_hz']
def model(_, l0, l8, lt, a):
    e0, e8 = np.exp(l0), np.exp(l8)
    z = (1j*w*np.exp(lt))**a
    e = (e0 + e8*z)/(1 + z)
    return np.concatenate([e.real, e.imag/e.real])
y = np.concatenate([t['storage'], t['loss_factor']])
s = np.concatenate([t['storage_std'], t['loss_factor_std']])
p, c = curve_fit(model, None, y, p0=[np.log(4e6), np.log(2.9e7), np.log(1e-3), 0.7], sigma=s, absolute_sigma=True)
d = np.sqrt(np.diag(c))
print(json.dumps({'e0': [np.exp(p[0]), np.exp(p[0])*d[0]], 'e_infinity': [np.exp(p[1]), np.exp(p[1])*d[1]], 'tau': [np.exp(p[2]), np.exp(p[2])*d[2]], 'alpha': [p[3], d[3]]}))
";

#[test]
#[ignore = "needs Python with SciPy"]
fn scipy_finds_the_same_law_with_the_same_error_bars_needs_scipy() {
    let python = python_with("scipy");
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("t.csv"), table(&zener(), true)).unwrap();
    let summary = json(&done(folder.path(), &["fit", "t.csv", "--law", "zener", "--json"]));
    let output =
        Command::new(&python).args(["-c", SCRIPT]).arg(folder.path().join("t.csv")).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let theirs = json(&String::from_utf8(output.stdout).unwrap());
    for name in ["e0", "e_infinity", "tau", "alpha"] {
        let ours = &law(&summary, "zener")["parameters"][name];
        let (value, std) = (ours["value"].as_f64().unwrap(), ours["std"].as_f64().unwrap());
        let (their_value, their_std) = (theirs[name][0].as_f64().unwrap(), theirs[name][1].as_f64().unwrap());
        // Both searches end within a thousandth of a standard deviation; theirs has slopes by differences, good to half the digits.
        assert!(
            (value - their_value).abs() < 2e-3 * their_std,
            "{name}: {value} {their_value} ± {their_std}"
        );
        assert!((std / their_std - 1.0).abs() < 1e-3, "{name}: {std} {their_std}");
    }
}

fn set(case: &Path, from: &str, to: &str) {
    let text = std::fs::read_to_string(case).unwrap();
    assert!(text.contains(from), "{from} is not in\n{text}");
    std::fs::write(case, text.replacen(from, to, 1)).unwrap();
}

/// The hammer test, with the law that its bar was made of.
#[test]
fn a_law_is_found_from_a_hammer_test() {
    let folder = tempfile::tempdir().unwrap();
    done(folder.path(), &["--quiet", "example", "hammer-bar", "bar"]);
    done(folder.path(), &["--quiet", "frf", "bar/records.lvm", "-o", "bar/frf.uff"]);
    let keys = "[identify]\nvaries = \"law\"\nlaw = [\"constant\", \"fractional\", \"zener\"]";
    let lines = of_tier(200, 676);
    let keys = format!("{keys}\nmax_lines = {lines}");
    set(&folder.path().join("bar/case.toml"), "[identify]", &keys);
    let summary = json(&done(folder.path(), &["identify", "bar/case.toml", "--out", "out", "--json"]));
    assert_eq!(summary["laws"]["best"], "zener", "{:#}", summary["laws"]);
    assert_eq!(summary["status"]["ok"], lines, "{:#}", summary["status"]);
    let zener = law(&summary["laws"], "zener");
    let found = |name: &str| zener["parameters"][name]["value"].as_f64().unwrap();
    // The band is above the transition: E∞ and α are identified well, E₀ and τ by what is left of it. The mesh takes up to 3.2(kh)²/12 = 1.6e-4 of the modulus.
    assert!((found("e_infinity") / 2.9e7 - 1.0).abs() < 0.02, "{zener:#}");
    let written = json(&std::fs::read_to_string(folder.path().join("out/law.json")).unwrap());
    assert_eq!(written, summary["laws"]);
    let read = |name: &str| std::fs::read_to_string(folder.path().join(name)).unwrap();
    let (table, truth) = (read("out/identified.csv"), read("bar/truth.csv"));
    let numbers = |table: &str, name: &str| {
        column(table, name).iter().map(|cell| cell.parse().unwrap_or(f64::NAN)).collect::<Vec<f64>>()
    };
    let [f, storage, std, eta, eta_std] =
        ["frequency_hz", "storage", "storage_std", "loss_factor", "loss_factor_std"]
            .map(|n| numbers(&table, n));
    let [at, true_storage, true_eta] = ["frequency_hz", "storage", "loss_factor"].map(|n| numbers(&truth, n));
    let status = column(&table, "status");
    for k in (0..f.len()).filter(|&k| status[k] == "ok") {
        let row = at.iter().position(|at| *at == f[k]).unwrap();
        let (off, off_eta) = (storage[k] / true_storage[row] - 1.0, eta[k] - true_eta[row]);
        assert!(off.abs() < 2e-3 && off_eta.abs() < 2e-3, "{} Hz: {off:e} {off_eta:e}", f[k]);
        assert!(std[k] > 0.0 && std[k] < 2e-3 * storage[k] && eta_std[k] < 2e-3, "{} Hz: {:e}", f[k], std[k]);
    }
    // What the law leaves is no noise of each line, and the bars are wider for it.
    let say = zener["residuals_say"].as_str().unwrap();
    assert!(say.starts_with("residuals correlated over ") && say.contains(" lines"), "{say}");
    // E0, which the band hardly identifies, would be 19 standard deviations off without: the mesh is wrong in the same sense everywhere, which no correlation that ends says wholly.
    let e0 = &zener["parameters"]["e0"];
    let off = (e0["value"].as_f64().unwrap() - 4e6).abs() / e0["std"].as_f64().unwrap();
    assert!(off < 4.0 && zener["widened"]["e0"].as_f64().unwrap() > 3.0, "{e0} {off}");
    // What each frequency says is kept beside it, and the law's table is one that `fit` reads.
    assert_eq!(column(&read("out/free.csv"), "status").len(), 676);
    let again = json(&done(folder.path(), &["fit", "out/identified.csv", "--law", "zener", "--json"]));
    let again = law(&again, "zener")["parameters"]["e_infinity"]["value"].as_f64().unwrap();
    assert!((again / found("e_infinity") - 1.0).abs() < 1e-3, "{again:e}");
    assert!(folder.path().join("out/figures/modulus.svg").exists());
}

/// The hammer test with a smooth modulus: it is right to the mesh, a left-out band is bridged, and what it does not go with is refused.
#[test]
fn a_smooth_modulus_is_found_from_a_hammer_test() {
    let folder = tempfile::tempdir().unwrap();
    done(folder.path(), &["--quiet", "example", "hammer-bar", "bar"]);
    done(folder.path(), &["--quiet", "frf", "bar/records.lvm", "-o", "bar/frf.uff"]);
    let case = folder.path().join("bar/case.toml");
    set(&case, "[identify]", "[identify]\nvaries = \"smooth\"\nexclude_hz = [[490.0, 510.0]]");
    let summary = json(&done(folder.path(), &["identify", "bar/case.toml", "--out", "out", "--json"]));
    assert_eq!(summary["identify"]["varies"], "smooth");
    let out = summary["identify"]["left_out"].as_u64().unwrap();
    assert!(out > 5 && summary["status"]["ok"] == 676 - out, "{:#}", summary["status"]);
    let curve = &summary["smooth"];
    assert!(curve["converged"] == true && curve["outliers"] == 0, "{curve:#}");
    assert!(
        curve["parameters"].as_f64().unwrap() > 2.0 && curve["width_octaves"].as_f64().unwrap() > 0.0,
        "{curve:#}"
    );
    let read = |name: &str| std::fs::read_to_string(folder.path().join(name)).unwrap();
    let (table, truth) = (read("out/identified.csv"), read("bar/truth.csv"));
    let numbers = |table: &str, name: &str| {
        column(table, name).iter().map(|cell| cell.parse().unwrap_or(f64::NAN)).collect::<Vec<f64>>()
    };
    let [f, storage, std, eta] =
        ["frequency_hz", "storage", "storage_std", "loss_factor"].map(|name| numbers(&table, name));
    let [at, true_storage, true_eta] = ["frequency_hz", "storage", "loss_factor"].map(|n| numbers(&truth, n));
    for (k, status) in column(&table, "status").iter().enumerate() {
        let row = at.iter().position(|at| *at == f[k]).unwrap();
        let (off, off_eta) = (storage[k] / true_storage[row] - 1.0, eta[k] - true_eta[row]);
        // The mesh and the cut record leave some 4e-4 of the response; bridged rows are as good, and keep their status.
        assert!(off.abs() < 5e-3 && off_eta.abs() < 5e-3, "{} Hz {status}: {off:e} {off_eta:e}", f[k]);
        assert!(std[k] > 0.0, "{} Hz {status}", f[k]);
        assert_eq!(status == "out_of_band", (490.0..=510.0).contains(&f[k]), "{} Hz", f[k]);
    }
    assert_eq!(column(&read("out/free.csv"), "status").len(), 676);
    assert!(folder.path().join("out/figures/modulus.svg").exists());
    set(&case, "varies = \"smooth\"", "varies = \"smooth\"\nlaw = \"zener\"");
    let message = refused(folder.path(), &["identify", "bar/case.toml", "--out", "out"]);
    assert!(message.contains("expected varies = \"law\" beside it"), "{message}");
    set(&case, "varies = \"smooth\"\nlaw = \"zener\"", "varies = \"smooth\"\nselection = \"smallest\"");
    let message = refused(folder.path(), &["identify", "bar/case.toml", "--out", "out"]);
    assert!(message.contains("\"smooth\" with selection \"smallest\""), "{message}");
}
