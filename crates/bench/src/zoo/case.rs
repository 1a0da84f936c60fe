//! A case: a model, its material, load and sensors, the band and what is said of the unknown.

use crate::data::{data, matrix};
use crate::wrong_models::Failure;
use crate::wrong_models::case::solve;
use crate::wrong_models::dice::Dice;
use crate::wrong_models::fault::Change;
use crate::wrong_models::natural::{elastic, undamped};
use crate::wrong_models::realised::{Realised, UNKNOWN};
use crate::wrong_models::structure::{Kind as Shape, Structure};
use cpu_time::ThreadTime;
use frfit::c64;
use frfit::for_each::sequential;
use frfit::frequency::linear_hz;
use frfit::identify::{Context, Frfs, Identification, Noise, Options, Problem, Unknown, identify};
use frfit::material::{Law, loss_factor};
use frfit::model::{DynamicStiffness, Experiment, Role, Sensor, Term};
use frfit::roots::Bounds;
use frfit_linalg::sparse::Triplets;
use std::fmt;

/// What kind of model.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// A rod of unequal elements with consistent masses.
    Rod,
    /// A beam in bending.
    Beam,
    /// A plate in bending.
    Plate,
    /// A plate or a beam of bricks.
    Bricks,
    /// Two known skins on an unknown core, in bricks.
    Sandwich,
    /// A beam on known springs.
    SprungBeam,
    /// Random springs between random masses, each to each, known and unknown ones.
    Springs,
    /// Matrices of the Harwell–Boeing collection.
    Published,
}

/// Stiffness and mass matrices of the data beside the project.
const PUBLISHED: [(&str, &str); 6] = [
    ("plate/bcsstk09.mtx", "plate/bcsstm09.mtx"),
    ("hb/bcsstk01.mtx", "hb/bcsstm01.mtx"),
    ("hb/bcsstk06.mtx", "hb/bcsstm06.mtx"),
    ("hb/bcsstk08.mtx", "hb/bcsstm08.mtx"),
    ("hb/bcsstk11.mtx", "hb/bcsstm11.mtx"),
    ("hb/bcsstk12.mtx", "hb/bcsstm12.mtx"),
];

impl Kind {
    /// Those that are made here.
    pub const MADE: [Self; 7] =
        [Self::Rod, Self::Beam, Self::Plate, Self::Bricks, Self::Sandwich, Self::SprungBeam, Self::Springs];

    /// That of a case: each in turn.
    pub fn of(index: u64) -> Self {
        Self::MADE[(index % Self::MADE.len() as u64) as usize]
    }
}

impl fmt::Display for Kind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Self::Rod => "rod",
            Self::Beam => "beam",
            Self::Plate => "plate",
            Self::Bricks => "bricks",
            Self::Sandwich => "sandwich",
            Self::SprungBeam => "sprung beam",
            Self::Springs => "springs",
            Self::Published => "published",
        })
    }
}

/// A case, measured.
#[derive(Debug)]
pub struct Case {
    /// Its number.
    pub index: u64,
    /// Of what.
    pub kind: Kind,
    /// The model, its unknown factor at the nominal value.
    pub model: DynamicStiffness,
    /// Load and sensors.
    pub experiment: Experiment,
    /// The true law of the unknown factor.
    pub truth: Law,
    /// Nominal over true factor.
    pub ratio: f64,
    /// Bounds of the storage part, if any.
    pub bounds: Option<[f64; 2]>,
    /// Frequencies of the lines.
    pub frequency_hz: Vec<f64>,
    /// Receptance with noise, `[frequency][sensor]`.
    pub measured: Vec<Vec<c64>>,
    /// Standard deviations of the noise, `[frequency][sensor]`.
    pub std: Vec<Vec<f64>>,
    /// Relative standard deviation of the factor that each line has at best: with noise by its size, without by roundoff.
    pub at_best: Vec<f64>,
    /// Noise over response.
    pub noise: f64,
    /// Whether the identification knows the standard deviations.
    pub noise_known: bool,
    /// Modes in the band.
    pub modes: usize,
}

/// Rows of a model at most.
const ROWS: usize = 5_000;

/// The part of a response that roundoff is at most.
const ROUNDOFF: f64 = 1e-11;

/// Step of ln E over which the true response is differenced.
const LOG_STEP: f64 = 1e-5;

impl Case {
    /// Draws a case of a kind and a seed, and measures it by direct solves at every line.
    ///
    /// # Errors
    /// Where a model cannot be made or solved: a fault of this benchmark.
    pub fn draw(kind: Kind, seed: u64, index: u64) -> Result<Self, Failure> {
        // The wrong models of a seed are other cases.
        let mut dice = Dice::new(seed, index).fork();
        let drawn = Drawn::new(kind, &mut dice)?;
        let (below, count) = (dice.pick(&[0, 0, 1, 3]), dice.count(2, 25));
        let natural = drawn.natural_hz(below + count + 8)?;
        let hz = |k: usize| natural.get(k.min(natural.len() - 1)).copied().unwrap_or(1.0);
        let (first, last) = match below {
            0 => (hz(0) * dice.between(0.1, 0.9), hz(count - 1)),
            below => (dice.between(hz(below - 1), hz(below)), hz(below + count - 1)),
        };
        let last = last.max(1.3 * first) * dice.between(1.0, 1.2);
        let frequency_hz = linear_hz(first, last, dice.log_between(50.0, 1200.0) as usize);
        let eta = dice.log_between(1e-5, 1.5);
        let truth = drawn.law((first * last).sqrt(), eta, &mut dice);
        let ratio = dice.log_between(0.33, 4.0);
        let sensors = dice.log_between(1.0, 21.0) as usize;
        let row = |dice: &mut Dice| Sensor { row: dice.pick(&drawn.rows), sign: 1.0 };
        let driven = row(&mut dice);
        let sensors: Vec<Sensor> = (0..sensors).map(|_| row(&mut dice)).collect();
        let experiment = Experiment::driven_at(drawn.model.dim(), driven, sensors);
        let at = |by: f64| solve(&with(&drawn.model, &truth.scaled(by))?, &experiment, &frequency_hz);
        let (exact, more) = (at(1.0)?, at(LOG_STEP.exp())?);
        let (noise, noise_known) = match dice.below(3) {
            0 => (0.0, false),
            _ => (dice.log_between(1e-3, 3e-2), dice.coin()),
        };
        let storages: Vec<f64> = frequency_hz.iter().map(|&f| truth.at(f).map_or(1.0, |e| e.re)).collect();
        let [low, high] = [f64::min, f64::max].map(|of| storages.iter().copied().reduce(of).unwrap_or(1.0));
        let bounds = [low / dice.log_between(1.1, 5.0), high * dice.log_between(1.1, 5.0)];
        let bounds = (dice.uniform() < 0.6).then_some(bounds);
        let at_best = exact.iter().zip(&more).map(|(x, more)| {
            let information = |(x, more): (&c64, &c64)| {
                let sigma = noise.max(ROUNDOFF) * x.norm();
                ((more - x) / (LOG_STEP * sigma)).norm_sqr()
            };
            x.iter().zip(more).map(information).sum::<f64>().powf(-0.5)
        });
        let mut of_noise = dice.fork();
        let mut noisy = |u: &c64| u + noise * u.norm() * of_noise.circular();
        let nominal = nominal(&truth, ratio, &mut dice);
        Ok(Self {
            index,
            kind,
            model: with(&drawn.model, &nominal)?,
            bounds,
            ratio,
            at_best: at_best.collect(),
            measured: exact.iter().map(|row| row.iter().map(&mut noisy).collect()).collect(),
            std: exact.iter().map(|row| row.iter().map(|u| noise * u.norm()).collect()).collect(),
            modes: natural.iter().filter(|hz| (first..last).contains(hz)).count(),
            experiment,
            truth,
            frequency_hz,
            noise,
            noise_known,
        })
    }

    /// Identifies it on this thread: what came out, and CPU seconds.
    ///
    /// # Errors
    /// [`frfit::identify::ProblemError`]: a fault of this benchmark.
    pub fn identify(&self) -> Result<(Identification, f64), Failure> {
        let bounds = Bounds { storage: self.bounds, ..Bounds::default() };
        let unknowns = [Unknown { bounds, ..Unknown::factor_of(&self.model, &[UNKNOWN])? }];
        let noise = if self.noise_known { Noise::Known(&self.std) } else { Noise::Unknown };
        let frfs = Frfs { frequency_hz: &self.frequency_hz, receptance: &self.measured, noise };
        let problem = Problem::new(&self.model, &self.experiment, &unknowns, &[], frfs)?;
        let start = ThreadTime::now();
        let context = Context { for_each: &sequential, progress: &|_, _, _| {} };
        let found = identify(&problem, &Options::default(), context)?;
        Ok((found, start.elapsed().as_secs_f64()))
    }

    /// The true loss factor in the middle of the band.
    pub fn middle_loss(&self) -> f64 {
        let middle = self.frequency_hz[self.frequency_hz.len() / 2];
        self.truth.at(middle).map_or(f64::NAN, loss_factor)
    }
}

/// The law with which the search begins: of another loss factor too where it is a constant.
fn nominal(truth: &Law, ratio: f64, dice: &mut Dice) -> Law {
    match truth {
        Law::Constant(value) => {
            let eta = loss_factor(*value) * dice.log_between(0.3, 3.0);
            Law::complex_modulus(ratio * value.re, eta)
        }
        _ => truth.scaled(ratio),
    }
}

/// A model with another law of its unknown factor.
fn with(model: &DynamicStiffness, law: &Law) -> Result<DynamicStiffness, Failure> {
    let terms = model.terms().iter().map(|term| match term.name.as_str() {
        UNKNOWN => Term { factor: law.clone(), ..term.clone() },
        _ => term.clone(),
    });
    Ok(DynamicStiffness::new(terms.collect())?)
}

/// A model, and where it may be driven and measured.
struct Drawn {
    model: DynamicStiffness,
    rows: Vec<usize>,
    structure: Option<Structure>,
}

impl Drawn {
    fn new(kind: Kind, dice: &mut Dice) -> Result<Self, Failure> {
        let (shape, bricks) = match kind {
            Kind::Rod => return Ok(Self::of(rod(dice)?)),
            Kind::Springs => return Ok(Self::of(springs(dice)?)),
            Kind::Published => return Ok(Self::of(published(dice)?)),
            Kind::Beam => (Shape::Beam, false),
            Kind::Plate => (Shape::Plate, false),
            Kind::Bricks => (dice.pick(&[Shape::Beam, Shape::Plate]), true),
            Kind::Sandwich => (Shape::Sandwich, false),
            Kind::SprungBeam => (Shape::SprungBeam, false),
        };
        let mut structure = Structure::draw(shape, bricks, dice);
        let storage = Law::complex_modulus(structure.storage, 0.0);
        let change = Change { bricks, ..Change::default() };
        loop {
            let realised = Realised::new(&structure, &storage, &change)?;
            if realised.model.dim() > ROWS {
                structure.set_mesh(structure.mesh[0] * 3 / 4);
                continue;
            }
            let rows = realised.stations().into_iter().map(|station| realised.row(station));
            let rows = rows.collect::<Result<_, _>>()?;
            return Ok(Self { rows, model: realised.model, structure: Some(structure) });
        }
    }

    fn of(model: DynamicStiffness) -> Self {
        Self { rows: (0..model.dim()).collect(), model, structure: None }
    }

    /// The lowest natural frequencies but those of rigid bodies.
    fn natural_hz(&self, count: usize) -> Result<Vec<f64>, Failure> {
        let found = undamped(&self.model, 1.0, count.min(self.model.dim()))?;
        Ok(elastic(&found).map(|(hz, _)| hz).collect())
    }

    fn law(&self, middle_hz: f64, eta: f64, dice: &mut Dice) -> Law {
        match &self.structure {
            Some(structure) if structure.kind == Shape::Sandwich => structure.draw_law(middle_hz, dice),
            Some(structure) => Law::complex_modulus(structure.storage, eta),
            None => Law::complex_modulus(1.0, eta),
        }
    }
}

fn term(name: &str, role: Role, matrix: Triplets, factor: c64) -> Term {
    Term { name: name.to_owned(), role, matrix: matrix.assemble(), factor: Law::Constant(factor) }
}

const ONE: c64 = c64::new(1.0, 0.0);

/// Free, or held at one end or both.
fn rod(dice: &mut Dice) -> Result<DynamicStiffness, Failure> {
    let n = dice.count(8, 120);
    let (mut k, mut m) = (Triplets::new(n), Triplets::new(n));
    for i in 0..n - 1 {
        let (stiffness, mass) = (dice.between(0.5, 2.0), 1e-6 * dice.between(0.5, 2.0));
        for (a, b, both) in [(i, i, 1.0), (i + 1, i + 1, 1.0), (i + 1, i, -1.0)] {
            k.add(a, b, both * stiffness);
            m.add(a, b, mass * if a == b { 1.0 / 3.0 } else { 1.0 / 6.0 });
        }
    }
    for end in [0, n - 1] {
        if dice.coin() {
            k.add(end, end, dice.between(0.5, 2.0));
        }
    }
    let terms = vec![term(UNKNOWN, Role::Stiffness, k, ONE), term("mass", Role::Mass, m, ONE)];
    Ok(DynamicStiffness::new(terms)?)
}

/// All of the stiffness is unknown.
fn published(dice: &mut Dice) -> Result<DynamicStiffness, Failure> {
    let (stiffness, mass) = dice.pick(&PUBLISHED);
    let term = |name: &str, role: Role, file: &str| -> Result<Term, Failure> {
        let matrix = matrix(&data().join(file))?;
        Ok(Term { name: name.to_owned(), role, matrix, factor: Law::Constant(ONE) })
    };
    let terms = vec![term(UNKNOWN, Role::Stiffness, stiffness)?, term("mass", Role::Mass, mass)?];
    Ok(DynamicStiffness::new(terms)?)
}

/// Each spring is known or unknown.
fn springs(dice: &mut Dice) -> Result<DynamicStiffness, Failure> {
    let n = dice.count(6, 60);
    let mut all = [Triplets::new(n), Triplets::new(n)];
    let mut mass = Triplets::new(n);
    let share = dice.between(0.3, 1.0);
    for i in 0..n {
        mass.add(i, i, 1e-6 * dice.log_between(0.2, 5.0));
        for j in 0..i {
            let stiffness = dice.log_between(1e-3, 1.0);
            let spring = &mut all[usize::from(dice.uniform() > share)];
            for (a, b, both) in [(i, i, 1.0), (j, j, 1.0), (i, j, -1.0)] {
                spring.add(a, b, both * stiffness);
            }
        }
        all[0].add(i, i, dice.log_between(1e-2, 1.0));
    }
    let [unknown, known] = all;
    let loss = c64::new(1.0, dice.log_between(1e-4, 0.1));
    let terms = vec![
        term(UNKNOWN, Role::Stiffness, unknown, ONE),
        term("known", Role::Stiffness, known, loss),
        term("mass", Role::Mass, mass, ONE),
    ];
    Ok(DynamicStiffness::new(terms)?)
}
