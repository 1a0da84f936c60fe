//! The slowest tests of a run, from the file in which cargo-nextest keeps their times.

use crate::links::{attribute, tags};
use crate::step::target;
use std::path::PathBuf;

const COUNT: usize = 20;

/// Where `.config/nextest.toml` has it.
fn times() -> PathBuf {
    target().join("nextest/default/times.xml")
}

/// Removes the times of an older run.
pub(crate) fn forget() {
    let _ = std::fs::remove_file(times());
}

/// Prints a table; nothing where no times were kept.
pub(crate) fn print() {
    let Ok(text) = std::fs::read_to_string(times()) else { return };
    let mut tests: Vec<(f64, String)> = tags(&text)
        .filter(|tag| tag.starts_with("testcase "))
        .filter_map(|tag| {
            let part = |name| attribute(tag, name);
            let name = format!("{} {}", part("classname")?, part("name")?);
            Some((part("time")?.parse().ok()?, name))
        })
        .collect();
    tests.sort_by(|a, b| b.0.total_cmp(&a.0));
    println!("── the slowest {COUNT} tests, in seconds of the clock");
    tests.iter().take(COUNT).for_each(|(seconds, name)| println!("{seconds:>8.2}  {name}"));
}
