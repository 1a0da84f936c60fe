//! LabVIEW measurement files (.lvm): time records of several channels, in one or more segments.
//!
//! A file begins with a header of keys and values, which says among others what separates the columns and which sign
//! decimal numbers have. Each segment has a header of its own, with one value a channel, then a line with the names of
//! the columns, then the rows. A last column `Comment` is passed over.
//!
//! # Source
//! National Instruments: "Specification for the LabVIEW Measurement File (.lvm)", version 2.0.
//!
//! # Examples
//!
//! ```
//! let text = "LabVIEW Measurement\nSeparator\tTab\nDecimal_Separator\t,\n***End_of_Header***\n\n\
//!             Channels\t1\nY_Unit_Label\tN\nDelta_X\t0,5\n***End_of_Header***\n\
//!             X_Value\tForce\tComment\n\t1,25\n\t-2\n";
//! let file = frfit_formats::lvm::read(text.as_bytes())?;
//! let force = &file.segments[0].channels[0];
//! assert_eq!((force.name.as_str(), force.unit.as_str()), ("Force", "N"));
//! assert_eq!(force.values, [1.25, -2.0]);
//! # Ok::<(), frfit_formats::FormatError>(())
//! ```

mod fields;
mod file_header;
mod read;
mod rows;
mod segment_header;
mod write;

pub(crate) use file_header::is_first_line;
pub use read::read;
pub use write::write;

/// What separates the columns.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Separator {
    /// `Tab`
    #[default]
    Tab,
    /// `Comma`
    Comma,
}

impl Separator {
    fn byte(self) -> u8 {
        match self {
            Self::Tab => b'\t',
            Self::Comma => b',',
        }
    }
}

/// The sign between the whole and the fraction of a number.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum DecimalSign {
    /// `1.5`
    #[default]
    Point,
    /// `1,5`
    Comma,
}

/// A measurement file.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Lvm {
    /// What separates the columns.
    pub separator: Separator,
    /// Which sign decimal numbers have.
    pub decimal: DecimalSign,
    /// The other keys of the file's header with their values, in their order: `Operator`, `Date`, `Time`, ...
    pub header: Vec<(String, String)>,
    /// The segments; of a file that was read at least one.
    pub segments: Vec<Segment>,
}

/// Channels that were recorded at the same time.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Segment {
    /// The line of its header, from 1; 0 in a segment that was not read from a file.
    pub line: usize,
    /// Date and time of the first channel as the file has them; empty where it has none.
    pub date: String,
    /// As `date`.
    pub time: String,
    /// The channels; of a segment that was read at least one.
    pub channels: Vec<Channel>,
}

/// One channel of a segment.
#[derive(Debug, Clone, PartialEq)]
pub struct Channel {
    /// Its name; may be empty.
    pub name: String,
    /// Unit of its values as the file has it; empty where it has none.
    pub unit: String,
    /// Where its samples lie.
    pub abscissa: Abscissa,
    /// The samples, all finite.
    pub values: Vec<f64>,
}

/// Where samples lie on the x axis, in seconds where that is time.
#[derive(Debug, Clone, PartialEq)]
pub enum Abscissa {
    /// At start + k · step, k from 0.
    Even {
        /// `X0`; 0 where the file does not say.
        start: f64,
        /// `Delta_X`
        step: f64,
    },
    /// At the values of a column, one a sample.
    Listed(Vec<f64>),
}
