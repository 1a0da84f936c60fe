//! No command loses or half-writes a file: inputs are spared, links and devices are written through, results are of one run.

use crate::common;

use common::{done, frfit, refused};
use serde_json::Value;
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

fn folder() -> tempfile::TempDir {
    tempfile::tempdir().unwrap()
}

/// Every file in a folder and below it with its bytes.
fn contents(folder: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let mut files = BTreeMap::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            files.extend(contents(&path));
        } else {
            let bytes = fs::read(&path).unwrap();
            files.insert(path, bytes);
        }
    }
    files
}

/// Runs a command that is refused because of what it reads, and asserts that no file is changed or made.
fn spared(folder: &Path, arguments: &[&str], name: &str) {
    let before = contents(folder);
    let said = refused(folder, arguments);
    assert!(
        said.contains(&format!("{name}: expected a file or folder of its own for what is written, found a file that this command reads")),
        "{arguments:?}: {said}"
    );
    assert!(contents(folder) == before, "{arguments:?} has changed a file");
}

/// The example `density` in `d/`, with the measured table by another name.
fn density(at: &Path, table: &str) {
    done(at, &["--quiet", "example", "density", "d"]);
    let case = at.join("d/case.toml");
    let text = fs::read_to_string(&case).unwrap();
    assert!(text.contains("\"frf.csv\""));
    fs::write(case, text.replace("\"frf.csv\"", &format!("\"{table}\""))).unwrap();
    fs::rename(at.join("d/frf.csv"), at.join("d").join(table)).unwrap();
}

#[test]
fn results_are_not_written_over_files_of_the_case() {
    let at = folder();
    density(at.path(), "response.csv");
    for command in ["identify", "respond"] {
        spared(at.path(), &[command, "d/case.toml", "--out", "d"], "d/response.csv");
    }
    let at = folder();
    density(at.path(), "sensitivities.csv");
    spared(at.path(), &["sensitivities", "d/case.toml", "--out", "d/../d"], "sensitivities.csv");
    // The case file itself; a UFF file; several unknowns.
    let at = folder();
    done(at.path(), &["--quiet", "example", "clamped-plate", "p"]);
    spared(at.path(), &["respond", "p/case.toml", "--out", "p"], "p/frf.uff");
    fs::rename(at.path().join("p/case.toml"), at.path().join("p/summary.json")).unwrap();
    spared(at.path(), &["identify", "p/summary.json", "--out", "p"], "p/summary.json");
    done(at.path(), &["--quiet", "example", "joint-stiffness", "j"]);
    fs::rename(at.path().join("j/case.toml"), at.path().join("j/identified.csv")).unwrap();
    spared(at.path(), &["identify", "j/identified.csv", "--out", "j"], "j/identified.csv");
}

#[test]
fn files_are_not_written_over_what_they_are_made_of() {
    let at = folder();
    density(at.path(), "frf.csv");
    spared(at.path(), &["convert", "d/K.mtx", "d/K.mtx"], "d/K.mtx");
    spared(at.path(), &["convert", "d/frf.csv", "./d/frf.csv"], "d/frf.csv");
    fs::write(at.path().join("m.csv"), "frequency_hz,storage,loss_factor\n1,1e9,0.1\n2,2e9,0.1\n3,3e9,0.1\n")
        .unwrap();
    spared(at.path(), &["export", "csv", "m.csv", "-o", "m.csv"], "m.csv");
    fs::copy(at.path().join("m.csv"), at.path().join("law.json")).unwrap();
    spared(at.path(), &["fit", "law.json", "--out", "."], "law.json");
    done(at.path(), &["--quiet", "fit", "m.csv", "--law", "constant", "--out", "laws"]);
    spared(
        at.path(),
        &["export", "csv", "m.csv", "--law", "laws/law.json", "-o", "laws/law.json"],
        "laws/law.json",
    );
    done(at.path(), &["--quiet", "example", "hammer-bar", "h"]);
    fs::rename(at.path().join("h/records.lvm"), at.path().join("h/frf.uff")).unwrap();
    spared(at.path(), &["frf", "h/frf.uff", "-o", "h/frf.uff"], "h/frf.uff");
    fs::rename(at.path().join("h/frf.uff"), at.path().join("h/frf-summary.json")).unwrap();
    spared(at.path(), &["frf", "h/frf-summary.json", "-o", "h/frf.uff"], "h/frf-summary.json");
}

#[cfg(unix)]
#[test]
fn an_input_is_known_by_its_links() {
    use std::os::unix::fs::symlink;
    let at = folder();
    density(at.path(), "frf.csv");
    fs::create_dir(at.path().join("out")).unwrap();
    symlink("../d/frf.csv", at.path().join("out/response.csv")).unwrap();
    spared(at.path(), &["respond", "d/case.toml", "--out", "out"], "out/response.csv");
    fs::remove_file(at.path().join("out/response.csv")).unwrap();
    fs::hard_link(at.path().join("d/M.mtx"), at.path().join("out/summary.json")).unwrap();
    spared(at.path(), &["identify", "d/case.toml", "--out", "out"], "out/summary.json");
    symlink("d", at.path().join("same")).unwrap();
    spared(at.path(), &["convert", "d/K.mtx", "same/K.mtx"], "same/K.mtx");
}

#[test]
fn a_minus_is_standard_output() {
    let at = folder();
    density(at.path(), "frf.csv");
    let matrix = frfit(at.path(), &["convert", "d/K.mtx", "-", "--to", "rsa"]);
    done(at.path(), &["convert", "d/K.mtx", "K.rsa"]);
    assert_eq!(matrix.status.code(), Some(0));
    assert!(matrix.stdout == fs::read(at.path().join("K.rsa")).unwrap());
    assert!(String::from_utf8_lossy(&matrix.stderr).starts_with("wrote - ("));
    let silent = frfit(at.path(), &["--quiet", "convert", "d/K.mtx", "-", "--to", ".rsa"]);
    assert!(silent.stdout == matrix.stdout && silent.stderr.is_empty());
    let said = refused(at.path(), &["convert", "d/K.mtx", "-"]);
    assert!(said.contains("expected an ending that names a format") && said.contains("--to"), "{said}");
    let said = refused(at.path(), &["convert", "d/K.mtx", "-", "--to", "mtx", "--json"]);
    assert!(said.contains("--json"), "{said}");
    fs::write(at.path().join("m.csv"), "frequency_hz,storage,loss_factor\n1,1e9,0.1\n2,2e9,0.1\n").unwrap();
    let table = frfit(at.path(), &["export", "json", "m.csv", "-o", "-"]);
    assert_eq!(serde_json::from_slice::<Value>(&table.stdout).unwrap()["storage"][1], 2e9);
    done(at.path(), &["--quiet", "example", "hammer-bar", "h"]);
    let frf = frfit(at.path(), &["frf", "h/records.lvm", "-o", "-", "--to", "uff"]);
    done(at.path(), &["--quiet", "frf", "h/records.lvm", "-o", "frf.uff"]);
    assert!(!frf.stdout.is_empty() && frf.stdout == fs::read(at.path().join("frf.uff")).unwrap());
    assert!(String::from_utf8_lossy(&frf.stderr).ends_with("wrote   -\n"));
    for command in [&["identify", "d/case.toml"][..], &["respond", "d/case.toml"], &["fit", "m.csv"]] {
        let said = refused(at.path(), &[command, &["--out", "-"]].concat());
        assert!(said.contains("-: expected a folder"), "{said}");
    }
    assert!(!at.path().join("-").exists());
}

#[cfg(unix)]
#[test]
fn devices_and_pipes_are_written_through_and_stay() {
    use std::os::unix::fs::FileTypeExt;
    let at = folder();
    density(at.path(), "frf.csv");
    let direct = frfit(at.path(), &["--quiet", "convert", "d/K.mtx", "/dev/stdout", "--to", "mtx"]);
    assert!(direct.stdout == fs::read(at.path().join("d/K.mtx")).unwrap());
    done(at.path(), &["--quiet", "convert", "d/K.mtx", "/dev/null", "--to", "mtx"]);
    assert!(fs::metadata("/dev/null").unwrap().file_type().is_char_device());
    if Path::new("/dev/full").exists() {
        let said = refused(at.path(), &["convert", "d/K.mtx", "/dev/full", "--to", "mtx"]);
        assert!(said.starts_with("frfit: /dev/full: expected to write here, found "), "{said}");
    }
    let pipe = at.path().join("pipe.mtx");
    assert!(std::process::Command::new("mkfifo").arg(&pipe).status().unwrap().success());
    let reader = std::thread::spawn({
        let pipe = pipe.clone();
        move || fs::read(pipe).unwrap()
    });
    done(at.path(), &["convert", "d/K.mtx", "pipe.mtx"]);
    assert!(reader.join().unwrap() == fs::read(at.path().join("d/K.mtx")).unwrap());
    assert!(fs::metadata(&pipe).unwrap().file_type().is_fifo());
}

#[cfg(unix)]
#[test]
fn links_and_permissions_stay_and_what_is_read_only_is_not_replaced() {
    use std::os::unix::fs::{PermissionsExt, symlink};
    let at = folder();
    density(at.path(), "frf.csv");
    let (file, link) = (at.path().join("far.mtx"), at.path().join("link.mtx"));
    fs::write(&file, "old").unwrap();
    fs::set_permissions(&file, fs::Permissions::from_mode(0o640)).unwrap();
    symlink("far.mtx", &link).unwrap();
    done(at.path(), &["convert", "d/K.mtx", "link.mtx"]);
    assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
    assert!(fs::read(&file).unwrap() == fs::read(at.path().join("d/K.mtx")).unwrap());
    let mode = |path: &Path| fs::metadata(path).unwrap().permissions().mode() & 0o777;
    assert_eq!(mode(&file), 0o640);
    fs::set_permissions(&file, fs::Permissions::from_mode(0o440)).unwrap();
    let said = refused(at.path(), &["convert", "d/M.mtx", "link.mtx"]);
    assert!(said.contains("link.mtx: expected a file that may be written, found a read-only one"), "{said}");
    // What is new has what the umask leaves.
    let shell = format!("umask 027; '{}' --quiet convert d/K.mtx new.mtx", env!("CARGO_BIN_EXE_frfit"));
    let ran = std::process::Command::new("sh").args(["-c", &shell]).current_dir(at.path()).status().unwrap();
    assert!(ran.success());
    assert_eq!(mode(&at.path().join("new.mtx")), 0o640);
}

/// The files of a result in the order in which they are put in place: the list first, the page last.
fn in_order(folder: &Path) -> Vec<String> {
    let list: Value =
        serde_json::from_slice(&fs::read(folder.join("identify-manifest.json")).unwrap()).unwrap();
    let names =
        list["files"].as_array().unwrap().iter().map(|file| file["name"].as_str().unwrap().to_owned());
    let first = std::iter::once("identify-manifest.json".to_owned());
    first.chain(names).chain(std::iter::once("report.html".to_owned())).collect()
}

#[test]
fn a_result_of_two_runs_or_of_half_of_one_is_no_result() {
    let at = folder();
    density(at.path(), "frf.csv");
    let identify = |out: &str, band: &str| {
        done(
            at.path(),
            &["--quiet", "identify", "d/case.toml", "--error-map", "0", "--out", out, "--band", band],
        );
    };
    identify("old", "10:500");
    identify("new", "10:900");
    done(at.path(), &["--quiet", "report", "new"]);
    let names = in_order(&at.path().join("new"));
    assert_eq!(names, in_order(&at.path().join("old")));
    assert!(names.len() > 8, "{names:?}");
    // Every file of the folder is in the list.
    assert_eq!(contents(&at.path().join("new")).len(), names.len());
    let mixed = at.path().join("mixed");
    let put = |from: &str, name: &str| {
        let to = mixed.join(name);
        fs::create_dir_all(to.parent().unwrap()).unwrap();
        fs::copy(at.path().join(from).join(name), to).unwrap();
    };
    // Killed after so many files, over an old result and in a new folder.
    for over_old in [true, false] {
        for count in 1..names.len() {
            let _ = fs::remove_dir_all(&mixed);
            if over_old {
                names.iter().for_each(|name| put("old", name));
            }
            names[..count].iter().for_each(|name| put("new", name));
            fs::create_dir(mixed.join(".frfit-1-0.partial")).unwrap();
            fs::write(mixed.join(".frfit-1-0.partial/lock"), "").unwrap();
            fs::write(mixed.join(".frfit-1-0.partial/0"), "half of a table").unwrap();
            fs::write(mixed.join("notes.txt"), "mine").unwrap();
            // All but the page, which is made again of the others.
            let whole = count == names.len() - 1;
            // The page may be the same in both.
            if whole {
                done(at.path(), &["--quiet", "report", "mixed"]);
                assert!(
                    fs::read(mixed.join("report.html")).unwrap()
                        == fs::read(at.path().join("new/report.html")).unwrap()
                );
            } else {
                let said = refused(at.path(), &["report", "mixed"]);
                let word = if over_old { "changed, or of another run: " } else { "missing: " };
                assert!(said.contains("expected the files of one run of frfit identify"), "{said}");
                assert!(said.contains(word) && said.contains("identify-manifest.json"), "{said}");
            }
        }
    }
    // The next run mends all, and leaves alone what is not its own.
    identify("mixed", "10:900");
    done(at.path(), &["--quiet", "report", "mixed"]);
    assert!(!mixed.join(".frfit-1-0.partial").exists());
    assert_eq!(fs::read_to_string(mixed.join("notes.txt")).unwrap(), "mine");
    // A table of another command, by the same name.
    done(at.path(), &["--quiet", "respond", "d/case.toml", "--out", "mixed"]);
    let said = refused(at.path(), &["report", "mixed"]);
    assert!(said.contains("changed, or of another run: ") && said.contains("response.csv"), "{said}");
    // A result without a list, as of an earlier version, is taken as it is.
    fs::remove_file(at.path().join("new/identify-manifest.json")).unwrap();
    done(at.path(), &["--quiet", "report", "new"]);
    fs::write(at.path().join("new/identify-manifest.json"), "{\"files\": 3}").unwrap();
    let said = refused(at.path(), &["report", "new"]);
    assert!(said.contains("identify-manifest.json: expected the list of files"), "{said}");
}

#[test]
fn every_result_has_the_list_of_its_files() {
    let at = folder();
    density(at.path(), "frf.csv");
    done(at.path(), &["--quiet", "respond", "d/case.toml", "--out", "r"]);
    done(at.path(), &["--quiet", "sensitivities", "d/case.toml", "--out", "s"]);
    fs::write(at.path().join("m.csv"), "frequency_hz,storage,loss_factor\n1,1e9,0.1\n2,2e9,0.1\n3,3e9,0.1\n")
        .unwrap();
    done(at.path(), &["--quiet", "fit", "m.csv", "--law", "constant", "--out", "f"]);
    done(at.path(), &["--quiet", "example", "hammer-bar", "h"]);
    done(at.path(), &["--quiet", "frf", "h/records.lvm", "-o", "h/out/frf.uff"]);
    done(at.path(), &["--quiet", "example", "joint-stiffness", "j"]);
    done(at.path(), &["--quiet", "identify", "j/case.toml", "--out", "j/out"]);
    for (folder, list) in [
        ("r", "respond-manifest.json"),
        ("s", "sensitivities-manifest.json"),
        ("f", "fit-manifest.json"),
        ("h/out", "frf-manifest.json"),
        ("j/out", "identify-manifest.json"),
    ] {
        let folder = at.path().join(folder);
        let list: Value = serde_json::from_slice(&fs::read(folder.join(list)).unwrap()).unwrap();
        let files = list["files"].as_array().unwrap();
        for file in files {
            let there = fs::metadata(folder.join(file["name"].as_str().unwrap())).unwrap().len();
            assert_eq!(file["bytes"], there, "{file}");
        }
        let page = usize::from(folder.join("report.html").exists());
        assert_eq!(contents(&folder).len(), files.len() + 1 + page, "{}", folder.display());
    }
}

#[test]
fn control_characters_of_files_do_not_reach_the_terminal() {
    let at = folder();
    density(at.path(), "frf.csv");
    let case = at.path().join("d/case.toml");
    let text = fs::read_to_string(&case).unwrap();
    // Clears the screen; would pass for a line of its own.
    let title = r#"title = "\u001b[2Jcl\u009b31mear\n  no finding        all is well""#;
    fs::write(&case, text.replacen("title =", &format!("{title}\n#"), 1)).unwrap();
    let esc = "b\u{1b}]0;x\u{7}.csv";
    fs::write(at.path().join(esc), "frequency_hz,re\u{1b}[31m,im\n1,2,3\n").unwrap();
    let uff = "    -1\n   151\nmodel \u{1b}[2J\nmade\nby\u{7}\n01-Jan-26 10:00:00\n01-Jan-26 10:00:00\nfrfit\n01-Jan-26 10:00:00\n    -1\n";
    fs::write(at.path().join("u.uff"), uff).unwrap();
    let lvm = "time_s,\"Fo\u{1b}[2Jrce (N)\",\"Acc\n (g)\"\n0,0,0\n1e-3,1,1\n2e-3,0,0\n3e-3,0,0\n";
    fs::write(at.path().join("records.csv"), lvm).unwrap();
    fs::write(at.path().join("bad.toml"), "title = \"a\"\nk\u{1b}ey = 3\n[\"x\\u001b[2J\"]\n").unwrap();
    let commands: [&[&str]; 12] = [
        &["check", "d/case.toml"],
        &["check", "d/case.toml", "--json"],
        &["identify", "d/case.toml", "--out", "o", "--error-map", "0"],
        &["identify", "d/case.toml", "--out", "o", "--error-map", "0", "--json"],
        &["respond", "d/case.toml", "--out", "r"],
        &["sensitivities", "d/case.toml"],
        &["inspect", "u.uff"],
        &["inspect", esc],
        &["inspect", "records.csv"],
        &["frf", "records.csv", "-o", "x.uff"],
        &["check", "bad.toml"],
        &["convert", esc, "no\u{1b}[2J.such"],
    ];
    for arguments in commands {
        let output = frfit(at.path(), arguments);
        for said in [output.stdout, output.stderr] {
            let said = String::from_utf8(said).unwrap();
            assert!(!said.replace('\n', "").contains(char::is_control), "{arguments:?}: {said:?}");
            assert!(!said.lines().any(|line| line == "  no finding        all is well"), "{said}");
        }
    }
    let said = done(at.path(), &["check", "d/case.toml"]);
    assert!(said.starts_with("\\x1b[2Jcl\\x9b31mear\\n  no finding"), "{said}");
    let json: Value = serde_json::from_str(&done(at.path(), &["check", "d/case.toml", "--json"])).unwrap();
    assert!(json["title"].as_str().unwrap().starts_with("\\x1b[2Jcl"));
    let said = refused(at.path(), &["frob\u{1b}[2J"]);
    assert!(!said.replace('\n', "").contains(char::is_control) && said.contains("'frob"), "{said:?}");
}

/// The example `density` with its measured values conjugated.
fn conjugated(at: &Path) {
    density(at, "frf.csv");
    let table = at.join("d/frf.csv");
    let text = fs::read_to_string(&table).unwrap();
    let mut lines = text.lines();
    let head = lines.next().unwrap();
    let im = head.split(',').position(|name| name == "im").unwrap();
    let turned = lines.map(|line| {
        let mut cells: Vec<String> = line.split(',').map(str::to_owned).collect();
        cells[im] = (-cells[im].parse::<f64>().unwrap()).to_string();
        cells.join(",")
    });
    let turned: Vec<String> = std::iter::once(head.to_owned()).chain(turned).collect();
    fs::write(table, turned.join("\n") + "\n").unwrap();
}

#[test]
fn a_conjugated_frf_is_named_and_quiet_does_not_silence_it() {
    let at = folder();
    conjugated(at.path());
    let finding = "  conjugated        row 79: the FRF is the complex conjugate (time convention e^(-iωt))";
    let loud = done(at.path(), &["check", "d/case.toml"]);
    assert!(loud.contains(finding), "{loud}");
    let quiet = done(at.path(), &["check", "d/case.toml", "--quiet"]);
    assert!(quiet.starts_with(finding) && quiet.lines().count() == 3, "{quiet}");
    assert_eq!(frfit(at.path(), &["check", "d/case.toml", "--quiet", "--strict"]).status.code(), Some(1));
    let identify = ["identify", "d/case.toml", "--out", "o", "--error-map", "0", "--strict", "--quiet"];
    let output = frfit(at.path(), &identify);
    let said = String::from_utf8(output.stdout).unwrap();
    assert_eq!(output.status.code(), Some(1), "{said}");
    assert!(said.starts_with(finding) && said.contains("  not explained "), "{said}");
    assert!(!said.contains("wrote") && !said.contains("  work"), "{said}");
    let summary: Value =
        serde_json::from_slice(&fs::read(at.path().join("o/summary.json")).unwrap()).unwrap();
    assert_eq!(summary["findings"][0]["kind"], "conjugated");
}

#[test]
fn quiet_says_nothing_where_all_is_well() {
    let at = folder();
    density(at.path(), "frf.csv");
    for arguments in [
        &["check", "d/case.toml"][..],
        &["identify", "d/case.toml", "--out", "o", "--error-map", "0"],
        &["respond", "d/case.toml", "--out", "r"],
        &["convert", "d/K.mtx", "K.rsa"],
        &["report", "o"],
    ] {
        let output = frfit(at.path(), &[arguments, &["--quiet"]].concat());
        assert_eq!(output.status.code(), Some(0));
        let said =
            String::from_utf8_lossy(&output.stdout).into_owned() + &String::from_utf8_lossy(&output.stderr);
        assert_eq!(said, "", "{arguments:?}");
    }
    // Impacts that are left out of an FRF are said.
    done(at.path(), &["--quiet", "example", "hammer-bar", "h"]);
    let loud = done(at.path(), &["frf", "h/records.lvm", "-o", "frf.uff"]);
    let quiet = done(at.path(), &["frf", "h/records.lvm", "-o", "frf.uff", "--quiet"]);
    let left_out: Vec<&str> =
        loud.lines().filter(|line| line.contains(" left out ") || line.starts_with("  note")).collect();
    assert!(!left_out.is_empty(), "{loud}");
    assert_eq!(quiet.lines().collect::<Vec<_>>(), left_out);
}

#[test]
fn matrices_of_any_size_of_numbers_give_the_same_answer_or_are_refused() {
    let at = folder();
    density(at.path(), "frf.csv");
    for power in ["e90", "e-90", "e160", "e-160"] {
        for matrix in ["K.mtx", "M.mtx"] {
            let text = fs::read_to_string(at.path().join("d").join(matrix)).unwrap();
            let mut sized = false;
            let scaled = text.lines().map(|line| {
                let cells: Vec<&str> = line.split(' ').collect();
                let is_entry = sized && !line.starts_with('%');
                sized |= !line.starts_with('%');
                if !is_entry {
                    return line.to_owned();
                }
                let value = cells[2].parse::<f64>().unwrap() * format!("1{power}").parse::<f64>().unwrap();
                format!("{} {} {value:e}", cells[0], cells[1])
            });
            let scaled: Vec<String> = scaled.collect();
            let folder = at.path().join(power);
            fs::create_dir_all(&folder).unwrap();
            fs::write(folder.join(matrix), scaled.join("\n") + "\n").unwrap();
        }
        // The response of the scaled model at the true density is smaller by that number.
        let case = fs::read_to_string(at.path().join("d/case.toml")).unwrap();
        let case = case.replace("\"frf.csv\"", "\"../measured.csv\"");
        fs::write(at.path().join(power).join("case.toml"), case).unwrap();
        let measured = fs::read_to_string(at.path().join("d/frf.csv")).unwrap();
        let by: f64 = format!("1{power}").parse().unwrap();
        let divided = measured.lines().map(|line| {
            let cells = line.split(',').enumerate().map(|(k, cell)| match cell.parse::<f64>() {
                Ok(value) if k > 0 => format!("{:e}", value / by),
                _ => cell.to_owned(),
            });
            cells.collect::<Vec<_>>().join(",")
        });
        let divided: Vec<String> = divided.collect();
        fs::write(at.path().join("measured.csv"), divided.join("\n") + "\n").unwrap();
        let case = format!("{power}/case.toml");
        if power.ends_with("160") {
            // The square of such a number is infinite, or zero: norms of vectors would be.
            for command in [&["check"][..], &["identify", "--out", "none"], &["respond", "--out", "none"]] {
                let said = refused(at.path(), &[command, &[&case]].concat());
                assert!(
                    said.contains(
                        "expected matrices whose largest entry with its factor is from 1e-100 to 1e100"
                    ),
                    "{said}"
                );
                assert!(
                    said.contains(&format!("{power}/case.toml:")) && said.contains("in matrix \"beam\""),
                    "{said}"
                );
            }
            assert!(!at.path().join("none").exists());
            continue;
        }
        let said = done(at.path(), &["check", &case]);
        assert!(said.contains("no finding"), "{power}: {said}");
        let said = done(at.path(), &["identify", &case, "--out", "o", "--error-map", "0", "--strict"]);
        assert!(
            said.contains("  status            199 ok\n") && said.contains("100.0 % of all"),
            "{power}: {said}"
        );
        let said = done(at.path(), &["inspect", &format!("{power}/K.mtx")]);
        assert!(said.contains(power) && said.contains("a term of a model"), "{said}");
        done(at.path(), &["respond", &case, "--out", "r"]);
    }
}
