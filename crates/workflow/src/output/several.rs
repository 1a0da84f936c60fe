//! Tables, summary and words for several unknowns.

use super::summary::{fit_json, inputs_json, leverage_json, model_errors_json, model_json, sensor};
use super::words::Words;
use crate::load::{Case, IdentifyCase, MeasuredNoise};
use crate::run::IdentifyRun;
use frfit::c64;
use frfit::identify::{
    Dependence, Direction, Explained, Identification, LineValue, NumberOf, Status, Uncertainty, Unknown,
    Variation,
};
use frfit::material::{Law, loss_factor};
use frfit_formats::csv::{Cell, write};
use serde_json::{Map, Value, json};

/// A value within this of the reference counts as right.
const RIGHT_WITHIN: f64 = 1e-5;

/// A direction whose deviation is larger is not told.
const UNTOLD: f64 = 0.3;

/// A weight below this part of the largest is left out of a sentence.
const SMALL: f64 = 0.05;

/// `identified.csv`: one row a frequency, all unknowns side by side.
pub fn several_csv(wanted: &IdentifyCase, run: &IdentifyRun) -> String {
    let mut columns: Vec<String> =
        ["frequency_hz", "status", "error", "chi2", "reduction_error"].map(Into::into).into();
    for one in &wanted.unknowns {
        let name = &one.name;
        match one.real {
            true => columns.extend([format!("{name}.value"), format!("{name}.std")]),
            false => columns.extend(
                ["storage", "loss_factor", "storage_std", "loss_factor_std", "storage_loss_correlation"]
                    .map(|part| format!("{name}.{part}")),
            ),
        }
    }
    let rows = run.found.lines.iter().map(|at| {
        let mut row = vec![
            Cell::Number(at.frequency_hz),
            Cell::Text(at.status.name()),
            at.error.into(),
            at.chi_squared.into(),
            at.reduction_error.into(),
        ];
        for (one, value) in wanted.unknowns.iter().zip(&at.values) {
            row.extend(cells(one, value));
        }
        row
    });
    let columns: Vec<&str> = columns.iter().map(String::as_str).collect();
    write(&columns, rows).expect("every row has the columns, and no name a line break")
}

/// `reference.csv`: the nominal value of each unknown by frequency, and the true one where the case tells it.
pub fn several_reference_csv(wanted: &IdentifyCase, run: &IdentifyRun) -> String {
    let parts = ["nominal_re", "nominal_im", "true_re", "true_im"];
    let mut columns = vec!["frequency_hz".to_owned()];
    columns.extend(wanted.unknowns.iter().flat_map(|one| parts.map(|part| format!("{}.{part}", one.name))));
    let rows = run.found.lines.iter().map(|at| {
        let of_one = |(nominal, reference): (&c64, &Option<Law>)| {
            let reference = reference.as_ref().and_then(|law| law.at(at.frequency_hz).ok());
            [
                nominal.re.into(),
                nominal.im.into(),
                reference.map(|p| p.re).into(),
                reference.map(|p| p.im).into(),
            ]
        };
        let values = at.values.iter().map(|value| &value.nominal).zip(&wanted.reference).flat_map(of_one);
        std::iter::once(Cell::Number(at.frequency_hz)).chain(values).collect::<Vec<_>>()
    });
    let columns: Vec<&str> = columns.iter().map(String::as_str).collect();
    write(&columns, rows).expect("every row has the columns, and no name a line break")
}

fn cells<'a>(one: &Unknown, value: &LineValue) -> Vec<Cell<'a>> {
    let bars =
        |part: &dyn Fn(Uncertainty) -> Option<f64>| -> Cell<'a> { value.uncertainty.and_then(part).into() };
    match one.real {
        true => vec![value.storage().into(), bars(&|b| Some(b.storage_std))],
        false => vec![
            value.storage().into(),
            value.loss_factor().into(),
            bars(&|b| Some(b.storage_std)),
            bars(&|b| b.loss_factor_std),
            bars(&|b| b.correlation),
        ],
    }
}

/// `summary.json` of several unknowns.
pub fn several_json(case: &Case, wanted: &IdentifyCase, run: &IdentifyRun, seconds_load: f64) -> Value {
    let outcome = &run.found;
    let mut statuses = Map::new();
    for status in Status::ALL.into_iter().filter(|&status| run.count(status) > 0) {
        statuses.insert(status.name().into(), json!(run.count(status)));
    }
    let unknown = |(j, one): (usize, &Unknown)| {
        let band = outcome.constants.iter().find(|value| value.unknowns == j);
        let numbers = band.map(|band| {
            let of =
                |n: &frfit::identify::Number| json!({"name": n.name, "value": n.value, "std": finite(n.std)});
            band.numbers.iter().map(of).collect::<Vec<_>>()
        });
        json!({
            "name": one.name,
            "matrices": matrices(case, one),
            "unit": wanted.units[j].word(),
            "varies": varies(one),
            "real": one.real,
            "bounds": {"storage": one.bounds.storage, "loss_factor": one.bounds.loss_factor},
            "numbers": numbers,
            "status": band.map(|band| band.status.name()),
            "reference": reference_json(wanted, run, j),
        })
    };
    let direction = |direction: &Direction| {
        let weights: Vec<Value> = direction
            .weights
            .iter()
            .map(|&(c, weight)| json!({"of": coordinate(wanted, outcome, c), "weight": weight}))
            .collect();
        json!({"std": finite(Some(direction.std)), "weights": weights})
    };
    json!({
        "frfit": env!("CARGO_PKG_VERSION"),
        "title": case.title,
        "inputs": inputs_json(case),
        "units": case.units.json(),
        "decay_per_s": case.model.decay_per_s(),
        "model": model_json(case),
        "sensors": (0..case.sensors.len()).map(|m| sensor(case, run, m)).collect::<Vec<_>>(),
        "band_hz": wanted.band_hz,
        "frequencies": outcome.lines.len(),
        "unknowns": wanted.unknowns.iter().enumerate().map(unknown).collect::<Vec<_>>(),
        "trusted": outcome.is_trusted(),
        "status": statuses,
        "coordinates": (0..outcome.identifiability.coordinates.len()).map(|c| coordinate(wanted, outcome, c)).collect::<Vec<_>>(),
        "correlation": outcome.identifiability.correlation,
        "directions": outcome.identifiability.directions.iter().map(direction).collect::<Vec<_>>(),
        "not_told": not_told(wanted, outcome),
        "profile": outcome.identifiability.profile.as_ref().map(|profile| &profile.points),
        "noise": {
            "source": noise_source(wanted, outcome),
            "level": outcome.noise.level,
        },
        "fit": fit_json(outcome.fit.as_ref()),
        "model_errors": outcome.model_errors.as_ref().map(|errors| model_errors_json(case, errors)),
        "leverage": leverage_json(case, outcome),
        "search": {"converged": outcome.search.converged, "starts": outcome.search.starts, "agreeing": outcome.search.agreeing},
        "counts": {
            "factorisations": outcome.search.work.factorisations,
            "solves": outcome.search.work.solves,
            "subspace_size": outcome.search.reduced_size.unwrap_or(0),
            "reduction_error": outcome.reduction_error(),
        },
        "seconds": {"load": seconds_load, "identify": run.seconds.identify()},
    })
}

fn finite(value: Option<f64>) -> Option<f64> {
    value.filter(|value| value.is_finite())
}

fn noise_source(wanted: &IdentifyCase, outcome: &Identification) -> &'static str {
    match wanted.noise {
        MeasuredNoise::Known(_) => "given",
        _ => outcome.noise.source.name(),
    }
}

/// How an unknown varies, as a case says it: `frequency`, `constant`, `law zener`.
pub fn varies(one: &Unknown) -> String {
    match &one.varies {
        Variation::PerFrequency => "frequency".into(),
        Variation::Constant => "constant".into(),
        Variation::Law(kinds) => {
            format!("law {}", kinds.iter().map(ToString::to_string).collect::<Vec<_>>().join(", "))
        }
        _ => "smooth".into(),
    }
}

fn matrices(case: &Case, one: &Unknown) -> Value {
    let name = |term: &usize| case.model.terms()[*term].name.clone();
    match &one.dependence {
        Dependence::Factor(terms) => json!(terms.iter().map(name).collect::<Vec<_>>()),
        Dependence::Powers(powers) => {
            json!(powers.iter().map(|(term, power)| (name(term), json!(power))).collect::<Map<_, _>>())
        }
    }
}

/// How far an unknown is from what a simulated measurement was made with; one that holds for the band by its value at the middle, in its deviations.
fn reference_json(wanted: &IdentifyCase, run: &IdentifyRun, j: usize) -> Value {
    let Some(reference) = &wanted.reference[j] else { return Value::Null };
    if wanted.unknowns[j].varies != Variation::PerFrequency {
        let at = &run.found.lines[run.found.lines.len() / 2];
        let (Ok(exact), Some(found)) = (reference.at(at.frequency_hz), at.values[j].value) else {
            return Value::Null;
        };
        let bars = at.values[j].uncertainty;
        let parts = [
            Some(found.re - exact.re).zip(bars.map(|bars| bars.storage_std)),
            Some(loss_factor(found) - loss_factor(exact)).zip(bars.and_then(|bars| bars.loss_factor_std)),
        ];
        let deviations = parts.into_iter().flatten().map(|(off, std)| (off / std).abs()).reduce(f64::max);
        let relative = (found - exact).norm() / exact.norm();
        return json!({"relative": relative, "deviations": finite(deviations)});
    }
    let off: Vec<Option<(f64, bool)>> = run
        .found
        .lines
        .iter()
        .map(|at| {
            let exact = reference.at(at.frequency_hz).ok()?;
            let value = at.values[j].value?;
            Some(((value - exact).norm() / exact.norm(), at.status == Status::Ok))
        })
        .collect();
    let right = off.iter().flatten().filter(|(off, _)| *off <= RIGHT_WITHIN).count();
    let largest = off.iter().flatten().filter(|(_, ok)| *ok).map(|(off, _)| *off).reduce(f64::max);
    let wrong_and_ok = off.iter().flatten().filter(|(off, ok)| *ok && *off > RIGHT_WITHIN).count();
    json!({
        "within": RIGHT_WITHIN,
        "fraction_right": right as f64 / off.len().max(1) as f64,
        "wrong_and_ok": wrong_and_ok,
        "deviation_max_ok": largest,
    })
}

/// What a coordinate of correlation and directions stands for: `core`, `core loss_factor`, `skins e0`.
pub fn coordinate(wanted: &IdentifyCase, outcome: &Identification, c: usize) -> String {
    let (of, number) = &outcome.identifiability.coordinates[c];
    match *of {
        NumberOf::Unknown(j) if number == "value" => wanted.unknowns[j].name.clone(),
        NumberOf::Unknown(j) => format!("{} {number}", wanted.unknowns[j].name),
        NumberOf::Channel(m) => format!("{number} of measurement {}", m + 1),
    }
}

/// The combinations that the measurements do not tell, in words.
pub fn not_told(wanted: &IdentifyCase, outcome: &Identification) -> Vec<String> {
    let sentence = |direction: &Direction| {
        let largest = direction.weights.first().map_or(1.0, |(_, weight)| weight.abs());
        let mut up = Vec::new();
        let mut down = Vec::new();
        for &(c, weight) in direction.weights.iter().filter(|(_, weight)| weight.abs() >= SMALL * largest) {
            let part = weight.abs() / largest;
            let name = coordinate(wanted, outcome, c);
            let told =
                if (part - 1.0).abs() < 0.01 { name } else { format!("{name} (by {part:.2} of that)") };
            if weight > 0.0 { up.push(told) } else { down.push(told) }
        }
        let both = match (up.as_slice(), down.as_slice()) {
            ([one], []) | ([], [one]) => one.clone(),
            (up, []) => format!("{} all larger together", up.join(", ")),
            (up, down) => format!("{} larger with {} smaller", up.join(", "), down.join(", ")),
        };
        match direction.std.is_finite() && direction.std < 10.0 {
            true => format!("{both}: ±{:.0} %", 100.0 * direction.std),
            false => format!("{both}: not identifiable"),
        }
    };
    outcome
        .identifiability
        .directions
        .iter()
        .filter(|direction| direction.std > UNTOLD)
        .map(sentence)
        .collect()
}

/// What a person reads first.
pub fn several_text(wanted: &IdentifyCase, run: &IdentifyRun) -> Words {
    let outcome = &run.found;
    let mut words = Words::default();
    let mut add = |is_warning: bool, label: &str, value: String| {
        words.add(is_warning, &format!("  {label:<17} {value}\n"));
    };
    if let Some(breakdown) = &outcome.search.breakdown {
        add(true, "no answer", format!("the model has no real stand-in that can be factorised: {breakdown}"));
    }
    let statuses = Status::ALL.into_iter().filter(|&status| run.count(status) > 0);
    add(
        run.count(Status::Ok) < outcome.lines.len(),
        "frequencies",
        statuses.map(|s| format!("{} {}", run.count(s), s.name())).collect::<Vec<_>>().join(", "),
    );
    for value in &outcome.constants {
        let one = &wanted.unknowns[value.unknowns];
        let number = |n: &frfit::identify::Number| {
            let name = if n.name == "value" { String::new() } else { format!("{} ", n.name) };
            match n.std.filter(|std| std.is_finite()) {
                Some(std) if std < n.value.abs() => format!("{name}{:.6e} ± {std:.1e}", n.value),
                Some(_) => format!("{name}{:.2e}, not identifiable", n.value),
                None => format!("{name}{:.6e}", n.value),
            }
        };
        let numbers = value.numbers.iter().map(number).collect::<Vec<_>>().join(", ");
        let doubt = match value.status {
            Status::Ok => String::new(),
            _ if value.at_bound => " (at its bounds: the measurements ask for a value beyond them)".into(),
            Status::NoRoot => " (no value within the bounds solves the equations)".into(),
            Status::Unexplained => " (the model does not explain the measurements)".into(),
            Status::Failed => " (the search did not converge)".into(),
            _ => " (not identifiable from these measurements)".into(),
        };
        add(!doubt.is_empty(), &one.name, format!("{numbers}{doubt}"));
    }
    for (j, one) in
        wanted.unknowns.iter().enumerate().filter(|(_, one)| one.varies == Variation::PerFrequency)
    {
        let ok =
            outcome.lines.iter().filter(|at| at.status == Status::Ok).filter_map(|at| at.values[j].value);
        let range = |part: &dyn Fn(c64) -> f64| {
            ok.clone().map(part).fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), v| (a.min(v), b.max(v)))
        };
        let (low, high) = range(&|v| v.re);
        if low > high {
            continue;
        }
        let (least, most) = range(&|v| loss_factor(v));
        let loss = if one.real { String::new() } else { format!(", loss factor {least:.5} to {most:.5}") };
        add(false, &one.name, format!("{low:.6e} to {high:.6e}{loss} (where ok)"));
    }
    for sentence in not_told(wanted, outcome) {
        add(true, "not identifiable", sentence);
    }
    if let Some(fit) = outcome.fit {
        let sentence = match fit.verdict {
            Explained::Untested => None,
            verdict => Some(format!(
                "{} (χ² {:.4e} with {} degrees of freedom)",
                verdict.name(),
                fit.chi_squared,
                fit.freedom
            )),
        };
        if let Some(sentence) = sentence {
            add(fit.verdict != Explained::Yes, "measurements", sentence);
        }
    }
    if !outcome.search.converged {
        add(true, "search", "did not settle: more frequencies, sensors or narrower bounds may help".into());
    }
    for (j, one) in wanted.unknowns.iter().enumerate() {
        let reference = reference_json(wanted, run, j);
        if let Some(right) = reference["fraction_right"].as_f64() {
            let off = reference["deviation_max_ok"]
                .as_f64()
                .map_or(String::new(), |off| format!(", off by at most {off:.1e} where ok"));
            add(
                false,
                "right",
                format!("{}: {:.1} % within {:.0e}{off}", one.name, 100.0 * right, RIGHT_WITHIN),
            );
        } else if let Some(off) = reference["relative"].as_f64() {
            let deviations = reference["deviations"]
                .as_f64()
                .map_or(String::new(), |d| format!(", {d:.1} of its deviations"));
            add(false, "reference", format!("{}: {off:.1e} off{deviations}", one.name));
        }
    }
    add(
        false,
        "work",
        format!(
            "{} factorisations, {} solves, {:.2} s",
            outcome.search.work.factorisations,
            outcome.search.work.solves,
            run.seconds.identify()
        ),
    );
    if let Some(error) = outcome.reduction_error() {
        add(
            false,
            "subspace",
            format!(
                "{} vectors, error of the response at most {error:.1e} (estimated)",
                outcome.search.reduced_size.unwrap_or(0)
            ),
        );
    }
    words
}

/// A name as a part of a file's name: letters, digits, - and _ stay.
pub(crate) fn file_name(name: &str) -> String {
    name.chars().map(|c| if c.is_alphanumeric() || c == '-' || c == '_' { c } else { '_' }).collect()
}
