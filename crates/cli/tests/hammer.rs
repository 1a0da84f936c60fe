//! From the hammer to the modulus, one command a step.

use crate::common;
use crate::tier::of_tier;

use common::{column, done, refused};
use serde_json::Value;
use std::f64::consts::TAU;
use std::fs;
use std::path::Path;

/// The example, and its FRF from its records.
fn chain(folder: &Path) {
    done(folder, &["--quiet", "example", "hammer-bar", "bar"]);
    done(folder, &["--quiet", "frf", "bar/records.lvm", "-o", "bar/frf.uff"]);
}

fn identify(folder: &Path, options: &[&str]) -> (Value, String) {
    let arguments = [&["identify", "bar/case.toml", "--out", "out", "--json"], options].concat();
    let summary = serde_json::from_str(&done(folder, &arguments)).unwrap();
    (summary, std::fs::read_to_string(folder.join("out/identified.csv")).unwrap())
}

fn numbers(table: &str, name: &str) -> Vec<f64> {
    column(table, name).iter().map(|cell| cell.parse().unwrap_or(f64::NAN)).collect()
}

/// Frequency and |E − truth|/|truth| of every answer, and the modulus of the truth.
fn deviations(folder: &Path, table: &str) -> Vec<(f64, f64, f64)> {
    let truth = std::fs::read_to_string(folder.join("bar/truth.csv")).unwrap();
    let [f, storage, eta] = ["frequency_hz", "storage", "loss_factor"].map(|name| numbers(table, name));
    let [at, true_storage, true_eta] =
        ["frequency_hz", "storage", "loss_factor"].map(|name| numbers(&truth, name));
    let mut found = Vec::new();
    for k in (0..f.len()).filter(|&k| storage[k].is_finite()) {
        let row = at.iter().position(|at| *at == f[k]).unwrap();
        let size = true_storage[row].hypot(true_storage[row] * true_eta[row]);
        let off =
            (storage[k] - true_storage[row]).hypot(storage[k] * eta[k] - true_storage[row] * true_eta[row]);
        found.push((f[k], off / size, size));
    }
    found
}

/// What 400 elements leave: the modulus is too small by (kh)²/12, between resonances by up to three times that.
fn mesh(frequency_hz: f64, modulus: f64) -> f64 {
    let wavenumber = TAU * frequency_hz * (1180.0 / modulus).sqrt();
    3.2 * (wavenumber * 0.3048 / 400.0).powi(2) / 12.0
}

/// The paper's Figs 7 to 10: nominal from the first mode, order 30, the least root.
#[test]
fn the_papers_way_is_within_one_percent_and_its_series_converges() {
    let folder = tempfile::tempdir().unwrap();
    chain(folder.path());
    // By day only what is within 30 Hz of the nominal resonances.
    let between: Vec<[f64; 2]> =
        (0..6).map(|n| 249.0 * f64::from(n)).map(|f| [f + 30.0, f + 219.0]).collect();
    let left_out = of_tier(&between[..], &[]);
    let case = folder.path().join("bar/case.toml");
    let text = std::fs::read_to_string(&case).unwrap();
    let keys = format!("[identify]\nexclude_hz = {left_out:?}");
    std::fs::write(case, text.replace("[identify]", &keys)).unwrap();
    let (summary, table) =
        identify(folder.path(), &["--method", "series", "--order", "30", "--error-map", "0"]);
    assert_eq!(summary["frequencies"], 676);
    let ok = column(&table, "status").iter().filter(|status| *status == "ok").count();
    let out = summary["identify"]["left_out"].as_u64().unwrap_or(0);
    assert!(ok as u64 + out == 676 && out < of_tier(520, 1), "{summary:#}");
    let errors = column(&table, "error");
    let errors = errors.iter().filter(|error| !error.is_empty()).map(|error| error.parse::<f64>().unwrap());
    assert!(errors.clone().count() == ok && errors.clone().all(|error| error < 0.01));
    let (f, radius) = (numbers(&table, "frequency_hz"), numbers(&table, "spectral_radius"));
    assert!(radius.iter().all(|radius| radius.is_nan() || *radius < 1.0));
    // Its maxima, at the nominal resonances n·249 Hz, rise from one to the next, and are small where the nominal was fitted.
    let around = |n: f64| {
        let near = f.iter().zip(&radius).filter(|(f, _)| (*f / 249.0 - n).abs() < 0.5);
        near.map(|(_, radius)| *radius).fold(0.0, f64::max)
    };
    let maxima: Vec<f64> = (1..=6).map(|n| around(f64::from(n))).collect();
    assert!(maxima[0] < 0.1 && maxima.is_sorted() && (0.8..0.9).contains(&maxima[5]), "{maxima:?}");
    for (f, off, modulus) in deviations(folder.path(), &table) {
        // Beside the mesh, what thirty terms leave: half a percent of the response at ρ = 0.84.
        assert!(off < mesh(f, modulus) + 5e-3 * around(6.0), "{f} Hz: {off:e}");
    }
}

#[test]
fn by_default_the_modulus_is_the_truth_up_to_the_mesh() {
    let folder = tempfile::tempdir().unwrap();
    chain(folder.path());
    let (summary, table) = identify(folder.path(), &[]);
    let found = deviations(folder.path(), &table);
    assert_eq!(summary["status"]["ok"], 676, "{}", summary["status"]);
    assert_eq!(found.len(), 676);
    // One sensor, one impact: only the scatter of the estimates shows the noise.
    assert_eq!(summary["noise"]["source"], "scatter");
    assert!(numbers(&table, "storage_std").iter().all(|std| *std > 0.0));
    assert!(numbers(&table, "chi2").iter().all(|chi2| chi2.is_nan()));
    for (f, off, modulus) in found {
        assert!(off < mesh(f, modulus), "{f} Hz: {off:e} of {:e}", mesh(f, modulus));
    }
    assert!(summary["reference"]["deviation"]["max_ok"].as_f64().unwrap() < 3e-4);
}

/// Largest |η − truth|/truth of the answers.
fn worst_loss_factor(folder: &Path, table: &str) -> f64 {
    let truth = std::fs::read_to_string(folder.join("bar/truth.csv")).unwrap();
    let [at, exact] = ["frequency_hz", "loss_factor"].map(|name| numbers(&truth, name));
    let [f, found] = ["frequency_hz", "loss_factor"].map(|name| numbers(table, name));
    let of = |k: usize| {
        let row = at.iter().position(|at| *at == f[k]).unwrap();
        (found[k] - exact[row]).abs() / exact[row]
    };
    (0..f.len()).filter(|&k| found[k].is_finite()).map(of).fold(0.0, f64::max)
}

/// The window of `frfit frf` is in the file that it writes, and from there in the model.
#[test]
fn windowed_impacts_have_the_loss_factor_of_the_material() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    done(at, &["--quiet", "example", "hammer-bar", "bar"]);
    let case = std::fs::read_to_string(at.join("bar/case.toml")).unwrap();
    let measurement = |keys: &str| {
        let changed = case.replace("file = \"frf.uff\"", keys);
        assert_ne!(changed, case);
        std::fs::write(at.join("bar/case.toml"), changed).unwrap();
    };
    let decay = 15.625;
    let band = ["--band", "200:700", "--error-map", "0"];
    done(at, &["--quiet", "frf", "bar/records.lvm", "--exponential-window", "0.064", "-o", "bar/frf.uff"]);
    let (summary, table) = identify(at, &band);
    assert_eq!(summary["decay_per_s"], decay);
    // One sensor: at some lines of windowed data another modulus fits as well, whatever the model knows of the window.
    let ok = summary["status"]["ok"].as_u64().unwrap();
    assert!(ok > 220 && ok + summary["status"]["ambiguous"].as_u64().unwrap_or(0) == 251, "{ok}");
    // The end of the record (0.1 % without a window), and (2/π)α/ω, as E is taken at the real ω.
    let with = worst_loss_factor(at, &table);
    assert!(with < 0.001 + 4.0 * decay / (TAU * TAU * 200.0), "{with}");
    // The same file without its word: 2α/ω over η = 0.119 at 200 Hz.
    let text = std::fs::read_to_string(at.join("bar/frf.uff")).unwrap();
    let said = format!("{:<80}", "decay_per_s = 15.625");
    assert_eq!(text.matches(&said).count(), 1);
    std::fs::write(at.join("bar/silent.uff"), text.replace(&said, &format!("{:<80}", "NONE"))).unwrap();
    measurement("file = \"silent.uff\"");
    let (summary, wrong) = identify(at, &band);
    assert_eq!((&summary["decay_per_s"], &summary["status"]["ok"]), (&Value::from(0.0), &Value::from(ok)));
    let without = worst_loss_factor(at, &wrong);
    assert!(without > 0.2, "{without}");
    // The case's word in its place: the same numbers.
    measurement("decay_per_s = 15.625\nfile = \"silent.uff\"");
    assert!(identify(at, &band).1 == table);
    // A table says it in a comment, which a conversion keeps, both ways.
    done(at, &["--quiet", "convert", "bar/frf.uff", "bar/frf.csv"]);
    let of_table = std::fs::read_to_string(at.join("bar/frf.csv")).unwrap();
    assert!(of_table.starts_with("# decay_per_s = 15.625\nfrequency_hz,"), "{}", &of_table[..60]);
    let dofs = ["--quantity", "accelerance", "--response", "401+X", "--reference", "1+X"];
    done(at, &[&["--quiet", "convert", "bar/frf.csv", "bar/again.uff"], &dofs[..]].concat());
    assert!(std::fs::read_to_string(at.join("bar/again.uff")).unwrap().contains(&said));
    done(at, &["--quiet", "frf", "bar/records.lvm", "--exponential-window", "0.064", "-o", "bar/direct.csv"]);
    let direct = std::fs::read_to_string(at.join("bar/direct.csv")).unwrap();
    assert!(direct.starts_with("# decay_per_s = 15.625\nfrequency_hz,"));
    // Its word and the case's must not contradict each other.
    measurement("decay_per_s = 6.0\nfile = \"frf.uff\"");
    let message = refused(at, &["identify", "bar/case.toml", "--out", "out"]);
    let expected = "measurement.decay_per_s: expected 15.625, as frf.uff says, or no such key, found 6";
    assert!(message.contains(expected), "{message}");
    let second = "decay_per_s = 15.625\nfile = \"frf.uff\"\nrow = 401\n[[measurement]]\n\
                  file = \"silent.uff\"";
    measurement(second);
    let message = refused(at, &["identify", "bar/case.toml", "--out", "out"]);
    let expected = "expected the decay_per_s of all measurements, 15.625 as of the first, found 0";
    assert!(message.contains(expected), "{message}");
    for wrong in ["-6.0", "inf", "\"6/s\""] {
        measurement(&format!("decay_per_s = {wrong}\nfile = \"frf.uff\""));
        let message = refused(at, &["identify", "bar/case.toml", "--out", "out"]);
        assert!(message.contains("expected a finite number of 1/s that is not negative"), "{message}");
    }
    // Nor must it be nonsense.
    std::fs::write(at.join("bar/frf.csv"), of_table.replace("= 15.625", "= soon")).unwrap();
    measurement("quantity = \"accelerance\"\nfile = \"frf.csv\"");
    let message = refused(at, &["identify", "bar/case.toml", "--out", "out"]);
    let expected = "frf.csv:1: expected decay_per_s = a number of 1/s from 0 on, found decay_per_s = soon";
    assert!(message.contains(expected), "{message}");
}

#[test]
fn records_at_fault_and_options_that_fit_nothing_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    chain(at);
    let frf = |arguments: &[&str]| refused(at, &[&["frf"], arguments].concat());
    std::fs::write(at.join("t.csv"), "time_s,hammer,Acceleration (g)\n0,0,0\n0.1,1,1\n0.2,0,0\n").unwrap();
    std::fs::write(at.join("uneven.csv"), "t,f (N),a (g)\n0,0,0\n0.1,1,1\n0.3,0,0\n").unwrap();
    for (arguments, said) in [
        (&["none.lvm", "-o", "x.uff"][..], "none.lvm: expected a file, found none"),
        (&["bar/K.mtx", "-o", "x.uff"], "bar/K.mtx: expected time records"),
        (
            &["bar/frf.uff", "-o", "x.uff"],
            "bar/frf.uff: expected time functions (dataset 58 of function type 1), found none",
        ),
        (&["bar/records.lvm", "-o", "x.txt"], "x.txt: expected an ending that names a format"),
        (
            &["t.csv", "-o", "x.uff"],
            "t.csv: expected a channel in a unit of force, or --force with its name or number, \
             found 1: \"hammer\" in no unit, 2: \"Acceleration\" in g",
        ),
        (
            &["t.csv", "-o", "x.uff", "--force", "hammer"],
            "t.csv: expected a known unit of \"hammer\", or --force-unit",
        ),
        (&["t.csv", "-o", "x.uff", "--force", "3"], "--force: expected the name or the number of a channel"),
        (&["uneven.csv", "-o", "x.uff"], "uneven.csv: expected equally spaced instants"),
        (&["bar/records.lvm", "-o", "x.uff", "--keep", "2"], "--keep: expected impacts from 1 to 1, found 2"),
        (
            &["bar/records.lvm", "-o", "x.uff", "--length", "0"],
            "--length: expected a positive number, found 0",
        ),
        (
            &["bar/records.lvm", "-o", "x.uff", "--length", "9"],
            "bar/records.lvm: expected an impact without fault, found none: impact 1: record incomplete, 1600 of 28800 samples",
        ),
        (
            &["bar/records.lvm", "-o", "x.uff", "--force-sensitivity", "2mV/N"],
            "--force-sensitivity: expected a voltage in \"Force\" for a sensitivity",
        ),
        (&["bar/records.lvm", "-o", "x.uff", "--response-unit", "furlong"], "furlong"),
    ] {
        let message = frf(arguments);
        assert!(message.contains(said), "{arguments:?}: {message}");
        assert!(!at.join("x.uff").exists());
    }
}

#[test]
fn sensitivities_units_and_degrees_of_freedom_from_the_command_line() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    done(at, &["--quiet", "example", "hammer-bar", "bar"]);
    // The same records in mV without units: 5 mV/N and 2 mV/g.
    let text = std::fs::read_to_string(at.join("bar/records.lvm")).unwrap();
    let mut rows = String::from("time_s,h,a\n");
    let samples = text.lines().skip_while(|line| !line.starts_with("X_Value")).skip(1);
    for (k, line) in samples.filter(|line| !line.is_empty()).enumerate() {
        let cells: Vec<f64> = line.split('\t').skip(1).map(|cell| cell.parse().unwrap()).collect();
        rows += &format!("{},{:e},{:e}\n", k as f64 * 0.3125e-3, 5.0 * cells[0], 2.0 * cells[1] / 9.80665);
    }
    std::fs::write(at.join("mv.csv"), rows).unwrap();
    done(at, &["--quiet", "frf", "bar/records.lvm", "-o", "direct.csv"]);
    done(
        at,
        &[
            "--quiet",
            "frf",
            "mv.csv",
            "-o",
            "mv.uff",
            "--force",
            "h",
            "--response",
            "2",
            "--force-sensitivity",
            "5mV/N",
            "--response-sensitivity",
            "2mV/g",
            "--force-dof",
            "1+X",
            "--response-dof",
            "401-X",
        ],
    );
    done(at, &["--quiet", "convert", "mv.uff", "mv-frf.csv", "--response", "401-X", "--reference", "1+X"]);
    let read = |name: &str| std::fs::read_to_string(at.join(name)).unwrap();
    let (direct, other) = (read("direct.csv"), read("mv-frf.csv"));
    let norm = |table: &str| -> Vec<f64> {
        numbers(table, "re").iter().zip(numbers(table, "im")).map(|(re, im)| re.hypot(im)).collect()
    };
    assert_eq!(norm(&direct).len(), 799);
    for (a, b) in norm(&direct).iter().zip(norm(&other)) {
        // 13 digits in UFF; the scale is a product of rounded factors.
        assert!((a - b).abs() < 1e-11 * a, "{a} {b}");
    }
}

/// The second FRF of the file is that of mid-length, and the case takes it for the corner of the tip. The DOF of the case counts, and both are said.
#[test]
fn a_dof_that_contradicts_the_file_is_said() {
    let folder = tempfile::tempdir().unwrap();
    done(folder.path(), &["example", "sandwich", "beam"]);
    let file = folder.path().join("beam/case.toml");
    let text = fs::read_to_string(&file).unwrap();
    let wrong = text.replace("dof = \"248+Z\" ", "record = 2\ndof = \"248+Z\" ");
    assert_ne!(text, wrong);
    let quick = wrong.replace("[identify]\n", "[identify]\ncheck = false\nmax_lines = 20\n");
    fs::write(&file, format!("model_error = \"none\"\n{quick}")).unwrap();
    let said = done(folder.path(), &["identify", "beam/case.toml", "--out", "out"]);
    assert!(said.contains("measured at 202+Z as the file says, at 248+Z as the case says"), "{said}");
    let summary: serde_json::Value =
        serde_json::from_str(&fs::read_to_string(folder.path().join("out/summary.json")).unwrap()).unwrap();
    assert_eq!(summary["sensors"][0]["dof_in_file"], "202+Z");
    assert!(summary["sensors"][1].get("dof_in_file").is_none());
}
