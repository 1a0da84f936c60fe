//! Readers and writers against files of other programs, broken files and their own round trips.

mod containers;
mod csv;
mod labels;
mod lvm;
mod matrices;
mod outside;
mod uff_against_pyuff;
mod uff_quirks;
mod uff_regressions;
mod uff_roundtrip;
mod uff_samples;
mod uff_support;
