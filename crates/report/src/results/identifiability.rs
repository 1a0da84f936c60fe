//! How well the numbers that hold for the band are identifiable.

use super::summary::Summary;
use frfit_formats::FormatError;
use serde_json::Value;

/// A combination of numbers.
#[derive(Debug)]
pub(crate) struct Combination {
    /// Its standard deviation; `None` where it is without end.
    pub(crate) std: Option<f64>,
    /// What it is made of, the largest first.
    pub(crate) weights: Vec<(String, f64)>,
}

/// How well the numbers that hold for the band are identifiable.
#[derive(Debug)]
pub(crate) struct Identifiability {
    /// What row and column of [`Self::correlation`] stand for.
    pub(crate) coordinates: Vec<String>,
    /// `None` where one of the two is not known.
    pub(crate) correlation: Vec<Vec<Option<f64>>>,
    /// What is not identifiable from the measurements, in sentences.
    pub(crate) not_identifiable: Vec<String>,
    /// The least identifiable combination.
    pub(crate) least: Option<Combination>,
    /// Distance along it, and Δχ².
    pub(crate) profile: Vec<(f64, f64)>,
}

impl Identifiability {
    pub(crate) fn read(summary: &Summary) -> Result<Self, FormatError> {
        let coordinates = summary.texts("/coordinates", Value::as_str)?;
        let count = coordinates.len();
        let refuse = || summary.missing("/correlation", &format!("{count} rows of {count}"));
        let row = |row: &Value| {
            let row = row.as_array().filter(|row| row.len() == count).ok_or_else(refuse)?;
            Ok(row.iter().map(Value::as_f64).collect::<Vec<_>>())
        };
        let correlation = summary.list("/correlation")?.iter().map(row);
        let correlation = correlation.collect::<Result<Vec<_>, FormatError>>()?;
        // A run that found nothing has none.
        if correlation.len() != count {
            return Err(refuse());
        }
        let weight = |weight: &Value| {
            Some((weight.get("of")?.as_str()?.to_owned(), weight.get("weight").and_then(Value::as_f64)?))
        };
        let least = summary.list("/directions")?.first().map(|direction| {
            let weights = direction.get("weights").and_then(Value::as_array);
            let weights = weights.into_iter().flatten().filter_map(weight).collect();
            Combination { std: direction.get("std").and_then(Value::as_f64), weights }
        });
        let point = |point: &Value| Some((point.get(0)?.as_f64()?, point.get(1)?.as_f64()?));
        Ok(Self {
            coordinates,
            correlation,
            not_identifiable: summary.texts("/not_identifiable", Value::as_str)?,
            least,
            profile: summary.array("/profile").iter().filter_map(point).collect(),
        })
    }
}
