//! Several unknowns from a case file.

use crate::common;
use crate::picture::assert_shows_something;
use crate::tier::of_tier;

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
reference = { storage = 2e11, loss_factor = 0.001 }
"#;

const DENSITY: &str = r#"
[[identify]]
name = "density"
matrix = "mass"
varies = "constant"
real = true
bounds = [5e3, 1e4]
reference = 7800.0
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
    assert!(said.contains("plate") && said.contains("density") && said.contains("reference"), "{said}");
    let summary = summary(folder.path());
    let number =
        |unknown: usize, k: usize| summary["unknowns"][unknown]["numbers"][k]["value"].as_f64().unwrap();
    // Exact data, a nominal modulus 25 % off: what is left is the subspace.
    for (found, exact) in [(number(0, 0), 2e11), (number(0, 1), 1e-3), (number(1, 0), 7800.0)] {
        assert!((found / exact - 1.0).abs() < 1e-6, "{found} for {exact}");
    }
    assert_eq!(summary["trusted"], true);
    assert_eq!(summary["not_identifiable"], serde_json::json!([]));
    assert!(summary["counts"]["factorisations"].as_u64().unwrap() <= 2, "{}", summary["counts"]);
    let table = std::fs::read_to_string(folder.path().join("out/identified.csv")).unwrap();
    assert!(column(&table, "status").iter().all(|status| status == "ok"));
    assert_eq!(column(&table, "density.storage").len(), column(&table, "plate.storage").len());
    for file in ["response.csv", "updated.uff", "figures/accelerance.svg"] {
        assert!(folder.path().join("out").join(file).exists(), "{file}");
    }
    assert_shows_something(&folder.path().join("out/figures/profile.png"));
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
        said.lines().find(|line| line.starts_with("  not identifiable")).unwrap_or_else(|| panic!("{said}"));
    let words = "plate storage, density (by 0.33 of that) larger with thickness (by 0.33 of that) smaller";
    assert!(line.contains(words), "{line}");
    let summary = summary(folder.path());
    assert_eq!(summary["trusted"], false);
    assert_eq!(summary["unknowns"][2]["status"], "not_identifiable");
}

#[test]
fn faults_are_told_with_their_place() {
    let folder = tempfile::tempdir().unwrap();
    plate(folder.path(), "");
    let file = folder.path().join("p/case.toml");
    let before = std::fs::read_to_string(&file).unwrap();
    let refused_with = |identify: &str, words: &[&str]| {
        std::fs::write(&file, format!("{before}{identify}")).unwrap();
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
    std::fs::write(&file, format!("{before}{MODULUS}{DENSITY}")).unwrap();
    let said = done(folder.path(), &["check", "p/case.toml"]);
    assert!(said.contains("no finding"), "{said}");
    let said = refused(folder.path(), &["identify", "p/case.toml", "--out", "out", "--method", "series"]);
    assert!(said.contains("--method"), "{said}");
}

/// The matrix of a file times p^power at each of some values, in files of their own; their names as TOML has them.
fn at_values(folder: &Path, matrix: &str, values: &[f64], power: i32) -> String {
    let text = std::fs::read_to_string(folder.join(matrix)).unwrap();
    let name = |value: f64| format!("{}-{value}.mtx", matrix.trim_end_matches(".mtx"));
    for &value in values {
        let mut past_size = false;
        let line = |line: &str| match line.rsplit_once(' ') {
            Some((position, entry)) if past_size => {
                format!("{position} {:e}\n", value.powi(power) * entry.parse::<f64>().unwrap())
            }
            _ => {
                past_size = !line.starts_with('%');
                format!("{line}\n")
            }
        };
        std::fs::write(folder.join(name(value)), text.lines().map(line).collect::<String>()).unwrap();
    }
    let files: Vec<String> = values.iter().map(|&value| format!("{:?}", name(value))).collect();
    format!("at = {{ dimension = \"thickness\", values = {values:?}, files = [{}] }}", files.join(", "))
}

/// The clamped plate with its true modulus and matrices at values of its thickness, which is looked for from 1.04.
fn plate_at_values(folder: &Path, of_stiffness: &[f64]) {
    const NOMINAL: &str = "[[identify]]\nname = \"thickness\"\nnominal = 1.04\nband_hz = [100.0, 2000.0]\nbounds = [0.8, 1.25]\nreference = 1.0\n";
    plate(folder, NOMINAL);
    done(folder, &["--quiet", "convert", "p/K.rsa", "p/K.mtx"]);
    let [stiffness, mass] = [("K.mtx", of_stiffness, 3), ("M.mtx", &[0.9, 1.1, 1.0], 1)]
        .map(|(matrix, values, power)| at_values(&folder.join("p"), matrix, values, power));
    let file = folder.join("p/case.toml");
    let case = std::fs::read_to_string(&file).unwrap().replace("2.5e11", "2e11");
    let by_powers = case.replace("nominal = 1.04", "nominal = 1.04\npowers = { plate = 3, mass = 1 }");
    std::fs::write(folder.join("p/powers.toml"), by_powers).unwrap();
    let case = case.replace("file = \"M.mtx\"", &mass).replace("file = \"K.rsa\"", &stiffness);
    std::fs::write(file, case).unwrap();
}

#[test]
fn a_thickness_from_matrices_at_its_values() {
    let folder = tempfile::tempdir().unwrap();
    plate_at_values(folder.path(), &[0.9, 0.95, 1.0, 1.05, 1.1]);
    done(folder.path(), &["--quiet", "identify", "p/case.toml", "--out", "out", "--strict"]);
    let found = summary(folder.path())["unknowns"][0]["numbers"][0]["value"].as_f64().unwrap();
    // exact data, and a cube from four values that differ by a twentieth: rounding times some ten thousand
    assert!((found - 1.0).abs() < 1e-8, "{found}");
    // Whoever does not look for the thickness has the plate at its nominal value, by either way.
    let [by_values, by_powers] = ["case", "powers"].map(|case| {
        done(folder.path(), &["--quiet", "respond", &format!("p/{case}.toml"), "--out", case]);
        let table = std::fs::read_to_string(folder.path().join(case).join("response.csv")).unwrap();
        let mut lines = table.lines().skip_while(|line| line.starts_with('#')).skip(1);
        let row = lines.nth(40).unwrap();
        row.split(',').filter_map(|cell| cell.parse().ok()).collect::<Vec<f64>>()
    });
    assert!(by_values.len() >= 3 && by_values.len() == by_powers.len());
    for (a, b) in by_values.iter().zip(&by_powers) {
        // near a resonance of a plate with η = 1e-3 rounding is a thousand times larger
        assert!((a - b).abs() < 1e-7 * b.abs(), "{by_values:?} {by_powers:?}");
    }
}

#[test]
fn a_polynomial_of_too_low_a_degree_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    plate_at_values(folder.path(), &[0.9, 1.0, 1.1]);
    let said = refused(folder.path(), &["identify", "p/case.toml", "--out", "out"]);
    assert!(said.contains("degree 1 in thickness") && said.contains("beside it at 1"), "{said}");
}

#[test]
fn a_dimension_without_a_nominal_value_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    plate_at_values(folder.path(), &[0.9, 0.95, 1.0, 1.05, 1.1]);
    let file = folder.path().join("p/case.toml");
    let case = std::fs::read_to_string(&file).unwrap();
    let (before, _) = case.split_once("[[identify]]").unwrap();
    std::fs::write(&file, format!("{before}[identify]\nmatrix = \"mass\"\n")).unwrap();
    for command in ["identify", "respond"] {
        let said = refused(folder.path(), &[command, "p/case.toml", "--out", "out"]);
        assert!(said.contains("an [[identify]] with name = \"thickness\" and its nominal value"), "{said}");
    }
}

/// A modulus at every frequency, a constant and a geometric parameter: every command takes such a case.
#[test]
fn three_unknowns_through_every_command() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    done(folder.path(), &["--quiet", "example", "two-materials", "p"]);
    let case = std::fs::read_to_string(at("p/case.toml")).unwrap();
    let (before, _) = case.split_once("# Each varies").unwrap();
    let unknowns = r#"
[[identify]]
matrix = "core"
band_hz = [20.0, 1000.0]
max_lines = LINES
exclude_hz = [[490.0, 510.0]]
bounds = { storage = [1e5, 1e8], loss_factor = [0.0, 3.0] }
reference = { law = "fractional", e0 = 8.14e5, e1 = 7.31e4, alpha = 0.528 }

[[identify]]
matrix = "skins"
varies = "constant"
bounds = { storage = [1e10, 2e11], loss_factor = [0.0, 0.2] }
reference = { storage = 6.2e10, loss_factor = 0.01 }

[[identify]]
name = "filling"
powers = { core-mass = 1 }
nominal = 1.2
bounds = [0.5, 2.0]
reference = 1.0
"#;
    let [lines, of_check] = of_tier([10, 8], [32, 12]).map(|count| format!("max_lines = {count}"));
    let unknowns = unknowns.replace("max_lines = LINES", &lines);
    std::fs::write(at("p/case.toml"), format!("{before}{unknowns}")).unwrap();

    let said = done(folder.path(), &["identify", "p/case.toml", "--out", "out", "--strict"]);
    let summary = summary(folder.path());
    assert_eq!(summary["trusted"], true, "{said}");
    let excluded = summary["status"]["out_of_band"].as_u64().unwrap();
    assert!(excluded > 0 && summary["frequencies"] == summary["status"]["ok"].as_u64().unwrap() + excluded);
    assert_eq!(summary["unknowns"][0]["reference"]["wrong_and_ok"], 0, "{said}");
    for (unknown, exact) in [(1, 6.2e10), (2, 1.0)] {
        let found = summary["unknowns"][unknown]["numbers"][0]["value"].as_f64().unwrap();
        assert!((found / exact - 1.0).abs() < 1e-6, "{found} for {exact}");
    }
    let table = std::fs::read_to_string(at("out/identified.csv")).unwrap();
    let status = column(&table, "status");
    assert_eq!(status.iter().filter(|status| **status == "out_of_band").count() as u64, excluded);
    done(folder.path(), &["report", "out"]);
    assert!(std::fs::read_to_string(at("out/report.html")).unwrap().contains("filling"));

    // One of the unknowns as a material; without a name the names are listed.
    let export = ["export", "csv", "out/identified.csv", "-o", "core.csv"];
    let said = refused(folder.path(), &export);
    assert!(said.contains("--unknown: expected one of \"core\", \"skins\", \"filling\""), "{said}");
    done(folder.path(), &[&export[..], &["--unknown", "core"]].concat());
    let exported = std::fs::read_to_string(at("core.csv")).unwrap();
    let rows = |table: &str, f: &str, name: &str| -> Vec<[f64; 2]> {
        // The line of units, and rows without a value, have no numbers.
        let number = |cell: String| cell.parse::<f64>().ok();
        let [f, e] = [f, name].map(|name| column(table, name));
        f.into_iter().zip(e).filter_map(|(f, e)| Some([number(f)?, number(e)?])).collect()
    };
    let names: Vec<&str> = exported.lines().next().unwrap().split(',').collect();
    assert_eq!(
        rows(&exported, names[0], "storage"),
        rows(&table, "frequency_hz", "core.storage"),
        "{names:?}"
    );
    assert!(refused(folder.path(), &[&export[..], &["--unknown", "skin"]].concat()).contains("\"skin\""));

    // A sign that is wrong is found beside three unknowns.
    let right = std::fs::read_to_string(at("p/case.toml")).unwrap();
    let wrong = right.replace("dof = \"248+Z\"", "scale = -1.0\ndof = \"248+Z\"").replace(&lines, &of_check);
    std::fs::write(at("p/wrong.toml"), wrong).unwrap();
    let said = done(folder.path(), &["check", "p/wrong.toml"]);
    assert!(said.contains("  sign") && said.contains("248"), "{said}");
}

/// The joint is softer than the bounds allow. Errors of the model explain the band beside it, but nothing is trusted.
#[test]
fn a_constant_that_stops_at_its_bounds_is_not_ok() {
    let folder = tempfile::tempdir().unwrap();
    done(folder.path(), &["--quiet", "example", "joint-stiffness", "j"]);
    let case = folder.path().join("j/case.toml");
    let text = std::fs::read_to_string(&case).unwrap();
    assert!(text.contains("storage = [100.0, 1e5]"));
    std::fs::write(&case, text.replace("storage = [100.0, 1e5]", "storage = [2500.0, 9000.0]")).unwrap();
    let said = done(folder.path(), &["identify", "j/case.toml", "--out", "out", "--band", "10:500"]);
    assert!(said.contains("at its bounds"), "{said}");
    assert!(!said.contains(" ok"), "{said}");
}
