//! A matrix in figures, and whether it can be a term of a model.

use super::text::{aligned, short};
use crate::load::{asymmetry, check_symmetric, complex};
use frfit::c64;
use frfit_formats::{CoordinateMatrix, Entries, FileKind, FormatError, Symmetry};
use serde_json::{Value, json};

/// A matrix in figures.
#[derive(Debug, Clone, PartialEq)]
pub struct MatrixFacts {
    /// What kind of file it is in.
    pub kind: FileKind,
    /// Number of rows.
    pub rows: usize,
    /// Number of columns.
    pub columns: usize,
    /// Positions that the file stores, each counted once; of a symmetric matrix those of one triangle.
    pub stored: usize,
    /// Entries of the whole matrix that are not zero.
    pub nonzeros: usize,
    /// `real`, `complex` or `pattern`.
    pub field: &'static str,
    /// What the file declares.
    pub symmetry: Symmetry,
    /// Where entries off the diagonal are stored: `both`, `lower`, `upper` or `none`; `one` where the symmetry gives the other.
    pub triangle: &'static str,
    /// Why Aᵀ is not A, in words; `None` where it is, up to rounding.
    pub asymmetry: Option<String>,
    /// Rows in which nothing is but zeros.
    pub zero_rows: usize,
    /// Diagonal entries that are zero.
    pub zero_diagonals: usize,
    /// Smallest and largest diagonal entry (of a complex matrix: real part); `None` without any.
    pub diagonal: Option<[f64; 2]>,
    /// Largest |a_ij|.
    pub largest: f64,
    /// What the file says about itself.
    pub title: String,
    /// Whether it can be a term of a model, and if not, why.
    pub term: Result<(), FormatError>,
}

/// The kind of a matrix file, as JSON has it.
pub(super) fn kind_word(kind: FileKind) -> &'static str {
    match kind {
        FileKind::HarwellBoeing => "harwell-boeing",
        FileKind::Op4 => "op4",
        FileKind::Numpy => "numpy",
        FileKind::Mat => "matlab",
        FileKind::MatrixMarket | FileKind::Uff | FileKind::Csv | FileKind::Lvm => "matrix market",
    }
}

/// Where a general matrix has entries off its diagonal; that of a rectangular one is of no interest.
fn triangle(matrix: &CoordinateMatrix) -> &'static str {
    let has = |side: fn(&usize, &usize) -> bool| {
        matrix.rows.iter().zip(&matrix.cols).any(|(row, col)| side(row, col))
    };
    match (matrix.symmetry, has(|row, col| row > col), has(|row, col| row < col)) {
        (Symmetry::General, _, _) if matrix.nrows != matrix.ncols => "both",
        (Symmetry::General, true, false) => "lower",
        (Symmetry::General, false, true) => "upper",
        (Symmetry::General, false, false) => "none",
        (Symmetry::General, true, true) => "both",
        _ => "one",
    }
}

impl MatrixFacts {
    pub(super) fn of(kind: FileKind, matrix: &CoordinateMatrix) -> Self {
        let mirrored = matrix.symmetry != Symmetry::General;
        let values = complex(matrix);
        let positions = matrix.rows.iter().copied().zip(matrix.cols.iter().copied());
        let nonzeros: Vec<((usize, usize), c64)> =
            positions.zip(values).filter(|(_, value)| *value != c64::default()).collect();
        // By what is stored, not by the numbers of the header: these may be huge.
        let mut rows: Vec<usize> = nonzeros.iter().map(|((row, _), _)| *row).collect();
        if mirrored {
            rows.extend(nonzeros.iter().map(|((_, col), _)| *col));
        }
        rows.sort_unstable();
        rows.dedup();
        let diagonal: Vec<f64> =
            nonzeros.iter().filter(|((row, col), _)| row == col).map(|(_, value)| value.re).collect();
        let zero_diagonals = matrix.nrows.min(matrix.ncols) - diagonal.len();
        let with_zero = || diagonal.iter().copied().chain((zero_diagonals > 0).then_some(0.0));
        Self {
            kind,
            rows: matrix.nrows,
            columns: matrix.ncols,
            stored: matrix.rows.len(),
            nonzeros: nonzeros.len() + if mirrored { nonzeros.len() - diagonal.len() } else { 0 },
            field: match matrix.entries {
                Entries::Pattern => "pattern",
                Entries::Real(_) => "real",
                Entries::Complex(_) => "complex",
            },
            symmetry: matrix.symmetry,
            triangle: triangle(matrix),
            asymmetry: match matrix.nrows == matrix.ncols {
                true => asymmetry(matrix),
                false => Some(format!("{} rows and {} columns", matrix.nrows, matrix.ncols)),
            },
            zero_rows: matrix.nrows - rows.len(),
            zero_diagonals,
            diagonal: with_zero().reduce(f64::min).zip(with_zero().reduce(f64::max)).map(<[f64; 2]>::from),
            largest: nonzeros.iter().map(|(_, value)| value.norm()).fold(0.0, f64::max),
            title: matrix.title.clone(),
            term: check_symmetric(matrix),
        }
    }

    /// What is known of the other triangle, and from what.
    fn triangle_words(&self) -> String {
        let declares_nothing = matches!(self.kind, FileKind::Numpy | FileKind::Mat);
        let declared = format!("declared {}", self.symmetry_word());
        match self.triangle {
            "lower" | "upper" if declares_nothing => format!("only the {} triangle stored", self.triangle),
            "lower" | "upper" => format!("{declared}, only the {} triangle stored", self.triangle),
            "none" if declares_nothing => "a diagonal".into(),
            _ if declares_nothing => "both triangles stored".into(),
            _ => declared,
        }
    }

    fn symmetry_word(&self) -> &'static str {
        match self.symmetry {
            Symmetry::General => "general",
            Symmetry::Symmetric => "symmetric",
            Symmetry::SkewSymmetric => "skew-symmetric",
            Symmetry::Hermitian => "hermitian",
        }
    }

    pub(super) fn json(&self) -> Value {
        json!({
            "rows": self.rows,
            "columns": self.columns,
            "stored": self.stored,
            "nonzeros": self.nonzeros,
            "field": self.field,
            "declared_symmetry": self.symmetry_word(),
            "triangle": self.triangle,
            "numerically_symmetric": self.asymmetry.is_none(),
            "asymmetry": self.asymmetry,
            "zero_rows": self.zero_rows,
            "zero_diagonals": self.zero_diagonals,
            "diagonal": self.diagonal.map(|[min, max]| json!({"min": min, "max": max})),
            "largest": self.largest,
            "title": self.title,
            "term": self.term.is_ok(),
        })
    }

    pub(super) fn lines(&self) -> String {
        let mut lines = Vec::new();
        let is_told = |line: &&str| line.contains(char::is_alphanumeric);
        if let Some(title) = self.title.lines().find(is_told) {
            lines.push(("title", title.trim().chars().take(72).collect()));
        }
        lines.push(("size", format!("{} x {}", self.rows, self.columns)));
        lines.push(("values", format!("{}, {}", self.field, self.triangle_words())));
        lines.push(("entries", format!("{} stored, {} not zero in all", self.stored, self.nonzeros)));
        if let Some([min, max]) = self.diagonal {
            let zeros = match self.zero_diagonals {
                0 => String::new(),
                zeros => format!(", {zeros} of them zero"),
            };
            lines.push(("diagonal", format!("{} to {}{zeros}", short(min), short(max))));
        }
        if self.zero_rows > 0 {
            lines.push(("zero rows", self.zero_rows.to_string()));
        }
        lines.push(("largest", short(self.largest)));
        lines.push((
            "use",
            match &self.term {
                Ok(()) => "a term of a model (file of a [[matrix]])".into(),
                Err(FormatError { expected, found, .. }) => {
                    format!("not a term of a model: expected {expected}, found {found}")
                }
            },
        ));
        aligned(&lines)
    }
}
