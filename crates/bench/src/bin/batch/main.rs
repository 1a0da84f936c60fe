//! Many specimens of one structure: `frfit batch` with a kept reduced model, beside one `frfit identify`.
//!
//! `batch [DOFS [SPECIMENS [TEMPERATURES [LINES]]]]` (default: 50 000, 40, 5, 1000). The sandwich of the example; each temperature changes the core's modulus and each specimen
//! has one of its own (5 %), with 1 % of noise of its own on two sensors. The same plan is done at once and in four shares, and the results compared byte by byte.
#![allow(clippy::print_stdout, clippy::print_stderr)] // tables are what a benchmark is for

use frfit::c64;
use frfit::for_each::map;
use frfit::subspace::{Point, Subspace, TrainOptions};
use frfit_bench::wrong_models::dice::Dice;
use frfit_bench::{Table, machine, memory, panel, panel_dofs};
use frfit_examples::Model;
use rayon::prelude::*;
use std::error::Error;
use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};
use std::{fs, thread};

type Failure = Box<dyn Error>;

/// A step that the seven digits of a UFF file hold.
const STEP_HZ: f64 = 0.98;

/// Factor of the modulus from the coldest to the warmest.
const COLDEST: f64 = 1.3;
const WARMEST: f64 = 0.75;

/// Scatter of the modulus from specimen to specimen, and noise over response.
const SCATTER: f64 = 0.05;
const NOISE: f64 = 0.01;

/// How often the memory of the program is looked at.
const LOOK: Duration = Duration::from_millis(20);

fn main() -> Result<(), Failure> {
    let mut numbers = std::env::args().skip(1).map(|text| text.parse::<usize>());
    let mut next = |usual: usize| numbers.next().unwrap_or(Ok(usual));
    let (dofs, specimens, temperatures, lines) = (next(50_000)?, next(40)?, next(5)?, next(1000)?);
    let program = program()?;
    // An eighth of the length across, four elements through the thickness.
    let nx = (8..).step_by(8).find(|&nx| panel_dofs(nx) >= dofs * 9 / 10).unwrap_or(160);
    let model = panel(nx)?;
    println!("Many specimens of one structure: frfit batch with a kept reduced model\n{}", machine());
    println!(
        "{} degrees of freedom, {specimens} specimens × {temperatures} temperatures, {lines} lines, two sensors, 1 % noise\n",
        model.stiffness.dim()
    );
    let folder = tempfile::tempdir()?;
    let at = folder.path();
    write(&model, at, [specimens, temperatures, lines])?;
    let run = |arguments: &[&str]| timed(&program, at, arguments);
    let mut table = Table::new(["command", "wall (s)", "over one run", "a run (ms)", "peak (MB)"]);
    let runs = specimens * temperatures;
    let (one, peak) = run(&["identify", "case.toml", "--out", "one"])?;
    let mut row = |name: &str, seconds: f64, count: usize, peak: Option<usize>| {
        table.push(vec![
            name.to_owned(),
            format!("{seconds:.2}"),
            format!("{:.2}", seconds / one),
            format!("{:.1}", 1e3 * seconds / count as f64),
            peak.map_or("–".to_owned(), |peak| format!("{:.0}", peak as f64 / 1e6)),
        ]);
    };
    row("identify, one run with its figures and report", one, 1, peak);
    let (seconds, peak) = run(&["train", "case.toml", "--out", "model.frfit"])?;
    row("train", seconds, 1, peak);
    let batch = ["batch", "plan.csv", "--reduced", "model.frfit", "--out"];
    let (seconds, peak) = run(&[&batch[..], &["whole"]].concat())?;
    row(&format!("batch, {runs} runs"), seconds, runs, peak);
    let (mut seconds, mut peak) = (0.0, None);
    for shard in 1..=4 {
        let (more, its) = run(&[&batch[..], &["shares", "--shard", &format!("{shard}/4")]].concat())?;
        (seconds, peak) = (seconds + more, its.max(peak));
    }
    row(&format!("batch in four shares, {runs} runs"), seconds, runs, peak);
    let (seconds, _) = run(&[&batch[..], &["whole"]].concat())?;
    row("batch again, nothing missing", seconds, runs, None);
    println!("{table}");
    let (same, ok) = compared(at)?;
    println!(
        "{same} of {runs} runs have the same tables in both, byte by byte; {ok} of {} lines are ok",
        runs * lines
    );
    Ok(())
}

/// The program as it is built for release.
fn program() -> Result<PathBuf, Failure> {
    let built =
        Command::new("cargo").args(["build", "--quiet", "--release", "--package", "frfit-cli"]).status()?;
    let path = std::env::current_exe()?.with_file_name("frfit");
    if !built.success() || !path.is_file() {
        return Err(format!("no program at {}", path.display()).into());
    }
    Ok(path)
}

/// Wall seconds and largest resident memory of the program.
fn timed(program: &Path, folder: &Path, arguments: &[&str]) -> Result<(f64, Option<usize>), Failure> {
    eprintln!("frfit {} …", arguments.join(" "));
    let start = Instant::now();
    let mut child =
        Command::new(program).args(arguments).current_dir(folder).stdout(Stdio::null()).spawn()?;
    let mut peak = None;
    let status = loop {
        peak = memory::peak_of(child.id()).max(peak);
        match child.try_wait()? {
            Some(status) => break status,
            None => thread::sleep(LOOK),
        }
    };
    if !status.success() {
        return Err(format!("frfit {}: {status}", arguments.join(" ")).into());
    }
    Ok((start.elapsed().as_secs_f64(), peak))
}

/// The case, a measurement of each specimen at each temperature, and the plan.
fn write(model: &Model, folder: &Path, [specimens, temperatures, lines]: [usize; 3]) -> Result<(), Failure> {
    let frequency_hz: Vec<f64> = (0..lines).map(|k| model.band_hz[0] + STEP_HZ * k as f64).collect();
    let example = frfit_examples::list().iter().find(|example| example.name == "sandwich");
    let example = example.ok_or("no example is named sandwich")?;
    let truth = frfit::model::Parameter { nominal: model.truth.clone(), ..model.parameter.clone() };
    let at: Vec<_> = frequency_hz
        .iter()
        .map(|&f| model.stiffness.at(f, std::slice::from_ref(&truth)))
        .collect::<Result<_, _>>()?;
    let point = |i: usize, ratio: f64| Point {
        at: at[i].clone(),
        correction: (ratio - 1.0) * at[i].parameters[0].nominal,
    };
    let drawn = (0..lines).step_by(lines.div_ceil(60));
    let ratios = [0.5, 0.7, 1.0, 1.3, 1.8];
    let points: Vec<Point<'_>> = drawn.flat_map(|i| ratios.map(|ratio| point(i, ratio))).collect();
    let for_each = |n: usize, each: &(dyn Fn(usize) + Sync)| (0..n).into_par_iter().for_each(each);
    let mut subspace = Subspace::new(&model.experiment, &at[lines - 1])?;
    // A thousandth of the noise.
    subspace.train(&points, &TrainOptions::default().with_tolerance(1e-5 * NOISE), &for_each)?;
    let measured = |ratio: f64, dice: &mut Dice| -> Result<Vec<Vec<c64>>, Failure> {
        let exact =
            map(&for_each, lines, |i| subspace.projection().assess(&at[i], point(i, ratio).correction));
        let exact = exact.into_iter().map(|assessed| assessed.map(|assessed| assessed.response));
        let mut rows = exact.collect::<Result<Vec<Vec<c64>>, _>>()?;
        for x in rows.iter_mut().flatten() {
            *x *= 1.0 + NOISE * dice.circular();
        }
        Ok(rows)
    };
    for file in example.files_of(model, &frequency_hz, &measured(1.0, &mut Dice::new(0, 0))?)? {
        fs::write(folder.join(&file.path), &file.bytes)?;
    }
    let mut plan = String::from("case,specimen,temperature,measurement.1.file,measurement.2.file\n");
    for temperature in 0..temperatures {
        let part = temperature as f64 / (temperatures - 1).max(1) as f64;
        let warm = COLDEST * (WARMEST / COLDEST).powf(part);
        for specimen in 0..specimens {
            // The same specimen at each temperature.
            let own = 1.0 + SCATTER * 2f64.sqrt() * Dice::new(1, specimen as u64).circular().re;
            let mut noise = Dice::new(2, (specimen * temperatures + temperature) as u64);
            let file = example.frf_of(model, &frequency_hz, &measured(warm * own, &mut noise)?)?;
            let name = format!("{specimen}-{temperature}.uff");
            fs::write(folder.join(&name), &file.bytes)?;
            writeln!(plan, "case.toml,{specimen},{temperature},{name},{name}")?;
        }
    }
    fs::write(folder.join("plan.csv"), plan)?;
    Ok(())
}

/// How many runs have the same tables in both stores, and how many lines are ok.
fn compared(folder: &Path) -> Result<(usize, usize), Failure> {
    let (mut same, mut ok) = (0, 0);
    for entry in fs::read_dir(folder.join("whole/runs"))? {
        let run = entry?;
        let other = folder.join("shares/runs").join(run.file_name());
        let table = fs::read(run.path().join("identified.csv"))?;
        same += usize::from(fs::read(other.join("identified.csv"))? == table);
        ok += String::from_utf8_lossy(&table).split([',', '\n']).filter(|cell| *cell == "ok").count();
    }
    Ok((same, ok))
}
