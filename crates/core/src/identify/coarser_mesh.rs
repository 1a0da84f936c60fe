//! The same structure on a coarser mesh: what the mesh does to the model.

use super::problem_error::{ProblemError, value};
use crate::model::{DynamicStiffness, Experiment};
use std::fmt;

/// The same structure on a coarser mesh, by which the error of the model's own mesh is measured (B-11).
///
/// The modes of both meshes are paired; Δ is the relative difference of their natural frequencies. With elements r times as long, and errors that go with the
/// power p of the length, the model's own error is
/// $$ \delta = \frac{\Delta}{r^p - 1}. $$
/// The model is corrected for it, and it stays in every error bar with a standard deviation as large as itself.
///
/// # Limits
/// What both meshes have wrong in the same way, they do not show: a law, a mass, a support, the assumptions of the elements.
///
/// # Source
/// P. J. Roache, J. Fluids Eng. 116 (1994) 405–413: extrapolation from two meshes, and a band of three times the difference for what is not known of the order.
#[derive(Debug)]
pub struct CoarserMesh {
    /// Its matrices: the same terms in the same order, with the same known factors.
    pub model: DynamicStiffness,
    /// The same load and sensors.
    pub experiment: Experiment,
    /// Length of its elements over that of the model's, r > 1.
    pub element_ratio: f64,
    /// The order p of the error of natural frequencies in the length of elements.
    pub order: f64,
}

impl CoarserMesh {
    /// Elements twice as long.
    pub const ELEMENT_RATIO: f64 = 2.0;

    /// The order of the natural frequencies of most elements: linear ones, and bending with shear. Those of cubic beams have 4.
    pub const ORDER: f64 = 2.0;

    /// The largest ratio and the largest order that are accepted.
    pub const MAX_RATIO: f64 = 16.0;

    /// δ/Δ = 1/(r^p − 1).
    pub(super) fn remainder(&self) -> f64 {
        1.0 / (self.element_ratio.powf(self.order) - 1.0)
    }

    /// Refuses what is not the same structure as a model.
    pub(super) fn validate(
        &self,
        model: &DynamicStiffness,
        experiment: &Experiment,
        is_unknown: impl Fn(usize) -> bool,
        frequency_hz: &[f64],
    ) -> Result<(), ProblemError> {
        let wrong = |what: &str, expected: String, found: &dyn fmt::Display| {
            Err(value(format!("coarser mesh: {what}"), expected, found))
        };
        for (name, number, least) in [("element_ratio", self.element_ratio, 1.0), ("order", self.order, 0.0)]
        {
            if !(number > least && number <= Self::MAX_RATIO) {
                let expected = format!("a number above {least} up to {}", Self::MAX_RATIO);
                return wrong(name, expected, &number);
            }
        }
        let roles = |model: &DynamicStiffness| model.terms().iter().map(|term| term.role).collect::<Vec<_>>();
        let [own, other] = [roles(model), roles(&self.model)];
        if own != other {
            return wrong(
                "roles of its matrices",
                format!("as in the model, {own:?}"),
                &format!("{other:?}"),
            );
        }
        let [own, other] = [experiment, &self.experiment].map(|one| one.sensors.len());
        if own != other {
            return wrong("sensors", format!("the model's {own}"), &other);
        }
        let known = model.terms().iter().zip(self.model.terms()).enumerate().filter(|(t, _)| !is_unknown(*t));
        for (_, (own, other)) in known {
            for &f in frequency_hz.first().into_iter().chain(frequency_hz.last()) {
                let [expected, found] = [own, other].map(|term| term.factor.at(f).unwrap_or_default());
                if (found - expected).norm() > FACTOR_RTOL * expected.norm() {
                    let expected = format!("that of the model, {expected} at {f} Hz");
                    return wrong(&format!("factor of {:?}", own.name), expected, &found);
                }
            }
        }
        Ok(())
    }
}

/// Factors that differ by less than this are the same number, written twice.
const FACTOR_RTOL: f64 = 1e-9;
