//! What a mesh can carry, as far as matrices alone show it.

use super::finding::Fault;
use crate::frequency::omega_rad_s;
use crate::model::{ModelAt, Role, WeightedTerm};

/// Part of the rows' own frequency up to which waves are resolved.
///
/// √(K_ii/M_ii) is the frequency of one row that moves alone. In a uniform mesh of linear bars (consistent mass) it is √3 c/h, in one of beams in bending 5.7 √(EI/ρA)/h²:
/// half of it has seven bars or four beams in a wavelength, and natural frequencies are 3 % too high on bars.
const RESOLVED_FREQUENCY_SHARE: f64 = 0.5;

/// Which part of the rows must be as slow as that: heavy points on soft springs are few, and say nothing of waves.
const SLOW_ROW_SHARE: f64 = 0.25;

/// Fewer rows that carry mass are points on springs, and no mesh.
const MIN_ROWS: usize = 4;

/// Whether a band reaches beyond the mesh, with the model as it is at the highest frequency.
///
/// # Limits
/// It cannot see how few elements there are in a wavelength where another direction is much stiffer (thin plates of solid elements have a thickness that vibrates
/// alone far above the band): there it says nothing. How large the error is, only a finer mesh shows.
pub(super) fn beyond_mesh(top: &ModelAt<'_>) -> Option<Fault> {
    let n = top.model.dim();
    let (mut stiffness, mut mass) = (vec![0.0; n], vec![0.0; n]);
    for &WeightedTerm { term, weight } in &top.nominal.parts {
        let term = &top.model.terms()[term];
        let into = match term.role {
            Role::Stiffness => &mut stiffness,
            Role::Mass => &mut mass,
            Role::Viscous => continue,
        };
        let factor = weight / top.model.weight(term.role, top.frequency_hz);
        into.iter_mut().enumerate().for_each(|(i, sum)| *sum += (factor * term.matrix.get(i, i)).re);
    }
    // Rows without mass follow the others at once: they carry no wave.
    let squares = stiffness.iter().zip(&mass).filter(|&(&k, &m)| m > 0.0 && k > 0.0).map(|(k, m)| k / m);
    let mut squares: Vec<f64> = squares.collect();
    if squares.len() < MIN_ROWS {
        return None;
    }
    squares.sort_by(f64::total_cmp);
    let slow = squares.get((SLOW_ROW_SHARE * squares.len() as f64) as usize)?.sqrt();
    let row_hz = slow / omega_rad_s(1.0);
    let top_hz = top.frequency_hz;
    (top_hz > RESOLVED_FREQUENCY_SHARE * row_hz).then_some(Fault::Mesh { row_hz, top_hz })
}
