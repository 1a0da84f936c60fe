//! Several unknowns beside `scipy.optimize.least_squares` on direct solves: the same answer, and what it costs.
//!
//! `scipy [NX] [FREQUENCIES] [LARGE]`: a sandwich of NX × NX/8 elements in plan (default 16), so many frequencies (default 24); its core's law, its skins' modulus and its core's density are
//! found by both. Then LARGE (default 160: 50 000 degrees of freedom, 0: none) is found by frfit, and one direct solve of SciPy's there times as many as it took for the small one
//! says what it would take. Needs a Python with SciPy (FRFIT_PYTHON, or python3).
#![allow(clippy::print_stdout, clippy::print_stderr)] // tables are what a benchmark is for

use frfit::c64;
use frfit::frequency::{linear_hz, omega_rad_s};
use frfit::identify::{Identification, Unknown, Variation};
use frfit::laws::LawKind;
use frfit::material::Law;
use frfit_bench::measurement::{by_subspace, direct};
use frfit_bench::{Structure, Table, machine};
use frfit_examples::{matrix, sandwich};
use serde_json::{Value, json};
use std::error::Error;
use std::path::Path;
use std::process::Command;

/// Nominal over true values: near enough for a search that has one start and no model of the misfit's valleys.
const CORE: f64 = 1.2;
const SKINS: f64 = 1.1;
const DENSITY: f64 = 0.9;

const PROGRAM: &str = include_str!("least_squares.py");

/// What both find: E₀, E₁ (iω_r)^α's modulus, α of the core; E′, η of the skins; ρ of the core.
type Numbers = [f64; 6];

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let mut next = |usual| arguments.next().map_or(Ok(usual), |given| given.parse::<usize>());
    let (nx, frequencies, large) = (next(16)?, next(24)?, next(160)?);
    println!("Several unknowns beside scipy.optimize.least_squares on direct solves\n{}", machine());
    let small = Case::new(nx, frequencies, direct)?;
    let ours = small.ours()?;
    println!(
        "sandwich, N = {}, {frequencies} frequencies, 2 sensors, one thread\n",
        small.structure.stiffness.dim()
    );
    let mut answers = Table::new(["", "E0", "|E1 (iω)^α|", "α", "skins E'", "skins η", "core ρ"]);
    let mut costs = Table::new(["", "factorisations", "solves", "CPU (s)", "ratio", "farthest number off"]);
    let answer = |label: &str, numbers: &Numbers| -> Vec<String> {
        std::iter::once(label.to_owned()).chain(numbers.map(|value| format!("{value:.8e}"))).collect()
    };
    answers.push(answer("truth", &small.truth));
    answers.push(answer("frfit", &ours.found));
    let work = ours.outcome.search.work;
    costs.push([
        "frfit".to_owned(),
        work.factorisations.to_string(),
        work.solves.to_string(),
        format!("{:.2}", ours.seconds),
        String::new(),
        format!("{:.1e}", farthest(&ours.found, &small.truth)),
    ]);
    let mut counts = Vec::new();
    for (label, what) in [("least_squares", "differences"), ("least_squares, exact slopes", "slopes")] {
        let theirs = small.theirs(what)?;
        let (count, seconds) = (number(&theirs, "factorisations")?, number(&theirs, "seconds")?);
        let theta: Vec<f64> = serde_json::from_value(theirs["theta"].clone())?;
        let found =
            [theta[0].exp(), theta[1].exp(), logistic(theta[2]), theta[3].exp(), theta[4], theta[5].exp()];
        answers.push(answer(label, &found));
        costs.push([
            label.to_owned(),
            count.to_string(),
            String::new(),
            format!("{seconds:.2}"),
            format!("{:.0}", seconds / ours.seconds),
            format!("{:.1e}", farthest(&found, &small.truth)),
        ]);
        counts.push((label, count));
    }
    println!("{answers}\n{costs}");
    if large > 0 {
        let large = Case::new(large, frequencies, |structure| Ok(by_subspace(structure, 0)?.measured))?;
        let ours = large.ours()?;
        let one = number(&large.theirs("solve")?, "seconds")?;
        println!(
            "sandwich, N = {}: frfit {:.1} s CPU ({} factorisations, {} solves), farthest number {:.1e} off; SciPy {one:.1} s for one factorisation with its solve",
            large.structure.stiffness.dim(),
            ours.seconds,
            ours.outcome.search.work.factorisations,
            ours.outcome.search.work.solves,
            farthest(&ours.found, &large.truth),
        );
        for (label, count) in counts {
            let seconds = one * count;
            println!("{label}: {count} of them are {seconds:.0} s, ratio {:.0}", seconds / ours.seconds);
        }
    }
    Ok(())
}

struct Case {
    structure: Structure,
    unknowns: Vec<Unknown>,
    truth: Numbers,
}

struct Ours {
    outcome: Identification,
    found: Numbers,
    seconds: f64,
}

impl Case {
    fn new(
        nx: usize,
        frequencies: usize,
        measure: impl Fn(&Structure) -> Result<Vec<Vec<c64>>, Box<dyn Error>>,
    ) -> Result<Self, Box<dyn Error>> {
        let model = sandwich(nx, nx / 8, 2)?;
        let [first, last] = model.band_hz;
        let mut structure = Structure::of(model, linear_hz(first, last, frequencies), 1e-5, 3.0);
        structure.measured = measure(&structure)?;
        let (core, core_law) =
            structure.unknowns("core", CORE, Variation::law(LawKind::Fractional), false)?;
        let (skins, skins_law) = structure.unknowns("skins", SKINS, Variation::Constant, false)?;
        let (density, density_law) = structure.unknowns("core-mass", DENSITY, Variation::Constant, true)?;
        let truth = numbers(&structure, [&core_law, &skins_law, &density_law])?;
        Ok(Self { structure, unknowns: vec![core, skins, density], truth })
    }

    fn ours(&self) -> Result<Ours, Box<dyn Error>> {
        let (outcome, seconds) = self.structure.identify(&self.unknowns)?;
        let law = |j: usize| outcome.constants.iter().find(|one| one.unknowns == j).map(|one| &one.law);
        let laws = [law(0), law(1), law(2)].map(|law| law.ok_or("an unknown of the band is missing"));
        let [core, skins, density] = laws;
        let found = numbers(&self.structure, [core?, skins?, density?])?;
        Ok(Ours { outcome, found, seconds })
    }

    /// What the program prints.
    fn theirs(&self, what: &str) -> Result<Value, Box<dyn Error>> {
        let folder = tempfile::tempdir()?;
        for term in self.structure.stiffness.terms() {
            let name = format!("{}.mtx", term.name);
            std::fs::write(folder.path().join(&name), matrix(term, &name)?)?;
        }
        std::fs::write(folder.path().join("task.json"), self.task()?.to_string())?;
        python(folder.path(), what)
    }

    fn task(&self) -> Result<Value, Box<dyn Error>> {
        let pair = |v: &c64| json!([v.re, v.im]);
        let pairs = |row: &Vec<c64>| row.iter().map(pair).collect::<Value>();
        let experiment = &self.structure.experiment;
        let sensors = (0..experiment.sensors.len()).map(|m| pairs(&experiment.unit_force(m)));
        let stiffness = &self.structure.stiffness;
        let skins_mass = &stiffness.terms()[stiffness.find("skins-mass")?].factor;
        let skins_density = skins_mass.at(self.structure.frequency_hz[0])?.re;
        let nominal: Vec<&Law> = self.unknowns.iter().map(|one| &one.nominal).collect();
        let [e0, e1, alpha, storage, eta, density] =
            numbers(&self.structure, [nominal[0], nominal[1], nominal[2]])?;
        Ok(json!({
            "frequency_hz": self.structure.frequency_hz,
            "measured": self.structure.measured.iter().map(pairs).collect::<Value>(),
            "load": pairs(&experiment.load),
            "sensors": sensors.collect::<Value>(),
            "skins_density": skins_density,
            "start": [e0.ln(), e1.ln(), (alpha / (1.0 - alpha)).ln(), storage.ln(), eta, density.ln()],
        }))
    }
}

fn python(folder: &Path, what: &str) -> Result<Value, Box<dyn Error>> {
    let python = std::env::var("FRFIT_PYTHON").unwrap_or_else(|_| "python3".into());
    // one thread, as ours
    let output = Command::new(&python)
        .args(["-c", PROGRAM])
        .arg(folder)
        .arg(what)
        .env("OPENBLAS_NUM_THREADS", "1")
        .output()
        .map_err(|error| format!("{python} (set FRFIT_PYTHON to a Python with SciPy): {error}"))?;
    if !output.status.success() {
        return Err(String::from_utf8_lossy(&output.stderr).into());
    }
    Ok(serde_json::from_slice(&output.stdout)?)
}

/// The laws' numbers as both sides count them: the fractional part at the middle of the band.
fn numbers(structure: &Structure, [core, skins, density]: [&Law; 3]) -> Result<Numbers, Box<dyn Error>> {
    let Law::Fractional { e0, e1, alpha } = core else { return Err("the core's law is fractional".into()) };
    let middle = structure.frequency_hz[structure.frequency_hz.len() / 2];
    let (skins, density) = (skins.at(middle)?, density.at(middle)?);
    Ok([*e0, e1 * omega_rad_s(middle).powf(*alpha), *alpha, skins.re, skins.im / skins.re, density.re])
}

fn logistic(t: f64) -> f64 {
    1.0 / (1.0 + (-t).exp())
}

fn farthest(found: &Numbers, truth: &Numbers) -> f64 {
    found.iter().zip(truth).map(|(found, truth)| (found / truth - 1.0).abs()).fold(0.0, f64::max)
}

fn number(of: &Value, name: &str) -> Result<f64, Box<dyn Error>> {
    of[name].as_f64().ok_or_else(|| format!("the program printed no {name}: {of}").into())
}
