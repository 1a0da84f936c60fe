//! What the program says, word for word.

use crate::common;

use common::done;

/// A report without what differs between machines: seconds, and what hangs on the last bit (the largest error, the number of
/// steps in which a spectral radius converges).
fn portable(text: &str) -> String {
    let masked = |line: &str| match line.split_whitespace().next() {
        Some("error") => "  error             at most [roundoff] (where ok)".to_owned(),
        Some("work") => match line.split_once(',') {
            Some((factorisations, _)) => format!("{factorisations}, [solves], [seconds]"),
            None => line.to_owned(),
        },
        Some("subspace") | Some("of") => match line.split_once("to ") {
            Some((before, _)) => format!("{before}to [error] (estimated)"),
            None => line.to_owned(),
        },
        _ => line.to_owned(),
    };
    text.lines().map(|line| masked(line) + "\n").collect()
}

#[test]
fn help_of_every_command() {
    let folder = tempfile::tempdir().unwrap();
    insta::assert_snapshot!("help", done(folder.path(), &["--help"]));
    for command in [
        "demo",
        "example",
        "frf",
        "check",
        "identify",
        "train",
        "batch",
        "fit",
        "report",
        "export",
        "respond",
        "sensitivities",
        "modes",
        "inspect",
        "convert",
    ] {
        insta::assert_snapshot!(format!("help_{command}"), done(folder.path(), &[command, "--help"]));
    }
}

#[test]
fn examples_and_the_demo() {
    let folder = tempfile::tempdir().unwrap();
    insta::assert_snapshot!("examples", done(folder.path(), &["example"]));
    insta::assert_snapshot!("demo", portable(&done(folder.path(), &["demo"])));
    insta::assert_snapshot!(
        "inspect",
        done(&folder.path().join("frfit-demo"), &["inspect", "K.mtx", "frf.uff", "force.csv", "truth.csv"])
    );
}

#[test]
fn a_hammer_test() {
    let folder = tempfile::tempdir().unwrap();
    insta::assert_snapshot!("hammer_example", done(folder.path(), &["example", "hammer-bar", "bar"]));
    let made = done(folder.path(), &["frf", "bar/records.lvm", "-o", "bar/frf.uff"]);
    insta::assert_snapshot!("hammer_frf", made);
    insta::assert_snapshot!(
        "hammer_inspect",
        done(folder.path(), &["inspect", "bar/records.lvm", "bar/frf.uff"])
    );
}

#[test]
fn sensitivities_of_a_sandwich() {
    let folder = tempfile::tempdir().unwrap();
    done(folder.path(), &["example", "sandwich", "sandwich"]);
    let wanted = ["sensitivities", "sandwich/case.toml", "--out", "out", "--candidates", "62+Z,143+Z,196+Z"];
    insta::assert_snapshot!("sensitivities", portable(&done(folder.path(), &wanted)));
    let table = std::fs::read_to_string(folder.path().join("out/sensitivities.csv")).unwrap();
    // 99 frequencies, two sensors, six parameters.
    assert_eq!(table.lines().count(), 1 + 99 * 2 * 6);
    assert!(folder.path().join("out/figures/sensitivities.svg").exists());
}
