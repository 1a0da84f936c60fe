//! Factors, orders and solutions against dense answers.

mod common;
mod hard;
mod matrix;
mod ordering;
mod solve;
