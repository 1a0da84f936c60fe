//! The information of the measurements on the numbers that hold for the band.

use frfit_linalg::dense::symmetric_eigen;

/// The sum of squares of the slopes at σ, by its eigenvectors.
pub(super) struct Information {
    /// Eigenvalues, ascending; zero where a direction is not identifiable.
    pub(super) values: Vec<f64>,
    /// Eigenvectors, one after the other.
    pub(super) vectors: Vec<f64>,
}

/// Information below this part of the largest counts as zero: this direction is known a hundred thousand times worse than the best one, by slopes of a reduced model.
const INFORMATION_RTOL: f64 = 1e-10;

/// A component of a direction below this counts as zero.
const DIRECTION_PART_TOL: f64 = 1e-4;

impl Information {
    /// From slopes of residuals, column after column; `None` without a coordinate or a finite number.
    pub(super) fn new(jacobian: &[f64], n: usize) -> Option<Self> {
        let m = jacobian.len().checked_div(n)?;
        let column = |c: usize| &jacobian[c * m..(c + 1) * m];
        let dot = |a: usize, b: usize| column(a).iter().zip(column(b)).map(|(x, y)| x * y).sum::<f64>();
        let normal: Vec<f64> = (0..n * n).map(|k| dot(k / n, k % n)).collect();
        let (mut values, vectors) = symmetric_eigen(n, &normal).ok()?;
        let least = INFORMATION_RTOL * values.last().copied().unwrap_or(0.0);
        values.iter_mut().filter(|value| **value <= least).for_each(|value| *value = 0.0);
        Some(Self { values, vectors })
    }

    /// From a covariance where noise is `level` times σ.
    pub(super) fn from_covariance(covariance: &[f64], n: usize, level: f64) -> Option<Self> {
        let (variances, columns) = symmetric_eigen(n, covariance).ok()?;
        let values = variances.iter().rev().map(|variance| level * level / variance).collect();
        let vectors = columns.rchunks_exact(n.max(1)).flatten().copied().collect();
        Some(Self { values, vectors })
    }

    /// gᵀ N⁻¹ h; infinite where both have a part that is not identifiable.
    pub(super) fn covariance(&self, g: &[f64], h: &[f64]) -> f64 {
        let size = |g: &[f64]| g.iter().map(|g| g * g).sum::<f64>().sqrt();
        let least = DIRECTION_PART_TOL * size(g) * DIRECTION_PART_TOL * size(h);
        let along = |v: &[f64], g: &[f64]| v.iter().zip(g).map(|(v, g)| v * g).sum::<f64>();
        let each = self.vectors.chunks_exact(g.len().max(1)).zip(&self.values);
        let part = |(v, &value): (&[f64], &f64)| {
            let both = along(v, g) * along(v, h);
            if value > 0.0 {
                both / value
            } else if both.abs() > least {
                f64::INFINITY
            } else {
                0.0
            }
        };
        each.map(part).sum()
    }

    /// The identifiable directions of coordinates some of which are held, of length one.
    pub(super) fn identifiable_with(jacobian: &[f64], n: usize, held: &[usize]) -> Option<Vec<Vec<f64>>> {
        let m = jacobian.len().checked_div(n)?;
        let free: Vec<usize> = (0..n).filter(|c| !held.contains(c)).collect();
        if free.is_empty() {
            return Some(Vec::new());
        }
        let columns: Vec<f64> =
            free.iter().flat_map(|&c| jacobian[c * m..(c + 1) * m].iter().copied()).collect();
        let expanded = |v: Vec<f64>| {
            let mut all = vec![0.0; n];
            free.iter().zip(v).for_each(|(&c, value)| all[c] = value);
            all
        };
        Some(Self::new(&columns, free.len())?.identifiable_from(0).into_iter().map(expanded).collect())
    }

    /// The same without the least identifiable direction.
    pub(super) fn identifiable_but_the_first(&self) -> Vec<Vec<f64>> {
        self.identifiable_from(1)
    }

    fn identifiable_from(&self, first: usize) -> Vec<Vec<f64>> {
        let n = self.values.len().max(1);
        let identifiable =
            self.vectors.chunks_exact(n).zip(&self.values).skip(first).filter(|(_, value)| **value > 0.0);
        identifiable.map(|(v, _)| v.to_vec()).collect()
    }
}
