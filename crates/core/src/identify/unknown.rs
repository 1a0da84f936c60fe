//! The unknowns of an identification.

use crate::c64;
use crate::laws::LawKind;
use crate::material::{Law, OutsideTable};
use crate::model::{DynamicStiffness, Member, ModelAt, ModelError, Parameter, ParameterAt, WeightedTerm};
use crate::roots::{Bounds, RootOptions};

/// Nominal values further off are estimates of another kind: `whole_box`.
pub(super) const NEAR_BOX_RATIO: f64 = 4.0;

/// How an unknown varies over the band.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub enum Variation {
    /// A value of its own at every frequency.
    PerFrequency,
    /// A smooth function of frequency, no smoother than the data say (B-9).
    Smooth,
    /// One value for the band.
    Constant,
    /// The law of least BIC among these (B-7).
    Law(Vec<LawKind>),
}

impl Variation {
    /// One law.
    pub fn law(kind: LawKind) -> Self {
        Self::Law(vec![kind])
    }
}

/// How an unknown p enters the terms of a model.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Dependence {
    /// In place of the factor of these terms: a modulus, a density.
    Factor(Vec<usize>),
    /// The factors of these terms are multiplied by p^d, (term, d), d positive or negative (B-8): a geometric parameter. A plate's thickness enters bending with 3, membrane and
    /// mass with 1; a bar's length its stiffness with −1 and its mass with 1.
    Powers(Vec<(usize, i32)>),
}

impl Dependence {
    /// The terms that it enters, by their index.
    pub fn terms(&self) -> impl Iterator<Item = usize> + '_ {
        let (factors, powers) = match self {
            Self::Factor(terms) => (terms.as_slice(), [].as_slice()),
            Self::Powers(powers) => ([].as_slice(), powers.as_slice()),
        };
        factors.iter().copied().chain(powers.iter().map(|(term, _)| *term))
    }
}

/// An unknown of a problem.
///
/// A term may have one unknown in place of its factor, and be multiplied by any number of others: E h³ of a plate in bending.
#[derive(Debug, Clone, PartialEq)]
pub struct Unknown {
    /// What it is called.
    pub name: String,
    /// How it enters.
    pub dependence: Dependence,
    /// Where to begin.
    pub nominal: Law,
    /// How it varies.
    pub varies: Variation,
    /// Whether it is real; a law is not.
    pub real: bool,
    /// What is known about it beforehand.
    pub bounds: Bounds,
}

impl Unknown {
    /// Real numbers that it has at each frequency: two, one, or none of its own.
    pub fn per_frequency(&self) -> usize {
        match (&self.varies, self.real) {
            (Variation::PerFrequency, true) => 1,
            (Variation::PerFrequency, false) => 2,
            _ => 0,
        }
    }

    /// Whether it has a value at each frequency, free or along a smooth curve.
    pub(super) fn is_curve(&self) -> bool {
        matches!(self.varies, Variation::PerFrequency | Variation::Smooth)
    }

    /// The same, free at every frequency where it is smooth.
    pub(super) fn freed(&self) -> Self {
        match self.varies {
            Variation::Smooth => Self { varies: Variation::PerFrequency, ..self.clone() },
            _ => self.clone(),
        }
    }

    /// Real numbers that it has for the band.
    pub fn for_band(&self) -> usize {
        match (&self.varies, self.real) {
            (Variation::PerFrequency, _) => 0,
            (Variation::Constant, true) => 1,
            (Variation::Constant, false) => 2,
            // A smooth one has as many as the data say.
            (Variation::Smooth, _) => 0,
            (Variation::Law(kinds), _) => kinds.iter().map(|kind| kind.count()).min().unwrap_or(0),
        }
    }

    /// The common factor of the named terms, nominally that of the first of them, with a value at each frequency.
    ///
    /// # Errors
    /// [`ModelError::UnknownName`] for a name that no term has, [`ModelError::Empty`] for no name.
    pub fn factor_of(model: &DynamicStiffness, names: &[&str]) -> Result<Self, ModelError> {
        let terms = names.iter().map(|name| model.find(name)).collect::<Result<Vec<_>, _>>()?;
        let first = *terms.first().ok_or(ModelError::Empty)?;
        Ok(Self {
            name: names.join(", "),
            dependence: Dependence::Factor(terms),
            nominal: model.terms()[first].factor.clone(),
            varies: Variation::PerFrequency,
            real: false,
            bounds: Bounds::default(),
        })
    }

    /// A parameter as an unknown without bounds, with a value at each frequency.
    pub fn of_parameter(parameter: &Parameter) -> Self {
        let members = &parameter.members;
        let dependence = match parameter.multiplies {
            false => Dependence::Factor(members.iter().map(|member| member.term).collect()),
            true => {
                Dependence::Powers(members.iter().map(|member| (member.term, member.power as i32)).collect())
            }
        };
        Self {
            name: String::from("p"),
            dependence,
            nominal: parameter.nominal.clone(),
            varies: Variation::PerFrequency,
            real: false,
            bounds: Bounds::default(),
        }
    }

    /// It as the parameter of a polynomial, P-10 and B-8; `None` of one with a negative power.
    pub fn parameter(&self) -> Option<Parameter> {
        let member = |(term, power): (usize, i32)| Some(Member { term, power: usize::try_from(power).ok()? });
        let (members, multiplies) = match &self.dependence {
            Dependence::Factor(terms) => (terms.iter().map(|&term| member((term, 1))).collect(), false),
            Dependence::Powers(powers) => (powers.iter().copied().map(member).collect(), true),
        };
        let members: Option<Vec<Member>> = members;
        Some(Parameter { members: members?, nominal: self.nominal.clone(), multiplies })
    }

    /// [low, high] of the real part in which it is searched about a nominal value: the bounds, or what a nominal is off at most, as far as they are within a ratio of
    /// it. `None` where nothing bounds it.
    pub(crate) fn box_about(&self, nominal: c64, ratio: f64) -> Option<[f64; 2]> {
        if nominal.re <= 0.0 {
            return self.bounds.storage;
        }
        let [low, high] =
            self.bounds.storage.unwrap_or([nominal.re / MAX_BOX_RATIO, nominal.re * MAX_BOX_RATIO]);
        // A nominal outside the bounds: the box is where they begin.
        let middle = nominal.re.clamp(low, high);
        Some([low.max(middle / ratio), high.min(middle * ratio)])
    }

    /// How its roots are accepted.
    pub(super) fn roots(&self) -> RootOptions {
        RootOptions { bounds: self.bounds, real: self.real }
    }

    /// [low, high] of the real part in which it is searched about a nominal value, beside other unknowns.
    pub(crate) fn range(&self, nominal: c64) -> [f64; 2] {
        let about = self.box_about(nominal, NEAR_BOX_RATIO);
        // A value of zero has no neighbourhood of its own, and nothing bounds it: the caller's nominal is then all there is.
        let [low, high] = about.unwrap_or([nominal.re, nominal.re]);
        match self.dependence {
            Dependence::Factor(_) => [low, high],
            // A geometric parameter is known better than a modulus: by drawing.
            Dependence::Powers(_) if nominal.re > 0.0 => {
                [low.max(nominal.re / MAX_DIMENSION_RATIO), high.min(nominal.re * MAX_DIMENSION_RATIO)]
            }
            Dependence::Powers(_) => [low, high],
        }
    }
}

/// Without bounds a nominal modulus is off by no more than this factor: more is a mistaken unit.
const MAX_BOX_RATIO: f64 = 30.0;

/// By how much a geometric parameter may be off.
const MAX_DIMENSION_RATIO: f64 = 2.0;

/// A model with several unknowns in it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Composite<'a> {
    pub(super) model: &'a DynamicStiffness,
    pub(super) unknowns: &'a [Unknown],
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
            let replaced = self.unknowns.iter().position(
                |one| matches!(&one.dependence, Dependence::Factor(terms) if terms.contains(&index)),
            );
            let own = match replaced {
                Some(j) => values[j],
                None => self.model.factor(index, frequency_hz)?,
            };
            let mut multiplied = self.model.weight(term.role, frequency_hz);
            let powers = self.unknowns.iter().enumerate().filter_map(|(j, one)| match &one.dependence {
                Dependence::Powers(all) => Some((j, all.iter().find(|(term, _)| *term == index)?.1)),
                Dependence::Factor(_) => None,
            });
            let powers: Vec<(usize, i32)> = powers.collect();
            for &(j, power) in &powers {
                multiplied *= values[j].powi(power);
            }
            at.nominal.parts.push(WeightedTerm { term: index, weight: own * multiplied });
            if let Some(j) = replaced {
                at.parameters[j].coefficients[0].parts.push(WeightedTerm { term: index, weight: multiplied });
            }
            for (j, power) in powers {
                let slope = f64::from(power) * own * multiplied / values[j];
                at.parameters[j].coefficients[0].parts.push(WeightedTerm { term: index, weight: slope });
            }
        }
        Ok(at)
    }

    /// The same with the j-th unknown alone as its parameter.
    pub(super) fn about_one(
        &self,
        frequency_hz: f64,
        values: &[c64],
        j: usize,
    ) -> Result<ModelAt<'a>, OutsideTable> {
        let mut at = self.at(frequency_hz, values)?;
        at.parameters.swap(0, j);
        at.parameters.truncate(1);
        Ok(at)
    }

    /// The nominal values at a frequency.
    pub(super) fn nominal(&self, frequency_hz: f64) -> Result<Vec<c64>, OutsideTable> {
        let decay_per_s = self.model.decay_per_s();
        self.unknowns.iter().map(|one| one.nominal.at_laplace(frequency_hz, decay_per_s)).collect()
    }
}
