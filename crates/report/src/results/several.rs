//! What a run with several unknowns has besides: the unknowns, and how those that hold for the band hang together.

use super::columns::Columns;
use super::reference::factors;
use super::summary::Summary;
use frfit::c64;
use frfit::identify::Status;
use frfit_formats::FormatError;
use serde_json::Value;

/// Columns of `identified.csv` that belong to no unknown.
const SHARED: [&str; 3] = ["error", "chi2", "reduction_error"];

/// A number that holds for the band.
#[derive(Debug)]
pub(crate) struct Number {
    pub(crate) name: String,
    pub(crate) value: f64,
    /// `None` where nothing tells it.
    pub(crate) std: Option<f64>,
}

/// One unknown.
#[derive(Debug)]
pub(crate) struct Unknown {
    pub(crate) name: String,
    /// `frequency`, `constant`, or `law` and its name.
    pub(crate) varies: String,
    pub(crate) real: bool,
    /// Its numbers, where it holds for the band.
    pub(crate) numbers: Vec<Number>,
    /// How far they can be trusted.
    pub(crate) status: Option<Status>,
    /// By frequency.
    pub(crate) nominal: Vec<Option<c64>>,
    /// By frequency, where the case tells it.
    pub(crate) reference: Vec<Option<c64>>,
    /// How far from it the answer is, as the summary says it.
    pub(crate) off: Value,
}

impl Unknown {
    /// Whether a curve over frequency shows more than a number does.
    pub(crate) fn is_curve(&self) -> bool {
        self.varies != "constant"
    }

    /// Whether one of its numbers is more than something that the search passed by.
    pub(crate) fn is_told(&self, number: &Number) -> bool {
        match number.std {
            Some(std) => std < number.value.abs(),
            // A deviation without end, or of noise that nothing tells.
            None => self.status == Some(Status::Ok),
        }
    }

    /// Columns of `identified.csv`: value and its deviation, loss factor and its deviation.
    pub(crate) fn columns(&self) -> [Option<String>; 4] {
        let named = |part: &str| Some(format!("{}.{part}", self.name));
        match self.real {
            true => [named("value"), named("std"), None, None],
            false => ["storage", "storage_std", "loss_factor", "loss_factor_std"].map(named),
        }
    }
}

/// A combination of numbers.
#[derive(Debug)]
pub(crate) struct Worst {
    /// Its deviation; `None` where nothing tells it.
    pub(crate) std: Option<f64>,
    /// What it is made of, the largest first.
    pub(crate) weights: Vec<(String, f64)>,
}

/// What holds of all of them.
#[derive(Debug)]
pub(crate) struct Several {
    pub(crate) unknowns: Vec<Unknown>,
    /// What row and column of [`Self::correlation`] stand for.
    pub(crate) coordinates: Vec<String>,
    /// `None` where nothing tells one of the two.
    pub(crate) correlation: Vec<Vec<Option<f64>>>,
    /// What the measurements cannot tell, in sentences.
    pub(crate) not_told: Vec<String>,
    /// The direction that is told worst.
    pub(crate) worst: Option<Worst>,
    /// Distance along it, and Δχ².
    pub(crate) profile: Vec<(f64, f64)>,
    pub(crate) converged: bool,
}

impl Several {
    pub(crate) fn read(summary: &Summary, reference: &Columns) -> Result<Self, FormatError> {
        let list = |pointer: &str| {
            summary
                .0
                .pointer(pointer)
                .and_then(Value::as_array)
                .ok_or_else(|| summary.missing(pointer, "a list"))
        };
        let unknowns = list("/unknowns")?.iter().map(|one| unknown(summary, one, reference));
        let coordinates = summary.texts("/coordinates", Value::as_str)?;
        let count = coordinates.len();
        let row = |row: &Value| {
            let row = row.as_array().filter(|row| row.len() == count);
            let row =
                row.ok_or_else(|| summary.missing("/correlation", &format!("{count} rows of {count}")))?;
            Ok(row.iter().map(Value::as_f64).collect::<Vec<_>>())
        };
        let correlation = list("/correlation")?.iter().map(row).collect::<Result<Vec<_>, FormatError>>()?;
        // A run that found nothing has none.
        if correlation.len() != count {
            return Err(summary.missing("/correlation", &format!("{count} rows of {count}")));
        }
        let weight = |weight: &Value| {
            Some((weight.get("of")?.as_str()?.to_owned(), weight.get("weight").and_then(Value::as_f64)?))
        };
        let worst = list("/directions")?.first().map(|direction| {
            let weights = direction.get("weights").and_then(Value::as_array);
            let weights = weights.into_iter().flatten().filter_map(weight).collect();
            Worst { std: direction.get("std").and_then(Value::as_f64), weights }
        });
        let point = |point: &Value| Some((point.get(0)?.as_f64()?, point.get(1)?.as_f64()?));
        Ok(Self {
            unknowns: unknowns.collect::<Result<_, _>>()?,
            coordinates,
            correlation,
            not_told: summary.texts("/not_told", Value::as_str)?,
            worst,
            profile: summary.array("/profile").iter().filter_map(point).collect(),
            converged: summary.0.pointer("/search/converged").and_then(Value::as_bool) == Some(true),
        })
    }

    /// The columns of `identified.csv` that a page shows.
    pub(crate) fn columns(summary: &Summary) -> Vec<String> {
        let of_one = |one: &Value| {
            let name = one.get("name").and_then(Value::as_str).unwrap_or("");
            let real = one.get("real").and_then(Value::as_bool) == Some(true);
            let parts: &[&str] = if real {
                &["value", "std"]
            } else {
                &["storage", "storage_std", "loss_factor", "loss_factor_std"]
            };
            parts.iter().map(|part| format!("{name}.{part}")).collect::<Vec<_>>()
        };
        // A constant is the same in every row.
        let vary = summary.array("/unknowns").iter();
        let vary = vary.filter(|one| one.get("varies").and_then(Value::as_str) != Some("constant"));
        SHARED.into_iter().map(str::to_owned).chain(vary.flat_map(of_one)).collect()
    }
}

fn unknown(summary: &Summary, one: &Value, reference: &Columns) -> Result<Unknown, FormatError> {
    let text = |key: &str| {
        let text = one.get(key).and_then(Value::as_str);
        text.map(str::to_owned).ok_or_else(|| summary.missing("/unknowns", &format!("a text {key} of each")))
    };
    let name = text("name")?;
    let number = |number: &Value| {
        let name = number.get("name").and_then(Value::as_str)?.to_owned();
        let value = number.get("value").and_then(Value::as_f64)?;
        Some(Number { name, value, std: number.get("std").and_then(Value::as_f64) })
    };
    let numbers = one.get("numbers").and_then(Value::as_array).into_iter().flatten();
    let status = match one.get("status").and_then(Value::as_str) {
        None => None,
        Some(word) => {
            let found = Status::ALL.into_iter().find(|status| status.name() == word);
            Some(found.ok_or_else(|| summary.missing("/unknowns", "a status of each"))?)
        }
    };
    Ok(Unknown {
        varies: text("varies")?,
        real: one.get("real").and_then(Value::as_bool) == Some(true),
        numbers: numbers.filter_map(number).collect(),
        status,
        nominal: factors(reference, &format!("{name}.nominal"))?,
        reference: factors(reference, &format!("{name}.true"))?,
        off: one.get("reference").cloned().unwrap_or(Value::Null),
        name,
    })
}
