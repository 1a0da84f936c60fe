//! The examples are complete, right, and reproducible.

mod claims;
mod common;
mod files;
mod hammer;
mod orthotropic_plate;
mod selection;
mod several;
#[path = "../../core/tests/tier/mod.rs"]
mod tier;
