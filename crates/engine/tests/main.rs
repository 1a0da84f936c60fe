//! Factors of MUMPS beside our own, and jobs that end too early.

mod factors;
mod jobs;
mod launched;
mod ranks;
