//! Abaqus: a material with frequency-domain viscoelasticity as a table.
//!
//! Abaqus takes the Fourier transform g*(ω) of the dimensionless relaxation function g(t) = G_R(t)/G∞ − 1, by which the complex shear modulus is
//! G(ω) = G∞ (1 + iω g*(ω)) = G∞ [(1 − ω Im g*) + iω Re g*]. A data line holds, with G = G′ + iG″,
//!
//! ω Re g* = G″/G∞, ω Im g* = 1 − G′/G∞, ω Re k* = K″/K∞, ω Im k* = 1 − K′/K∞, f in cycles per time.
//!
//! With a real, constant Poisson's ratio shear and bulk modulus have the factor of E, so that both pairs are those of E. Since only the product of the long-term modulus
//! and these numbers enter a steady-state step, any E∞ gives the same E(ω); the one at the lowest frequency is written, which static steps use.
//!
//! # Source
//! Abaqus Analysis User's Guide, "Frequency domain viscoelasticity"; Abaqus Keywords Reference Guide, `*VISCOELASTIC`.

use super::solid::{Solid, reference};
use crate::error::{InputError, Place};
use frfit_formats::FormatError;
use frfit_formats::cards::keyword::{check_name, comment, data, keyword};
use std::path::Path;

/// `*MATERIAL` with `*ELASTIC` and `*VISCOELASTIC`.
///
/// # Errors
/// A name that Abaqus does not read.
pub(super) fn abaqus(solid: &Solid, name: &str, heading: &str, source: &Path) -> Result<String, InputError> {
    check_name(name)
        .map_err(|error| InputError::at(&Place::option("--name"), error.expected, error.found))?;
    let written = || -> Result<String, FormatError> {
        let long_term = reference(solid.points.first().map_or(f64::NAN, |p| p.1.re));
        let usage = "Use: *SOLID SECTION, MATERIAL=this name; *STEADY STATE DYNAMICS, DIRECT (or SUBSPACE PROJECTION).\n\
             Data lines: omega Re g*, omega Im g*, omega Re k*, omega Im k*, frequency, where omega Re g* = G''/Ginf and \
             omega Im g* = 1 - G'/Ginf, and likewise k* with the bulk modulus. The long-term modulus is E' at the lowest frequency, \
             which static steps take.";
        let mut out = comment(&(heading.to_owned() + usage));
        out += &keyword("MATERIAL", &[("NAME", name)])?;
        if let Some(density) = solid.density {
            out += &keyword("DENSITY", &[])?;
            out += &data(&[density])?;
        }
        out += &keyword("ELASTIC", &[("MODULI", "LONG TERM")])?;
        out += &data(&[long_term, solid.poisson])?;
        out += &keyword("VISCOELASTIC", &[("FREQUENCY", "TABULAR")])?;
        for (frequency_hz, e) in &solid.points {
            let (real, imaginary) = (e.im / long_term, 1.0 - e.re / long_term);
            out += &data(&[real, imaginary, real, imaginary, *frequency_hz])?;
        }
        Ok(out)
    };
    written().map_err(|error| InputError::in_file(source, error))
}
