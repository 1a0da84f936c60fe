//! From entries whose rows and columns have labels to a matrix.

use num_complex::Complex64 as c64;

use crate::assemble::{Assembly, Clash, ClashKind, Duplicates, Value};
use crate::{CoordinateMatrix, DofLabel, FormatError, Symmetry};

/// Entries in the order of a file: where they belong, on which line they are, and their values.
///
/// In lists of their own, for a list of entries would take half as much again for alignment.
pub(crate) struct Labelled<C> {
    rows: Vec<C>,
    cols: Vec<C>,
    lines: Vec<u32>,
    re: Vec<f64>,
    /// Empty for a real matrix.
    im: Vec<f64>,
}

impl<C: Copy + Ord> Labelled<C> {
    pub(crate) fn new() -> Self {
        Self { rows: Vec::new(), cols: Vec::new(), lines: Vec::new(), re: Vec::new(), im: Vec::new() }
    }

    pub(crate) fn push(&mut self, line: usize, row: C, col: C, value: f64) {
        self.rows.push(row);
        self.cols.push(col);
        // Of a file of more than 2³² lines the last line is named: an error then only says "not before".
        self.lines.push(u32::try_from(line).unwrap_or(u32::MAX));
        self.re.push(value);
    }

    pub(crate) fn push_complex(&mut self, line: usize, row: C, col: C, value: c64) {
        self.push(line, row, col, value.re);
        self.im.push(value.im);
    }

    pub(crate) fn len(&self) -> usize {
        self.rows.len()
    }

    pub(crate) fn rows(&self) -> &[C] {
        &self.rows
    }

    pub(crate) fn cols(&self) -> &[C] {
        &self.cols
    }

    /// The rows whose diagonal entry passes a test, sorted.
    pub(crate) fn rows_with_diagonal(&self, test: impl Fn(f64) -> bool) -> Vec<C> {
        let on_diagonal = |k: &usize| self.rows[*k] == self.cols[*k] && test(self.re[*k]);
        sorted((0..self.len()).filter(on_diagonal).map(|k| self.rows[k]).collect())
    }

    /// Leaves out every entry in one of these rows or columns (sorted).
    pub(crate) fn leave_out(&mut self, codes: &[C]) {
        let gone = |code: &C| codes.binary_search(code).is_ok();
        let kept: Vec<bool> = self.rows.iter().zip(&self.cols).map(|(r, c)| !gone(r) && !gone(c)).collect();
        retain(&mut self.rows, &kept);
        retain(&mut self.cols, &kept);
        retain(&mut self.lines, &kept);
        retain(&mut self.re, &kept);
        if !self.im.is_empty() {
            retain(&mut self.im, &kept);
        }
    }

    /// Symmetric where no entry has its mirror image beside it, general elsewhere.
    ///
    /// A file that says nothing of symmetry lists one triangle of a symmetric matrix, or all of any.
    pub(crate) fn inferred_symmetry(&self) -> Symmetry {
        let pairs = || self.rows.iter().copied().zip(self.cols.iter().copied());
        let mut below: Vec<(C, C)> = pairs().filter(|(row, col)| row > col).collect();
        below.sort_unstable();
        let mirrored = |(row, col): (C, C)| row < col && below.binary_search(&(col, row)).is_ok();
        if pairs().any(mirrored) { Symmetry::General } else { Symmetry::Symmetric }
    }

    /// The matrix, given the row and the column of each code; each position once.
    pub(crate) fn assemble(
        self,
        symmetry: Symmetry,
        (nrows, row_of): (usize, impl Fn(C) -> u64),
        (ncols, col_of): (usize, impl Fn(C) -> u64),
        shown: impl Fn(C) -> String,
        title: String,
    ) -> Result<CoordinateMatrix, FormatError> {
        let Self { rows, cols, lines, re, im } = self;
        let places = |k: usize| (row_of(rows[k]), col_of(cols[k]));
        let finished = match im.is_empty() {
            true => assembled::<f64>(symmetry, &places, re.into_iter().map(|re| [re, 0.0]), &lines, |all| {
                all.finish(Duplicates::Refuse, nrows, ncols, title)
            })?,
            false => {
                let values = re.into_iter().zip(im).map(|(re, im)| [re, im]);
                assembled::<c64>(symmetry, &places, values, &lines, |all| {
                    all.finish(Duplicates::Refuse, nrows, ncols, title)
                })?
            }
        };
        finished.map_err(|clash| {
            let here = (clash.row as u64, clash.col as u64);
            let is_here = |k: &usize| {
                let (row, col) = places(*k);
                (row, col) == here || (symmetry != Symmetry::General && (col, row) == here)
            };
            let mut met = (0..rows.len()).filter(is_here);
            let first = met.next().unwrap_or_default();
            let second = match clash.kind {
                ClashKind::Mirrored => met.find(|&k| places(k) != places(first)),
                ClashKind::Twice | ClashKind::Overflow => met.next(),
            };
            let second = second.unwrap_or(first);
            let name = |k: usize| format!("({}, {})", shown(rows[k]), shown(cols[k]));
            let found = match clash.kind {
                ClashKind::Mirrored => format!("both {} and {}", name(first), name(second)),
                ClashKind::Twice | ClashKind::Overflow => format!("{} again", name(second)),
            };
            FormatError::line(lines[second] as usize, "each position once", found)
        })
    }
}

impl Labelled<i64> {
    /// The square matrix whose rows and columns are all labels of either, sorted; and these.
    pub(crate) fn square(
        self,
        symmetry: Symmetry,
        title: String,
    ) -> Result<(CoordinateMatrix, Vec<DofLabel>), FormatError> {
        let mut all = Vec::with_capacity(2 * self.len());
        all.extend_from_slice(&self.rows);
        all.extend_from_slice(&self.cols);
        let codes = sorted(all);
        let (size, index) = (codes.len(), index_of(&codes));
        let matrix = self.assemble(symmetry, (size, &index), (size, &index), shown_label, title)?;
        Ok((matrix, codes.iter().copied().map(DofLabel::of_code).collect()))
    }
}

/// Row or column of a code among those that are there.
pub(crate) fn index_of(codes: &[i64]) -> impl Fn(i64) -> u64 {
    // All codes of the entries are there: a failed search cannot happen, and would give the place next to it.
    |code| codes.binary_search(&code).unwrap_or_else(|next| next) as u64
}

pub(crate) fn shown_label(code: i64) -> String {
    DofLabel::of_code(code).to_string()
}

/// Sorted, each once, in no more room than it takes.
pub(crate) fn sorted<C: Ord>(mut codes: Vec<C>) -> Vec<C> {
    codes.sort_unstable();
    codes.dedup();
    codes.shrink_to_fit();
    codes
}

fn retain<T>(items: &mut Vec<T>, kept: &[bool]) {
    let mut kept = kept.iter();
    items.retain(|_| kept.next().copied().unwrap_or(true));
}

/// Pushes all entries and finishes; the outer error is that of an entry, the inner that of the whole.
fn assembled<V: Value>(
    symmetry: Symmetry,
    places: &impl Fn(usize) -> (u64, u64),
    values: impl ExactSizeIterator<Item = [f64; 2]>,
    lines: &[u32],
    finish: impl FnOnce(Assembly<V>) -> Result<CoordinateMatrix, Clash>,
) -> Result<Result<CoordinateMatrix, Clash>, FormatError> {
    let mut assembly = Assembly::new(symmetry, values.len());
    for (k, value) in values.enumerate() {
        let (row, col) = places(k);
        assembly
            .push(row, col, V::from_numbers(value))
            .map_err(|(expected, found)| FormatError::line(lines[k] as usize, expected, found))?;
    }
    Ok(finish(assembly))
}
