//! Several unknowns from a case file.

mod common;

use common::{column, done, frfit, refused};
use serde_json::Value;
use std::path::Path;

/// The clamped plate with another `[identify]`.
fn plate(folder: &Path, identify: &str) {
    done(folder, &["--quiet", "example", "clamped-plate", "p"]);
    let file = folder.join("p/case.toml");
    let case = std::fs::read_to_string(&file).unwrap();
    let (before, _) = case.split_once("[identify]").unwrap();
    std::fs::write(file, format!("{before}{identify}")).unwrap();
}

const MODULUS: &str = r#"
[[identify]]
matrix = "plate"
varies = "constant"
band_hz = [100.0, 2000.0]
bounds = { storage = [1e11, 4e11], loss_factor = [0.0, 0.1] }
truth = { storage = 2e11, loss_factor = 0.001 }
"#;

const DENSITY: &str = r#"
[[identify]]
name = "density"
matrix = "mass"
varies = "constant"
real = true
bounds = [5e3, 1e4]
truth = 7800.0
"#;

const THICKNESS: &str = r#"
[[identify]]
name = "thickness"
powers = { plate = 3, mass = 1 }
nominal = 1.0
bounds = [0.5, 2.0]
"#;

fn summary(folder: &Path) -> Value {
    serde_json::from_slice(&std::fs::read(folder.join("out/summary.json")).unwrap()).unwrap()
}

#[test]
fn modulus_and_density_of_a_plate() {
    let folder = tempfile::tempdir().unwrap();
    plate(folder.path(), &format!("{MODULUS}{DENSITY}"));
    let said = done(folder.path(), &["identify", "p/case.toml", "--out", "out", "--strict"]);
    assert!(said.contains("plate") && said.contains("density") && said.contains("truth"), "{said}");
    let summary = summary(folder.path());
    let number =
        |unknown: usize, k: usize| summary["unknowns"][unknown]["numbers"][k]["value"].as_f64().unwrap();
    // Exact data, a nominal modulus 25 % off: what is left is the subspace.
    for (found, exact) in [(number(0, 0), 2e11), (number(0, 1), 1e-3), (number(1, 0), 7800.0)] {
        assert!((found / exact - 1.0).abs() < 1e-6, "{found} for {exact}");
    }
    assert_eq!(summary["trusted"], true);
    assert_eq!(summary["not_told"], serde_json::json!([]));
    assert!(summary["counts"]["factorisations"].as_u64().unwrap() <= 2, "{}", summary["counts"]);
    let table = std::fs::read_to_string(folder.path().join("out/identified.csv")).unwrap();
    assert!(column(&table, "status").iter().all(|status| status == "ok"));
    assert_eq!(column(&table, "density.value").len(), column(&table, "plate.storage").len());
    for file in ["response.csv", "updated.uff", "figures/accelerance.svg", "figures/profile.png"] {
        assert!(folder.path().join("out").join(file).exists(), "{file}");
    }
}

#[test]
fn what_cannot_be_told_apart_is_said_in_words() {
    let folder = tempfile::tempdir().unwrap();
    plate(folder.path(), &format!("{MODULUS}{DENSITY}{THICKNESS}"));
    let output = frfit(folder.path(), &["identify", "p/case.toml", "--out", "out", "--strict"]);
    // Done, but not trusted.
    assert_eq!(output.status.code(), Some(1), "{}", String::from_utf8_lossy(&output.stderr));
    let said = String::from_utf8(output.stdout).unwrap();
    // E h³ and ρ h: where h falls by 1, E grows by 3 and ρ by 1.
    let line =
        said.lines().find(|line| line.contains("nothing tells it")).unwrap_or_else(|| panic!("{said}"));
    let words = "plate storage, density (by 0.33 of that) larger with thickness (by 0.33 of that) smaller";
    assert!(line.contains(words), "{line}");
    let summary = summary(folder.path());
    assert_eq!(summary["trusted"], false);
    assert_eq!(summary["unknowns"][2]["status"], "ill_conditioned");
}

#[test]
fn faults_are_told_with_their_place() {
    let refused_with = |identify: &str, words: &[&str]| {
        let folder = tempfile::tempdir().unwrap();
        plate(folder.path(), identify);
        let said = refused(folder.path(), &["identify", "p/case.toml", "--out", "out"]);
        assert!(said.contains("case.toml:") && words.iter().all(|word| said.contains(word)), "{said}");
        assert!(!folder.path().join("out").exists(), "nothing is written");
    };
    let freely = MODULUS.replace("varies = \"constant\"\n", "");
    let other = "[[identify]]\nmatrix = \"mass\"\n";
    // One sensor: two real numbers at each frequency, four unknown.
    refused_with(&format!("{freely}{other}"), &["4 unknown real numbers", "2 measured"]);
    // Both of them are taken by the modulus.
    refused_with(&format!("{freely}{DENSITY}"), &["unknown real numbers", "measured"]);
    refused_with(&format!("{MODULUS}{MODULUS}"), &["this key in the first"]);
    refused_with(
        &format!(
            "{MODULUS}{}",
            MODULUS.replace("matrix", "name = \"again\"\nmatrix").replace("band_hz = [100.0, 2000.0]", "")
        ),
        &["each matrix's factor in one unknown"],
    );
    refused_with(&format!("{MODULUS}{}", THICKNESS.replace("mass = 1", "maas = 1")), &["maas", "mass"]);
    refused_with(&format!("{MODULUS}{}", THICKNESS.replace("plate = 3", "plate = 0")), &["other than 0"]);
    refused_with(&format!("{MODULUS}{}", THICKNESS.replace("nominal = 1.0", "")), &["nominal"]);
    refused_with(
        &format!("{MODULUS}{}", DENSITY.replace("varies = \"constant\"", "varies = \"law\"")),
        &["real"],
    );
    refused_with(&format!("{MODULUS}{}", DENSITY.replace("bounds", "band_hz")), &["first [[identify]]"]);
    let folder = tempfile::tempdir().unwrap();
    plate(folder.path(), &format!("{MODULUS}{DENSITY}"));
    let said = refused(folder.path(), &["check", "p/case.toml"]);
    assert!(said.contains("one unknown that varies"), "{said}");
    let said = refused(folder.path(), &["identify", "p/case.toml", "--out", "out", "--method", "series"]);
    assert!(said.contains("--method"), "{said}");
}
