//! Nastran: a material and the pair of tables of its frequency dependence, for direct frequency response (SOL 108).
//!
//! Without more, Nastran's stiffness is (1 + ig) K¹ + i K⁴, with g = PARAM,G, K¹ the stiffness at the moduli of the materials, K⁴ = Σ GE·K_e over the elements.
//! Where case control says SDAMPING = n and n is a TABLEDi, i K⁴ becomes (T_R(f) + i T_I(f)) K⁴, T_R being table n and T_I table n + 1. An element of the reference
//! modulus G_ref then has the stiffness K_e (1 + ig + GE·(T_R + i T_I)), and it shall have K_e (G′ + iG″)/G_ref. Hence
//!
//! T_R(f) = (G′(f)/G_ref − 1)/GE, T_I(f) = (G″(f)/G_ref − g)/GE,
//!
//! and with a constant Poisson's ratio G/G_ref = E/E_ref. g = 0 is taken. G_ref and GE are any numbers that are not zero; near the material's own they make the same
//! deck a sensible approximation where the tables are not used (SOL 103, 111).
//!
//! # Limits
//! The pair holds for every element with GE ≠ 0: one viscoelastic material (or several in proportion) in a model. Nastran interpolates linearly in f, and extrapolates linearly.
//!
//! # Source
//! MSC Nastran Dynamic Analysis User's Guide and NX Nastran Advanced Dynamic Analysis User's Guide, "Viscoelastic materials in frequency response analysis".

use super::solid::{Solid, reference};
use crate::error::{InputError, Place};
use frfit_formats::FormatError;
use frfit_formats::cards::bulk::Field::{Blank, Integer, Real, Word};
use frfit_formats::cards::bulk::{Field, comment, entry};
use std::path::Path;

/// MAT1 and two TABLED1.
///
/// # Errors
/// A single frequency: a table of Nastran's needs two.
pub(super) fn nastran(solid: &Solid, id: u32, heading: &str, source: &Path) -> Result<String, InputError> {
    let [Some(first), Some(last)] = [solid.points.first(), solid.points.last()].map(|p| p.map(|p| p.0))
    else {
        return Ok(String::new());
    };
    if solid.points.len() < 2 {
        return Err(InputError::at(&Place::file(source), "at least two frequencies for a TABLED1", "one"));
    }
    let Some(second) = id.checked_add(1).filter(|&second| id > 0 && second < 100_000_000) else {
        let expected = "a number from 1 to 99999998: the tables have it and the next one";
        return Err(InputError::at(&Place::option("--id"), expected, id.to_string()));
    };
    let usage = format!(
        "\nUse: SOL 108; case control SDAMPING = {id}; bulk data INCLUDE this file; properties refer to MID {id}. \
         No PARAM,G; GE of every other material blank or 0: the tables act on all elements with GE.\n\
         TABLED1 {id} is TR(f) = (E'/Eref - 1)/GE, TABLED1 {second} is TI(f) = (E''/Eref)/GE, Eref and GE those of MAT1 {id}: \
         the stiffness is that of MAT1 times 1 + GE (TR + i TI).\n\
         Nastran extrapolates tables linearly: stay within {first} to {last} Hz."
    );
    let written = || -> Result<String, FormatError> {
        let storage = reference(median(solid.points.iter().map(|p| p.1.re)));
        let loss = median(solid.points.iter().map(|p| p.1.im / p.1.re));
        // Any number but zero serves.
        let damping = if loss > 0.0 { reference(loss) } else { 0.01 };
        let mut out = comment(&(heading.to_owned() + &usage));
        let density = solid.density.map_or(Blank, Real);
        out += &entry(
            "MAT1",
            &[Integer(id), Real(storage), Blank, Real(solid.poisson), density, Blank, Blank, Real(damping)],
        )?;
        let parts = [
            (id, solid.points.iter().map(|p| (p.0, (p.1.re / storage - 1.0) / damping)).collect::<Vec<_>>()),
            (second, solid.points.iter().map(|p| (p.0, p.1.im / storage / damping)).collect()),
        ];
        for (id, values) in parts {
            let mut fields: Vec<Field<'_>> = vec![Blank; 8];
            fields[..3].copy_from_slice(&[Integer(id), Word("LINEAR"), Word("LINEAR")]);
            fields.extend(values.iter().flat_map(|&(x, y)| [Real(x), Real(y)]));
            fields.push(Word("ENDT"));
            out += &entry("TABLED1", &fields)?;
        }
        Ok(out)
    };
    written().map_err(|error| InputError::in_file(source, error))
}

fn median(values: impl Iterator<Item = f64>) -> f64 {
    let mut values: Vec<f64> = values.collect();
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}
