//! Frequency response functions: a frequency, real and imaginary part or magnitude and phase\[, coherence\]\[, std\], and
//! `# decay_per_s = 6` of a windowed one.

use num_complex::Complex64 as c64;
use std::f64::consts::PI;

use super::Table;
use super::time_records::name_and_unit;
use crate::FormatError;
use crate::text::{Lines, number, quoted};

/// A measured frequency response function, sorted by frequency.
#[derive(Debug, Clone, PartialEq)]
pub struct FrfTable {
    /// Frequencies in hertz, strictly ascending.
    pub frequency_hz: Vec<f64>,
    /// The complex response at each frequency.
    pub response: Vec<c64>,
    /// Coherence γ² of each value, from 0 to 1.
    pub coherence: Option<Vec<f64>>,
    /// Standard deviation of each complex value, √E|δH|².
    pub std: Option<Vec<f64>>,
    /// What a comment line `# decay_per_s = 6` says: the decay rate in 1/s of an exponential window on both channels.
    pub decay_per_s: Option<f64>,
}

/// What a column of an FRF holds.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Column {
    /// Of so many hertz each.
    Frequency(f64),
    Real,
    Imaginary,
    Magnitude,
    /// 20 log₁₀ of the magnitude in SI units.
    Decibel,
    /// Of so many radians each.
    Phase(f64),
    Coherence,
    Std,
}

/// The columns that an FRF may have, as errors list them.
const COLUMNS: &str = "frequency_hz, re, im, magnitude, magnitude_db, phase_deg, phase_rad, coherence, std";

/// The units of a value that are SI.
const SI: [&str; 12] = [
    "",
    "m/N",
    "m/s/N",
    "(m/s)/N",
    "m/s^2/N",
    "m/s²/N",
    "(m/s^2)/N",
    "(m/s²)/N",
    "m/(N s)",
    "m/(Ns)",
    "1/kg",
    "s/kg",
];

impl Column {
    /// What a column with this name holds, or what is wrong with the name (expected, found).
    ///
    /// `Frequency (Hz)`, `frequency [Hz]` and `frequency_hz` are the same. A frequency without a unit is in hertz; a phase
    /// without a unit is refused, for degrees and radians are both usual.
    fn of(name: &str) -> Result<Self, (String, String)> {
        let (plain, unit) = name_and_unit(name);
        let plain = plain.to_ascii_lowercase().replace([' ', '-'], "_");
        let (stem, suffix) = ["hz", "khz", "rad_s", "db", "deg", "rad"]
            .into_iter()
            .filter_map(|suffix| Some((plain.strip_suffix(suffix)?.strip_suffix('_')?, suffix)))
            .next_back()
            .unwrap_or((&plain, ""));
        let lower = unit.to_ascii_lowercase();
        let of_unit = if suffix.is_empty() { lower.as_str() } else { suffix };
        let refuse = |expected: &str| Err((expected.to_owned(), quoted(name.as_bytes())));
        let value =
            |column: Self| match SI.iter().any(|si| si.eq_ignore_ascii_case(&unit)) && suffix.is_empty() {
                true => Ok(column),
                false => refuse("values in m, s, N and kg (scale of [[measurement]] has the factor)"),
            };
        match stem {
            "frequency" | "freq" | "f" => match of_unit {
                "" | "hz" => Ok(Self::Frequency(1.0)),
                "khz" => Ok(Self::Frequency(1e3)),
                "rad/s" | "rad_s" => Ok(Self::Frequency(0.5 / PI)),
                _ => refuse("a frequency in Hz, kHz or rad/s"),
            },
            "re" | "real" | "real_part" => value(Self::Real),
            "im" | "imag" | "imaginary" | "imag_part" | "imaginary_part" => value(Self::Imaginary),
            "magnitude" | "mag" | "amplitude" | "abs" => match of_unit {
                "db" => Ok(Self::Decibel),
                _ => value(Self::Magnitude),
            },
            "phase" | "angle" | "arg" => match of_unit {
                "deg" | "degree" | "degrees" | "°" => Ok(Self::Phase(PI / 180.0)),
                "rad" | "radian" | "radians" => Ok(Self::Phase(1.0)),
                _ => refuse("the unit of the phase, as in phase_deg or \"phase (rad)\""),
            },
            "coherence" | "coh" if of_unit.is_empty() => Ok(Self::Coherence),
            "std" if of_unit.is_empty() => Ok(Self::Std),
            _ => {
                let known = COLUMNS.split(", ");
                let hint =
                    super::columns::nearest(name, known).map(|near| format!("; did you mean {near:?}?"));
                let found = match name {
                    "" => "a column without a name".into(),
                    _ => format!("{}{}", quoted(name.as_bytes()), hint.unwrap_or_default()),
                };
                Err((format!("one of the columns {COLUMNS}"), found))
            }
        }
    }
}

/// Where the columns of an FRF are.
struct Columns {
    frequency: (usize, f64),
    value: Value,
    coherence: Option<usize>,
    std: Option<usize>,
}

/// How a complex value is written.
enum Value {
    Parts { re: usize, im: usize },
    Polar { magnitude: usize, is_db: bool, phase: usize, radians: f64 },
}

impl Columns {
    fn of(table: &Table) -> Result<Self, FormatError> {
        let mut found: Vec<(usize, Column)> = Vec::new();
        for (index, name) in table.names().enumerate() {
            // What a caller names so is left out.
            if name == LEFT_OUT {
                continue;
            }
            let column =
                Column::of(name).map_err(|(expected, found)| table.name_error(index, expected, found))?;
            let same = |one: &&(usize, Column)| {
                std::mem::discriminant(&one.1) == std::mem::discriminant(&column)
                    || matches!(
                        (one.1, column),
                        (Column::Magnitude, Column::Decibel) | (Column::Decibel, Column::Magnitude)
                    )
            };
            if let Some((first, _)) = found.iter().find(same) {
                let first = table.names().nth(*first).unwrap_or_default();
                let expected = format!("one column such as {first:?}");
                return Err(table.name_error(index, expected, "a second one".into()));
            }
            found.push((index, column));
        }
        let at = |wanted: fn(Column) -> bool| found.iter().find(|(_, column)| wanted(*column)).copied();
        let missing = |name: &str| {
            let expected = format!("a column {name:?}");
            FormatError::line(table.names_line(), expected, format!("only {}", table.listed()))
        };
        let frequency = at(|column| matches!(column, Column::Frequency(_)));
        let (re, im) = (at(|column| column == Column::Real), at(|column| column == Column::Imaginary));
        let magnitude = at(|column| matches!(column, Column::Magnitude | Column::Decibel));
        let phase = at(|column| matches!(column, Column::Phase(_)));
        let value = match (re, im, magnitude, phase) {
            (Some((re, _)), Some((im, _)), None, None) => Value::Parts { re, im },
            (None, None, Some((magnitude, column)), Some((phase, Column::Phase(radians)))) => {
                Value::Polar { magnitude, is_db: column == Column::Decibel, phase, radians }
            }
            (None, None, Some(_), None) => return Err(missing("phase_deg")),
            (None, None, None, Some(_)) => return Err(missing("magnitude")),
            (Some(_), None, None, None) => return Err(missing("im")),
            (_, _, None, None) => return Err(missing("re")),
            _ => {
                let expected = "re and im, or a magnitude and a phase";
                return Err(FormatError::line(table.names_line(), expected, table.listed()));
            }
        };
        let Some((frequency, Column::Frequency(hertz))) = frequency else {
            return Err(missing("frequency_hz"));
        };
        Ok(Self {
            frequency: (frequency, hertz),
            value,
            coherence: at(|column| column == Column::Coherence).map(|(index, _)| index),
            std: at(|column| column == Column::Std).map(|(index, _)| index),
        })
    }

    fn response(&self, table: &Table, row: usize) -> Result<c64, FormatError> {
        match self.value {
            Value::Parts { re, im } => Ok(c64::new(table.number(row, re)?, table.number(row, im)?)),
            Value::Polar { magnitude, is_db, phase, radians } => {
                let size = match is_db {
                    true => 10.0_f64.powf(table.number(row, magnitude)? / 20.0),
                    false => checked(table, row, magnitude, "a number from 0 on", |x| x >= 0.0)?,
                };
                Ok(c64::from_polar(size, radians * table.number(row, phase)?))
            }
        }
    }
}

/// The name that a caller gives to a column that is not to be read.
const LEFT_OUT: &str = "-";

/// Reads a frequency response function. Its columns are found by their names, upper and lower case alike:
///
/// | column | names | units |
/// |---|---|---|
/// | frequency | `frequency`, `freq`, `f` | Hz (also without a unit), kHz, rad/s |
/// | real, imaginary part | `re`, `real`; `im`, `imag`, `imaginary` | SI |
/// | or magnitude | `magnitude`, `mag`, `amplitude`, `abs` | SI, or dB re 1 of it |
/// | and phase | `phase`, `angle`, `arg` | deg, rad |
/// | coherence γ², standard deviation | `coherence`, `std` | those of the value |
///
/// A unit stands in brackets, `Phase (deg)`, or at the end of the name, `phase_deg`.
///
/// # Errors
/// What [`Table::read`] refuses; a column that is missing or unknown; no line of data; a negative or repeated
/// frequency; a negative magnitude; a coherence outside 0…1; a negative std; a cell that is no finite number; a comment `decay_per_s =` without a number from 0 on, or two that differ.
pub fn read_frf(bytes: &[u8]) -> Result<FrfTable, FormatError> {
    frf_of(&Table::read(bytes)?, bytes)
}

/// The same of a table whose columns have other names, or none: `names` are those of [`read_frf`], in the order of the columns, and `-` for a column that
/// is not to be read. A first line that is not all numbers is that of the table's own names, and is passed over.
///
/// # Errors
/// As [`read_frf`]; another number of columns.
pub fn read_frf_named(bytes: &[u8], names: &[&str]) -> Result<FrfTable, FormatError> {
    frf_of(&Table::read_named(bytes, names)?, bytes)
}

fn frf_of(table: &Table, bytes: &[u8]) -> Result<FrfTable, FormatError> {
    let columns = Columns::of(table)?;
    table.at_least_one_row()?;
    let (frequency, hertz) = columns.frequency;
    let (mut frequency_hz, order) = ascending_frequencies(table, frequency, 0..table.rows())?;
    if hertz != 1.0 {
        frequency_hz.iter_mut().for_each(|f| *f *= hertz);
    }
    let optional = |column: Option<usize>, expected: &str, most: f64| {
        let of = |column| {
            let value = |&row: &usize| checked(table, row, column, expected, |x| (0.0..=most).contains(&x));
            order.iter().map(value).collect::<Result<Vec<f64>, FormatError>>()
        };
        column.map(of).transpose()
    };
    Ok(FrfTable {
        frequency_hz,
        decay_per_s: decay(bytes)?,
        coherence: optional(columns.coherence, "a number from 0 to 1", 1.0)?,
        std: optional(columns.std, "a number from 0 on", f64::MAX)?,
        response: order.iter().map(|&row| columns.response(table, row)).collect::<Result<_, _>>()?,
    })
}

/// What comment lines `# decay_per_s = 6` say.
fn decay(bytes: &[u8]) -> Result<Option<f64>, FormatError> {
    let mut found = None;
    for line in Lines::new(bytes) {
        let Some(comment) = line.bytes.trim_ascii_start().strip_prefix(b"#") else { continue };
        let Some(said) = decay_said(comment) else { continue };
        let of_line = |expected: &str, found: String| FormatError::line(line.number, expected, found);
        let shown = || String::from_utf8_lossy(comment.trim_ascii()).into_owned();
        let value = said.ok_or_else(|| of_line(DECAY, shown()))?;
        if let Some(before) = found.replace(value).filter(|before| *before != value) {
            return Err(of_line("one decay_per_s", format!("{value} after {before}")));
        }
    }
    Ok(found)
}

const DECAY: &str = "decay_per_s = a number of 1/s from 0 on";

/// What a line of text says about the decay rate of an exponential window: `decay_per_s = 6`, in 1/s. `None` if it does not mention it, `Some(None)` if the value is no number from 0 on.
pub fn decay_said(text: &[u8]) -> Option<Option<f64>> {
    let rest = text.trim_ascii().strip_prefix(b"decay_per_s")?.trim_ascii_start().strip_prefix(b"=")?;
    Some(number(rest.trim_ascii()).filter(|value| *value >= 0.0))
}

/// The frequencies of some rows in ascending order, and the rows in that order.
pub(super) fn ascending_frequencies(
    table: &Table,
    column: usize,
    rows: impl Iterator<Item = usize>,
) -> Result<(Vec<f64>, Vec<usize>), FormatError> {
    let mut order = rows
        .map(|row| Ok((checked(table, row, column, "a number from 0 on", |x| x >= 0.0)?, row)))
        .collect::<Result<Vec<_>, FormatError>>()?;
    order.sort_by(|a, b| a.0.total_cmp(&b.0));
    for pair in order.windows(2) {
        if pair[0].0 == pair[1].0 {
            let (first, second) = (pair[0].1.min(pair[1].1), pair[0].1.max(pair[1].1));
            let found = format!("{} again, first in line {}", table.shown(second, column), table.line(first));
            return Err(table.error(second, column, "each frequency once", found));
        }
    }
    Ok(order.into_iter().unzip())
}

/// A number with a property.
pub(super) fn checked(
    table: &Table,
    row: usize,
    column: usize,
    expected: &str,
    is_good: impl Fn(f64) -> bool,
) -> Result<f64, FormatError> {
    let value = table.number(row, column)?;
    match is_good(value) {
        true => Ok(value),
        false => Err(table.error(row, column, expected, table.shown(row, column))),
    }
}
