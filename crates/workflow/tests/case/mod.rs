//! Case files: what is read from a good one, and what is said about a broken one.

mod arbitrary;
mod broken_case;
mod broken_files;
mod files;
mod good;
mod laws;
mod measured;
mod unknowns;
