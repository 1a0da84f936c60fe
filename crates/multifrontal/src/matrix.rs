//! Symmetric matrices from what there is: entries in any order, compressed columns, sparse matrices of other crates.

use crate::scalar::{Real, Scalar};
use crate::{Options, PatternError, Symbolic};
use std::fmt;

/// Two entries that mirror each other may differ by so many units of roundoff of the largest entry in their rows: sums
/// of elements in another order do.
const SYMMETRY_ROUNDOFFS: f64 = 64.0;

/// Which entries of what is given are the matrix.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Triangle {
    /// Those on the diagonal and below it; others are not read.
    Lower,
    /// Those on the diagonal and above it; others are not read.
    Upper,
    /// All: each entry off the diagonal has its mirror image, equal but for roundoff. The lower one is taken.
    Both,
}

/// The lower triangle of a symmetric matrix, by columns: rows ascend in each, and none comes twice.
///
/// Zeros that are given are kept: matrices with entries at the same places have the same pattern, whatever their values.
/// So one [`Symbolic`] serves them all.
///
/// ```
/// use multifrontal::{Options, Symbolic, SymmetricMatrix, Triangle};
///
/// // [4 1 0; 1 0 2; 0 2 5], and 2 is made of two contributions.
/// let entries = [(0, 0, 4.0), (1, 0, 1.0), (2, 1, 1.5), (2, 1, 0.5), (2, 2, 5.0)];
/// let matrix = SymmetricMatrix::from_triplets(3, Triangle::Lower, entries)?;
/// assert_eq!(matrix.values(), [4.0, 1.0, 2.0, 5.0]);
/// let symbolic = Symbolic::of(&matrix, &Options::default())?;
/// let factor = symbolic.factor(matrix.values(), &Options::default())?;
/// # assert_eq!(factor.dim(), 3);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct SymmetricMatrix<T> {
    col_ptr: Vec<usize>,
    row_idx: Vec<usize>,
    values: Vec<T>,
}

/// Why something is no symmetric matrix.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub enum MatrixError {
    /// It is not square.
    Shape {
        /// Its rows.
        rows: usize,
        /// Its columns.
        cols: usize,
    },
    /// `col_ptr` must have n + 1 entries that begin with 0, do not descend, and end with the number of rows given.
    Columns,
    /// Not one value for each row given.
    Values {
        /// Rows given.
        expected: usize,
        /// Values given.
        found: usize,
    },
    /// An entry outside of the matrix.
    Outside {
        /// Its row.
        row: usize,
        /// Its column.
        col: usize,
    },
    /// An entry differs from its mirror image by more than roundoff, or has none.
    Unsymmetric {
        /// The row below the diagonal.
        row: usize,
        /// The column.
        col: usize,
    },
}

impl fmt::Display for MatrixError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Shape { rows, cols } => write!(f, "expected a square matrix, found {rows} × {cols}"),
            // The same fault, in the same words.
            Self::Columns => PatternError::Columns.fmt(f),
            Self::Values { expected, found } => write!(f, "expected {expected} values, found {found}"),
            Self::Outside { row, col } => write!(f, "entry ({row}, {col}) is outside of the matrix"),
            Self::Unsymmetric { row, col } => {
                write!(f, "the matrix is not symmetric: entries ({row}, {col}) and ({col}, {row}) differ")
            }
        }
    }
}

impl std::error::Error for MatrixError {}

impl<T: Scalar> SymmetricMatrix<T> {
    /// From (row, column, value) in any order; what comes several times is added up.
    ///
    /// # Errors
    /// [`MatrixError::Outside`]; of both triangles [`MatrixError::Unsymmetric`].
    pub fn from_triplets(
        dim: usize,
        triangle: Triangle,
        entries: impl IntoIterator<Item = (usize, usize, T)>,
    ) -> Result<Self, MatrixError> {
        let entries: Vec<_> = entries.into_iter().collect();
        Self::assemble((dim, dim), triangle, entries.iter().copied())
    }

    /// From compressed columns: `col_ptr[j]..col_ptr[j + 1]` are the places of column j in `row_idx` and `values`. Rows
    /// may come in any order in a column; what comes several times is added up.
    ///
    /// Compressed rows of one triangle are the compressed columns of the other.
    ///
    /// # Errors
    /// [`MatrixError`], where the columns make no matrix, or of both triangles no symmetric one.
    pub fn from_csc(
        dim: usize,
        triangle: Triangle,
        col_ptr: &[usize],
        row_idx: &[usize],
        values: &[T],
    ) -> Result<Self, MatrixError> {
        if row_idx.len() != values.len() {
            return Err(MatrixError::Values { expected: row_idx.len(), found: values.len() });
        }
        let ends = col_ptr.first() == Some(&0) && col_ptr.last() == Some(&row_idx.len());
        if dim.checked_add(1) != Some(col_ptr.len()) || !ends || !col_ptr.is_sorted() {
            return Err(MatrixError::Columns);
        }
        let entries = (0..dim).flat_map(|col| {
            let places = col_ptr[col]..col_ptr[col + 1];
            places.map(move |at| (row_idx[at], col, values[at]))
        });
        Self::assemble((dim, dim), triangle, entries)
    }

    /// From a sparse matrix of `faer` 0.24, with columns that are sorted or not. Needs the feature `faer`.
    ///
    /// ```
    /// use faer::sparse::{SparseColMat, Triplet};
    /// use multifrontal::{Options, Solver, Symbolic, SymmetricMatrix, Triangle};
    ///
    /// let entries = [(0, 0, 4.0), (1, 0, 1.0), (0, 1, 1.0), (2, 1, 2.0), (1, 2, 2.0), (2, 2, 5.0)];
    /// let entries = entries.map(|(row, col, value)| Triplet::new(row, col, value));
    /// let sparse = SparseColMat::<usize, f64>::try_new_from_triplets(3, 3, &entries).expect("rows are inside");
    ///
    /// let matrix = SymmetricMatrix::from_faer(sparse.as_ref(), Triangle::Both)?;
    /// let symbolic = Symbolic::of(&matrix, &Options::default())?;
    /// let mut x = [6.0, 7.0, 19.0];
    /// Solver::new(&symbolic, matrix.values(), &Options::default())?.solve(&mut x)?;
    /// assert!(x.iter().zip([1.0, 2.0, 3.0]).all(|(x, exact): (&f64, f64)| (x - exact).abs() < 1e-14));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`MatrixError::Shape`]; of both triangles [`MatrixError::Unsymmetric`].
    #[cfg(feature = "faer")]
    pub fn from_faer<I: faer::Index>(
        matrix: faer::sparse::SparseColMatRef<'_, I, T>,
        triangle: Triangle,
    ) -> Result<Self, MatrixError> {
        let symbolic = matrix.symbolic();
        let entries = (0..symbolic.ncols()).flat_map(|col| {
            let column = symbolic.row_idx_of_col_raw(col).iter().zip(matrix.val_of_col(col));
            column.map(move |(row, &value)| (row.zx(), col, value))
        });
        Self::assemble((symbolic.nrows(), symbolic.ncols()), triangle, entries)
    }

    /// From a sparse matrix of `sprs` 0.11, by columns or by rows. Needs the feature `sprs`.
    ///
    /// ```
    /// use multifrontal::{Options, Solver, Symbolic, SymmetricMatrix, Triangle};
    ///
    /// let mut triplets = sprs::TriMat::new((3, 3));
    /// for (row, col, value) in [(0, 0, 4.0), (1, 0, 1.0), (2, 1, 2.0), (2, 2, 5.0)] {
    ///     triplets.add_triplet(row, col, value);
    /// }
    /// let sparse: sprs::CsMat<f64> = triplets.to_csr();
    ///
    /// let matrix = SymmetricMatrix::from_sprs(sparse.view(), Triangle::Lower)?;
    /// let symbolic = Symbolic::of(&matrix, &Options::default())?;
    /// let mut x = [6.0, 7.0, 19.0];
    /// Solver::new(&symbolic, matrix.values(), &Options::default())?.solve(&mut x)?;
    /// assert!(x.iter().zip([1.0, 2.0, 3.0]).all(|(x, exact): (&f64, f64)| (x - exact).abs() < 1e-14));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`MatrixError::Shape`]; of both triangles [`MatrixError::Unsymmetric`].
    #[cfg(feature = "sprs")]
    pub fn from_sprs<I: sprs::SpIndex, P: sprs::SpIndex>(
        matrix: sprs::CsMatViewI<'_, T, I, P>,
        triangle: Triangle,
    ) -> Result<Self, MatrixError> {
        let (places, inner, values) = (matrix.indptr(), matrix.indices(), matrix.data());
        let by_rows = matrix.is_csr();
        let entries = (0..matrix.outer_dims()).flat_map(|outer| {
            places.outer_inds_sz(outer).map(move |at| {
                let inner = inner[at].index();
                let (row, col) = if by_rows { (outer, inner) } else { (inner, outer) };
                (row, col, values[at])
            })
        });
        Self::assemble(matrix.shape(), triangle, entries)
    }

    fn assemble(
        (rows, cols): (usize, usize),
        triangle: Triangle,
        entries: impl Iterator<Item = (usize, usize, T)> + Clone,
    ) -> Result<Self, MatrixError> {
        if rows != cols {
            return Err(MatrixError::Shape { rows, cols });
        }
        if let Some((row, col, _)) = entries.clone().find(|&(row, col, _)| row >= rows || col >= cols) {
            return Err(MatrixError::Outside { row, col });
        }
        let lower = entries.clone().filter(|&(row, col, _)| row >= col);
        let upper = entries.filter(|&(row, col, _)| row <= col).map(|(row, col, value)| (col, row, value));
        match triangle {
            Triangle::Lower => Ok(Self::of_lower(rows, lower)),
            Triangle::Upper => Ok(Self::of_lower(rows, upper)),
            Triangle::Both => Self::of_lower(rows, lower).checked(&Self::of_lower(rows, upper)),
        }
    }

    /// Sorts entries on the diagonal and below it into columns.
    fn of_lower(dim: usize, entries: impl Iterator<Item = (usize, usize, T)> + Clone) -> Self {
        let mut next = vec![0; dim + 1];
        entries.clone().for_each(|(_, col, _)| next[col + 1] += 1);
        (0..dim).for_each(|col| next[col + 1] += next[col]);
        let ends = next[1..].to_vec();
        let mut sorted = vec![(0, T::default()); next[dim]];
        for (row, col, value) in entries {
            sorted[next[col]] = (row, value);
            next[col] += 1;
        }
        let mut matrix = Self { col_ptr: vec![0], row_idx: Vec::new(), values: Vec::new() };
        matrix.row_idx.reserve_exact(sorted.len());
        matrix.values.reserve_exact(sorted.len());
        let mut start = 0;
        for end in ends {
            let column = &mut sorted[start..end];
            // A stable sort: equal ones are added up in the order in which they were given.
            column.sort_by_key(|&(row, _)| row);
            for same in column.chunk_by(|a, b| a.0 == b.0) {
                let mut sum = same[0].1;
                same[1..].iter().for_each(|&(_, value)| sum += value);
                matrix.row_idx.push(same[0].0);
                matrix.values.push(sum);
            }
            matrix.col_ptr.push(matrix.row_idx.len());
            start = end;
        }
        matrix
    }

    /// This triangle, if the other one, turned over, is the same; places that only the other one has are zeros here.
    fn checked(&self, other: &Self) -> Result<Self, MatrixError> {
        let dim = self.dim();
        let mut largest = vec![0.0f64; dim];
        for (row, col, value) in self.entries().chain(other.entries()) {
            for at in [row, col] {
                largest[at] = largest[at].max(value.modulus());
            }
        }
        let zeros = other.entries().map(|(row, col, _)| (row, col, T::default()));
        let both: Vec<_> = self.entries().chain(zeros).collect();
        let both = Self::of_lower(dim, both.iter().copied());
        let mut found = other.entries().peekable();
        for (row, col, value) in both.entries() {
            let mirrored = found.next_if(|&(r, c, _)| (r, c) == (row, col)).map_or(T::default(), |it| it.2);
            let tolerance = SYMMETRY_ROUNDOFFS * T::Real::ROUNDOFF * largest[row].max(largest[col]);
            // What is not finite is found when the matrix is factorised.
            if (value - mirrored).modulus() > tolerance {
                return Err(MatrixError::Unsymmetric { row, col });
            }
        }
        Ok(both)
    }

    fn entries(&self) -> impl Iterator<Item = (usize, usize, T)> {
        (0..self.dim()).flat_map(move |col| {
            let places = self.col_ptr[col]..self.col_ptr[col + 1];
            places.map(move |at| (self.row_idx[at], col, self.values[at]))
        })
    }

    /// Number of rows n.
    pub fn dim(&self) -> usize {
        self.col_ptr.len() - 1
    }

    /// Where each column begins in [`SymmetricMatrix::row_idx`], and where the last one ends.
    pub fn col_ptr(&self) -> &[usize] {
        &self.col_ptr
    }

    /// The row of each entry.
    pub fn row_idx(&self) -> &[usize] {
        &self.row_idx
    }

    /// The value of each entry.
    pub fn values(&self) -> &[T] {
        &self.values
    }

    /// The value of each entry, to be changed: the pattern stays.
    pub fn values_mut(&mut self) -> &mut [T] {
        &mut self.values
    }
}

impl Symbolic {
    /// Analyses the pattern of a matrix, as [`Symbolic::new`] does.
    ///
    /// # Errors
    /// [`PatternError::TooLarge`]; [`PatternError::Permutation`] of an order that is given.
    pub fn of<T: Scalar>(matrix: &SymmetricMatrix<T>, options: &Options) -> Result<Self, PatternError> {
        Self::new(matrix.dim(), &matrix.col_ptr, &matrix.row_idx, options)
    }
}
