//! Factors by ranks of MUMPS beside those of this process: time, memory, inertia, solutions.
//!
//! `engine [DOFS] [RANKS] [KILLS]`: a sandwich in bricks of about so many degrees of freedom (default 50 000), on 1 to RANKS ranks
//! (default 3); then so many jobs (default 0) of which a rank is killed at a random moment.
//!
//! One thread in this process, one a rank. The order of elimination is the same. The ranks run the program that `FRFIT_MUMPS` names, or
//! `frfit-mumps`.
#![allow(clippy::print_stdout)] // tables are what a benchmark is for

use frfit::c64;
use frfit::model::DynamicStiffness;
use frfit_bench::{Table, machine, memory, panel, panel_dofs};
use frfit_engine::{Launch, Mumps, RankUsage};
use frfit_linalg::solve::{Analysis, Breakdown, CheckedFactor, Engine, HasSymbolic, Multifrontal};
use std::error::Error;
use std::process::Command;
use std::time::{Duration, Instant};

/// Columns of a block of right-hand sides.
const COLUMNS: usize = 8;

/// What one engine took.
struct Cost {
    name: String,
    factor_wall: f64,
    factor_cpu: f64,
    solve_wall: f64,
    peak_mb: f64,
    negative: Option<usize>,
    difference: f64,
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut numbers = std::env::args().skip(1).map(|text| text.parse::<usize>());
    let mut number = |usual: usize| numbers.next().unwrap_or(Ok(usual));
    let (dofs, ranks, kills) = (number(50_000)?, number(3)?, number(0)?);
    let nx = (8..).step_by(8).find(|&nx| panel_dofs(nx) >= dofs).unwrap_or(160);
    let model = panel(nx)?.stiffness;
    let frequency_hz = 500.0;
    let complex = model.at(frequency_hz, &[])?.assemble(&[]);
    let real: Vec<f64> = complex.iter().map(|value| value.re).collect();
    println!("Ranks of MUMPS beside this process\n{}", machine());
    println!(
        "{} degrees of freedom, {COLUMNS} right-hand sides, Re D and D at {frequency_hz} Hz\n",
        model.dim()
    );
    let mut table = Table::new([
        "engine",
        "matrix",
        "factor wall (s)",
        "factor CPU (s)",
        "solve (s)",
        "peak (MB)",
        "negative",
        "difference",
    ]);
    let mut own = (None, None);
    for count in 0..=ranks {
        let engine = (count > 0).then(|| Mumps::start(&launch(count))).transpose()?;
        let costs = [
            of(&model, engine.as_ref(), &real, &mut own.0, |factor| Some(factor.negative_eigenvalues()))?,
            of(&model, engine.as_ref(), &complex, &mut own.1, |_| None)?,
        ];
        for (cost, matrix) in costs.iter().zip(["real", "complex"]) {
            table.push([
                cost.name.clone(),
                matrix.to_owned(),
                format!("{:.2}", cost.factor_wall),
                format!("{:.2}", cost.factor_cpu),
                format!("{:.2}", cost.solve_wall),
                format!("{:.0}", cost.peak_mb),
                cost.negative.map_or("–".into(), |count| count.to_string()),
                format!("{:.1e}", cost.difference),
            ]);
        }
    }
    println!("{table}\npeak: of the largest rank so far; of this process what its factor added");
    killed(&model, &real, ranks, kills)
}

fn launch(ranks: usize) -> Launch {
    let mut launch = Launch::by(&format!("mpirun --oversubscribe --allow-run-as-root -n {ranks}"));
    if let Some(program) = std::env::var_os("FRFIT_MUMPS") {
        launch.program = program.into();
    }
    launch
}

/// One engine on one matrix, and its solutions beside the first engine's; `negative` counts eigenvalues where the matrix has a sign.
fn of<T: HasSymbolic + Into<c64>>(
    model: &DynamicStiffness,
    engine: Option<&Mumps>,
    values: &[T],
    own: &mut Option<Vec<T>>,
    negative: impl Fn(&CheckedFactor<T>) -> Option<usize>,
) -> Result<Cost, Box<dyn Error>> {
    let pattern = model.analysis().pattern();
    let analysis: Analysis = match engine {
        Some(mumps) => mumps.analyse(pattern),
        None => Multifrontal.analyse(pattern),
    };
    analysis.factor_memory::<T>()?; // analysed
    let used = || -> Result<Vec<RankUsage>, Breakdown> { engine.map_or(Ok(Vec::new()), Mumps::usage) };
    memory::forget_peak();
    let resident = memory::resident().unwrap_or(0);
    let before = used()?;
    let start = Instant::now();
    let cpu = cpu_time::ThreadTime::now();
    let factor = analysis.factor(values)?;
    let factor_wall = start.elapsed().as_secs_f64();
    let of_process = cpu.elapsed().as_secs_f64();
    let added = memory::peak().unwrap_or(0).saturating_sub(resident) as f64;
    let after = used()?;
    let seconds = |ranks: &[RankUsage]| ranks.iter().map(|rank| rank.cpu_s).sum::<f64>();
    // Some numbers of the matrix: right-hand sides of its size and of its kind.
    let mut x: Vec<T> = (0..COLUMNS * model.dim()).map(|k| values[(k * 7919) % values.len()]).collect();
    let start = Instant::now();
    factor.solve(&mut x)?;
    let solve_wall = start.elapsed().as_secs_f64();
    let first = own.get_or_insert_with(|| x.clone());
    let norm = |value: T| -> f64 { Into::<c64>::into(value).norm() };
    let size = first.iter().map(|&value| norm(value)).fold(0.0, f64::max);
    let difference = first.iter().zip(&x).map(|(&a, &b)| (a.into() - b.into()).norm()).fold(0.0, f64::max);
    Ok(Cost {
        name: analysis.engine().to_owned(),
        factor_wall,
        factor_cpu: if engine.is_some() { seconds(&after) - seconds(&before) } else { of_process },
        solve_wall,
        peak_mb: after.iter().map(|rank| rank.peak_bytes).reduce(f64::max).unwrap_or(added) / 1e6,
        negative: negative(&factor),
        difference: difference / size,
    })
}

/// Jobs of which the last rank is killed: how long until frfit knows.
fn killed(
    model: &DynamicStiffness,
    values: &[f64],
    ranks: usize,
    kills: usize,
) -> Result<(), Box<dyn Error>> {
    let mut longest = Duration::ZERO;
    for k in 0..kills {
        let mumps = Mumps::start(&launch(ranks))?;
        let analysis = mumps.analyse(model.analysis().pattern());
        // A golden ratio's multiples fall everywhere within three seconds.
        let delay = Duration::from_secs_f64(3.0 * (0.618_034 * (k + 1) as f64).fract());
        let killer = std::thread::spawn(move || {
            std::thread::sleep(delay);
            kill_last_rank();
            Instant::now()
        });
        let outcome = loop {
            let solved = analysis.factor(values).and_then(|factor| factor.solve(&mut vec![1.0; model.dim()]));
            if let Err(breakdown) = solved {
                break breakdown;
            }
        };
        let known = Instant::now();
        let killed = killer.join().map_err(|_| "the rank was not killed")?;
        let late = known.saturating_duration_since(killed);
        longest = longest.max(late);
        println!(
            "killed after {:.2} s, known {:.2} s later: {outcome:.60}",
            delay.as_secs_f64(),
            late.as_secs_f64()
        );
    }
    if kills > 0 {
        println!("{kills} ranks killed, the longest time until it is known: {:.2} s", longest.as_secs_f64());
    }
    Ok(())
}

/// The youngest process below the launcher.
fn kill_last_rank() {
    let children = |of: u32| -> Vec<u32> {
        let output = Command::new("ps").args(["-o", "pid=", "--ppid", &of.to_string()]).output();
        let text =
            output.map(|output| String::from_utf8_lossy(&output.stdout).into_owned()).unwrap_or_default();
        text.split_whitespace().filter_map(|pid| pid.parse().ok()).collect()
    };
    let last = children(std::process::id()).into_iter().flat_map(children).max();
    if let Some(rank) = last {
        let _ = Command::new("kill").args(["-9", &rank.to_string()]).status();
    }
}
