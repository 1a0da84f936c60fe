//! The computation.

use super::Candidates;
use super::ranking::{Ranking, ranking};
use crate::job_error::JobError;
use crate::load::Case;
use crate::run::in_parallel;
use frfit::c64;
use frfit::model::{Experiment, Sensor};
use frfit::response::Work;
use frfit::sensitivity::{
    Change, Ranked, Resolved, SensitivityBand, StandardDeviations, Variable, WorstBar, change_points,
    next_sensors, with_each_added, worst_bar,
};
use frfit::subspace::{ChangeOptions, ChangePoint, Trained};
use frfit_linalg::dense::NoConvergence;
use frfit_linalg::solve::Breakdown;
use std::time::Instant;

/// Noise of the response where it is not known: that of a careful hammer test between resonances.
const ASSUMED_NOISE: f64 = 0.01;

/// Estimated error of response and derivatives at all rows: the true error may be ten times that, and candidates are compared to one per cent.
const CANDIDATE_TOL: f64 = 1e-3;

/// Candidates that are looked at again as sensors …
const SHORTLIST: usize = 5;

/// … each at least so much worse than the one before: those in between are as good as that, for candidates are compared to no better (and a smaller gain moves no sensor).
const AS_GOOD: f64 = 1.01;

/// What is asked for.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct SensitivityOptions {
    /// √E|δx|² over |x| of all sensors; `None`: as the files say, or 1 %.
    pub noise: Option<f64>,
    /// Where the next sensor may go.
    pub candidates: Candidates,
    /// Bytes of memory that may be used. `None`: what the system says is available.
    pub memory_bytes: Option<u64>,
}

/// What the noise was taken from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum NoiseFrom {
    /// This part of the response, as asked for.
    Given(f64),
    /// The files of the measurements.
    Files,
    /// This part of the response, for want of better.
    Assumed(f64),
}

/// ∂ln x_m/∂ln p with its estimated error; `None` where there is no answer.
pub type Sensitivity = Option<(c64, f64)>;

/// Where the next sensor should go.
#[derive(Debug, Clone, PartialEq)]
pub struct NextSensor {
    /// How many degrees of freedom were compared.
    pub compared: usize,
    /// The worst error bar as it is.
    pub before: WorstBar,
    /// The best places, the best first.
    pub best: Vec<Place>,
    /// How good that subspace is.
    pub trained: Trained,
}

/// A place for a sensor.
#[derive(Debug, Clone, PartialEq)]
pub struct Place {
    /// Row, from 0.
    pub row: usize,
    /// The worst error bar with a sensor really added there, to a subspace trained for it.
    pub after: WorstBar,
    /// Rows that were found to be as good within a hundredth, as neighbours and mirror images are.
    pub as_good: Vec<usize>,
}

/// What came out.
#[derive(Debug, Clone, PartialEq)]
pub struct SensitivityRun {
    /// What is differentiated by.
    pub variables: Vec<Variable>,
    /// The frequencies.
    pub frequency_hz: Vec<f64>,
    /// `[frequency][variable][sensor]`.
    pub values: Vec<Vec<Vec<Sensitivity>>>,
    /// Variables by how much the response depends on them.
    pub ranking: Vec<Ranking>,
    /// What the noise was taken from.
    pub noise: NoiseFrom,
    /// What all sensors together identify; `None` where the singular values of their Jacobian were not found.
    pub resolved: Option<Resolved>,
    /// Where the next sensor should go; `None` where that was not asked, or nothing can be said.
    pub next: Option<NextSensor>,
    /// Real factorisations and solves.
    pub work: Work,
    /// Vectors of the subspace.
    pub subspace_size: usize,
    /// How its training ended.
    pub trained: Trained,
    /// Wall-clock seconds.
    pub seconds: f64,
}

/// Sensitivities of a case, on all cores; the result does not depend on their number. The inner error says why nothing could be solved.
///
/// # Errors
/// [`JobError`] for a table of a factor that does not reach a frequency, or a candidate that the model has not.
pub fn sensitivities(
    case: &Case,
    options: &SensitivityOptions,
) -> Result<Result<SensitivityRun, Breakdown>, JobError> {
    let start = Instant::now();
    let candidates = options.candidates.rows(case)?;
    let wanted = case.sensitivities.as_ref();
    let matrices = wanted.map(|wanted| wanted.matrices.clone()).unwrap_or_default();
    let mut variables = Variable::of_matrices(&case.model, &matrices, &case.respond_hz)?;
    variables.extend(
        wanted
            .iter()
            .flat_map(|wanted| &wanted.dimensions)
            .map(|(name, powers)| Variable { name: name.clone(), change: Change::Powers(powers.clone()) }),
    );
    let unknown = wanted.iter().flat_map(|wanted| &wanted.unknown_scale).enumerate();
    for (sensor, _) in unknown.filter(|(_, unknown)| **unknown) {
        let name = format!("scale at {}", case.sensors[sensor].label);
        variables.push(Variable { name, change: Change::Scale(sensor) });
    }
    let points = change_points(&case.model, &variables, &case.respond_hz)?;
    Ok(computed(case, options, &variables, &points, &candidates)
        .map(|run| SensitivityRun { seconds: start.elapsed().as_secs_f64(), ..run }))
}

fn computed(
    case: &Case,
    options: &SensitivityOptions,
    variables: &[Variable],
    points: &[ChangePoint<'_>],
    candidates: &[usize],
) -> Result<SensitivityRun, Breakdown> {
    let train = ChangeOptions::default().with_everywhere((!candidates.is_empty()).then_some(CANDIDATE_TOL));
    let band = match case.subspace() {
        Some(subspace) => SensitivityBand::of_subspace(subspace, variables, points, &train, &in_parallel)?,
        None => SensitivityBand::new(&case.experiment, variables, points, &train, &in_parallel)?,
    };
    let measured = case.sensitivities.as_ref().and_then(|wanted| wanted.std.clone());
    let (noise, deviations) = match (options.noise, measured) {
        (Some(noise), _) => (NoiseFrom::Given(noise), band.proportional(noise)),
        (None, Some(std)) => (NoiseFrom::Files, std),
        (None, None) => (NoiseFrom::Assumed(ASSUMED_NOISE), band.proportional(ASSUMED_NOISE)),
    };
    let sensors: Vec<usize> = (0..case.sensors.len()).collect();
    let resolved = band.resolved(&deviations, &sensors).ok();
    let mut work = band.work();
    let mut next = None;
    if let (Some(resolved), false) = (&resolved, candidates.is_empty()) {
        let ranked = next_sensors(&band, &deviations, candidates, &in_parallel);
        let short = shortlist(&ranked);
        let rows: Vec<usize> = short.iter().map(|(row, _)| *row).collect();
        let experiment = with_sensors(&case.experiment, &rows);
        let again =
            SensitivityBand::new(&experiment, variables, points, &ChangeOptions::default(), &in_parallel)?;
        work += again.work();
        next = checked(&again, &deviations, sensors.len(), short).ok().map(|best| NextSensor {
            compared: candidates.len(),
            before: worst_bar(resolved),
            best,
            trained: again.trained(),
        });
    }
    let value = |i: usize, p: usize| sensors.iter().map(|&m| band.logarithmic(i, p, m)).collect::<Vec<_>>();
    Ok(SensitivityRun {
        values: (0..points.len()).map(|i| (0..variables.len()).map(|p| value(i, p)).collect()).collect(),
        ranking: ranking(&band, sensors.len()),
        variables: variables.to_vec(),
        frequency_hz: band.frequency_hz().to_vec(),
        noise,
        resolved,
        next,
        work,
        subspace_size: band.size(),
        trained: band.trained(),
        seconds: 0.0,
    })
}

fn with_sensors(experiment: &Experiment, rows: &[usize]) -> Experiment {
    let mut experiment = experiment.clone();
    experiment.sensors.extend(rows.iter().map(|&row| Sensor { row, sign: 1.0 }));
    experiment
}

/// The best candidates, and for each those that are as good.
fn shortlist(ranked: &[Ranked]) -> Vec<(usize, Vec<usize>)> {
    let mut short: Vec<(Ranked, Vec<usize>)> = Vec::new();
    let bar = |ranked: &Ranked| ranked.after.worst.map_or(0.0, |worst| worst.std);
    for candidate in ranked {
        let full = short.len() == SHORTLIST;
        match short.last_mut() {
            Some((last, as_good))
                if candidate.after.unseen == last.after.unseen && bar(candidate) <= AS_GOOD * bar(last) =>
            {
                as_good.push(candidate.row);
            }
            _ if full => break,
            _ => short.push((*candidate, Vec::new())),
        }
    }
    short.into_iter().map(|(ranked, as_good)| (ranked.row, as_good)).collect()
}

/// The short list with each really added, the best first.
fn checked(
    again: &SensitivityBand<'_>,
    deviations: &StandardDeviations,
    present: usize,
    short: Vec<(usize, Vec<usize>)>,
) -> Result<Vec<Place>, NoConvergence> {
    let bars = with_each_added(again, deviations, present)?;
    let place = |((row, as_good), after)| Place { row, after, as_good };
    let mut best: Vec<Place> = short.into_iter().zip(bars).map(place).collect();
    best.sort_by(|a, b| a.after.total_cmp(&b.after));
    Ok(best)
}
