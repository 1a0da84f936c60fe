//! What the formats leave open.

use crate::error::{InputError, Place};
use frfit::dof::DofName;
use frfit::quantity::Quantity;
use frfit_formats::uff::{Endian, Form};

/// What a conversion cannot know from its files. An option that has no meaning for a conversion is refused.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct ConvertOptions {
    /// Of a file of several matrices: which.
    pub name: Option<String>,
    /// From UFF to a table: the number of the FRF, from 1.
    pub record: Option<i64>,
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

    /// Refuses an option that is set and has no meaning.
    pub(super) fn only(&self, meant: &[&str], conversion: &str) -> Result<(), InputError> {
        let set = [
            ("--name", self.name.clone()),
            ("--record", self.record.map(|record| record.to_string())),
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
