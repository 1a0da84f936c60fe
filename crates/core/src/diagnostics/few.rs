//! Few sensors, all fitted together: the faults that explain what the moduli alone do not.

use super::Depth;
use super::by_modes::moduli_by_modes;
use super::data_hypothesis::{Change, DataHypothesis, DofMismatch, Edit, ln_over_receptance};
use super::dof_mismatch::{Case, Tried, dof_mismatch};
use super::explanation::{self, Choice, EXPLAINED_MISFIT, Elsewhere, Explanation, choose};
use super::finding::{Diagnosis, Evidence, Fault, Finding, NotJudged, OtherExplanation, OtherRow};
use super::mesh;
use super::moduli::{Moduli, Parametrization};
use super::responses::{Responses, over_the_box, trained};
use super::row_pairs::row_pairs;
use super::rows::{LoadScan, Rows, driven_row, sweep};
use super::search::{Fitted, Grid, Search, Written};
use crate::c64;
use crate::for_each::{ForEach, map};
use crate::identify::{Options, Problem};
use crate::material::OutsideTable;
use crate::model::Experiment;
use crate::quantity::Quantity;
use crate::response::Work;
use crate::subspace::Subspace;
use std::cell::Cell;
use std::f64::consts::TAU;

/// Rows as likely as the best within this cannot be distinguished from it.
const EQUAL_NATS: f64 = 3.0;

/// Values at fewer than this explain nothing: three numbers of the modulus, two of a change, and as many again to judge by.
const MIN_VALUES: usize = 8;

/// Frequencies that are looked at, for one unknown and for each further one, and values at most (they are fewer where there are many sensors).
const MAX_FREQUENCIES: usize = 40;
const MAX_FREQUENCIES_PER_UNKNOWN: usize = 10;
const MAX_VALUES: usize = 240;

/// Sensors for which another row is searched: those that agree least with the model.
const MAX_SUSPECTS: usize = 4;

/// Faults that are searched together: data with three faults mean a wrong model.
const MAX_FAULTS: usize = 2;

/// Explanations that are named where the data do not decide.
const MAX_UNDECIDED: usize = 4;

/// Nominal values that are powers of ten off are searched where the misfit is above this: a factor of 2. Of a sandwich whose core counts for
/// nothing its skins still leave 0.98.
const FAR_MISFIT: f64 = 0.7;

/// Powers of ten that are tried, to either side.
const MAX_POWER_OF_TEN: i32 = 7;

/// Frequencies beyond this multiple of those of rows that move alone are not compared.
const MAX_TOP_OVER_ROW: f64 = 2.0;

/// Modes serve moduli that differ from theirs by less than this in ln a: beyond, they are computed again.
const MODES_LN_RANGE: f64 = 0.05;

/// Another axis is tried where this misfit is left: five per cent, or three degrees.
const NOTABLE_MISFIT: f64 = 0.05;

/// The axis of a unit that is seldom taken for another one is tried where this is left: a factor of 1.3, or 17 degrees.
const LARGE_MISFIT: f64 = 0.3;

/// What is measured by some sensors.
#[derive(Clone, Copy)]
pub(super) struct Measured<'x> {
    pub(super) experiment: &'x Experiment,
    /// `[frequency][sensor]`.
    pub(super) receptance: &'x [Vec<c64>],
    pub(super) quantities: &'x [Quantity],
    /// Standard deviations of the receptances, where they are known.
    pub(super) std: Option<&'x [Vec<f64>]>,
}

/// Some sensors of what was measured.
pub(super) struct Part {
    experiment: Experiment,
    quantities: Vec<Quantity>,
    receptance: Vec<Vec<c64>>,
    std: Option<Vec<Vec<f64>>>,
}

impl Part {
    pub(super) fn of(measured: Measured<'_>, sensors: &[usize]) -> Self {
        let Measured { experiment, receptance, quantities, std } = measured;
        let of_sensors = |at: &Vec<f64>| sensors.iter().map(|&m| at[m]).collect();
        Self {
            std: std.map(|std| std.iter().map(of_sensors).collect()),
            experiment: Experiment {
                load: experiment.load.clone(),
                sensors: sensors.iter().map(|&m| experiment.sensors[m]).collect(),
            },
            quantities: sensors.iter().map(|&m| quantities[m]).collect(),
            receptance: receptance.iter().map(|at| sensors.iter().map(|&m| at[m]).collect()).collect(),
        }
    }

    pub(super) fn measured(&self) -> Measured<'_> {
        let Self { experiment, quantities, receptance, std } = self;
        Measured { experiment, receptance, quantities, std: std.as_deref() }
    }
}

/// What answers for the sensors of a band.
#[derive(Clone)]
pub(super) struct Model<'x> {
    pub(super) problem: &'x Problem<'x>,
    /// A reduced model of the whole problem; without one, one is trained for the sensors.
    pub(super) trained: Option<&'x Subspace<'x>>,
    /// Which of the problem's sensors they are.
    pub(super) sensors: Vec<usize>,
    /// How far to look.
    pub(super) depth: Depth,
}

/// What the sensors of a band agree on.
pub(super) struct Agreed<'x, 'a> {
    pub(super) responses: &'x Responses<'a>,
    /// The frequencies of the band that are looked at.
    pub(super) picked: &'x [usize],
    /// The moduli, the factor and the delay.
    pub(super) fitted: &'x Fitted,
    /// The changes that were found, of all sensors.
    pub(super) edits: &'x [Edit],
}

/// [`super::diagnose`] of a few sensors. Where load, rows and axis are those of the case, `agreed` is then asked about what was found.
pub(super) fn look<T>(
    model: &Model<'_>,
    measured: Measured<'_>,
    options: &Options,
    for_each: ForEach<'_>,
    agreed: &dyn Fn(Agreed<'_, '_>) -> T,
) -> Result<(Diagnosis, Option<T>), OutsideTable> {
    let problem = model.problem;
    let all_hz = problem.frfs().frequency_hz;
    let unknowns = problem.unknowns().len();
    let most = MAX_FREQUENCIES + MAX_FREQUENCIES_PER_UNKNOWN * (unknowns - 1);
    let picked =
        looked_at(all_hz, measured, most.min((MAX_VALUES / measured.quantities.len().max(1)).max(12)));
    let frequency_hz: Vec<f64> = picked.iter().map(|&i| all_hz[i]).collect();
    let mut diagnosis = Diagnosis {
        findings: Vec::new(),
        others: Vec::new(),
        misfit: None,
        not_judged: None,
        frequencies: picked.len(),
        work: Work::default(),
    };
    let values = picked.iter().map(|&i| written(problem, measured, i)).collect();
    let written = Written { values, noise: picked.iter().map(|&i| noise(measured, i)).collect() };
    if written.values.iter().flatten().flatten().count() < MIN_VALUES {
        diagnosis.not_judged = Some(NotJudged::FewValues);
        return Ok((diagnosis, None));
    }
    let Some(parametrization) = Parametrization::new(problem, &frequency_hz, options)? else {
        diagnosis.not_judged = Some(NotJudged::Parameter);
        return Ok((diagnosis, None));
    };
    let own = match model.trained {
        None => {
            let moduli = over_the_box(&parametrization);
            trained(problem, measured.experiment, &frequency_hz, &parametrization, &moduli, for_each)?
        }
        Some(_) => None,
    };
    diagnosis.work = own.as_ref().map_or(Work::default(), Subspace::work);
    let Some(subspace) = model.trained.or(own.as_ref()) else {
        diagnosis.not_judged = Some(NotJudged::Breakdown);
        return Ok((diagnosis, None));
    };
    let sensors = match model.trained {
        None => (0..measured.quantities.len()).collect(),
        Some(_) => model.sensors.clone(),
    };
    let (depth, work) = (model.depth, Cell::default());
    let look = Look { problem, measured, options, for_each, written: &written, depth, work };
    let responses = |about: &Moduli| {
        let parametrization = (parametrization.clone(), about);
        Responses::new(problem, subspace, Vec::clone(&sensors), parametrization, &frequency_hz, for_each)
    };
    let Some(mut responses_there) = responses(&parametrization.nominal()) else {
        diagnosis.not_judged = Some(NotJudged::Breakdown);
        return Ok((diagnosis, None));
    };
    if responses_there.is_modal() {
        // The modes of the likeliest values, in place of those of the nominal ones.
        let likeliest = look.likeliest(&responses_there);
        let by_modes = if likeliest.misfit.sigma <= LARGE_MISFIT {
            None
        } else {
            let model = (subspace.projection(), &*sensors);
            moduli_by_modes(problem, model, measured, (&parametrization, &frequency_hz), for_each)
        };
        let moduli = by_modes.unwrap_or(likeliest.moduli);
        if moduli.ln_sizes.iter().any(|ln| ln.abs() > MODES_LN_RANGE)
            && let Some(nearer) = responses(&moduli)
        {
            responses_there = nearer;
        }
    }
    let (as_given, tried) = look.explanations(&responses_there)?;
    diagnosis.work += look.work.get();
    let search = look.search(&responses_there);
    let choice = choose(&as_given, &tried);
    let left = match &choice {
        Some(choice) if choice.is_certain() => choice.best,
        _ => &as_given,
    };
    if let Some(choice) = &choice {
        look.say(&search, choice, &as_given, &tried, &mut diagnosis);
    }
    diagnosis.misfit = Some(left.fitted.misfit.sigma);
    // A mesh is judged at the likeliest values, also where others are nearly as likely.
    let likeliest = choice.as_ref().map_or(&as_given, |choice| choice.best);
    let axis = likeliest.elsewhere.iter().find_map(|elsewhere| match elsewhere.fault {
        Fault::Axis { factor } => Some(factor),
        _ => None,
    });
    let top = frequency_hz.len() - 1;
    let values = parametrization.values(&likeliest.fitted.moduli, top);
    if let Ok(top) = problem.at(frequency_hz[top] / axis.unwrap_or(1.0), &values)
        && let Some(fault) = mesh::beyond_mesh(&top)
    {
        let sensors = (0..measured.quantities.len()).collect();
        diagnosis.findings.push(Finding { fault, sensors, evidence: None });
    }
    let common: Vec<Edit> =
        left.edits.iter().filter(|edit| edit.sensors.len() == measured.quantities.len()).cloned().collect();
    let own = left.elsewhere.is_empty().then(|| {
        agreed(Agreed { responses: &responses_there, picked: &picked, fitted: &left.fitted, edits: &common })
    });
    Ok((diagnosis, own))
}

/// Moduli, and how badly every row suits the load with each of them.
type Swept = (Vec<Moduli>, Vec<LoadScan>);

/// What is looked at.
struct Look<'x> {
    problem: &'x Problem<'x>,
    measured: Measured<'x>,
    options: &'x Options,
    for_each: ForEach<'x>,
    written: &'x Written,
    depth: Depth,
    /// What trainings beyond the first have cost.
    work: Cell<Work>,
}

impl Look<'_> {
    /// The likeliest moduli with data as they are or with one change of their values.
    fn likeliest(&self, responses: &Responses<'_>) -> Fitted {
        let search = self.search(responses);
        let grid = search.grid(self.measured.quantities.len());
        let as_given = self.as_given(&search, &grid);
        let tried = explanation::single_changes(&search, &grid, &as_given);
        choose(&as_given, &tried).map_or(&as_given, |choice| choice.best).fitted.clone()
    }

    fn search<'s, 'a>(&'s self, responses: &'s Responses<'a>) -> Search<'s, 'a> {
        Search { responses, written: self.written, for_each: self.for_each }
    }

    fn as_given(&self, search: &Search<'_, '_>, grid: &Grid) -> Explanation {
        let decay_per_s = self.problem.model().decay_per_s();
        let hypothesis = DataHypothesis::as_given(self.measured.quantities, decay_per_s);
        let fitted = search.fit(&hypothesis, grid, &[]);
        Explanation::as_given(hypothesis, fitted)
    }

    /// Data as they are, and everything that was tried.
    fn explanations(
        &self,
        responses: &Responses<'_>,
    ) -> Result<(Explanation, Vec<Explanation>), OutsideTable> {
        let search = self.search(responses);
        let grid = search.grid(self.measured.quantities.len());
        let as_given = self.as_given(&search, &grid);
        let mut tried = explanation::changes(&search, &grid, &as_given);
        // Another axis or row is searched only where nothing simpler explains the data.
        let left = |tried: &[Explanation], misfit: fn(&Fitted) -> f64| {
            tried.iter().chain([&as_given]).map(|one| misfit(&one.fitted)).fold(f64::INFINITY, f64::min)
        };
        // Nothing is accused before everything else was looked at.
        let [of_axis, of_rows] = match self.depth {
            Depth::Quick if choose(&as_given, &tried).is_none() => [LARGE_MISFIT; 2],
            Depth::Quick | Depth::Full => [NOTABLE_MISFIT, EXPLAINED_MISFIT],
        };
        if left(&tried, |fitted| fitted.misfit.sigma) > of_axis {
            tried.extend(self.axis(responses, &as_given, TAU, false).unwrap_or_default());
        }
        if left(&tried, Fitted::worst) > of_rows {
            let is_single = |one: &&Explanation| one.edits.len() == 1 && one.faults() == 1;
            let is_likely = |one: &&Explanation| as_given.nats - one.nats >= explanation::FINDING_NATS;
            let singles = tried.iter().filter(is_single).filter(is_likely);
            let likeliest = singles.min_by(|a, b| a.nats.total_cmp(&b.nats));
            let swept = self.swept(&search, &as_given);
            let mut rows = self.rows(&search, &grid, &as_given, &swept)?;
            if let Some(beside) = likeliest {
                rows.extend(self.rows(&search, &grid, beside, &self.swept(&search, beside))?);
            }
            tried.extend(rows.into_iter().filter(explanation::is_large));
            // A factor without a name beside another row fits what two other rows do.
            let is_plain = |one: &&Explanation| one.faults() < 2 || !one.has_unnamed_factor();
            let plain: Vec<Explanation> = tried.iter().filter(is_plain).cloned().collect();
            if left(&plain, Fitted::worst) > of_rows {
                tried.extend(self.row_pairs(&search, &as_given, &swept)?);
            }
        }
        // No stiffness turns a response round.
        let is_stiffness_like =
            |one: &Explanation| !one.is_of_sense() || one.fitted.misfit.sigma > NOTABLE_MISFIT;
        let is_accused = choose(&as_given, &tried).is_some_and(|choice| is_stiffness_like(choice.best));
        let is_full = self.depth == Depth::Full;
        if is_full && left(&tried, |fitted| fitted.misfit.sigma) > LARGE_MISFIT {
            tried.extend(self.axis(responses, &as_given, TAU, true).unwrap_or_default());
        }
        let is_far = is_full
            && as_given.fitted.misfit.sigma > FAR_MISFIT
            && left(&tried, |fitted| fitted.misfit.sigma) > NOTABLE_MISFIT;
        // What is accused may be a nominal value just beyond the box.
        let powers = if is_far { MAX_POWER_OF_TEN } else { i32::from(is_accused) };
        tried.extend(self.far_nominals(responses, &as_given, powers));
        // Higher frequencies have more modes, and cost most.
        if is_full && left(&tried, |fitted| fitted.misfit.sigma) > LARGE_MISFIT {
            tried.extend(self.axis(responses, &as_given, 1.0 / TAU, false).unwrap_or_default());
        }
        Ok((as_given, tried))
    }

    /// Another row for a sensor or for the load beside an explanation, and beside one more change of values where there are not too many faults.
    fn rows(
        &self,
        search: &Search<'_, '_>,
        grid: &Grid,
        beside: &Explanation,
        (moduli, loads): &Swept,
    ) -> Result<Vec<Explanation>, OutsideTable> {
        let of_sensors = self.moduli_of_other_rows(search, grid, beside, moduli);
        let hypothesis = &beside.data_hypothesis;
        let seconds = if beside.faults() + 1 < MAX_FAULTS { hypothesis.edits() } else { Vec::new() };
        let (rows, work) =
            dof_mismatch(search, self.case(), (hypothesis, &seconds), &of_sensors, (moduli, loads))?;
        self.spent(work);
        Ok(self.explanations_by_rows(beside, &rows))
    }

    /// How badly every row suits the load, with moduli of the whole box.
    fn swept(&self, search: &Search<'_, '_>, beside: &Explanation) -> Swept {
        let (experiment, data_hypothesis) = (self.measured.experiment, &beside.data_hypothesis);
        let moduli = sweep(search.responses, &beside.fitted.moduli);
        let rows = Rows { search, experiment, data_hypothesis };
        // A load on several rows is not searched.
        let count = if driven_row(experiment).is_some() { moduli.len() } else { 0 };
        let loads = map(self.for_each, count, |l| rows.scan_load(&moduli[l]));
        (moduli, loads)
    }

    /// Two other rows at once.
    fn row_pairs(
        &self,
        search: &Search<'_, '_>,
        as_given: &Explanation,
        (moduli, loads): &Swept,
    ) -> Result<Vec<Explanation>, OutsideTable> {
        let (rows, work) = row_pairs(search, self.case(), &as_given.data_hypothesis, (moduli, loads))?;
        self.spent(work);
        Ok(self.explanations_by_rows(as_given, &rows))
    }

    fn explanations_by_rows(&self, beside: &Explanation, rows: &[Tried]) -> Vec<Explanation> {
        let explanation = |(elsewhere, second, fitted): (Vec<Elsewhere>, Option<Edit>, Fitted)| {
            let first = match second {
                None => beside.clone(),
                Some(edit) => beside.changed_by(&edit, fitted.clone()),
            };
            elsewhere.into_iter().fold(first, |one, elsewhere| one.and(elsewhere, fitted.clone()))
        };
        likeliest_rows(rows, self.problem.model().dim()).into_iter().map(explanation).collect()
    }

    fn case(&self) -> Case<'_> {
        Case { problem: self.problem, experiment: self.measured.experiment, options: self.options }
    }

    fn spent(&self, work: Work) {
        let mut sum = self.work.get();
        sum += work;
        self.work.set(sum);
    }

    /// The same data at frequencies that are smaller by a factor: as they are, with one change, and with another row where this alone explains more, or everything is tried.
    fn axis(
        &self,
        responses: &Responses<'_>,
        as_given: &Explanation,
        factor: f64,
        is_everything: bool,
    ) -> Option<Vec<Explanation>> {
        let frequency_hz: Vec<f64> = responses.frequency_hz.iter().map(|f| f / factor).collect();
        let parametrization = Parametrization::new(self.problem, &frequency_hz, self.options).ok()??;
        let (fault, cost) = (Fault::Axis { factor }, 2f64.ln());
        self.with_other_responses(&frequency_hz, parametrization, &mut |search| {
            let grid = search.grid(self.measured.quantities.len());
            let fitted = search.fit(&as_given.data_hypothesis, &grid, &[]);
            let alone = as_given.and(Elsewhere { fault: fault.clone(), sensors: self.all(), cost }, fitted);
            let mut tried = explanation::single_changes(search, &grid, &alone);
            if is_everything || alone.fitted.misfit.sigma < as_given.fitted.misfit.sigma {
                tried.extend(self.rows(search, &grid, &alone, &self.swept(search, &alone)).ok()?);
            }
            tried.push(alone);
            tried.retain(|one| one.faults() <= MAX_FAULTS && explanation::is_large(one));
            Some(tried)
        })
    }

    /// The same data with all nominal values up to so many powers of ten off: another unit, or a zero too many.
    fn far_nominals(
        &self,
        responses: &Responses<'_>,
        as_given: &Explanation,
        powers: i32,
    ) -> Vec<Explanation> {
        let mut tried = Vec::new();
        for power in (1..=powers).flat_map(|power| [power, -power]) {
            let centre = f64::from(power) * std::f64::consts::LN_10;
            let Some(parametrization) = responses.parametrization.about(centre) else { continue };
            let one = self.with_other_responses(&responses.frequency_hz, parametrization, &mut |search| {
                let grid = search.grid(self.measured.quantities.len());
                let fitted = search.fit(&as_given.data_hypothesis, &grid, &[]);
                let first = search.responses.parametrization.free().next()?.0;
                let fault = Fault::Nominal { ratio: fitted.moduli.ln_sizes[first].exp() };
                let cost = f64::from(2 * MAX_POWER_OF_TEN).ln();
                Some(as_given.and(Elsewhere { fault, sensors: self.all(), cost }, fitted))
            });
            tried.extend(one);
        }
        tried
    }

    fn all(&self) -> Vec<usize> {
        (0..self.measured.quantities.len()).collect()
    }

    /// Trains a model at these frequencies and moduli, and hands a search on it to `found`. `None` where no model can be trained, or the
    /// band is far beyond the mesh.
    fn with_other_responses<T>(
        &self,
        frequency_hz: &[f64],
        parametrization: Parametrization,
        found: &mut dyn FnMut(&Search<'_, '_>) -> Option<T>,
    ) -> Option<T> {
        let (problem, experiment) = (self.problem, self.measured.experiment);
        let moduli = over_the_box(&parametrization);
        let about = moduli[moduli.len() / 2].clone();
        let top = frequency_hz.len() - 1;
        let values = parametrization.values(&about, top);
        // A band far beyond the mesh cannot be compared, and costs most.
        let mesh = mesh::beyond_mesh(&problem.at(frequency_hz[top], &values).ok()?);
        if matches!(mesh, Some(Fault::Mesh { row_hz, top_hz }) if top_hz > MAX_TOP_OVER_ROW * row_hz) {
            return None;
        }
        let subspace =
            trained(problem, experiment, frequency_hz, &parametrization, &moduli, self.for_each).ok()??;
        self.spent(subspace.work());
        let parametrization = (parametrization, &about);
        let there =
            Responses::new(problem, &subspace, self.all(), parametrization, frequency_hz, self.for_each)?;
        found(&Search { responses: &there, written: self.written, for_each: self.for_each })
    }

    /// Moduli with which rows are compared, for each sensor that agrees least: those of the other sensors, or all of the box.
    fn moduli_of_other_rows(
        &self,
        search: &Search<'_, '_>,
        grid: &Grid,
        beside: &Explanation,
        all: &[Moduli],
    ) -> Vec<(usize, Vec<Moduli>)> {
        let hypothesis = &beside.data_hypothesis;
        let mut suspects: Vec<usize> = (0..hypothesis.sensors()).collect();
        suspects.sort_by(|&a, &b| beside.fitted.own[b].total_cmp(&beside.fitted.own[a]));
        suspects.truncate(MAX_SUSPECTS);
        let without = |m: usize| {
            if hypothesis.sensors() == 1 {
                return all.to_vec();
            }
            let others = search.written.without(m);
            let known = Search { written: &others, ..*search }.fit(hypothesis, grid, &[]).moduli;
            vec![known, beside.fitted.moduli.clone()]
        };
        suspects.into_iter().map(|m| (m, without(m))).collect()
    }

    /// Findings where the data are certain of them, what else would explain the data, or what they do not decide between.
    fn say(
        &self,
        search: &Search<'_, '_>,
        choice: &Choice<'_>,
        as_given: &Explanation,
        tried: &[Explanation],
        diagnosis: &mut Diagnosis,
    ) {
        let best = choice.best;
        let other = |one: &Explanation, likeliest: f64| OtherExplanation {
            faults: faults(search, one),
            misfit: one.fitted.misfit.sigma,
            nats_behind: one.nats - likeliest,
        };
        if !choice.is_certain() {
            let near = |one: &&Explanation| {
                one.faults() <= best.faults() && one.nats - best.nats < best.min_margin()
            };
            let mut undecided: Vec<&Explanation> = tried.iter().filter(near).collect();
            undecided.sort_by(|a, b| a.nats.total_cmp(&b.nats));
            // The simplest one, against which all are held, need not be the likeliest.
            let likeliest = undecided.first().map_or(best.nats, |one| one.nats);
            let others = undecided.into_iter().take(MAX_UNDECIDED);
            diagnosis.others = others.map(|one| other(one, likeliest)).collect();
            return;
        }
        let all = faults(search, best);
        for (k, (fault, sensors)) in all.into_iter().enumerate() {
            let is_without =
                |one: &&Explanation| one.faults() + 1 == best.faults() && one.is_without(best, k);
            let before = tried.iter().find(is_without).unwrap_or(as_given);
            let evidence = Evidence {
                before: before.fitted.misfit_of(&sensors),
                after: best.fitted.misfit_of(&sensors),
                nats: before.nats - best.nats,
                margin: choice.rival.map(|(_, behind)| behind),
            };
            diagnosis.findings.push(Finding { fault, sensors, evidence: Some(evidence) });
        }
        diagnosis.others = choice.rival.map(|(rival, _)| other(rival, best.nats)).into_iter().collect();
    }
}

/// Frequencies to look at: half of them where the response is largest among its neighbours (there it depends on damping), the others evenly spaced, ascending.
fn looked_at(frequency_hz: &[f64], measured: Measured<'_>, most: usize) -> Vec<usize> {
    let usable: Vec<usize> = (0..frequency_hz.len()).filter(|&i| frequency_hz[i] > 0.0).collect();
    if usable.len() <= most {
        return usable;
    }
    let size = |i: usize, m: usize| measured.receptance[i][m].norm();
    let mut peaks: Vec<(f64, usize)> = Vec::new();
    for m in 0..measured.quantities.len() {
        for around in usable.windows(3) {
            let [a, b, c] = [0, 1, 2].map(|k| size(around[k], m));
            if b > a && b > c {
                peaks.push((b / (0.5 * (a + c)), around[1]));
            }
        }
    }
    peaks.sort_by(|a, b| b.0.total_cmp(&a.0));
    let mut picked: Vec<usize> = Vec::new();
    for (_, i) in peaks {
        if picked.len() < most / 2 && !picked.contains(&i) {
            picked.push(i);
        }
    }
    let even = most - picked.len();
    picked.extend((0..even).map(|k| usable[k * (usable.len() - 1) / (even - 1).max(1)]));
    picked.sort_unstable();
    picked.dedup();
    picked
}

/// ln of the values as they were written, at one frequency.
pub(super) fn written(problem: &Problem<'_>, measured: Measured<'_>, i: usize) -> Vec<Option<c64>> {
    let (frequency_hz, decay_per_s) = (problem.frfs().frequency_hz[i], problem.model().decay_per_s());
    let values = measured.receptance[i].iter().zip(measured.quantities);
    values
        .map(|(u, &quantity)| Some(u.ln() + ln_over_receptance(quantity, frequency_hz, decay_per_s)))
        .map(|ln| ln.filter(|ln| ln.is_finite()))
        .collect()
}

/// The variance that known noise gives the real and the imaginary part of the logarithm of each value at one frequency; zero where it is not known.
pub(super) fn noise(measured: Measured<'_>, i: usize) -> Vec<f64> {
    let Some(std) = measured.std else { return vec![0.0; measured.quantities.len()] };
    let variance = |(x, std): (&c64, &f64)| 0.5 * (std / x.norm()).powi(2);
    let variances = measured.receptance[i].iter().zip(&std[i]).map(variance);
    variances.map(|variance| if variance.is_finite() { variance } else { 0.0 }).collect()
}

/// What an explanation says is wrong, and with which sensors.
fn faults(search: &Search<'_, '_>, one: &Explanation) -> Vec<(Fault, Vec<usize>)> {
    let of_edit = |edit: &Edit| (fault(search, one, edit), edit.sensors.clone());
    let elsewhere =
        one.elsewhere.iter().map(|elsewhere| (elsewhere.fault.clone(), elsewhere.sensors.clone()));
    one.edits.iter().map(of_edit).chain(elsewhere).collect()
}

/// What a change of values says.
fn fault(search: &Search<'_, '_>, one: &Explanation, edit: &Edit) -> Fault {
    let found = &one.fitted;
    // What is elsewhere is not among the responses of the search.
    let is_here = one.elsewhere.is_empty();
    let stds = || match is_here {
        true => search.standard_deviations(&one.data_hypothesis, found),
        false => [None; 2],
    };
    match &edit.change {
        Change::Conjugated => Fault::Conjugated,
        Change::Quantity { was, is } => {
            // As the case reads the values, with the modulus that came of reading them otherwise: a modulus with a slope of its own would hide part of it.
            let before = one.data_hypothesis.with(&Edit {
                change: Change::Quantity { was: *is, is: *was },
                sensors: edit.sensors.clone(),
            });
            let slope = if is_here { search.slope(&before, found, &edit.sensors) } else { None };
            let (slope, slope_std) = slope.unwrap_or((f64::NAN, f64::NAN));
            Fault::Quantity { taken_for: *was, is: *is, slope, slope_std }
        }
        Change::Factor => {
            let factor = found.ln_factor.exp();
            let relative_std = stds()[0].unwrap_or(0.0);
            let known = one.known_factor(relative_std);
            Fault::Factor { factor, relative_std, known }
        }
        Change::Delay => Fault::Delay { seconds: found.delay_s, std: stds()[1].unwrap_or(0.0) },
        Change::Reversed | Change::Column(..) => Fault::Sign,
    }
}

/// The likeliest rows of each sensor and of the load, of two of them, and beside each change of values, with those that cannot be distinguished from them.
fn likeliest_rows(rows: &[Tried], dim: usize) -> Vec<(Vec<Elsewhere>, Option<Edit>, Fitted)> {
    let is_load = |what: DofMismatch| matches!(what, DofMismatch::Load(_));
    let is_same = |a: &Tried, b: &Tried| {
        let concerns = |tried: &Tried| -> Vec<(bool, Vec<usize>)> {
            tried.places.iter().map(|(what, sensors)| (is_load(*what), sensors.clone())).collect()
        };
        a.second == b.second && concerns(a) == concerns(b)
    };
    let mut groups: Vec<Vec<&Tried>> = Vec::new();
    for tried in rows {
        match groups.iter_mut().find(|group| is_same(group[0], tried)) {
            Some(group) => group.push(tried),
            None => groups.push(vec![tried]),
        }
    }
    let likeliest = |mut same: Vec<&Tried>| {
        same.sort_by(|a, b| a.fitted.nats.total_cmp(&b.fitted.nats));
        let best = same[0];
        let alike: Vec<&Tried> =
            same.into_iter().take_while(|tried| tried.fitted.nats <= best.fitted.nats + EQUAL_NATS).collect();
        let elsewhere = |(k, (what, sensors)): (usize, &(DofMismatch, Vec<usize>))| {
            let mut rows: Vec<OtherRow> = Vec::new();
            for tried in &alike {
                let (DofMismatch::Response(row) | DofMismatch::Load(row)) = tried.places[k].0;
                if rows.iter().all(|other| other.row != row) {
                    rows.push(OtherRow { row, misfit: tried.fitted.misfit.sigma });
                }
            }
            let fault = if is_load(*what) { Fault::LoadDof { rows } } else { Fault::ResponseDof { rows } };
            // As many rows were tried as there are.
            Elsewhere { fault, sensors: sensors.clone(), cost: (dim.max(1) as f64).ln() }
        };
        let elsewhere = best.places.iter().enumerate().map(elsewhere).collect();
        (elsewhere, best.second.clone(), best.fitted.clone())
    };
    groups.into_iter().map(likeliest).collect()
}
