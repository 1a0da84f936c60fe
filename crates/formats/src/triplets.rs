//! Bare lists of row, column and value: CalculiX (`.sti`, `.mas`) and Abaqus with `FORMAT=COORDINATE` (`.mtx`).
//!
//! A line an entry: row and column from 1 and a value, set apart by blanks or commas. CalculiX lists one triangle
//! and the diagonal, Abaqus one triangle or both. The file gives neither its size nor its symmetry: the size is the
//! largest index, and where no entry has its mirror image beside it, it is a triangle of a symmetric matrix.
//! Lines that begin with `**` are comments.
//!
//! The rows of a CalculiX matrix are named in a file beside it, which [`read_dofs`] reads: `.dof`, one line a row,
//! `712.1` for direction 1 of node 712.
//!
//! # Limits
//! A value has to have a decimal point or an exponent, as both programs write it: the size line of a Matrix Market
//! file that has lost its banner would else be an entry. A table (CSV) of a whole number, a whole number and a value
//! without names of columns is a list of entries. A matrix of which one triangle is nothing but zeros and is
//! not symmetric cannot be distinguished from a triangle of a symmetric one.
//!
//! # Source
//! G. Dhondt: CalculiX CrunchiX User's Manual, keywords \*FREQUENCY and \*MODAL DYNAMIC: `SOLVER=MATRIXSTORAGE`.
//! Abaqus Analysis User's Guide, "Generating matrices", `*MATRIX OUTPUT, FORMAT=COORDINATE`.

use crate::assemble::MAX_ROWS;
use crate::label::{MAX_NODE, distinct};
use crate::labelled::Labelled;
use crate::text::{Decimal, FINITE, Line, Lines, Tokens, quoted, whole};
use crate::{CoordinateMatrix, DofLabel, FormatError};

/// Reads a list of row, column and value.
///
/// # Errors
/// A line that is not a row, a column and a value; a value that is not finite, or has neither point nor exponent; a
/// position given twice; no entry.
pub fn read(bytes: &[u8]) -> Result<CoordinateMatrix, FormatError> {
    let mut entries = Labelled::<u32>::new();
    let title = each_entry(bytes, |line| {
        let fields = Fields::split(line);
        let row = fields.whole(0, "a row", MAX_ROWS)?;
        let col = fields.whole(1, "a column", MAX_ROWS)?;
        let value = fields.value(2)?;
        fields.end(3)?;
        entries.push(line.number, row as u32, col as u32, value);
        Ok(())
    })?;
    if entries.len() == 0 {
        return Err(FormatError::whole("entries: row, column and value", "none"));
    }
    let size = entries.rows().iter().chain(entries.cols()).max().map_or(0, |&n| n as usize);
    let symmetry = entries.inferred_symmetry();
    let index = |n: u32| u64::from(n) - 1;
    entries.assemble(symmetry, (size, index), (size, index), |n| n.to_string(), title)
}

/// Whether a line is an entry of this list.
pub(crate) fn is_entry(line: Line<'_>) -> bool {
    let fields = Fields::split(line);
    let indices = (0..2).all(|k| fields.whole(k, "", MAX_ROWS).is_ok());
    indices && fields.value(2).is_ok() && fields.end(3).is_ok()
}

/// Reads the names of the rows of a CalculiX matrix (`.dof`), in their order.
///
/// # Errors
/// A line that is not a node, a point and a component from 0 to 9; a name given twice; no name.
pub fn read_dofs(bytes: &[u8]) -> Result<Vec<DofLabel>, FormatError> {
    let mut labels = Vec::new();
    let mut lines = Vec::new();
    for line in Lines::new(bytes).filter(|line| !line.is_blank()) {
        let mut tokens = Tokens::new(line);
        let (start, token) = tokens.take();
        labels.push(dof(token).ok_or_else(|| {
            line.error(start, "a node, a point and a direction such as 712.1", quoted(token))
        })?);
        tokens.end()?;
        lines.push(u32::try_from(line.number).unwrap_or(u32::MAX));
    }
    if labels.is_empty() {
        return Err(FormatError::whole("names of rows such as 712.1", "none"));
    }
    distinct(labels, &lines)
}

fn dof(token: &[u8]) -> Option<DofLabel> {
    let point = token.iter().position(|&b| b == b'.')?;
    let node = whole(&token[..point]).filter(|node| (1..=MAX_NODE).contains(node))?;
    match token[point + 1..] {
        [digit @ b'0'..=b'9'] => Some(DofLabel { node: node as i64, component: digit - b'0' }),
        _ => None,
    }
}

/// What stands behind the two stars of a comment line.
pub(crate) fn comment(line: Line<'_>) -> Option<&[u8]> {
    line.bytes.trim_ascii().strip_prefix(b"**")
}

/// Hands over every line that is neither blank nor a comment; the title is the comments before the first.
pub(crate) fn each_entry<'a>(
    bytes: &'a [u8],
    mut take: impl FnMut(Line<'a>) -> Result<(), FormatError>,
) -> Result<String, FormatError> {
    let mut title = String::new();
    let mut in_title = true;
    for line in Lines::new(bytes).filter(|line| !line.is_blank()) {
        let Some(comment) = comment(line) else {
            in_title = false;
            take(line)?;
            continue;
        };
        let comment = String::from_utf8_lossy(comment.trim_ascii());
        if in_title && !comment.is_empty() {
            title.push_str(if title.is_empty() { "" } else { "\n" });
            title.push_str(&comment);
        }
    }
    Ok(title)
}

/// The first fields of a line, set apart by blanks, commas or both.
pub(crate) struct Fields<'a> {
    line: Line<'a>,
    /// Where each starts, and what it is.
    fields: [(usize, &'a [u8]); Fields::MAX_COUNT],
    count: usize,
}

impl<'a> Fields<'a> {
    /// One more than the longest line that is read has.
    pub(crate) const MAX_COUNT: usize = 7;

    pub(crate) fn split(line: Line<'a>) -> Self {
        let mut fields = [(line.bytes.len(), &[][..]); Self::MAX_COUNT];
        let (mut count, mut at) = (0, 0);
        let is_between = |b: u8| b == b',' || b.is_ascii_whitespace();
        while count < Self::MAX_COUNT {
            let Some(skip) = line.bytes[at..].iter().position(|&b| !is_between(b)) else { break };
            let start = at + skip;
            let length = line.bytes[start..].iter().position(|&b| is_between(b));
            at = length.map_or(line.bytes.len(), |length| start + length);
            fields[count] = (start, &line.bytes[start..at]);
            count += 1;
        }
        Self { line, fields, count }
    }

    pub(crate) fn count(&self) -> usize {
        self.count
    }

    /// The k-th field, a whole number from 1 on.
    pub(crate) fn whole(&self, k: usize, name: &str, most: u64) -> Result<u64, FormatError> {
        let (start, field) = self.fields[k];
        match whole(field) {
            Some(n) if (1..=most).contains(&n) => Ok(n),
            _ => Err(self.line.error(start, format!("{name} from 1 to {most}"), quoted(field))),
        }
    }

    /// The k-th field, a node: negative for one that the solver has made.
    pub(crate) fn node(&self, k: usize) -> Result<i64, FormatError> {
        let (start, field) = self.fields[k];
        let (sign, digits) = match field.strip_prefix(b"-") {
            Some(digits) => (-1, digits),
            None => (1, field),
        };
        match whole(digits) {
            Some(n) if (1..=MAX_NODE).contains(&n) => Ok(sign * n as i64),
            _ => Err(self.line.error(start, "a node number other than 0, below 2^31", quoted(field))),
        }
    }

    /// The k-th field, a finite number with a point or an exponent.
    pub(crate) fn value(&self, k: usize) -> Result<f64, FormatError> {
        let (start, field) = self.fields[k];
        let Some((decimal, value)) = Decimal::parse(field).and_then(|d| Some((d, d.value(0)?))) else {
            return Err(self.line.error(start, FINITE, quoted(field)));
        };
        match decimal.has_point || decimal.exponent.is_some() {
            true => Ok(value),
            false => Err(self.line.error(start, "a value with a decimal point", quoted(field))),
        }
    }

    /// No k-th field.
    pub(crate) fn end(&self, k: usize) -> Result<(), FormatError> {
        let (start, field) = self.fields[k];
        if self.count > k {
            return Err(self.line.error(start, "the end of the line", quoted(field)));
        }
        Ok(())
    }
}
