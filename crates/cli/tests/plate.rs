//! The main job on real matrices: the clamped plate BCSSTK09/BCSSTM09 and a measured FRF in a UFF 58 file.
//!
//! K is read from its Harwell–Boeing file, M from Matrix Market; the measurement is made by `frfit respond` with the true modulus
//! (1 + 0.001i, P-42), the identification starts from (1 + δ) times that.

use crate::common;
use crate::tier::of_tier;

use common::{column, data, done};
use serde_json::Value;
use std::path::Path;

/// Frequencies of the measurement.
fn points() -> usize {
    of_tier(100, 300)
}

/// Unit force at row 301 (deflection of node 101), accelerance at row 538 (deflection of node 180).
fn case(plate: &Path, factor: f64, measurement: &str) -> String {
    let plate = plate.display();
    format!(
        r#"
title = "Clamped plate"
[[matrix]]
name = "plate"
role = "stiffness"
file = "{plate}/bcsstk09.rsa"
factor = {{ storage = {factor}, loss_factor = 0.001 }}
[[matrix]]
name = "mass"
role = "mass"
file = "{plate}/bcsstm09.mtx"
[load]
row = 301
[[measurement]]
row = 538
{measurement}
[respond]
band_hz = [20.0, 3608.0]
points = {}
"#,
        points()
    )
}

#[test]
#[ignore = "needs the data of ../shared/data"]
fn modulus_of_the_plate_from_an_frf_file_needs_data() {
    let plate = data("plate");
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: String| std::fs::write(folder.path().join(name), text).unwrap();
    write("truth.toml", case(&plate, 1.0, "quantity = \"accelerance\""));
    done(folder.path(), &["--quiet", "respond", "truth.toml", "--out", "measured"]);
    let shares = [(0.25, 0.48, 0.88), (-0.25, 0.21, 0.75)];
    for (delta, least_right, least_right_of_ok) in shares.into_iter().take(of_tier(1, 2)) {
        let identify = r#"
[identify]
matrix = "plate"
band_hz = [20.0, 3608.0]
method = "series"
order = 30
selection = "smallest"
bounds = { storage = [0.2, 5.0], loss_factor = [0.0, 1.0] }
reference = { storage = 1.0, loss_factor = 0.001 }
"#;
        write("case.toml", case(&plate, 1.0 + delta, "file = \"measured/frf.uff\"") + identify);
        let said =
            done(folder.path(), &["identify", "case.toml", "--out", "out", "--error-map", "0", "--json"]);
        let summary: Value = serde_json::from_str(&said).unwrap();

        assert_eq!(summary["frequencies"], points());
        let right = summary["reference"]["fraction_right"].as_f64().unwrap();
        // Measured with this load and point: 50.0 % and 22.3 % within 1e-6; up to 3 kHz and within 1 %: 69.9 % and 40.6 %, where an
        // independent experiment with others had 67 % and 37 %.
        assert!(right > least_right, "δ = {delta}: {}", summary["reference"]);
        assert!(
            summary["reference"]["fraction_right_of_ok"].as_f64().unwrap() > least_right_of_ok,
            "{}",
            summary["reference"]
        );
        assert!(!summary["bands_hz"]["diverged"].as_array().unwrap().is_empty());
        let table = std::fs::read_to_string(folder.path().join("out/identified.csv")).unwrap();
        let diverged = column(&table, "status").iter().filter(|status| *status == "diverged").count();
        assert_eq!(summary["status"]["diverged"], diverged);
    }
}

#[test]
#[ignore = "needs the data of ../shared/data"]
fn by_default_every_modulus_of_the_plate_is_right_needs_data() {
    let plate = data("plate");
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: String| std::fs::write(folder.path().join(name), text).unwrap();
    write("truth.toml", case(&plate, 1.0, "quantity = \"accelerance\""));
    done(folder.path(), &["--quiet", "respond", "truth.toml", "--out", "measured"]);
    // The paper's errors, twice those, and a nominal three times off either way; one sensor.
    for factor in [1.25, 1.0 / 3.0, 1.5, 0.5, 3.0, 0.75].into_iter().take(of_tier(2, 6)) {
        let identify = r#"
[identify]
matrix = "plate"
band_hz = [20.0, 3608.0]
bounds = { storage = [0.2, 5.0], loss_factor = [0.0, 1.0] }
reference = { storage = 1.0, loss_factor = 0.001 }
"#;
        write("case.toml", case(&plate, factor, "file = \"measured/frf.uff\"") + identify);
        let said = done(folder.path(), &["identify", "case.toml", "--out", "out", "--json"]);
        let summary: Value = serde_json::from_str(&said).unwrap();
        assert_eq!(summary["reference"]["fraction_right_of_ok"], 1.0, "{factor}: {}", summary["reference"]);
        // One sensor is allowed to be ambiguous here and there, not wrong; at the time of writing it is neither.
        assert!(
            summary["reference"]["fraction_right"].as_f64().unwrap() >= 0.98,
            "{factor}: {}",
            summary["reference"]
        );
        let counts = &summary["counts"];
        // One modulus scales the whole stiffness: one factor to solve with, one to count modes by.
        assert_eq!(counts["factorisations"], 2, "{counts}");
        assert!(counts["solves"].as_u64().unwrap() <= 61, "{counts}");
        assert!(counts["reduction_error"].as_f64().unwrap() < 1e-6, "{counts}");
    }
}

#[test]
#[ignore = "needs the data of ../shared/data"]
fn natural_frequencies_show_at_once_needs_data() {
    let plate = data("plate");
    let (k, m) = (plate.join("bcsstk09.rsa"), plate.join("bcsstm09.mtx"));
    let said = done(&plate, &["inspect", k.to_str().unwrap(), m.to_str().unwrap(), "--modes", "5"]);
    for frequency in ["858.089", "1748.537987", "2566.20", "3134.1"] {
        assert!(said.contains(frequency), "{said}");
    }
}

#[test]
fn a_free_chain_has_a_rigid_body_mode() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, entries: &str| {
        let text = format!(
            "%%MatrixMarket matrix coordinate real symmetric\n3 3 {}\n{entries}",
            entries.lines().count()
        );
        std::fs::write(folder.path().join(name), text).unwrap();
    };
    write("K.mtx", "1 1 1\n2 1 -1\n2 2 2\n3 2 -1\n3 3 1\n");
    write("M.mtx", "1 1 1\n2 2 1\n3 3 1\n");
    let said = done(folder.path(), &["inspect", "K.mtx", "M.mtx"]);
    assert!(said.contains("K φ = ω² M φ; the first is a rigid-body mode"), "{said}");
    // ω² = 0, 1, 3
    assert!(
        said.contains("1  0.000000 Hz") && said.contains("2  0.159155 Hz") && said.contains("3  0.275664 Hz"),
        "{said}"
    );
    // Two files that are not K and M have no natural frequencies, and nothing is wrong with that.
    write("Z.mtx", "1 1 0\n");
    let said = done(folder.path(), &["inspect", "K.mtx", "Z.mtx"]);
    assert!(!said.contains("natural"), "{said}");
}
