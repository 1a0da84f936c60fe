//! Tables with named columns, as spreadsheets and scripts write them.
//!
//! The first line that is neither blank nor a comment (`#`) names the columns; they may stand in any order.
//! Cells are separated by commas, semicolons or tabs, whichever the names are separated by, and may be
//! quoted. Numbers have a decimal point, or, where cells are not separated by commas, a decimal comma; a table that has both
//! signs is refused.
//!
//! [`Table`] is any such table; [`read_frf`], [`read_frf_named`], [`read_vector`], [`read_dof_names`], [`read_modulus`], [`read_modulus_data`], [`read_modulus_rows`] and
//! [`read_time_records`] are the ones that `frfit` works with; [`write()`] writes one.
//!
//! # Source
//! Y. Shafranovich: Common Format and MIME Type for Comma-Separated Values (CSV) Files, RFC 4180, 2005.

mod columns;
mod dof_names;
mod frf;
mod modulus;
mod modulus_data;
mod modulus_rows;
mod table;
mod time_records;
mod vector;
mod write;

pub use dof_names::{Direction, DofName, read_dof_names};
pub use frf::{FrfTable, decay_said, read_frf, read_frf_named};
pub use modulus::{ModulusTable, read_modulus};
pub use modulus_data::{ModulusData, read_modulus_data, read_modulus_data_where};
pub use modulus_rows::{ModulusRow, ModulusRows, read_modulus_rows};
pub use table::Table;
pub use time_records::{TimeChannel, TimeTable, read_time_records};
pub use vector::read_vector;
pub use write::{Cell, write};
