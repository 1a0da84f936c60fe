//! A variable: its flags, dimensions and name, and what it is.

use super::element::{Element, Kind};
use super::matrix;
use crate::bytes::Cursor;
use crate::{FormatError, NamedMatrix};

/// What is at the head of every variable.
pub(super) struct Head {
    class: u8,
    pub(super) is_complex: bool,
    pub(super) dimensions: Vec<u64>,
    name: String,
}

const STRUCTURE: u8 = 2;
const SPARSE: u8 = 5;

impl Head {
    fn read(cursor: &mut Cursor<'_>) -> Result<Self, FormatError> {
        let place = cursor.place();
        let flags = Element::read(cursor, "the flags of a variable")?.wholes().unwrap_or_default();
        let flags =
            *flags.first().ok_or_else(|| FormatError::byte(place, "the flags of a variable", "none"))?;
        // Of an object of MATLAB's own kind (opaque) nothing more is as it is of others.
        let class = (flags & 0xFF) as u8;
        if class == 17 {
            return Ok(Self { class, is_complex: false, dimensions: Vec::new(), name: String::new() });
        }
        let place = cursor.place();
        let dimensions = Element::read(cursor, "the dimensions of a variable")?.wholes();
        let dimensions = dimensions.filter(|sizes| sizes.len() >= 2).ok_or_else(|| {
            FormatError::byte(place, "the dimensions of a variable, at least two whole numbers", "others")
        })?;
        let name = Element::read(cursor, "the name of a variable")?.text();
        Ok(Self { class, is_complex: flags & 0x800 != 0, dimensions, name })
    }

    /// What it is, where it is no matrix.
    fn other(&self) -> String {
        match self.class {
            1 => "a cell array".into(),
            STRUCTURE => "a structure".into(),
            3 => "an object".into(),
            4 => "a text".into(),
            16 => "a function handle".into(),
            SPARSE | 6..=15 => self.shape(),
            other => format!("an array of class {other}"),
        }
    }

    fn shape(&self) -> String {
        let sizes: Vec<_> = self.dimensions.iter().map(u64::to_string).collect();
        format!("an array of {}", sizes.join(" x "))
    }
}

/// Adds a variable; of a structure each of its fields.
///
/// # Errors
/// Parts that end beyond the variable, so that nothing of it can be told.
pub(super) fn read(mut cursor: Cursor<'_>, matrices: &mut Vec<NamedMatrix>) -> Result<(), FormatError> {
    if cursor.left() == 0 {
        return Ok(());
    }
    let head = Head::read(&mut cursor)?;
    // What MATLAB saves for itself, such as the insides of objects, has no name.
    if head.name.is_empty() {
        return Ok(());
    }
    if head.class == STRUCTURE && head.dimensions.iter().all(|&size| size == 1) {
        return fields(&head.name, cursor, matrices);
    }
    matrices.push(NamedMatrix::plain(head.name.as_str(), one(&head, cursor, &head.name)));
    Ok(())
}

/// A variable that is a matrix.
fn one(head: &Head, cursor: Cursor<'_>, name: &str) -> Result<crate::CoordinateMatrix, FormatError> {
    match (head.class, head.dimensions.as_slice()) {
        (SPARSE, &[nrows, ncols]) => matrix::sparse(head, cursor, [nrows, ncols], name),
        (6..=15, &[nrows, ncols]) => matrix::full(head, cursor, [nrows, ncols], name),
        _ => Err(FormatError::whole("a matrix of numbers", head.other())),
    }
}

/// The fields of a structure.
fn fields(
    structure: &str,
    mut cursor: Cursor<'_>,
    matrices: &mut Vec<NamedMatrix>,
) -> Result<(), FormatError> {
    const LENGTH: &str = "the length of a field's name";
    let place = cursor.place();
    let length = Element::read(&mut cursor, LENGTH)?.wholes().and_then(|lengths| lengths.first().copied());
    let length = length.and_then(|length| usize::try_from(length).ok()).filter(|length| *length > 0);
    let length = length.ok_or_else(|| FormatError::byte(place, LENGTH, "none"))?;
    let mut names = Element::read(&mut cursor, "the names of fields")?.data;
    let names = names.take(names.left() as u64, "the names of fields")?;
    for name in names.chunks_exact(length) {
        let end = name.iter().position(|&byte| byte == 0).unwrap_or(name.len());
        let name = format!("{structure}.{}", String::from_utf8_lossy(&name[..end]));
        let element = Element::read(&mut cursor, "a field")?;
        let mut inside = element.data;
        // An empty field has nothing at all.
        let matrix = match element.kind {
            Kind::Matrix if inside.left() > 0 => {
                let head = Head::read(&mut inside)?;
                one(&head, inside, &name)
            }
            _ => Err(FormatError::whole("a matrix of numbers", "nothing")),
        };
        matrices.push(NamedMatrix::plain(name, matrix));
    }
    Ok(())
}
