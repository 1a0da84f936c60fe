//! Tables of a measured modulus: what `frfit identify` writes, and what instruments for dynamic mechanical analysis do.

use super::Table;
use super::frf::{ascending_frequencies, checked};
use crate::FormatError;

/// A measured modulus over frequency, sorted by frequency.
#[derive(Debug, Clone, PartialEq)]
pub struct ModulusData {
    /// Frequencies in hertz, strictly ascending, above zero.
    pub frequency_hz: Vec<f64>,
    /// E′ in pascal, or in the unit of the table where it names none.
    pub storage: Vec<f64>,
    /// η = E″/E′.
    pub loss_factor: Vec<f64>,
    /// Standard deviations of E′ and η.
    pub std: Option<Vec<[f64; 2]>>,
    /// Rows that were left out: without a modulus, or with another status than `ok`.
    pub left_out: usize,
    /// Whether the table names its unit of E′, which then is in pascal.
    pub names_unit: bool,
}

/// Names of the columns, the first that of `identified.csv`.
const FREQUENCY: [&str; 5] = ["frequency_hz", "frequency", "freq", "f", "f_hz"];
const STORAGE: [&str; 4] = ["storage", "storage_modulus", "e_stor", "e'"];
const LOSS_FACTOR: [&str; 4] = ["loss_factor", "tan_delta", "tan_del", "eta"];
const LOSS: [&str; 4] = ["loss", "loss_modulus", "e_loss", "e''"];

/// Reads a table of a measured modulus.
///
/// | column | names |
/// |---|---|
/// | frequency | frequency_hz, frequency, freq, f, f_hz |
/// | E′ | storage, storage_modulus, E_stor, E' |
/// | η or E″ | loss_factor, tan_delta, tan_del, eta; or loss, loss_modulus, E_loss, E'' |
/// | standard deviations, both or none, in all rows or in none | storage_std, loss_factor_std |
/// | status | status: only rows that say `ok` are used |
///
/// Upper and lower case are the same, other columns are passed over. The first line below the names may give units: Hz, kHz or rad/s, and Pa, kPa, MPa, GPa, psi, psf or dyn/cm^2;
/// E′ and E″ then come out in pascal. Rows in which both cells of the modulus are empty are left out.
///
/// # Errors
/// What [`Table::read`] refuses; a column that is missing, or given twice under two names; an unknown unit; a frequency that is not positive or repeated, as where one table
/// holds several temperatures; a cell that is no finite number; a standard deviation that is not positive, or only one of the two; no row to use.
pub fn read_modulus_data(bytes: &[u8]) -> Result<ModulusData, FormatError> {
    read(bytes, None)
}

/// As [`read_modulus_data`], of the rows alone whose cell in a column has this value: the same text, or the same number. One table of several temperatures is read so.
///
/// # Errors
/// As [`read_modulus_data`]; a column that is not there, or in which no row has the value: the error lists those that it has.
pub fn read_modulus_data_where(bytes: &[u8], column: &str, value: &str) -> Result<ModulusData, FormatError> {
    read(bytes, Some((column, value)))
}

/// Values of a column that an error lists at most.
const LISTED: usize = 12;

/// The rows from `first` on whose cell has this value.
fn rows_where(table: &Table, first: usize, column: &str, value: &str) -> Result<Vec<usize>, FormatError> {
    let at = table.column(column)?;
    let number = |text: &str| text.parse::<f64>().ok();
    let same = |text: &str| text == value || number(value).is_some_and(|value| number(text) == Some(value));
    let rows: Vec<usize> = (first..table.rows()).filter(|&row| same(table.text(row, at))).collect();
    if rows.is_empty() {
        let mut there: Vec<&str> = Vec::new();
        for text in (first..table.rows()).map(|row| table.text(row, at)) {
            if !there.contains(&text) {
                there.push(text);
            }
        }
        let more =
            if there.len() > LISTED { format!(" and {} more", there.len() - LISTED) } else { String::new() };
        there.truncate(LISTED);
        let expected = format!("a row with {value:?} in column {column:?}");
        return Err(FormatError::line(
            table.names_line(),
            expected,
            format!("only {}{more}", there.join(", ")),
        ));
    }
    Ok(rows)
}

fn read(bytes: &[u8], only: Option<(&str, &str)>) -> Result<ModulusData, FormatError> {
    let table = Table::read(bytes)?;
    let Columns { frequency, storage, loss, is_factor, deviations, status, first, hz, pascal, loss_unit } =
        Columns::of(&table)?;
    let used = |&row: &usize| {
        let answered = !(table.is_empty(row, storage) && table.is_empty(row, loss));
        answered && status.is_none_or(|status| table.text(row, status) == "ok")
    };
    let all = match only {
        Some((column, value)) => rows_where(&table, first, column, value)?,
        None => (first..table.rows()).collect(),
    };
    let rows: Vec<usize> = all.iter().copied().filter(used).collect();
    let left_out = all.len() - rows.len();
    if rows.is_empty() {
        let expected = "at least one line with a modulus (and the status ok) below the names";
        return Err(FormatError::line(table.names_line(), expected, "none"));
    }
    let (frequency_hz, order) = ascending_frequencies(&table, frequency, rows.into_iter())?;
    let positive = |row, column| checked(&table, row, column, "a number above 0", |x| x > 0.0);
    positive(order[0], frequency)?;
    let storage_values = order.iter().map(|&row| Ok(pascal * positive(row, storage)?));
    let storage_values = storage_values.collect::<Result<Vec<f64>, FormatError>>()?;
    let eta = |(&row, e): (&usize, &f64)| {
        let value = table.number(row, loss)?;
        Ok(if is_factor { value } else { loss_unit * value / e })
    };
    let loss_factor = order.iter().zip(&storage_values).map(eta).collect::<Result<_, FormatError>>()?;
    let pair = |[a, b]: [usize; 2]| {
        let of = |&row: &usize| Ok([pascal * positive(row, a)?, positive(row, b)?]);
        order.iter().map(of).collect::<Result<Vec<_>, FormatError>>()
    };
    // Where nothing was known of the noise, all cells of the standard deviations are empty: that is a table without them.
    let is_given = |columns: &[usize; 2]| {
        order.iter().any(|&row| columns.iter().any(|&column| !table.is_empty(row, column)))
    };
    Ok(ModulusData {
        std: deviations.filter(is_given).map(pair).transpose()?,
        frequency_hz: frequency_hz.into_iter().map(|f| hz * f).collect(),
        storage: storage_values,
        loss_factor,
        left_out,
        names_unit: first > 0,
    })
}

/// Where a table has what a modulus is made of, and in which units.
#[derive(Debug, Clone, Copy)]
pub(super) struct Columns {
    pub(super) frequency: usize,
    pub(super) storage: usize,
    /// η, or E″ where `is_factor` is false.
    pub(super) loss: usize,
    pub(super) is_factor: bool,
    pub(super) deviations: Option<[usize; 2]>,
    pub(super) status: Option<usize>,
    /// The first row of numbers: 1 where units are below the names.
    pub(super) first: usize,
    /// What the units are in SI units.
    pub(super) hz: f64,
    pub(super) pascal: f64,
    pub(super) loss_unit: f64,
}

impl Columns {
    /// The columns by their names.
    ///
    /// # Errors
    /// A column that is missing, or given twice under two names; an unknown unit.
    pub(super) fn of(table: &Table) -> Result<Self, FormatError> {
        let frequency = needed(table, &FREQUENCY)?;
        let storage = needed(table, &STORAGE)?;
        let (loss, is_factor) = match (one_of(table, &LOSS_FACTOR)?, one_of(table, &LOSS)?) {
            (Some(_), Some(second)) => {
                let expected = "one of the columns loss_factor and loss";
                return Err(table.name_error(second, expected.into(), "a second one".into()));
            }
            (None, Some(loss)) => (loss, false),
            (Some(loss), None) => (loss, true),
            (None, None) => {
                let expected = "a column \"loss_factor\" or \"loss\"";
                return Err(FormatError::line(
                    table.names_line(),
                    expected,
                    format!("only {}", table.listed()),
                ));
            }
        };
        let deviations = match (table.find("storage_std")?, table.find("loss_factor_std")?) {
            (Some(storage), Some(eta)) => Some([storage, eta]),
            (None, None) => None,
            (Some(one), None) | (None, Some(one)) => {
                let expected = "both columns storage_std and loss_factor_std, or none".into();
                return Err(table.name_error(one, expected, "one of them".into()));
            }
        };
        let status = table.find("status")?;
        let units = has_units(table, [frequency, storage]);
        let [hz, pascal, loss_unit] = match units {
            true => [
                unit(table, frequency, &HERTZ)?,
                unit(table, storage, &PASCAL)?,
                if is_factor { 1.0 } else { unit(table, loss, &PASCAL)? },
            ],
            false => [1.0; 3],
        };
        let first = usize::from(units);
        Ok(Self { frequency, storage, loss, is_factor, deviations, status, first, hz, pascal, loss_unit })
    }
}

/// The column with one of these names; `None` if no column has one.
fn one_of(table: &Table, names: &[&str]) -> Result<Option<usize>, FormatError> {
    let mut found = None;
    for name in names {
        match (found, table.find(name)?) {
            (Some(_), Some(second)) => {
                let expected = format!("one of the columns {}", names.join(", "));
                return Err(table.name_error(second, expected, "a second one".into()));
            }
            (None, Some(column)) => found = Some(column),
            (_, None) => {}
        }
    }
    Ok(found)
}

/// The column with one of these names, that has to be there under the first or another.
fn needed(table: &Table, names: &[&str]) -> Result<usize, FormatError> {
    one_of(table, names)?.map_or_else(|| table.column(names[0]), Ok)
}

const HERTZ: [(&str, f64); 3] = [("Hz", 1.0), ("kHz", 1e3), ("rad/s", 1.0 / std::f64::consts::TAU)];
const PASCAL: [(&str, f64); 7] = [
    ("Pa", 1.0),
    ("kPa", 1e3),
    ("MPa", 1e6),
    ("GPa", 1e9),
    ("psi", 4.448_221_615_260_5 / (0.0254 * 0.0254)),
    ("psf", 4.448_221_615_260_5 / (0.3048 * 0.3048)),
    ("dyn/cm^2", 0.1),
];

/// Whether the first row holds units: words where numbers belong.
fn has_units(table: &Table, columns: [usize; 2]) -> bool {
    let word = |column: usize| table.text(0, column).starts_with(|c: char| c.is_ascii_alphabetic());
    table.rows() > 0 && columns.into_iter().all(word)
}

/// What a column's unit is in SI units.
fn unit(table: &Table, column: usize, known: &[(&str, f64)]) -> Result<f64, FormatError> {
    let found = known.iter().find(|(name, _)| *name == table.text(0, column));
    found.map(|(_, factor)| *factor).ok_or_else(|| {
        let names: Vec<&str> = known.iter().map(|(name, _)| *name).collect();
        table.error(0, column, format!("one of the units {}", names.join(", ")), table.shown(0, column))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn identified_tables_are_read_where_they_are_ok() {
        let text = "frequency_hz,storage,loss_factor,status,storage_std,loss_factor_std\n\
                    20,2e6,0.1,ok,1e4,0.01\n10,1e6,0.2,ok,2e4,0.02\n30,,,no_root,,\n40,9e9,0.3,ambiguous,1,1\n";
        let data = read_modulus_data(text.as_bytes()).unwrap();
        assert_eq!(data.frequency_hz, [10.0, 20.0]);
        assert_eq!((data.storage, data.loss_factor), (vec![1e6, 2e6], vec![0.2, 0.1]));
        assert_eq!(data.std, Some(vec![[2e4, 0.02], [1e4, 0.01]]));
        assert_eq!(data.left_out, 2);
    }

    #[test]
    fn deviations_that_are_nowhere_told_are_none() {
        let text =
            "f,storage,eta,status,storage_std,loss_factor_std\n1,2,3,ok,,\n2,2,3,ok,,\n3,2,3,ambiguous,1,1\n";
        assert_eq!(read_modulus_data(text.as_bytes()).unwrap().std, None);
    }

    #[test]
    fn units_below_the_names_are_converted() {
        let text = "f, E_stor, E_loss,T\nkHz, MPa, kPa,C\n1,2,500,-5\n";
        let data = read_modulus_data(text.as_bytes()).unwrap();
        assert_eq!((data.frequency_hz, data.storage), (vec![1e3], vec![2e6]));
        assert_eq!((data.loss_factor, data.std), (vec![0.25], None));
    }

    #[test]
    fn one_of_several_temperatures_is_picked() {
        let text = "f,storage,eta,T\nHz,Pa,-,C\n1,2,0.1,20\n2,3,0.2,20.0\n1,5,0.3,-10\n";
        let data = read_modulus_data_where(text.as_bytes(), "T", "20").unwrap();
        assert_eq!((data.storage, data.left_out), (vec![2.0, 3.0], 0));
        assert_eq!(read_modulus_data_where(text.as_bytes(), "T", "-10").unwrap().storage, [5.0]);
        let refused =
            |column: &str| read_modulus_data_where(text.as_bytes(), column, "30").unwrap_err().to_string();
        assert_eq!(
            refused("T"),
            "input:1: expected a row with \"30\" in column \"T\", found only 20, 20.0, -10"
        );
        assert!(refused("X").starts_with("input:1: expected a column \"X\""), "{}", refused("X"));
    }

    #[test]
    fn broken_tables_are_refused_at_their_place() {
        for (text, expected) in [
            (
                "f,E_stor\n1,2\n",
                "input:1: expected a column \"loss_factor\" or \"loss\", found only \"f\", \"E_stor\"",
            ),
            (
                "f,E_stor,eta,E_loss\n1,2,3,4\n",
                "input:1:14: expected one of the columns loss_factor and loss, found a second one",
            ),
            (
                "f,E_stor,E_loss\nHz,bar,bar\n1,2,3\n",
                "input:2:4: expected one of the units Pa, kPa, MPa, GPa, psi, psf, dyn/cm^2 in column \"E_stor\", found \"bar\"",
            ),
            (
                "f,E_stor,E_loss\n1,2,3\n1,3,4\n",
                "input:3:1: expected each frequency once in column \"f\", found \"1\" again, first in line 2",
            ),
            ("f,storage,eta\n0,2,3\n", "input:2:1: expected a number above 0 in column \"f\", found \"0\""),
            (
                "f,storage,eta\n1,-2,3\n",
                "input:2:3: expected a number above 0 in column \"storage\", found \"-2\"",
            ),
            (
                "f,storage,eta,storage_std\n1,2,3,1\n",
                "input:1:15: expected both columns storage_std and loss_factor_std, or none, found one of them",
            ),
            (
                "f,storage,eta,storage_std,loss_factor_std\n1,2,3,1,\n",
                "input:2:9: expected a finite number in column \"loss_factor_std\", found an empty cell",
            ),
            (
                "f,storage,eta,status\n1,2,3,no_root\n",
                "input:1: expected at least one line with a modulus (and the status ok) below the names, found none",
            ),
            (
                "f,freq,storage,eta\n1,2,3,4\n",
                "input:1:1: expected one of the columns frequency_hz, frequency, freq, f, f_hz, found a second one",
            ),
        ] {
            assert_eq!(read_modulus_data(text.as_bytes()).unwrap_err().to_string(), expected);
        }
    }
}
