//! A variable: its flags, dimensions and name, and what it is.

use super::head::{Head, SPARSE, STRUCTURE};
use super::matrix;
use super::stream::{Kind, Stream};
use crate::{FormatError, NamedMatrix};

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
