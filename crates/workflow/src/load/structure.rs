//! The structure of a case: matrices, names of rows and what is attached.

use super::attached::terms as attached;
use super::dimension::{PartOf, at_nominal};
use super::dofs::Dofs;
use super::files::Files;
use super::model::{Terms, terms};
use crate::case::CaseFile;
use crate::error::InputError;
use frfit::model::Term;

/// The terms of a model, and the names of its rows.
pub(super) struct Structure {
    pub(super) terms: Vec<Term>,
    /// The matrix of the case that each is, or is part of; what is attached follows them.
    pub(super) of: Vec<PartOf>,
    pub(super) dofs: Dofs,
}

/// Reads matrices, factors, names of rows and what is attached. `keeps_dimensions`: a matrix that is given at several values of a dimension is one term for each
/// power of it, and else the matrix at its nominal value.
pub(super) fn structure(
    case: &CaseFile,
    keeps_dimensions: bool,
    files: &mut Files,
) -> Result<Structure, InputError> {
    let Terms { terms: all, of, labels } = terms(case, files)?;
    let mut terms = if keeps_dimensions { all } else { at_nominal(case, all, &of)? };
    let dim = terms.first().map_or(0, |term| term.matrix.dim());
    let dofs = Dofs::read(case.dofs.as_ref(), dim, &labels, case.units, files)?;
    terms.extend(attached(&case.attached, case.units, dim, &dofs)?);
    Ok(Structure { terms, of, dofs })
}
