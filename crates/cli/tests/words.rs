//! What the program says, word for word.

mod common;

use common::done;

/// Text with its measured seconds masked: they are the one thing that differs between runs.
fn without_seconds(text: &str) -> String {
    text.lines()
        .map(|line| match line.strip_suffix(" s").and_then(|rest| rest.rsplit_once(", ")) {
            Some((work, seconds)) if seconds.parse::<f64>().is_ok() => format!("{work}, [seconds] s\n"),
            _ => format!("{line}\n"),
        })
        .collect()
}

#[test]
fn help_of_every_command() {
    let folder = tempfile::tempdir().unwrap();
    insta::assert_snapshot!("help", done(folder.path(), &["--help"]));
    for command in ["demo", "example", "identify", "respond", "inspect", "convert"] {
        insta::assert_snapshot!(format!("help_{command}"), done(folder.path(), &[command, "--help"]));
    }
}

#[test]
fn examples_and_the_demo() {
    let folder = tempfile::tempdir().unwrap();
    insta::assert_snapshot!("examples", done(folder.path(), &["example"]));
    insta::assert_snapshot!("demo", without_seconds(&done(folder.path(), &["demo"])));
    insta::assert_snapshot!(
        "inspect",
        done(&folder.path().join("frfit-demo"), &["inspect", "K.mtx", "frf.uff", "force.csv", "truth.csv"])
    );
}
