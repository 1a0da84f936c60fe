//! Tables: what is read, what is refused with which word, written and read back.

mod broken;
mod reading;
mod regressions;
mod round_trip;
