//! A model of which several things are unknown, with known answers.

use crate::{Error, Rig};
use frfit::c64;
use frfit::dof::DofName;
use frfit::identify::{Dependence, Unknown};
use frfit::material::Law;
use frfit::model::{DynamicStiffness, Experiment, Term};
use frfit::response::{FullModel, Response};
use std::f64::consts::TAU;

/// A finite element model at its nominal factors, where it is driven and measured, what is unknown, and the truth.
#[derive(Debug)]
pub struct SeveralModel {
    /// The terms, each with the factor that the case gives it: a geometric parameter multiplies it besides.
    pub stiffness: DynamicStiffness,
    /// Load and sensors.
    pub experiment: Experiment,
    /// What is unknown, with its nominal values.
    pub unknowns: Vec<Unknown>,
    /// The law that the measurement is made with, of each of them.
    pub truth: Vec<Law>,
    /// Standard deviation √E|δx|² of the measured responses, relative to each; 0 where they are exact.
    pub noise: f64,
    /// First and last frequency.
    pub band_hz: [f64; 2],
    /// Distance of neighbouring frequencies in the example.
    pub step_hz: f64,
    /// Name of each row; `None` where it is neither a displacement nor a rotation.
    pub dofs: Vec<Option<DofName>>,
}

/// Responses with noise, `[frequency][sensor]`.
#[derive(Debug, Clone, PartialEq)]
pub struct Measured {
    /// Receptance in m/N.
    pub receptance: Vec<Vec<c64>>,
    /// Standard deviation √E|δx|² of each.
    pub std: Vec<Vec<f64>>,
}

impl SeveralModel {
    /// What is driven and measured.
    pub fn rig(&self) -> Rig<'_> {
        let Self { stiffness, experiment, dofs, band_hz, step_hz, .. } = self;
        Rig { stiffness, experiment, dofs, band_hz: *band_hz, step_hz: *step_hz }
    }

    /// What exact sensors would measure: receptances by direct solves with the true values, `[frequency][sensor]`.
    ///
    /// # Errors
    /// [`Error::Breakdown`] where the true system cannot be solved, [`Error::Law`] where a true law does not reach a frequency.
    pub fn exact(&self, frequency_hz: &[f64]) -> Result<Vec<Vec<c64>>, Error> {
        let one = |&f: &f64| {
            let truth = self.true_stiffness(f)?;
            let system = FullModel::new(truth.at(f, &[])?, &self.experiment)?;
            let mut x = system.load().to_vec();
            system.solve_nominal(&mut x)?;
            Ok(system.observe(&x))
        };
        frequency_hz.iter().map(one).collect()
    }

    /// The exact receptances with [`Self::noise`], the same each time.
    ///
    /// # Errors
    /// As [`Self::exact`].
    pub fn measured(&self, frequency_hz: &[f64]) -> Result<Measured, Error> {
        let exact = self.exact(frequency_hz)?;
        let mut random = uniform();
        // Circular: |δx|² is exponentially distributed.
        let mut normal = || c64::from_polar((-random().ln()).sqrt(), TAU * random());
        let std: Vec<Vec<f64>> =
            exact.iter().map(|x| x.iter().map(|x| self.noise * x.norm()).collect()).collect();
        let measured =
            exact.iter().zip(&std).map(|(x, s)| x.iter().zip(s).map(|(x, s)| x + s * normal()).collect());
        Ok(Measured { receptance: measured.collect(), std })
    }

    /// The terms with their true factors at a frequency.
    pub(crate) fn true_stiffness(&self, frequency_hz: f64) -> Result<DynamicStiffness, Error> {
        let terms = self.stiffness.terms().iter().enumerate();
        let terms = terms.map(|(index, term)| self.true_term(index, term, frequency_hz));
        Ok(DynamicStiffness::new(terms.collect::<Result<_, _>>()?)?)
    }

    /// A term with its true factor at a frequency.
    fn true_term(&self, index: usize, term: &Term, frequency_hz: f64) -> Result<Term, Error> {
        let mut factor = term.factor.at(frequency_hz)?;
        let unknowns = self.unknowns.iter().zip(&self.truth);
        for (one, truth) in unknowns.clone() {
            match &one.dependence {
                Dependence::Factor(terms) if terms.contains(&index) => factor = truth.at(frequency_hz)?,
                _ => {}
            }
        }
        for (one, truth) in unknowns {
            let Dependence::Powers(powers) = &one.dependence else { continue };
            for (_, power) in powers.iter().filter(|(term, _)| *term == index) {
                factor *= truth.at(frequency_hz)?.powi(*power);
            }
        }
        Ok(Term { factor: Law::Constant(factor), ..term.clone() })
    }
}

/// Uniform numbers in (0, 1).
///
/// # Source
/// splitmix64: G. L. Steele, D. Lea, C. H. Flood, Fast splittable pseudorandom number generators, OOPSLA 2014, 453–472.
fn uniform() -> impl FnMut() -> f64 {
    let mut state: u64 = 1;
    move || {
        state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (state ^ (state >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        // 53 bits, and half a step more than nothing: its logarithm is finite.
        (((z ^ (z >> 31)) >> 11) as f64 + 0.5) / 9_007_199_254_740_992.0
    }
}
