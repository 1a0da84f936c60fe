//! What the program says, word for word.

use crate::common;

use common::done;

/// A report without what differs between machines: seconds, and what hangs on the last bit (the largest error, the number of
/// steps in which a spectral radius converges).
fn portable(text: &str) -> String {
    let estimated = |line: &str| match line.split_once("to ") {
        Some((before, _)) => format!("{before}to [error] (estimated)"),
        None => line.to_owned(),
    };
    let masked = |line: &str| match line.split_whitespace().next() {
        Some("error") => "  error             at most [roundoff] (where ok)".to_owned(),
        Some("work") => match line.split_once(',') {
            Some((factorisations, _)) => format!("{factorisations}, [solves], [seconds]"),
            None => line.to_owned(),
        },
        Some("subspace") => estimated(line),
        _ if line.contains(" places compared; ") => estimated(line),
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
        "completions",
        "man",
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

/// A page of the manual for every command, and scripts that a shell takes.
#[test]
fn manual_pages_and_completions() {
    let folder = tempfile::tempdir().unwrap();
    done(folder.path(), &["man", "man1"]);
    let page = |name: &str| std::fs::read_to_string(folder.path().join("man1").join(name)).unwrap();
    assert!(page("frfit.1").contains("frfit\\-identify(1)"));
    assert!(page("frfit-batch-collect.1").contains("A row for each line of each run"));
    assert!(page("frfit-identify.1").contains("Folder for the results"));
    for (shell, word) in [("bash", "COMPREPLY"), ("zsh", "#compdef frfit"), ("fish", "complete -c frfit")] {
        let script = done(folder.path(), &["completions", shell]);
        assert!(script.contains(word) && script.contains("keep-reduced"), "{shell}");
    }
}

/// Without --out results are beside the case; an edited example is not overwritten.
#[test]
fn folders_without_a_name_and_edited_examples() {
    let folder = tempfile::tempdir().unwrap();
    done(folder.path(), &["--quiet", "example", "density", "d"]);
    done(folder.path(), &["--quiet", "respond", "d/case.toml"]);
    assert!(folder.path().join("d/case-response/response.csv").exists());
    done(folder.path(), &["--quiet", "identify", "d/case.toml"]);
    assert!(folder.path().join("d/case-results/identified.csv").exists());
    done(folder.path(), &["--quiet", "example", "density", "d"]);
    let case = folder.path().join("d/case.toml");
    let edited = std::fs::read_to_string(&case).unwrap() + "# mine\n";
    std::fs::write(&case, &edited).unwrap();
    let refusal = common::refused(folder.path(), &["example", "density", "d"]);
    assert!(refusal.contains("an edited file is not overwritten"), "{refusal}");
    assert_eq!(std::fs::read_to_string(&case).unwrap(), edited);
}
