//! Files of several matrices, each with a name.

use crate::{CoordinateMatrix, FormatError, Labels};

/// A matrix of a file that may hold several.
#[derive(Debug, Clone, PartialEq)]
pub struct NamedMatrix {
    /// Its name in the file; empty where the format has none.
    pub name: String,
    /// The matrix, or why the data of this name are no matrix. The rest of the file is sound either way.
    pub matrix: Result<CoordinateMatrix, FormatError>,
    /// What its rows and columns stand for, as far as the file says.
    pub labels: Labels,
}

impl NamedMatrix {
    /// Without labels.
    pub(crate) fn plain(name: impl Into<String>, matrix: Result<CoordinateMatrix, FormatError>) -> Self {
        Self { name: name.into(), matrix, labels: Labels::default() }
    }

    /// Name and size, or what else it is, as an error lists it: `K (3 x 3)`.
    fn described(&self) -> String {
        match &self.matrix {
            Ok(matrix) => format!("{} ({} x {})", self.name, matrix.nrows, matrix.ncols),
            Err(error) => format!("{} ({})", self.name, error.found),
        }
    }
}

/// The matrix of a name, or without one the only matrix. What has the name may still be none ([`NamedMatrix::matrix`]).
///
/// # Errors
/// No matrix of the name, or several that it could be: what there is, with sizes.
pub fn choose_matrix<'a>(
    matrices: &'a [NamedMatrix],
    name: Option<&str>,
) -> Result<&'a NamedMatrix, FormatError> {
    chosen(matrices, name).map(|k| &matrices[k])
}

/// As [`choose_matrix`], for who needs nothing else of the file: matrices are large, so it is moved, not cloned.
///
/// # Errors
/// As [`choose_matrix`].
pub fn take_matrix(mut matrices: Vec<NamedMatrix>, name: Option<&str>) -> Result<NamedMatrix, FormatError> {
    chosen(&matrices, name).map(|k| matrices.swap_remove(k))
}

/// Which of them it is.
fn chosen(matrices: &[NamedMatrix], name: Option<&str>) -> Result<usize, FormatError> {
    let all = || 0..matrices.len();
    let unnamed = matrices.iter().any(|entry| entry.name.is_empty());
    let (chosen, expected): (Vec<_>, _) = match name {
        Some(_) if unnamed => {
            return Err(FormatError::whole(
                "no name beside a file that names no matrix",
                name.unwrap_or_default(),
            ));
        }
        Some(name) => {
            (all().filter(|&k| matrices[k].name == name).collect(), format!("one matrix named {name:?}"))
        }
        None => (all().collect(), "one matrix, or a name: { file = \"...\", name = \"...\" }".into()),
    };
    match chosen.as_slice() {
        [one] => Ok(*one),
        _ => Err(FormatError::whole(expected, listed(matrices))),
    }
}

/// What a file holds, as an error lists it.
fn listed(matrices: &[NamedMatrix]) -> String {
    const MAX_SHOWN: usize = 12;
    if matrices.is_empty() {
        return "none".into();
    }
    let shown: Vec<_> = matrices.iter().take(MAX_SHOWN).map(NamedMatrix::described).collect();
    let more = if matrices.len() > MAX_SHOWN {
        format!(" and {} more", matrices.len() - MAX_SHOWN)
    } else {
        String::new()
    };
    format!("{}{more}", shown.join(", "))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Entries, Symmetry};

    fn named(name: &str, n: usize) -> NamedMatrix {
        let matrix = CoordinateMatrix {
            nrows: n,
            ncols: n,
            symmetry: Symmetry::General,
            rows: Vec::new(),
            cols: Vec::new(),
            entries: Entries::Real(Vec::new()),
            title: String::new(),
        };
        NamedMatrix::plain(name, Ok(matrix))
    }

    #[test]
    fn a_name_chooses_and_a_missing_one_lists_what_there_is() {
        let text = NamedMatrix::plain("note", Err(FormatError::whole("a matrix", "a text")));
        let all = [named("K", 3), named("M", 2), text];
        assert_eq!(choose_matrix(&all, Some("M")).unwrap(), &all[1]);
        assert_eq!(take_matrix(all.to_vec(), Some("M")).unwrap(), all[1]);
        let message = |name| choose_matrix(&all, name).unwrap_err().to_string();
        assert_eq!(
            message(None),
            "input: expected one matrix, or a name: { file = \"...\", name = \"...\" }, \
             found K (3 x 3), M (2 x 2), note (a text)"
        );
        assert_eq!(
            message(Some("C")),
            "input: expected one matrix named \"C\", found K (3 x 3), M (2 x 2), note (a text)"
        );
        assert_eq!(choose_matrix(&all, Some("note")).unwrap(), &all[2]);
    }

    #[test]
    fn the_only_matrix_needs_no_name_and_one_without_a_name_has_none() {
        assert_eq!(choose_matrix(&[named("K", 3)], None), Ok(&named("K", 3)));
        assert_eq!(choose_matrix(&[named("", 3)], None), Ok(&named("", 3)));
        let message = choose_matrix(&[named("", 3)], Some("K")).unwrap_err().to_string();
        assert_eq!(message, "input: expected no name beside a file that names no matrix, found K");
        let twice = [named("K", 3), named("K", 2)];
        let message = choose_matrix(&twice, Some("K")).unwrap_err().to_string();
        assert_eq!(message, "input: expected one matrix named \"K\", found K (3 x 3), K (2 x 2)");
        assert!(choose_matrix(&[], None).unwrap_err().to_string().ends_with("found none"));
    }
}
