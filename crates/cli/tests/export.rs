//! The way out: decks of other solvers, tables, and the updated responses.

use crate::common;

use common::{column, done, frfit, refused};

const IDENTIFIED: &str = "frequency_hz,storage,loss_factor,status,storage_std,loss_factor_std\n\
                          100,2.5e6,0.21,ok,1e4,0.004\n125.5,2.75e6,0.25,ok,2e4,0.005\n\
                          150,9e9,0.3,ambiguous,,\n175,,,no_root,,\n200,3.5e6,0.31,ok,3e4,0.01\n";

/// The program's version, which every deck names, is no part of what is to stay.
fn versionless(text: &str) -> String {
    text.replace(env!("CARGO_PKG_VERSION"), "[version]")
}

#[test]
fn decks_word_for_word() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("identified.csv"), IDENTIFIED).unwrap();
    for format in ["nastran", "abaqus", "ansys", "csv", "json"] {
        let arguments = ["export", format, "identified.csv", "-o", "deck", "--unit-system", "mm-t-s"];
        let solid = ["--poisson", "0.45", "--density", "1100", "--id", "7", "--name", "CORE"];
        let said = done(folder.path(), &[&arguments[..], &solid[..]].concat());
        let deck = std::fs::read_to_string(folder.path().join("deck")).unwrap();
        insta::assert_snapshot!(format!("export_{format}"), versionless(&format!("{said}\n{deck}")));
    }
}

#[test]
fn faults_are_the_users() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("identified.csv"), IDENTIFIED).unwrap();
    let message = refused(folder.path(), &["export", "ansys", "identified.csv", "-o", "deck"]);
    assert!(
        message.starts_with("frfit: --poisson: expected Poisson's ratio, above -1 and below 0.5"),
        "{message}"
    );
    assert!(message.ends_with(", found none\n") && !folder.path().join("deck").exists(), "{message}");
    let message = refused(folder.path(), &["export", "ansis", "identified.csv", "-o", "deck"]);
    assert!(message.contains("expected nastran, abaqus, ansys, csv or json, found \"ansis\""), "{message}");
    let message = refused(folder.path(), &["export", "csv", "none.csv", "-o", "deck"]);
    assert!(message.contains("none.csv: expected a file"), "{message}");
}

/// From an example to a law to a deck, and the updated responses as UFF, which are those of the table bit for bit.
#[test]
fn an_identification_goes_on_to_the_next_solver() {
    let folder = tempfile::tempdir().unwrap();
    done(folder.path(), &["--quiet", "example", "rubber-bar", "bar"]);
    done(folder.path(), &["--quiet", "identify", "bar/case.toml", "--out", "out", "--error-map", "0"]);
    done(folder.path(), &["--quiet", "fit", "out/identified.csv", "--law", "fractional", "--out", "laws"]);
    let deck = ["export", "nastran", "out/identified.csv", "-o", "core.bdf", "--poisson", "0.49"];
    done(folder.path(), &deck);
    let of_law = [&deck[..], &["--law", "laws/law.json", "--json"]].concat();
    let summary: serde_json::Value = serde_json::from_str(&done(folder.path(), &of_law)).unwrap();
    assert!(summary["law"].as_str().unwrap().contains("fractional"), "{summary:#}");

    done(folder.path(), &["convert", "out/updated.uff", "updated.csv", "--record", "1"]);
    let read = |name: &str| std::fs::read_to_string(folder.path().join(name)).unwrap();
    let (response, updated) = (read("out/response.csv"), read("updated.csv"));
    let sensor = column(&response, "sensor")[0].clone();
    let sensors = column(&response, "sensor");
    for (table, uff) in [("frequency_hz", "frequency_hz"), ("updated_re", "re"), ("updated_im", "im")] {
        let of_sensor = column(&response, table).into_iter().zip(&sensors).filter(|(_, s)| **s == sensor);
        let expected: Vec<f64> = of_sensor.filter_map(|(cell, _)| cell.parse().ok()).collect();
        let found: Vec<f64> = column(&updated, uff).iter().map(|cell| cell.parse().unwrap()).collect();
        assert!(expected.len() > 10);
        assert_eq!(found, expected, "{table}");
    }
    let inspected = String::from_utf8(frfit(folder.path(), &["inspect", "out/updated.uff"]).stdout).unwrap();
    assert!(inspected.contains("updated"), "{inspected}");
}
