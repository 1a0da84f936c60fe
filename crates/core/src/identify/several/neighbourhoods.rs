//! The subspace of a band with several unknowns: good over the box of all of them, then where answers were found.

use crate::c64;
use crate::for_each::{ForEach, map};
use crate::halton;
use crate::identify::band::{
    BOX_TOL, MAX_NEIGHBOURHOODS, MAX_TRAINING_FREQUENCIES, MIN_NEIGHBOURHOOD_LINES, TRAINED_TOL, is_certain,
};
use crate::identify::context::{Context, Stage};
use crate::identify::problem::Problem;
use crate::identify::unknown::{Composite, Unknown};
use crate::material::{OutsideTable, loss_factor};
use crate::model::ModelAt;
use crate::response::Work;
use crate::subspace::{Assessment, Corrected, Local, ModalErrors, Modes};
use crate::subspace::{Point, Projection, Subspace, TrainOptions};
use crate::thinned::thinned;
use frfit_linalg::solve::Breakdown;
use std::sync::Arc;

/// Real factorisations at most: a second unknown wants more vectors, which cost solves.
const MAX_FACTORISATIONS: usize = 3;

/// Points of the box at each of them, for each unknown: neighbouring frequencies have other points of the same sequence, so that together they fill the box.
const TRAINING_POINTS_PER_UNKNOWN: usize = 3;

/// Frequencies at which the model of a neighbourhood is made good.
const NEIGHBOURHOOD_FREQUENCIES: usize = 4;

/// Answers of a neighbourhood that its model is made good at, at most.
const MAX_NEIGHBOURHOOD_ANSWERS: usize = 8;

/// Error of a model that only has to separate starts from one another.
pub(super) const ROUGH_MODEL_TOL: f64 = 1e-4;

/// A reduced model for a band and a box of several unknowns.
pub(super) struct Neighbourhoods<'a> {
    pub(super) composite: Composite<'a>,
    frequency_hz: &'a [f64],
    /// `[frequency][unknown]`.
    nominal: Vec<Vec<c64>>,
    subspace: Subspace<'a>,
    /// First and last frequency of each neighbourhood, and its model.
    blocks: Vec<([usize; 2], Option<Local>)>,
    /// The whole reduced model without its errors, where every answer is corrected for them.
    corrected: Option<Corrected>,
    answers: Vec<Answer>,
    /// Whether models are good near the answers alone, and not over the box.
    is_near: bool,
}

/// A frequency, and values of all unknowns there.
pub(super) type Answer = (usize, Vec<c64>);

/// A response and its slopes: x_m, and ∂x_m/∂p_j as `[unknown][sensor]`.
pub(super) type Responded = (Vec<c64>, Vec<Vec<c64>>);

/// Trains over the box.
///
/// # Errors
/// [`Breakdown`] where no real stand-in for D can be factorised, [`OutsideTable`] where a table ends within the band.
pub(super) fn train<'a>(
    kept: Option<Subspace<'a>>,
    problem: &Problem<'a>,
    nominal: &[Vec<c64>],
    context: Context<'_>,
) -> Result<Result<Subspace<'a>, Breakdown>, OutsideTable> {
    let composite = Composite { model: problem.model, unknowns: problem.unknowns };
    let frequency_hz = problem.frfs.frequency_hz;
    let n = frequency_hz.len();
    (context.progress)(Stage::Subspace, 0, n);
    let reference = composite.at(frequency_hz[n - 1], &nominal[n - 1])?;
    let mut subspace = match kept.map_or_else(|| Subspace::new(problem.experiment, &reference), Ok) {
        Ok(subspace) => subspace,
        Err(breakdown) => return Ok(Err(breakdown)),
    };
    let all: Vec<usize> = (0..n).collect();
    let mut points = Vec::new();
    for (k, &i) in thinned(&all, MAX_TRAINING_FREQUENCIES).enumerate() {
        points.extend(box_points(&composite, frequency_hz[i], &nominal[i], k)?);
    }
    let training =
        TrainOptions { tolerance: BOX_TOL, factorisations: MAX_FACTORISATIONS, ..TrainOptions::default() };
    let corners = corners(&composite, frequency_hz[n - 1], &nominal[n - 1])?;
    Ok(subspace.train_box(&points, &corners, &training, context.for_each).map(|()| subspace))
}

/// Unknowns whose ends are combined.
const MAX_CORNER_UNKNOWNS: usize = 4;

/// The corners of the box at a frequency.
fn corners<'a>(
    composite: &Composite<'a>,
    frequency_hz: f64,
    nominal: &[c64],
) -> Result<Vec<Point<'a>>, OutsideTable> {
    let corner = |k: usize| {
        let ends = (0..nominal.len()).map(|j| f64::from(u8::from(k >> j.min(MAX_CORNER_UNKNOWNS) & 1 == 1)));
        let at = composite.at(frequency_hz, &at_parts(composite, nominal, ends))?;
        Ok(Point { at, correction: c64::default() })
    };
    (0..1 << nominal.len().min(MAX_CORNER_UNKNOWNS)).map(corner).collect()
}

/// Everything at its nominal value, and points of a sequence over the box.
fn box_points<'a>(
    composite: &Composite<'a>,
    frequency_hz: f64,
    nominal: &[c64],
    k: usize,
) -> Result<Vec<Point<'a>>, OutsideTable> {
    let count = TRAINING_POINTS_PER_UNKNOWN * nominal.len();
    let values = std::iter::once(nominal.to_vec());
    let values = values.chain((0..count).map(|p| in_box(composite, nominal, 1 + k * count + p)));
    let point =
        |values: Vec<c64>| Ok(Point { at: composite.at(frequency_hz, &values)?, correction: c64::default() });
    values.map(point).collect()
}

impl<'a> Neighbourhoods<'a> {
    /// The models of the neighbourhoods of a band on a subspace that was trained for it.
    pub(super) fn new(
        subspace: Subspace<'a>,
        problem: &Problem<'a>,
        nominal: &[Vec<c64>],
        context: Context<'_>,
    ) -> Self {
        let composite = Composite { model: problem.model, unknowns: problem.unknowns };
        let frequency_hz = problem.frfs.frequency_hz;
        let n = frequency_hz.len();
        let count = (n / MIN_NEIGHBOURHOOD_LINES).clamp(1, MAX_NEIGHBOURHOODS);
        let ends = (0..count).map(|b| [b * n / count, (b + 1) * n / count - 1]);
        let blocks = ends.map(|ends| (ends, None)).collect();
        let mut reduced = Self {
            composite,
            frequency_hz,
            nominal: nominal.to_vec(),
            subspace,
            blocks,
            answers: Vec::new(),
            corrected: None,
            is_near: false,
        };
        reduced.localise(context.for_each);
        reduced
    }

    /// What the next one may train further.
    pub(super) fn into_subspace(self) -> Subspace<'a> {
        self.subspace
    }

    fn box_points(&self, i: usize, k: usize) -> Result<Vec<Point<'a>>, OutsideTable> {
        box_points(&self.composite, self.frequency_hz[i], &self.nominal[i], k)
    }

    fn point(&self, i: usize, values: &[c64]) -> Result<Point<'a>, OutsideTable> {
        Ok(Point { at: self.composite.at(self.frequency_hz[i], values)?, correction: c64::default() })
    }

    /// The model's matrices at these values.
    pub(super) fn at(&self, i: usize, values: &[c64]) -> Option<ModelAt<'a>> {
        self.composite.at(self.frequency_hz[i], values).ok()
    }

    /// The model that answers at a frequency.
    pub(super) fn model(&self, i: usize) -> &Projection {
        match (self.local(i), &self.corrected) {
            (Some(local), _) => local.model(),
            (None, Some(corrected)) => &corrected.model,
            (None, None) => self.whole(),
        }
    }

    fn local(&self, i: usize) -> Option<&Local> {
        let block = self.blocks.iter().find(|([first, last], _)| (*first..=*last).contains(&i));
        block.and_then(|(_, local)| local.as_ref())
    }

    /// The whole reduced model, not corrected for its errors.
    pub(super) fn whole(&self) -> &Projection {
        self.subspace.projection()
    }

    /// Takes errors of the model out of every answer from now on.
    pub(super) fn correct(&mut self, modes: &Modes, errors: &ModalErrors, for_each: ForEach<'_>) {
        self.corrected = Some(Corrected::new(self.whole(), modes, errors));
        self.localise(for_each);
    }

    /// The model without its errors, in the basis that there is.
    pub(super) fn corrected(&self) -> Option<&Corrected> {
        self.corrected.as_ref()
    }

    /// Response and slopes at these values.
    pub(super) fn respond(&self, i: usize, values: &[c64]) -> Option<Responded> {
        self.respond_on(self.model(i), i, values)
    }

    /// The same on another model.
    pub(super) fn respond_on(&self, model: &Projection, i: usize, values: &[c64]) -> Option<Responded> {
        model.respond_with_slopes(&self.at(i, values)?).ok()
    }

    /// A model of one frequency with few vectors, good to some error over the box.
    pub(super) fn rough(&self, i: usize, tolerance: f64) -> Projection {
        let points = self.box_points(i, i).unwrap_or_default();
        self.model(i).localised(&points, tolerance)
    }

    /// A model of one frequency that is good near some values.
    pub(super) fn about(&self, i: usize, values: &[c64]) -> Option<Projection> {
        self.model(i).about(&self.at(i, values)?)
    }

    /// How good the model is at these values.
    pub(super) fn assess(&self, i: usize, values: &[c64]) -> Option<Assessment> {
        self.local(i)?.assess(&self.at(i, values)?, c64::default()).ok()
    }

    /// Models that are good over the box.
    pub(super) fn widen(&mut self, for_each: ForEach<'_>) {
        if std::mem::take(&mut self.is_near) {
            self.localise(for_each);
        }
    }

    /// Models of few vectors that are good near some answers, where no frequency has a value of its own: all of them move together, and not far.
    pub(super) fn narrow(&mut self, answers: Vec<Answer>, for_each: ForEach<'_>) {
        let is_there = self.is_near && self.answers == answers;
        if !is_there && !self.composite.unknowns.iter().any(Unknown::is_curve) {
            (self.is_near, self.answers) = (true, answers);
            self.localise(for_each);
        }
    }

    /// Trains at the answers where the subspace is not good enough; whether anything was gained.
    pub(super) fn refine(&mut self, answers: &[Answer], context: Context<'_>) -> bool {
        let lacking = |(i, values): &Answer| {
            let at = self.at(*i, values)?;
            let assessed = self.assess(*i, values)?;
            (!is_certain(&at, c64::default(), &assessed)).then(|| Point { at, correction: c64::default() })
        };
        let lacking: Vec<(usize, Point<'a>)> =
            map(context.for_each, answers.len(), |k| Some((k, lacking(&answers[k])?)))
                .into_iter()
                .flatten()
                .collect();
        if lacking.is_empty() {
            return false;
        }
        (context.progress)(Stage::Subspace, 0, self.frequency_hz.len());
        let before = self.subspace.size();
        let trained = || thinned(&lacking, MAX_TRAINING_FREQUENCIES);
        match self.is_near {
            true => self.answers = answers.to_vec(),
            false => self.answers.extend(trained().map(|(k, _)| answers[*k].clone())),
        }
        let points: Vec<Point<'a>> = trained().map(|(_, point)| point.clone()).collect();
        let training = TrainOptions {
            tolerance: TRAINED_TOL,
            factorisations: MAX_FACTORISATIONS,
            ..TrainOptions::default()
        };
        let trained = self.subspace.train(&points, &training, context.for_each);
        self.corrected = self.corrected.as_ref().map(|corrected| corrected.in_larger(self.whole()));
        self.localise(context.for_each);
        trained.is_ok() && self.subspace.size() > before
    }

    fn localise(&mut self, for_each: ForEach<'_>) {
        let reduced = &*self;
        let about = |b: usize| reduced.about_block(reduced.blocks[b].0);
        // Where one neighbourhood needs the whole model the others do.
        let middle = about(reduced.blocks.len() / 2);
        let models = match middle.model().size() < reduced.size() {
            true => map(for_each, reduced.blocks.len(), about),
            false => vec![middle; reduced.blocks.len()],
        };
        self.blocks.iter_mut().zip(models).for_each(|(block, model)| block.1 = Some(model));
    }

    fn about_block(&self, [first, last]: [usize; 2]) -> Local {
        let steps = (last - first).min(NEIGHBOURHOOD_FREQUENCIES - 1);
        let picked = (0..=steps).map(|k| first + k * (last - first) / steps.max(1));
        let own: Vec<&Answer> = self.answers.iter().filter(|(i, _)| (first..=last).contains(i)).collect();
        let is_near = self.is_near && !own.is_empty();
        let boxes = picked.filter(|_| !is_near).filter_map(|i| self.box_points(i, i).ok()).flatten();
        let own =
            thinned(&own, MAX_NEIGHBOURHOOD_ANSWERS).filter_map(|(i, values)| self.point(*i, values).ok());
        let points: Vec<Point<'_>> = boxes.chain(own).collect();
        let own = Arc::new(self.whole().localised(&points, TRAINED_TOL));
        Local::new(own, self.corrected.as_ref(), &points, TRAINED_TOL)
    }

    pub(super) fn size(&self) -> usize {
        self.subspace.size()
    }

    pub(super) fn work(&self) -> Work {
        self.subspace.work()
    }
}

/// The k-th point of a sequence over the box of all unknowns, logarithmic where a range is positive: one dimension for each.
pub(super) fn in_box(composite: &Composite<'_>, nominal: &[c64], k: usize) -> Vec<c64> {
    at_parts(composite, nominal, halton::point(k))
}

/// Values that divide the range of each unknown in some parts, with the loss factor of the nominal one.
fn at_parts(composite: &Composite<'_>, nominal: &[c64], parts: impl Iterator<Item = f64>) -> Vec<c64> {
    let value = |((one, &nominal), part): ((&Unknown, &c64), f64)| {
        let real = between(one.range(nominal), part);
        let eta = loss_factor(nominal);
        let eta = one.bounds.loss_factor.map_or(eta, |[low, high]| eta.clamp(low, high));
        if one.real || !eta.is_finite() { c64::new(real, 0.0) } else { c64::new(1.0, eta) * real }
    };
    composite.unknowns.iter().zip(nominal).zip(parts).map(value).collect()
}

/// The value that divides a range in this part: of its logarithm where it is positive.
pub(super) fn between([low, high]: [f64; 2], part: f64) -> f64 {
    if low > 0.0 { low * (high / low).powf(part) } else { low + (high - low) * part }
}
