//! The HTML page of an identification.

use crate::common;
use crate::tier::of_tier;

use common::{column, done, refused};
use serde_json::Value;
use std::path::Path;

fn read(folder: &Path, name: &str) -> String {
    std::fs::read_to_string(folder.join(name)).unwrap()
}

/// The sandwich, coarse in frequency, with a title that is no tag.
fn sandwich(folder: &Path, more: &str) {
    let case = folder.join("s/case.toml");
    // The one that was edited before.
    let _ = std::fs::remove_file(&case);
    done(folder, &["--quiet", "example", "sandwich", "s"]);
    let text = std::fs::read_to_string(&case).unwrap();
    let titled = text.replacen("title = ", "title = \"<script>alert(1)</script> & more\"\n# ", 1);
    std::fs::write(case, titled.replace("[identify]", &format!("[identify]\n{more}"))).unwrap();
}

#[test]
fn identify_writes_what_report_makes_of_the_folder() {
    let folder = tempfile::tempdir().unwrap();
    for (more, tables) in [
        ("", vec!["identified.csv", "candidates.csv", "reference.csv", "response.csv"]),
        (
            "varies = \"smooth\"",
            vec!["identified.csv", "candidates.csv", "reference.csv", "response.csv", "free.csv"],
        ),
        // The folder still has the free.csv of the run before: it is no table of this one.
        (
            "method = \"series\"\nselection = \"smallest\"",
            vec!["identified.csv", "candidates.csv", "reference.csv", "response.csv", "error_map.csv"],
        ),
    ] {
        sandwich(folder.path(), more);
        let said = done(
            folder.path(),
            &[
                "identify",
                "s/case.toml",
                "--out",
                "out",
                "--band",
                of_tier("20:200", "20:400"),
                "--error-map",
                "4",
            ],
        );
        assert!(said.contains("report.html"), "{said}");
        let out = folder.path().join("out");
        let summary: Value = serde_json::from_str(&read(&out, "summary.json")).unwrap();
        assert_eq!(summary["tables"], serde_json::json!(tables), "{more}");
        let page = read(&out, "report.html");
        assert!(
            page.contains("<h1>&lt;script&gt;alert(1)&lt;/script&gt; &amp; more</h1>")
                && !page.contains("<script>alert")
        );
        assert_eq!(page.contains("id=\"plot-error-map\""), more.contains("series"), "{more}");
        std::fs::remove_file(out.join("report.html")).unwrap();
        let said = done(folder.path(), &["report", "out"]);
        assert!(said.contains("wrote out/report.html"), "{said}");
        assert!(read(&out, "report.html") == page, "{more}: the page of the folder is another");
    }
}

#[test]
fn the_tables_beside_it_hold_what_it_compares_with() {
    let folder = tempfile::tempdir().unwrap();
    sandwich(folder.path(), "");
    done(folder.path(), &["--quiet", "identify", "s/case.toml", "--out", "out", "--band", "20:200"]);
    let out = folder.path().join("out");
    let (identified, reference) = (read(&out, "identified.csv"), read(&out, "reference.csv"));
    let numbers = |table: &str, name: &str| -> Vec<f64> {
        column(table, name).iter().map(|cell| cell.parse().unwrap()).collect()
    };
    assert_eq!(numbers(&identified, "frequency_hz"), numbers(&reference, "frequency_hz"));
    let [factor, correction, nominal] =
        [(&identified, "factor_re"), (&identified, "correction_re"), (&reference, "nominal_re")]
            .map(|(t, n)| numbers(t, n));
    for k in 0..factor.len() {
        // factor = nominal + correction, to the roundoff of that sum.
        assert!((factor[k] - correction[k] - nominal[k]).abs() <= 1e-12 * nominal[k], "{k}");
    }
    // The sandwich is measured with its known truth: the answers are near it.
    let truth = numbers(&reference, "true_re");
    assert!(truth.iter().zip(&factor).all(|(truth, factor)| (truth / factor - 1.0).abs() < 1e-5));
    // Its file gives no standard deviation.
    assert!(column(&read(&out, "response.csv"), "measured_std").iter().all(String::is_empty));
}

#[test]
fn a_folder_without_results_is_refused_with_what_is_missing() {
    let folder = tempfile::tempdir().unwrap();
    let message = refused(folder.path(), &["report", "nowhere"]);
    assert_eq!(
        message,
        "frfit: nowhere: expected a folder with the results of frfit identify, found nothing of that name\n"
    );
    std::fs::create_dir(folder.path().join("out")).unwrap();
    let message = refused(folder.path(), &["report", "out"]);
    assert_eq!(
        message,
        "frfit: out/summary.json: expected this file, as frfit identify of this version writes it, found none\n"
    );
    done(folder.path(), &["--quiet", "demo"]);
    let out = folder.path().join("frfit-demo/out");
    std::fs::remove_file(out.join("report.html")).unwrap();
    let table = read(&out, "identified.csv").replacen(",ok,", ",good,", 1);
    std::fs::write(out.join("identified.csv"), table).unwrap();
    let message = refused(folder.path(), &["report", "frfit-demo/out"]);
    assert!(message.contains("changed, or of another run: identified.csv"), "{message}");
    // Without the list of files it is read, and found to be wrong.
    std::fs::remove_file(out.join("identify-manifest.json")).unwrap();
    let message = refused(folder.path(), &["report", "frfit-demo/out"]);
    assert!(
        message.starts_with("frfit: frfit-demo/out/identified.csv:2:") && message.contains("found \"good\""),
        "{message}"
    );
    assert!(!out.join("report.html").exists());
}
