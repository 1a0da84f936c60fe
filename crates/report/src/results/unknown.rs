//! What was unknown, and what is known of it for the whole band.

use super::columns::Columns;
use super::summary::Summary;
use crate::number::with_bar;
use frfit::c64;
use frfit::identify::Status;
use frfit_formats::FormatError;
use serde_json::Value;

/// Columns of `identified.csv` that an unknown has.
const COLUMNS: [&str; 10] = [
    "storage",
    "storage_std",
    "loss_factor",
    "loss_factor_std",
    "correction_re",
    "correction_im",
    "storage_loss_correlation",
    "storage_std_noise",
    "storage_std_model",
    "storage_std_known_factors",
];

/// A number that holds for the band.
#[derive(Debug)]
pub(crate) struct Number {
    pub(crate) name: String,
    pub(crate) value: f64,
    /// `None` where it is not known, or without end.
    pub(crate) std: Option<f64>,
}

/// One unknown.
#[derive(Debug)]
pub(crate) struct Unknown {
    pub(crate) name: String,
    /// What its columns begin with: its name and a point where there are several unknowns.
    pub(crate) prefix: String,
    /// `frequency`, `smooth`, `constant` or `law`.
    pub(crate) varies: String,
    pub(crate) real: bool,
    /// `Pa` or another unit of stress, `1` where it is relative to that of the matrix; `None` where none is known.
    unit: Option<String>,
    /// `stiffness`, `mass` or `viscous`: what the first of its matrices is; `None` of a geometric parameter.
    role: Option<String>,
    /// Its numbers, where it holds for the band.
    pub(crate) numbers: Vec<Number>,
    /// How far they can be trusted.
    pub(crate) status: Option<Status>,
    /// How near the reference it is, as the summary says.
    pub(crate) off: Value,
    /// By frequency.
    pub(crate) nominal: Vec<Option<c64>>,
    /// By frequency, where the case gives it.
    pub(crate) reference: Vec<Option<c64>>,
}

impl Unknown {
    /// All that the summary has, without what [`Self::compare`] adds.
    pub(crate) fn read(summary: &Summary) -> Result<Vec<Self>, FormatError> {
        let all = summary.list("/unknowns")?;
        if all.is_empty() {
            return Err(summary.missing("/unknowns", "at least one"));
        }
        all.iter().map(|one| unknown(summary, one, all.len() == 1)).collect()
    }

    /// Adds nominal and true values by frequency.
    pub(crate) fn compare(&mut self, reference: &Columns) -> Result<(), FormatError> {
        self.nominal = factors(reference, &self.column("nominal"))?;
        self.reference = factors(reference, &self.column("true"))?;
        Ok(())
    }

    /// A column of this unknown.
    pub(crate) fn column(&self, part: &str) -> String {
        format!("{}{part}", self.prefix)
    }

    /// The columns of `identified.csv` that a page shows or offers: a constant is the same in every row.
    pub(crate) fn columns(&self) -> Vec<String> {
        if self.is_curve() { COLUMNS.iter().map(|part| self.column(part)).collect() } else { Vec::new() }
    }

    /// Whether a curve over frequency shows more than a number does.
    pub(crate) fn is_curve(&self) -> bool {
        self.varies != "constant"
    }

    /// Whether each frequency has a value of its own; else its numbers hold for the band.
    pub(crate) fn is_free(&self) -> bool {
        ["frequency", "smooth"].contains(&self.varies.as_str())
    }

    /// Whether one of its numbers is more than something that the search passed by.
    pub(crate) fn is_known(&self, number: &Number) -> bool {
        match number.std {
            Some(std) => std < number.value.abs(),
            // A standard deviation without end, or of noise that is not known.
            None => self.status == Some(Status::Ok),
        }
    }

    /// A number with its error bar, in its unit.
    pub(crate) fn shown(&self, number: &Number, std: Option<f64>) -> String {
        let unit = if ["storage", "value"].contains(&number.name.as_str()) { self.unit() } else { "" };
        with_bar(number.value, std, unit)
    }

    /// `Pa` or another unit of stress, or nothing where it is relative, or of something else than a modulus.
    pub(crate) fn unit(&self) -> &str {
        self.unit.as_deref().filter(|unit| *unit != "1").unwrap_or("")
    }

    /// What the real part is: as an axis has it, and in running text.
    pub(crate) fn what(&self) -> [&'static str; 2] {
        let is_relative = self.unit.as_deref() == Some("1");
        match (self.role.as_deref(), self.real) {
            (Some("stiffness"), false) if is_relative => {
                ["Storage modulus E′ (relative to the matrix)", "relative storage modulus"]
            }
            (Some("stiffness"), false) => ["Storage modulus E′", "storage modulus"],
            (Some("stiffness"), true) if !is_relative => ["Modulus E", "modulus"],
            (_, false) => ["Real part of the factor", "factor"],
            (None, true) => ["Value", "value"],
            (_, true) => ["Factor", "factor"],
        }
    }
}

fn unknown(summary: &Summary, one: &Value, is_only: bool) -> Result<Unknown, FormatError> {
    let text = |key: &str| one.get(key).and_then(Value::as_str).map(str::to_owned);
    let needed =
        |key: &str| text(key).ok_or_else(|| summary.missing("/unknowns", &format!("a text {key} of each")));
    let number = |number: &Value| {
        let name = number.get("name").and_then(Value::as_str)?.to_owned();
        let value = number.get("value").and_then(Value::as_f64)?;
        Some(Number { name, value, std: number.get("std").and_then(Value::as_f64) })
    };
    let numbers = one.get("numbers").and_then(Value::as_array).into_iter().flatten();
    let status = match text("status") {
        None => None,
        Some(word) => {
            Some(Status::named(&word).ok_or_else(|| summary.missing("/unknowns", "a status of each"))?)
        }
    };
    let name = needed("name")?;
    Ok(Unknown {
        prefix: if is_only { String::new() } else { format!("{name}.") },
        varies: needed("varies")?,
        real: one.get("real").and_then(Value::as_bool) == Some(true),
        unit: text("unit"),
        role: one.pointer("/matrices/0").and_then(Value::as_str).map(|matrix| summary.role(matrix)),
        numbers: numbers.filter_map(number).collect(),
        status,
        off: one.get("reference").cloned().unwrap_or(Value::Null),
        nominal: Vec::new(),
        reference: Vec::new(),
        name,
    })
}

/// Columns `<what>_re` and `<what>_im`.
fn factors(table: &Columns, what: &str) -> Result<Vec<Option<c64>>, FormatError> {
    let re = table.numbers(&format!("{what}_re"))?;
    let im = table.numbers(&format!("{what}_im"))?;
    Ok(re.into_iter().zip(im).map(|(re, im)| Some(c64::new(re?, im?))).collect())
}
