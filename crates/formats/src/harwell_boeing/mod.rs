//! Harwell–Boeing exchange format (`.rsa`, `.rua`, `.psa`, `.rb`, …).
//!
//! Assembled matrices: real (R), complex (C) and pattern (P; integer values, I, are read as real),
//! symmetric (S), unsymmetric (U), Hermitian (H), skew-symmetric (Z) and rectangular (R). Elemental
//! matrices (third letter E) are refused.
//!
//! Fields are cut from the lines by column as the Fortran formats in line 4 say, and read as Fortran reads
//! them: a value without a point has its last d digits behind it, and a scale factor kP divides a value
//! without an exponent by 10^k. Two things differ from Fortran: a blank field is refused where a number is
//! due, because the blank end of a torn file would turn into zeros; and a line that has the right number of
//! tokens, but not in the columns of the format, is read token by token.
//!
//! # Source
//! I. S. Duff, R. G. Grimes, J. G. Lewis: Users' Guide for the Harwell–Boeing Sparse Matrix Collection
//! (Release I), report TR/PA/92/86, CERFACS, 1992.

mod block;
mod formats;
mod fortran;
mod header;
mod matrix_type;
mod read;
mod rhs;
mod write;

pub(crate) use header::looks_like;
pub use read::{HarwellBoeing, read, read_with_rhs};
pub use rhs::RightHandSides;
pub use write::write;
