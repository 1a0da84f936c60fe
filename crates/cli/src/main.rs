//! The `frfit` command.
fn main() {}
