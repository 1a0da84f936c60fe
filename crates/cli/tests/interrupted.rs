//! A run that is ended from outside leaves earlier results as they were.
#![cfg(unix)]

use crate::common;
use crate::tier::of_tier;

use common::{done, frfit};
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
        for &milliseconds in of_tier(&[20, 200, 500][..], &[1, 20, 80, 200, 500]) {
            let mut run = Command::new(env!("CARGO_BIN_EXE_frfit"))
                .args(["--quiet", "identify", "plate/case.toml", "--out", "out", "--reduction", "full"])
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

#[test]
fn a_run_that_is_killed_at_any_moment_leaves_whole_files_and_a_result_that_is_known_to_be_whole_or_not() {
    let folder = tempfile::tempdir().unwrap();
    done(folder.path(), &["--quiet", "example", "density", "d"]);
    let arguments = |band: &'static str, out: &'static str| {
        ["--quiet", "identify", "d/case.toml", "--error-map", "0", "--band", band, "--out", out]
    };
    let bands = ["10:500", "10:900"];
    let outs = ["of-0", "of-1"];
    let start = std::time::Instant::now();
    for (band, out) in bands.into_iter().zip(outs) {
        done(folder.path(), &arguments(band, out));
    }
    let run_s = 0.5 * start.elapsed().as_secs_f64();
    // What is the same in each run of a band: not the summary and what is made of it, which have seconds in them.
    let whole = |name: &str| outs.map(|out| std::fs::read(folder.path().join(out).join(name)).unwrap());
    let tables = ["identified.csv", "response.csv", "candidates.csv", "updated.uff", "figures/modulus.svg"];
    let tables = tables.into_iter().filter(|name| folder.path().join("of-0").join(name).exists());
    let tables: Vec<(&str, [Vec<u8>; 2])> = tables.map(|name| (name, whole(name))).collect();
    assert!(tables.len() >= 4);
    let mut ended = 0;
    for round in 0..of_tier(9, 40) {
        let mut run = Command::new(env!("CARGO_BIN_EXE_frfit"))
            .args(arguments(bands[round % 2], "out"))
            .current_dir(folder.path())
            .stdout(Stdio::null())
            .spawn()
            .unwrap();
        // Moments spread evenly over a run and a little more, in no order; a third of them late, where files are written.
        let part = (round as f64 * 0.618_033_988_75).fract();
        let part = if round % 3 == 0 { 0.8 + 0.3 * part } else { 1.2 * part };
        std::thread::sleep(Duration::from_secs_f64(part * run_s));
        let _ = run.kill();
        ended += usize::from(!run.wait().unwrap().success());
        let out = folder.path().join("out");
        for (name, versions) in &tables {
            if let Ok(bytes) = std::fs::read(out.join(name)) {
                assert!(versions.contains(&bytes), "round {round}: {name} is of no run");
            }
        }
        if out.join("summary.json").exists() {
            let report = frfit(folder.path(), &["report", "out"]);
            let said = String::from_utf8_lossy(&report.stderr).into_owned();
            let is_refused = said.contains("expected the files of one run of frfit identify");
            assert!(report.status.success() || is_refused, "round {round}: {said}");
        }
    }
    assert!(ended > 0, "all runs were done before they were killed");
    // The next run is whole, and clears away what the others have left.
    done(folder.path(), &arguments(bands[0], "out"));
    done(folder.path(), &["--quiet", "report", "out"]);
    let left = contents(&folder.path().join("out"));
    assert!(left.keys().all(|name| !name.contains(".frfit-")), "{:?}", left.keys());
}
