//! Matrix files: real ones, broken ones, written and read back, and against SciPy.

#![allow(clippy::print_stdout, reason = "a skipped test says why")]

mod broken;
mod dialects;
mod real_files;
mod regressions;
mod round_trip;
mod scipy;
