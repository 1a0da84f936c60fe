//! Universal File Format: what vibration measurement systems have written since SDRC I-DEAS.
//!
//! A file is a row of *datasets*, each between two lines that hold `-1` in columns 5–6 and opened by its
//! number. Read into typed records are
//!
//! | dataset | content | record |
//! |---|---|---|
//! | 15, 2411 | nodes, single and double precision | [`Node`] |
//! | 58, 58b | functions at nodal degrees of freedom, text or binary | [`Function`] |
//! | 82 | trace lines | [`TraceLine`] |
//! | 151 | who wrote the file, and when | [`FileHeader`] |
//! | 164 | units | [`Units`] |
//!
//! Every other number is listed with its place ([`Record::Other`]).
//!
//! [`File::new`] finds the datasets without reading what is in them: binary data are stepped over by their
//! byte count, text is searched for the delimiter alone. [`File::function_header`] then reads eleven lines
//! and [`File::function`] all of one function.
//!
//! # Limits
//!
//! Binary functions hold IEEE 754 numbers; the VAX and IBM/370 formats that the document also names are
//! refused when the function is read. The Fortran rule that a number without a decimal point has an implied
//! one is not applied: no writer in use relies on it.
//!
//! # Source
//!
//! Structural Dynamics Research Laboratory, University of Cincinnati: "Universal File Formats for Modal
//! Analysis Testing", datasets 15, 58, 58b, 82, 151, 164, 2411.
//!
//! # Examples
//!
//! ```
//! use frfit_formats::uff::{self, Form, Function, FunctionHeader, Spacing, Values};
//!
//! let header = FunctionHeader {
//!     spacing: Spacing::Even { minimum: 10.0, increment: 0.5 },
//!     ..FunctionHeader::default()
//! };
//! let function = Function::new(header, vec![10.0, 10.5], Values::Real(vec![1.0, -1.0]));
//! let bytes = uff::write::function(&function, Form::Ascii)?;
//!
//! let file = uff::File::new(&bytes)?;
//! assert_eq!(file.function_header(0)?.points, 2);
//! assert_eq!(file.function(0)?, function);
//! # Ok::<(), frfit_formats::FormatError>(())
//! ```

mod binary;
mod columns;
mod data;
mod data_lines;
mod data_type;
mod delimiter;
mod direction;
mod entry;
mod file;
mod file_header;
mod function;
mod function_header;
mod function_type;
mod lines;
mod nodes;
mod number;
mod quantity;
mod read_header;
mod record;
mod scan;
mod summary;
mod title;
mod trace_line;
mod units;
pub mod write;

pub use binary::Endian;
pub use data_type::DataType;
pub use direction::direction_name;
pub use entry::Entry;
pub use file::{File, read_all};
pub use file_header::FileHeader;
pub use function::{Function, Values};
pub use function_header::{Axis, Dof, FunctionHeader, Spacing};
pub use function_type::FunctionType;
pub use nodes::Node;
pub use quantity::Quantity;
pub use record::Record;
pub use scan::scan;
pub use summary::{FunctionSummary, Summary};
pub use trace_line::TraceLine;
pub use units::Units;
pub use write::Form;
