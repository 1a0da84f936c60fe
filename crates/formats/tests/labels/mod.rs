//! Matrices whose rows have names: CalculiX, Abaqus, Nastran DMIG and Ansys.

mod broken;
mod doors;
mod pynastran;
mod real_files;
mod regressions;
mod round_trip;
