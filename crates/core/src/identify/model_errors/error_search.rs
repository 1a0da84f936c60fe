//! The search for errors with which the model explains a band.

use super::band_search::Search;
use super::estimated::Estimated;
use super::fit::{ADDED_NOISE, Explained, FIRST_LEVELS, Fit, RIGHT_MODEL_NATS};
use super::fitting::{Fitting, Place, middle};
use super::kinds::Kinds;
use super::measured::{SAME_START, distance};
use super::paired::ByModes;
use super::sizes::{DOUBTFUL_SHAPE_STD, MISPLACED_SHAPE_STD};
use crate::subspace::{Modes, Projection};
use std::cell::OnceCell;
use std::f64::consts::TAU;

/// The first level of added noise where coordinates were tried one by one: more would let go what was found.
const TUNED_LEVELS: usize = 2;

/// The first level of added noise where only errors of damping and masses are to be found.
const LAST_LEVELS: usize = 5;

/// Starts with more mismatch over the least of all are far from the answer.
const MAX_MISMATCH_OVER_LEAST: f64 = 1.2;

/// A stiffness is no farther from where natural frequencies have it than so many standard deviations of both. These also hold what errors have in common, which is the same
/// in both.
const MAX_DEVIATIONS: f64 = 1.5;

/// A search from several starts.
pub(super) struct ErrorSearch<'f, 't, 'a> {
    search: &'f Search<'t, 'a>,
    starts: &'f [Vec<f64>],
    /// All lines that are used, on a model that is good near the starts.
    whole: Fitting<'f, 'a>,
    /// Some of them.
    coarse: Fitting<'f, 'a>,
    /// The most that noise leaves where it is not given.
    usual_noise: f64,
    /// The unknowns by the modes of the measurement, once they were asked for.
    by_modes: OnceCell<Option<ByModes>>,
}

impl<'f, 't, 'a> ErrorSearch<'f, 't, 'a> {
    /// With a model that is good near the starts, and its modes.
    pub(super) fn new(
        search: &'f Search<'t, 'a>,
        starts: &'f [Vec<f64>],
        (model, modes): &'f (Projection, Modes),
    ) -> Self {
        Self {
            search,
            starts,
            whole: search.fitting(model, modes, &search.lines),
            coarse: Fitting { free_nodes: false, ..search.fitting(model, modes, &search.some) },
            usual_noise: search.data.usual_noise(),
            by_modes: OnceCell::new(),
        }
    }

    /// The errors of stiffness that explain the band best, or of stiffness and masses. `None` where nothing can be compared.
    pub(super) fn of_stiffness(&self) -> Option<Explained> {
        self.of_all_starts().map(|wrong| self.without_common_error(wrong))
    }

    /// From where the unknowns have taken what all natural frequencies have in common, as long as that is improbable and leads to larger evidence.
    ///
    /// Of the two hardly more than the sum is seen. So they lie in a long valley, in which a search may stop.
    fn without_common_error(&self, mut wrong: Explained) -> Explained {
        let data = self.search.data;
        let settled: Fit<'_> = &|fitting, place| data.settled_near(fitting, place);
        while let Some(place) = self.whole.without_common_error(&wrong.found.place) {
            let nearer = self.search.near(place, wrong.kinds, settled);
            match nearer.filter(|nearer| nearer.evidence < wrong.evidence) {
                Some(nearer) => wrong = nearer,
                None => break,
            }
        }
        wrong
    }

    /// From the starts, from pairs of modes, and from elsewhere where neither explains the band.
    fn of_all_starts(&self) -> Option<Explained> {
        let is_found = |wrong: &Option<Explained>| wrong.as_ref().is_some_and(|wrong| self.is_found(wrong));
        let by_starts = self.of_starts();
        let by_modes = if is_found(&by_starts) { None } else { self.paired() };
        // Where single lines and natural frequencies lead to the same small errors, no other start is likely to come to better ones of the same kinds.
        let is_same = by_starts.as_ref().zip(by_modes.as_ref()).is_some_and(|(a, b)| self.are_same(a, b));
        let mut wrong = self.better(by_starts, by_modes);
        if !is_found(&wrong) {
            wrong = self.better(wrong, self.with_masses());
        }
        if is_same {
            return wrong;
        }
        if !is_found(&wrong) {
            wrong = self.better(wrong, self.upwards());
        }
        let wrong = self.tuned(wrong?);
        // Shapes that may be far off explain almost any band, with any modulus: small errors have to explain it already. With one sensor they only scale its resonances.
        let is_free = self.coarse.known.given.shape.is_none();
        let has_others = self.search.data.counted_sensors().count() > 1;
        let are_doubtful = is_free && has_others && wrong.sizes.shape >= DOUBTFUL_SHAPE_STD;
        let misplaced =
            if are_doubtful && self.is_found(&wrong) { self.with_misplaced_sensors() } else { None };
        self.better(Some(wrong), misplaced)
    }

    /// From the starts, with errors of shapes as large as those of a sensor or a load beside its place. Where the search begins with small ones, errors of natural frequencies take
    /// their part, and the unknowns follow.
    fn with_misplaced_sensors(&self) -> Option<Explained> {
        let data = self.search.data;
        let known = self.coarse.known.with_shape(MISPLACED_SHAPE_STD);
        let coarse = Fitting { kinds: Kinds::STIFFNESS, known, ..self.coarse };
        let place = self.nearest(&coarse, self.at_starts())?;
        self.search.near(place, Kinds::STIFFNESS, &|fitting, place| {
            let far = Fitting { known, ..*fitting };
            let with_size = data.explain(&far, place, &ADDED_NOISE[FIRST_LEVELS..])?;
            data.settled_with(fitting, with_size.found.place, with_size.sizes)
        })
    }

    /// From the starts. Far from the answer damping that is free only hides that a mode is at another frequency, and masses may.
    fn of_starts(&self) -> Option<Explained> {
        self.fitted(self.at_starts(), Kinds::STIFFNESS)
    }

    /// From where modes have the places of those of the measurement.
    fn paired(&self) -> Option<Explained> {
        let data = self.search.data;
        let used = |line: usize, sensor: usize| self.is_used(line, sensor);
        let place = self.search.at_partners(self.by_modes()?, &self.whole, &used)?;
        let settled: Fit<'_> = &|fitting, place| data.settled_near(fitting, place);
        self.search.near(place, Kinds::STIFFNESS, settled)
    }

    /// The unknowns by the modes of the measurement.
    fn by_modes(&self) -> Option<&ByModes> {
        let start = || self.search.curves.straight(&self.starts[0]);
        self.by_modes.get_or_init(|| self.search.by_modes(&start())).as_ref()
    }

    /// Whether constant stiffnesses are where natural frequencies do not have them.
    ///
    /// Where neither noise nor errors explain the responses, other places may follow what the model lacks. Natural frequencies hardly depend on that.
    pub(super) fn contradicts_modes(&self, estimated: &Estimated) -> bool {
        let line = middle(&self.search.lines);
        let frequency_hz = self.search.data.omegas[line] / TAU;
        let is_far = |&(unknown, by_modes, log_std): &(usize, f64, f64)| -> Option<bool> {
            let found = estimated.values(line, frequency_hz)?[unknown].re;
            let [variance, ..] = estimated.covariance_at(unknown, line, frequency_hz)?;
            let of_both = (variance.max(0.0).sqrt() / found).hypot(log_std);
            Some((found / by_modes).ln().abs() > MAX_DEVIATIONS * of_both)
        };
        let mut constants = self.by_modes().into_iter().flat_map(|by_modes| &by_modes.constants);
        constants.any(|one| is_far(one).unwrap_or(false))
    }

    /// With masses at the sensors.
    fn with_masses(&self) -> Option<Explained> {
        self.fitted(self.at_starts(), Kinds::MASSES)
    }

    /// From where each start leads with lines that are used from the lowest on.
    fn upwards(&self) -> Option<Explained> {
        let stiffness = Fitting { kinds: Kinds::STIFFNESS, free_nodes: false, ..self.whole };
        let upwards = |start: &Vec<f64>| self.search.data.upwards(&stiffness, start);
        self.fitted(self.starts.iter().filter_map(upwards).collect(), Kinds::STIFFNESS)
    }

    /// From where smooth unknowns leave least mismatch, all over their range, with natural frequencies that are tried one by one there. The same where the errors are found.
    fn tuned(&self, mut wrong: Explained) -> Explained {
        if self.is_found(&wrong) {
            return wrong;
        }
        let whole = &self.whole;
        let used = |line: usize, sensor: usize| self.is_used(line, sensor);
        let scaled = |start: &Vec<f64>| whole.scaled(whole.start(&self.search.curves.straight(start)), &used);
        let mut scaled: Vec<(f64, Place)> = self.starts.iter().filter_map(scaled).collect();
        scaled.sort_by(|a, b| a.0.total_cmp(&b.0));
        let most = scaled.first().map_or(0.0, |(least, _)| MAX_MISMATCH_OVER_LEAST * least);
        scaled.dedup_by(|a, b| distance(&a.1, &b.1) <= SAME_START);
        for (_, mut place) in scaled.into_iter().filter(|(mismatch, _)| *mismatch <= most) {
            while !self.is_found(&wrong) {
                let tuned = whole
                    .tuned(place, &used)
                    .and_then(|there| self.explained(there, Kinds::STIFFNESS, &ADDED_NOISE[TUNED_LEVELS..]));
                let is_better = |tuned: &Explained| tuned.evidence <= wrong.evidence - 2.0 * RIGHT_MODEL_NATS;
                let Some(tuned) = tuned.filter(is_better) else { break };
                place = tuned.found.place.clone();
                wrong = tuned;
            }
        }
        wrong
    }

    /// With errors of masses and damping, each kind unless it is worse, and −2 ln of the evidence of the kinds that explain the band best. The model is good near the
    /// errors.
    pub(super) fn with_further_kinds(
        &self,
        (model, modes): &(Projection, Modes),
        mut wrong: Explained,
    ) -> (Explained, f64) {
        // Errors that the data do not determine stay in the bars: masses and common damping are left out only where they are clearly worse.
        // Damping of single modes can stand in for a loss factor that varies with frequency, so it has to explain the band better.
        type With = fn(Kinds) -> Kinds;
        let further: [(With, f64); 3] = [
            (Kinds::with_masses, RIGHT_MODEL_NATS),
            (Kinds::with_common_damping, RIGHT_MODEL_NATS),
            (Kinds::with_own_damping, 0.0),
        ];
        let data = self.search.data;
        let fine = self.search.fitting(model, modes, &self.search.lines);
        // Whether there are errors is asked of the kinds that explain the band best.
        let mut best = wrong.evidence;
        for (with, nats) in further {
            let kinds = with(wrong.kinds);
            if kinds != wrong.kinds {
                let (place, fitting) = (wrong.found.place.clone(), Fitting { kinds, ..fine });
                // A minimum that explains the band is near, and noise that is not given is what the errors leave. From any other minimum less noise leads away.
                let more = if self.is_explained(&wrong) || !data.known() {
                    let sizes = wrong.sizes.with_kinds(kinds, fine.known);
                    fitting
                        .linearised(place)
                        .and_then(|at| data.settled(&fitting, at, sizes, (wrong.level, wrong.rest)))
                } else {
                    data.explain(&fitting, place, &ADDED_NOISE[LAST_LEVELS..])
                };
                best = more.as_ref().map_or(best, |more| best.min(more.evidence));
                wrong = more.filter(|more| more.evidence < wrong.evidence + 2.0 * nats).unwrap_or(wrong);
            }
        }
        (wrong, best)
    }

    /// Whether the residual is noise.
    pub(super) fn is_explained(&self, wrong: &Explained) -> bool {
        self.search.data.is_explained(wrong, &self.search.lines, self.usual_noise)
    }

    /// The same with small errors. Large ones may explain a band as well: those of modes at each other's places.
    fn is_found(&self, wrong: &Explained) -> bool {
        self.is_explained(wrong) && self.whole.are_small(&wrong.found.place)
    }

    /// The fit of small errors, or of larger evidence where both have them or neither.
    fn better(&self, a: Option<Explained>, b: Option<Explained>) -> Option<Explained> {
        let are_large = |one: &Explained| !self.whole.are_small(&one.found.place);
        let order = |a: &Explained, b: &Explained| {
            are_large(a).cmp(&are_large(b)).then(a.evidence.total_cmp(&b.evidence))
        };
        a.into_iter().chain(b).min_by(order)
    }

    /// Whether two are one: the unknowns are the same, and the errors of either are small.
    fn are_same(&self, a: &Explained, b: &Explained) -> bool {
        let [a, b] = [a, b].map(|one| &one.found.place);
        let unknowns = self.whole.curves.count();
        let is_near = distance(&a[..unknowns], &b[..unknowns]) <= SAME_START;
        is_near && self.whole.are_small(a) && self.whole.are_small(b)
    }

    /// Whether a sensor is not left out at a line.
    fn is_used(&self, line: usize, sensor: usize) -> bool {
        self.search.data.sigma[line][sensor].is_finite()
    }

    fn at_starts(&self) -> Vec<Place> {
        self.starts.iter().map(|start| self.coarse.start(start)).collect()
    }

    /// From the best of some places, with some lines at first.
    fn fitted(&self, places: Vec<Place>, kinds: Kinds) -> Option<Explained> {
        let place = self.nearest(&Fitting { kinds, ..self.coarse }, places)?;
        self.explained(place, kinds, &ADDED_NOISE[FIRST_LEVELS..])
    }

    /// The best of where some places lead with some lines.
    fn nearest(&self, coarse: &Fitting<'_, '_>, places: Vec<Place>) -> Option<Place> {
        let ends = places.into_iter().filter_map(|place| self.search.data.approach(coarse, place));
        Some(ends.min_by(|a, b| a.0.total_cmp(&b.0))?.1)
    }

    /// From a place, with all lines and these levels of added noise, on a model that is good there.
    fn explained(&self, place: Place, kinds: Kinds, from_above: &[f64]) -> Option<Explained> {
        let data = self.search.data;
        self.search.near(place, kinds, &|fitting, place| data.explain(fitting, place, from_above))
    }
}
