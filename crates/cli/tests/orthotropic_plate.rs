//! The example of a wooden plate: from five impacts to the moduli, one command a step.

use crate::common;
use crate::tier::of_tier;

use common::{column, done};
use serde_json::Value;
use std::fs;

/// The constants of the wood are the true ones, within bars that are not too long; by day from the lowest five of ten modes.
#[test]
fn five_impacts_give_four_constants_of_the_wood() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    done(at, &["--quiet", "example", "orthotropic-plate", "plate"]);
    done(at, &["--quiet", "frf", "plate/records.lvm", "-o", "plate/frf.uff"]);
    let case = fs::read_to_string(at.join("plate/case.toml")).unwrap();
    let [of_band, few] = ["450.0]", "max_lines = 40"].map(|key| case.matches(key).count());
    assert_eq!([of_band, few], [1, 1]);
    let (band, lines) = of_tier(("220.0]", "max_lines = 12"), ("450.0]", "max_lines = 40"));
    fs::write(at.join("plate/case.toml"), case.replace("450.0]", band).replace("max_lines = 40", lines))
        .unwrap();
    let summary: Value =
        serde_json::from_str(&done(at, &["identify", "plate/case.toml", "--out", "out", "--json"])).unwrap();
    assert_eq!(summary["status"]["ok"], of_tier(12, 40), "{}", summary["status"]);
    assert_ne!(summary["fit"]["verdict"], "not explained", "{}", summary["fit"]);
    // What the example was made with.
    let truth = [("D11", 1.12e10), ("D22", 9.6e8), ("D12", 3.6e8), ("D66", 7.0e8)];
    for (found, (name, truth)) in summary["unknowns"].as_array().unwrap().iter().zip(truth) {
        let number = |key: &str| found["numbers"][0][key].as_f64().unwrap();
        let (value, std) = (number("value"), number("std"));
        let off = (value - truth).abs();
        assert_eq!(found["name"], name);
        assert!(off < 2.0 * std && off < 0.02 * truth, "{name}: {value:e} ± {std:e} for {truth:e}");
        // A bar that is too long covers anything; one below the 0.5 % of the density is too short.
        assert!((0.005..0.05).contains(&(std / truth)), "{name}: {value:e} ± {std:e}");
    }
}

/// The mesh is some tenths of a per cent off, and the nominal constants several per cent.
#[test]
fn natural_frequencies_come_together() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    done(at, &["--quiet", "example", "orthotropic-plate", "plate"]);
    done(at, &["--quiet", "frf", "plate/records.lvm", "-o", "plate/frf.uff"]);
    // How many pairs, the smallest and the largest relative difference.
    let differences = |out: &str| {
        done(at, &["--quiet", "modes", "plate/case.toml", "--out", out]);
        let table = fs::read_to_string(at.join(out).join("modes.csv")).unwrap();
        let cells = column(&table, "frequency_difference");
        let off: Vec<f64> = cells.iter().filter_map(|cell| cell.parse().ok()).collect();
        let extreme = |of: fn(f64, f64) -> f64| off.iter().copied().reduce(of).unwrap();
        (off.len(), extreme(f64::min), extreme(f64::max))
    };
    let (pairs, least, most) = differences("nominal");
    assert_eq!(pairs, 10);
    assert!(0.07 < least && most < 0.11, "{least} to {most}");
    let mut case = fs::read_to_string(at.join("plate/case.toml")).unwrap();
    let nominal_and_true =
        [("1.3e10", "1.12e10"), ("1.15e9", "9.6e8"), ("3.0e8", "3.6e8"), ("8.4e8", "7.0e8")];
    for (nominal, truth) in nominal_and_true {
        case = case.replace(&format!("storage = {nominal}, "), &format!("storage = {truth}, "));
    }
    fs::write(at.join("plate/case.toml"), case).unwrap();
    let (pairs, least, most) = differences("truth");
    assert_eq!(pairs, 10);
    // Elements that conform are too stiff, never too soft; poles from noisy lines are good to 1e-4.
    assert!(-1e-4 < least && (0.002..0.005).contains(&most), "{least} to {most}");
}
