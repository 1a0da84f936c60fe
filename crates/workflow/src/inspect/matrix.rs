//! A matrix in figures, and whether it can be a term of a model.

use super::text::aligned;
use crate::load::{asymmetry, check_symmetric, complex};
use crate::terminal::short;
use frfit::c64;
use frfit_formats::csv::Direction;
use frfit_formats::{CoordinateMatrix, DofLabel, Entries, FileKind, FormatError, Labels, Symmetry};
use serde_json::{Value, json};
use std::collections::BTreeSet;

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
    /// What the file declares, or, of lists of entries that declare nothing, whether one triangle is there (symmetric) or both.
    pub symmetry: Symmetry,
    /// Where entries off the diagonal are stored: `both`, `lower`, `upper` or `none`; `one` where the symmetry gives the other triangle.
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
    /// What its rows stand for; `None` where no file says.
    pub labels: Option<LabelFacts>,
    /// What the file says about itself.
    pub title: String,
    /// Whether it can be a term of a model, and if not, why.
    pub term: Result<(), FormatError>,
}

/// What the rows of a matrix stand for, in figures.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct LabelFacts {
    /// Number of nodes that have a row.
    pub nodes: usize,
    /// Directions that some node has.
    pub directions: Vec<Direction>,
    /// Rows without a name that a case can use: no direction, or a node that the solver has made for itself.
    pub nameless: usize,
    /// The first row and the last one.
    pub ends: [DofLabel; 2],
    /// Degrees of freedom that are held fixed and have no row.
    pub fixed: usize,
}

impl LabelFacts {
    fn of(labels: &Labels) -> Option<Self> {
        let ends = [*labels.rows.first()?, *labels.rows.last()?];
        let nodes: BTreeSet<_> = labels.rows.iter().map(|label| label.node).collect();
        let directions: BTreeSet<_> = labels.rows.iter().filter_map(|label| label.direction()).collect();
        let nameless = |label: &&DofLabel| label.node < 1 || label.direction().is_none();
        Some(Self {
            nodes: nodes.len(),
            directions: directions.into_iter().collect(),
            nameless: labels.rows.iter().filter(nameless).count(),
            ends,
            fixed: labels.fixed.len(),
        })
    }

    fn directions(&self) -> Vec<&'static str> {
        self.directions.iter().map(|direction| direction.name()).collect()
    }

    fn json(&self) -> Value {
        json!({
            "nodes": self.nodes,
            "directions": self.directions(),
            "without_name": self.nameless,
            "first": self.ends[0].to_string(),
            "last": self.ends[1].to_string(),
            "held_fixed": self.fixed,
        })
    }

    fn line(&self) -> String {
        let [first, last] = self.ends;
        let mut line = format!("{first} to {last}, {} nodes", self.nodes);
        if !self.directions.is_empty() {
            line.push_str(&format!(" with {}", self.directions().join(", ")));
        }
        if self.nameless > 0 {
            line.push_str(&format!("; {} rows without a name", self.nameless));
        }
        if self.fixed > 0 {
            line.push_str(&format!("; {} more held fixed and left out", self.fixed));
        }
        line
    }
}

/// The kind of a matrix file, as JSON has it.
pub(super) fn kind_word(kind: FileKind) -> &'static str {
    match kind {
        FileKind::HarwellBoeing => "harwell-boeing",
        FileKind::Triplets => "triplets",
        FileKind::Abaqus => "abaqus",
        FileKind::Dmig => "dmig",
        FileKind::Op4 => "op4",
        FileKind::Numpy => "numpy",
        FileKind::Mat => "matlab",
        FileKind::MatrixMarket | FileKind::Uff | FileKind::Csv | FileKind::Lvm => "matrix market",
    }
}

/// Where a matrix has entries off its diagonal; that of a rectangular one is of no interest.
fn triangle(matrix: &CoordinateMatrix) -> &'static str {
    let has = |side: fn(&usize, &usize) -> bool| {
        matrix.rows.iter().zip(&matrix.cols).any(|(row, col)| side(row, col))
    };
    match (matrix.symmetry, has(|row, col| row > col), has(|row, col| row < col)) {
        (Symmetry::General, _, _) if matrix.nrows != matrix.ncols => "both",
        (_, false, false) => "none",
        (Symmetry::General, true, false) => "lower",
        (Symmetry::General, false, true) => "upper",
        (Symmetry::General, true, true) => "both",
        _ => "one",
    }
}

impl MatrixFacts {
    pub(super) fn of(kind: FileKind, matrix: &CoordinateMatrix, labels: &Labels) -> Self {
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
            labels: LabelFacts::of(labels),
            title: matrix.title.clone(),
            term: check_symmetric(matrix),
        }
    }

    /// What is known of the other triangle, and from what.
    fn triangle_words(&self) -> String {
        let declares_nothing =
            matches!(self.kind, FileKind::Triplets | FileKind::Abaqus | FileKind::Numpy | FileKind::Mat);
        let declared = format!("declared {}", self.symmetry_word());
        match self.triangle {
            "lower" | "upper" if declares_nothing => format!("only the {} triangle stored", self.triangle),
            "lower" | "upper" => format!("{declared}, only the {} triangle stored", self.triangle),
            "none" if declares_nothing => "a diagonal".into(),
            "one" if declares_nothing => "one triangle stored: symmetric".into(),
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
            "labels": self.labels.as_ref().map(LabelFacts::json),
            "zero_rows": self.zero_rows,
            "zero_diagonals": self.zero_diagonals,
            "diagonal": self.diagonal.map(|[min, max]| json!({"min": min, "max": max})),
            "largest": self.largest,
            "title": self.title,
            "term": self.term.is_ok(),
        })
    }

    /// A line for each figure; the title unless it is the name under which they stand.
    pub(super) fn lines(&self, name: &str) -> String {
        let mut lines = Vec::new();
        let is_told = |line: &&str| line.contains(char::is_alphanumeric) && line.trim() != name;
        if let Some(title) = self.title.lines().find(is_told) {
            lines.push(("title", title.trim().chars().take(72).collect()));
        }
        lines.push(("size", format!("{} x {}", self.rows, self.columns)));
        lines.push(("values", format!("{}, {}", self.field, self.triangle_words())));
        lines.push(("entries", format!("{} stored, {} not zero in all", self.stored, self.nonzeros)));
        if let Some(labels) = &self.labels {
            lines.push(("rows", labels.line()));
        }
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
