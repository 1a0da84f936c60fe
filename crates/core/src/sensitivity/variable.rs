//! Which parameters a model has.

use crate::c64;
use crate::material::OutsideTable;
use crate::model::{Combination, DynamicStiffness, Member};

/// A real parameter of a model, by whose logarithm is differentiated.
#[derive(Debug, Clone, PartialEq)]
pub struct Variable {
    /// What it is called in tables.
    pub name: String,
    /// What it changes.
    pub change: Change,
}

/// What a parameter changes.
#[derive(Debug, Clone, PartialEq)]
pub enum Change {
    /// The factors of some terms, in proportion to a power of the parameter: 1 for a modulus (its loss factor stays), 3 for a thickness in bending.
    Factor(Vec<Member>),
    /// The loss factors of some terms: the imaginary parts of their factors.
    LossFactor(Vec<usize>),
    /// The scale of a sensor's channel, which is not known: what it measures is in proportion.
    Scale(usize),
}

impl Variable {
    /// The factor of every term, and where it is complex its loss factor for itself; terms whose factor is zero have no logarithm and are left out.
    ///
    /// # Limits
    /// What a matrix has of its own in imaginary parts goes with its factor.
    ///
    /// # Errors
    /// [`OutsideTable`] where a table does not reach a frequency.
    pub fn of_model(model: &DynamicStiffness, frequency_hz: &[f64]) -> Result<Vec<Self>, OutsideTable> {
        let mut variables = Vec::new();
        for (index, term) in model.terms().iter().enumerate() {
            let factors = frequency_hz.iter().map(|&f| term.factor.at(f)).collect::<Result<Vec<c64>, _>>()?;
            if factors.iter().all(|factor| factor.norm() == 0.0) {
                continue;
            }
            let factor = Change::Factor(vec![Member { term: index, power: 1 }]);
            variables.push(Self { name: term.name.clone(), change: factor });
            if factors.iter().any(|factor| factor.im != 0.0) {
                let name = format!("{} loss factor", term.name);
                variables.push(Self { name, change: Change::LossFactor(vec![index]) });
            }
        }
        Ok(variables)
    }

    /// ∂D/∂ln p at a frequency; nothing for the scale of a channel.
    ///
    /// # Errors
    /// [`OutsideTable`] where a table does not reach this frequency.
    pub fn derivative(
        &self,
        model: &DynamicStiffness,
        frequency_hz: f64,
    ) -> Result<Combination, OutsideTable> {
        let term = |index: usize| -> Result<(c64, c64), OutsideTable> {
            let term = &model.terms()[index];
            Ok((term.role.weight(frequency_hz), term.factor.at(frequency_hz)?))
        };
        let parts = match &self.change {
            Change::Factor(members) => {
                let part = |member: &Member| {
                    let (weight, factor) = term(member.term)?;
                    Ok((member.term, member.power as f64 * weight * factor))
                };
                members.iter().map(part).collect::<Result<_, OutsideTable>>()?
            }
            Change::LossFactor(terms) => {
                let part = |&index: &usize| {
                    let (weight, factor) = term(index)?;
                    Ok((index, weight * c64::new(0.0, factor.im)))
                };
                terms.iter().map(part).collect::<Result<_, OutsideTable>>()?
            }
            Change::Scale(_) => Vec::new(),
        };
        Ok(Combination { parts })
    }
}
