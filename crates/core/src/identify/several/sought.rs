//! What is looked for when several things are.

use super::super::Options;
use crate::c64;
use crate::laws::Family;
use crate::material::{Law, OutsideTable};
use crate::model::{DynamicStiffness, ModelAt, ParameterAt};
use crate::roots::Bounds;

/// How an unknown varies over the band.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Vary {
    /// A value of its own at every frequency.
    PerFrequency,
    /// One value for the band.
    Constant,
    /// A law with so many parameters.
    Law(Family),
}

/// How an unknown p enters the terms of a model.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Enters {
    /// In place of the factor of these terms: a modulus, a density.
    Factor(Vec<usize>),
    /// The factors of these terms are multiplied by p^d, (term, d), d positive or negative (B-8): a dimension. A plate's thickness enters bending with 3, membrane and
    /// mass with 1; a bar's length its stiffness with −1 and its mass with 1.
    Powers(Vec<(usize, i32)>),
}

/// One unknown of several.
///
/// A term may have one unknown in place of its factor, and be multiplied by any number of others: E h³ of a plate in bending.
#[derive(Debug, Clone, PartialEq)]
pub struct Sought {
    /// What it is called.
    pub name: String,
    /// How it enters.
    pub enters: Enters,
    /// Where to begin.
    pub nominal: Law,
    /// How it varies.
    pub varies: Vary,
    /// Whether it is real; a law is not.
    pub real: bool,
    /// What is known about it beforehand.
    pub bounds: Bounds,
}

impl Sought {
    /// Real numbers that it has at each frequency: two, one, or none of its own.
    pub fn per_frequency(&self) -> usize {
        match (self.varies, self.real) {
            (Vary::PerFrequency, true) => 1,
            (Vary::PerFrequency, false) => 2,
            _ => 0,
        }
    }

    /// Real numbers that it has for the band.
    pub fn for_band(&self) -> usize {
        match (self.varies, self.real) {
            (Vary::PerFrequency, _) => 0,
            (Vary::Constant, true) => 1,
            (Vary::Constant, false) => 2,
            (Vary::Law(family), _) => family.count(),
        }
    }

    /// [low, high] of the real part in which it is looked for about a nominal value.
    pub(super) fn range(&self, nominal: c64) -> [f64; 2] {
        let options = Options { bounds: self.bounds, ..Options::default() };
        let about = options.box_about(nominal);
        // A value of zero has no neighbourhood of its own, and nothing bounds it: the caller's nominal is then all there is.
        let [low, high] = about.unwrap_or([nominal.re, nominal.re]);
        match self.enters {
            Enters::Factor(_) => [low, high],
            // A dimension is known better than a modulus: by drawing.
            Enters::Powers(_) if nominal.re > 0.0 => {
                [low.max(nominal.re / DIMENSION), high.min(nominal.re * DIMENSION)]
            }
            Enters::Powers(_) => [low, high],
        }
    }
}

/// By how much a dimension may be off.
const DIMENSION: f64 = 2.0;

/// A model with several unknowns in it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Composite<'a> {
    pub(super) model: &'a DynamicStiffness,
    pub(super) sought: &'a [Sought],
}

impl<'a> Composite<'a> {
    /// D at these values of the unknowns, and the first derivative by each as its only coefficient: exact for small changes, and for any change of one that
    /// stands in place of a factor.
    pub(super) fn at(&self, frequency_hz: f64, values: &[c64]) -> Result<ModelAt<'a>, OutsideTable> {
        let mut at = ModelAt {
            model: self.model,
            frequency_hz,
            nominal: Default::default(),
            parameters: values
                .iter()
                .map(|&nominal| ParameterAt { nominal, coefficients: vec![Default::default()] })
                .collect(),
        };
        for (index, term) in self.model.terms().iter().enumerate() {
            let replaced = self
                .sought
                .iter()
                .position(|one| matches!(&one.enters, Enters::Factor(terms) if terms.contains(&index)));
            let own = match replaced {
                Some(j) => values[j],
                None => term.factor.at(frequency_hz)?,
            };
            let mut multiplied = term.role.weight(frequency_hz);
            let powers = self.sought.iter().enumerate().filter_map(|(j, one)| match &one.enters {
                Enters::Powers(all) => Some((j, all.iter().find(|(term, _)| *term == index)?.1)),
                Enters::Factor(_) => None,
            });
            let powers: Vec<(usize, i32)> = powers.collect();
            for &(j, power) in &powers {
                multiplied *= values[j].powi(power);
            }
            at.nominal.parts.push((index, own * multiplied));
            if let Some(j) = replaced {
                at.parameters[j].coefficients[0].parts.push((index, multiplied));
            }
            for (j, power) in powers {
                let slope = f64::from(power) * own * multiplied / values[j];
                at.parameters[j].coefficients[0].parts.push((index, slope));
            }
        }
        Ok(at)
    }

    /// The nominal values at a frequency.
    pub(super) fn nominal(&self, frequency_hz: f64) -> Result<Vec<c64>, OutsideTable> {
        self.sought.iter().map(|one| one.nominal.at(frequency_hz)).collect()
    }
}
