//! The model at one frequency, as a polynomial in its parameters' corrections.

use super::{DynamicStiffness, Parameter, Role, Term};
use crate::c64;
use crate::material::OutsideTable;

/// A term of a model with a weight.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WeightedTerm {
    /// Its index.
    pub term: usize,
    /// What its matrix is multiplied by.
    pub weight: c64,
}

/// Σ weight · matrix over some terms of a model.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Combination {
    /// The terms.
    pub parts: Vec<WeightedTerm>,
}

impl Combination {
    /// out += (this combination) x.
    pub fn multiply_add(&self, model: &DynamicStiffness, factor: c64, x: &[c64], out: &mut [c64]) {
        for &WeightedTerm { term, weight } in &self.parts {
            model.terms()[term].matrix.multiply_add(factor * weight, x, out);
        }
    }

    /// values += factor · (this combination's entries on the model's pattern).
    pub fn accumulate_into(&self, model: &DynamicStiffness, factor: c64, values: &mut [c64]) {
        for &WeightedTerm { term, weight } in &self.parts {
            model.terms()[term].matrix.accumulate_into(factor * weight, values);
        }
    }
}

/// One parameter at one frequency.
#[derive(Debug, Clone, PartialEq)]
pub struct ParameterAt {
    /// Its nominal value p̄.
    pub nominal: c64,
    /// A_1 … A_d, the coefficients of c … c^d with p = p̄ + c.
    pub coefficients: Vec<Combination>,
}

impl ParameterAt {
    /// Whether it enters a term of the model.
    pub(crate) fn enters(&self, term: usize) -> bool {
        self.coefficients.iter().flat_map(|c| &c.parts).any(|own| own.term == term)
    }
}

/// D(c) = A₀ + Σ_j Σ_q c_j^q A_{j,q} at one frequency, P-10 and B-8.
#[derive(Debug, Clone)]
pub struct ModelAt<'m> {
    /// The model that the combinations refer to.
    pub model: &'m DynamicStiffness,
    /// The frequency.
    pub frequency_hz: f64,
    /// A₀: everything at its nominal value.
    pub nominal: Combination,
    /// What may change.
    pub parameters: Vec<ParameterAt>,
}

impl DynamicStiffness {
    /// The model at one frequency, expanded about the nominal values of the parameters.
    ///
    /// # Errors
    /// [`OutsideTable`] where a table does not reach this frequency.
    pub fn at<'m>(
        &'m self,
        frequency_hz: f64,
        parameters: &[Parameter],
    ) -> Result<ModelAt<'m>, OutsideTable> {
        let mut nominal = Combination::default();
        let unknown = |term| parameters.iter().any(|p| p.members.iter().any(|member| member.term == term));
        for (index, term) in self.terms().iter().enumerate().filter(|&(index, _)| !unknown(index)) {
            let weight = self.weight(term.role, frequency_hz) * self.factor(index, frequency_hz)?;
            nominal.parts.push(WeightedTerm { term: index, weight });
        }
        let mut expanded = Vec::with_capacity(parameters.len());
        for parameter in parameters {
            let value = parameter.nominal.at_laplace(frequency_hz, self.decay_per_s())?;
            let degree = parameter.members.iter().map(|member| member.power).max().unwrap_or(0);
            let mut coefficients = vec![Combination::default(); degree];
            for member in &parameter.members {
                let term = &self.terms()[member.term];
                let mut weight = self.weight(term.role, frequency_hz);
                if parameter.multiplies {
                    weight *= self.factor(member.term, frequency_hz)?;
                }
                // (p̄ + c)^d = Σ_q binomial(d, q) p̄^{d−q} c^q
                let of_nominal = weight * value.powu(member.power as u32);
                nominal.parts.push(WeightedTerm { term: member.term, weight: of_nominal });
                let mut binomial = 1.0;
                for q in 1..=member.power {
                    binomial *= (member.power + 1 - q) as f64 / q as f64;
                    let coefficient = binomial * value.powu((member.power - q) as u32);
                    coefficients[q - 1]
                        .parts
                        .push(WeightedTerm { term: member.term, weight: weight * coefficient });
                }
            }
            expanded.push(ParameterAt { nominal: value, coefficients });
        }
        Ok(ModelAt { model: self, frequency_hz, nominal, parameters: expanded })
    }

    /// As [`Self::at`], at every frequency of a band.
    ///
    /// # Errors
    /// [`OutsideTable`] where a table does not reach a frequency.
    pub fn at_all<'m>(
        &'m self,
        frequency_hz: &[f64],
        parameters: &[Parameter],
    ) -> Result<Vec<ModelAt<'m>>, OutsideTable> {
        frequency_hz.iter().map(|&f| self.at(f, parameters)).collect()
    }
}

impl ModelAt<'_> {
    /// Whether an unknown enters a term.
    pub(crate) fn is_unknown(&self, term: usize) -> bool {
        self.parameters.iter().any(|parameter| parameter.enters(term))
    }

    /// The terms that an unknown enters, with their numbers.
    pub(crate) fn terms_of(&self, unknown: usize) -> impl Iterator<Item = (usize, &Term)> {
        let is_entered = move |(term, _): &(usize, &Term)| self.parameters[unknown].enters(*term);
        self.model.terms().iter().enumerate().filter(is_entered)
    }

    /// Whether an unknown enters stiffness alone.
    pub(crate) fn is_stiffness(&self, unknown: usize) -> bool {
        self.terms_of(unknown).all(|(_, term)| term.role == Role::Stiffness)
    }

    /// The entries of D(c) on the model's pattern; `corrections[j]` is c_j.
    ///
    /// # Panics
    /// Where there is not one correction for each parameter.
    pub fn assemble(&self, corrections: &[c64]) -> Vec<c64> {
        assert_eq!(corrections.len(), self.parameters.len());
        let mut values = vec![c64::default(); self.model.analysis().pattern().stored()];
        self.nominal.accumulate_into(self.model, c64::new(1.0, 0.0), &mut values);
        for (parameter, &c) in self.parameters.iter().zip(corrections) {
            let mut power = c64::new(1.0, 0.0);
            for coefficient in &parameter.coefficients {
                power *= c;
                coefficient.accumulate_into(self.model, power, &mut values);
            }
        }
        values
    }
}
