//! The same structure on a coarser mesh: what the mesh does to the model.

use crate::model::{DynamicStiffness, Experiment};
use std::fmt;

/// The same structure on a coarser mesh, by which the error of the model's own mesh is measured (B-11).
///
/// The natural frequencies of both meshes are paired; what lies between them is Δ. With elements r times as long, and errors that go with the
/// power p of the length, the model's own error is
/// $$ \delta = \frac{\Delta}{r^p - 1}. $$
/// It is taken out of the model, and stays in every error bar with a standard deviation as large as itself.
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

    /// Ratios and orders beyond this are none of meshes.
    pub const MAX_RATIO: f64 = 16.0;

    /// δ/Δ = 1/(r^p − 1).
    pub(super) fn remainder(&self) -> f64 {
        1.0 / (self.element_ratio.powf(self.order) - 1.0)
    }

    /// What is wrong with it beside a model: what, expected, found.
    pub(super) fn validate(
        &self,
        model: &DynamicStiffness,
        experiment: &Experiment,
        is_unknown: impl Fn(usize) -> bool,
        frequency_hz: &[f64],
    ) -> Result<(), [String; 3]> {
        let wrong = |what: &str, expected: &dyn fmt::Display, found: &dyn fmt::Display| {
            Err([format!("coarser mesh: {what}"), expected.to_string(), found.to_string()])
        };
        let usual = |value: f64, least: f64| value > least && value <= Self::MAX_RATIO;
        if !usual(self.element_ratio, 1.0) {
            let expected = format!("a number above 1 up to {}", Self::MAX_RATIO);
            return wrong("element_ratio", &expected, &self.element_ratio);
        }
        if !usual(self.order, 0.0) {
            return wrong("order", &format!("a positive number up to {}", Self::MAX_RATIO), &self.order);
        }
        let roles = |model: &DynamicStiffness| model.terms().iter().map(|term| term.role).collect::<Vec<_>>();
        let [own, other] = [roles(model), roles(&self.model)];
        if own != other {
            let expected = format!("as in the model, {own:?}");
            return wrong("roles of its matrices", &expected, &format!("{other:?}"));
        }
        let [own, other] = [experiment, &self.experiment].map(|one| one.sensors.len());
        if own != other {
            return wrong("sensors", &format!("the model's {own}"), &other);
        }
        if self.experiment.load.len() != self.model.dim() {
            return wrong("load", &format!("{} entries", self.model.dim()), &self.experiment.load.len());
        }
        let outside = self.experiment.sensors.iter().find(|sensor| sensor.row >= self.model.dim());
        if let Some(sensor) = outside {
            return wrong("row of a sensor", &format!("below {}", self.model.dim()), &sensor.row);
        }
        for (t, (own, other)) in model.terms().iter().zip(self.model.terms()).enumerate() {
            for &f in frequency_hz.first().into_iter().chain(frequency_hz.last()) {
                let [own_value, value] = [own, other].map(|term| term.factor.at(f).unwrap_or_default());
                if !is_unknown(t) && (value - own_value).norm() > FACTOR_RTOL * own_value.norm() {
                    let expected = format!("that of the model, {own_value} at {f} Hz");
                    return wrong(&format!("factor of {:?}", own.name), &expected, &value);
                }
            }
        }
        Ok(())
    }
}

/// Factors that differ by less than this are the same number, written twice.
const FACTOR_RTOL: f64 = 1e-9;
