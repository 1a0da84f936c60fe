//! What breaks factorisations: singular, badly scaled and constrained matrices, numbers that are none.

use crate::common;

use common::{Lower, noise, solid};
use multifrontal::{
    FactorError, Inertia, Options, Ordering, PatternError, Precision, Solver, Symbolic, Threads, c64,
};
use proptest::prelude::*;

/// A factor in single precision, where that is enough.
fn single() -> Options {
    Options::default().with_precision(Precision::Single)
}

#[test]
fn rows_come_in_any_order() {
    // [4 1 0; 1 0 2; 0 2 5].
    let (columns, rows, values) = ([0, 2, 4, 5], [1, 0, 2, 1, 2], [1.0, 4.0, 2.0, 0.0, 5.0]);
    for ordering in [Ordering::Automatic, Ordering::NestedDissection, Ordering::Given(vec![2, 0, 1])] {
        let options = Options::default().with_ordering(ordering);
        let symbolic = Symbolic::new(3, &columns, &rows, &options).unwrap();
        let mut x = [6.0, 7.0, 19.0];
        let solver = Solver::new(&symbolic, &values, &options).unwrap();
        assert!(solver.solve(&mut x).unwrap().backward_error < 1e-15);
        assert!(
            x.iter().zip([1.0, 2.0, 3.0]).all(|(x, exact): (&f64, f64)| (x - exact).abs() < 1e-14),
            "{x:?}"
        );
    }
}

/// Beyond one half a matrix may have no pivot at all, and is not singular for that.
#[test]
fn thresholds_out_of_range_are_the_nearest_in_it() {
    let matrix = Lower::new(2, [(0, 0, 1.0), (1, 0, 2.0), (1, 1, 1.0)]);
    let symbolic = matrix.symbolic(&Ordering::default());
    for threshold in [-1.0, 0.0, 0.5, 7.0, f64::INFINITY, f64::NAN] {
        let factor = symbolic.factor(&matrix.values, &Options::default().with_threshold(threshold));
        assert_eq!(signs(factor.unwrap().inertia()), (1, 1), "{threshold}");
    }
}

/// Positive and negative eigenvalues.
fn signs(inertia: Inertia) -> (usize, usize) {
    (inertia.positive, inertia.negative)
}

fn factor(matrix: &Lower<f64>) -> Result<multifrontal::Factor<f64>, FactorError> {
    matrix.symbolic(&Ordering::default()).factor(&matrix.values, &Options::default())
}

/// A chain of unit springs between n unit masses, fixed at its beginning or free: ω² = 4 sin² of known angles.
fn chain(n: usize, fixed: bool, shift: f64) -> Lower<f64> {
    let springs = (1..n).flat_map(|i| [(i - 1, i - 1, 1.0), (i, i, 1.0), (i, i - 1, -1.0)]);
    let ground = fixed.then_some((0, 0, 1.0));
    Lower::new(n, springs.chain(ground).chain((0..n).map(|i| (i, i, -shift))).collect::<Vec<_>>())
}

#[test]
fn sylvester_counts_the_modes_of_a_chain_under_a_shift() {
    let n = 300;
    let angle = |k: usize| (2 * k + 1) as f64 * std::f64::consts::PI / (4 * n + 2) as f64;
    let square = |k: usize| 4.0 * angle(k).sin().powi(2);
    for modes in [0, 1, 2, 150, 299, 300] {
        let shift = match modes {
            0 => 0.5 * square(0),
            300 => 4.1,
            _ => 0.5 * (square(modes - 1) + square(modes)),
        };
        let inertia = factor(&chain(n, true, shift)).unwrap().inertia();
        assert_eq!(signs(inertia), (n - modes, modes));
    }
}

#[test]
fn a_free_chain_is_singular_and_says_so() {
    // Every number is an integer: the last pivot is exactly 0.
    let error = factor(&chain(100, false, 0.0)).unwrap_err();
    assert!(matches!(error, FactorError::Singular { deficiency: 1, row } if row < 100), "{error}");
}

#[test]
fn rows_of_zeros_are_named() {
    let matrix =
        Lower::new(4, [(0, 0, 1.0), (1, 1, 0.0), (2, 2, 3.0), (3, 2, 1.0), (3, 3, 0.0), (1, 0, 0.0)]);
    assert_eq!(factor(&matrix).unwrap_err(), FactorError::Singular { row: 1, deficiency: 1 });
}

#[test]
fn what_is_no_number_is_named() {
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let mut matrix = chain(10, true, 0.0);
        let k = matrix.col_ptr[3] + 1;
        matrix.values[k] = bad;
        assert_eq!(factor(&matrix).unwrap_err(), FactorError::NotFinite { row: 4, col: 3 });
    }
    let symbolic = chain(10, true, 0.0).symbolic(&Ordering::default());
    let error = symbolic.factor(&[1.0; 3], &Options::default()).unwrap_err();
    assert_eq!(error, FactorError::Values { expected: 19, found: 3 });
}

#[test]
fn patterns_are_checked() {
    let new =
        |dim, columns: &[usize], rows: &[usize]| Symbolic::new(dim, columns, rows, &Options::default()).err();
    assert_eq!(new(2, &[0, 1], &[0]), Some(PatternError::Columns));
    assert_eq!(new(2, &[0, 2, 1], &[0]), Some(PatternError::Columns));
    assert_eq!(new(2, &[0, 1, 2], &[0, 0]), Some(PatternError::Row { col: 1, row: 0 }));
    assert_eq!(new(2, &[0, 1, 2], &[0, 2]), Some(PatternError::Row { col: 1, row: 2 }));
    // What comes twice made minimum degree panic.
    assert_eq!(new(3, &[0, 3, 4, 5], &[2, 0, 2, 1, 2]), Some(PatternError::Repeated { col: 0, row: 2 }));
    let order = Options::default().with_ordering(Ordering::Given(vec![0, 0]));
    assert_eq!(Symbolic::new(2, &[0, 1, 2], &[0, 1], &order).err(), Some(PatternError::Permutation(0)));
    let nothing = Symbolic::new(0, &[0], &[], &Options::default()).unwrap();
    nothing.factor::<f64>(&[], &Options::default()).unwrap().solve_in_place(&mut [], Threads::One);
}

#[test]
fn steel_and_foam() {
    // Springs of 1 and of 1e-12 in turn, grounded at one end: everything moves by what the soft springs give.
    let n = 20;
    let springs = (1..n).flat_map(|i| {
        let k = if i % 2 == 0 { 1.0 } else { 1e-12 };
        [(i - 1, i - 1, k), (i, i, k), (i, i - 1, -k)]
    });
    let matrix = Lower::new(n, springs.chain([(0, 0, 1.0)]).collect::<Vec<_>>());
    let mut x = vec![0.0; n];
    x[n - 1] = 1e-12;
    factor(&matrix).unwrap().solve_in_place(&mut x, Threads::One);
    // A diagonal of 1 + 1e-12 has lost all but four of the soft spring's digits before anything is computed: as
    // if each of ten nodes stood on a spring of 1e-16, with (1 + 4 + … + 100)/10 · 1e-4 of the answer in all.
    let exact = (n / 2) as f64;
    assert!((x[n - 1] / exact - 1.0).abs() < 1e-2, "{}", x[n - 1]);
}

#[test]
fn a_vanishing_imaginary_part_survives_three_products_for_one() {
    // At a resonance of the undamped matrix the response is that of the loss factor alone.
    let n = 300;
    let square = 4.0 * (std::f64::consts::PI / (4 * n + 2) as f64).sin().powi(2);
    for loss in [1e-2, 1e-5, 1e-8] {
        let real = chain(n, true, 0.0);
        let shifted = chain(n, true, square);
        let values: Vec<c64> =
            real.values.iter().zip(&shifted.values).map(|(&k, &d)| c64::new(d, loss * k)).collect();
        let symbolic = real.symbolic(&Ordering::default());
        let solver = Solver::new(&symbolic, &values, &Options::default()).unwrap();
        let mode: Vec<f64> =
            (1..=n).map(|i| (i as f64 * std::f64::consts::PI / (2 * n + 1) as f64).sin()).collect();
        let mut x: Vec<c64> = mode.iter().map(|&phi| c64::new(phi, 0.0)).collect();
        let solution = solver.solve(&mut x).unwrap();
        assert!(solution.backward_error < 1e-15, "{solution:?}");
        // x = φ / (i η ω²); the matrix is known to 1e-16 of its entries, against a loss of η ω².
        let exact = c64::new(0.0, -1.0 / (loss * square));
        let error =
            x.iter().zip(&mode).map(|(x, phi)| (x - exact * phi).norm()).fold(0.0, f64::max) / exact.norm();
        assert!(error < 1e-15 / (loss * square), "{loss}: {error:e}");
    }
}

#[test]
fn single_precision_is_refined_or_given_up() {
    let matrix = solid(6, c64::new, 3);
    let symbolic = matrix.symbolic(&Ordering::default());
    let mut noise = noise(5);
    let b: Vec<c64> = (0..2 * matrix.dim).map(|_| c64::new(noise(), noise())).collect();
    let solver = Solver::new(&symbolic, &matrix.values, &single()).unwrap();
    let mut x = b.clone();
    let solution = solver.solve(&mut x).unwrap();
    assert!(solution.precision == Precision::Single && solution.refinements >= 1, "{solution:?}");
    for (x, b) in x.chunks(matrix.dim).zip(b.chunks(matrix.dim)) {
        assert!(matrix.backward_error(x, b) < 1e-15);
    }
    // Condition 1e10: single precision has no digit right, and full precision does it.
    let soft = chain(300, true, 4.0 * (std::f64::consts::PI / 1202.0f64).sin().powi(2) * (1.0 - 1e-6));
    let symbolic = soft.symbolic(&Ordering::default());
    let solver = Solver::new(&symbolic, &soft.values, &single()).unwrap();
    let mut x = vec![1.0; 300];
    let solution = solver.solve(&mut x).unwrap();
    assert!(solution.precision == Precision::Full && solution.backward_error < 1e-15, "{solution:?}");
    assert!(solver.condition().unwrap() > 1e9);
}

#[test]
fn the_condition_of_a_diagonal_is_its_range() {
    let matrix = Lower::new(50, (0..50).map(|i| (i, i, c64::new(0.0, 2.0f64.powi(i as i32)))));
    let symbolic = matrix.symbolic(&Ordering::default());
    let solver = Solver::new(&symbolic, &matrix.values, &Options::default()).unwrap();
    assert_eq!(solver.condition().unwrap(), 2.0f64.powi(49));
}

#[test]
fn a_load_at_one_row_gives_what_a_full_one_does() {
    let matrix = solid(7, c64::new, 3);
    let factor = matrix.symbolic(&Ordering::default()).factor(&matrix.values, &Options::default()).unwrap();
    for row in [0, 17, matrix.dim - 1] {
        let mut b = vec![c64::default(); matrix.dim];
        b[row] = c64::new(1.0, 0.0);
        let mut x = b.clone();
        factor.solve_in_place(&mut x, Threads::One);
        assert!(matrix.backward_error(&x, &b) < 1e-13);
    }
}

/// L D Lᵀ of integers with known pivots, its rows in any order: inertia and singularity are known.
fn known(n: usize, pivots: &[i8], couplings: &[(usize, usize, i8)], seed: u64) -> Lower<f64> {
    let mut l = vec![vec![0i64; n]; n];
    for (i, row) in l.iter_mut().enumerate() {
        row[i] = 1;
    }
    for &(i, j, value) in couplings {
        let (i, j) = (i % n, j % n);
        if i != j {
            l[i.max(j)][i.min(j)] = i64::from(value % 2);
        }
    }
    let mut noise = noise(seed);
    let mut place: Vec<(u64, usize)> = (0..n).map(|i| ((noise().abs() * 1e9) as u64, i)).collect();
    place.sort_unstable();
    let entry = |i: usize, j: usize| (0..n).map(|k| l[i][k] * i64::from(pivots[k]) * l[j][k]).sum::<i64>();
    let pairs =
        (0..n).flat_map(|i| (0..=i).map(move |j| (i, j))).filter(|&(i, j)| i == j || entry(i, j) != 0);
    Lower::new(n, pairs.map(|(i, j)| (place[i].1, place[j].1, entry(i, j) as f64)).collect::<Vec<_>>())
}

proptest! {
    /// Planted zero pivots make it singular; without them the signs are those that were planted.
    #[test]
    fn inertia_is_that_of_the_planted_pivots(
        pivots in prop::collection::vec(-3i8..=3, 1..40),
        couplings in prop::collection::vec((0usize..40, 0usize..40, any::<i8>()), 0..80),
        seed in any::<u64>(),
    ) {
        let n = pivots.len();
        let regular: Vec<i8> = pivots.iter().map(|&pivot| if pivot == 0 { 1 } else { pivot }).collect();
        let negative = regular.iter().filter(|&&pivot| pivot < 0).count();
        let inertia = factor(&known(n, &regular, &couplings, seed)).unwrap().inertia();
        prop_assert_eq!(signs(inertia), (n - negative, negative));
        // Roundoff may leave something of a zero; then it shows in the condition.
        let zeros = pivots.iter().filter(|&&pivot| pivot == 0).count();
        let matrix = known(n, &pivots, &couplings, seed);
        let symbolic = matrix.symbolic(&Ordering::default());
        match Solver::new(&symbolic, &matrix.values, &Options::default()) {
            Err(FactorError::Singular { deficiency, .. }) => prop_assert!((1..=zeros).contains(&deficiency)),
            Ok(solver) if zeros > 0 => {
                let condition = solver.condition().unwrap();
                prop_assert!(condition > 1e13 || condition.is_nan(), "{condition:e}");
            }
            Ok(_) => {}
            Err(other) => prop_assert!(false, "{other}"),
        }
    }

    /// Lagrange multipliers: as many zeros on the diagonal as constraints, and as many negative pivots.
    #[test]
    fn constraints_add_one_negative_pivot_each(
        n in 20usize..150,
        constraints in 1usize..10,
        couplings in prop::collection::vec((0usize..150, 0usize..150, -1.0f64..1.0), 0..400),
        loss in 0.0f64..0.2,
    ) {
        let mut diagonal = vec![1.0; n];
        let mut entries = Vec::new();
        for (i, j, value) in couplings.into_iter().map(|(i, j, value)| (i % n, j % n, value)).filter(|(i, j, _)| i != j) {
            diagonal[i] += value.abs();
            diagonal[j] += value.abs();
            entries.push((i, j, value));
        }
        entries.extend(diagonal.into_iter().enumerate().map(|(i, value)| (i, i, value)));
        let ties: Vec<_> = (0..constraints).flat_map(|c| [(n + c, 2 * c, 1.0), (n + c, 2 * c + 1, -1.0)]).collect();
        let matrix = Lower::new(n + constraints, entries.iter().chain(&ties).copied().collect::<Vec<_>>());
        prop_assert_eq!(signs(factor(&matrix).unwrap().inertia()), (n, constraints));
        let stiff = entries.iter().map(|&(i, j, value)| (i, j, c64::new(value, loss * value)));
        let tied = ties.iter().map(|&(i, j, value)| (i, j, c64::new(value, 0.0)));
        let matrix = Lower::new(n + constraints, stiff.chain(tied).collect::<Vec<_>>());
        let symbolic = matrix.symbolic(&Ordering::default());
        let solver = Solver::new(&symbolic, &matrix.values, &Options::default()).unwrap();
        let mut x = vec![c64::new(1.0, 1.0); n + constraints];
        let solution = solver.solve(&mut x).unwrap();
        prop_assert!(solution.backward_error < 1e-15, "{solution:?}");
        for c in 0..constraints {
            // x₂c − x₂c₊₁ = 1 + i, as the right-hand side says.
            let gap = x[2 * c] - x[2 * c + 1] - c64::new(1.0, 1.0);
            prop_assert!(gap.norm() < 1e-12 * (1.0 + x[2 * c].norm()), "{gap}");
        }
    }
}

#[test]
fn a_solution_that_is_no_number_is_none() {
    let matrix = chain(20, true, 0.0);
    let symbolic = matrix.symbolic(&Ordering::default());
    for precision in [Precision::Full, Precision::Single] {
        let solver =
            Solver::new(&symbolic, &matrix.values, &Options::default().with_precision(precision)).unwrap();
        for bad in [f64::NAN, f64::INFINITY, 1e308] {
            let mut x = vec![1.0; 40];
            x[33] = bad;
            assert_eq!(solver.solve(&mut x), Err(FactorError::NoSolution { column: 1 }));
        }
    }
}
