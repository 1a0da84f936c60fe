//! LabVIEW measurement files: what is read, what is refused with which word, written and read back.

mod broken;
mod reading;
mod real_files;
mod round_trip;
