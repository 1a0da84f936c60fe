//! Each element against a solution in closed form, with its rate of convergence.

mod bar;
mod beam;
mod brick;
mod hexahedron;
mod modes;
mod orthotropic_plate;
mod plate;
mod polynomial;
mod support;
