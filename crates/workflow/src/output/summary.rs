//! `summary.json`: what went in, what was done, what came out, in a form that programs read.

use super::assumptions::contradicted;
use super::identifiability::{coordinate, not_identifiable};
use super::{corrections_json, laws_json, smooth_json};
use crate::load::{Case, IdentifyCase, InputFile, MeasuredNoise, SensorInfo};
use crate::run::IdentifyRun;
use frfit::c64;
use frfit::identify::{
    Assumption, CalibrationError, CausalityBreach, ContradictedAssumption, Contributions, Dependence,
    Direction, FactorError, GoodnessOfFit, Identifiability, Identification, Leverage, LeverageOf, Line,
    MeshError, ModeError, ModelErrors, ModelErrorsFound, NoiseLevel, Number, SensorMass, Status, Unknown,
    Variation,
};
use frfit::material::loss_factor;
use frfit::model::{FactorPart, Term};
use frfit_linalg::solve::Breakdown;
use serde_json::{Map, Value, json};

/// A value within this of the reference counts as right: the search for several unknowns ends earlier than roots of one do.
fn right_within(unknowns: usize) -> f64 {
    if unknowns == 1 { 1e-6 } else { 1e-5 }
}

/// The summary of an identification. `seconds_figures` is the stage outside the run.
///
/// What belongs to one unknown stands in `unknowns`; what belongs to a single one stands also beside what belongs to the band.
pub fn summary_json(case: &Case, identify: &IdentifyCase, run: &IdentifyRun, seconds_figures: f64) -> Value {
    let (found, options) = (&run.found, &identify.options);
    let statuses = || Status::ALL.into_iter().filter(|&status| run.count(status) > 0);
    let by_status = |of: &dyn Fn(Status) -> Value| -> Map<String, Value> {
        statuses().map(|status| (status.name().to_owned(), of(status))).collect()
    };
    let [window, shifts, cut_off] = corrections_json(case.corrections());
    let mut summary = json!({
        "frfit": env!("CARGO_PKG_VERSION"),
        "title": case.title,
        "inputs": InputFile::json(&case.inputs),
        "units": case.units.json(),
        "decay_per_s": case.model.decay_per_s(),
        "window": window,
        "frequency_shifts": shifts,
        "cut_off": cut_off,
        "model": model_json(case),
        "sensors": (0..case.sensors.len()).map(|m| sensor(case, run, m)).collect::<Vec<_>>(),
        "identify": {
            "band_hz": identify.band_hz,
            "not_common": identify.not_common,
            "left_out": identify.left_out.iter().filter(|&&out| out).count(),
            "method": options.method.name(),
            "order": options.order,
            "selection": options.selection.name(),
            "reduction": options.reduction.name(),
            "reject_outliers": options.reject_outliers,
            "model_error": model_error_json(options.model_errors),
            "coarser_mesh": case.coarser_mesh.is_some(),
        },
        "unknowns": (0..identify.unknowns.len()).map(|j| unknown_json(case, identify, run, j)).collect::<Vec<_>>(),
        "frequencies": found.lines.len(),
        "status": by_status(&|status| json!(run.count(status))),
        "bands_hz": by_status(&|status| json!(run.bands_hz(status))),
        "no_answer": no_answer(run),
        "trusted": found.is_trusted(),
        "noise": noise(identify, run),
        "fit": fit_json(found.fit.as_ref()),
        "model_errors": found.model_errors.as_ref().map(|errors| model_errors_json(case, errors)),
        "error_bars_contain": error_bars_contain(found),
        "leverage": leverage_json(case, found),
        "causality_breaches": breaches_json(case, found),
        "error": spread(run, |line| line.error),
        "required_order": required_order(run),
        "spectral_radius": spread(run, |line| line.spectral_radius),
        "search": {
            "converged": found.search.converged, "starts": found.search.starts, "agreeing": found.search.agreeing,
            "about": found.search.about,
        },
        "counts": {
            "factorisations": found.search.work.factorisations,
            "solves": found.search.work.solves,
            "subspace_size": found.search.reduced_size,
            "explored": found.search.explored,
            "reduction_error": found.reduction_error(),
        },
        "seconds": {
            "load": run.seconds.load,
            "check": run.seconds.check,
            "subspace": run.seconds.subspace,
            "solutions": run.seconds.solutions,
            "selection": run.seconds.selection,
            "laws": run.seconds.laws,
            "identify": run.seconds.identify(),
            "error_map": run.seconds.error_map,
            "figures": seconds_figures,
        },
    });
    add(&mut summary, identifiability_json(identify, found));
    if identify.is_law() {
        summary["laws"] = laws_json(&found.laws, identify.units[0], case.units);
    }
    if identify.varies(0) == "smooth" {
        summary["smooth"] = found.curve.as_ref().map_or(Value::Null, smooth_json);
    }
    if let [_] = identify.unknowns[..] {
        of_the_only(&mut summary);
    }
    summary
}

/// Which of `noise`, `model_errors` and `known_factors` the error bars contain. They contain errors of the model also if none was found, but noise may hide
/// some.
fn error_bars_contain(found: &Identification) -> Vec<&'static str> {
    let values = || found.lines.iter().flat_map(|line| &line.values);
    let contains = |of: fn(&Contributions) -> f64| {
        values().filter_map(|value| value.uncertainty).any(|bar| of(&bar.contributions) > 0.0)
    };
    [
        ("noise", contains(|bar| bar.noise)),
        ("model_errors", contains(|bar| bar.model)),
        ("known_factors", contains(|bar| bar.known_factors)),
    ]
    .into_iter()
    .filter_map(|(part, is_in)| is_in.then_some(part))
    .collect()
}

/// The keys of the only unknown, where a program expects them that knows of no other.
fn of_the_only(summary: &mut Value) {
    let only = summary["unknowns"][0].clone();
    summary["factor_unit"] = only["unit"].clone();
    for key in ["storage_std", "loss_factor_std", "reference"] {
        summary[key] = only[key].clone();
    }
    summary["identify"]["matrix"] = only["matrices"].clone();
    for key in ["varies", "law", "bounds", "real"] {
        summary["identify"][key] = only[key].clone();
    }
}

/// The members of an object, added to another.
fn add(object: &mut Value, more: Value) {
    if let (Some(object), Value::Object(more)) = (object.as_object_mut(), more) {
        object.extend(more);
    }
}

/// An unknown, and what was found of it.
fn unknown_json(case: &Case, identify: &IdentifyCase, run: &IdentifyRun, j: usize) -> Value {
    let one = &identify.unknowns[j];
    let band = run.found.constants.iter().find(|value| value.unknowns == j);
    let number = |n: &Number| json!({"name": n.name, "value": n.value, "std": finite(n.std)});
    let laws = match &one.varies {
        Variation::Law(laws) => laws.as_slice(),
        _ => &[],
    };
    json!({
        "name": one.name,
        "matrices": matrices(case, one),
        "unit": identify.units[j].word(),
        "varies": identify.varies(j),
        "law": laws.iter().map(|kind| kind.to_string()).collect::<Vec<_>>(),
        "real": one.real,
        "bounds": {"storage": one.bounds.storage, "loss_factor": one.bounds.loss_factor},
        "numbers": band.map(|band| band.numbers.iter().map(number).collect::<Vec<_>>()),
        "status": band.map(|band| band.status.name()),
        "storage_std": spread(run, |line| Some(line.values[j].uncertainty?.storage_std)),
        "loss_factor_std": spread(run, |line| line.values[j].uncertainty?.loss_factor_std),
        "reference": reference(identify, run, j),
    })
}

/// The matrices that an unknown multiplies; of a geometric parameter each with its power.
fn matrices(case: &Case, one: &Unknown) -> Value {
    let name = |term: &usize| case.model.terms()[*term].name.clone();
    match &one.dependence {
        Dependence::Factor(terms) => json!(terms.iter().map(name).collect::<Vec<_>>()),
        Dependence::Powers(powers) => {
            json!(powers.iter().map(|(term, power)| (name(term), json!(power))).collect::<Map<_, _>>())
        }
    }
}

/// Correlation and directions of the numbers that hold for the band.
fn identifiability_json(identify: &IdentifyCase, found: &Identification) -> Value {
    let Identifiability { coordinates, correlation, directions, profile } = &found.identifiability;
    let names: Vec<String> = (0..coordinates.len()).map(|c| coordinate(identify, found, c)).collect();
    let direction = |direction: &Direction| {
        let weight = |&(c, weight): &(usize, f64)| json!({"of": names[c], "weight": weight});
        let weights: Vec<Value> = direction.weights.iter().map(weight).collect();
        json!({"std": finite(Some(direction.std)), "weights": weights})
    };
    json!({
        "coordinates": names,
        "correlation": correlation,
        "directions": directions.iter().map(direction).collect::<Vec<_>>(),
        "not_identifiable": not_identifiable(identify, found),
        "profile": profile.as_ref().map(|profile| &profile.points),
    })
}

fn finite(value: Option<f64>) -> Option<f64> {
    value.filter(|value| value.is_finite())
}

/// How large the model is, and what its matrices are.
fn model_json(case: &Case) -> Value {
    let matrix = |term: &Term| json!({"name": term.name, "role": format!("{:?}", term.role).to_lowercase()});
    json!({
        "dofs": case.model.dim(),
        "engine": case.model.analysis().engine(),
        "nonzeros": case.model.analysis().pattern().nonzeros(),
        "matrices": case.model.terms().iter().map(matrix).collect::<Vec<_>>(),
    })
}

/// Reasons why frequencies have no answer, and how many frequencies each has.
fn no_answer(run: &IdentifyRun) -> Value {
    let of =
        |(reason, count): (&Breakdown, usize)| json!({"reason": reason.to_string(), "frequencies": count});
    run.found.breakdowns().into_iter().map(of).collect()
}

/// A sensor and its agreement with the answers: its misfit over its standard deviation (root mean square).
fn sensor(case: &Case, run: &IdentifyRun, m: usize) -> Value {
    let sensor = &case.sensors[m];
    let mut of_sensor = json!({"label": sensor.label, "quantity": sensor.quantity.name()});
    if let Some(elsewhere) = sensor.elsewhere {
        of_sensor["dof_in_file"] = json!(elsewhere.to_string());
    }
    let channels = case.identify.as_ref().map_or(&[][..], |identify| &identify.channels);
    let unknown = channels.get(m).copied().unwrap_or_default();
    let found = run.found.channels.get(m).copied().unwrap_or_default();
    let asked = [("scale", unknown.scale, found.scale), ("delay_s", unknown.delay, found.delay_s)];
    for (key, _, found) in asked.into_iter().filter(|(_, asked, _)| *asked) {
        of_sensor[key] = json!(found.map(|found| found.value));
        of_sensor[format!("{key}_std")] = json!(found.and_then(|found| found.std));
    }
    if let Some(fit) = run.found.sensors.get(m) {
        of_sensor["misfit"] = json!(fit.misfit);
        of_sensor["contradicts"] = json!(fit.contradicts);
        of_sensor["dead"] = json!(fit.dead);
        of_sensor["left_out"] = json!(fit.left_out);
    }
    of_sensor
}

/// How large the noise is, and where that is known from: `level` is in units of what `deviation` names.
fn noise(identify: &IdentifyCase, run: &IdentifyRun) -> Value {
    let NoiseLevel { level, source, of_sensors, of_scatter, floor, correlation, common } = run.found.noise;
    let deviation = match &identify.noise {
        MeasuredNoise::Known(_) => "std, or coherence and averages, of the measurements",
        MeasuredNoise::Relative(_) => "coherence of the measurements, as of one average",
        MeasuredNoise::Unknown if floor.is_some() => {
            "size of the response with a floor, over that of a response of median size"
        }
        MeasuredNoise::Unknown => "size of the response, a tenth of its median at least",
    };
    json!({
        "level": level, "source": source.name(), "deviation": deviation,
        "level_of_sensors": of_sensors, "level_of_scatter": of_scatter,
        "correlation_of_sensors": correlation, "level_in_common": common,
        "floor": floor.map(|floor| json!({"over_median": floor.over_median, "power": floor.power})),
    })
}

/// What the case says of the errors of the model, as its key does.
fn model_error_json(known: ModelErrors) -> Value {
    match known {
        ModelErrors::Estimated => json!("estimated"),
        ModelErrors::None => json!("none"),
        ModelErrors::Given(sizes) => {
            json!({"frequency": sizes.frequency, "shape": sizes.shape, "calibration": sizes.calibration})
        }
    }
}

/// What an unknown is called.
fn unknown_name(case: &Case, unknown: usize) -> Option<&str> {
    Some(case.identify.as_ref()?.unknowns.get(unknown)?.name.as_str())
}

/// How far 1 % of each known factor, or of the natural frequencies at the end of the band, moves each unknown, in per cent.
fn leverage_json(case: &Case, found: &Identification) -> Vec<Value> {
    let one = |one: &Leverage| {
        let unknown = unknown_name(case, one.unknown);
        let mut json = json!({"unknown": unknown, "percent_by_percent": one.change});
        match one.of {
            LeverageOf::Factor(term) => json["matrix"] = json!(case.model.terms()[term].name),
            LeverageOf::Mesh => json["mesh"] = json!(true),
        }
        json
    };
    found.leverage.iter().map(one).collect()
}

/// What is taken for known and contradicted.
fn assumptions_json(case: &Case, all: &[ContradictedAssumption]) -> Vec<Value> {
    let one = |one: &ContradictedAssumption| {
        let mut json = match one.what {
            Assumption::Calibration => json!({"assumption": "calibration"}),
            Assumption::Factor { term, part } => {
                json!({"assumption": "factor", "matrix": case.model.terms()[term].name, "part": part_name(part)})
            }
        };
        json["error"] = one.error.into();
        json["std"] = one.std.into();
        json["text"] = contradicted(case, one).into();
        json
    };
    all.iter().map(one).collect()
}

fn part_name(part: FactorPart) -> &'static str {
    match part {
        FactorPart::Storage => "storage",
        FactorPart::LossFactor => "loss_factor",
    }
}

/// Where a modulus is that of no causal material.
fn breaches_json(case: &Case, found: &Identification) -> Vec<Value> {
    let one = |breach: &CausalityBreach| json!({"unknown": unknown_name(case, breach.unknown), "range_hz": breach.range_hz});
    found.causality_breaches.iter().map(one).collect()
}

/// The errors of the model that were corrected for.
fn model_errors_json(case: &Case, errors: &ModelErrorsFound) -> Value {
    let mode = |mode: &ModeError| {
        let mut json = json!({"frequency_hz": mode.frequency_hz, "error": mode.error, "std": mode.std});
        if let Some(coarser_hz) = mode.coarser_hz {
            json["coarser_mesh_hz"] = coarser_hz.into();
        }
        json
    };
    let mesh = |mesh: MeshError| json!({"paired": mesh.paired, "expected": mesh.expected, "remainder": mesh.remainder, "std": mesh.std});
    let mass = |(sensor, one): (&SensorInfo, &SensorMass)| json!({"sensor": sensor.label, "mass_kg": one.mass, "std_kg": one.std});
    let matrix = |factor: &FactorError| json!({"matrix": case.model.terms()[factor.term].name, "part": part_name(factor.part), "error": factor.error, "std": factor.std});
    let sensors = case.sensors.iter().map(|sensor| sensor.label.as_str());
    let channels = std::iter::once("force").chain(sensors);
    let calibration = |(channel, one): (&str, &CalibrationError)| json!({"channel": channel, "error": one.error, "std": one.std});
    json!({
        "frequency_std": errors.frequency_std,
        "loss_factor_std": errors.loss_factor_std,
        "shape_std": errors.shape_std,
        "response_std": errors.response_std,
        "bars_over_noise": errors.bars_over_noise,
        "evidence_nats": errors.evidence,
        "mesh": errors.mesh.map(mesh),
        "modes": errors.modes.iter().map(mode).collect::<Vec<_>>(),
        "matrices": errors.factors.iter().map(matrix).collect::<Vec<_>>(),
        "contradicted_assumptions": assumptions_json(case, &errors.contradicted_assumptions),
        "calibrations": channels.zip(&errors.calibrations).map(calibration).collect::<Vec<_>>(),
        "sensor_masses": case.sensors.iter().zip(&errors.masses).map(mass).collect::<Vec<_>>(),
    })
}

/// χ² over the band and its meaning; null where it cannot be tested.
fn fit_json(fit: Option<&GoodnessOfFit>) -> Value {
    let Some(fit) = fit else { return Value::Null };
    json!({
        "chi2": fit.chi_squared, "freedom": fit.freedom, "chi2_per_freedom": fit.chi_squared / fit.freedom as f64,
        "deviate": fit.deviate, "verdict": fit.verdict.name(),
    })
}

/// The order that the paper's series would need for a truncation error of 1e-6, and at how many answers no order is enough; null where that was not
/// asked of any.
fn required_order(run: &IdentifyRun) -> Value {
    let asked =
        run.found.lines.iter().filter(|line| line.reduction_error.is_some() && line.correction().is_some());
    let orders: Vec<Option<usize>> = asked.map(|line| line.required_order).collect();
    if orders.is_empty() {
        return Value::Null;
    }
    let most = orders.iter().flatten().max();
    json!({"most": most, "never": orders.iter().filter(|order| order.is_none()).count()})
}

/// Median and largest of a number over the frequencies with status `ok`; null where no frequency has one.
fn spread(run: &IdentifyRun, number: impl Fn(&Line) -> Option<f64>) -> Value {
    let ok = run.found.lines.iter().filter(|line| line.status == Status::Ok);
    let mut values: Vec<f64> = ok.filter_map(number).collect();
    values.sort_by(f64::total_cmp);
    json!({"median_ok": values.get(values.len() / 2), "max_ok": values.last()})
}

/// How near an unknown is to what a simulated measurement was made with; null where that is not known.
///
/// `relative` and `deviations` (in its standard deviations) of what holds for the band are those in the middle of the lines with a value.
fn reference(identify: &IdentifyCase, run: &IdentifyRun, j: usize) -> Value {
    let Some(law) = &identify.reference[j] else { return Value::Null };
    let within = right_within(identify.unknowns.len());
    let exact = |line: &Line| law.at(line.frequency_hz).ok();
    let off = |line: &Line| {
        let exact = exact(line)?;
        Some((line.values[j].value? - exact).norm() / exact.norm())
    };
    let is_ok = |line: &&Line| line.status == Status::Ok;
    let is_right = |line: &Line| off(line).is_some_and(|off| off <= within);
    let lines = || run.found.lines.iter();
    // Of the values with error bars that are ok, those that have the reference within two standard deviations: 0.95 is right.
    let covered = |part: usize| {
        let within = |line: &Line| Some(deviations(line, j, exact(line)?)[part]? <= 2.0);
        fraction(lines().filter(is_ok).filter_map(within))
    };
    // Where the measurement is not one of the model itself, the mesh decides how near the reference a value can be.
    let mut reference = json!({
        "covered": {
            "storage": covered(0),
            "loss_factor": covered(1),
        },
        "deviation": spread(run, off),
        "within": within,
        "fraction_right": fraction(lines().map(is_right)),
        "fraction_right_of_ok": fraction(lines().filter(is_ok).map(is_right)),
        "wrong_and_ok": lines().filter(is_ok).filter(|line| !is_right(line)).count(),
    });
    let answered: Vec<&Line> = lines().filter(|line| off(line).is_some()).collect();
    if let (true, Some(middle)) = (identify.holds_for_band(j), answered.get(answered.len() / 2))
        && let Some(exact) = exact(middle)
    {
        reference["relative"] = json!(off(middle));
        let largest = deviations(middle, j, exact).into_iter().flatten().reduce(f64::max);
        reference["deviations"] = json!(finite(largest));
    }
    reference
}

/// How many standard deviations the storage modulus and the loss factor of an unknown are off.
fn deviations(line: &Line, j: usize, exact: c64) -> [Option<f64>; 2] {
    let value = &line.values[j];
    let off = |found: Option<f64>, exact: f64, std: Option<f64>| Some(((found? - exact) / std?).abs());
    let bars = value.uncertainty;
    [
        off(value.storage(), exact.re, bars.map(|bars| bars.storage_std)),
        off(value.loss_factor(), loss_factor(exact), bars.and_then(|bars| bars.loss_factor_std)),
    ]
}

fn fraction(flags: impl Iterator<Item = bool>) -> Option<f64> {
    let flags: Vec<bool> = flags.collect();
    let count = flags.iter().filter(|&&flag| flag).count();
    (!flags.is_empty()).then(|| count as f64 / flags.len() as f64)
}
