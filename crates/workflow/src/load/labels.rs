//! Matrices whose rows have names: the files beside them, and one order for all.

use crate::error::{InputError, Place};
use crate::reads::Reads;
use frfit_formats::{
    CoordinateMatrix, DofLabel, Entries, FileKind, FormatError, Labels, NamedMatrix, abaqus, ansys, detect,
    listed_labels, read_matrices, take_matrix, triplets,
};
use std::collections::{HashMap, HashSet};
use std::ffi::OsStr;
use std::path::{Path, PathBuf};

/// The file that names the rows of a matrix which does not name them itself, if it is there: `.dof` beside what CalculiX
/// writes, `.mapping` beside a Harwell–Boeing file of Ansys.
pub(super) fn names_beside(matrix: &Path, kind: FileKind) -> Option<PathBuf> {
    let endings: &[&str] = match kind {
        FileKind::Triplets => &["dof"],
        FileKind::HarwellBoeing => &["mapping", "MAPPING"],
        _ => &[],
    };
    let beside = endings.iter().map(|ending| matrix.with_extension(ending));
    beside.into_iter().find(|path| path.extension() != matrix.extension() && path.is_file())
}

/// The files beside one that may name its rows, whatever it is.
pub(crate) fn files_beside(matrix: &Path) -> Vec<PathBuf> {
    let kinds = [FileKind::Triplets, FileKind::HarwellBoeing];
    kinds.into_iter().filter_map(|kind| names_beside(matrix, kind)).collect()
}

/// The names of rows in a file of this kind, one for each row of the matrix.
pub(super) fn read_names(kind: FileKind, bytes: &[u8], rows: usize) -> Result<Labels, FormatError> {
    let labels = match kind {
        FileKind::HarwellBoeing => ansys::read_mapping(bytes)?,
        _ => triplets::read_dofs(bytes)?,
    };
    match labels.len() == rows {
        true => Ok(Labels::of_rows(labels)),
        false => {
            let expected = format!("{rows} names, one for each row of the matrix beside it");
            Err(FormatError::whole(expected, labels.len().to_string()))
        }
    }
}

/// All matrices of a file with the names of their rows, of the file itself or of the one beside it.
///
/// # Errors
/// What either reader refuses; a file that names more or fewer rows than there are.
pub(crate) fn matrices_of(
    path: &Path,
    bytes: &[u8],
    reads: &mut Reads,
) -> Result<Vec<NamedMatrix>, InputError> {
    let mut all = read_matrices(bytes).map_err(|error| InputError::in_file(path, error))?;
    let beside = detect(bytes).and_then(|kind| Some((kind, names_beside(path, kind)?)));
    if let (Some((kind, names)), [NamedMatrix { matrix: Ok(matrix), labels, .. }]) = (beside, &mut all[..]) {
        let read = super::files::load_bytes(&names, reads)?;
        *labels =
            read_names(kind, &read, matrix.nrows).map_err(|error| InputError::in_file(&names, error))?;
    }
    Ok(all)
}

/// The name of the file beside another, as a case would give it.
pub(super) fn sibling(name: &str, path: &Path) -> String {
    let ending = path.extension().and_then(OsStr::to_str).unwrap_or_default();
    Path::new(name).with_extension(ending).to_string_lossy().into_owned()
}

/// A matrix of a model.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Member<'a> {
    pub(crate) matrix: &'a CoordinateMatrix,
    pub(crate) labels: &'a Labels,
    /// Whether it is a stiffness: what has no stiffness anywhere is no degree of freedom.
    pub(crate) is_stiffness: bool,
}

/// What each row of a model stands for, and where the rows of its matrices go.
#[derive(Debug)]
pub(crate) struct Order {
    pub(crate) labels: Vec<DofLabel>,
    /// Of each matrix the place of each row, none where it is held fixed; or none where all stay where they are.
    places: Vec<Option<Vec<Option<usize>>>>,
}

impl Order {
    /// The k-th matrix in this order; `None` where it is in it already.
    pub(crate) fn apply(
        &self,
        k: usize,
        matrix: &CoordinateMatrix,
    ) -> Option<Result<CoordinateMatrix, FormatError>> {
        self.places[k].as_ref().map(|places| matrix.renumbered(places, self.labels.len()))
    }
}

/// One order for matrices of which each names its rows: that of the first stiffness, then what other stiffnesses add.
/// What one of the files says is held fixed has no row. `None` where no matrix names its rows.
///
/// A matrix without names among others with names stands in their order where they all have the same.
///
/// # Errors
/// The matrix at fault, and what is wrong: names that no stiffness has; none where the others differ; a row that is
/// held fixed by a large number and cannot be left out, since nothing names the rows of the other matrices.
pub(crate) fn one_order(members: &[Member<'_>]) -> Result<Option<Order>, (usize, FormatError)> {
    let named = || members.iter().enumerate().filter(|(_, member)| !member.labels.rows.is_empty());
    for (k, member) in members.iter().enumerate().filter(|(_, member)| member.labels.rows.is_empty()) {
        if let Some(row) = held_by_a_large_number(member.matrix) {
            let expected = "no row that is held fixed by 1e36 on the diagonal (written with FORMAT=MATRIX INPUT, \
                            the names of such rows say which rows to leave out)";
            return Err((k, FormatError::whole(expected, format!("it in row {}", row + 1))));
        }
    }
    if named().next().is_none() {
        return Ok(None);
    }
    let fixed: HashSet<DofLabel> =
        named().flat_map(|(_, member)| member.labels.fixed.iter().copied()).collect();
    let any_stiffness = named().any(|(_, member)| member.is_stiffness);
    let mut place_of = HashMap::new();
    let mut labels = Vec::new();
    for (_, member) in named().filter(|(_, member)| member.is_stiffness || !any_stiffness) {
        for &label in member.labels.rows.iter().filter(|label| !fixed.contains(label)) {
            place_of.entry(label).or_insert_with(|| {
                labels.push(label);
                labels.len() - 1
            });
        }
    }
    let mut places = Vec::with_capacity(members.len());
    for (k, member) in members.iter().enumerate() {
        let rows = &member.labels.rows;
        if rows.is_empty() {
            let same = named().all(|(_, other)| other.labels.rows == labels) && fixed.is_empty();
            if !same {
                let expected = "names of its rows, as the other matrices have, which differ in them";
                return Err((k, FormatError::whole(expected, "none (no .dof or .mapping file beside it)")));
            }
            places.push(None);
            continue;
        }
        let unknown: Vec<_> =
            rows.iter().copied().filter(|l| !place_of.contains_key(l) && !fixed.contains(l)).collect();
        if !unknown.is_empty() {
            let found = format!("{} that none has: {}", unknown.len(), listed_labels(&unknown));
            return Err((k, FormatError::whole("rows that some stiffness has too, by their names", found)));
        }
        let to: Vec<_> = rows.iter().map(|label| place_of.get(label).copied()).collect();
        let stays = to.len() == labels.len() && to.iter().enumerate().all(|(k, place)| *place == Some(k));
        places.push((!stays).then_some(to));
    }
    Ok(Some(Order { labels, places }))
}

/// A row with Abaqus' mark of a degree of freedom that is held fixed.
fn held_by_a_large_number(matrix: &CoordinateMatrix) -> Option<usize> {
    let Entries::Real(values) = &matrix.entries else { return None };
    let mut entries = matrix.rows.iter().zip(&matrix.cols).zip(values);
    entries.find(|&((row, col), &value)| row == col && value == abaqus::FIXED).map(|((&row, _), _)| row)
}

/// The only matrix of a file, with the names of its rows.
///
/// # Errors
/// A file that cannot be read, that holds several matrices, or what the readers refuse.
pub(crate) fn load_one(path: &Path) -> Result<(CoordinateMatrix, Labels), InputError> {
    // Nothing is written of it.
    let mut reads = Reads::default();
    let bytes = super::files::load_bytes(path, &mut reads)?;
    let refuse = |error: FormatError| InputError::at(&Place::file(path), "a file of one matrix", error.found);
    let NamedMatrix { matrix, labels, .. } =
        take_matrix(matrices_of(path, &bytes, &mut reads)?, None).map_err(refuse)?;
    Ok((matrix.map_err(|error| InputError::in_file(path, error))?, labels))
}

#[cfg(test)]
mod tests {
    use super::*;
    use frfit_formats::Symmetry;

    /// The diagonal matrix of these numbers.
    fn diagonal(values: &[f64]) -> CoordinateMatrix {
        CoordinateMatrix {
            nrows: values.len(),
            ncols: values.len(),
            symmetry: Symmetry::Symmetric,
            rows: (0..values.len()).collect(),
            cols: (0..values.len()).collect(),
            entries: Entries::Real(values.to_vec()),
            title: String::new(),
        }
    }

    fn labels(nodes: &[i64]) -> Labels {
        Labels::of_rows(nodes.iter().map(|&node| DofLabel { node, component: 1 }).collect())
    }

    fn order(all: &[(CoordinateMatrix, Labels, bool)]) -> Result<Option<Order>, (usize, FormatError)> {
        let member = |one: &'_ (CoordinateMatrix, Labels, bool)| (one.2, one.0.clone(), one.1.clone());
        let owned: Vec<_> = all.iter().map(member).collect();
        let members: Vec<_> = owned
            .iter()
            .map(|(is_stiffness, matrix, labels)| Member { matrix, labels, is_stiffness: *is_stiffness })
            .collect();
        one_order(&members)
    }

    #[test]
    fn the_first_stiffness_gives_the_order_and_others_are_brought_to_it() {
        let mut first = labels(&[3, 1]);
        first.fixed = labels(&[9]).rows;
        let all = [
            (diagonal(&[30.0, 10.0]), first, true),
            (diagonal(&[0.1, 0.9, 0.3]), labels(&[1, 9, 3]), false),
            (diagonal(&[20.0, 11.0]), labels(&[2, 1]), true),
        ];
        let order = order(&all).unwrap().unwrap();
        assert_eq!(order.labels, labels(&[3, 1, 2]).rows);
        let values = |k: usize| match order.apply(k, &all[k].0) {
            Some(matrix) => {
                let matrix = matrix.unwrap();
                (matrix.rows, matrix.entries)
            }
            None => panic!("it was not in order"),
        };
        assert_eq!(values(0), (vec![0, 1], Entries::Real(vec![30.0, 10.0])));
        assert_eq!(values(1), (vec![0, 1], Entries::Real(vec![0.3, 0.1])));
        assert_eq!(values(2), (vec![1, 2], Entries::Real(vec![11.0, 20.0])));
    }

    #[test]
    fn what_is_in_order_stays_as_it_is() {
        let all = [
            (diagonal(&[1.0, 2.0]), labels(&[1, 2]), true),
            (diagonal(&[3.0, 4.0]), labels(&[1, 2]), false),
            (diagonal(&[3.0, 4.0]), Labels::default(), false),
        ];
        let order = order(&all).unwrap().unwrap();
        assert!((0..3).all(|k| order.apply(k, &all[k].0).is_none()));
        assert!(self::order(&all[2..]).unwrap().is_none());
    }

    #[test]
    fn names_that_do_not_fit_are_refused() {
        let k = || (diagonal(&[1.0, 2.0]), labels(&[1, 2]), true);
        let refused = |all: &[(CoordinateMatrix, Labels, bool)]| {
            let (at, error) = order(all).unwrap_err();
            (at, format!("expected {}, found {}", error.expected, error.found))
        };
        let mass = (diagonal(&[1.0; 6]), labels(&[1, 2, 4, 5, 6, 7]), false);
        let expected = "expected rows that some stiffness has too, by their names, found 4 that none has: 4+X, 5+X, 6+X and 1 more";
        assert_eq!(refused(&[k(), mass]), (1, expected.into()));
        let mass = (diagonal(&[1.0; 2]), labels(&[2, 1]), false);
        let (at, _) = refused(&[k(), mass, (diagonal(&[1.0; 2]), Labels::default(), false)]);
        assert_eq!(at, 2);
        let (at, message) = refused(&[(diagonal(&[1.0, 1e36]), Labels::default(), true)]);
        assert!(at == 0 && message.ends_with("found it in row 2"), "{message}");
    }
}
