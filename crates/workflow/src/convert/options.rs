//! What the formats leave open.

use crate::error::{InputError, Place};
use crate::load::Choice;
use frfit::dof::DofName;
use frfit::quantity::Quantity;
use frfit_formats::uff::{Endian, Form};

/// What a conversion cannot know from its files. An option that has no meaning for a conversion is refused.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct ConvertOptions {
    /// Of a file of several matrices: which.
    pub name: Option<String>,
    /// From UFF: the numbers of the FRFs, from 1; for a table one.
    pub records: Vec<i64>,
    /// From a table: the names of its columns, in place of its own.
    pub columns: Option<Vec<String>>,
    /// From a table to UFF: what the FRF is. From UFF to a table: what it has to be.
    pub quantity: Option<Quantity>,
    /// From a table to UFF: where it was measured. From UFF to a table: the FRF that was measured there.
    pub response: Option<DofName>,
    /// From a table to UFF: where it was driven. From UFF to a table: the FRF that was driven there.
    pub reference: Option<DofName>,
    /// The ending that says the format of the output, in place of that of its name.
    pub to: Option<String>,
    /// To UFF: functions in binary (58b, little endian) rather than as text.
    pub binary: bool,
}

impl ConvertOptions {
    /// How functions are written.
    pub(super) fn form(&self) -> Form {
        if self.binary { Form::Binary { endian: Endian::Little } } else { Form::Ascii }
    }

    fn shown_records(&self) -> String {
        self.records.iter().map(i64::to_string).collect::<Vec<_>>().join(",")
    }

    /// The FRF of a UFF file that becomes a table.
    pub(super) fn of_uff(&self) -> Result<Choice, InputError> {
        if self.records.len() > 1 {
            let place = Place::option("--record");
            return Err(InputError::at(&place, "one FRF for a table", self.shown_records()));
        }
        let record = self.records.first().copied();
        Ok(Choice { record, measured_at: self.response, driven_at: self.reference, columns: None })
    }

    /// The FRF of a table.
    pub(super) fn of_columns(&self) -> Choice {
        Choice { columns: self.columns.clone(), ..Choice::default() }
    }

    /// Refuses an option that is set and has no meaning.
    pub(super) fn only(&self, meant: &[&str], conversion: &str) -> Result<(), InputError> {
        let set = [
            ("--name", self.name.clone()),
            ("--record", (!self.records.is_empty()).then(|| self.shown_records())),
            ("--columns", self.columns.as_ref().map(|names| names.join(","))),
            ("--quantity", self.quantity.map(|quantity| quantity.to_string())),
            ("--response", self.response.map(|dof| dof.to_string())),
            ("--reference", self.reference.map(|dof| dof.to_string())),
            ("--binary", self.binary.then(|| "it".to_owned())),
        ];
        for (name, value) in set {
            if let (Some(value), false) = (value, meant.contains(&name)) {
                let expected = format!("no such option for {conversion}");
                return Err(InputError::at(&Place::option(name), expected, value));
            }
        }
        Ok(())
    }
}
