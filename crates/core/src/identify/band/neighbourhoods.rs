//! The subspace of a band: trained over the box in which the answer may be, then where answers were found.

use crate::c64;
use crate::for_each::{ForEach, map};
use crate::identify::context::{Context, Stage};
use crate::identify::measured::Band;
use crate::identify::options::Options;
use crate::identify::unknown::Unknown;
use crate::material::loss_factor;
use crate::model::ModelAt;
use crate::response::Work;
use crate::subspace::{Assessment, Corrected, Local, ModalErrors, Modes};
use crate::subspace::{Point, Projection, Subspace, TrainOptions};
use crate::thinned::thinned;
use frfit_linalg::solve::Breakdown;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Error over the box of frequencies and factors: enough to find every root, which is then looked at more closely.
pub(in crate::identify) const BOX_TOL: f64 = 1e-6;

/// Error at the answers. The factor is read from the response with a loss of some digits near its stationary points, and is to be right to 1e-6.
const ANSWER_TOL: f64 = 1e-9;

/// Error at the answers that were looked at, so that those between them are within what an answer's may be.
pub(in crate::identify) const TRAINED_TOL: f64 = 0.25 * ANSWER_TOL;

/// Frequencies of the training at most; neighbours share what they need.
pub(in crate::identify) const MAX_TRAINING_FREQUENCIES: usize = 60;

/// Neighbourhoods at most, and the least frequencies that are worth one.
pub(in crate::identify) const MAX_NEIGHBOURHOODS: usize = 24;
pub(in crate::identify) const MIN_NEIGHBOURHOOD_LINES: usize = 8;

/// Frequencies of a neighbourhood at which its model is made good, at least; more where the neighbourhoods are few, to the resolution of the
/// training: in a sparse band neighbours have little in common, and where a model is bad nothing is found and nothing says so.
const MIN_NEIGHBOURHOOD_POINTS: usize = 3;

/// Storage values of the box per octave, and the least.
const BOX_STORAGES_PER_OCTAVE: f64 = 1.0;

/// Rounds of refinement at the answers before the remaining answers are called uncertain.
const MAX_REFINEMENT_ROUNDS: usize = 6;

pub(super) struct Neighbourhoods<'a, 'o> {
    subspace: Subspace<'a>,
    at: &'o [ModelAt<'a>],
    unknown: &'a Unknown,
    options: Options,
    blocks: Vec<Block>,
    /// The model that answered at each frequency: that of its neighbourhood, when it was last asked.
    models: Vec<Option<Arc<Local>>>,
    /// The whole reduced model without its errors, where every answer is corrected for them.
    corrected: Option<Corrected>,
    /// Answers at each frequency, and how good their model is there.
    assessed: Vec<Vec<(c64, Assessment)>>,
    /// Answers that the training looked at: (frequency, correction).
    answers: Vec<(usize, c64)>,
}

/// How far the training had come: vectors, and answers in a neighbourhood that it looked at.
type Training = (usize, usize);

/// A neighbourhood.
struct Block {
    /// First and last frequency (index).
    ends: [usize; 2],
    /// Its model.
    model: Option<Arc<Local>>,
    /// Its model without corrections, and what that was made from.
    own: Option<(Training, Arc<Projection>)>,
}

impl Block {
    fn has(&self, i: usize) -> bool {
        (self.ends[0]..=self.ends[1]).contains(&i)
    }

    fn forget(&mut self) {
        (self.model, self.own) = (None, None);
    }
}

impl<'a, 'o> Neighbourhoods<'a, 'o> {
    /// The reduced model where the options want one and it can be built.
    pub(super) fn if_wanted(
        band: &Band<'a>,
        at: &'o [ModelAt<'a>],
        trained: &mut Option<Subspace<'a>>,
        options: &Options,
        context: Context<'_>,
    ) -> Option<Self> {
        let wanted = options.reduction.is_subspace(options.method, band.model.dim(), at.len());
        // A singular stand-in for D is no reason to give up: the full model says at which frequency what breaks down.
        wanted.then(|| Self::on_trained(band, at, trained, options, context)).flatten()
    }

    /// On the subspace that was trained for the band already, or else is now; `None` where it cannot be built.
    pub(super) fn on_trained(
        band: &Band<'a>,
        at: &'o [ModelAt<'a>],
        trained: &mut Option<Subspace<'a>>,
        options: &Options,
        context: Context<'_>,
    ) -> Option<Self> {
        let subspace = trained.take().map_or_else(|| train(None, band, at, options, context), Ok).ok()?;
        let n = at.len();
        let count = (n / MIN_NEIGHBOURHOOD_LINES).clamp(1, MAX_NEIGHBOURHOODS);
        let block = |b| Block { ends: [b * n / count, (b + 1) * n / count - 1], model: None, own: None };
        Some(Self {
            subspace,
            at,
            unknown: band.unknown,
            options: *options,
            blocks: (0..count).map(block).collect(),
            models: vec![None; n],
            assessed: vec![Vec::new(); n],
            answers: Vec::new(),
            corrected: None,
        })
    }

    /// Makes the subspace good in another box too, in which answers are searched from now on.
    ///
    /// # Errors
    /// [`Breakdown`] where a solve of the training fails.
    pub(super) fn widen(&mut self, options: &Options, context: Context<'_>) -> Result<(), Breakdown> {
        self.look_in(options);
        self.blocks.iter_mut().for_each(Block::forget);
        self.forget_answers();
        train_in_box(&mut self.subspace, self.at, self.unknown, options, context)
    }

    /// Answers are searched in this box from now on; the subspace is good in it already.
    pub(super) fn look_in(&mut self, options: &Options) {
        self.options = *options;
    }

    /// No model has answered yet at any frequency.
    fn forget_answers(&mut self) {
        self.models.fill(None);
        self.assessed.iter_mut().for_each(Vec::clear);
    }

    /// Leaves what was trained to the next one.
    pub(super) fn hand_back(reduced: Option<Self>, trained: &mut Option<Subspace<'a>>) {
        if let Some(reduced) = reduced {
            *trained = Some(reduced.subspace);
        }
    }

    /// Some of the frequencies, over the whole band: once the subspace is good at their answers, it is at most of the others.
    pub(super) fn pilots(&self) -> Vec<usize> {
        let all: Vec<usize> = (0..self.at.len()).collect();
        thinned(&all, MAX_TRAINING_FREQUENCIES).copied().collect()
    }

    /// Whether it was trained at answers.
    pub(super) fn has_answers(&self) -> bool {
        !self.answers.is_empty()
    }

    /// Finds what there is at some frequencies (ascending), each on the model of its neighbourhood.
    pub(super) fn find<T: Send + Sync>(
        &mut self,
        which: &[usize],
        context: Context<'_>,
        find: impl Fn(usize, &Projection) -> T + Sync,
    ) -> Vec<T> {
        self.localise(which, context.for_each);
        let done = AtomicUsize::new(0);
        let reduced = &*self;
        (context.progress)(Stage::Solutions, 0, which.len());
        map(context.for_each, which.len(), |k| {
            let found = find(which[k], reduced.model(which[k]));
            (context.progress)(Stage::Solutions, done.fetch_add(1, Ordering::Relaxed) + 1, which.len());
            found
        })
    }

    /// Lets the caller say which corrections (k, c) at the k-th of some frequencies (ascending) are the answers among what was found there; where the subspace
    /// is not good enough at one, trains it there and finds again, with what was found before.
    pub(super) fn certify<T: Send + Sync>(
        &mut self,
        which: &[usize],
        mut found: Vec<T>,
        context: Context<'_>,
        again: impl Fn(usize, &Projection, &T) -> T + Sync,
        mut answers: impl FnMut(&[T]) -> Vec<(usize, c64)>,
    ) -> Vec<T> {
        for round in 0..=MAX_REFINEMENT_ROUNDS {
            let answers = answers(&found);
            let reduced = &*self;
            let assessed = map(context.for_each, answers.len(), |a| {
                let (k, correction) = answers[a];
                reduced.assess(which[k], correction)
            });
            let mut uncertain: Vec<(usize, c64)> = Vec::new();
            for ((k, correction), assessed) in answers.into_iter().zip(assessed) {
                let Some(assessed) = assessed else { continue };
                if !is_certain(&self.at[which[k]], correction, &assessed) {
                    uncertain.push((k, correction));
                }
                self.remember(which[k], correction, assessed);
            }
            let lacking: Vec<(usize, c64)> = uncertain.iter().map(|&(k, c)| (which[k], c)).collect();
            if lacking.is_empty()
                || round == MAX_REFINEMENT_ROUNDS
                || !self.refine(&lacking, context).unwrap_or(false)
            {
                break;
            }
            let mut pending: Vec<usize> = uncertain.into_iter().map(|(k, _)| k).collect();
            pending.dedup();
            let frequencies: Vec<usize> = pending.iter().map(|&k| which[k]).collect();
            let before = &found;
            let better = self.find(&frequencies, context, |i, model| {
                let k = which.binary_search(&i).unwrap_or_default();
                again(i, model, &before[k])
            });
            pending.into_iter().zip(better).for_each(|(k, better)| found[k] = better);
        }
        found
    }

    /// How good the model that answered at a frequency is at a correction there.
    pub(super) fn assess(&self, i: usize, correction: c64) -> Option<Assessment> {
        let known = self.assessed[i].iter().find(|(same, _)| *same == correction);
        known.map(|(_, assessed)| assessed.clone()).or_else(|| self.assess_anew(i, correction))
    }

    fn assess_anew(&self, i: usize, correction: c64) -> Option<Assessment> {
        let assessed = match self.models[i].as_deref() {
            Some(local) => local.assess(&self.at[i], correction),
            None => self.model(i).assess(&self.at[i], correction),
        };
        assessed.ok()
    }

    /// The whole reduced model, not corrected for its errors.
    pub(super) fn whole(&self) -> &Projection {
        self.subspace.projection()
    }

    /// Takes errors of the model out of every answer from now on.
    pub(super) fn correct(&mut self, modes: &Modes, errors: &ModalErrors) {
        self.corrected = Some(Corrected::new(self.whole(), modes, errors));
        self.blocks.iter_mut().for_each(|block| block.model = None);
        self.forget_answers();
    }

    /// Corrections, one at each frequency that has any, at which the subspace is not good enough: (frequency, correction).
    pub(super) fn lacking(
        &self,
        correction: impl Fn(usize) -> Option<c64> + Sync,
        for_each: ForEach<'_>,
    ) -> Vec<(usize, c64)> {
        let one = |i: usize| {
            let correction = correction(i)?;
            let assessed = self.assess(i, correction)?;
            (!is_certain(&self.at[i], correction, &assessed)).then_some((i, correction))
        };
        map(for_each, self.at.len(), one).into_iter().flatten().collect()
    }

    /// ∂²x_m/∂c² at an answer.
    pub(super) fn second_derivative(&self, i: usize, correction: c64) -> Option<Vec<c64>> {
        self.model(i).second_derivative(&self.at[i], correction).ok()
    }

    /// Keeps how good the model that found a correction is there.
    pub(super) fn remember(&mut self, i: usize, correction: c64, assessed: Assessment) {
        if self.assessed[i].iter().all(|(same, _)| *same != correction) {
            self.assessed[i].push((correction, assessed));
        }
    }

    /// Trains at answers (frequency, correction), and lets the models of their neighbourhoods be made again; false where nothing was gained.
    pub(super) fn refine(
        &mut self,
        lacking: &[(usize, c64)],
        context: Context<'_>,
    ) -> Result<bool, Breakdown> {
        (context.progress)(Stage::Subspace, 0, self.at.len());
        // Neighbours lack the same: those that this leaves uncertain are looked at in the next round.
        let answers: Vec<(usize, c64)> = thinned(lacking, MAX_TRAINING_FREQUENCIES).copied().collect();
        let points: Vec<Point<'a>> =
            answers.iter().map(|&(i, correction)| Point { at: self.at[i].clone(), correction }).collect();
        let before = self.subspace.size();
        let training = TrainOptions { tolerance: TRAINED_TOL, ..TrainOptions::default() };
        self.subspace.train(&points, &training, context.for_each)?;
        self.answers.extend(answers);
        if self.subspace.size() > before {
            self.corrected = self.corrected.as_ref().map(|corrected| corrected.in_larger(self.whole()));
        }
        let lacks = |block: &Block| lacking.iter().any(|&(i, _)| block.has(i));
        let is_outgrown =
            |block: &Block| block.own.as_ref().is_some_and(|(training, _)| *training != self.training(block));
        let gained = self.size() > before || self.blocks.iter().filter(|block| lacks(block)).any(is_outgrown);
        if gained {
            self.blocks.iter_mut().filter(|block| lacks(block)).for_each(Block::forget);
        }
        Ok(gained)
    }

    /// Makes the models of the neighbourhoods in which these frequencies (ascending) are, for them. A model that there is stays: its assessments hold, however
    /// many vectors the subspace has gained since.
    pub(super) fn localise(&mut self, frequencies: &[usize], for_each: ForEach<'_>) {
        let members = |[first, last]: [usize; 2]| {
            let from = frequencies.partition_point(|&i| i < first);
            &frequencies[from..frequencies.partition_point(|&i| i <= last)]
        };
        let wanted: Vec<usize> = (0..self.blocks.len())
            .filter(|&b| !members(self.blocks[b].ends).is_empty() && self.blocks[b].model.is_none())
            .collect();
        let reduced = &*self;
        let models = map(for_each, wanted.len(), |k| {
            let block = &reduced.blocks[wanted[k]];
            (reduced.training(block), reduced.local(block))
        });
        for (b, (training, model)) in wanted.into_iter().zip(models) {
            let block = &mut self.blocks[b];
            block.own.get_or_insert_with(|| (training, Arc::clone(model.own())));
            block.model = Some(Arc::new(model));
        }
        for block in &self.blocks {
            for &i in members(block.ends) {
                let model = block.model.clone();
                let same =
                    self.models[i].as_ref().zip(model.as_ref()).is_some_and(|(a, b)| Arc::ptr_eq(a, b));
                if !same {
                    self.assessed[i].clear();
                }
                self.models[i] = model;
            }
        }
    }

    /// How far the training has come for a neighbourhood.
    fn training(&self, block: &Block) -> Training {
        (self.size(), self.answers.iter().filter(|(i, _)| block.has(*i)).count())
    }

    /// The model of a neighbourhood.
    fn local(&self, block: &Block) -> Local {
        let [first, last] = block.ends;
        let steps = (last - first)
            .min(MIN_NEIGHBOURHOOD_POINTS.max(MAX_TRAINING_FREQUENCIES / self.blocks.len()) - 1);
        let picked = (0..=steps).map(|k| first + k * (last - first) / steps.max(1));
        let box_points = picked.flat_map(|i| self.box_points(i));
        let answers = self.answers.iter().filter(|(i, _)| (first..=last).contains(i));
        let answers: Vec<(usize, c64)> = answers.copied().collect();
        let answers = thinned(&answers, MIN_NEIGHBOURHOOD_LINES);
        let answers = answers.map(|&(i, correction)| Point { at: self.at[i].clone(), correction });
        let points: Vec<Point<'_>> = box_points.chain(answers).collect();
        let own = match &block.own {
            Some((_, own)) => Arc::clone(own),
            None => Arc::new(self.whole().localised(&points, TRAINED_TOL)),
        };
        Local::new(own, self.corrected.as_ref(), &points, TRAINED_TOL)
    }

    /// First and last frequency of each neighbourhood.
    pub(super) fn neighbourhoods(&self) -> impl Iterator<Item = [usize; 2]> {
        self.blocks.iter().map(|block| block.ends)
    }

    /// The model that answered at a frequency.
    pub(super) fn model(&self, i: usize) -> &Projection {
        match (self.models[i].as_deref(), &self.corrected) {
            (Some(local), _) => local.model(),
            (None, Some(corrected)) => &corrected.model,
            (None, None) => self.whole(),
        }
    }

    /// The model without its errors, in the basis that there is.
    pub(super) fn corrected(&self) -> Option<&Corrected> {
        self.corrected.as_ref()
    }

    pub(super) fn size(&self) -> usize {
        self.subspace.size()
    }

    pub(super) fn work(&self) -> Work {
        self.subspace.work()
    }

    fn box_points(&self, i: usize) -> Vec<Point<'a>> {
        box_points(&self.at[i], self.unknown, &self.options)
    }
}

/// Trains over the box, a new subspace or one that was kept.
///
/// # Errors
/// [`Breakdown`] where no real stand-in for D can be factorised.
pub(in crate::identify) fn train<'a>(
    kept: Option<Subspace<'a>>,
    band: &Band<'a>,
    at: &[ModelAt<'a>],
    options: &Options,
    context: Context<'_>,
) -> Result<Subspace<'a>, Breakdown> {
    let new = || Subspace::new(band.experiment, &at[at.len() - 1]);
    let mut subspace = kept.map_or_else(new, Ok)?;
    train_in_box(&mut subspace, at, band.unknown, options, context)?;
    Ok(subspace)
}

fn train_in_box<'a>(
    subspace: &mut Subspace<'a>,
    at: &[ModelAt<'a>],
    unknown: &Unknown,
    options: &Options,
    context: Context<'_>,
) -> Result<(), Breakdown> {
    (context.progress)(Stage::Subspace, 0, at.len());
    let points: Vec<Point<'a>> =
        thinned(at, MAX_TRAINING_FREQUENCIES).flat_map(|at| box_points(at, unknown, options)).collect();
    let training = TrainOptions { tolerance: BOX_TOL, ..TrainOptions::default() };
    let corners = box_points(&at[at.len() - 1], unknown, options);
    subspace.train_box(&points, &corners, &training, context.for_each)
}

/// The nominal factor and a grid over the box at a frequency.
fn box_points<'a>(at: &ModelAt<'a>, unknown: &Unknown, options: &Options) -> Vec<Point<'a>> {
    let nominal = at.parameters[0].nominal;
    let point = |factor: c64| Point { at: at.clone(), correction: factor - nominal };
    let mut points = vec![point(nominal)];
    let searched = options.search_box(unknown, nominal);
    if let Some([low, high]) = searched.filter(|[low, high]| 0.0 < *low && high.is_finite()) {
        let steps = ((BOX_STORAGES_PER_OCTAVE * (high / low).log2()).ceil() as usize).max(2);
        let eta = loss_factor(nominal);
        let eta = unknown.bounds.loss_factor.map_or(eta, |[low, high]| eta.clamp(low, high));
        let storage = |k: usize| low * (high / low).powf(k as f64 / steps as f64);
        points.extend((0..=steps).map(|k| point(c64::new(1.0, eta) * storage(k))));
    }
    points
}

/// Whether an answer's error is what it may be.
pub(in crate::identify) fn is_certain(at: &ModelAt<'_>, correction: c64, assessed: &Assessment) -> bool {
    assessed.relative_truncation(at.parameters[0].nominal + correction) <= ANSWER_TOL
}

/// What the subspace may have done to an answer.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::identify) struct ReductionError {
    /// Estimated error of the response over all sensors, relative to the measured one.
    pub(in crate::identify) response: f64,
    /// What that does to the factor, relative.
    pub(super) factor: f64,
}

/// Largest relative error of the factor that the subspace may cause, by its own estimate, for status `ok`: the estimate is ten
/// to a hundred times what direct solves show.
pub(in crate::identify) const MAX_REDUCTION_ERROR: f64 = 1e-5;

pub(in crate::identify) fn reduction_error(
    assessed: &Assessment,
    factor: c64,
    measured: &[c64],
) -> ReductionError {
    let norm = |values: &mut dyn Iterator<Item = f64>| values.map(|v| v * v).sum::<f64>().sqrt();
    let error = norm(&mut (0..measured.len()).map(|m| assessed.error(m)));
    let size = norm(&mut measured.iter().map(|u| u.norm()));
    let slope = norm(&mut assessed.slope.iter().map(|slope| slope.norm()));
    ReductionError { response: error / size, factor: error / (slope * factor.norm()) }
}
