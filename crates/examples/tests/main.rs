//! The examples are complete, right, and reproducible.

mod claims;
mod common;
mod files;
mod hammer;
mod selection;
mod several;
