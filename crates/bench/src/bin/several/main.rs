//! What more unknowns cost: the modulus of a sandwich's core at every frequency, beside it the skins' modulus, and beside both a density.
//!
//! `several [NX] [FREQUENCIES]`: a sandwich of NX × NX/8 elements in plan (default 160: 50 000 degrees of freedom), so many frequencies (default 300). The measurement is
//! made with a subspace of its own, checked by direct solves.
#![allow(clippy::print_stdout, clippy::print_stderr)] // tables are what a benchmark is for

use frfit::c64;
use frfit::frequency::linear_hz;
use frfit::identify::{Identification, Options, Status, Unknown, Variation};
use frfit::laws::LawKind;
use frfit::material::Law;
use frfit_bench::measurement::{BySubspace, by_subspace};
use frfit_bench::{Structure, Table, machine};
use frfit_examples::sandwich;
use std::error::Error;

/// The nominal core is 1 + δ times the true one, skins and density are less far off.
const DELTA: f64 = 0.5;
const SKINS: f64 = 1.15;
const DENSITY: f64 = 0.85;

/// A value this near to the truth is right.
const RIGHT: f64 = 1e-5;

/// Direct solves that check the measurement.
const CHECKS: usize = 2;

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let nx: usize = arguments.next().map_or(Ok(160), |nx| nx.parse())?;
    let frequencies: usize = arguments.next().map_or(Ok(300), |count| count.parse())?;
    println!("Cost of several unknowns\n{}", machine());
    let model = sandwich(nx, nx / 8, 2)?;
    let [first, last] = model.band_hz;
    let mut structure = Structure::of(model, linear_hz(first, last, frequencies), RIGHT, 3.0);
    let BySubspace { measured, checked, .. } = by_subspace(&structure, CHECKS)?;
    structure.measured = measured;
    println!(
        "sandwich, N = {}, {} sensors, {frequencies} frequencies, one thread; measurement {:.1e} off at {CHECKS} direct solves\n",
        structure.stiffness.dim(),
        structure.experiment.sensors.len(),
        checked.unwrap_or(f64::NAN)
    );

    let core = |varies| structure.unknowns("core", 1.0 + DELTA, varies, false);
    let skins = structure.unknowns("skins", SKINS, Variation::Constant, false)?;
    let density = structure.unknowns("core-mass", DENSITY, Variation::Constant, true)?;
    let freely = core(Variation::PerFrequency)?;
    let by_law = core(Variation::law(LawKind::Fractional))?;
    let sets = [
        ("core E(ω)", vec![freely.clone()]),
        ("core E(ω), skins E", vec![freely.clone(), skins.clone()]),
        ("core E(ω), skins E, core ρ", vec![freely, skins.clone(), density.clone()]),
        ("core by law", vec![by_law.clone()]),
        ("core by law, skins E, core ρ", vec![by_law, skins, density]),
    ];

    let mut table = Table::new([
        "unknown",
        "CPU (s)",
        "times",
        "factorisations",
        "solves",
        "vectors",
        "right",
        "wrong and ok",
    ]);
    eprintln!("one unknown, as [identify] …");
    let usual = structure.task(structure.experiment.sensors.len(), DELTA)?.run(&Options::default(), 1)?;
    table.push([
        "core E(ω), alone".to_owned(),
        format!("{:.1}", usual.cpu),
        "1.00".to_owned(),
        usual.found.search.work.factorisations.to_string(),
        usual.found.search.work.solves.to_string(),
        usual.found.search.reduced_size.map_or("–".to_owned(), |size| size.to_string()),
        usual.score.to_string(),
        String::new(),
    ]);
    for (label, set) in sets {
        eprintln!("{label} …");
        let (unknowns, truths): (Vec<Unknown>, Vec<Law>) = set.into_iter().unzip();
        let (outcome, cpu) = structure.identify(&unknowns)?;
        let [right, wrong] = score(&outcome, &truths)?;
        table.push([
            label.to_owned(),
            format!("{cpu:.1}"),
            format!("{:.2}", cpu / usual.cpu),
            outcome.search.work.factorisations.to_string(),
            outcome.search.work.solves.to_string(),
            outcome.search.reduced_size.unwrap_or(0).to_string(),
            format!("{:.3}", right as f64 / outcome.lines.len() as f64),
            wrong.to_string(),
        ]);
    }
    println!("{table}");
    Ok(())
}

/// Frequencies at which every unknown is right, and those at which one is not but all are called `ok`.
fn score(outcome: &Identification, truths: &[Law]) -> Result<[usize; 2], Box<dyn Error>> {
    let mut counts = [0, 0];
    for at in &outcome.lines {
        let exact: Vec<c64> = truths.iter().map(|law| law.at(at.frequency_hz)).collect::<Result<_, _>>()?;
        let near = |(found, exact): (&frfit::identify::LineValue, &c64)| {
            found.value.is_some_and(|value| (value - exact).norm() <= RIGHT * exact.norm())
        };
        let right = at.values.iter().zip(&exact).all(near);
        counts[0] += usize::from(right);
        counts[1] += usize::from(!right && at.status == Status::Ok);
    }
    Ok(counts)
}
