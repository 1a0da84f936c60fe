//! Sparse direct solvers beside each other on dynamic stiffness matrices: time, memory, backward error, in one run.
//!
//! Solvers run in turn on each matrix, so that what disturbs one disturbs all; figures are medians over the rounds.
//!
//! PARDISO is that of Intel's MKL, loaded from the folder that FRFIT_MKL names (`python3 -m venv V && V/bin/pip install mkl`,
//! then FRFIT_MKL=V/lib). MUMPS is compiled with `cc` against Debian's libmumps-seq-dev, and takes MKL's BLAS where there
//! is one. What is missing is left out and said. All solvers but MUMPS run in this process.

mod case;
mod ceiling;
mod faer_solvers;
mod ldlt;
mod mkl;
mod mumps;
mod options;
mod report;
mod rivrs;
mod round;
mod solver;
mod symbolic;

use case::{Number, RECIPES, Structure};
use frfit_linalg::c64;
use options::Options;
use report::{Entry, Rating};
use round::Round;
use solver::{Installed, Solver};
use std::error::Error;
use std::io::Write;
use std::process::ExitCode;

/// Seconds of a factorisation from which on a solver runs [`FEW`] round only, but for the two that are compared by medians.
const PATIENCE: f64 = 10.0;

/// Rounds of another solver that is slow.
const FEW: usize = 1;

fn main() -> ExitCode {
    let options = match Options::parse(std::env::args().skip(1)) {
        Ok(options) => options,
        Err(words) => {
            eprintln!("{words}");
            return ExitCode::from(2);
        }
    };
    match compare(&options) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}

/// One solver with some threads, and what it did so far.
struct Contender<T> {
    name: &'static str,
    solver: Solver,
    threads: usize,
    rounds: Vec<Round<T>>,
    failure: Option<String>,
}

fn compare(options: &Options) -> Result<(), Box<dyn Error>> {
    let program = std::env::current_exe()?;
    let folder = program.ancestors().nth(2).ok_or("no build folder")?.join("solvers");
    let installed = Installed::find(&folder);
    println!("Sparse direct solvers\n{}", frfit_bench::machine());
    match &installed.mkl {
        Ok(mkl) => println!("{}", mkl.version),
        Err(why) => println!("without PARDISO: {why}"),
    }
    match &installed.mumps {
        Ok(mumps) => println!("MUMPS on {}", mumps.blas()),
        Err(why) => println!("without MUMPS: {why}"),
    }
    println!(
        "\nSeconds of one thread are CPU seconds, of several those on the clock; medians over the rounds (where a factor of \
         others than multifrontal and\nPARDISO takes more than {PATIENCE} s: {FEW} round); least: of all rounds, on the clock. GF/s: operations of L D Lᵀ under nested \
         dissection, Σ c² (complex: four\ntimes), over the factor's seconds; of dense: over the speed of a large product. \
         solve 8: eight right-hand sides at once. L: entries;\nGF own: operations; memory: of what is kept of analysis and factor; all three by its own \
         report. peak: growth of resident memory. error: ‖b − Ax‖∞ / (‖A‖∞ ‖x‖∞ + ‖b‖∞),\nof the worst right-hand side (of MUMPS: the first), unrefined unless remarked. \
         negative: pivots, that is modes below ω.\n"
    );
    let mut csv = options.csv.as_ref().map(std::fs::File::create).transpose()?;
    if let Some(csv) = &mut csv {
        writeln!(csv, "{}", report::CSV_HEADING)?;
    }
    let mut record = |line: String| csv.as_mut().map_or(Ok(()), |csv| writeln!(csv, "{line}"));
    let wanted = |numbers: &str| options.numbers.iter().any(|name| name == numbers);
    let real = if wanted("real") { ceilings::<f64>(options, &installed) } else { Vec::new() };
    let complex = if wanted("complex") { ceilings::<c64>(options, &installed) } else { Vec::new() };
    for recipe in RECIPES.iter().filter(|recipe| options.matrices.iter().any(|name| name == recipe.name)) {
        eprintln!("{} …", recipe.name);
        let structure = recipe.make()?;
        if wanted("complex") {
            contest::<c64>(options, &installed, recipe.name, &structure, &complex, &mut record)?;
        }
        if wanted("real") {
            contest::<f64>(options, &installed, recipe.name, &structure, &real, &mut record)?;
        }
    }
    Ok(())
}

/// Prints the speed of dense products, and returns the one to rate by.
fn ceilings<T: Number>(options: &Options, installed: &Installed) -> Vec<(usize, f64)> {
    let of = |&threads: &usize| {
        let [mkl, faer] = ceiling::gflops::<T>(installed.mkl.as_ref().ok(), threads);
        let words = |speed: Option<f64>| speed.map_or("–".to_owned(), |speed| format!("{speed:.1}"));
        println!(
            "dense product, {}, threads {threads}: MKL {}, faer {} GF/s",
            T::NAME,
            words(mkl),
            words(faer)
        );
        (threads, mkl.or(faer).unwrap_or(f64::NAN))
    };
    options.threads.iter().map(of).collect()
}

fn contest<T: Number>(
    options: &Options,
    installed: &Installed,
    matrix: &str,
    structure: &Structure,
    ceilings: &[(usize, f64)],
    record: &mut impl FnMut(String) -> std::io::Result<()>,
) -> Result<(), Box<dyn Error>> {
    let case = structure.case::<T>();
    let full = symbolic::Full::new(&case.pattern);
    let (flops, entries) = full.cost(&full.dissection()?);
    drop(full);
    let rating = Rating { gflop: T::FLOPS * flops / 1e9, ceilings: ceilings.to_vec() };
    let mut contenders: Vec<Contender<T>> = Vec::new();
    for &(name, solver) in
        options.solvers.iter().filter(|(_, solver)| solver.takes(&case) && solver.installed(installed))
    {
        for &threads in &options.threads {
            contenders.push(Contender { name, solver, threads, rounds: Vec::new(), failure: None });
        }
    }
    // Any solver's factor and what it works in, but for those that take many times as much.
    let room = (1.5 * entries) as usize * size_of::<T>();
    let begun = ticks();
    for round in 0..options.rounds {
        for contender in &mut contenders {
            let other = !matches!(contender.solver, Solver::Ldlt | Solver::Pardiso);
            let slow = other && contender.rounds.first().is_some_and(|first| first.factor.wall > PATIENCE);
            if contender.failure.is_some() || (slow && round >= FEW) {
                continue;
            }
            eprintln!("  {} {}, round {}: {}", matrix, T::NAME, round + 1, contender.name);
            match contender.solver.round(installed, &case, contender.threads, room) {
                Ok(round) => contender.rounds.push(round),
                Err(failure) => contender.failure = Some(failure),
            }
        }
    }
    println!(
        "\n{matrix}, {}: n = {}, {:.2} M entries in the lower triangle; L {:.2} M entries, {:.2} GF; the host took {:.1} % of the processors",
        T::NAME,
        case.dim(),
        case.pattern.stored() as f64 / 1e6,
        entries / 1e6,
        rating.gflop,
        share_taken(begun, ticks())
    );
    let mut table = Vec::new();
    for Contender { name, threads, rounds, failure, .. } in &contenders {
        if let Some(failure) = failure {
            println!("{name}, threads {threads}: {failure}");
        }
        if let Some(last) = rounds.last() {
            let entry = Entry::new(name, *threads, rounds, case.backward_error(&last.solution));
            record(report::csv_line(matrix, T::NAME, case.dim(), &entry, &rating))?;
            table.push(entry);
        }
    }
    println!("{}", report::table(&table, &rating));
    Ok(())
}

/// Ticks of all processors so far, and those that the machine's host took of them; zeros where the system does not say.
fn ticks() -> [f64; 2] {
    let text = std::fs::read_to_string("/proc/stat").unwrap_or_default();
    // user, nice, system, idle, iowait, irq, softirq, steal; guests are among the users.
    let of_all = text.lines().next().into_iter().flat_map(str::split_whitespace).skip(1).take(8);
    let ticks: Vec<f64> = of_all.filter_map(|ticks| ticks.parse().ok()).collect();
    [ticks.iter().sum(), ticks.get(7).copied().unwrap_or_default()]
}

/// What the host took in between, in per cent; NaN where the system does not say.
fn share_taken(begun: [f64; 2], ended: [f64; 2]) -> f64 {
    100.0 * (ended[1] - begun[1]) / (ended[0] - begun[0])
}
