//! The first natural frequencies of K and M: a wrong unit of either shows at once.

use crate::error::{InputError, Place};
use crate::load::{Member, empty_rows, load_one, one_order, symmetric_matrix};
use frfit_linalg::modes::{ModesError, lowest};
use frfit_linalg::solve::Breakdown;
use serde_json::{Value, json};
use std::path::Path;

/// The lowest natural frequencies of K φ = ω² M φ in Hz, in ascending order; 0 for a rigid-body mode up to roundoff.
/// Fewer than `count` where M has a smaller rank. Where the files name the rows, both are brought to one order.
///
/// # Errors
/// A file that holds no real symmetric matrix, sizes that differ, a K and M without natural frequencies.
pub fn natural_frequencies(k: &Path, m: &Path, count: usize) -> Result<Vec<f64>, InputError> {
    let ((stiffness, of_stiffness), (mass, of_mass)) = (load_one(k)?, load_one(m)?);
    let member = |matrix, labels, is_stiffness| Member { matrix, labels, is_stiffness };
    let order = one_order(&[member(&stiffness, &of_stiffness, true), member(&mass, &of_mass, false)]);
    let in_file = |at: usize, error| InputError::in_file(if at == 0 { k } else { m }, error);
    let order = order.map_err(|(at, error)| in_file(at, error))?;
    let moved = |at: usize, matrix| {
        let moved = order.as_ref().and_then(|order| order.apply(at, matrix)).transpose();
        moved.map_err(|error| in_file(at, error))
    };
    let (moved_stiffness, moved_mass) = (moved(0, &stiffness)?, moved(1, &mass)?);
    let (stiffness, mass) = (moved_stiffness.unwrap_or(stiffness), moved_mass.unwrap_or(mass));
    if stiffness.nrows != mass.nrows {
        let expected = format!("as many rows as K ({}: {})", k.display(), stiffness.nrows);
        return Err(InputError::at(&Place::file(m), expected, mass.nrows.to_string()));
    }
    // One entry is in at most two rows. Checked before anything is allocated by the number of rows.
    let entries = stiffness.rows.len().saturating_add(mass.rows.len());
    if stiffness.nrows > entries.saturating_mul(2) {
        let found = format!("{entries} entries in both for {} rows", stiffness.nrows);
        return Err(InputError::at(&Place::file(k), "a nonzero in every row of K or M", found));
    }
    let symmetric = |path, matrix| symmetric_matrix(matrix).map_err(|error| InputError::in_file(path, error));
    let (of_k, of_m) = (symmetric(k, &stiffness)?, symmetric(m, &mass)?);
    let modes = lowest(&of_k, &of_m, count).map_err(|error| {
        if let ModesError::Breakdown(Breakdown::Singular { .. }) = error {
            let empty = empty_rows(stiffness.nrows, [&stiffness, &mass]);
            return InputError::at(&Place::file(k), WHOLE, without_values(&empty));
        }
        let complex_mass = error == ModesError::Complex && of_k.real_values().is_some();
        let place = Place::file(if complex_mass { m } else { k });
        InputError::at(&place, "K and M with natural frequencies", error.to_string())
    })?;
    Ok(modes.frequencies_hz())
}

/// What K and M must be.
const WHOLE: &str = "K and M of the whole model, in which each degree of freedom has a stiffness or a mass; where they \
                     are matrices of a part, name all matrices in a case file and run `frfit modes` on it";

/// Why K + s M is singular for every s, by the rows in which neither has a value that is not zero.
fn without_values(empty: &[usize]) -> String {
    match empty {
        [row] => format!("no value in row {} of both", row + 1),
        [first, ..] => format!("no value in {} rows of both (the first is {})", empty.len(), first + 1),
        [] => "a motion that has neither stiffness nor mass: K + s M is singular for every s".into(),
    }
}

/// What `frfit inspect K M --json` prints of natural frequencies.
pub fn modes_json(frequency_hz: &[f64]) -> Value {
    json!({"natural_frequencies_hz": frequency_hz, "rigid_body_modes": rigid_body_modes(frequency_hz)})
}

/// How many of the first natural frequencies, ascending, are those of rigid-body modes: zero up to roundoff.
///
/// # Limits
/// Where all are zero there is nothing to compare them with: none is counted.
pub fn rigid_body_modes(frequency_hz: &[f64]) -> usize {
    let highest = frequency_hz.last().copied().unwrap_or_default();
    frequency_hz.iter().take_while(|&&f| f < RIGID * highest).count()
}

/// A frequency of this part of the highest is roundoff: of ω² some 1e-12 are left of the highest, and softer suspensions are rare.
const RIGID: f64 = 1e-5;
