//! Matrix Market exchange format (`.mtx`).
//!
//! Coordinate and array files of real, integer, complex and pattern fields, general, symmetric,
//! skew-symmetric and Hermitian. Beyond the letter of the format these are read too: CR LF, blank lines
//! and comment lines between entries, leading and trailing blanks, a banner in any case, a byte order
//! mark, exponents with D or Q or without a letter, and entries of the upper triangle of a matrix that
//! is given by one triangle (they are mirrored into the lower one).
//!
//! # Source
//! R. F. Boisvert, R. Pozo, K. A. Remington: The Matrix Market Exchange Formats: Initial Design,
//! NISTIR 5935, National Institute of Standards and Technology, 1996.

mod header;
mod read;
mod write;

pub(crate) use header::is_banner;
pub use read::read;
pub use write::write;
