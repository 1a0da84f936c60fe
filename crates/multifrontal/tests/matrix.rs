//! Input: entries in any order, compressed columns, sparse matrices of other crates.

use crate::common;

use common::{noise, solid};
use multifrontal::{MatrixError, Options, Solver, Symbolic, SymmetricMatrix, Triangle, c64};

/// Entries of a small solid's lower triangle, and the same of both triangles without order.
fn entries() -> (SymmetricMatrix<c64>, Vec<(usize, usize, c64)>) {
    let solid = solid(3, c64::new, 4);
    let lower =
        SymmetricMatrix::from_csc(solid.dim, Triangle::Lower, &solid.col_ptr, &solid.row_idx, &solid.values)
            .unwrap();
    let columns =
        solid.col_ptr.windows(2).enumerate().flat_map(|(col, at)| (at[0]..at[1]).map(move |k| (col, k)));
    let mut both = Vec::new();
    for (col, k) in columns {
        let (row, value) = (solid.row_idx[k], solid.values[k]);
        both.push((row, col, value));
        if row != col {
            both.push((col, row, value));
        }
    }
    let mut noise = noise(9);
    let mut keyed: Vec<_> = both.into_iter().map(|entry| (noise(), entry)).collect();
    keyed.sort_by(|a, b| a.0.total_cmp(&b.0));
    (lower, keyed.into_iter().map(|(_, entry)| entry).collect())
}

#[test]
fn every_way_in_gives_the_same_matrix() {
    let (lower, both) = entries();
    for triangle in [Triangle::Lower, Triangle::Upper, Triangle::Both] {
        let found = SymmetricMatrix::from_triplets(lower.dim(), triangle, both.iter().copied()).unwrap();
        assert_eq!(found, lower, "{triangle:?}");
    }
    // What is not read may be anything.
    let torn =
        both.iter().map(|&(row, col, value)| (row, col, if row < col { c64::new(7.0, 0.0) } else { value }));
    assert_eq!(SymmetricMatrix::from_triplets(lower.dim(), Triangle::Lower, torn).unwrap(), lower);
    // What comes in pieces is added up.
    let pieces = both.iter().flat_map(|&(row, col, value)| [(row, col, 0.5 * value); 2]);
    assert_eq!(SymmetricMatrix::from_triplets(lower.dim(), Triangle::Both, pieces).unwrap(), lower);
}

#[test]
fn values_change_and_the_pattern_stays() {
    let (mut matrix, _) = entries();
    let symbolic = Symbolic::of(&matrix, &Options::default()).unwrap();
    matrix.values_mut().iter_mut().for_each(|value| *value *= 2.0);
    let mut x = vec![c64::new(1.0, 0.0); matrix.dim()];
    let solver = Solver::new(&symbolic, matrix.values(), &Options::default()).unwrap();
    assert!(solver.solve(&mut x).unwrap().backward_error < 1e-15);
    let places = (matrix.col_ptr(), matrix.row_idx());
    assert_eq!((places.0.len(), places.0[matrix.dim()]), (matrix.dim() + 1, places.1.len()));
}

#[test]
fn what_is_no_symmetric_matrix_is_refused() {
    let csc = |columns: &[usize], rows: &[usize], values: &[f64]| {
        SymmetricMatrix::from_csc(2, Triangle::Both, columns, rows, values).unwrap_err()
    };
    assert_eq!(csc(&[0, 1], &[0], &[1.0]), MatrixError::Columns);
    assert_eq!(csc(&[0, 2, 1], &[0], &[1.0]), MatrixError::Columns);
    assert_eq!(csc(&[0, 1, 1], &[0], &[]), MatrixError::Values { expected: 1, found: 0 });
    assert_eq!(csc(&[0, 1, 2], &[0, 2], &[1.0; 2]), MatrixError::Outside { row: 2, col: 1 });
    assert_eq!(csc(&[0, 1, 2], &[1, 1], &[1.0; 2]), MatrixError::Unsymmetric { row: 1, col: 0 });
    assert_eq!(csc(&[0, 1, 2], &[0, 0], &[1.0; 2]), MatrixError::Unsymmetric { row: 1, col: 0 });
    let huge = SymmetricMatrix::from_csc(usize::MAX, Triangle::Lower, &[], &[], &[1.0; 0]);
    assert_eq!(huge.unwrap_err(), MatrixError::Columns);
    // Sums in another order differ by roundoff. A place that only one triangle has must hold a zero.
    let rounded = [(0, 0, 3.0), (1, 0, 0.1 + 0.2), (0, 1, 0.3), (2, 1, 0.0), (2, 2, 1.0)];
    let matrix = SymmetricMatrix::from_triplets(3, Triangle::Both, rounded).unwrap();
    assert_eq!((matrix.row_idx(), matrix.values()), (&[0, 1, 2, 2][..], &[3.0, 0.1 + 0.2, 0.0, 1.0][..]));
    // What is not finite has no mirror image to compare with; the factorisation names it.
    let broken = [(0, 0, 1.0), (1, 0, f64::NAN), (0, 1, f64::NAN), (1, 1, 1.0)];
    assert!(SymmetricMatrix::from_triplets(2, Triangle::Both, broken).is_ok());
    assert_eq!(SymmetricMatrix::<f64>::from_triplets(0, Triangle::Both, []).unwrap().dim(), 0);
}

#[cfg(feature = "faer")]
#[test]
fn matrices_of_faer() {
    use faer::sparse::{SparseColMat, SymbolicSparseColMat, Triplet};

    let (lower, both) = entries();
    let triplets: Vec<_> =
        both.iter().map(|&(row, col, value)| Triplet::new(row as u32, col as u32, value)).collect();
    let sparse =
        SparseColMat::<u32, c64>::try_new_from_triplets(lower.dim(), lower.dim(), &triplets).unwrap();
    for triangle in [Triangle::Lower, Triangle::Upper, Triangle::Both] {
        assert_eq!(SymmetricMatrix::from_faer(sparse.as_ref(), triangle).unwrap(), lower, "{triangle:?}");
    }
    // Columns with room behind their entries, and rows that do not ascend.
    let symbolic = SymbolicSparseColMat::<usize>::new_unsorted_checked(
        2,
        2,
        vec![0, 3, 5],
        Some(vec![2, 1]),
        vec![1, 0, 0, 1, 0],
    );
    let loose = SparseColMat::new(symbolic, vec![2.0, 1.0, 99.0, 3.0, 99.0]);
    let found = SymmetricMatrix::from_faer(loose.as_ref(), Triangle::Lower).unwrap();
    assert_eq!((found.row_idx(), found.values()), (&[0, 1, 1][..], &[1.0, 2.0, 3.0][..]));
    let wide = SparseColMat::<usize, f64>::try_new_from_triplets(2, 3, &[]).unwrap();
    let error = SymmetricMatrix::from_faer(wide.as_ref(), Triangle::Lower).unwrap_err();
    assert_eq!(error, MatrixError::Shape { rows: 2, cols: 3 });
}

#[cfg(feature = "sprs")]
#[test]
fn matrices_of_sprs() {
    let (lower, both) = entries();
    let mut triplets = sprs::TriMatI::<c64, u32>::new((lower.dim(), lower.dim()));
    both.iter().for_each(|&(row, col, value)| triplets.add_triplet(row, col, value));
    let (by_columns, by_rows) = (triplets.to_csc::<u32>(), triplets.to_csr::<usize>());
    for triangle in [Triangle::Lower, Triangle::Upper, Triangle::Both] {
        assert_eq!(SymmetricMatrix::from_sprs(by_columns.view(), triangle).unwrap(), lower, "{triangle:?}");
        assert_eq!(SymmetricMatrix::from_sprs(by_rows.view(), triangle).unwrap(), lower, "{triangle:?}");
    }
    // One triangle alone, whose rows are the columns of the other.
    let mut triplets = sprs::TriMat::new((2, 2));
    for (row, col, value) in [(0, 0, 1.0), (1, 0, 2.0), (1, 1, 3.0)] {
        triplets.add_triplet(row, col, value);
    }
    for sparse in [triplets.to_csr::<usize>(), triplets.to_csc()] {
        let found = SymmetricMatrix::from_sprs(sparse.view(), Triangle::Lower).unwrap();
        assert_eq!(found.values(), [1.0, 2.0, 3.0]);
        let upper = SymmetricMatrix::from_sprs(sparse.transpose_view(), Triangle::Upper).unwrap();
        assert_eq!(found, upper);
    }
    // A part of a matrix, whose places do not begin with 0.
    let whole: sprs::CsMat<f64> = sprs::CsMat::eye(4);
    let whole = whole.view();
    let part = whole.slice_outer(2..4);
    let error = SymmetricMatrix::from_sprs(part, Triangle::Lower).unwrap_err();
    assert_eq!(error, MatrixError::Shape { rows: 2, cols: 4 });
}
