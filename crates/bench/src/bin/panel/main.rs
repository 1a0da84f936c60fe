//! A sandwich panel from its files to the modulus: `frfit identify` as a user runs it, over the size of the model.
//!
//! `panel [[LEAST..]MOST [FOLDER]]` takes the models of so many degrees of freedom (default: up to 310000, some GB of memory and of disk); `panel 1000000..1100000`
//! is the one of a million, `panel 2000000..2100000` that of two. The cases are kept where there is a folder for them.
//!
//! The sandwich of the example in bricks, skins and core in four layers of elements, 1000 frequencies, two sensors, on all cores. The measurement is made with a
//! subspace of its own ([`frfit_bench::measurement::by_subspace`]) whose estimated error is given. Everything counts: reading the matrices,
//! identifying, tables and figures.
#![allow(clippy::print_stdout, clippy::print_stderr)] // tables are what a benchmark is for

use frfit_bench::measurement::by_subspace;
use frfit_bench::{Structure, Table, exponent, machine, memory, panel, panel_dofs};
use frfit_examples::Model;
use serde_json::Value;
use std::error::Error;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};
use std::{fs, thread};

/// Elements along the sandwich; an eighth of it across, and four through the thickness: 10k, 50k, 100k, 300k, 1 000k, 2 000k degrees of freedom.
const LENGTHS: [usize; 6] = [72, 160, 224, 400, 728, 1032];

const FREQUENCIES: usize = 1000;

/// A step that the seven digits of a UFF file hold.
const STEP_HZ: f64 = 0.98;

/// How often the memory of the program is looked at.
const LOOK: Duration = Duration::from_millis(20);

/// What one size costs.
struct Cost {
    dofs: usize,
    /// Bytes of all files.
    bytes: usize,
    /// Estimated error of what was measured.
    measurement: f64,
    seconds: f64,
    /// Largest resident memory of the program.
    peak: Option<usize>,
    summary: Value,
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let range = arguments.next().unwrap_or("310000".to_owned());
    let (least, most) = range.split_once("..").unwrap_or(("0", &range));
    let range = least.parse()?..=most.parse()?;
    let kept = arguments.next().map(PathBuf::from);
    let program = program()?;
    println!("From files to the modulus: frfit identify over the size of the model\n{}", machine());
    println!("{FREQUENCIES} frequencies; wall seconds of the whole program and of its stages\n");
    let mut costs = Vec::new();
    for nx in LENGTHS.into_iter().filter(|&nx| range.contains(&panel_dofs(nx))) {
        eprintln!("{} degrees of freedom …", panel_dofs(nx));
        costs.push(cost(&program, nx, kept.as_deref())?);
    }
    println!("{}", table(&costs));
    Ok(())
}

/// The program as it is built for release.
fn program() -> Result<PathBuf, Box<dyn Error>> {
    let built =
        Command::new("cargo").args(["build", "--quiet", "--release", "--package", "frfit-cli"]).status()?;
    let path = std::env::current_exe()?.with_file_name("frfit");
    if !built.success() || !path.is_file() {
        return Err(format!("no program at {}", path.display()).into());
    }
    Ok(path)
}

fn cost(program: &Path, nx: usize, kept: Option<&Path>) -> Result<Cost, Box<dyn Error>> {
    let temporary = tempfile::tempdir()?;
    let model = panel(nx)?;
    let dofs = model.stiffness.dim();
    let folder = kept.map_or(temporary.path().to_path_buf(), |kept| kept.join(dofs.to_string()));
    fs::create_dir_all(&folder)?;
    let (bytes, measurement) = write(model, &folder)?;
    let start = Instant::now();
    let mut child = Command::new(program)
        .args(["identify", "case.toml", "--out", "identified"])
        .current_dir(&folder)
        .stdout(Stdio::null())
        .spawn()?;
    let mut peak = None;
    let status = loop {
        peak = memory::peak_of(child.id()).max(peak);
        match child.try_wait()? {
            Some(status) => break status,
            None => thread::sleep(LOOK),
        }
    };
    let seconds = start.elapsed().as_secs_f64();
    if !status.success() {
        return Err(format!("frfit identify: {status}").into());
    }
    let summary = serde_json::from_slice(&fs::read(folder.join("identified/summary.json"))?)?;
    Ok(Cost { dofs, bytes, measurement, seconds, peak, summary })
}

/// Writes the case; bytes of all files, and the estimated error of the measurement.
fn write(model: Model, folder: &Path) -> Result<(usize, f64), Box<dyn Error>> {
    let frequency_hz: Vec<f64> = (0..FREQUENCIES).map(|k| model.band_hz[0] + STEP_HZ * k as f64).collect();
    let example = frfit_examples::list().iter().find(|example| example.name == "sandwich");
    let example = example.ok_or("no example is named sandwich")?;
    // The model is large: it is lent to the measurement, and taken back.
    let dofs = model.dofs.clone();
    let parameter = model.parameter.clone();
    let (band_hz, step_hz) = (model.band_hz, model.step_hz);
    let structure = Structure::of(model, frequency_hz.clone(), 1e-5, 3.0);
    let measured = by_subspace(&structure, 0)?;
    let Structure { stiffness, experiment, truth, .. } = structure;
    let model = Model { stiffness, experiment, parameter, truth: truth.nominal, band_hz, step_hz, dofs };
    let mut bytes = 0;
    for file in example.files_of(&model, &frequency_hz, &measured.measured)? {
        fs::write(folder.join(&file.path), &file.bytes)?;
        bytes += file.bytes.len();
    }
    Ok((bytes, measured.truncation + measured.roundoff))
}

fn table(costs: &[Cost]) -> Table {
    let stages = ["load", "subspace", "solutions", "selection", "figures"];
    let mut heading = vec!["N", "files (MB)", "wall (s)"];
    heading.extend(stages);
    heading.extend(["peak (MB)", "factorisations", "solves", "vectors", "ok", "worst", "measurement"]);
    let mut table = Table::new(heading);
    for cost in costs {
        let Cost { dofs, bytes, measurement, seconds, peak, summary } = cost;
        let number = |path: &str| summary.pointer(path).and_then(Value::as_f64).unwrap_or(f64::NAN);
        let mut row = vec![dofs.to_string(), format!("{:.0}", *bytes as f64 / 1e6), format!("{seconds:.1}")];
        row.extend(stages.map(|stage| format!("{:.1}", number(&format!("/seconds/{stage}")))));
        row.push(peak.map_or("–".to_owned(), |peak| format!("{:.0}", peak as f64 / 1e6)));
        row.extend(
            ["factorisations", "solves", "subspace_size"]
                .map(|of| number(&format!("/counts/{of}")).to_string()),
        );
        row.push(number("/status/ok").to_string());
        row.push(format!("{:.1e}", number("/unknowns/0/reference/deviation/max_ok")));
        row.push(format!("{measurement:.1e}"));
        table.push(row);
    }
    let dofs: Vec<f64> = costs.iter().map(|cost| cost.dofs as f64).collect();
    let power = |of: &dyn Fn(&Cost) -> f64| {
        let values: Vec<f64> = costs.iter().map(of).collect();
        format!("{:.2}", exponent(&dofs, &values))
    };
    let mut last =
        vec!["∝ N to the".to_owned(), power(&|cost| cost.bytes as f64), power(&|cost| cost.seconds)];
    last.extend(
        stages.map(|stage| power(&|cost| cost.summary["seconds"][stage].as_f64().unwrap_or(f64::NAN))),
    );
    last.push(power(&|cost| cost.peak.unwrap_or(0) as f64));
    table.push(last);
    table
}
