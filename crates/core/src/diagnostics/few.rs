//! Few sensors, all fitted together: the changes that explain what the modulus alone does not, one after the other.

use super::data_hypothesis::{Change, DataHypothesis, DofMismatch, Edit, ln_over_receptance};
use super::dof_mismatch::{Tried, dof_mismatch, sweep};
use super::finding::{
    Diagnosis, Evidence, Fault, Finding, KNOWN_FACTOR_RTOL, KnownFactor, NotJudged, OtherRow,
};
use super::responses::{self, Parametrization, Responses, trained};
use super::search::{Fitted, Grid, Search, Written};
use super::{mesh, misfit};
use crate::c64;
use crate::for_each::{ForEach, map};
use crate::identify::{Band, Options, Problem};
use crate::material::OutsideTable;
use crate::quantity::Quantity;
use crate::response::Work;
use crate::subspace::Subspace;

/// The least log-likelihood ratio of a finding, in nats: some thirty changes are tried (e^3.4), and neighbouring residuals are not independent: what is left of a law
/// that is no power may move several of them together.
pub const FINDING_NATS: f64 = 15.0;

/// The misfit with a finding over that without, at most. A factor, a delay or another row can fit a little of whatever is wrong; what they are the reason of falls to the noise.
pub const MAX_MISFIT_RATIO: f64 = 0.6;

/// A factor nearer to one than this is the calibration's or the model's mass, and no fault.
const MIN_LN_FACTOR: f64 = 0.1;

/// A delay that turns the phase by less than this at the top of the band (rad) is a filter's, and no fault.
const MIN_DELAY_PHASE_RAD: f64 = 0.2;

/// A factor or delay of fewer standard deviations than this is not distinguished from zero.
const SIGNIFICANT_STD: f64 = 5.0;

/// Misfit up to which data are explained: noise and a constant law leave as much, and the rows of a neighbourhood cannot be distinguished by it.
const EXPLAINED_MISFIT: f64 = 0.04;

/// Readings as likely as the best within this: the one that is listed first is named.
const EQUAL_NATS: f64 = 3.0;

/// Values at fewer than this explain nothing: three numbers of the modulus, two of a change, and as many again to judge by.
const MIN_VALUES: usize = 8;

/// Frequencies that are looked at, and values at most (they are fewer where there are many sensors).
const MAX_FREQUENCIES: usize = 40;

const MAX_VALUES: usize = 240;

/// Findings at most.
const MAX_FINDINGS: usize = 2;

/// What answers for the sensors of a band.
#[derive(Clone)]
pub(super) struct Model<'x> {
    pub(super) problem: &'x Problem<'x>,
    /// Which unknown is free, with the others at their nominal values.
    pub(super) unknown: usize,
    /// A reduced model of the whole problem; without one, one is trained for the sensors.
    pub(super) trained: Option<&'x Subspace<'x>>,
    /// Which of the problem's sensors they are.
    pub(super) sensors: Vec<usize>,
}

/// What the sensors of a band agree on.
pub(super) struct Agreed<'x, 'a> {
    pub(super) responses: &'x Responses<'a>,
    /// The frequencies of the band that are looked at.
    pub(super) picked: &'x [usize],
    /// The modulus, the factor and the delay.
    pub(super) fitted: &'x Fitted,
    /// The changes that were found, of all sensors.
    pub(super) edits: &'x [Edit],
}

/// [`super::diagnose`] of a few sensors. Where load and rows are those of the case, `agreed` is then asked about what was found.
pub(super) fn look<T>(
    model: &Model<'_>,
    band: &Band<'_>,
    quantities: &[Quantity],
    options: &Options,
    for_each: ForEach<'_>,
    agreed: &dyn Fn(Agreed<'_, '_>) -> T,
) -> Result<(Diagnosis, Option<T>), OutsideTable> {
    let picked = looked_at(band, MAX_FREQUENCIES.min((MAX_VALUES / quantities.len().max(1)).max(12)));
    let frequency_hz: Vec<f64> = picked.iter().map(|&i| band.frequency_hz[i]).collect();
    let mut diagnosis = Diagnosis {
        findings: Vec::new(),
        misfit: None,
        not_judged: None,
        frequencies: picked.len(),
        work: Work::default(),
    };
    let written = Written(picked.iter().map(|&i| written(band, quantities, i)).collect());
    if written.0.iter().flatten().flatten().count() < MIN_VALUES {
        diagnosis.not_judged = Some(NotJudged::FewValues);
        return Ok((diagnosis, None));
    }
    let at = model.problem.about(model.unknown, &frequency_hz)?;
    let is_linear = band.parameter.members.iter().all(|member| member.power == 1);
    let parametrization = Parametrization::about(&at, band.unknown, options).filter(|_| is_linear);
    let Some(parametrization) = parametrization else {
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
    let mut data_hypothesis = DataHypothesis::as_given(quantities, band.model.decay_per_s());
    let mut current = search.fit(&data_hypothesis, &grid, None);
    let (mut common, mut mismatch_found) = (Vec::new(), false);
    while diagnosis.findings.len() < MAX_FINDINGS {
        let values = best_change(&search, &grid, &data_hypothesis, &current);
        // Another row is looked for only where nothing simpler explains the data.
        let explained = values.as_ref().map_or(current.misfit.sigma, |(_, found)| found.misfit.sigma);
        let rows = match explained <= EXPLAINED_MISFIT {
            true => Vec::new(),
            false => {
                let laws = laws_of_other_rows(&search, &grid, &data_hypothesis, &current);
                dof_mismatch(&search, band, &at, options, &data_hypothesis, &laws)
            }
        };
        let best_row = likeliest_row(&rows, &current, band.model.dim());
        let likeliest = values.as_ref().map_or(f64::INFINITY, |(_, found)| found.nats);
        if let Some((fault, tried)) = best_row.filter(|(_, tried)| tried.fitted.nats < likeliest) {
            let evidence = evidence(&current, &tried.fitted);
            let sensors = tried.edit.sensors.clone();
            diagnosis.findings.push(Finding { fault, sensors, evidence: Some(evidence) });
            current = tried.fitted.clone();
            mismatch_found = true;
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
    let own = (!mismatch_found)
        .then(|| agreed(Agreed { responses: &responses, picked: &picked, fitted: &current, edits: &common }));
    Ok((diagnosis, own))
}

/// Frequencies to look at: half of them where the response is largest among its neighbours (there it depends on damping), the others evenly spaced, ascending.
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
pub(super) fn written(band: &Band<'_>, quantities: &[Quantity], i: usize) -> Vec<Option<c64>> {
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
    before.nats - after.nats >= FINDING_NATS && after.misfit.sigma <= MAX_MISFIT_RATIO * before.misfit.sigma
}

/// The likeliest change of values that is a finding.
fn best_change(
    search: &Search<'_, '_>,
    grid: &Grid,
    data_hypothesis: &DataHypothesis,
    current: &Fitted,
) -> Option<(Edit, Fitted)> {
    // No misfit is taken to be smaller than that floor: from here nothing can fall far enough.
    if MAX_MISFIT_RATIO * current.misfit.sigma < misfit::MIN_MISFIT {
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
    let first = found.iter().position(|(_, fitted)| fitted.nats <= least + EQUAL_NATS)?;
    Some(found.swap_remove(first))
}

/// Whether a factor or a delay is large enough to be a fault.
fn is_large(search: &Search<'_, '_>, data_hypothesis: &DataHypothesis, edit: &Edit, fitted: &Fitted) -> bool {
    let top = crate::frequency::omega_rad_s(search.responses.frequency_hz.last().copied().unwrap_or(0.0));
    let beyond = |value: f64, least: f64, std: Option<f64>| {
        value.abs() >= least && std.is_some_and(|std| value.abs() >= SIGNIFICANT_STD * std)
    };
    match edit.change {
        Change::Factor => {
            beyond(fitted.ln_factor, MIN_LN_FACTOR, search.standard_deviations(data_hypothesis, fitted)[0])
        }
        Change::Delay => beyond(
            fitted.delay_s,
            MIN_DELAY_PHASE_RAD / top,
            search.standard_deviations(data_hypothesis, fitted)[1],
        ),
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
    let [factor_std, delay_std] = search.standard_deviations(after, found);
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
            let near = |known: &KnownFactor| off(*known) <= KNOWN_FACTOR_RTOL + 3.0 * relative_std;
            let nearest = KnownFactor::ALL.into_iter().filter(near);
            let known = nearest.min_by(|&a, &b| off(a).total_cmp(&off(b)));
            Fault::Factor { factor, relative_std, known }
        }
        Change::Delay => Fault::Delay { seconds: found.delay_s, std: delay_std.unwrap_or(0.0) },
        Change::Reversed | Change::Column(..) => Fault::Sign,
    }
}

/// Moduli with which rows are compared, for each sensor and (last) for the load: that of the other sensors, and all of the box.
fn laws_of_other_rows(
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

/// The likeliest row for a dof mismatch that is a finding, with those that cannot be distinguished from it.
fn likeliest_row<'t>(rows: &'t [Tried], current: &Fitted, dim: usize) -> Option<(Fault, &'t Tried)> {
    let best = rows.iter().min_by(|a, b| a.fitted.nats.total_cmp(&b.fitted.nats))?;
    // As many rows were tried as there are.
    let tried = (dim.max(1) as f64).ln();
    let gained = current.nats - best.fitted.nats - tried;
    if gained < FINDING_NATS || best.fitted.misfit.sigma > MAX_MISFIT_RATIO * current.misfit.sigma {
        return None;
    }
    let alike = |tried: &&Tried| {
        tried.fitted.nats <= best.fitted.nats + EQUAL_NATS && tried.edit.sensors == best.edit.sensors
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
