//! min Σ r_i(θ)² from several starts, and how well the answer is determined.

use frfit_linalg::dense::symmetric_eigen;
use levenberg_marquardt::{LeastSquaresProblem, LevenbergMarquardt, TerminationReason};
use nalgebra::storage::Owned;
use nalgebra::{DMatrix, DVector, Dyn};

/// Residuals r of length m, and ∂r/∂θ, m × n, column after column.
pub(crate) type Residuals = (Vec<f64>, Vec<f64>);

/// Residuals at θ; `None` where there is no finite answer.
pub(crate) type Evaluate<'a> = &'a dyn Fn(&[f64]) -> Option<Residuals>;

/// How to search.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Search {
    /// Starts that are followed: the best of those given.
    pub(crate) starts: usize,
    /// Evaluations for each start and unknown.
    pub(crate) patience: usize,
    /// Sums of squares that differ by less than this are one.
    pub(crate) same: f64,
}

/// A minimum.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Minimum {
    pub(crate) theta: Vec<f64>,
    /// Σ r².
    pub(crate) sum: f64,
    pub(crate) jacobian: Vec<f64>,
    /// Whether the search ended because there was nothing more to gain.
    pub(crate) converged: bool,
}

/// What became of all starts.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct LocalMinima {
    pub(crate) best: Minimum,
    /// Where else a start ended, by its sum: each differs from the best by more than what is the same.
    pub(crate) others: Vec<Minimum>,
    /// Starts that were followed, and how many of them ended at the best sum.
    pub(crate) followed: usize,
    pub(crate) agreeing: usize,
}

/// A point without finite residuals is that bad: the step there is refused and shortened.
const REFUSED_RESIDUAL: f64 = 1e100;

/// Relative reduction and relative step at which a search ends. Of a χ² of ten thousand that is a millionth: a further gain moves no parameter by more than a
/// thousandth of its standard deviation.
const SEARCH_RTOL: f64 = 1e-10;

struct Problem<'a> {
    evaluate: Evaluate<'a>,
    theta: DVector<f64>,
    residuals: DVector<f64>,
    jacobian: DMatrix<f64>,
}

impl LeastSquaresProblem<f64, Dyn, Dyn> for Problem<'_> {
    type ParameterStorage = Owned<f64, Dyn>;
    type ResidualStorage = Owned<f64, Dyn>;
    type JacobianStorage = Owned<f64, Dyn, Dyn>;

    fn set_params(&mut self, theta: &DVector<f64>) {
        self.theta.copy_from(theta);
        match (self.evaluate)(theta.as_slice()) {
            Some((residuals, jacobian)) => {
                self.residuals.copy_from_slice(&residuals);
                self.jacobian.copy_from_slice(&jacobian);
            }
            None => self.residuals.fill(REFUSED_RESIDUAL),
        }
    }

    fn params(&self) -> DVector<f64> {
        self.theta.clone()
    }

    fn residuals(&self) -> Option<DVector<f64>> {
        Some(self.residuals.clone())
    }

    fn jacobian(&self) -> Option<DMatrix<f64>> {
        Some(self.jacobian.clone())
    }
}

/// Follows the best starts by Levenberg and Marquardt's method, and keeps the best end; `None` where no start has finite residuals.
///
/// # Source
/// J. J. Moré, The Levenberg–Marquardt algorithm, Lecture Notes in Mathematics 630 (1978) 105–116.
pub(crate) fn minimise(starts: &[Vec<f64>], evaluate: Evaluate<'_>, search: &Search) -> Option<LocalMinima> {
    let sum = |r: &[f64]| r.iter().map(|r| r * r).sum::<f64>();
    let mut ranked: Vec<(f64, &Vec<f64>)> =
        starts.iter().filter_map(|theta| Some((sum(&evaluate(theta)?.0), theta))).collect();
    ranked.sort_by(|a, b| a.0.total_cmp(&b.0));
    ranked.truncate(search.starts);
    let mut ends: Vec<Minimum> =
        ranked.iter().filter_map(|(_, theta)| descend(theta, evaluate, search)).collect();
    ends.sort_by(|a, b| a.sum.total_cmp(&b.sum));
    let followed = ends.len();
    let least = ends.first()?.sum;
    let agreeing = ends.iter().take_while(|end| end.sum - least <= search.same).count();
    // Of those that agree, one that has converged.
    let best = ends[..agreeing].iter().position(|end| end.converged).unwrap_or(0);
    let best = ends.remove(best);
    let mut others: Vec<Minimum> = Vec::new();
    for end in ends.into_iter().skip(agreeing - 1) {
        if others.last().is_none_or(|last| end.sum - last.sum > search.same) {
            others.push(end);
        }
    }
    Some(LocalMinima { best, others, followed, agreeing })
}

/// Follows one start.
pub(crate) fn descend(start: &[f64], evaluate: Evaluate<'_>, search: &Search) -> Option<Minimum> {
    let (residuals, jacobian) = evaluate(start)?;
    let (m, n) = (residuals.len(), start.len());
    let problem = Problem {
        evaluate,
        theta: DVector::from_column_slice(start),
        residuals: DVector::from_vec(residuals),
        jacobian: DMatrix::from_vec(m, n, jacobian),
    };
    let method = LevenbergMarquardt::new().with_patience(search.patience);
    let method = method.with_ftol(SEARCH_RTOL).with_xtol(SEARCH_RTOL).with_gtol(f64::EPSILON);
    let (end, report) = method.minimize(problem);
    let theta = end.theta.as_slice().to_vec();
    let (residuals, jacobian) = evaluate(&theta)?;
    let sum = residuals.iter().map(|r| r * r).sum();
    // Nothing to gain to the last bit is as good as it gets.
    let reason = report.termination;
    let has_ended = reason.was_successful() || matches!(reason, TerminationReason::NoImprovementPossible(_));
    let converged = has_ended || is_settled(&residuals, &jacobian, n);
    Some(Minimum { theta, sum, jacobian, converged })
}

/// Of a residual that is noise, what a last step may still gain: it moves nothing that the data determine by more than a tenth of its standard deviation.
const SETTLED_GAIN: f64 = 0.01;

/// Whether a full step gains next to nothing by the slopes: r·P r with the projection P on the columns of the Jacobian. A search that has lost its
/// patience in a flat valley, as where a law has a parameter too many, ends there.
fn is_settled(residuals: &[f64], jacobian: &[f64], n: usize) -> bool {
    let m = residuals.len();
    if m <= n {
        return false;
    }
    let Some(inverse) = inverse_information(jacobian, n) else { return false };
    let pull: Vec<f64> =
        jacobian.chunks_exact(m).map(|c| c.iter().zip(residuals).map(|(a, b)| a * b).sum()).collect();
    let pairs = (0..n * n).map(|k| pull[k / n] * inverse[k / n][k % n] * pull[k % n]);
    let gain: f64 = pairs.filter(|product| product.is_finite()).sum();
    let sum: f64 = residuals.iter().map(|r| r * r).sum();
    gain <= SETTLED_GAIN * sum / (m - n) as f64
}

/// (JᵀJ)⁻¹, n × n, row after row.
///
/// A column of zeros is a coordinate on which no residual depends: its rows are NaN, and the others are those without it. `None` where coordinates depend on each other to the last digit.
pub(crate) fn inverse_information(jacobian: &[f64], n: usize) -> Option<Vec<Vec<f64>>> {
    let m = jacobian.len() / n.max(1);
    let norms: Vec<f64> =
        jacobian.chunks_exact(m).map(|c| c.iter().map(|x| x * x).sum::<f64>().sqrt()).collect();
    let sensitive: Vec<usize> = (0..n).filter(|&j| norms[j] > INSENSITIVE_COORDINATE_TOL).collect();
    let k = sensitive.len();
    let column = |j: usize| &jacobian[j * m..(j + 1) * m];
    let correlation = |(i, j): (usize, usize)| {
        let dot: f64 = column(i).iter().zip(column(j)).map(|(a, b)| a * b).sum();
        dot / (norms[i] * norms[j])
    };
    let scaled: Vec<f64> =
        sensitive.iter().flat_map(|&i| sensitive.iter().map(move |&j| (i, j))).map(correlation).collect();
    let (values, vectors) = symmetric_eigen(k, &scaled).ok()?;
    if values.first().is_some_and(|&least| least < DEPENDENT_COORDINATE_RTOL) {
        return None;
    }
    let mut inverse = vec![vec![f64::NAN; n]; n];
    for (a, &i) in sensitive.iter().enumerate() {
        for (b, &j) in sensitive.iter().enumerate() {
            let sum: f64 = (0..k).map(|q| vectors[q * k + a] * vectors[q * k + b] / values[q]).sum();
            inverse[i][j] = sum / (norms[i] * norms[j]);
        }
    }
    Some(inverse)
}

/// A coordinate whose change by one moves Σ r² by less than the square of this is not identifiable.
const INSENSITIVE_COORDINATE_TOL: f64 = 1e-8;

/// Eigenvalues of JᵀJ with columns of norm one are exact to some ε; below this they have no digit.
const DEPENDENT_COORDINATE_RTOL: f64 = 1e-13;

#[cfg(test)]
mod tests {
    use super::*;

    const SEARCH: Search = Search { starts: 4, patience: 100, same: 1e-9 };

    /// Freudenstein and Roth: two minima, 0 at (5, 4) and 48.98 at (11.41, −0.8968) (Moré, Garbow, Hillstrom 1981, problem 2).
    fn freudenstein_roth(t: &[f64]) -> Option<Residuals> {
        let (x, y) = (t[0], t[1]);
        let r = vec![-13.0 + x + ((5.0 - y) * y - 2.0) * y, -29.0 + x + ((y + 1.0) * y - 14.0) * y];
        Some((r, vec![1.0, 1.0, 10.0 * y - 3.0 * y * y - 2.0, 3.0 * y * y + 2.0 * y - 14.0]))
    }

    /// A mean with and without a tenth of its standard deviation too much, and with half of it.
    #[test]
    fn a_search_is_settled_where_a_step_gains_nothing_that_noise_does_not() {
        let noise = [1.2, -0.7, 0.4, -1.5, 0.9, -0.3];
        let std = (noise.iter().map(|r| r * r).sum::<f64>() / 5.0 / 6.0).sqrt();
        for (off, settled) in [(0.0, true), (0.09, true), (0.5, false)] {
            let residuals = noise.map(|r| r + off * std);
            assert_eq!(is_settled(&residuals, &[1.0; 6], 1), settled, "{off}");
        }
        // Two coordinates that are one, and as many coordinates as residuals.
        assert!(
            !is_settled(&noise, &[1.0; 12], 2) && !is_settled(&[0.0], &[1.0], 1) && !is_settled(&[], &[], 1)
        );
    }

    #[test]
    fn the_best_of_several_minima_is_kept_and_the_other_is_named() {
        let minima =
            minimise(&[vec![0.5, -2.0], vec![15.0, 4.0], vec![4.0, 3.0]], &freudenstein_roth, &SEARCH)
                .unwrap();
        assert!(minima.best.converged && minima.best.sum < 1e-20, "{minima:?}");
        assert!((minima.best.theta[0] - 5.0).abs() < 1e-9 && (minima.best.theta[1] - 4.0).abs() < 1e-9);
        assert_eq!((minima.followed, minima.agreeing, minima.others.len()), (3, 2, 1));
        assert!((minima.others[0].sum - 48.984_253_679).abs() < 1e-6, "{:?}", minima.others);
    }

    #[test]
    fn steps_to_where_nothing_is_finite_are_refused() {
        // ln x has no value below 0, where the first step from 5 leads: x = 5 − 5 ln 5.
        let log = |t: &[f64]| (t[0] > 0.0).then(|| (vec![t[0].ln()], vec![1.0 / t[0]]));
        let minima = minimise(&[vec![5.0], vec![-1.0]], &log, &SEARCH).unwrap();
        assert!((minima.best.theta[0] - 1.0).abs() < 1e-9, "{minima:?}");
        assert_eq!(minima.followed, 1);
        assert!(minimise(&[vec![-1.0]], &log, &SEARCH).is_none());
    }

    #[test]
    fn the_information_is_inverted_as_far_as_there_is_any() {
        // JᵀJ = [[2, 1], [1, 1]] has the inverse [[1, −1], [−1, 2]].
        let two = inverse_information(&[1.0, 1.0, 1.0, 0.0], 2).unwrap();
        for (row, expected) in two.iter().zip([[1.0, -1.0], [-1.0, 2.0]]) {
            assert!(row.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-14), "{two:?}");
        }
        let with_zero = inverse_information(&[1.0, 1.0, 0.0, 0.0], 2).unwrap();
        assert!(
            (with_zero[0][0] - 0.5).abs() < 1e-15 && with_zero[1][1].is_nan() && with_zero[0][1].is_nan()
        );
        assert_eq!(inverse_information(&[1.0, 2.0, 2.0, 4.0], 2), None);
    }
}
