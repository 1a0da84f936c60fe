//! `frfit sensitivities` from case files: what is said of parameters that the sensors cannot separate, what noise is taken, what is refused.

use frfit_workflow::job::respond_case;
use frfit_workflow::load::Overrides;
use frfit_workflow::sensitivities::{SensitivityJob, SensitivityOptions, sensitivities_case};
use serde_json::Value;
use std::fmt::Write;
use std::fs;
use std::path::Path;
use tempfile::TempDir;

const N: usize = 6;

/// The chain's stiffness and a unit mass at each of its masses.
fn matrices(folder: &Path) {
    let mut k = format!("%%MatrixMarket matrix coordinate real symmetric\n{N} {N} {}\n", 2 * N - 1);
    let mut m = format!("%%MatrixMarket matrix coordinate real symmetric\n{N} {N} {N}\n");
    for i in 1..=N {
        writeln!(k, "{i} {i} {}", if i < N { 2.0 } else { 1.0 }).unwrap();
        if i < N {
            writeln!(k, "{} {i} -1.0", i + 1).unwrap();
        }
        writeln!(m, "{i} {i} 1.0").unwrap();
    }
    fs::write(folder.join("K.mtx"), k).unwrap();
    fs::write(folder.join("M.mtx"), m).unwrap();
}

fn matrix(name: &str, role: &str, file: &str, factor: &str) -> String {
    format!("[[matrix]]\nname = \"{name}\"\nrole = \"{role}\"\nfile = \"{file}\"\nfactor = {factor}\n")
}

/// Springs with a loss factor and masses, driven at the free end.
fn chain() -> String {
    matrix("springs", "stiffness", "K.mtx", "{ storage = 400.0, loss_factor = 0.05 }")
        + &matrix("masses", "mass", "M.mtx", "0.8")
        + &format!("[load]\nrow = {N}\n")
}

const RESPOND: &str = "[respond]\nband_hz = [0.5, 6.0]\npoints = 40\n";

fn run(folder: &TempDir, case: &str, options: &SensitivityOptions) -> SensitivityJob {
    matrices(folder.path());
    let file = folder.path().join("case.toml");
    fs::write(&file, case).unwrap();
    sensitivities_case(&file, &Overrides::default(), options, None).unwrap()
}

fn options(noise: Option<f64>, candidates: &str) -> SensitivityOptions {
    SensitivityOptions { noise, candidates: candidates.parse().unwrap(), memory_bytes: None }
}

/// Standard deviation of a parameter in the summary.
fn std_of(summary: &Value, name: &str) -> Option<f64> {
    let parameters = summary["parameters"].as_array().unwrap();
    parameters.iter().find(|parameter| parameter["name"] == name).unwrap()["std"].as_f64()
}

#[test]
fn of_springs_in_parallel_only_the_sum_is_seen() {
    let folder = tempfile::tempdir().unwrap();
    let case = matrix("soft", "stiffness", "K.mtx", "100.0")
        + &matrix("stiff", "stiffness", "K.mtx", "300.0")
        + &matrix("masses", "mass", "M.mtx", "0.8")
        + "[load]\nrow = 6\n[[measurement]]\nrow = 6\n[[attached]]\nrow = 2\ndamping = 1.5\n"
        + RESPOND;
    let job = run(&folder, &case, &options(Some(0.02), "all"));
    let found = &job.summary["inseparable"];
    assert_eq!(found.as_array().unwrap().len(), 1, "{found}");
    assert_eq!(found[0]["parameters"], serde_json::json!(["soft", "stiff"]));
    let words = found[0]["words"].as_str().unwrap();
    assert!(
        words.contains("only their sum is seen (±") && words.ends_with("not their difference"),
        "{words}"
    );
    assert!(std_of(&job.summary, "soft").is_none() && std_of(&job.summary, "masses").unwrap() < 0.05);
    assert!(std_of(&job.summary, "attached 1 (damping at row 2)").unwrap() < 0.3);
    // No place in the world separates them: the best sensor is for the others.
    let next = &job.summary["next_sensor"];
    assert_eq!((&next["compared"], &next["before"]["unseen"]), (&Value::from(N - 1), &Value::from(2)));
    assert_eq!(next["best"][0]["after"]["unseen"], 2);
    assert!(job.text.all.contains("inseparable       soft, stiff: only their sum"), "{}", job.text.all);
}

#[test]
fn with_an_unknown_scale_a_common_factor_is_not_seen() {
    let folder = tempfile::tempdir().unwrap();
    let known = chain() + "[[measurement]]\nrow = 6\n" + RESPOND;
    let job = run(&folder, &known, &options(None, "none"));
    assert!(
        job.summary["inseparable"].as_array().unwrap().is_empty() && job.summary["next_sensor"].is_null()
    );
    assert!(job.text.all.contains("identifiable      all parameters"), "{}", job.text.all);
    let unknown = chain() + "[[measurement]]\nrow = 6\nscale = \"unknown\"\n" + RESPOND;
    let job = run(&folder, &unknown, &options(None, "all"));
    let words = job.summary["inseparable"][0]["words"].as_str().unwrap();
    assert_eq!(
        words,
        "springs, masses, scale at row 6: a common factor of all of them is not seen (not at all)"
    );
    // Another sensor of known scale settles it.
    let next = &job.summary["next_sensor"];
    assert_eq!(
        (&next["before"]["unseen"], &next["best"][0]["after"]["unseen"]),
        (&Value::from(3), &Value::from(0))
    );
}

#[test]
fn noise_is_what_the_files_say_or_what_is_asked_for() {
    let folder = tempfile::tempdir().unwrap();
    let plain = chain() + "[[measurement]]\nrow = 6\n" + RESPOND;
    let assumed = run(&folder, &plain, &options(None, "none"));
    assert_eq!(assumed.summary["noise"], serde_json::json!({"source": "assumed", "relative": 0.01}));
    let file = folder.path().join("case.toml");
    let out = folder.path().join("out");
    let (_, response) = respond_case(&file, &Overrides::default(), None, Some(&out), &|_, _| {}).unwrap();
    let mut table = "frequency_hz,re,im,std\n0.0,1.0,0.0,0.1\n".to_owned();
    for (f, x) in response.frequency_hz.iter().zip(&response.receptance) {
        let x = x.as_ref().unwrap()[0];
        writeln!(table, "{f},{},{},{}", x.re, x.im, 0.02 * x.norm()).unwrap();
    }
    fs::write(folder.path().join("frf.csv"), table).unwrap();
    // From 0 Hz on, where nothing moves: that line is left out.
    let measured = chain() + "[[measurement]]\nfile = \"frf.csv\"\nquantity = \"receptance\"\nrow = 6\n";
    let measured_run = run(&folder, &measured, &options(None, "none"));
    assert_eq!(measured_run.summary["noise"], serde_json::json!({"source": "files"}));
    assert_eq!(
        (&measured_run.summary["frequencies"], &measured_run.summary["band_hz"][0]),
        (&Value::from(40), &Value::from(0.5))
    );
    let given = run(&folder, &measured, &options(Some(0.01), "none"));
    for name in ["springs", "springs loss factor", "masses"] {
        let [assumed, from_files, given] =
            [&assumed, &measured_run, &given].map(|job| std_of(&job.summary, name).unwrap());
        // A table of 17 digits: the same to roundoff.
        assert!(
            (from_files / (2.0 * assumed) - 1.0).abs() < 1e-9 && (given / assumed - 1.0).abs() < 1e-9,
            "{name}"
        );
    }
    // Within the band that is to be identified.
    let band = measured + "[identify]\nmatrix = \"springs\"\nband_hz = [2.0, 4.0]\n";
    let within = run(&folder, &band, &options(None, "none"));
    let [low, high] = [0, 1].map(|k| within.summary["band_hz"][k].as_f64().unwrap());
    assert!(low >= 2.0 && high <= 4.0 && within.summary["frequencies"].as_u64().unwrap() > 10);
}

#[test]
fn a_free_structure_and_an_undamped_one_are_answered() {
    let folder = tempfile::tempdir().unwrap();
    matrices(folder.path());
    let free = "%%MatrixMarket matrix coordinate real symmetric\n6 6 11\n1 1 1\n2 1 -1\n2 2 2\n3 2 -1\n3 3 2\n4 3 -1\n4 4 2\n5 4 -1\n5 5 2\n6 5 -1\n6 6 1\n";
    fs::write(folder.path().join("free.mtx"), free).unwrap();
    let case = matrix("springs", "stiffness", "free.mtx", "400.0")
        + &matrix("masses", "mass", "M.mtx", "0.8")
        + "[load]\nrow = 1\n[[measurement]]\nrow = 6\n"
        + RESPOND;
    let job = run(&folder, &case, &options(None, "all"));
    let job_run = job.run.unwrap();
    assert!(job_run.trained.converged);
    // x is homogeneous of degree −1 in stiffness and mass together, at every frequency.
    for at in &job_run.values {
        let sum = at[0][0].unwrap().0 + at[1][0].unwrap().0;
        assert!((sum + 1.0).norm() < 1e-9, "{sum}");
    }
}

#[test]
fn what_cannot_be_used_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    matrices(folder.path());
    let file = folder.path().join("case.toml");
    let refused = |case: &str, candidates: &str| {
        fs::write(&file, case).unwrap();
        let error = sensitivities_case(&file, &Overrides::default(), &options(None, candidates), None);
        error.unwrap_err().to_string()
    };
    let plain = chain() + "[[measurement]]\nrow = 6\n";
    assert!(refused(&plain, "none").contains("expected a table [respond]"));
    let with = plain + RESPOND;
    let beyond = refused(&with, "7");
    assert!(beyond.contains("--candidates: expected a row from 1 to 6, found 7"), "{beyond}");
    let unnamed = refused(&with, "12+Z");
    assert!(unnamed.contains("--candidates") && unnamed.contains("[dofs]"), "{unnamed}");
}

/// Stiffness and mass that go with a geometric parameter as with factors: with both of them it is not identifiable.
#[test]
fn dimensions_are_parameters() {
    let folder = tempfile::tempdir().unwrap();
    let case = chain()
        + "[[measurement]]\nrow = 6\n[[measurement]]\nrow = 3\n[[identify]]\nname = \"thickness\"\npowers = { springs = 3, masses = 1 }\nnominal = 1.1\n"
        + RESPOND;
    let job = run(&folder, &case, &options(Some(0.02), "none"));
    let parameters = job.summary["parameters"].as_array().unwrap();
    let kind = |name: &str| &parameters.iter().find(|one| one["name"] == name).unwrap()["kind"];
    assert_eq!((kind("thickness"), kind("springs")), (&Value::from("dimension"), &Value::from("factor")));
    let found = &job.summary["inseparable"];
    assert_eq!(found[0]["parameters"], serde_json::json!(["springs", "masses", "thickness"]), "{found}");
}
