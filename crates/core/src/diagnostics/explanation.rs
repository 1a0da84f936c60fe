//! What explains data that the moduli alone do not: one change, or two together.
//!
//! Two changes are searched together, for neither may help alone: a sign hides that values are in g. All single changes are
//! fitted, then pairs of those that are likely with all others. An explanation is believed where the data know it from every
//! other one ([`MIN_MARGIN_NATS`]).

use super::data_hypothesis::{Change, DataHypothesis, Edit};
use super::finding::{Fault, KNOWN_FACTOR_RTOL, KnownFactor};
use super::misfit;
use super::search::{Fitted, Grid, Search};
use crate::for_each::map;

/// The least log-likelihood ratio of a finding, in nats: some thirty changes are tried (e^3.4), and neighbouring residuals are not independent: the residual of a law
/// that is no power may move several of them together.
pub const FINDING_NATS: f64 = 15.0;

/// The same of a second finding beside the best single one, and of one whose number is free: a wrong model leaves what small second faults explain.
const SECOND_FINDING_NATS: f64 = 2.0 * FINDING_NATS;
const SECOND_FREE_FINDING_NATS: f64 = 4.0 * FINDING_NATS;

/// A factor without a name beside another fault is a calibration: no larger than this, nor smaller than one over it.
const MAX_UNNAMED_LN_FACTOR: f64 = 1.1;

/// The misfit of the sensors that a fault concerns is at most this, or at most a multiple of that of all sensors.
const MAX_CONCERNED_LEFT: f64 = 0.1;
const MAX_CONCERNED_OVER_ALL: f64 = 3.0;

/// What leaves more than this explains nothing: a factor of 1.5, or 23 degrees.
const MAX_MISFIT_LEFT: f64 = 0.4;

/// The misfit with a finding over that without, at most. A factor, a delay or another row can fit a little of whatever is wrong; what they are the reason of falls to the noise.
pub const MAX_MISFIT_RATIO: f64 = 0.6;

/// The least log-likelihood ratio of an explanation to the best other one, in nats for each of its faults: with less the data do not say which it is.
pub const MIN_MARGIN_NATS: f64 = 15.0;

/// A factor nearer to one than this is the calibration's or the model's mass, and no fault.
const MIN_LN_FACTOR: f64 = 0.1;

/// A factor nearer to one than this (a quarter), or a delay that turns the phase by less than this at the top of the band (rad), may still be the model's: a
/// support that it lacks answers as a factor of 1.1 to 1.2 or as 0.4 rad, and leaves a third to a half of the misfit, where a fault of the data leaves the
/// noise.
/// So the misfit with it is at most a share of that without, and beside another fault it is not believed.
const SMALL_LN_FACTOR: f64 = 0.22;
const SMALL_DELAY_PHASE_RAD: f64 = 0.5;
const MAX_MISFIT_RATIO_OF_SMALL: f64 = 0.25;

/// A delay that turns the phase by less than this at the top of the band (rad) is a filter's, and no fault.
const MIN_DELAY_PHASE_RAD: f64 = 0.2;

/// Misfit up to which data are explained: noise and a constant law leave as much, and the rows of a neighbourhood cannot be distinguished by it.
pub(super) const EXPLAINED_MISFIT: f64 = 0.04;

/// Changes of a single sensor that a second change is added to, and second changes that are fitted for each first one.
const MAX_FIRST_OF_ONE_SENSOR: usize = 4;
const MAX_SECOND_CHANGES: usize = 6;

/// Points of the grid at which second changes are compared.
const SECOND_CHANGE_POINTS: usize = 200;

/// A fault that is no change of values: another row, another axis.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Elsewhere {
    pub(super) fault: Fault,
    pub(super) sensors: Vec<usize>,
    /// ln of the number of others that were tried.
    pub(super) cost: f64,
}

/// Faults together, and the misfit with them.
#[derive(Debug, Clone)]
pub(super) struct Explanation {
    pub(super) edits: Vec<Edit>,
    pub(super) elsewhere: Vec<Elsewhere>,
    pub(super) data_hypothesis: DataHypothesis,
    pub(super) fitted: Fitted,
    /// −ln likelihood with the price of every free number and of every choice among changes.
    pub(super) nats: f64,
}

impl Explanation {
    /// Whether nothing but the sense of values, or that of their phase, is wrong.
    pub(super) fn is_of_sense(&self) -> bool {
        let is_sense = |edit: &Edit| matches!(edit.change, Change::Reversed | Change::Conjugated);
        self.elsewhere.is_empty() && self.edits.iter().all(is_sense)
    }

    /// Data as they are.
    pub(super) fn as_given(data_hypothesis: DataHypothesis, fitted: Fitted) -> Self {
        Self { edits: Vec::new(), elsewhere: Vec::new(), data_hypothesis, nats: fitted.nats, fitted }
    }

    /// How many faults it has.
    pub(super) fn faults(&self) -> usize {
        self.edits.len() + self.elsewhere.len()
    }

    /// The least log-likelihood ratio to the best other explanation with which it is believed.
    pub(super) fn min_margin(&self) -> f64 {
        MIN_MARGIN_NATS * self.faults() as f64
    }

    /// With one more change of values.
    pub(super) fn changed_by(&self, edit: &Edit, fitted: Fitted) -> Self {
        let cost = (self.data_hypothesis.edits().len().max(1) as f64).ln();
        self.with(edit, self.data_hypothesis.with(edit), fitted, cost)
    }

    /// With a fault that is no change of values.
    pub(super) fn and(&self, elsewhere: Elsewhere, fitted: Fitted) -> Self {
        let nats = fitted.nats + self.cost() + elsewhere.cost;
        let elsewhere = self.elsewhere.iter().cloned().chain([elsewhere]).collect();
        Self { elsewhere, fitted, nats, ..self.clone() }
    }

    fn with(&self, edit: &Edit, data_hypothesis: DataHypothesis, fitted: Fitted, cost: f64) -> Self {
        let edits = self.edits.iter().chain([edit]).cloned().collect();
        let nats = fitted.nats + self.cost() + cost;
        Self { edits, elsewhere: self.elsewhere.clone(), data_hypothesis, fitted, nats }
    }

    fn cost(&self) -> f64 {
        self.nats - self.fitted.nats
    }

    /// Whether it explains what another one does not, by so many nats: of all sensors, or of those that its faults concern.
    fn improves_on(&self, other: &Self, nats: f64) -> bool {
        let falls = |after: f64, before: f64| after <= MAX_MISFIT_RATIO * before;
        let of_all = falls(self.fitted.misfit.sigma, other.fitted.misfit.sigma);
        let own = |sensors: &[usize]| falls(self.fitted.misfit_of(sensors), other.fitted.misfit_of(sensors));
        let new = self.edits_beside(other).map(|edit| &edit.sensors);
        let elsewhere = self.elsewhere.iter().filter(|one| !other.has(one)).map(|one| &one.sensors);
        let is_of_concerned = new.chain(elsewhere).any(|sensors| own(sensors));
        other.nats - self.nats >= nats && (of_all || is_of_concerned)
    }

    /// Changes of values that another one does not have.
    fn edits_beside(&self, other: &Self) -> impl Iterator<Item = &Edit> {
        self.edits.iter().filter(|edit| !other.edits.contains(edit))
    }

    /// Whether a change is a factor or a delay so small that an error of the model may answer alike.
    fn is_small(&self, edit: &Edit) -> bool {
        match edit.change {
            Change::Factor => self.fitted.ln_factor.abs() < SMALL_LN_FACTOR,
            Change::Delay => self.fitted.delay_phase_rad.abs() < SMALL_DELAY_PHASE_RAD,
            _ => false,
        }
    }

    /// Whether it has a small change that leaves as much as a model does that is wrong.
    fn is_of_model(&self, as_given: &Self) -> bool {
        self.edits.iter().filter(|edit| self.is_small(edit)).any(|edit| {
            let [left, before] = [self, as_given].map(|one| one.fitted.misfit_of(&edit.sensors));
            left > MAX_MISFIT_RATIO_OF_SMALL * before
        })
    }

    /// Whether the misfit, of all sensors and of those that its faults concern, is small enough for an explanation.
    fn is_explanation(&self) -> bool {
        let of_all = self.fitted.misfit.sigma;
        let of_concerned = MAX_CONCERNED_LEFT.max(MAX_CONCERNED_OVER_ALL * of_all).min(MAX_MISFIT_LEFT);
        of_all <= MAX_MISFIT_LEFT && self.left() <= of_concerned.max(of_all)
    }

    /// The largest misfit of all sensors, or of those of a fault that concerns not all of them.
    fn left(&self) -> f64 {
        let of_edits = self.edits.iter().map(|edit| &edit.sensors);
        let concerned = of_edits.chain(self.elsewhere.iter().map(|one| &one.sensors));
        let some = concerned.filter(|sensors| sensors.len() < self.fitted.own.len());
        some.map(|sensors| self.fitted.misfit_of(sensors)).fold(self.fitted.misfit.sigma, f64::max)
    }

    /// The number with a name that its factor is, as near as a factor is known by these data: a model that does not fit well knows none well.
    pub(super) fn known_factor(&self, relative_std: f64) -> Option<KnownFactor> {
        let unknown = 3.0 * relative_std + 0.5 * self.fitted.misfit.sigma;
        KnownFactor::nearest(self.fitted.ln_factor, KNOWN_FACTOR_RTOL + unknown)
    }

    /// Whether it needs a factor without a name: with a second fault beside it, that fits too much.
    pub(super) fn has_unnamed_factor(&self) -> bool {
        let least_std = self.fitted.misfit.sigma / (self.fitted.values.max(1) as f64).sqrt();
        self.edits.iter().any(|edit| edit.change == Change::Factor) && self.known_factor(least_std).is_none()
    }

    /// Whether it has all faults of another one but its k-th.
    pub(super) fn is_without(&self, other: &Self, k: usize) -> bool {
        let mut without = other.clone();
        match k.checked_sub(other.edits.len()) {
            None => drop(without.edits.remove(k)),
            Some(k) => drop(without.elsewhere.remove(k)),
        }
        self.faults() == without.faults() && self.has_all_of(&without)
    }

    /// Whether it has all faults of another one.
    fn has_all_of(&self, other: &Self) -> bool {
        other.edits.iter().all(|edit| self.edits.contains(edit))
            && other.elsewhere.iter().all(|elsewhere| self.has(elsewhere))
    }

    /// Whether it has a fault of this kind and of these sensors.
    fn has(&self, elsewhere: &Elsewhere) -> bool {
        let same =
            |own: &Elsewhere| own.fault.is_same_kind(&elsewhere.fault) && own.sensors == elsewhere.sensors;
        self.elsewhere.iter().any(same)
    }
}

/// An explanation that is believed, or those between which the data do not decide.
pub(super) struct Choice<'e> {
    /// The likeliest.
    pub(super) best: &'e Explanation,
    /// The likeliest that is another one, and by how many nats it is less likely.
    pub(super) rival: Option<(&'e Explanation, f64)>,
}

impl Choice<'_> {
    /// Whether the data know it from every other one.
    pub(super) fn is_certain(&self) -> bool {
        self.rival.is_none_or(|(_, behind)| behind >= self.best.min_margin())
    }
}

/// The likeliest explanation that is a finding: of one fault, or of two where no single one leaves as little.
pub(super) fn choose<'e>(as_given: &'e Explanation, tried: &'e [Explanation]) -> Option<Choice<'e>> {
    let likeliest =
        |of: &mut dyn Iterator<Item = &'e Explanation>| of.min_by(|a, b| a.nats.total_cmp(&b.nats));
    let of_faults = |count: usize| tried.iter().filter(move |one| one.faults() == count);
    let explains = |one: &&Explanation| one.improves_on(as_given, FINDING_NATS) && one.is_explanation();
    let single = likeliest(&mut of_faults(1).filter(explains).filter(|one| !one.is_of_model(as_given)));
    // The likeliest single fault, whether or not it is a finding, or the data as given if no fault is likelier.
    let base = likeliest(&mut of_faults(1).chain([as_given])).unwrap_or(as_given);
    let is_second = |one: &&Explanation| {
        let is_free = |edit: &Edit| edit.change == Change::Delay;
        let is_unnamed = one.has_unnamed_factor();
        let nats = match is_unnamed || one.edits.iter().any(is_free) {
            true => SECOND_FREE_FINDING_NATS,
            false => SECOND_FINDING_NATS,
        };
        let is_plain = !is_unnamed
            || one.left() <= EXPLAINED_MISFIT && one.fitted.ln_factor.abs() <= MAX_UNNAMED_LN_FACTOR;
        // What is small beside a fault is looked at when that is mended.
        let is_small = one.edits_beside(base).any(|edit| one.is_small(edit));
        is_plain && !is_small && one.improves_on(base, nats)
    };
    let pair = likeliest(&mut of_faults(2).filter(explains).filter(is_second));
    let best = pair.or(single)?;
    let others = tried.iter().filter(|one| !one.has_all_of(best) && one.improves_on(as_given, FINDING_NATS));
    let rival = likeliest(&mut others.filter(|one| one.faults() <= best.faults()));
    Some(Choice { best, rival: rival.map(|rival| (rival, rival.nats - best.nats)) })
}

/// All single changes of values, then pairs where no single one explains the data.
pub(super) fn changes(search: &Search<'_, '_>, grid: &Grid, as_given: &Explanation) -> Vec<Explanation> {
    // What the moduli explain needs no fault: one that data show leaves more.
    if as_given.fitted.worst() <= EXPLAINED_MISFIT {
        return Vec::new();
    }
    let mut tried = single_changes(search, grid, as_given);
    let mut order: Vec<usize> = (0..tried.len()).collect();
    order.sort_by(|&a, &b| tried[a].nats.total_cmp(&tried[b].nats));
    let is_finding = |&&k: &&usize| tried[k].improves_on(as_given, FINDING_NATS) && is_large(&tried[k]);
    let found = order.iter().find(is_finding).copied();
    let left = found.map(|k| tried[k].fitted.worst());
    let firsts: Vec<usize> = match left {
        Some(left) if MAX_MISFIT_RATIO * left < misfit::MIN_MISFIT => Vec::new(),
        // What a single fault explains may have another one beside it.
        Some(left) if left <= EXPLAINED_MISFIT => found.into_iter().collect(),
        _ => {
            let all = as_given.data_hypothesis.sensors();
            let of_all = |&&k: &&usize| tried[k].edits[0].sensors.len() == all;
            let few = order.iter().filter(|k| !of_all(k)).take(MAX_FIRST_OF_ONE_SENSOR);
            order.iter().filter(of_all).chain(few).copied().collect()
        }
    };
    let pairs = pairs(search, grid, as_given, &tried, &firsts);
    tried.extend(pairs);
    tried.retain(is_large);
    tried
}

/// All single changes of values beside what is wrong already.
pub(super) fn single_changes(search: &Search<'_, '_>, grid: &Grid, beside: &Explanation) -> Vec<Explanation> {
    let edits = beside.data_hypothesis.edits();
    map(search.for_each, edits.len(), |k| {
        let fitted = search.fit(&beside.data_hypothesis.with(&edits[k]), grid, &[&beside.fitted]);
        beside.changed_by(&edits[k], fitted)
    })
}

/// Second changes beside some single ones.
fn pairs(
    search: &Search<'_, '_>,
    grid: &Grid,
    as_given: &Explanation,
    singles: &[Explanation],
    firsts: &[usize],
) -> Vec<Explanation> {
    let cost = (singles.len().max(1) as f64).ln();
    let mut seen: Vec<DataHypothesis> =
        singles.iter().chain([as_given]).map(|one| one.data_hypothesis.clone()).collect();
    let mut found = Vec::new();
    for &first in firsts {
        let first = &singles[first];
        let seconds: Vec<(Edit, DataHypothesis)> = first
            .data_hypothesis
            .edits()
            .into_iter()
            .map(|edit| {
                let both = first.data_hypothesis.with(&edit);
                (edit, both)
            })
            .filter(|(_, both)| !seen.contains(both))
            .collect();
        let points = search.best_points(&first.data_hypothesis, grid, SECOND_CHANGE_POINTS);
        let scores = map(search.for_each, seconds.len(), |k| search.best_score(&seconds[k].1, grid, &points));
        let mut order: Vec<usize> = (0..seconds.len()).collect();
        order.sort_by(|&a, &b| scores[a].total_cmp(&scores[b]));
        order.truncate(MAX_SECOND_CHANGES);
        found.extend(map(search.for_each, order.len(), |k| {
            let (edit, both) = &seconds[order[k]];
            let fitted = search.fit(both, grid, &[&first.fitted]);
            first.with(edit, both.clone(), fitted, cost)
        }));
        seen.extend(order.iter().map(|&k| seconds[k].1.clone()));
    }
    found
}

/// Whether every factor and delay in it is large enough to be a fault.
pub(super) fn is_large(one: &Explanation) -> bool {
    let has = |change: Change| one.edits.iter().any(|edit| edit.change == change);
    let [factor, delay] = [has(Change::Factor), has(Change::Delay)];
    (!factor || one.fitted.ln_factor.abs() >= MIN_LN_FACTOR)
        && (!delay || one.fitted.delay_phase_rad.abs() >= MIN_DELAY_PHASE_RAD)
}

#[cfg(test)]
mod tests {
    use super::super::misfit::Misfit;
    use super::super::moduli::Moduli;
    use super::*;
    use crate::quantity::Quantity;

    /// With changes of sensors, so many nats and this misfit of two sensors.
    fn explanation(edits: &[(Change, &[usize])], nats: f64, own: [f64; 2]) -> Explanation {
        let given = DataHypothesis::as_given(&[Quantity::Receptance; 2], 0.0);
        let edits: Vec<Edit> =
            edits.iter().map(|(change, of)| Edit { change: change.clone(), sensors: of.to_vec() }).collect();
        let data_hypothesis = edits.iter().fold(given, |given, edit| given.with(edit));
        let moduli = Moduli { ln_sizes: vec![0.0], ln_loss: 0.0, slope: 0.0, loss_slope: 0.0 };
        let misfit = Misfit { nats, sigma: own[0].min(own[1]) };
        // A factor has a name: in g.
        let ln_factor = KnownFactor::StandardGravity.value().ln();
        let fitted = Fitted {
            moduli,
            ln_factor,
            delay_s: 0.0,
            delay_phase_rad: 0.0,
            misfit,
            values: 80,
            own: own.to_vec(),
            nats,
        };
        Explanation { edits, elsewhere: Vec::new(), data_hypothesis, fitted, nats }
    }

    const ALL: &[usize] = &[0, 1];

    #[test]
    fn a_pair_is_believed_where_no_single_one_leaves_as_little() {
        let given = explanation(&[], 100.0, [1.0; 2]);
        let sign = explanation(&[(Change::Reversed, ALL)], 98.0, [0.9; 2]);
        let factor = explanation(&[(Change::Factor, ALL)], 95.0, [0.8; 2]);
        let both = explanation(&[(Change::Reversed, ALL), (Change::Factor, ALL)], 20.0, [0.1; 2]);
        let tried = [sign, factor, both];
        let choice = choose(&given, &tried).unwrap();
        assert_eq!(choice.best.edits, tried[2].edits);
        assert!(choice.is_certain() && choice.rival.is_none());
        // A factor without a name beside another fault fits too much.
        let mut unnamed = tried.clone();
        unnamed[2].fitted.ln_factor = 3f64.ln();
        assert!(choose(&given, &unnamed).is_none());
        // A second change that helps little is no finding.
        let alone = explanation(&[(Change::Reversed, ALL)], 20.0, [0.1; 2]);
        let little = explanation(&[(Change::Reversed, ALL), (Change::Delay, ALL)], 10.0, [0.09; 2]);
        assert_eq!(choose(&given, &[little, alone]).unwrap().best.faults(), 1);
        assert!(choose(&given, &tried[..2]).is_none());
    }

    #[test]
    fn what_another_explanation_does_as_well_is_not_decided() {
        let given = explanation(&[], 100.0, [1.0; 2]);
        let late = explanation(&[(Change::Delay, ALL)], 20.0, [0.1; 2]);
        let conjugated = explanation(&[(Change::Conjugated, ALL)], 20.0 + 0.9 * MIN_MARGIN_NATS, [0.1; 2]);
        let tried = [late.clone(), conjugated.clone()];
        let choice = choose(&given, &tried).unwrap();
        assert!(!choice.is_certain());
        assert_eq!(choice.rival.unwrap().0.edits, conjugated.edits);
        // More of the same is not another explanation.
        let more = explanation(&[(Change::Delay, ALL), (Change::Reversed, &[1])], 19.0, [0.1; 2]);
        assert!(choose(&given, &[late, more]).unwrap().is_certain());
    }

    #[test]
    fn a_fault_of_one_sensor_is_seen_beside_sensors_that_hide_it() {
        // The misfit of all is that of most: it is as small before.
        let given = explanation(&[], 100.0, [0.01, 1.0]);
        let of_one = explanation(&[(Change::Reversed, &[1])], 50.0, [0.01, 0.02]);
        assert_eq!(choose(&given, std::slice::from_ref(&of_one)).unwrap().best.edits, of_one.edits);
        let of_other = explanation(&[(Change::Reversed, &[0])], 80.0, [0.01, 1.0]);
        assert!(choose(&given, &[of_other]).is_none());
    }

    #[test]
    fn a_small_factor_is_believed_only_where_it_leaves_next_to_nothing() {
        let given = explanation(&[], 500.0, [0.14; 2]);
        let factor = |ln_factor: f64, left: f64| {
            let mut factor = explanation(&[(Change::Factor, &[1])], 20.0, [left; 2]);
            factor.fitted.ln_factor = ln_factor;
            factor
        };
        let is_believed = |one: Explanation| choose(&given, &[one]).is_some();
        assert!(is_believed(factor(1.19f64.ln(), 0.02)));
        // A support that the model lacks leaves more.
        assert!(!is_believed(factor(1.19f64.ln(), 0.06)));
        assert!(is_believed(factor(1.5f64.ln(), 0.06)));
        let delay = |phase: f64| {
            let mut delay = explanation(&[(Change::Delay, &[1])], 20.0, [0.06; 2]);
            delay.fitted.delay_phase_rad = phase;
            delay
        };
        assert!(!is_believed(delay(0.4)));
        assert!(is_believed(delay(-0.8)));
    }
}
