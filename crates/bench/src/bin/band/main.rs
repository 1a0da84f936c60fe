//! What a whole band costs: one subspace for all frequencies against the paper's series and Nelder–Mead on the full model.
//!
//! `band [NX] [SAMPLE]`: a sandwich of NX × NX/8 elements in plan (default 160: 50 000 degrees of freedom); series and search at so many of the
//! frequencies (default 3), extrapolated to all of them; 0 leaves them out.
//!
//! The measurement is made with a subspace of its own ([`frfit_bench::measurement::by_subspace`]), checked by direct solves.
#![allow(clippy::print_stdout, clippy::print_stderr)] // tables are what a benchmark is for

use frfit::frequency::{linear_hz, omega_rad_s};
use frfit::identify::{Method, Options, Selection};
use frfit::model::{DynamicStiffness, Role};
use frfit_bench::clock::{RUNS, median, seconds};
use frfit_bench::measurement::{BySubspace, by_subspace};
use frfit_bench::{Run, Structure, Table, machine};
use frfit_examples::sandwich;
use std::error::Error;

/// The nominal core is 1 + δ times the true one.
const DELTA: f64 = 0.5;

/// Frequencies of a band, and of one that is sampled ten times as densely.
const FREQUENCIES: usize = 1000;
const MANY: usize = 10_000;

/// Direct solves that check the measurement.
const CHECKS: usize = 2;

/// Iterations of Nelder–Mead.
const ITERATIONS: usize = 60;

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let nx: usize = arguments.next().map_or(Ok(160), |nx| nx.parse())?;
    let sample: usize = arguments.next().map_or(Ok(3), |sample| sample.parse())?;
    let structure = |frequencies| -> Result<Structure, Box<dyn Error>> {
        let model = sandwich(nx, nx / 8, 2)?;
        let [first, last] = model.band_hz;
        let mut structure = Structure::of(model, linear_hz(first, last, frequencies), 1e-5, 3.0);
        let BySubspace { measured, truncation, roundoff, checked, size } = by_subspace(&structure, CHECKS)?;
        structure.measured = measured;
        let checked = checked.unwrap_or(f64::NAN);
        println!(
            "measurement: {size} vectors; estimated truncation {truncation:.1e}, roundoff {roundoff:.1e}; {checked:.1e} at {CHECKS} direct solves"
        );
        Ok(structure)
    };
    println!("Cost of a band\n{}", machine());
    let (band, dense) = (structure(FREQUENCIES)?, structure(MANY)?);
    println!("sandwich, N = {}, {} sensors\n", band.stiffness.dim(), band.experiment.sensors.len());

    let sensors = band.experiment.sensors.len();
    let joint = Options::default();
    let run = |structure: &Structure, threads| {
        eprintln!("band, {} frequencies, {threads} threads …", structure.frequency_hz.len());
        structure.task(sensors, DELTA)?.run(&joint, threads)
    };
    let two = run(&band, 2)?;
    // In turn, so that what disturbs one disturbs all.
    let mut rounds: Vec<Round> = Vec::with_capacity(RUNS);
    for _ in 0..RUNS {
        rounds.push((run(&band, 1)?, run(&dense, 1)?, factorisations(&band)?));
    }
    let each = |what: &dyn Fn(&Round) -> f64| median(rounds.iter().map(what).collect());
    // What training costs does not depend on how many frequencies there are, and differs by more than all the rest from run to run.
    let after = |run: &Run| run.cpu - run.stages.subspace;
    let more = each(&|(one, many, _)| after(many) - after(one));
    let training = each(&|(one, many, _)| many.stages.subspace - one.stages.subspace);
    let [below, within, complex] = [0, 1, 2].map(|k| each(&|(_, _, factorisations)| factorisations[k]));
    rounds.sort_by(|a, b| a.0.cpu.total_cmp(&b.0.cpu));
    let (one, many, _) = &rounds[RUNS / 2];
    let sampled = |options: Options| -> Result<Option<Run>, Box<dyn Error>> {
        if sample == 0 {
            return Ok(None);
        }
        eprintln!("{}, {sample} frequencies …", options.method.name());
        band.task(sensors, DELTA)?.sample(sample).run(&options, 1).map(Some)
    };
    let series = sampled(Options::paper())?;
    let search = Options::default()
        .with_method(Method::NelderMead)
        .with_order(ITERATIONS)
        .with_selection(Selection::Smallest);
    let search = sampled(search)?;

    let heading = [
        "way",
        "frequencies",
        "threads",
        "wall (s)",
        "CPU (s)",
        "subspace",
        "solutions",
        "selection",
        "per band",
        "factorisations",
        "solves",
        "vectors",
        "right",
    ];
    let mut table = Table::new(heading);
    let mut add = |way: &str, threads: usize, frequencies: usize, run: &Run| {
        // What was sampled counts for the whole band.
        let share = frequencies as f64 / run.found.lines.len() as f64;
        let times = |seconds: f64| format!("{:.1}", share * seconds);
        // The full model has one stage only.
        let stage = |seconds: f64| run.found.search.reduced_size.map_or("–".to_owned(), |_| times(seconds));
        let stages = run.stages;
        let cost = share * run.cpu / one.cpu;
        let work = |count: usize| ((share * count as f64) as usize).to_string();
        table.push([
            way.to_owned(),
            frequencies.to_string(),
            threads.to_string(),
            times(run.wall),
            times(run.cpu),
            stage(stages.subspace),
            stage(stages.solutions),
            stage(stages.selection),
            format!("{cost:.2}"),
            work(run.found.search.work.factorisations),
            work(run.found.search.work.solves),
            run.found.search.reduced_size.map_or("–".to_owned(), |size| size.to_string()),
            run.score.to_string(),
        ]);
    };
    add("subspace, joint", 1, FREQUENCIES, one);
    add("subspace, joint", 2, FREQUENCIES, &two);
    add("subspace, joint", 1, MANY, many);
    for (way, run) in [("series n = 30".to_owned(), &series), (format!("Nelder–Mead {ITERATIONS}"), &search)]
    {
        if let Some(run) = run {
            add(&format!("{way}, from {sample}"), 1, FREQUENCIES, run);
        }
    }
    println!("{table}");
    println!("stages in CPU seconds; per band: CPU seconds over those of the first row");

    println!(
        "\none factorisation: real, below the band {below:.2} s; real, at its end {within:.2} s; complex {complex:.2} s"
    );
    println!(
        "{} more frequencies: {more:.2} s, {:.0} µs each: {:.1} real factorisations, {:.1} complex ones; training {training:+.2} s",
        MANY - FREQUENCIES,
        1e6 * more / (MANY - FREQUENCIES) as f64,
        more / below,
        more / complex
    );
    println!("medians of {RUNS} rounds in turn, on one thread");
    Ok(())
}

/// The band, the dense one, and [`factorisations`].
type Round = (Run, Run, [f64; 3]);

/// CPU seconds of one factorisation: of a stand-in that is positive definite, of one that is not, and of D.
fn factorisations(structure: &Structure) -> Result<[f64; 3], Box<dyn Error>> {
    let model: &DynamicStiffness = &structure.stiffness;
    let frequency_hz = structure.frequency_hz[structure.frequency_hz.len() - 1];
    let omega_squared = omega_rad_s(frequency_hz).powi(2);
    let real = |sigma: f64| {
        let mut values = vec![0.0; model.analysis().pattern().stored()];
        for term in model.terms() {
            let factor = term.factor.at(frequency_hz)?.re;
            let weight = if term.role == Role::Mass { sigma * factor } else { factor };
            term.matrix.accumulate_real_into(weight, &mut values);
        }
        // The first one also makes the symbolic analysis.
        model.analysis().factor(&values)?;
        Ok::<_, Box<dyn Error>>(seconds(|| model.analysis().factor(&values)))
    };
    let values =
        model.at(frequency_hz, std::slice::from_ref(&structure.truth))?.assemble(&[Default::default()]);
    model.analysis().factor(&values)?;
    Ok([real(0.01 * omega_squared)?, real(-omega_squared)?, seconds(|| model.analysis().factor(&values))])
}
