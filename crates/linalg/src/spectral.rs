//! The spectral radius of an operator that is only known by what it does to a vector.
//!
//! Arnoldi's process with full reorthogonalisation, restarted from its leading Ritz vectors.
//!
//! # Source
//! Y. Saad, *Numerical Methods for Large Eigenvalue Problems*, 2nd ed., SIAM 2011, ch. 6.

use crate::c64;
use crate::dense::{Matrix, eigen};
use crate::solve::Breakdown;
use crate::vector::{norm, orthogonalise};

/// How hard to look.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SpectralOptions {
    /// Relative residual ‖Bv − λv‖/|λ| at which to stop. Default 1e-6.
    pub tolerance: f64,
    /// Krylov vectors before a restart. Default 48.
    pub subspace: usize,
    /// Restarts before giving up. Default 8.
    pub restarts: usize,
}

impl Default for SpectralOptions {
    fn default() -> Self {
        Self { tolerance: 1e-6, subspace: 48, restarts: 8 }
    }
}

/// The largest |λ| that was found, and how sure it is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SpectralRadius {
    /// |λ|.
    pub radius: f64,
    /// λ.
    pub eigenvalue: c64,
    /// ‖B v − λ v‖ / |λ| for its Ritz vector of norm one; 0 where λ = 0.
    pub residual: f64,
    /// How often the operator was applied.
    pub applications: usize,
    /// Whether the residual is under the tolerance.
    pub converged: bool,
}

/// ρ(B) for an n × n operator given by `apply(x, out)`: out = B x.
///
/// The start vector is a fixed pseudo-random one: the same operator gives the same answer.
///
/// # Errors
/// Whatever `apply` returns, and [`Breakdown::NotFinite`] where it produced a number that is not finite.
///
/// # Limits
/// Krylov methods see an eigenvalue when its eigenvector has a part in the start vector; a larger one whose part
/// is below roundoff can be missed. The residual bounds the distance to *an* eigenvalue only for normal operators.
pub fn spectral_radius(
    n: usize,
    mut apply: impl FnMut(&[c64], &mut [c64]) -> Result<(), Breakdown>,
    options: &SpectralOptions,
) -> Result<SpectralRadius, Breakdown> {
    let mut best = SpectralRadius {
        radius: 0.0,
        eigenvalue: c64::default(),
        residual: 0.0,
        applications: 0,
        converged: true,
    };
    if n == 0 {
        return Ok(best);
    }
    let mut start = pseudo_random(n);
    for _ in 0..=options.restarts {
        let mut krylov = Krylov::new(start);
        while krylov.len() < options.subspace.min(n) {
            let invariant = krylov.extend(&mut apply)?;
            best.applications += 1;
            // A small dense eigenproblem for each fourth vector: cheap beside the applications.
            if invariant || krylov.len().is_multiple_of(4) || krylov.len() >= options.subspace.min(n) {
                let ritz = krylov.leading(best.applications, options.tolerance)?;
                best = ritz;
                if best.converged || invariant {
                    best.converged = true;
                    return Ok(best);
                }
            }
        }
        start = krylov.restart_vector()?;
    }
    Ok(best)
}

/// Orthonormal v₀ … v_m and the Hessenberg matrix H with B V_m = V_{m+1} H.
struct Krylov {
    basis: Vec<Vec<c64>>,
    hessenberg: Vec<Vec<c64>>,
}

impl Krylov {
    fn new(mut start: Vec<c64>) -> Self {
        normalise(&mut start);
        Self { basis: vec![start], hessenberg: Vec::new() }
    }

    /// Number of columns of H.
    fn len(&self) -> usize {
        self.hessenberg.len()
    }

    /// One more Krylov vector; true where the space is invariant (the new vector is roundoff).
    fn extend(
        &mut self,
        apply: &mut impl FnMut(&[c64], &mut [c64]) -> Result<(), Breakdown>,
    ) -> Result<bool, Breakdown> {
        let last = &self.basis[self.len()];
        let mut next = vec![c64::default(); last.len()];
        apply(last, &mut next)?;
        let before = norm(&next);
        if !before.is_finite() {
            return Err(Breakdown::NotFinite);
        }
        let mut column = orthogonalise(&self.basis, &mut next);
        let rest = norm(&next);
        column.push(c64::new(rest, 0.0));
        self.hessenberg.push(column);
        let invariant = rest <= 4.0 * f64::EPSILON * before;
        if !invariant {
            next.iter_mut().for_each(|x| *x /= rest);
        }
        self.basis.push(next);
        Ok(invariant)
    }

    fn ritz(&self) -> Result<crate::dense::Eigen, Breakdown> {
        let m = self.len();
        let h = Matrix::from_fn(m, m, |i, j| self.hessenberg[j].get(i).copied().unwrap_or_default());
        eigen(&h).map_err(|_| Breakdown::NotFinite)
    }

    /// The Ritz value of largest modulus and its residual |h_{m+1,m}| |y_m|.
    fn leading(&self, applications: usize, tolerance: f64) -> Result<SpectralRadius, Breakdown> {
        let m = self.len();
        let ritz = self.ritz()?;
        let leader = largest(&ritz.values);
        let eigenvalue = ritz.values[leader];
        let radius = eigenvalue.norm();
        let gap = self.hessenberg[m - 1][m].norm() * ritz.vectors[(m - 1, leader)].norm();
        let residual = if radius > 0.0 { gap / radius } else { gap };
        Ok(SpectralRadius { radius, eigenvalue, residual, applications, converged: residual <= tolerance })
    }

    /// Sum of the Ritz vectors of the three largest Ritz values: near-equal moduli are kept together.
    fn restart_vector(&self) -> Result<Vec<c64>, Breakdown> {
        let ritz = self.ritz()?;
        let mut order: Vec<usize> = (0..self.len()).collect();
        order.sort_by(|&a, &b| ritz.values[b].norm().total_cmp(&ritz.values[a].norm()));
        let mut sum = vec![c64::default(); self.basis[0].len()];
        for &leader in order.iter().take(3) {
            for (v, y) in self.basis.iter().zip(ritz.vectors.column(leader)) {
                sum.iter_mut().zip(v).for_each(|(s, v)| *s += y * v);
            }
        }
        Ok(sum)
    }
}

fn largest(values: &[c64]) -> usize {
    let mut leader = 0;
    for (i, value) in values.iter().enumerate() {
        if value.norm() > values[leader].norm() {
            leader = i;
        }
    }
    leader
}

fn normalise(a: &mut [c64]) {
    let size = norm(a);
    if size > 0.0 {
        a.iter_mut().for_each(|a| *a /= size);
    }
}

/// Numbers in [−1, 1)², the same ones every time (splitmix64: Steele, Lea, Flood, OOPSLA 2014).
pub(crate) fn pseudo_random(n: usize) -> Vec<c64> {
    let mut state = 0x9E37_79B9_7F4A_7C15_u64;
    let mut next = move || {
        state = state.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = state;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    };
    (0..n).map(|_| c64::new(next(), next())).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn diagonal(values: &[c64]) -> impl FnMut(&[c64], &mut [c64]) -> Result<(), Breakdown> + '_ {
        move |x, out| {
            out.iter_mut().zip(x).zip(values).for_each(|((o, x), d)| *o = d * x);
            Ok(())
        }
    }

    #[test]
    fn finds_the_largest_of_a_normal_operator_to_its_tolerance() {
        let values: Vec<c64> =
            (0..300).map(|i| c64::from_polar(1.0 / (1.0 + 0.02 * i as f64), 0.7 * i as f64)).collect();
        let found = spectral_radius(300, diagonal(&values), &SpectralOptions::default()).unwrap();
        // Normal operator: the eigenvalue error is at most the residual.
        assert!(found.converged && (found.radius - 1.0).abs() < 1e-6, "{found:?}");
    }

    #[test]
    fn a_defective_operator_still_gets_its_radius() {
        // A 5 × 5 Jordan block of 0.5: eigenvalues are sensitive like ε^{1/5}.
        let found = spectral_radius(
            5,
            |x, out| {
                for i in 0..5 {
                    out[i] = 0.5 * x[i] + if i < 4 { x[i + 1] } else { c64::default() };
                }
                Ok(())
            },
            &SpectralOptions::default(),
        )
        .unwrap();
        assert!((found.radius - 0.5).abs() < 5e-3, "{found:?}");
    }

    #[test]
    fn zero_operator_and_empty_operator() {
        let zero = spectral_radius(
            7,
            |_, out| {
                out.fill(c64::default());
                Ok(())
            },
            &SpectralOptions::default(),
        );
        assert_eq!(zero.unwrap().radius, 0.0);
        assert_eq!(spectral_radius(0, |_, _| Ok(()), &SpectralOptions::default()).unwrap().radius, 0.0);
    }

    #[test]
    fn a_nan_is_an_error() {
        let nan = spectral_radius(
            3,
            |_, out| {
                out.fill(c64::new(f64::NAN, 0.0));
                Ok(())
            },
            &SpectralOptions::default(),
        );
        assert_eq!(nan, Err(Breakdown::NotFinite));
    }

    #[test]
    fn says_when_it_has_not_converged() {
        // 400 eigenvalues of equal modulus: no gap for Krylov to see.
        let values: Vec<c64> = (0..400).map(|i| c64::from_polar(1.0, i as f64)).collect();
        let options = SpectralOptions { restarts: 1, ..SpectralOptions::default() };
        let found = spectral_radius(400, diagonal(&values), &options).unwrap();
        assert!(!found.converged && found.residual > options.tolerance);
    }
}
