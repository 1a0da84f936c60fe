//! What the sensors measure: receptances with the true factor, without noise.

use crate::{Structure, in_pool};
use frfit::c64;
use frfit::for_each::map;
use frfit::identify::relative_error;
use frfit::material::OutsideTable;
use frfit::model::{Experiment, ModelAt};
use frfit::response::{FullModel, Response};
use frfit::subspace::{Assessment, Point, Subspace, TrainOptions};
use frfit_linalg::solve::Breakdown;
use rayon::prelude::*;
use std::error::Error;

/// By a direct solve of the full model at each frequency.
///
/// # Errors
/// Where a system cannot be solved, or the law does not reach a frequency.
pub fn direct(structure: &Structure) -> Result<Vec<Vec<c64>>, Box<dyn Error>> {
    let at = expanded(structure)?;
    let solve = |at: &ModelAt<'_>| solve(at, &structure.experiment);
    Ok(in_pool(THREADS, || at.par_iter().map(solve).collect::<Result<Vec<_>, Breakdown>>())??)
}

/// By a subspace, where so many direct solves are too dear.
#[derive(Debug)]
pub struct BySubspace {
    /// Receptance, `[frequency][sensor]`.
    pub measured: Vec<Vec<c64>>,
    /// Largest estimated error of any sensor for what the vectors lack, relative to its response, or on an antiresonance to p ∂x/∂p.
    pub truncation: f64,
    /// The same for roundoff.
    pub roundoff: f64,
    /// Largest error at those frequencies where direct solves checked it, relative over the sensors; `None` where none did.
    pub checked: Option<f64>,
    /// Vectors.
    pub size: usize,
}

/// Threads of what is not timed.
const THREADS: usize = 2;

/// Frequencies of the training at most.
const TRAINING: usize = 1000;

/// Errors to train to, one after the other, the last as far as roundoff lets it: each training looks at all frequencies again.
const TOLERANCES: [f64; 3] = [1e-6, 1e-9, 1e-11];

/// By a subspace of its own, with the truth as nominal value and trained at up to a thousand of the very frequencies as far as roundoff lets it; checked
/// by so many direct solves.
///
/// # Errors
/// Where a system cannot be solved, or the law does not reach a frequency.
pub fn by_subspace(structure: &Structure, checks: usize) -> Result<BySubspace, Box<dyn Error>> {
    let (at, experiment) = (expanded(structure)?, &structure.experiment);
    let n = at.len();
    let point = |i: usize| Point { at: at[i].clone(), correction: c64::default() };
    let count = TRAINING.min(n);
    let points: Vec<Point<'_>> = (0..count).map(|k| point(k * (n - 1) / (count - 1).max(1))).collect();
    let train = || {
        let mut subspace = Subspace::new(experiment, &at[n - 1])?;
        let for_each = |n: usize, each: &(dyn Fn(usize) + Sync)| (0..n).into_par_iter().for_each(each);
        for tolerance in TOLERANCES {
            subspace.train(&points, &TrainOptions::default().with_tolerance(tolerance), &for_each)?;
        }
        let small = subspace.projection();
        let assessed = map(&for_each, n, |i| small.assess(&at[i], c64::default()));
        Ok::<_, Breakdown>((assessed.into_iter().collect::<Result<Vec<Assessment>, _>>()?, subspace.size()))
    };
    let (assessed, size) = in_pool(THREADS, train)??;
    let largest = |error: fn(&Assessment, usize) -> f64| {
        let relative = |(assessed, at): (&Assessment, &ModelAt<'_>)| {
            let slope = |m: usize| (at.parameters[0].nominal * assessed.slope[m]).norm();
            let size = |m: usize| assessed.response[m].norm().max(slope(m));
            (0..assessed.response.len()).map(|m| error(assessed, m) / size(m)).fold(0.0, f64::max)
        };
        assessed.iter().zip(&at).map(relative).fold(0.0, f64::max)
    };
    let (truncation, roundoff) = (largest(|a, m| a.truncation[m]), largest(|a, m| a.roundoff[m]));
    let check = |i: usize| Ok(relative_error(&solve(&at[i], experiment)?, &assessed[i].response));
    let errors = (0..checks).map(|k| check((2 * k + 1) * n / (2 * checks)));
    let errors: Vec<f64> = errors.collect::<Result<_, Breakdown>>()?;
    let checked = errors.into_iter().reduce(f64::max);
    let measured = assessed.into_iter().map(|assessed| assessed.response).collect();
    Ok(BySubspace { measured, truncation, roundoff, checked, size })
}

/// The true model at every frequency.
fn expanded(structure: &Structure) -> Result<Vec<ModelAt<'_>>, OutsideTable> {
    let truth = std::slice::from_ref(&structure.truth);
    structure.frequency_hz.iter().map(|&f| structure.stiffness.at(f, truth)).collect()
}

/// Receptances at the nominal values.
fn solve(at: &ModelAt<'_>, experiment: &Experiment) -> Result<Vec<c64>, Breakdown> {
    FullModel::new(at.clone(), experiment)?.respond_nominal()
}
