//! The factors of MUMPS are those of this process.

use crate::launched::{lossy, mumps, square};
use frfit_linalg::c64;
use frfit_linalg::solve::{Analysis, Breakdown, Engine};

/// max |a − b| / max |a|.
fn largest_difference<T: Into<c64> + Copy>(a: &[T], b: &[T]) -> f64 {
    let largest =
        |values: &mut dyn Iterator<Item = c64>| values.map(|value| value.norm()).fold(0.0, f64::max);
    let differences = &mut a.iter().zip(b).map(|(&a, &b)| a.into() - b.into());
    largest(differences) / largest(&mut a.iter().map(|&a| a.into()))
}

#[test]
#[ignore = "needs MUMPS"]
fn every_number_of_ranks_gives_our_solutions_and_our_inertia_needs_mumps() {
    let matrix = square(40, 1.3);
    let (real, complex) = (matrix.real_values().unwrap(), lossy(&matrix));
    let ours = Analysis::new(matrix.pattern());
    let rhs: Vec<f64> = (0..3 * 1600).map(|k| f64::from(k % 11) - 5.0).collect();
    let complex_rhs: Vec<c64> = rhs.iter().map(|&value| c64::new(value, 1.0)).collect();
    let expected = ours.factor(real).unwrap();
    let mut x = rhs.clone();
    expected.solve(&mut x).unwrap();
    let mut z = complex_rhs.clone();
    ours.factor(&complex).unwrap().solve(&mut z).unwrap();
    for ranks in 1..=3 {
        let mumps = mumps(ranks);
        assert_eq!(mumps.ranks(), ranks);
        let theirs = mumps.analyse(matrix.pattern());
        assert!(theirs.factor_memory::<f64>().is_ok());
        let (factor, lossy) = (theirs.factor(real).unwrap(), theirs.factor(&complex).unwrap());
        assert_eq!(factor.negative_eigenvalues(), expected.negative_eigenvalues());
        let mut found = rhs.clone();
        factor.solve(&mut found).unwrap();
        assert!(largest_difference(&x, &found) < 1e-11);
        let mut found = complex_rhs.clone();
        lossy.solve(&mut found).unwrap();
        assert!(largest_difference(&z, &found) < 1e-11);
        assert_eq!(mumps.usage().unwrap().len(), ranks);
    }
}

#[test]
#[ignore = "needs MUMPS"]
fn several_patterns_and_factors_live_side_by_side_needs_mumps() {
    let mumps = mumps(2);
    let (small, large) = (square(10, 0.3), square(20, 0.7));
    let analyses = [mumps.analyse(small.pattern()), mumps.analyse(large.pattern())];
    let factors: Vec<_> = [&small, &large, &small]
        .iter()
        .zip([0, 1, 0])
        .map(|(matrix, k)| analyses[k].factor(matrix.real_values().unwrap()).unwrap())
        .collect();
    drop(analyses); // the factors keep what they need
    for (factor, matrix) in factors.iter().zip([&small, &large, &small]).rev() {
        let mut x = vec![1.0; matrix.dim()];
        factor.solve(&mut x).unwrap();
        let mut ours = vec![1.0; matrix.dim()];
        Analysis::new(matrix.pattern())
            .factor(matrix.real_values().unwrap())
            .unwrap()
            .solve(&mut ours)
            .unwrap();
        assert!(largest_difference(&ours, &x) < 1e-11);
    }
}

#[test]
#[ignore = "needs MUMPS"]
fn a_singular_matrix_is_one_and_the_ranks_go_on_needs_mumps() {
    let mumps = mumps(2);
    let matrix = square(10, 0.0);
    let analysis = mumps.analyse(matrix.pattern());
    let singular = analysis.factor(&vec![0.0; matrix.pattern().stored()]);
    assert!(matches!(singular, Err(Breakdown::Singular { .. })), "{singular:?}");
    assert!(analysis.factor(matrix.real_values().unwrap()).is_ok());
}

#[test]
#[ignore = "needs MUMPS"]
fn factors_on_disk_give_the_same_needs_mumps() {
    let folder = std::env::temp_dir();
    let mut launch = crate::launched::launch(2);
    launch.out_of_core = Some(folder);
    let mumps = frfit_engine::Mumps::start(&launch).unwrap();
    let matrix = square(40, 1.3);
    let factor = mumps.analyse(matrix.pattern()).factor(matrix.real_values().unwrap()).unwrap();
    let mut x = vec![1.0; matrix.dim()];
    let report = factor.solve(&mut x).unwrap();
    assert!(report.backward_error < 1e-14);
}
