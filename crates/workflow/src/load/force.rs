//! The load vector F.

use super::dofs::{Dofs, beyond};
use super::files::Files;
use crate::case::{LoadEntry, Located};
use crate::error::InputError;
use frfit::c64;
use frfit_formats::{FormatError, csv};

/// A unit force at one degree of freedom, in the sense of its sign, or the vector of a file.
pub(super) fn load(
    entry: &LoadEntry,
    dim: usize,
    dofs: &Dofs,
    files: &mut Files,
) -> Result<Vec<c64>, InputError> {
    match entry {
        LoadEntry::File(name) => vector(name, dim, dofs, files),
        LoadEntry::At(spot) => {
            let (driven, _) = dofs.find(spot)?;
            let mut load = vec![c64::default(); dim];
            load[driven.row] = c64::new(driven.sign, 0.0);
            Ok(load)
        }
    }
}

fn vector(
    name: &Located<String>,
    dim: usize,
    dofs: &Dofs,
    files: &mut Files,
) -> Result<Vec<c64>, InputError> {
    let file = files.read(name)?;
    let mut load = vec![c64::default(); dim];
    for (k, (row, value)) in
        csv::read_vector(&file.bytes).map_err(|error| file.refuse(error))?.into_iter().enumerate()
    {
        match load.get_mut(row - 1) {
            Some(entry) => *entry = value * dofs.in_si(row - 1),
            None => return Err(file.refuse(beyond(&file.bytes, k, dim, row))),
        }
    }
    if load.iter().all(|value| value.norm() == 0.0) {
        return Err(file.refuse(FormatError::whole("a load that is not zero in every row", "zeros only")));
    }
    Ok(load)
}
