//! Many runs by one plan, with one reduced model.

use crate::common;
use crate::tier::of_tier;

use common::{column, done, frfit, refused};
use serde_json::Value;
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::Duration;

/// A sandwich, specimens of it that were measured up to other frequencies, and a reduced model for all.
fn with_plan(folder: &Path, rows: usize) {
    done(folder, &["--quiet", "example", "sandwich", "s"]);
    let case = fs::read_to_string(folder.join("s/case.toml")).unwrap();
    assert_eq!(case.matches("band_hz = [20.0, 1000.0]").count(), 1, "{case}");
    fs::write(
        folder.join("s/case.toml"),
        case.replace("band_hz = [20.0, 1000.0]", "band_hz = [300.0, 400.0]"),
    )
    .unwrap();
    done(folder, &["--quiet", "train", "s/case.toml", "--out", "m.frfit"]);
    let row = |k: usize| format!("s/case.toml,beam {k},\"[300.0, {}.0]\"\n", 400 - 10 * k);
    let rows: String = (0..rows).map(row).collect();
    fs::write(folder.join("plan.csv"), format!("case,specimen,identify.band_hz\n{rows}")).unwrap();
}

/// A table whose cells have no commas in them.
fn plain(table: &str) -> String {
    let cell = |(k, part): (usize, &str)| if k % 2 == 1 { part.replace(',', ";") } else { part.to_owned() };
    table.split('"').enumerate().map(cell).collect()
}

/// The tables of every run of a store, by its key.
fn tables(store: &Path) -> BTreeMap<String, Vec<Vec<u8>>> {
    let run = |entry: fs::DirEntry| {
        let files = ["identified.csv", "candidates.csv", "response.csv", "updated.uff", "plan.json"];
        let contents = files.map(|file| fs::read(entry.path().join(file)).unwrap()).to_vec();
        (entry.file_name().into_string().unwrap(), contents)
    };
    fs::read_dir(store.join("runs")).unwrap().map(|entry| run(entry.unwrap())).collect()
}

#[test]
fn runs_are_the_same_alone_in_shares_and_as_tasks_of_slurm() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    with_plan(at, 3);
    let batch = |store: &str, more: &[&str]| {
        let usual = ["--json", "batch", "plan.csv", "--out", store, "--reduced", "m.frfit"];
        done(at, &[&usual[..], more].concat())
    };
    batch("whole", &[]);
    assert!(batch("shares", &["--shard", "1/2", "--jobs", "1"]).contains("\"done\": 2"));
    let said = done(at, &["batch", "status", "plan.csv", "--out", "shares", "--reduced", "m.frfit"]);
    assert_eq!(said, "3 runs: 2 done, 0 failed, 1 missing\n");
    let slurm =
        [("SLURM_ARRAY_TASK_ID", "8"), ("SLURM_ARRAY_TASK_COUNT", "2"), ("SLURM_ARRAY_TASK_MIN", "7")];
    let task = Command::new(env!("CARGO_BIN_EXE_frfit"))
        .args(["batch", "plan.csv", "--out", "shares", "--reduced", "m.frfit"])
        .envs(slurm)
        .current_dir(at)
        .output()
        .unwrap();
    let said = String::from_utf8(task.stdout).unwrap();
    assert!(said.starts_with("1 of 1 runs done ("), "{said}");
    let whole = tables(&at.join("whole"));
    assert_eq!((whole.len(), whole == tables(&at.join("shares"))), (3, true));
    // The same bits as a case in which the band stands.
    let case = fs::read_to_string(at.join("s/case.toml")).unwrap();
    fs::write(at.join("s/third.toml"), case.replace("[300.0, 400.0]", "[300.0, 380.0]")).unwrap();
    done(at, &["--quiet", "identify", "s/third.toml", "--out", "third", "--reduced", "m.frfit"]);
    let third = fs::read(at.join("third/identified.csv")).unwrap();
    assert_eq!(whole.values().filter(|files| files[0] == third).count(), 1);
    let table = plain(&done(at, &["batch", "collect", "whole", "-o", "-"]));
    // The words about it go to standard error.
    assert_eq!(column(&table, "specimen"), ["beam 0", "beam 1", "beam 2"]);
    assert_eq!(column(&table, "verdict"), ["explained"; 3]);
    done(at, &["--quiet", "batch", "collect", "whole", "-o", "lines.csv", "--lines"]);
    let lines = plain(&fs::read_to_string(at.join("lines.csv")).unwrap());
    // Of 11, 10 and 9 lines.
    assert_eq!(column(&lines, "frequency_hz").len(), 30);
    assert_eq!(column(&table, "lines"), ["11", "10", "9"]);
}

#[test]
fn a_run_that_fails_is_told_apart_and_tried_again_when_asked() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    with_plan(at, 0);
    let rows = "s/case.toml,here,frf.uff\ns/case.toml,late,late.uff\nnowhere.toml,lost,\n";
    fs::write(at.join("plan.csv"), format!("case,specimen,measurement.1.file\n{rows}")).unwrap();
    let batch = ["batch", "plan.csv", "--out", "store"];
    let said = done(at, &batch);
    assert!(said.contains("1 of 3 runs done"), "{said}");
    assert!(said.contains("row 2 failed: s/case.toml:") && said.contains("s/late.uff, found none"), "{said}");
    assert!(said.contains("row 3 failed: nowhere.toml: expected a case file, found none"), "{said}");
    let strict = frfit(at, &[&batch[..], &["--strict"]].concat());
    assert_eq!(strict.status.code(), Some(1));
    // What a run depends on is another file now: it is another run, and is done.
    fs::copy(at.join("s/frf.uff"), at.join("s/late.uff")).unwrap();
    let said = done(at, &batch);
    assert!(said.contains("1 of 3 runs done, 1 were there") && said.contains("1 failed before"), "{said}");
    let said = done(at, &[&batch[..], &["--retry", "failed"]].concat());
    assert!(said.contains("0 of 3 runs done, 2 were there") && said.contains("row 3 failed"), "{said}");
    let table = plain(&done(at, &["batch", "collect", "store", "-o", "-"]));
    let verdicts = column(&table, "verdict");
    assert_eq!(verdicts.iter().filter(|verdict| *verdict == "explained").count(), 2, "{table}");
    assert_eq!(verdicts.iter().filter(|verdict| *verdict == "failed").count(), 1, "{table}");
    assert!(table.contains("a case file; found none"), "{table}");
}

#[test]
fn what_cannot_be_a_plan_or_a_share_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    with_plan(at, 1);
    let said = |plan: &str, more: &[&str]| {
        fs::write(at.join("wrong.csv"), plan).unwrap();
        refused(at, &[&["batch", "wrong.csv", "--out", "store"], more].concat())
    };
    assert!(said("specimen,a\n1,2\n", &[]).contains("expected a column \"case\""));
    assert!(said("case,specimen\n", &[]).contains("expected a row for each run, found none"));
    assert!(said("case,a,a\nx,1,2\n", &[]).contains("two named \"a\""));
    assert!(said("case,a\n,1\n", &[]).contains("the path of a case"));
    let output = frfit(at, &["batch", "plan.csv", "--out", "store", "--shard", "3/2"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(!at.join("store").exists());
    assert!(refused(at, &["batch", "collect", "store", "-o", "-"]).contains("a store with runs"));
    // A key that leads nowhere is the fault of its row, and says so with the plan's line.
    let path = "case,matrix.glue.factor\ns/case.toml,1.0\n";
    fs::write(at.join("wrong.csv"), path).unwrap();
    let words = done(at, &["batch", "wrong.csv", "--out", "store"]);
    assert!(
        words.contains("row 1 failed: wrong.csv:2: matrix.glue.factor: expected the name or the number"),
        "{words}"
    );
}

#[test]
fn a_kept_reduced_model_serves_modes_and_sensitivities() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    with_plan(at, 0);
    let json = |arguments: &[&str]| -> Value { serde_json::from_str(&done(at, arguments)).unwrap() };
    let number = |value: &Value, path: &str| value.pointer(path).and_then(Value::as_f64).unwrap();
    for (verb, more, compared) in [
        ("modes", &[][..], "/model/modes/3/frequency_hz"),
        ("sensitivities", &["--candidates", "none"][..], "/parameters/0/rms"),
    ] {
        let usual = [&["--json", verb, "s/case.toml"], more].concat();
        let [own, kept] = [json(&usual), json(&[&usual[..], &["--reduced", "m.frfit"]].concat())];
        let [a, b] = [&own, &kept].map(|found| number(found, compared));
        assert!((a - b).abs() < 1e-5 * a.abs(), "{verb}: {a} and {b}");
        let work =
            |found: &Value| ["factorisations", "solves"].map(|of| number(found, &format!("/counts/{of}")));
        let ([own_factors, own_solves], [factors, solves]) = (work(&own), work(&kept));
        assert!(factors <= own_factors && solves < own_solves, "{verb}: {own} and {kept}");
    }
    let words = refused(at, &["modes", "s/case.toml", "--reduced", "s/K_core.mtx"]);
    assert!(words.contains("K_core.mtx"), "{words}");
}

#[test]
fn a_reduced_model_belongs_to_its_matrices_load_and_sensors() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    with_plan(at, 0);
    let with = |from: &str, to: &str| {
        let case = fs::read_to_string(at.join("s/case.toml")).unwrap();
        assert!(case.contains(from), "{case}");
        fs::write(at.join("s/other.toml"), case.replacen(from, to, 1)).unwrap();
        refused(at, &["identify", "s/other.toml", "--out", "out", "--reduced", "m.frfit"])
    };
    let load = fs::read_to_string(at.join("s/case.toml")).unwrap();
    let load = load.lines().skip_while(|line| *line != "[load]").nth(1).unwrap().to_owned();
    let said = with(&load, "row = 77");
    assert!(said.contains("m.frfit") && said.contains("found that of another load"), "{said}");
    let said = with("file = \"M_core.mtx\"", "file = \"M_skins.mtx\"");
    assert!(said.contains("another matrix in place of \"core-mass\""), "{said}");
    let wrong = refused(at, &["identify", "s/case.toml", "--out", "out", "--reduced", "s/K_core.mtx"]);
    assert!(wrong.contains("K_core.mtx") && wrong.contains("expected a file of frfit train"), "{wrong}");
    let mut bytes = fs::read(at.join("m.frfit")).unwrap();
    let middle = bytes.len() / 2;
    bytes[middle] ^= 1;
    fs::write(at.join("damaged.frfit"), bytes).unwrap();
    let wrong = refused(at, &["identify", "s/case.toml", "--out", "out", "--reduced", "damaged.frfit"]);
    assert!(wrong.contains("damaged.frfit"), "{wrong}");
    let own = refused(at, &["train", "s/case.toml", "--reduced", "m.frfit", "--out", "m.frfit"]);
    assert!(own.contains("a file that this command reads"), "{own}");
    let full = ["identify", "s/case.toml", "--out", "out", "--reduced", "m.frfit", "--reduction", "full"];
    assert!(refused(at, &full).contains("--reduced: expected the reduction"));
    assert!(!at.join("out").exists());
    // Without a factorisation, and kept again.
    let more = [
        "--json",
        "identify",
        "s/case.toml",
        "--out",
        "out",
        "--reduced",
        "m.frfit",
        "--keep-reduced",
        "n.frfit",
    ];
    let first = done(at, &more);
    let again = done(at, &["--json", "identify", "s/case.toml", "--out", "again", "--reduced", "n.frfit"]);
    assert!(first.contains("\"solves\": ") && again.contains("\"factorisations\": 0"), "{again}");
    let checked = done(at, &["check", "s/case.toml", "--reduced", "n.frfit"]);
    assert_eq!(checked, done(at, &["check", "s/case.toml"]));
}

/// The values of a measurement are not needed to train: the same file without them, and at other frequencies nearly the same subspace.
#[test]
fn a_model_is_trained_before_anything_is_measured() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    done(at, &["--quiet", "example", "sandwich", "s"]);
    let case = fs::read_to_string(at.join("s/case.toml")).unwrap();
    let unmeasured = case.replace("file = \"frf.uff\"\n", "");
    let respond = "[respond]\nband_hz = [20.0, 1000.0]\npoints = 99\n";
    fs::write(at.join("s/planned.toml"), &unmeasured).unwrap();
    fs::write(at.join("s/same.toml"), format!("{unmeasured}\n{respond}")).unwrap();
    for name in ["case", "planned", "same"] {
        let (case, kept) = (format!("s/{name}.toml"), format!("{name}.frfit"));
        done(at, &["--quiet", "train", &case, "--out", &kept]);
    }
    assert!(fs::read(at.join("case.frfit")).unwrap() == fs::read(at.join("same.frfit")).unwrap());
    let identify = ["--json", "identify", "s/case.toml", "--out", "out", "--reduced", "planned.frfit"];
    let found: Value = serde_json::from_str(&done(at, &identify)).unwrap();
    assert_eq!(found["status"]["ok"], 99, "{found}");
    // From nothing there are three, of more than a hundred solves.
    let [factorisations, solves] =
        ["factorisations", "solves"].map(|count| found["counts"][count].as_u64().unwrap());
    assert!(factorisations <= 1 && solves <= 30, "{factorisations} {solves}");
    let said = refused(at, &["identify", "s/planned.toml", "--out", "other"]);
    assert!(said.contains("the key \"file\""), "{said}");
}

/// A batch that is killed loses the runs in flight and nothing else.
#[cfg(unix)]
#[test]
fn kill_at_any_moment_leaves_whole_runs() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    with_plan(at, 8);
    let arguments = ["--quiet", "batch", "plan.csv", "--out", "store", "--reduced", "m.frfit"];
    let whole = |store: &Path| {
        for entry in fs::read_dir(store.join("runs")).into_iter().flatten() {
            let run = entry.unwrap().path();
            let summary = fs::read_to_string(run.join("summary.json")).unwrap();
            assert!(summary.trim_end().ends_with('}'), "{summary}");
            let table = fs::read_to_string(run.join("identified.csv")).unwrap();
            assert!(table.ends_with('\n') && run.join("plan.json").exists(), "{table}");
        }
    };
    let mut ended = 0;
    for k in 0..of_tier(4, 50) {
        let mut run = Command::new(env!("CARGO_BIN_EXE_frfit"))
            .args(arguments)
            .current_dir(at)
            .stdout(Stdio::null())
            .spawn()
            .unwrap();
        std::thread::sleep(Duration::from_millis(10 + 137 * k % 400));
        ended += usize::from(run.try_wait().unwrap().is_none());
        run.kill().unwrap();
        run.wait().unwrap();
        whole(&at.join("store"));
    }
    assert!(ended > 0, "every batch was done before the signal");
    done(at, &arguments);
    whole(&at.join("store"));
    assert_eq!(fs::read_dir(at.join("store/partial")).unwrap().count(), 0);
    let said = done(at, &["batch", "status", "plan.csv", "--out", "store", "--reduced", "m.frfit"]);
    assert_eq!(said, "8 runs: 8 done, 0 failed, 0 missing\n");
}
