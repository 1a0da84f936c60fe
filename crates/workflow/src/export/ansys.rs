//! Ansys Mechanical APDL: frequency-dependent elasticity and structural damping, for a full harmonic analysis.
//!
//! `TB,ELASTIC` holds E′ and Poisson's ratio, `TB,SDAMP,,,,STRU` the structural damping coefficient g, both over `TBFIELD,FREQ`. The element's stiffness is
//! (1 + ig) K(E′), so that g = η = E″/E′: the coefficient is the loss factor, not the damping ratio ξ = η/2 that `MP,DMPR` takes (which is doubled on entry).
//!
//! # Source
//! Ansys Mechanical APDL Command Reference, `TB`, `TBFIELD`, `DMPSTR`; Theory Reference, "Damping Matrices"; Structural Analysis Guide, "Full Harmonic Analysis".

use super::solid::Solid;
use crate::error::{InputError, Place};
use frfit_formats::FormatError;
use frfit_formats::cards::command::Argument::{Blank, Integer, Real, Word};
use frfit_formats::cards::command::{command, comment};
use std::path::Path;

/// `TB,ELASTIC`, `TB,SDAMP` and their values.
///
/// # Errors
/// A material 0.
pub(super) fn ansys(solid: &Solid, id: u32, heading: &str, source: &Path) -> Result<String, InputError> {
    if id == 0 {
        return Err(InputError::at(&Place::option("--id"), "a number from 1 on", "0"));
    }
    let written = || -> Result<String, FormatError> {
        let usage = format!(
            "Use: /INPUT this file in /PREP7, MAT,{id} for the elements, ANTYPE,HARMIC with HROPT,FULL. No MP,EX, MP,DMPR, MP,DMPS or DMPSTR \
             for this material. TB,ELASTIC holds E' and Poisson's ratio, TB,SDAMP,,,,STRU the loss factor eta = E''/E' (not the damping ratio, \
             which is half of it); Ansys interpolates between the frequencies."
        );
        let mut out = comment(&(heading.to_owned() + &usage));
        if let Some(density) = solid.density {
            out += &command("MP", &[Word("DENS"), Integer(id), Real(density)])?;
        }
        out += &command("TB", &[Word("ELASTIC"), Integer(id), Blank, Blank, Word("ISOT")])?;
        for (frequency_hz, e) in &solid.points {
            out += &command("TBFIELD", &[Word("FREQ"), Real(*frequency_hz)])?;
            out += &command("TBDATA", &[Integer(1), Real(e.re), Real(solid.poisson)])?;
        }
        out += &command("TB", &[Word("SDAMP"), Integer(id), Blank, Blank, Word("STRU")])?;
        for (frequency_hz, e) in &solid.points {
            out += &command("TBFIELD", &[Word("FREQ"), Real(*frequency_hz)])?;
            out += &command("TBDATA", &[Integer(1), Real(e.im / e.re)])?;
        }
        Ok(out)
    };
    written().map_err(|error| InputError::in_file(source, error))
}
