//! LabVIEW measurement files: what is read, what is refused with which word, written and read back.

mod broken;
#[path = "../outside/mod.rs"]
mod outside;
mod reading;
mod real_files;
mod round_trip;
