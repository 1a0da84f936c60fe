//! The choice of a pivot by rows and columns in turn, as a rook moves.
//!
//! C. Ashcraft, R. G. Grimes, J. G. Lewis, SIAM J. Matrix Anal. Appl. 20 (1998) 513–561.

use std::ops::Range;

/// Growth-optimal threshold of Bunch and Kaufman, (1 + √17)/8.
const BUNCH_KAUFMAN_ALPHA: f64 = 0.640_388_203_202_208_4;

/// Where the largest other entry of a row and column is, and its size; `size` is that of an entry on the diagonal or
/// below it.
#[inline(always)]
pub(super) fn largest(of: usize, among: Range<usize>, size: impl Fn(usize, usize) -> f64) -> (usize, f64) {
    let mut best = (of, 0.0);
    for k in among {
        let size = size(k.max(of), k.min(of));
        if k != of && size > best.1 {
            best = (k, size);
        }
    }
    best
}

/// A column, or two in ascending order, as the next pivot: no entry of a real L becomes larger than 1/(1 − α) = 2.8.
///
/// `found` is what [`largest`] gives for the first.
#[inline(always)]
pub(super) fn rook(
    among: Range<usize>,
    found: (usize, f64),
    size: impl Fn(usize, usize) -> f64 + Copy,
) -> (usize, Option<usize>) {
    let (mut at, (mut next, mut most)) = (among.start, found);
    if next == at || size(at, at) >= BUNCH_KAUFMAN_ALPHA * most {
        return (at, None);
    }
    loop {
        let (after, across) = largest(next, among.clone(), size);
        if size(next, next) >= BUNCH_KAUFMAN_ALPHA * across {
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
    use super::{BUNCH_KAUFMAN_ALPHA, largest, rook};
    use proptest::prelude::*;

    /// What a rook finds in a symmetric matrix, row after row.
    fn chosen(matrix: &[f64], n: usize) -> (usize, Option<usize>) {
        let size = |i: usize, j: usize| matrix[i * n + j].abs();
        rook(0..n, largest(0, 0..n, size), size)
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
            let bound = (1.0 + 1e-12) / (1.0 - BUNCH_KAUFMAN_ALPHA);
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
