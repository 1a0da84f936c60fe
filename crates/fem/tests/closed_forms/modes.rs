//! Natural frequencies by subspace iteration.

use super::support::{form, product};
use frfit_linalg::solve::Analysis;
use frfit_linalg::sparse::SymmetricMatrix;
use nalgebra::{DMatrix, SymmetricEigen};

/// The lowest eigenvalues ω² of K φ = ω² M φ, ascending, for positive definite K + shift·M.
///
/// Bathe & Wilson, Int. J. Numer. Methods Eng. 6 (1973) 213–226.
pub(crate) fn lowest(k: &SymmetricMatrix, m: &SymmetricMatrix, count: usize, shift: f64) -> Vec<f64> {
    let n = k.dim();
    let size = (2 * count).max(count + 6).min(n);
    let shifted: Vec<f64> = {
        let m = m.on_pattern(k.pattern());
        k.real_values().unwrap().iter().zip(m.real_values().unwrap()).map(|(k, m)| k + shift * m).collect()
    };
    let factor = Analysis::new(k.pattern()).factor(&shifted).unwrap();
    let shifted = SymmetricMatrix::new(k.pattern().clone(), frfit_linalg::sparse::Values::Real(shifted));
    // Any start that no symmetry of the structure leaves out of a mode.
    let mut basis: Vec<Vec<f64>> =
        (0..size).map(|j| (0..n).map(|i| ((1 + i * (3 * j + 2)) as f64).sin()).collect()).collect();
    let mut previous = vec![f64::INFINITY; count];
    for _ in 0..200 {
        for vector in &mut basis {
            *vector = product(m, vector);
            factor.solve(vector).unwrap();
        }
        let values = ritz(&shifted, m, &mut basis);
        // Below every error that the tests look at, above the roundoff of a slender structure: its stiffnesses
        // differ by 1e8, and what a solution has of the stiffest directions from roundoff alone moves a Ritz value by up to 7e-10.
        let settled = values.iter().zip(&previous).all(|(new, old)| (new - old).abs() < 2e-9 * new.abs());
        if settled {
            return values[..count].iter().map(|value| value - shift).collect();
        }
        previous = values[..count].to_vec();
    }
    panic!("subspace iteration has not settled");
}

/// Rayleigh–Ritz: eigenvalues of the projected problem, ascending; the basis becomes the Ritz vectors.
fn ritz(k: &SymmetricMatrix, m: &SymmetricMatrix, basis: &mut Vec<Vec<f64>>) -> Vec<f64> {
    let size = basis.len();
    for vector in basis.iter_mut() {
        let norm = form(vector, k, vector).sqrt();
        vector.iter_mut().for_each(|entry| *entry /= norm);
    }
    let project =
        |matrix| DMatrix::from_fn(size, size, |i, j| form(&basis[i.min(j)], matrix, &basis[i.max(j)]));
    // M y = θ K y with K positive definite, for M may be singular.
    let root = project(k).cholesky().expect("independent vectors").l();
    let left = root.solve_lower_triangular(&project(m)).unwrap();
    let reduced = root.solve_lower_triangular(&left.transpose()).unwrap();
    let eigen = SymmetricEigen::new((&reduced + reduced.transpose()) / 2.0);
    let mut order: Vec<usize> = (0..size).collect();
    order.sort_by(|&a, &b| eigen.eigenvalues[b].total_cmp(&eigen.eigenvalues[a]));
    let vectors = root.transpose().solve_upper_triangular(&eigen.eigenvectors).unwrap();
    let combine = |j: usize| {
        (0..basis[0].len()).map(|row| (0..size).map(|i| basis[i][row] * vectors[(i, j)]).sum()).collect()
    };
    let turned = order.iter().map(|&j| combine(j)).collect();
    *basis = turned;
    order.iter().map(|&j| 1.0 / eigen.eigenvalues[j]).collect()
}
