//! Dimensions: matrices that are given at several values of one, and models that stand at the nominal value of each.

use crate::case::{CaseFile, Located};
use crate::error::InputError;
use frfit::c64;
use frfit::model::Term;
use frfit_linalg::dense::{Matrix, solve};
use frfit_linalg::sparse::{SymmetricMatrix, Triplets};
use std::collections::BTreeMap;

/// What a term of the model is of a matrix of the case.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct PartOf {
    /// The matrix.
    pub(super) matrix: String,
    /// Of a matrix that is given at several values of a dimension: its name, and the power to which it multiplies the term.
    pub(super) dimension: Option<(String, i32)>,
}

/// A matrix may be that far from the polynomial through the others, relative to its largest entry: some programs write seven digits.
const MEETS: f64 = 1e-6;

/// A power whose part of the matrix is smaller than this, relative to its largest entry, is rounding.
const NONE: f64 = 1e-11;

/// Rounding of a matrix' digits may be amplified by at most this in K_q: of sixteen digits there are then as many left as [`MEETS`] asks for.
const AMPLIFIED: f64 = MEETS / f64::EPSILON;

/// K_q of K(p) = Σ_q p^q K_q through the matrices at all values but the middle one, which has to be met (B-8). Without `powers` q is 0, 1, 2 and so on.
///
/// # Errors
/// Where it is not, a matrix is complex, or values are too near to each other for as many powers.
pub(super) fn polynomial(
    samples: &[(f64, SymmetricMatrix)],
    powers: Option<&Located<Vec<i32>>>,
    dimension: &Located<String>,
) -> Result<Vec<(i32, SymmetricMatrix)>, InputError> {
    let mut samples: Vec<&(f64, SymmetricMatrix)> = samples.iter().collect();
    samples.sort_by(|a, b| a.0.total_cmp(&b.0));
    let n = samples.len();
    let all: Vec<i32> = (0..n as i32 - 1).collect();
    let exponents = powers.map_or(&all, |powers| &powers.value);
    // Every entry at every value, those of the check last.
    let check = samples.remove(n / 2);
    samples.push(check);
    let mut entries: BTreeMap<(usize, usize), Vec<f64>> = BTreeMap::new();
    for (k, (_, matrix)) in samples.iter().enumerate() {
        let Some(values) = matrix.real_values() else {
            let expected = "real matrices at the values of a dimension";
            return Err(InputError::at(&dimension.place, expected, "a complex one"));
        };
        for (position, &value) in matrix.pattern().positions().zip(values) {
            entries.entry(position).or_insert_with(|| vec![0.0; n])[k] = value;
        }
    }
    // In units of the middle value powers are of one size.
    let unit = check.0;
    let fitted = &samples[..n - 1];
    let vandermonde =
        Matrix::from_fn(n - 1, n - 1, |i, q| c64::new((fitted[i].0 / unit).powi(exponents[q]), 0.0));
    if amplification(&vandermonde, n - 1).is_none_or(|by| by > AMPLIFIED) {
        let expected =
            format!("values of {} far enough apart for its powers {}", dimension.value, listed(exponents));
        let found = samples.iter().map(|(value, _)| value.to_string()).collect::<Vec<_>>().join(", ");
        return Err(InputError::at(powers.map_or(&dimension.place, |own| &own.place), expected, found));
    }
    let (mut largest, mut off) = (0.0f64, 0.0f64);
    let mut coefficients = Vec::with_capacity(entries.len());
    for (position, values) in entries {
        let right: Vec<c64> = values[..n - 1].iter().map(|&v| c64::new(v, 0.0)).collect();
        // Values differ, so that there is an answer.
        let own: Vec<f64> = solve(&vandermonde, &right).unwrap_or_default().iter().map(|c| c.re).collect();
        off = off.max((own.iter().sum::<f64>() - values[n - 1]).abs());
        largest = values.iter().fold(largest, |largest, value| largest.max(value.abs()));
        coefficients.push((position, own));
    }
    let beside = off / largest;
    // a matrix of zeros has no largest entry
    if largest > 0.0 && (beside.is_nan() || beside > MEETS) {
        let name = &dimension.value;
        let (place, expected) = match powers {
            None => (
                &dimension.place,
                format!(
                    "a matrix that is a polynomial of degree {} in {name} through the other values: at more values, one of higher degree; or its powers",
                    n - 2
                ),
            ),
            Some(own) => {
                let powers = listed(exponents);
                (
                    &own.place,
                    format!(
                        "a matrix with the powers {powers} of {name} through the other values: others, or more"
                    ),
                )
            }
        };
        let found = format!("{beside:.1e} of its largest entry beside it at {unit}");
        return Err(InputError::at(place, expected, found));
    }
    let dim = check.1.dim();
    let of_power = |q: usize| {
        let any = coefficients.iter().any(|(_, own)| own[q].abs() > NONE * largest);
        any.then(|| {
            let mut matrix = Triplets::new(dim);
            for ((row, col), own) in &coefficients {
                matrix.add(*row, *col, own[q] / unit.powi(exponents[q]));
            }
            (exponents[q], matrix.assemble())
        })
    };
    Ok((0..n - 1).filter_map(of_power).collect())
}

/// ‖V⁻¹‖∞, which is by how much rounding of the matrices is amplified in their parts; `None` where there is no inverse.
fn amplification(vandermonde: &Matrix, n: usize) -> Option<f64> {
    let unit = |k: usize| (0..n).map(|i| c64::new(f64::from(u8::from(i == k)), 0.0)).collect::<Vec<_>>();
    let columns = (0..n).map(|k| solve(vandermonde, &unit(k)).ok()).collect::<Option<Vec<_>>>()?;
    let of_row = |q: usize| columns.iter().map(|column| column[q].norm()).sum::<f64>();
    let largest = (0..n).map(of_row).fold(0.0, f64::max);
    largest.is_finite().then_some(largest)
}

fn listed(powers: &[i32]) -> String {
    powers.iter().map(i32::to_string).collect::<Vec<_>>().join(", ")
}

/// (term, power) of a dimension, from the matrices that are given at its values and from `powers`.
pub(super) fn powers_of(
    dimension: &str,
    of: &[PartOf],
    also: &[(Located<String>, i32)],
) -> Vec<(usize, i32)> {
    let own = |part: &PartOf| {
        let at = part.dimension.as_ref().filter(|(name, _)| name == dimension).map_or(0, |(_, power)| *power);
        let given = also.iter().find(|(name, _)| name.value == part.matrix).map_or(0, |(_, power)| *power);
        at + given
    };
    let all = of.iter().map(own).enumerate();
    all.filter(|(_, power)| *power != 0).collect()
}

/// The terms with every dimension at its nominal value: the model of whoever does not look for it.
///
/// # Errors
/// Where a matrix is given at values of a dimension that has no nominal one.
pub(super) fn at_nominal(
    case: &CaseFile,
    mut terms: Vec<Term>,
    of: &[PartOf],
) -> Result<Vec<Term>, InputError> {
    each_has_a_value(case)?;
    for one in case.unknowns() {
        let Some(nominal) = &one.nominal else { continue };
        case.has_matrices(one.powers.iter().map(|(name, _)| name))?;
        for (term, power) in powers_of(&one.name.value, of, &one.powers) {
            terms[term].factor = terms[term].factor.scaled(nominal.value.powi(power));
        }
    }
    Ok(terms)
}

/// Refuses a matrix that is given at values of a dimension without a nominal one.
pub(super) fn each_has_a_value(case: &CaseFile) -> Result<(), InputError> {
    for at in case.matrices.iter().filter_map(|entry| entry.at.as_ref()) {
        let name = &at.dimension.value;
        if !case.unknowns().any(|one| one.name.value == *name && one.nominal.is_some()) {
            let expected = format!("an [[identify]] with name = {name:?} and its nominal value");
            return Err(InputError::at(&at.dimension.place, expected, "none"));
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::error::Place;
    use std::path::Path;

    fn name() -> Located<String> {
        Located { value: "h".into(), place: Place::file(Path::new("case.toml")) }
    }

    /// 2 × 2 with entries of a polynomial.
    fn sample(p: f64, entry: impl Fn(f64) -> f64) -> (f64, SymmetricMatrix) {
        let mut matrix = Triplets::new(2);
        matrix.add(0, 0, entry(p));
        matrix.add(1, 1, 2.0 * p);
        (p, matrix.assemble())
    }

    #[test]
    fn powers_are_told_from_values() {
        let entry = |p: f64| 3.0 + 5.0 * p.powi(3);
        let samples: Vec<_> = [0.8, 1.0, 1.1, 1.3, 0.9].map(|p| sample(p, entry)).into();
        let found = polynomial(&samples, None, &name()).unwrap();
        assert_eq!(found.iter().map(|(power, _)| *power).collect::<Vec<_>>(), [0, 1, 3]);
        let at = |p: f64, row: usize| -> f64 {
            let value = |matrix: &SymmetricMatrix| {
                let mut all = matrix.pattern().positions().zip(matrix.real_values().unwrap());
                all.find(|(position, _)| *position == (row, row)).map_or(0.0, |(_, value)| *value)
            };
            found.iter().map(|(power, matrix)| p.powi(*power) * value(matrix)).sum()
        };
        // 1.7 is beyond all values: rounding of the values' last digits is amplified some hundred times
        assert!((at(1.7, 0) - entry(1.7)).abs() < 1e-12 * 1e3 && (at(1.7, 1) - 3.4).abs() < 1e-12 * 1e3);
    }

    #[test]
    fn what_is_no_polynomial_of_that_degree_is_refused() {
        let samples: Vec<_> = [0.8, 1.0, 1.1, 1.3].map(|p| sample(p, |p| 5.0 * p.powi(3))).into();
        let error = polynomial(&samples, None, &name()).unwrap_err().to_string();
        assert!(error.contains("degree 2 in h") && error.contains("at 1.1"), "{error}");
    }
}
