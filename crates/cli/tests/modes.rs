//! `frfit modes`: modes of the model beside those of the measurement.

use crate::common;

use common::{column, done, frfit, refused};
use std::fmt::Write;
use std::fs;
use std::path::Path;

/// A case in which nothing was measured: the matrices of the sandwich, places for its sensors, and what is said of them.
fn unmeasured(folder: &Path, rest: &str) {
    done(folder, &["--quiet", "example", "sandwich", "s"]);
    let text = fs::read_to_string(folder.join("s/case.toml")).unwrap();
    let (model, _) = text.split_once("[[measurement]]").unwrap();
    let sensors = "[[measurement]]\ndof = \"248+Z\"\n[[measurement]]\ndof = \"202+Z\"\n";
    fs::write(folder.join("s/plan.toml"), format!("{model}{sensors}{rest}")).unwrap();
}

fn json(file: &Path) -> serde_json::Value {
    serde_json::from_str(&fs::read_to_string(file).unwrap()).unwrap()
}

/// Numbers of a column, in the rows that have one.
fn numbers(table: &str, name: &str) -> Vec<f64> {
    column(table, name).iter().filter(|cell| !cell.is_empty()).map(|cell| cell.parse().unwrap()).collect()
}

/// A report without what differs between machines: seconds and solves, what is left of exact data, and what these say of a mode between the lines.
fn portable(text: &str) -> String {
    let mut masked = String::new();
    for line in text.lines() {
        let first = line.split_whitespace().next();
        let _ = match (first, line.split_once(" factorisations, ")) {
            (_, Some((before, _))) => {
                writeln!(masked, "{before} factorisations, [solves], [vectors], [seconds]")
            }
            (Some("remainder"), _) => writeln!(masked, "  remainder         [level] is left"),
            (Some("383.79"), _) => writeln!(masked, "      383.79  [a mode between the lines]"),
            _ => writeln!(masked, "{line}"),
        };
    }
    masked
}

#[test]
fn all_measured_modes_of_a_sandwich_have_a_partner() {
    let folder = tempfile::tempdir().unwrap();
    done(folder.path(), &["--quiet", "example", "sandwich", "s"]);
    let said = done(folder.path(), &["modes", "s/case.toml", "--out", "out"]);
    insta::assert_snapshot!("modes", portable(&said));
    let out = folder.path().join("out");
    let table = fs::read_to_string(out.join("modes.csv")).unwrap();
    assert_eq!(
        table.lines().next().unwrap(),
        "kind,model_mode,model_frequency_hz,model_damping_ratio,measured_mode,measured_frequency_hz,\
         measured_frequency_std_hz,measured_damping_ratio,measured_damping_ratio_std,frequency_difference,mac,\
         is_crossing,skins.energy_share,core.energy_share"
    );
    assert_eq!(column(&table, "kind"), ["pair"; 6]);
    assert_eq!(column(&table, "measured_mode"), ["1", "2", "3", "4", "5", "6"]);
    assert_eq!(column(&table, "is_crossing"), ["no"; 6]);
    let assurance = numbers(&table, "mac");
    assert!(assurance.len() == 6 && assurance.iter().all(|mac| *mac > 0.95), "{assurance:?}");
    for (skins, core) in
        numbers(&table, "skins.energy_share").iter().zip(numbers(&table, "core.energy_share"))
    {
        assert!((skins + core - 1.0).abs() < 1e-12);
    }
    let summary = json(&out.join("modes.json"));
    assert_eq!(summary["model"]["counted"], summary["model"]["found"]);
    assert_eq!(summary["measured"]["pairs"].as_array().unwrap().len(), 6);
    let factor = summary["measured"]["stiffness_factor"].as_f64().unwrap();
    assert!((0.5..0.8).contains(&factor), "the nominal core is 1.5 times too stiff: {factor}");
    let shapes = fs::read_to_string(out.join("modes.uff")).unwrap();
    assert_eq!(shapes.lines().filter(|line| line.trim() == "55").count(), 12);
    assert_eq!(
        fs::read_to_string(out.join("correlation.csv")).unwrap().lines().next(),
        Some("frequency_hz,csac,csf")
    );
    let diagram = fs::read_to_string(out.join("stabilisation.csv")).unwrap();
    assert!(column(&diagram, "is_stable").iter().filter(|cell| *cell == "yes").count() > 50);
    for figure in ["stabilisation", "pairs", "mac", "frf-correlation"] {
        for ending in ["svg", "png"] {
            assert!(out.join(format!("figures/{figure}.{ending}")).exists(), "{figure}.{ending}");
        }
    }
}

#[test]
fn identified_factors_bring_the_modes_together() {
    let folder = tempfile::tempdir().unwrap();
    done(folder.path(), &["--quiet", "example", "density", "d"]);
    let differences = |table: &str| -> f64 {
        numbers(table, "frequency_difference").iter().fold(0.0, |most, own| most.max(own.abs()))
    };
    let table = || fs::read_to_string(folder.path().join("modes/modes.csv")).unwrap();
    done(folder.path(), &["modes", "d/case.toml", "--out", "modes"]);
    assert!(differences(&table()) > 0.05);
    done(folder.path(), &["--quiet", "identify", "d/case.toml", "--out", "out"]);
    let identified = ["modes", "d/case.toml", "--identified", "out/identified.csv", "--out", "modes"];
    assert!(done(folder.path(), &identified).contains("factors of out/identified.csv"));
    let table = table();
    assert_eq!(column(&table, "kind"), ["pair"; 4]);
    assert!(differences(&table) < 1e-3, "{table}");
    let [own, other] = ["model_damping_ratio", "measured_damping_ratio"].map(|name| numbers(&table, name));
    assert!(own.iter().zip(other).all(|(own, other)| (own / other - 1.0).abs() < 0.01), "{table}");
    // One sensor has no shape.
    assert_eq!(column(&table, "mac"), [""; 4]);
    assert!(!folder.path().join("modes/figures/mac.svg").exists());
}

#[test]
fn without_files_there_are_the_modes_of_the_model_alone() {
    let folder = tempfile::tempdir().unwrap();
    unmeasured(folder.path(), "[respond]\nband_hz = [20.0, 1000.0]\npoints = 9\n");
    let said = done(folder.path(), &["modes", "s/plan.toml", "--out", "out"]);
    insta::assert_snapshot!("modes_of_the_model", portable(&said));
    let table = fs::read_to_string(folder.path().join("out/modes.csv")).unwrap();
    assert_eq!(column(&table, "kind"), ["model"; 6]);
    assert!(!folder.path().join("out/stabilisation.csv").exists());
    assert!(!folder.path().join("out/figures").exists());
    let lower = done(folder.path(), &["modes", "s/plan.toml", "--band", "20:400", "--json"]);
    let lower: serde_json::Value = serde_json::from_str(&lower).unwrap();
    assert_eq!(lower["model"]["modes"].as_array().unwrap().len(), 4);
    assert!(lower["measured"].is_null());
}

#[test]
fn rigid_bodies_are_modes_without_damping() {
    let folder = tempfile::tempdir().unwrap();
    done(folder.path(), &["--quiet", "example", "rubber-bar", "bar"]);
    done(folder.path(), &["modes", "bar/case.toml", "--band", "20:800", "--out", "out"]);
    let table = fs::read_to_string(folder.path().join("out/modes.csv")).unwrap();
    let kinds = column(&table, "kind");
    assert_eq!(kinds.iter().filter(|kind| *kind == "rigid body").count(), 1);
    assert_eq!((kinds[0].as_str(), numbers(&table, "model_frequency_hz")[0]), ("rigid body", 0.0));
    // A shape has the number of its row.
    let shapes = fs::read_to_string(folder.path().join("out/modes.uff")).unwrap();
    let first = shapes.lines().skip_while(|line| line.trim() != "55").nth(7).unwrap();
    assert_eq!(first.split_whitespace().last(), Some("2"), "{first}");
}

#[test]
fn a_single_line_is_said_to_show_nothing() {
    let folder = tempfile::tempdir().unwrap();
    done(folder.path(), &["--quiet", "example", "sandwich", "s"]);
    // A warning: --quiet leaves it.
    let said = done(folder.path(), &["--quiet", "modes", "s/case.toml", "--band", "100:105"]);
    assert!(said.contains("1 frequency in the band, to which no pole can be fitted"), "{said}");
}

#[test]
fn bands_that_are_none() {
    let folder = tempfile::tempdir().unwrap();
    unmeasured(folder.path(), "");
    let said = refused(folder.path(), &["modes", "s/plan.toml"]);
    assert!(said.contains("s/plan.toml: expected a band: --band, ") && said.contains("found none"), "{said}");
    let said = refused(folder.path(), &["modes", "s/plan.toml", "--band", "0:0"]);
    assert!(
        said.contains("--band: expected a band that reaches above 0 Hz") && said.contains("found [0, 0]"),
        "{said}"
    );
    let said = refused(folder.path(), &["modes", "s/case.toml", "--band", "5000:6000"]);
    assert!(said.contains("--band: expected a band with frequencies of s/frf.uff"), "{said}");
}

#[test]
fn tables_that_are_none_of_the_case() {
    let folder = tempfile::tempdir().unwrap();
    unmeasured(folder.path(), "[respond]\nband_hz = [20.0, 1000.0]\npoints = 9\n");
    let with = |case: &str, table: &str| refused(folder.path(), &["modes", case, "--identified", table]);
    let said = with("s/case.toml", "none.csv");
    assert!(said.contains("--identified: expected a file at none.csv, found none"), "{said}");
    let said = with("s/plan.toml", "s/truth.csv");
    assert!(
        said.contains("--identified: expected a case with [identify]") && said.contains("found none"),
        "{said}"
    );
    done(folder.path(), &["--quiet", "example", "plate-thickness", "p"]);
    let said = with("p/case.toml", "s/truth.csv");
    assert!(said.contains("--identified: expected no geometric parameter"), "{said}");
    assert!(said.contains("found \"thickness\""), "{said}");
    done(folder.path(), &["--quiet", "example", "two-materials", "two"]);
    let said = with("two/case.toml", "s/truth.csv");
    assert!(said.contains("s/truth.csv: expected columns of the unknown \"skins\""), "{said}");
    assert!(said.contains("found those of one unknown without a name"), "{said}");
    fs::write(folder.path().join("others.csv"), "frequency_hz,a.storage,a.loss_factor\n20,1e6,0\n").unwrap();
    let said = with("s/case.toml", "others.csv");
    assert!(said.contains("others.csv: expected columns of the unknown \"core\""), "{said}");
    assert!(said.contains("found those of \"a\"") && said.contains("--identified"), "{said}");
    // One of several unknowns of another case is found by its name.
    fs::write(folder.path().join("others.csv"), "frequency_hz,core.storage,core.loss_factor\n20,1e6,0\n")
        .unwrap();
    done(folder.path(), &["modes", "s/case.toml", "--identified", "others.csv"]);
}

#[test]
fn nothing_that_is_read_is_written() {
    let folder = tempfile::tempdir().unwrap();
    done(folder.path(), &["--quiet", "example", "sandwich", "s"]);
    let said = refused(folder.path(), &["modes", "s/case.toml", "--out", "s/case.toml"]);
    assert!(said.contains("s/case.toml: expected a folder, or nothing yet, found a file"), "{said}");
    for name in ["modes.uff", "modes.csv"] {
        fs::create_dir_all(folder.path().join("s/own")).unwrap();
        let file = folder.path().join("s/own").join(name);
        let read =
            fs::read(folder.path().join("s").join(if name == "modes.uff" { "frf.uff" } else { "truth.csv" }));
        let read = read.unwrap();
        fs::write(&file, &read).unwrap();
        let case = fs::read_to_string(folder.path().join("s/case.toml")).unwrap();
        fs::write(folder.path().join("s/own.toml"), case.replace("frf.uff", "own/modes.uff")).unwrap();
        let mut wanted = vec!["modes", "s/own.toml", "--out", "s/own"];
        if name == "modes.csv" {
            wanted = vec!["modes", "s/case.toml", "--identified", "s/own/modes.csv", "--out", "s/own"];
        }
        let said = refused(folder.path(), &wanted);
        assert!(said.contains(&format!("s/own/{name}: expected a file or folder of its own")), "{said}");
        assert_eq!(fs::read(&file).unwrap(), read);
        assert_eq!(fs::read_dir(folder.path().join("s/own")).unwrap().count(), 1, "nothing is written");
        fs::remove_file(file).unwrap();
    }
}

#[test]
fn orders_that_are_none() {
    let folder = tempfile::tempdir().unwrap();
    for order in ["0", "5", "401", "-1", "many"] {
        let output = frfit(folder.path(), &["modes", "case.toml", &format!("--max-order={order}")]);
        let said = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{said}");
        assert!(said.contains("--max-order") && said.contains("expected an order from 6 to 400"), "{said}");
    }
}
