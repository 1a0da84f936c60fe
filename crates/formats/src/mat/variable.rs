//! A variable: its flags, dimensions and name, and what it is.

use super::matrix;
use super::stream::{Kind, Stream};
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
    fn read(stream: &mut Stream<'_>) -> Result<Self, FormatError> {
        let place = stream.place();
        let flags = stream.wholes("the flags of a variable")?.unwrap_or_default();
        let flags =
            *flags.first().ok_or_else(|| FormatError::byte(place, "the flags of a variable", "none"))?;
        // Of an object of MATLAB's own kind (opaque) nothing more is as it is of others.
        let class = (flags & 0xFF) as u8;
        if class == 17 {
            return Ok(Self { class, is_complex: false, dimensions: Vec::new(), name: String::new() });
        }
        let place = stream.place();
        let dimensions = stream.wholes("the dimensions of a variable")?;
        let dimensions = dimensions.filter(|sizes| sizes.len() >= 2).ok_or_else(|| {
            FormatError::byte(place, "the dimensions of a variable, at least two whole numbers", "others")
        })?;
        let name = stream.text("the name of a variable")?;
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
/// Parts that end beyond the variable, so that it cannot be read.
pub(super) fn read(stream: &mut Stream<'_>, matrices: &mut Vec<NamedMatrix>) -> Result<(), FormatError> {
    if stream.left() == 0 {
        return Ok(());
    }
    let head = Head::read(stream)?;
    // What MATLAB saves for itself, such as the insides of objects, has no name.
    if head.name.is_empty() {
        return Ok(());
    }
    if head.class == STRUCTURE && head.dimensions.iter().all(|&size| size == 1) {
        return fields(&head.name, stream, matrices);
    }
    matrices.push(NamedMatrix::plain(head.name.as_str(), one(&head, stream, &head.name)));
    Ok(())
}

/// A variable that is a matrix.
fn one(head: &Head, stream: &mut Stream<'_>, name: &str) -> Result<crate::CoordinateMatrix, FormatError> {
    match (head.class, head.dimensions.as_slice()) {
        (SPARSE, &[nrows, ncols]) => matrix::sparse(head, stream, [nrows, ncols], name),
        (6..=15, &[nrows, ncols]) => matrix::full(head, stream, [nrows, ncols], name),
        _ => Err(FormatError::whole("a matrix of numbers", head.other())),
    }
}

/// The fields of a structure.
fn fields(
    structure: &str,
    stream: &mut Stream<'_>,
    matrices: &mut Vec<NamedMatrix>,
) -> Result<(), FormatError> {
    const LENGTH: &str = "the length of a field's name";
    let place = stream.place();
    let length = stream.wholes(LENGTH)?.and_then(|lengths| lengths.first().copied());
    let length = length.and_then(|length| usize::try_from(length).ok()).filter(|length| *length > 0);
    let length = length.ok_or_else(|| FormatError::byte(place, LENGTH, "none"))?;
    let names = stream.bytes("the names of fields")?;
    for name in names.chunks_exact(length) {
        let end = name.iter().position(|&byte| byte == 0).unwrap_or(name.len());
        let name = format!("{structure}.{}", String::from_utf8_lossy(&name[..end]));
        let tag = stream.tag("a field")?;
        // What is wrong with one field leaves the others as they are.
        let mut matrix = Err(FormatError::whole("a matrix of numbers", "nothing"));
        stream.inside(tag, |inside| {
            // An empty field has nothing at all.
            if tag.kind == Kind::Matrix && inside.left() > 0 {
                let head = Head::read(inside)?;
                matrix = one(&head, inside, &name);
            }
            Ok(())
        })?;
        matrices.push(NamedMatrix::plain(name, matrix));
    }
    Ok(())
}
