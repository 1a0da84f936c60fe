//! Factors by ranks of MUMPS, in place of our own.

use crate::common;
use crate::ranks::{launcher, program};

use common::{column, done, refused};
use std::fs;
use std::path::Path;
use std::process::Command;

/// The example in a short band, with these lines after it.
fn sandwich(folder: &Path, lines: &str) {
    done(folder, &["--quiet", "example", "sandwich", "s"]);
    let case = fs::read_to_string(folder.join("s/case.toml")).unwrap();
    let short = case.replace("band_hz = [20.0, 1000.0]", "band_hz = [300.0, 400.0]");
    assert_ne!(case, short);
    fs::write(folder.join("s/case.toml"), short + lines).unwrap();
}

/// The command, with the program of the ranks in its environment.
fn with_ranks(folder: &Path, arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_frfit"));
    command.args(arguments).current_dir(folder).env("FRFIT_MUMPS", program());
    command
}

#[test]
fn a_case_starts_no_other_program() {
    let folder = tempfile::tempdir().unwrap();
    sandwich(folder.path(), "\n[solver]\nengine = \"mumps\"\nlaunch = \"mpirun -n 2 touch stolen;\"\n");
    let words = refused(folder.path(), &["identify", "s/case.toml"]);
    assert!(words.contains("solver.launch") && words.contains("found \"touch\""), "{words}");
    assert!(words.contains("any other command only as --launch"), "{words}");
    assert!(!folder.path().join("case-results").exists());
}

#[test]
fn a_launcher_without_its_engine_is_refused_and_so_is_one_that_is_not_there() {
    let folder = tempfile::tempdir().unwrap();
    sandwich(folder.path(), "");
    let words = refused(folder.path(), &["identify", "s/case.toml", "--launch", &launcher(3)]);
    assert!(words.contains("--launch: expected --engine mumps beside it"), "{words}");
    let words = refused(folder.path(), &["identify", "s/case.toml", "--engine", "pardiso"]);
    assert!(words.contains("--engine: expected \"multifrontal\" or \"mumps\", found \"pardiso\""), "{words}");
    let absent = ["identify", "s/case.toml", "--engine", "mumps", "--launch", "no-such-launcher -n 2"];
    let words = refused(folder.path(), &absent);
    assert!(words.contains("\"no-such-launcher\" cannot be run"), "{words}");
}

#[test]
#[ignore = "needs MUMPS"]
fn ranks_give_the_same_answers_needs_mumps() {
    let folder = tempfile::tempdir().unwrap();
    sandwich(folder.path(), "");
    done(folder.path(), &["--quiet", "identify", "s/case.toml", "--out", "own"]);
    let ranks = [
        "--quiet",
        "identify",
        "s/case.toml",
        "--out",
        "ranks",
        "--engine",
        "mumps",
        "--launch",
        &launcher(3),
    ];
    let output = with_ranks(folder.path(), &ranks).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let table = |out: &str| fs::read_to_string(folder.path().join(out).join("identified.csv")).unwrap();
    let [own, ranks] = [table("own"), table("ranks")];
    assert_eq!(column(&own, "status"), column(&ranks, "status"));
    for name in ["storage", "loss_factor"] {
        for (own, ranks) in column(&own, name).iter().zip(column(&ranks, name)) {
            let [own, ranks]: [f64; 2] = [own.parse().unwrap(), ranks.parse().unwrap()];
            // Each engine trains a subspace of its own, whose error of the response (1e-9) moves the core by up to 2e-8.
            assert!((own - ranks).abs() < 1e-7 * own.abs(), "{name}: {own} and {ranks}");
        }
    }
    let summary = fs::read_to_string(folder.path().join("ranks/summary.json")).unwrap();
    let summary: serde_json::Value = serde_json::from_str(&summary).unwrap();
    let engine = summary["model"]["engine"].as_str().unwrap();
    assert!(engine.starts_with("mumps 5.") && engine.ends_with(", ranks: 3"), "{engine}");
}

#[test]
#[ignore = "needs MUMPS"]
#[cfg(unix)]
fn ranks_that_end_are_said_with_their_words_needs_mumps() {
    let folder = tempfile::tempdir().unwrap();
    sandwich(folder.path(), "");
    // Every rank ends itself some time after it has begun; the launcher says which signal it was.
    let script = folder.path().join("ranks.sh");
    let full = ["identify", "s/case.toml", "--out", "out", "--reduction", "full"];
    let launcher = launcher(3);
    let arguments = [&full[..], &["--engine", "mumps", "--launch", &launcher]].concat();
    for seconds in ["0.3", "1.5"] {
        let text = format!("#!/bin/sh\n(sleep {seconds}; kill -9 $$) &\nexec {}\n", program().display());
        fs::write(&script, text).unwrap();
        fs::set_permissions(&script, std::os::unix::fs::PermissionsExt::from_mode(0o755)).unwrap();
        let output = with_ranks(folder.path(), &arguments).env("FRFIT_MUMPS", &script).output().unwrap();
        let words = String::from_utf8_lossy(&output.stdout) + String::from_utf8_lossy(&output.stderr);
        // At the start, at the forecast of the memory, or in the middle of the band.
        assert!(words.contains("the ranks ") && words.contains("signal 9"), "{words}");
        if output.status.success() {
            let table = fs::read_to_string(folder.path().join("out/identified.csv")).unwrap();
            assert!(column(&table, "status").contains(&"failed".to_owned()), "{table}");
            assert!(words.contains("no answer"), "{words}");
        }
    }
}
