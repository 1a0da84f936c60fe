//! The choice of a pivot by rows and columns in turn, as a rook moves.
//!
//! C. Ashcraft, R. G. Grimes, J. G. Lewis, SIAM J. Matrix Anal. Appl. 20 (1998) 513–561.

/// Growth-optimal threshold of Bunch and Kaufman, (1 + √17)/8.
const ALPHA: f64 = 0.640_388_203_202_208_4;

/// A column, or two in ascending order, as the next pivot: no entry of a real L becomes larger than 1/(1 − α) = 2.8.
///
/// `diagonal` gives the size of a diagonal entry, `largest` where the largest other entry of a row and column is, and
/// its size: `found` in the first.
#[inline(always)]
pub(super) fn rook(
    first: usize,
    found: (usize, f64),
    diagonal: impl Fn(usize) -> f64,
    largest: impl Fn(usize) -> (usize, f64),
) -> (usize, Option<usize>) {
    let (mut at, (mut next, mut most)) = (first, found);
    if next == at || diagonal(at) >= ALPHA * most {
        return (at, None);
    }
    loop {
        let (after, across) = largest(next);
        if diagonal(next) >= ALPHA * across {
            return (next, None);
        }
        // The largest of its row and of its column; `across` grows from turn to turn, so there is an end.
        if across <= most {
            return (at.min(next), Some(at.max(next)));
        }
        (at, next, most) = (next, after, across);
    }
}

#[cfg(test)]
mod tests {
    use super::{ALPHA, rook};
    use proptest::prelude::*;

    /// What a rook finds in a symmetric matrix, row after row.
    fn chosen(matrix: &[f64], n: usize) -> (usize, Option<usize>) {
        let largest = |of: usize| {
            let others = (0..n).filter(|&k| k != of).map(|k| (k, matrix[of * n + k].abs()));
            others.fold((of, 0.0), |best, it| if it.1 > best.1 { it } else { best })
        };
        rook(0, largest(0), |k| matrix[k * n + k].abs(), largest)
    }

    #[test]
    fn a_zero_diagonal_makes_a_pair_and_a_large_one_is_taken() {
        assert_eq!(chosen(&[0.0, 1.0, 1.0, 0.0], 2), (0, Some(1)));
        assert_eq!(chosen(&[1.0, 1.0, 1.0, 0.0], 2), (0, None));
        assert_eq!(chosen(&[0.1, 1.0, 1.0, 5.0], 2), (1, None));
        assert_eq!(chosen(&[0.0], 1), (0, None));
    }

    proptest! {
        #[test]
        fn entries_of_l_are_bounded(n in 1usize..7, numbers in proptest::collection::vec(-1.0f64..1.0, 49)) {
            let matrix: Vec<f64> =
                (0..n * n).map(|k| numbers[(k / n).min(k % n) * 7 + (k / n).max(k % n)]).collect();
            let at = |i: usize, j: usize| matrix[i * n + j];
            let bound = (1.0 + 1e-12) / (1.0 - ALPHA);
            match chosen(&matrix, n) {
                (j, None) => (0..n).filter(|&i| i != j).for_each(|i| assert!(at(i, j).abs() <= bound * at(j, j).abs())),
                (j, Some(k)) => {
                    let determinant = at(j, j) * at(k, k) - at(j, k) * at(j, k);
                    for i in (0..n).filter(|&i| i != j && i != k) {
                        let first = (at(i, j) * at(k, k) - at(i, k) * at(j, k)) / determinant;
                        let second = (at(i, k) * at(j, j) - at(i, j) * at(j, k)) / determinant;
                        assert!(first.abs().max(second.abs()) <= bound);
                    }
                }
            }
        }
    }
}
