//! Which parameters a model has.

use crate::c64;
use crate::material::OutsideTable;
use crate::model::{Combination, DynamicStiffness, WeightedTerm};

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
    /// The factors of some terms, in proportion to the parameter: a modulus (its loss factor stays), a density.
    Factor(Vec<usize>),
    /// The factors of some terms, in proportion to a power of the parameter (B-8): a geometric parameter, 3 for a thickness in bending.
    Powers(Vec<(usize, i32)>),
    /// The loss factors of some terms: the imaginary parts of their factors.
    LossFactor(Vec<usize>),
    /// The scale of a sensor's channel, which is not known: what it measures is in proportion.
    Scale(usize),
}

impl Variable {
    /// The factor of every term, and where it is complex its loss factor for itself; terms whose factor is zero have no logarithm and are left out.
    ///
    /// # Limits
    /// The imaginary parts of a matrix itself are multiplied by its factor.
    ///
    /// # Errors
    /// [`OutsideTable`] where a table does not reach a frequency.
    pub fn of_model(model: &DynamicStiffness, frequency_hz: &[f64]) -> Result<Vec<Self>, OutsideTable> {
        let each = model.terms().iter().enumerate().map(|(index, term)| (term.name.clone(), vec![index]));
        Self::of_matrices(model, &each.collect::<Vec<_>>(), frequency_hz)
    }

    /// The same where several terms are one matrix, with one factor: its name and its terms.
    ///
    /// # Errors
    /// [`OutsideTable`] where a table does not reach a frequency.
    ///
    /// # Panics
    /// Where a matrix has no term, or one that the model has not.
    pub fn of_matrices(
        model: &DynamicStiffness,
        matrices: &[(String, Vec<usize>)],
        frequency_hz: &[f64],
    ) -> Result<Vec<Self>, OutsideTable> {
        let mut variables = Vec::new();
        for (name, terms) in matrices {
            let factor = &model.terms()[terms[0]].factor;
            let factors = frequency_hz.iter().map(|&f| factor.at(f)).collect::<Result<Vec<c64>, _>>()?;
            if factors.iter().all(|factor| factor.norm() == 0.0) {
                continue;
            }
            variables.push(Self { name: name.clone(), change: Change::Factor(terms.clone()) });
            if factors.iter().any(|factor| factor.im != 0.0) {
                let name = format!("{name} loss factor");
                variables.push(Self { name, change: Change::LossFactor(terms.clone()) });
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
            Ok((model.weight(term.role, frequency_hz), model.factor(index, frequency_hz)?))
        };
        let parts = match &self.change {
            Change::Factor(terms) => {
                let part = |&index: &usize| {
                    let (weight, factor) = term(index)?;
                    Ok(WeightedTerm { term: index, weight: weight * factor })
                };
                terms.iter().map(part).collect::<Result<_, OutsideTable>>()?
            }
            Change::Powers(terms) => {
                let part = |&(index, power): &(usize, i32)| {
                    let (weight, factor) = term(index)?;
                    Ok(WeightedTerm { term: index, weight: f64::from(power) * weight * factor })
                };
                terms.iter().map(part).collect::<Result<_, OutsideTable>>()?
            }
            Change::LossFactor(terms) => {
                let part = |&index: &usize| {
                    let (weight, factor) = term(index)?;
                    Ok(WeightedTerm { term: index, weight: weight * c64::new(0.0, factor.im) })
                };
                terms.iter().map(part).collect::<Result<_, OutsideTable>>()?
            }
            Change::Scale(_) => Vec::new(),
        };
        Ok(Combination { parts })
    }
}
