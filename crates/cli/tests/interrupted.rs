//! A run that is ended from outside leaves earlier results as they were.
#![cfg(unix)]

mod common;

use common::done;
use std::collections::BTreeMap;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::Duration;

/// Every file below a folder with its bytes.
fn contents(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut files = BTreeMap::new();
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            files.extend(contents(&path));
        } else {
            files.insert(path.display().to_string(), std::fs::read(&path).unwrap());
        }
    }
    files
}

#[test]
fn interrupt_and_kill_at_any_moment_leave_earlier_results() {
    let folder = tempfile::tempdir().unwrap();
    done(folder.path(), &["--quiet", "example", "clamped-plate", "plate"]);
    // A short band first; then the whole one, which takes seconds on the full model: killed before, it has nothing to write yet.
    done(folder.path(), &["--quiet", "identify", "plate/case.toml", "--out", "out", "--band", "20:100"]);
    let before = contents(&folder.path().join("out"));
    assert!(before.len() > 5);
    let (mut ended, mut finished) = (0, 0);
    for signal in ["-INT", "-KILL"] {
        for milliseconds in [1, 20, 80, 200, 500] {
            let mut run = Command::new(env!("CARGO_BIN_EXE_frfit"))
                .args(["--quiet", "identify", "plate/case.toml", "--out", "out", "--space", "full"])
                .current_dir(folder.path())
                .stdout(Stdio::null())
                .spawn()
                .unwrap();
            std::thread::sleep(Duration::from_millis(milliseconds));
            let sent = Command::new("kill").args([signal, &run.id().to_string()]).status().unwrap();
            let status = run.wait().unwrap();
            if status.success() {
                finished += 1;
                continue;
            }
            assert!(sent.success());
            ended += 1;
            assert_eq!(contents(&folder.path().join("out")), before, "{signal} after {milliseconds} ms");
        }
        // On a machine that is done within half a second there would be nothing to see.
        assert!(ended > 0, "{finished} of the runs were done before the signal");
    }
}
