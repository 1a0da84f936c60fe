//! The HTML page of several unknowns.

use crate::common;
use crate::picture::assert_shows_something;

use common::done;
use serde_json::Value;
use std::path::Path;

fn read(folder: &Path, name: &str) -> String {
    std::fs::read_to_string(folder.join(name)).unwrap()
}

#[test]
fn identify_writes_what_report_makes_of_the_folder() {
    let folder = tempfile::tempdir().unwrap();
    done(folder.path(), &["--quiet", "example", "added-mass", "m"]);
    let said = done(folder.path(), &["identify", "m/case.toml", "--out", "out"]);
    assert!(said.contains("report.html"), "{said}");
    let out = folder.path().join("out");
    let summary: Value = serde_json::from_str(&read(&out, "summary.json")).unwrap();
    assert_eq!(
        summary["tables"],
        serde_json::json!(["identified.csv", "candidates.csv", "reference.csv", "response.csv"])
    );
    let page = read(&out, "report.html");
    for expected in [
        "Can be used",
        "component and beam are known for the whole band",
        "id=\"plot-correlation\"",
        "id=\"plot-profile\"",
    ] {
        assert!(page.contains(expected), "{expected}");
    }
    std::fs::remove_file(out.join("report.html")).unwrap();
    // Tables of another run in the same folder are none of this one.
    std::fs::write(out.join("free.csv"), "no table").unwrap();
    let said = done(folder.path(), &["report", "out"]);
    assert!(said.contains("wrote out/report.html"), "{said}");
    assert!(read(&out, "report.html") == page, "the page of the folder is another");
}

#[test]
fn the_picture_of_the_correlation_has_a_row_for_each_number() {
    let folder = tempfile::tempdir().unwrap();
    done(folder.path(), &["--quiet", "example", "added-mass", "m"]);
    done(folder.path(), &["--quiet", "identify", "m/case.toml", "--out", "out"]);
    let out = folder.path().join("out");
    let summary: Value = serde_json::from_str(&read(&out, "summary.json")).unwrap();
    let svg = read(&out, "figures/correlation.svg");
    for (k, name) in summary["coordinates"].as_array().unwrap().iter().enumerate() {
        let row = format!("{} {}", k + 1, name.as_str().unwrap());
        assert!(svg.contains(&row), "{row}");
    }
    assert_shows_something(&out.join("figures/correlation.png"));
    // A single number has no correlation.
    done(folder.path(), &["--quiet", "example", "plate-thickness", "p"]);
    done(folder.path(), &["--quiet", "identify", "p/case.toml", "--out", "one"]);
    assert!(!folder.path().join("one/figures/correlation.svg").exists());
}
