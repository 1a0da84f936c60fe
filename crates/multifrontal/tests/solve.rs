//! Solutions of random matrices against their residuals, in every precision and with any number of threads.

use crate::common;

use common::{Lower, in_pool, noise, solid};
use multifrontal::{Options, Ordering, Scalar, Threads, c64};
use proptest::prelude::*;
use std::time::Duration;

/// Roundoff, and the growth that pivots a hundred times smaller than their neighbours allow; 1e-14 was seen.
const GROWN: f64 = 1e-12;

fn check<T: Scalar>(matrix: &Lower<T>, columns: usize, tolerance: f64, value: impl Fn(f64, f64) -> T) {
    let orderings = [
        ("automatic", Ordering::Automatic),
        ("minimum degree", Ordering::MinimumDegree),
        ("nested dissection", Ordering::NestedDissection),
        ("backwards", Ordering::Given((0..matrix.dim).rev().collect())),
    ];
    for (name, ordering) in orderings {
        let symbolic = matrix.symbolic(&ordering);
        let factor = symbolic.factor(&matrix.values, &Options::default()).unwrap();
        let mut noise = noise(7);
        let b: Vec<T> = (0..matrix.dim * columns).map(|_| value(noise(), noise())).collect();
        let mut x = b.clone();
        factor.solve_in_place(&mut x, Threads::One);
        for (x, b) in x.chunks(matrix.dim).zip(b.chunks(matrix.dim)) {
            let error = matrix.backward_error(x, b);
            assert!(error <= tolerance, "{name}: {error:e}");
        }
        // Threads change nothing, whether they stay awake or not.
        for threads in [Threads::Pool, Threads::Spinning(Duration::from_millis(1))] {
            let options = Options::default().with_threads(threads);
            let again = in_pool(3, || symbolic.factor(&matrix.values, &options)).unwrap();
            let mut y = b.clone();
            in_pool(2, || again.solve_in_place(&mut y, threads));
            assert_eq!(x, y, "{name}");
        }
    }
}

#[test]
fn real_solids() {
    for n in [1, 2, 3, 5, 8] {
        check(&solid(n, |re, _| re, 1), 3, GROWN, |re, _| re);
    }
}

#[test]
fn complex_solids() {
    for n in [1, 2, 3, 5, 8] {
        check(&solid(n, c64::new, 1), 9, GROWN, c64::new);
    }
}

/// One right-hand side is solved with in its own way, and a matrix without zeros is a single front.
#[test]
fn one_right_hand_side_and_one_front() {
    check(&solid(8, |re, _| re, 1), 1, GROWN, |re, _| re);
    check(&solid(8, c64::new, 1), 1, GROWN, c64::new);
    let mut noise = noise(3);
    let dense: Vec<_> = (0..400).flat_map(|j| (j..400).map(move |i| (i, j))).collect();
    let dense = dense.into_iter().map(|(i, j)| (i, j, c64::new(noise(), noise())));
    check(&Lower::new(400, dense.collect::<Vec<_>>()), 1, GROWN, c64::new);
}

#[test]
fn single_precision_solids() {
    check(&solid(5, |re, _| re as f32, 1), 4, 1e-5, |re, _| re as f32);
    check(&solid(5, |re, im| num_complex::Complex32::new(re as f32, im as f32), 1), 4, 1e-5, |re, im| {
        num_complex::Complex32::new(re as f32, im as f32)
    });
}

/// Candidates that are delayed move what their new front has of its children already, whoever put it there; and the factor
/// is large enough for threads to share its solutions.
#[test]
fn delayed_candidates_with_any_number_of_threads() {
    // Next to nothing on the diagonal.
    let matrix = solid(11, |re, im| if re > 2.0 { c64::new(1e-3 * im, 0.0) } else { c64::new(re, im) }, 5);
    let symbolic = matrix.symbolic(&Ordering::NestedDissection);
    let mut noise = noise(2);
    let b: Vec<c64> = (0..9 * matrix.dim).map(|_| c64::new(noise(), noise())).collect();
    let solve = |threads: Threads| {
        // As strict as can be, so that many are delayed.
        let options = Options::default().with_threads(threads).with_threshold(0.5);
        let factor = symbolic.factor(&matrix.values, &options).unwrap();
        assert!(factor.delayed() > 50, "{}", factor.delayed());
        let mut x = b.clone();
        factor.solve_in_place(&mut x, threads);
        x
    };
    let alone = solve(Threads::One);
    for (x, b) in alone.chunks(matrix.dim).zip(b.chunks(matrix.dim)) {
        assert!(matrix.backward_error(x, b) <= GROWN);
    }
    for threads in 2..5 {
        assert_eq!(alone, in_pool(threads, || solve(Threads::Pool)), "{threads} threads");
    }
}

proptest! {
    /// Saddle points and zeros on the diagonal: only delayed pivots and blocks of two get through.
    #[test]
    fn indefinite_with_zero_diagonals(
        dim in 1usize..120,
        couplings in prop::collection::vec((0usize..120, 0usize..120, -1.0f64..1.0), 0..600),
        zeros in prop::collection::vec(any::<bool>(), 120),
        seed in 0u64..1000,
    ) {
        let mut noise = noise(seed);
        let entries = couplings.iter().map(|&(i, j, value)| (i % dim, j % dim, value)).filter(|(i, j, _)| i != j);
        let diagonal = (0..dim).map(|i| (i, i, if zeros[i] { 0.0 } else { noise() }));
        let matrix = Lower::new(dim, entries.chain(diagonal).collect::<Vec<_>>());
        let b: Vec<f64> = (0..dim).map(|_| noise()).collect();
        for ordering in [Ordering::Automatic, Ordering::Given((0..dim).collect())] {
            let Ok(factor) = matrix.symbolic(&ordering).factor(&matrix.values, &Options::default()) else { continue };
            prop_assert_eq!(factor.inertia().positive + factor.inertia().negative, dim);
            let mut x = b.clone();
            factor.solve_in_place(&mut x, Threads::One);
            if x.iter().all(|x| x.is_finite()) {
                // L is bounded by 100 an entry, so that a growth of some hundreds is possible and was seen.
                prop_assert!(matrix.backward_error(&x, &b) < 1e-11, "{:e}", matrix.backward_error(&x, &b));
            }
        }
    }
}
