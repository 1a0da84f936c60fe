//! Matrix files: real ones, broken ones, written and read back, and against SciPy.

mod broken;
mod dialects;
mod kinds;
mod real_files;
mod regressions;
mod round_trip;
mod scipy;
