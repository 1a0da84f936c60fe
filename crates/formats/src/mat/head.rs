//! The head of a variable: its flags, dimensions and name.

use super::stream::Stream;
use crate::FormatError;

/// What is at the head of every variable.
pub(super) struct Head {
    pub(super) class: u8,
    pub(super) is_complex: bool,
    pub(super) dimensions: Vec<u64>,
    pub(super) name: String,
}

pub(super) const STRUCTURE: u8 = 2;
pub(super) const SPARSE: u8 = 5;

impl Head {
    pub(super) fn read(stream: &mut Stream<'_>) -> Result<Self, FormatError> {
        let place = stream.place();
        let flags = stream.wholes("the flags of a variable")?.unwrap_or_default();
        let flags =
            *flags.first().ok_or_else(|| FormatError::byte(place, "the flags of a variable", "none"))?;
        // Of an object of MATLAB's own kind (opaque) nothing more is as it is of others.
        let class = (flags & 0xFF) as u8;
        if class == 17 {
            return Ok(Self { class, is_complex: false, dimensions: Vec::new(), name: String::new() });
        }
        let place = stream.place();
        let dimensions = stream.wholes("the dimensions of a variable")?;
        let dimensions = dimensions.filter(|sizes| sizes.len() >= 2).ok_or_else(|| {
            FormatError::byte(place, "the dimensions of a variable, at least two whole numbers", "others")
        })?;
        let name = stream.text("the name of a variable")?;
        Ok(Self { class, is_complex: flags & 0x800 != 0, dimensions, name })
    }

    /// What it is, where it is no matrix.
    pub(super) fn other(&self) -> String {
        match self.class {
            1 => "a cell array".into(),
            STRUCTURE => "a structure".into(),
            3 => "an object".into(),
            4 => "a text".into(),
            16 => "a function handle".into(),
            SPARSE | 6..=15 => self.shape(),
            other => format!("an array of class {other}"),
        }
    }

    fn shape(&self) -> String {
        let sizes: Vec<_> = self.dimensions.iter().map(u64::to_string).collect();
        format!("an array of {}", sizes.join(" x "))
    }
}
