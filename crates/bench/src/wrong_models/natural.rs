//! How wrong a model is: its natural frequencies beside those of the truth.

use super::Failure;
use super::realised::Realised;
use frfit::c64;
use frfit::model::{DynamicStiffness, Role};
use frfit_linalg::modes::{Modes, ModesError, lowest};
use frfit_linalg::sparse::{SymmetricMatrix, Values};

/// An elastic mode.
#[derive(Debug, Clone)]
pub struct Mode {
    /// Its natural frequency.
    pub hz: f64,
    /// Deflection along Z at the stations.
    shape: Vec<f64>,
}

/// A natural frequency below this part of the highest is that of a rigid body: roundoff.
const RIGID: f64 = 1e-3;

/// The lowest elastic modes of a model without its losses, the unknown factor at the storage modulus that its law has at a frequency, with so many
/// modes searched in all, or fewer where the last of them do not converge.
///
/// # Errors
/// Where they do not converge.
pub fn modes(
    realised: &Realised,
    stations: &[[f64; 3]],
    at_hz: f64,
    count: usize,
) -> Result<Vec<Mode>, Failure> {
    let found = undamped(&realised.model, at_hz, count)?;
    let rows = stations.iter().map(|&station| realised.row(station)).collect::<Result<Vec<_>, _>>()?;
    let elastic = elastic(&found);
    Ok(elastic.map(|(hz, shape)| Mode { hz, shape: rows.iter().map(|&row| shape[row]).collect() }).collect())
}

/// The lowest modes of a model without its losses, its factors at the storage moduli that they have at a frequency; fewer where the last of them do not converge.
///
/// # Errors
/// Where they do not converge.
pub fn undamped(model: &DynamicStiffness, at_hz: f64, count: usize) -> Result<Modes, Failure> {
    let (stiffness, mass) = (sum(model, Role::Stiffness, at_hz)?, sum(model, Role::Mass, at_hz)?);
    Ok(match lowest(&stiffness, &mass, count) {
        // The highest of them are the last to converge, and the least needed.
        Err(ModesError::NotConverged { converged }) if converged > 1 => {
            lowest(&stiffness, &mass, converged - 1)?
        }
        found => found?,
    })
}

/// Natural frequencies in Hz and shapes of all modes but those of rigid bodies.
pub fn elastic(modes: &Modes) -> impl Iterator<Item = (f64, &Vec<f64>)> {
    let frequencies = modes.frequencies_hz();
    let least = RIGID * frequencies.last().copied().unwrap_or(0.0);
    frequencies.into_iter().zip(&modes.shapes).filter(move |(hz, _)| *hz > least)
}

/// The real part of all terms of a role.
fn sum(model: &DynamicStiffness, role: Role, at_hz: f64) -> Result<SymmetricMatrix, Failure> {
    let pattern = model.analysis().pattern();
    let mut values = vec![c64::default(); pattern.stored()];
    for term in model.terms().iter().filter(|term| term.role == role) {
        term.matrix.accumulate_into(c64::new(term.factor.at(at_hz)?.re, 0.0), &mut values);
    }
    Ok(SymmetricMatrix::new(pattern.clone(), Values::Real(values.iter().map(|value| value.re).collect())))
}

/// Shapes that agree less than this are not one mode.
const ALIKE: f64 = 0.7;

/// Nor are those whose frequencies differ by more than this: between nodes a high mode may look like a low one.
const NEAR: f64 = 0.25;

/// The natural frequency f of each mode of a model that the truth has too, and f/f₀ − 1, f₀ that of the truth's mode in the neighbourhood whose shape
/// is most alike (modal assurance criterion).
pub fn errors(model: &[Mode], truth: &[Mode]) -> Vec<[f64; 2]> {
    let error = |mode: &Mode| {
        let near = truth.iter().filter(|other| (mode.hz / other.hz - 1.0).abs() <= NEAR);
        let alike = near.map(|other| (assurance(&mode.shape, &other.shape), other.hz));
        let (assurance, hz) = alike.max_by(|a, b| a.0.total_cmp(&b.0))?;
        (assurance > ALIKE).then(|| [mode.hz, mode.hz / hz - 1.0])
    };
    model.iter().filter_map(error).collect()
}

pub(super) fn assurance(a: &[f64], b: &[f64]) -> f64 {
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    dot(a, b).powi(2) / (dot(a, a) * dot(b, b)).max(f64::MIN_POSITIVE)
}

/// Median of the absolute values of some errors; `None` of none.
pub fn size(errors: &[[f64; 2]]) -> Option<f64> {
    median(errors.iter().map(|[_, error]| error.abs()).collect())
}

/// The middle of some numbers; `None` of none.
pub fn median(mut values: Vec<f64>) -> Option<f64> {
    values.sort_by(f64::total_cmp);
    let n = values.len();
    (n > 0).then(|| 0.5 * (values[(n - 1) / 2] + values[n / 2]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn modes_are_paired_by_their_shapes() {
        let mode = |hz, shape: [f64; 2]| Mode { hz, shape: shape.to_vec() };
        // The truth has its two modes in the other order, one mode of its own, and signs are arbitrary.
        let model = [mode(10.0, [1.0, 0.0]), mode(11.0, [0.0, 1.0])];
        let truth = [mode(10.0, [0.0, -2.0]), mode(10.5, [0.6, 0.6]), mode(12.5, [3.0, 0.0])];
        let errors = errors(&model, &truth);
        assert!((errors[0][1] + 0.2).abs() < 1e-12 && (errors[1][1] - 0.1).abs() < 1e-12, "{errors:?}");
    }

    #[test]
    fn the_median_of_an_even_number_lies_between() {
        assert_eq!(median(vec![3.0, 1.0, 2.0, 10.0]), Some(2.5));
        assert_eq!(median(Vec::new()), None);
    }
}
