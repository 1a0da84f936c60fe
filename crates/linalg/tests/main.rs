//! Solutions and symmetry.

mod solve;
mod symmetric;
