//! What is unknown in a model.

use super::{DynamicStiffness, ModelError};
use crate::material::Law;

/// A term that a parameter enters, and with which power.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Member {
    /// Index of the term in the model.
    pub term: usize,
    /// Power p ≥ 1 of the parameter in front of the term's matrix (B-8): 1 for a modulus, 3 for a plate's
    /// thickness in bending.
    pub power: usize,
}

/// An unknown factor: it stands in front of the matrices of its members, in place of their own factors or beside them.
///
/// Several matrices may share one; each term may belong to one parameter.
#[derive(Debug, Clone, PartialEq)]
pub struct Parameter {
    /// The terms that it enters.
    pub members: Vec<Member>,
    /// Its nominal value over frequency; the correction c is counted from it, P-35.
    pub nominal: Law,
    /// Whether it multiplies the members' own factors (a geometric parameter), in place of standing for them (a modulus).
    pub multiplies: bool,
}

impl Parameter {
    /// The common factor of the named terms; its nominal is the factor of the first of them.
    ///
    /// # Errors
    /// [`ModelError::UnknownName`] for a name that no term has, [`ModelError::Empty`] for no name.
    pub fn factor_of(model: &DynamicStiffness, names: &[&str]) -> Result<Self, ModelError> {
        let terms = names.iter().map(|name| model.find(name)).collect::<Result<Vec<_>, _>>()?;
        let first = *terms.first().ok_or(ModelError::Empty)?;
        Ok(Self {
            members: terms.into_iter().map(|term| Member { term, power: 1 }).collect(),
            nominal: model.terms()[first].factor.clone(),
            multiplies: false,
        })
    }
}
