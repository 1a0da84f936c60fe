//! A structure whose factor is known, measured without noise, and identified from a nominal one that is off.

use crate::{Score, Stages};
use cpu_time::ProcessTime;
use frfit::c64;
use frfit::for_each::{ForEach, sequential};
use frfit::identify::{
    Context, Dependence, Frfs, Identification, Noise, Options, Problem, ProblemError, Unknown, Variation,
    identify,
};
use frfit::material::{Law, OutsideTable, Table};
use frfit::model::{DynamicStiffness, Experiment, Parameter};
use frfit::roots::Bounds;
use frfit_examples::Model;
use rayon::prelude::*;
use std::error::Error;
use std::time::Instant;

/// What is known of a structure.
#[derive(Debug)]
pub struct Structure {
    /// D(ω).
    pub stiffness: DynamicStiffness,
    /// Load and sensors.
    pub experiment: Experiment,
    /// The unknown factor, with its true law.
    pub truth: Parameter,
    /// Frequencies, ascending.
    pub frequency_hz: Vec<f64>,
    /// Receptance with the true law, `[frequency][sensor]`.
    pub measured: Vec<Vec<c64>>,
    /// Largest relative error of a factor that counts as right.
    pub tolerance: f64,
    /// Upper bound of the loss factor.
    pub loss_factor: f64,
}

/// An identification to be done.
#[derive(Debug)]
pub struct Task<'a> {
    structure: &'a Structure,
    experiment: Experiment,
    /// (1 + δ) times the truth.
    nominal: Parameter,
    /// Indices of the structure's frequencies.
    picked: Vec<usize>,
}

/// What a run cost, and what it found.
#[derive(Debug)]
pub struct Run {
    /// The outcome.
    pub found: Identification,
    /// Wall-clock seconds.
    pub wall: f64,
    /// CPU seconds of all threads.
    pub cpu: f64,
    /// CPU seconds by stage.
    pub stages: Stages,
    /// How much of it is right.
    pub score: Score,
}

impl Structure {
    /// An example with its own truth at other frequencies, not measured yet.
    pub fn of(model: Model, frequency_hz: Vec<f64>, tolerance: f64, loss_factor: f64) -> Self {
        Self {
            truth: Parameter { nominal: model.truth, ..model.parameter },
            stiffness: model.stiffness,
            experiment: model.experiment,
            frequency_hz,
            measured: Vec::new(),
            tolerance,
            loss_factor,
        }
    }

    /// The task with the first so many sensors and the nominal factor (1 + δ) times the true one.
    ///
    /// # Errors
    /// [`OutsideTable`] where the true law does not reach a frequency.
    pub fn task(&self, sensors: usize, delta: f64) -> Result<Task<'_>, Box<dyn Error>> {
        let mut experiment = self.experiment.clone();
        experiment.sensors.truncate(sensors);
        let at = |&f: &f64| Ok((1.0 + delta) * self.truth.nominal.at(f)?);
        let values: Vec<c64> = self.frequency_hz.iter().map(at).collect::<Result<_, OutsideTable>>()?;
        let nominal = Law::Table(Table::new(self.frequency_hz.clone(), values)?);
        let nominal = Parameter { nominal, ..self.truth.clone() };
        Ok(Task { structure: self, experiment, nominal, picked: (0..self.frequency_hz.len()).collect() })
    }

    /// One of several unknowns, the factor of a term, with a multiple of its true law as nominal one; and the true law.
    ///
    /// # Errors
    /// Where there is no such term.
    pub fn unknowns(
        &self,
        name: &str,
        off: f64,
        varies: Variation,
        real: bool,
    ) -> Result<(Unknown, Law), Box<dyn Error>> {
        let term = self.stiffness.find(name)?;
        let is_unknown = self.truth.members.iter().any(|member| member.term == term);
        let truth = if is_unknown { &self.truth.nominal } else { &self.stiffness.terms()[term].factor };
        let unknowns = Unknown {
            name: name.to_owned(),
            dependence: Dependence::Factor(vec![term]),
            nominal: truth.scaled(off),
            varies,
            real,
            bounds: Bounds::default(),
        };
        Ok((unknowns, truth.clone()))
    }

    /// Identifies unknowns on one thread: what came out, and CPU seconds.
    ///
    /// # Errors
    /// [`ProblemError`] where the unknowns do not belong to the structure.
    pub fn identify(&self, unknowns: &[Unknown]) -> Result<(Identification, f64), ProblemError> {
        let frfs =
            Frfs { frequency_hz: &self.frequency_hz, receptance: &self.measured, noise: Noise::Unknown };
        let problem = Problem::new(&self.stiffness, &self.experiment, unknowns, &[], frfs)?;
        let start = ProcessTime::now();
        let context = Context { for_each: &sequential, progress: &|_, _, _| {} };
        let found = identify(&problem, &Options::default(), context)?;
        Ok((found, start.elapsed().as_secs_f64()))
    }

    /// Storage from a fifth to five times the truth in the middle of the band: wide enough for a nominal that is three times off.
    fn bounds(&self) -> Result<Bounds, OutsideTable> {
        let (first, last) = (self.frequency_hz[0], self.frequency_hz[self.frequency_hz.len() - 1]);
        let storage = self.truth.nominal.at(0.5 * (first + last))?.re;
        let loss_factor = Some([0.0, self.loss_factor]);
        Ok(Bounds { storage: Some([0.2 * storage, 5.0 * storage]), loss_factor })
    }
}

impl Task<'_> {
    /// The same at so many of its frequencies, the middles of equal stretches; at all where there are no more.
    pub fn sample(self, count: usize) -> Self {
        let (n, count) = (self.picked.len(), count.min(self.picked.len()));
        let picked = (0..count).map(|k| self.picked[(2 * k + 1) * n / (2 * count)]).collect();
        Self { picked, ..self }
    }

    /// Number of frequencies.
    pub fn frequencies(&self) -> usize {
        self.picked.len()
    }

    /// Identifies with the structure's bounds, on so many threads.
    ///
    /// # Errors
    /// Where the true law does not reach a frequency, or there are no threads to be had.
    pub fn run(&self, options: &Options, threads: usize) -> Result<Run, Box<dyn Error>> {
        let frequency_hz: Vec<f64> = self.picked.iter().map(|&i| self.structure.frequency_hz[i]).collect();
        let sensors = self.experiment.sensors.len();
        let measured: Vec<Vec<c64>> =
            self.picked.iter().map(|&i| self.structure.measured[i][..sensors].to_vec()).collect();
        let unknowns = [Unknown { bounds: self.structure.bounds()?, ..Unknown::of_parameter(&self.nominal) }];
        let frfs = Frfs { frequency_hz: &frequency_hz, receptance: &measured, noise: Noise::Unknown };
        let problem = Problem::new(&self.structure.stiffness, &self.experiment, &unknowns, &[], frfs)?;
        let clock = Stages::clock();
        let run = |for_each: ForEach<'_>| {
            let (start, wall) = (ProcessTime::now(), Instant::now());
            let progress = |stage, _, _| clock.enter(stage);
            let found = identify(&problem, options, Context { for_each, progress: &progress })?;
            Ok::<_, ProblemError>((found, wall.elapsed().as_secs_f64(), start.elapsed().as_secs_f64()))
        };
        let (found, wall, cpu) = match threads {
            1 => run(&sequential)?,
            // As the workflow does it.
            _ => in_pool(threads, || run(&|n, each| (0..n).into_par_iter().for_each(each)))??,
        };
        let truth = |f| self.structure.truth.nominal.at(f);
        let score = Score::of(&found.lines, truth, self.structure.tolerance)?;
        Ok(Run { found, wall, cpu, stages: clock.stop(), score })
    }
}

/// Does something in a pool of so many threads.
///
/// # Errors
/// Where the system does not give them.
pub fn in_pool<T: Send>(
    threads: usize,
    work: impl FnOnce() -> T + Send,
) -> Result<T, rayon::ThreadPoolBuildError> {
    Ok(rayon::ThreadPoolBuilder::new().num_threads(threads).build()?.install(work))
}
