//! What is wrong with data against a model, in words that name what to change, before anything is identified.
//!
//! The modulus is not known yet. So every way to read the data is judged after the likeliest modulus for it: the nominal times a number, with a slope over log ω
//! and a damping of its own (three numbers), within the bounds and a factor of four. One subspace for the whole box (B-3) answers for all moduli: at each of some forty
//! frequencies its response is a sum over poles, x_m(c) = Σ_k ρ_mk/(1 + cλ_k). What is compared are residuals ln(measured/model), magnitude and phase together, by the
//! likelihood of Student's distribution with a scale that is free (`misfit`), and by what BIC takes for each free number.
//!
//! A change is a finding where it is likelier than the data as they are by [`MARGIN`] and leaves a misfit that is smaller by [`FALL`]; then a second change is looked for with
//! the first in force, and a third is not: who finds three faults has the wrong model.
//!
//! # Limits
//! Load and response that are swapped give the same FRF (reciprocity), so that nobody can tell. A factor of all sensors and the modulus are one where nothing but stiffness
//! answers (a clamped structure below its first resonance), and then nothing is said. A conjugated FRF is told by damping that shows; where it is less than the noise, nothing is said.
//! A dof is one of several where neighbours or mirror images answer alike: all of them are named. Faults that depend on frequency (a filter, a mounting resonance) are not looked for.

mod data_hypothesis;
mod dof_mismatch;
mod finding;
mod many;
mod mesh;
mod misfit;
mod responses;
mod search;

pub use finding::{Evidence, Fault, Finding, KnownFactor, NAMED_WITHIN, NotJudged, OtherRow};

use crate::c64;
use crate::for_each::{ForEach, map};
use crate::identify::{Band, Context, Options, Problem, ProblemError, ReducedBand};
use crate::material::OutsideTable;
use crate::quantity::Quantity;
use crate::response::Work;
use crate::subspace::Subspace;
use data_hypothesis::{Change, DataHypothesis, DofMismatch, Edit, ln_over_receptance};
use dof_mismatch::{Tried, dof_mismatch, sweep};
use responses::{Parametrization, Responses, trained};
use search::{Fitted, Grid, Search, Written};

/// What came of looking at the data.
#[derive(Debug, Clone, PartialEq)]
pub struct Diagnosis {
    /// What is wrong, the mesh last; empty where nothing is.
    pub findings: Vec<Finding>,
    /// Robust deviation of ln(measured/model), real and imaginary part each, with the likeliest modulus and all findings; `None` where it was not judged.
    pub misfit: Option<f64>,
    /// Why the data were not judged, if they were not.
    pub not_judged: Option<NotJudged>,
    /// Frequencies that were looked at.
    pub frequencies: usize,
    /// Work of size N.
    pub work: Work,
}

/// By how much a finding must be likelier, natural logarithm: some thirty changes are tried (e^3.4), and neighbouring residuals are not independent: what is left of a law
/// that is no power may move several of them together.
pub const MARGIN: f64 = 15.0;

/// The misfit with a finding over that without, at most. A factor, a delay or another row can fit a little of whatever is wrong; what they are the reason of falls to the noise.
pub const FALL: f64 = 0.6;

/// A factor nearer to one than this is the calibration's or the model's mass, and no fault.
const LEAST_FACTOR: f64 = 0.1;

/// A delay that turns the phase by less than this at the top of the band (rad) is a filter's, and no fault.
const LEAST_PHASE: f64 = 0.2;

/// A factor or delay of fewer deviations than this is none.
const SIGNIFICANT: f64 = 5.0;

/// Misfit up to which data are explained: noise and a constant law leave as much, and the rows of a neighbourhood are not to be told by it.
const EXPLAINED: f64 = 0.04;

/// Readings as likely as the best within this: the one that is listed first is named.
const AS_LIKELY: f64 = 3.0;

/// Values at fewer than this explain nothing: three numbers of the modulus, two of a change, and as many again to judge by.
const LEAST_VALUES: usize = 8;

/// Frequencies that are looked at, and values at most (they are fewer where there are many sensors).
const FREQUENCIES: usize = 40;
const VALUES: usize = 240;

/// Findings at most.
const FINDINGS: usize = 2;

/// Looks for what is wrong with a band's data against its model; `quantities` says what each sensor's values were before they were made receptances.
///
/// Where the band is identified too, [`diagnose_on`] shares its reduced model.
///
/// Costs one real factorisation and some dozens of solves; two more where another row is looked for. Of more than twenty sensors that many are looked at
/// together, all others are compared with the modulus that they have, and those that differ most are looked at one by one: the cost beyond that of
/// twenty sensors is one product with the basis at each frequency, and one residual a sensor and frequency.
///
/// Of several unknowns each in turn is free with the others at their nominal values, and the one with the least misfit is
/// believed, if it explains the data to a misfit of 0.3.
///
/// # Errors
/// [`ProblemError`]: where there is not one quantity for each sensor, or an option does not belong to the problem.
///
/// # Limits
/// Several unknowns that are all far from their nominal values hide a fault. A factor that has no name (a unit, gravity) is not a
/// finding beside several unknowns: these may be off by as much.
pub fn diagnose(
    problem: &Problem<'_>,
    quantities: &[Quantity],
    options: &Options,
    for_each: ForEach<'_>,
) -> Result<Diagnosis, ProblemError> {
    diagnose_by(None, problem, quantities, options, for_each)
}

/// The same on a reduced model that is shared with [`identify_on`](crate::identify::identify_on), and trained now where it is not
/// yet: for all unknowns and sensors one, and no factorisation but where another row is looked for.
///
/// # Errors
/// As [`diagnose`].
pub fn diagnose_on<'a>(
    reduced: &mut ReducedBand<'a>,
    problem: &'a Problem<'a>,
    quantities: &[Quantity],
    options: &Options,
    for_each: ForEach<'_>,
) -> Result<Diagnosis, ProblemError> {
    let before = reduced.work();
    let context = Context { for_each, progress: &|_, _, _| {} };
    let trained = reduced.trained(problem, options, context)?;
    let mut found = diagnose_by(trained, problem, quantities, options, for_each)?;
    found.work += reduced.work().since(before);
    Ok(found)
}

fn diagnose_by(
    trained: Option<&Subspace<'_>>,
    problem: &Problem<'_>,
    quantities: &[Quantity],
    options: &Options,
    for_each: ForEach<'_>,
) -> Result<Diagnosis, ProblemError> {
    let sensors = problem.experiment().sensors.len();
    if quantities.len() != sensors {
        let (what, expected) = ("quantities".to_owned(), format!("{sensors}, one for each sensor"));
        return Err(ProblemError::Count { what, expected, found: quantities.len() });
    }
    let mut best: Option<Diagnosis> = None;
    let mut work = Work::default();
    for (j, unknown) in problem.unknowns().iter().enumerate() {
        let Some(parameter) = unknown.parameter() else { continue };
        let band = problem.band(&parameter);
        let model = Model { problem, unknown: j, trained, sensors: (0..sensors).collect() };
        let options = Options { bounds: unknown.bounds, real: unknown.real, ..*options };
        let mut found = match sensors > many::MOST_SENSORS {
            true => many::diagnose(&model, &band, quantities, &options, for_each)?,
            false => look(&model, &band, quantities, &options, for_each, &|_| ())?.0,
        };
        work += found.work;
        if problem.unknowns().len() > 1 {
            // What the other unknowns may be off by looks like a factor without a name.
            found.findings.retain(|finding| !matches!(finding.fault, Fault::Factor { known: None, .. }));
        }
        let misfit = |found: &Diagnosis| found.misfit.unwrap_or(f64::INFINITY);
        if best.as_ref().is_none_or(|best| misfit(&found) < misfit(best)) {
            best = Some(found);
        }
    }
    let several = problem.unknowns().len() > 1;
    let open = |found: &Diagnosis| several && found.misfit.is_some_and(|misfit| misfit > EXPLAINED_BY_ONE);
    Ok(match best {
        Some(found) if !open(&found) => Diagnosis { work, ..found },
        found => Diagnosis {
            findings: Vec::new(),
            misfit: found.as_ref().and_then(|found| found.misfit),
            not_judged: Some(NotJudged::SeveralUnknowns),
            frequencies: found.map_or(0, |found| found.frequencies),
            work,
        },
    })
}

/// A misfit up to which one free unknown beside others at their nominal values is believed: a factor of 1.3, or 17 degrees.
const EXPLAINED_BY_ONE: f64 = 0.3;

/// What answers for the sensors of a band.
#[derive(Clone)]
struct Model<'x> {
    problem: &'x Problem<'x>,
    /// Which unknown is free, with the others at their nominal values.
    unknown: usize,
    /// A reduced model of the whole problem; without one, one is trained for the sensors.
    trained: Option<&'x Subspace<'x>>,
    /// Which of the problem's sensors they are.
    sensors: Vec<usize>,
}

/// What the sensors of a band agree on.
struct Agreed<'x, 'a> {
    responses: &'x Responses<'a>,
    /// The frequencies of the band that are looked at.
    picked: &'x [usize],
    /// The modulus, the factor and the delay.
    fitted: &'x Fitted,
    /// The changes that were found, of all sensors.
    edits: &'x [Edit],
}

/// [`diagnose`] of a few sensors. Where load and rows are those of the case, `agreed` is then asked about what was found.
fn look<T>(
    model: &Model<'_>,
    band: &Band<'_>,
    quantities: &[Quantity],
    options: &Options,
    for_each: ForEach<'_>,
    agreed: &dyn Fn(Agreed<'_, '_>) -> T,
) -> Result<(Diagnosis, Option<T>), OutsideTable> {
    let picked = looked_at(band, FREQUENCIES.min((VALUES / quantities.len().max(1)).max(12)));
    let frequency_hz: Vec<f64> = picked.iter().map(|&i| band.frequency_hz[i]).collect();
    let mut diagnosis = Diagnosis {
        findings: Vec::new(),
        misfit: None,
        not_judged: None,
        frequencies: picked.len(),
        work: Work::default(),
    };
    let written = Written(picked.iter().map(|&i| written(band, quantities, i)).collect());
    if written.0.iter().flatten().flatten().count() < LEAST_VALUES {
        diagnosis.not_judged = Some(NotJudged::FewValues);
        return Ok((diagnosis, None));
    }
    let at = model.problem.about(model.unknown, &frequency_hz)?;
    let is_linear = band.parameter.members.iter().all(|member| member.power == 1);
    let Some(parametrization) = Parametrization::about(&at, options).filter(|_| is_linear) else {
        diagnosis.not_judged = Some(NotJudged::Parameter);
        return Ok((diagnosis, None));
    };
    let own = match model.trained {
        None => trained(band.experiment, &at, &parametrization, for_each),
        Some(_) => None,
    };
    diagnosis.work = own.as_ref().map_or(Work::default(), Subspace::work);
    let sensors = match model.trained {
        None => (0..quantities.len()).collect(),
        Some(_) => model.sensors.clone(),
    };
    let responses = model
        .trained
        .or(own.as_ref())
        .and_then(|subspace| Responses::new(subspace, sensors, parametrization, &at, for_each));
    let Some(responses) = responses else {
        diagnosis.not_judged = Some(NotJudged::Breakdown);
        return Ok((diagnosis, None));
    };
    let search = Search { responses: &responses, written: &written, for_each };
    let grid = search.grid(quantities.len());
    let mut data_hypothesis = DataHypothesis::as_told(quantities, band.model.decay_per_s());
    let mut current = search.fit(&data_hypothesis, &grid, None);
    let (mut common, mut elsewhere_found) = (Vec::new(), false);
    while diagnosis.findings.len() < FINDINGS {
        let values = best_change(&search, &grid, &data_hypothesis, &current);
        // Another row is looked for only where nothing simpler explains the data.
        let explained = values.as_ref().map_or(current.misfit.sigma, |(_, found)| found.misfit.sigma);
        let rows = match explained <= EXPLAINED {
            true => Vec::new(),
            false => {
                let laws = laws_elsewhere(&search, &grid, &data_hypothesis, &current);
                dof_mismatch(&search, band.experiment, &at, options, &data_hypothesis, &laws)
            }
        };
        let best_row = likeliest_row(&rows, &current, band.model.dim());
        let likeliest = values.as_ref().map_or(f64::INFINITY, |(_, found)| found.nats);
        if let Some((fault, tried)) = best_row.filter(|(_, tried)| tried.fitted.nats < likeliest) {
            let evidence = evidence(&current, &tried.fitted);
            let sensors = tried.edit.sensors.clone();
            diagnosis.findings.push(Finding { fault, sensors, evidence: Some(evidence) });
            current = tried.fitted.clone();
            elsewhere_found = true;
            break;
        }
        let Some((edit, found)) = values else { break };
        let after = data_hypothesis.with(&edit);
        let fault = fault(&search, &data_hypothesis, &after, &edit, &found);
        let evidence = evidence(&current, &found);
        if edit.sensors.len() == quantities.len() {
            common.push(edit.clone());
        }
        diagnosis.findings.push(Finding { fault, sensors: edit.sensors, evidence: Some(evidence) });
        (data_hypothesis, current) = (after, found);
    }
    diagnosis.misfit = Some(current.misfit.sigma);
    if let Some(top) = at.last()
        && let Some(fault) = mesh::beyond_mesh(top, responses.correction(current.law, at.len() - 1))
    {
        let sensors = (0..quantities.len()).collect();
        diagnosis.findings.push(Finding { fault, sensors, evidence: None });
    }
    let told = (!elsewhere_found)
        .then(|| agreed(Agreed { responses: &responses, picked: &picked, fitted: &current, edits: &common }));
    Ok((diagnosis, told))
}

/// Frequencies to look at: half of them where the response is largest among its neighbours (there it tells of damping), the others evenly spaced, ascending.
fn looked_at(band: &Band<'_>, most: usize) -> Vec<usize> {
    let usable: Vec<usize> = (0..band.frequency_hz.len()).filter(|&i| band.frequency_hz[i] > 0.0).collect();
    if usable.len() <= most {
        return usable;
    }
    let size = |i: usize, m: usize| band.measured[i][m].norm();
    let mut peaks: Vec<(f64, usize)> = Vec::new();
    for m in 0..band.experiment.sensors.len() {
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
fn written(band: &Band<'_>, quantities: &[Quantity], i: usize) -> Vec<Option<c64>> {
    let values = band.measured[i].iter().zip(quantities);
    values
        .map(|(u, &quantity)| {
            let ln = ln_over_receptance(quantity, band.frequency_hz[i], band.model.decay_per_s());
            Some(u.ln() + ln)
        })
        .map(|ln| ln.filter(|ln| ln.is_finite()))
        .collect()
}

fn evidence(before: &Fitted, after: &Fitted) -> Evidence {
    Evidence { before: before.misfit.sigma, after: after.misfit.sigma, nats: before.nats - after.nats }
}

/// Whether a change explains what was not explained.
fn is_better(before: &Fitted, after: &Fitted) -> bool {
    before.nats - after.nats >= MARGIN && after.misfit.sigma <= FALL * before.misfit.sigma
}

/// The likeliest change of values that is a finding.
fn best_change(
    search: &Search<'_, '_>,
    grid: &Grid,
    data_hypothesis: &DataHypothesis,
    current: &Fitted,
) -> Option<(Edit, Fitted)> {
    // No misfit is taken to be smaller than that floor: from here nothing can fall far enough.
    if FALL * current.misfit.sigma < misfit::FLOOR {
        return None;
    }
    let edits = data_hypothesis.edits();
    let fitted = map(search.for_each, edits.len(), |k| {
        search.fit(&data_hypothesis.with(&edits[k]), grid, Some(current))
    });
    let mut found: Vec<(Edit, Fitted)> = edits
        .into_iter()
        .zip(fitted)
        .filter(|(edit, fitted)| {
            is_better(current, fitted) && is_large(search, &data_hypothesis.with(edit), edit, fitted)
        })
        .collect();
    let least = found.iter().map(|(_, fitted)| fitted.nats).fold(f64::INFINITY, f64::min);
    let first = found.iter().position(|(_, fitted)| fitted.nats <= least + AS_LIKELY)?;
    Some(found.swap_remove(first))
}

/// Whether a factor or a delay is large enough to be a fault.
fn is_large(search: &Search<'_, '_>, data_hypothesis: &DataHypothesis, edit: &Edit, fitted: &Fitted) -> bool {
    let top = crate::frequency::omega_rad_s(search.responses.frequency_hz.last().copied().unwrap_or(0.0));
    let beyond = |value: f64, least: f64, std: Option<f64>| {
        value.abs() >= least && std.is_some_and(|std| value.abs() >= SIGNIFICANT * std)
    };
    match edit.change {
        Change::Factor => {
            beyond(fitted.ln_factor, LEAST_FACTOR, search.deviations(data_hypothesis, fitted)[0])
        }
        Change::Delay => {
            beyond(fitted.delay_s, LEAST_PHASE / top, search.deviations(data_hypothesis, fitted)[1])
        }
        _ => true,
    }
}

/// What a change of values says.
fn fault(
    search: &Search<'_, '_>,
    before: &DataHypothesis,
    after: &DataHypothesis,
    edit: &Edit,
    found: &Fitted,
) -> Fault {
    let [factor_std, delay_std] = search.deviations(after, found);
    match &edit.change {
        Change::Conjugated => Fault::Conjugated,
        Change::Quantity(is) => {
            // As the case reads the values, with the modulus that came of reading them otherwise: a modulus with a slope of its own would hide part of it.
            let (slope, slope_std) =
                search.slope(before, found, &edit.sensors).unwrap_or((f64::NAN, f64::NAN));
            Fault::Quantity { taken_for: before.quantity[edit.sensors[0]], is: *is, slope, slope_std }
        }
        Change::Factor => {
            let factor = found.ln_factor.exp();
            let relative_std = factor_std.unwrap_or(0.0);
            let off = |known: KnownFactor| (found.ln_factor - known.value().ln()).abs();
            let near = |known: &KnownFactor| off(*known) <= NAMED_WITHIN + 3.0 * relative_std;
            let nearest = KnownFactor::ALL.into_iter().filter(near);
            let known = nearest.min_by(|&a, &b| off(a).total_cmp(&off(b)));
            Fault::Factor { factor, relative_std, known }
        }
        Change::Delay => Fault::Delay { seconds: found.delay_s, std: delay_std.unwrap_or(0.0) },
        Change::Reversed | Change::Column(..) => Fault::Sign,
    }
}

/// Moduli with which rows are compared, for each sensor and (last) for the load: that of the other sensors, and all of the box.
fn laws_elsewhere(
    search: &Search<'_, '_>,
    grid: &Grid,
    data_hypothesis: &DataHypothesis,
    current: &Fitted,
) -> Vec<Vec<responses::Law>> {
    let all = sweep(search.responses);
    let sensors = data_hypothesis.sensors();
    let without = |m: usize| {
        if sensors == 1 {
            return all.clone();
        }
        let blanked = |values: &Vec<Option<c64>>| {
            values.iter().enumerate().map(|(k, value)| value.filter(|_| k != m)).collect()
        };
        let others = Written(search.written.0.iter().map(blanked).collect());
        let known = Search { written: &others, ..*search }.fit(data_hypothesis, grid, None).law;
        vec![known, current.law]
    };
    let mut laws: Vec<Vec<responses::Law>> = (0..sensors).map(without).collect();
    laws.push(all);
    laws
}

/// The likeliest row for a dof mismatch that is a finding, with those that cannot be told from it.
fn likeliest_row<'t>(rows: &'t [Tried], current: &Fitted, dim: usize) -> Option<(Fault, &'t Tried)> {
    let best = rows.iter().min_by(|a, b| a.fitted.nats.total_cmp(&b.fitted.nats))?;
    // As many rows were tried as there are.
    let tried = (dim.max(1) as f64).ln();
    let gained = current.nats - best.fitted.nats - tried;
    if gained < MARGIN || best.fitted.misfit.sigma > FALL * current.misfit.sigma {
        return None;
    }
    let alike = |tried: &&Tried| {
        tried.fitted.nats <= best.fitted.nats + AS_LIKELY && tried.edit.sensors == best.edit.sensors
    };
    let mut same: Vec<&Tried> = rows.iter().filter(alike).collect();
    same.sort_by(|a, b| a.fitted.nats.total_cmp(&b.fitted.nats));
    let listed = |wanted: fn(DofMismatch) -> Option<usize>| -> Vec<OtherRow> {
        let of =
            |tried: &&Tried| Some(OtherRow { row: wanted(tried.what)?, misfit: tried.fitted.misfit.sigma });
        same.iter().filter_map(of).collect()
    };
    let fault = match best.what {
        DofMismatch::Response(_) => Fault::ResponseDof {
            rows: listed(|what| match what {
                DofMismatch::Response(row) => Some(row),
                DofMismatch::Load(_) => None,
            }),
        },
        DofMismatch::Load(_) => Fault::LoadDof {
            rows: listed(|what| match what {
                DofMismatch::Load(row) => Some(row),
                DofMismatch::Response(_) => None,
            }),
        },
    };
    Some((fault, best))
}
