//! What adds up to an error bar: noise, errors of the model, factors that are taken for known.

use super::estimated::Estimated;
use frfit_linalg::dense::Cholesky;

/// The covariance of some coordinates of a search, and which of them are errors.
pub(in crate::identify) struct Split {
    covariance: Vec<f64>,
    /// All errors, and those of known factors alone.
    errors: Held,
    known_factors: Held,
}

/// Coordinates that are held, and the factor of their covariance.
struct Held {
    coordinates: Vec<usize>,
    factor: Cholesky,
}

impl Estimated {
    /// Of all coordinates; `None` where the covariance of the errors is not definite.
    pub(in crate::identify) fn split(&self) -> Option<Split> {
        self.split_of(&(0..self.count()).collect::<Vec<_>>())
    }

    /// Of some of the coordinates; `None` where the covariance of the errors is not definite.
    pub(in crate::identify) fn split_of(&self, coordinates: &[usize]) -> Option<Split> {
        let first_factor = self.first_of_modes() + self.errors.stiffness.len();
        let is_error = |c: usize| self.error_range().contains(&c);
        let is_known = |c: usize| {
            let factor = c.checked_sub(first_factor).and_then(|t| self.factors.get(t));
            factor.is_some_and(|factor| factor.is_known)
        };
        let covariance = self.covariance_of(coordinates);
        let held = |wanted: &dyn Fn(usize) -> bool| {
            let places: Vec<usize> = (0..coordinates.len()).filter(|&k| wanted(coordinates[k])).collect();
            Held::new(&covariance, coordinates.len(), places)
        };
        let (errors, known_factors) = (held(&is_error)?, held(&is_known)?);
        Some(Split { covariance, errors, known_factors })
    }
}

impl Held {
    fn new(covariance: &[f64], n: usize, coordinates: Vec<usize>) -> Option<Self> {
        let row = |&a: &usize| coordinates.iter().map(move |b| covariance[a * n + b]);
        let block: Vec<f64> = coordinates.iter().flat_map(row).collect();
        let factor = Cholesky::new(coordinates.len(), &block).ok()?;
        Some(Self { coordinates, factor })
    }

    /// By how much holding them reduces a variance, of whose gradient g this is Cg.
    fn reduction(&self, times: &[f64]) -> f64 {
        let own: Vec<f64> = self.coordinates.iter().map(|&c| times[c]).collect();
        let mut solved = own.clone();
        self.factor.solve(&mut solved);
        own.iter().zip(&solved).map(|(a, b)| a * b).sum()
    }
}

impl Split {
    /// The variance gᵀCg of a gradient, zero beyond its end: the part that remains without errors of the model; the part that vanishes when the errors of known factors are
    /// held; and the part of the rest that vanishes when all errors are held. In the order of [`crate::identify::Contributions`]: noise, model, known factors.
    pub(in crate::identify) fn of(&self, gradient: &[f64]) -> [f64; 3] {
        let n = self.covariance.len().isqrt();
        let row = |row: &[f64]| row.iter().zip(gradient).map(|(c, g)| c * g).sum::<f64>();
        let times: Vec<f64> = self.covariance.chunks_exact(n.max(1)).map(row).collect();
        let whole: f64 = times.iter().zip(gradient).map(|(t, g)| t * g).sum();
        let of_errors = self.errors.reduction(&times).min(whole);
        let of_known = self.known_factors.reduction(&times).min(of_errors);
        [whole - of_errors, of_errors - of_known, of_known]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The variance that remains when some coordinates are held is the inverse of the rest's block of the inverse.
    #[test]
    fn contributions_are_those_of_coordinates_that_are_held() {
        const N: usize = 5;
        let root: Vec<f64> = (0..N * N).map(|k| ((7 * k + 3) % 11) as f64 / 11.0 - 0.4).collect();
        let of = |i: usize, j: usize| -> f64 { (0..N).map(|k| root[i * N + k] * root[j * N + k]).sum() };
        let covariance: Vec<f64> =
            (0..N * N).map(|k| of(k / N, k % N) + if k % (N + 1) == 0 { 0.1 } else { 0.0 }).collect();
        let information = Cholesky::new(N, &covariance).unwrap().inverse();
        let gradient = [0.7, -1.1, 0.4, 0.9];
        let left = |kept: &[usize]| -> f64 {
            let block: Vec<f64> = kept
                .iter()
                .flat_map(|&i| kept.iter().map(move |&j| i * N + j))
                .map(|k| information[k])
                .collect();
            let own: Vec<f64> = kept.iter().map(|&i| gradient.get(i).copied().unwrap_or(0.0)).collect();
            let mut times = own.clone();
            Cholesky::new(kept.len(), &block).unwrap().solve(&mut times);
            own.iter().zip(times).map(|(a, b)| a * b).sum()
        };
        let held = |coordinates: &[usize]| Held::new(&covariance, N, coordinates.to_vec()).unwrap();
        let split =
            Split { errors: held(&[2, 3, 4]), known_factors: held(&[3]), covariance: covariance.clone() };
        let [noise, model, known_factors] = split.of(&gradient);
        let (whole, without_known) = (left(&[0, 1, 2, 3, 4]), left(&[0, 1, 2, 4]));
        assert!((noise - left(&[0, 1])).abs() < 1e-12 * whole);
        assert!((known_factors - (whole - without_known)).abs() < 1e-12 * whole);
        assert!((noise + model + known_factors - whole).abs() < 1e-12 * whole);
    }
}
