//! Factors, orders and solutions against dense answers.

mod common;
mod hard;
mod ordering;
mod solve;
