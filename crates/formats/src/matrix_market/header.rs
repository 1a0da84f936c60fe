//! Banner, comments and size line.

use crate::assemble::{MAX_ENTRIES, MAX_ROWS};
use crate::matrix::SQUARE;
use crate::text::{Line, Lines, Tokens, quoted};
use crate::{FormatError, Symmetry};

/// What stands before the first entry.
pub(super) struct Header {
    pub(super) field: Field,
    pub(super) symmetry: Symmetry,
    pub(super) nrows: u64,
    pub(super) ncols: u64,
    /// Number of entries of a coordinate file; `None` of an array file.
    pub(super) entries: Option<u64>,
    /// Number of the size line.
    pub(super) size_line: usize,
    pub(super) title: String,
}

/// What a value is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Field {
    Real,
    Integer,
    Complex,
    Pattern,
}

const BANNER: &str = "%%matrixmarket";

/// Whether a line begins like the first line of a Matrix Market file.
pub(crate) fn is_banner(line: &[u8]) -> bool {
    line.get(..BANNER.len()).is_some_and(|start| start.eq_ignore_ascii_case(BANNER.as_bytes()))
}

impl Header {
    pub(super) fn read(lines: &mut Lines<'_>) -> Result<Self, FormatError> {
        let Some(first) = lines.next() else {
            return Err(FormatError::whole("a line that begins with %%MatrixMarket", "an empty file"));
        };
        let (is_coordinate, field, symmetry) = banner(first)?;
        let (title, size) = comments_and_size_line(lines)?;
        let mut tokens = Tokens::new(size);
        let nrows = tokens.whole("a number of rows", 0, MAX_ROWS)?;
        let ncols = tokens.whole("a number of columns", 0, MAX_ROWS)?;
        let entries = match is_coordinate {
            true => Some(tokens.whole("a number of entries", 0, MAX_ENTRIES)?),
            false => None,
        };
        tokens.end()?;
        if symmetry != Symmetry::General && nrows != ncols {
            return Err(FormatError::line(size.number, SQUARE, format!("{nrows} rows and {ncols} columns")));
        }
        Ok(Self { field, symmetry, nrows, ncols, entries, size_line: size.number, title })
    }
}

/// `%%MatrixMarket matrix <coordinate|array> <field> <symmetry>`.
fn banner(line: Line<'_>) -> Result<(bool, Field, Symmetry), FormatError> {
    let mut tokens = Tokens::new(line);
    let mut choose = |expected: &str, known: &[&str]| {
        let (start, word) = tokens.word();
        let found = known.iter().position(|k| *k == word);
        found.ok_or_else(|| line.error(start, expected, quoted(word.as_bytes())))
    };
    choose("%%MatrixMarket", &[BANNER])?;
    choose("matrix (the only object that is read)", &["matrix"])?;
    let is_coordinate = choose("coordinate or array", &["coordinate", "array"])? == 0;
    let field = match choose("real, integer, complex or pattern", &["real", "integer", "complex", "pattern"])?
    {
        0 => Field::Real,
        1 => Field::Integer,
        2 => Field::Complex,
        _ if !is_coordinate => {
            return Err(FormatError::line(1, "real, integer or complex values in an array file", "pattern"));
        }
        _ => Field::Pattern,
    };
    let (expected, known): (_, &[&str]) = match field {
        Field::Complex => (
            "general, symmetric, skew-symmetric or hermitian",
            &["general", "symmetric", "skew-symmetric", "hermitian"],
        ),
        Field::Real | Field::Integer => {
            ("general, symmetric or skew-symmetric", &["general", "symmetric", "skew-symmetric"])
        }
        Field::Pattern => ("general or symmetric", &["general", "symmetric"]),
    };
    let symmetry = match choose(expected, known)? {
        0 => Symmetry::General,
        1 => Symmetry::Symmetric,
        2 => Symmetry::SkewSymmetric,
        _ => Symmetry::Hermitian,
    };
    tokens.end()?;
    Ok((is_coordinate, field, symmetry))
}

/// The comment lines without their percent signs, and the first line that is no comment.
fn comments_and_size_line<'a>(lines: &mut Lines<'a>) -> Result<(String, Line<'a>), FormatError> {
    let mut comments: Option<String> = None;
    for line in lines.by_ref() {
        match line.bytes.trim_ascii() {
            [] => {}
            [b'%', comment @ ..] => {
                let comment = String::from_utf8_lossy(comment);
                match &mut comments {
                    Some(above) => above.extend(["\n", comment.trim()]),
                    None => comments = Some(comment.trim().to_owned()),
                }
            }
            _ => return Ok((comments.unwrap_or_default(), line)),
        }
    }
    Err(FormatError::line(lines.taken, "a size line", "the end of the file"))
}
