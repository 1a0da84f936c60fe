//! One reduced model of a band, shared by diagnostics and identification.

use super::band;
use super::context::Context;
use super::options::Options;
use super::problem::Problem;
use super::problem_error::ProblemError;
use super::several;
use crate::response::Work;
use crate::subspace::{KeptSubspace, Subspace};
use std::ptr;

/// One reduced model of a band (B-3), for [`diagnose_on`](crate::diagnostics::diagnose_on) and
/// [`identify_on`](super::identify_on): whoever needs it first trains it over the box of all unknowns, and the next one
/// trains it further where answers need that. Of another problem it begins again. What it was trained to may be kept for other runs ([`ReducedBand::kept`]).
#[derive(Debug, Default)]
pub struct ReducedBand<'a> {
    /// What it was trained for.
    problem: Option<&'a Problem<'a>>,
    pub(super) subspace: Option<Subspace<'a>>,
}

impl<'a> ReducedBand<'a> {
    /// All work of size N of its training so far.
    pub fn work(&self) -> Work {
        self.subspace.as_ref().map_or(Work::default(), Subspace::work)
    }

    /// On a reduced model that was kept, trained further where the box of the problem is not within one that it was trained in.
    ///
    /// # Errors
    /// [`ProblemError::Reduced`] where it is the reduced model of another model; options that do not belong to the problem.
    pub fn of_kept(
        kept: &KeptSubspace,
        problem: &'a Problem<'a>,
        options: &Options,
        context: Context<'_>,
    ) -> Result<Self, ProblemError> {
        let subspace = Subspace::of_kept(kept, problem.model(), problem.experiment())?;
        let mut reduced = Self { problem: Some(problem), subspace: None };
        reduced.train(Some(subspace), problem, options, context)?;
        Ok(reduced)
    }

    /// What serves other runs with the same matrices, load and sensors; `None` where nothing was trained.
    pub fn kept(&self) -> Option<KeptSubspace> {
        self.subspace.as_ref().map(Subspace::kept)
    }

    /// Trains over the box of the problem, where that was not done yet. The values of the FRFs are not used, only their frequencies.
    ///
    /// # Errors
    /// [`ProblemError`] for options that do not belong to the problem.
    pub fn train_for(
        &mut self,
        problem: &'a Problem<'a>,
        options: &Options,
        context: Context<'_>,
    ) -> Result<(), ProblemError> {
        self.trained(problem, options, context).map(drop)
    }

    /// The subspace, trained where it is not there yet; `None` where no real stand-in for D can be factorised.
    pub(crate) fn trained(
        &mut self,
        problem: &'a Problem<'a>,
        options: &Options,
        context: Context<'_>,
    ) -> Result<Option<&Subspace<'a>>, ProblemError> {
        self.begin(problem);
        if self.subspace.is_none() {
            self.train(None, problem, options, context)?;
        }
        Ok(self.subspace.as_ref())
    }

    fn train(
        &mut self,
        kept: Option<Subspace<'a>>,
        problem: &'a Problem<'a>,
        options: &Options,
        context: Context<'_>,
    ) -> Result<(), ProblemError> {
        problem.check_options(options)?;
        let trained = match problem.single() {
            Some((_, parameter)) => {
                let band = problem.band(0, parameter);
                let at = band.model.at_all(band.frequency_hz, std::slice::from_ref(parameter))?;
                band::train(kept, &band, &at, options, context)
            }
            None => several::train(kept, problem, context)?,
        };
        self.subspace = trained.ok();
        Ok(())
    }

    /// Forgets the model of another problem.
    pub(super) fn begin(&mut self, problem: &'a Problem<'a>) {
        if !self.problem.is_some_and(|before| ptr::eq(before, problem)) {
            *self = Self { problem: Some(problem), subspace: None };
        }
    }
}
