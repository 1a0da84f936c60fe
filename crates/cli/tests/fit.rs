//! Laws: fitted to tables of moduli, and straight to FRFs.

mod common;

use common::{column, data, done, refused};
use frfit::c64;
use frfit::laws::Family;
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
        // Multiples of the golden section fill an interval evenly; uniform in ±√3 has deviation one.
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
        assert_eq!(summary["laws"].as_array().unwrap().len(), Family::ALL.len());
        let zener = law(&summary, "zener");
        // E0 is 19 deviations off without that: the band hardly tells it, and the mesh is in the same sense wrong everywhere, which no correlation that has an end says whole.
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
    set(&case, "[identify]", "[identify]\nvaries = \"smooth\"\nleave_out_hz = [[490.0, 510.0]]");
    let summary = json(&done(folder.path(), &["identify", "bar/case.toml", "--out", "out", "--json"]));
    assert_eq!(summary["identify"]["varies"], "smooth");
    let out = summary["identify"]["left_out"].as_u64().unwrap();
    assert!(out > 5 && summary["status"]["ok"] == 676 - out, "{:#}", summary["status"]);
    let curve = &summary["smooth"];
    assert!(curve["converged"] == true && curve["unexplained"] == 0, "{curve:#}");
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
