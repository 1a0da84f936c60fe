//! Inputs at fault: exit code 2, what, where, expected and found, and nothing written.

use crate::common;

use common::{column, done, frfit, refused};
use std::path::Path;

/// Writes an example, changes one of its files, and returns the message of `identify`.
fn message(change: impl FnOnce(&Path)) -> String {
    let folder = tempfile::tempdir().unwrap();
    done(folder.path(), &["--quiet", "example", "density", "d"]);
    change(&folder.path().join("d"));
    let message = refused(folder.path(), &["identify", "d/case.toml", "--out", "out"]);
    assert!(!folder.path().join("out").exists(), "nothing is written");
    message
}

/// Replaces text in a file; the text must be there.
fn edit(file: &Path, from: &str, to: &str) {
    let text = std::fs::read_to_string(file).unwrap();
    assert!(text.contains(from), "{from:?} is not in\n{text}");
    std::fs::write(file, text.replacen(from, to, 1)).unwrap();
}

#[test]
fn unknown_key() {
    let said = message(|d| edit(&d.join("case.toml"), "[identify]", "[identify]\noder = 30"));
    assert!(said.contains("case.toml:") && said.contains("oder") && said.contains("order"), "{said}");
}

#[test]
fn unknown_matrix() {
    let said = message(|d| edit(&d.join("case.toml"), "matrix = \"mass\"", "matrix = \"mas\""));
    assert!(said.contains("case.toml:") && said.contains("mas") && said.contains("mass"), "{said}");
}

#[test]
fn band_without_data() {
    let folder = tempfile::tempdir().unwrap();
    done(folder.path(), &["--quiet", "example", "density", "d"]);
    let said = refused(folder.path(), &["identify", "d/case.toml", "--out", "out", "--band", "90000:90001"]);
    assert!(said.contains("--band") && said.contains("90000"), "{said}");
}

#[test]
fn missing_case_and_missing_file() {
    let folder = tempfile::tempdir().unwrap();
    let said = refused(folder.path(), &["identify", "nowhere.toml", "--out", "out"]);
    assert!(said.contains("nowhere.toml"), "{said}");
    let said = message(|d| {
        let frf = std::fs::read_dir(d)
            .unwrap()
            .map(|e| e.unwrap().path())
            .find(|p| p.ends_with("frf.csv"))
            .unwrap();
        std::fs::remove_file(frf).unwrap();
    });
    assert!(
        said.contains("case.toml:") && said.contains("expected a file at d/frf.csv, found none"),
        "{said}"
    );
}

#[test]
fn a_model_that_does_not_fit_into_memory() {
    let folder = tempfile::tempdir().unwrap();
    done(folder.path(), &["--quiet", "example", "clamped-plate", "plate"]);
    for method in ["series", "rational"] {
        let case = ["identify", "plate/case.toml", "--out", "out", "--method", method, "--memory", "1"];
        let said = refused(folder.path(), &case);
        assert!(said.contains("a model of 1083 degrees of freedom: expected "), "{said}");
        assert!(said.contains(" MB of memory for ") && said.contains("found 1.000 MB"), "{said}");
    }
    refused(folder.path(), &["respond", "plate/case.toml", "--out", "out", "--memory", "1"]);
    assert!(!folder.path().join("out").exists(), "nothing is written");
}

/// What needs a little more memory than there is has its factors in single precision, and the same answers.
#[test]
fn a_model_whose_factors_fit_in_single_precision() {
    let folder = tempfile::tempdir().unwrap();
    done(folder.path(), &["--quiet", "example", "clamped-plate", "plate"]);
    let arguments = |out, memory| {
        ["identify", "plate/case.toml", "--method", "rational", "--out", out, "--memory", memory]
    };
    let refusal = refused(folder.path(), &arguments("none", "1"));
    let needed = refusal.split("expected ").nth(1).and_then(|rest| rest.split(' ').next()).unwrap();
    // Whole megabytes about what is needed.
    let needed: f64 = needed.parse().unwrap();
    let [more, less] = [needed.ceil(), needed.floor()].map(|megabytes| megabytes.to_string());
    let double = done(folder.path(), &arguments("double", &more));
    let single = done(folder.path(), &arguments("single", &less));
    assert!(!double.contains("single precision"), "{double}");
    assert!(single.contains("factors in single precision"), "{single}");
    let values = |out: &str| -> Vec<f64> {
        let table = std::fs::read_to_string(folder.path().join(out).join("identified.csv")).unwrap();
        column(&table, "storage").iter().filter_map(|cell| cell.parse().ok()).collect()
    };
    let (double, single) = (values("double"), values("single"));
    assert!(double.len() > 10 && double.len() == single.len());
    assert!(double.iter().zip(&single).all(|(a, b)| (a - b).abs() < 1e-6 * a.abs()));
}

#[test]
fn output_that_cannot_be_written() {
    let folder = tempfile::tempdir().unwrap();
    done(folder.path(), &["--quiet", "example", "density", "d"]);
    std::fs::write(folder.path().join("out"), "a file is in the way").unwrap();
    let said = refused(folder.path(), &["identify", "d/case.toml", "--out", "out", "--error-map", "0"]);
    assert!(said.contains("out"), "{said}");
}

#[test]
fn wrong_use_of_the_command_line() {
    let folder = tempfile::tempdir().unwrap();
    for arguments in [
        &["identify"][..],
        &["frobnicate"],
        &["identify", "c.toml", "--out", "o", "--band", "12"],
        &["convert", "a.mtx"],
    ] {
        let output = frfit(folder.path(), arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
    }
}
