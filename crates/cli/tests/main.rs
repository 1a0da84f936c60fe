//! The binary as a person runs it: arguments, words, files, exit codes.

mod batch;
mod book;
mod check;
mod common;
mod demo;
mod export;
mod fit;
mod hammer;
mod interrupted;
mod modes;
mod orthotropic_plate;
#[path = "../../formats/tests/outside/mod.rs"]
mod outside;
#[path = "../../figures/tests/picture/mod.rs"]
mod picture;
mod plate;
#[path = "../../engine/tests/ranks/mod.rs"]
mod ranks;
mod refusals;
mod report;
mod several;
mod several_report;
mod solver;
#[path = "../../core/tests/tier/mod.rs"]
mod tier;
mod words;
mod writing;
