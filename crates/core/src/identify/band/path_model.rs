//! A model for what is near one curve of factors over frequency: far fewer vectors than for a box.

use super::candidates::Evaluated;
use super::neighbourhoods::{TRAINED_TOL, is_certain};
use crate::c64;
use crate::model::ModelAt;
use crate::subspace::{Assessment, Point, Projection};
use crate::thinned::thinned;
use frfit_linalg::dense::NoConvergence;
use std::borrow::Cow;

/// Points of a curve at which its model is made good.
const CURVE_POINTS: usize = 9;

/// A curve, and the model for it.
pub(super) struct PathModel<'e, 'a> {
    at: &'a [ModelAt<'a>],
    /// Frequencies (index) and factors there, straight between them.
    curve: Vec<(usize, c64)>,
    model: Cow<'e, Projection>,
}

impl<'e, 'a> PathModel<'e, 'a> {
    /// With a model of its own made from that of the neighbourhood, or with that.
    pub(super) fn along(
        at: &'a [ModelAt<'a>],
        curve: Vec<(usize, c64)>,
        model: &'e Projection,
        own: bool,
    ) -> Self {
        let path_model = Self { at, curve, model: Cow::Borrowed(model) };
        if own {
            Self { model: Cow::Owned(model.localised(&path_model.points(), TRAINED_TOL)), ..path_model }
        } else {
            path_model
        }
    }

    /// With a model that is good at these answers (frequency, correction) too, where this one is not.
    pub(super) fn widened(self, model: &Projection, answers: &[(usize, c64)]) -> Self {
        let certain = |&(i, correction): &(usize, c64)| {
            self.assess(i, correction).is_some_and(|assessed| is_certain(&self.at[i], correction, &assessed))
        };
        if matches!(self.model, Cow::Borrowed(_)) || answers.iter().all(certain) {
            return self;
        }
        let mut points = self.points();
        points.extend(answers.iter().map(|&(i, correction)| Point { at: self.at[i].clone(), correction }));
        Self { model: Cow::Owned(model.localised(&points, TRAINED_TOL)), ..self }
    }

    fn points(&self) -> Vec<Point<'a>> {
        let all: Vec<usize> = (self.curve[0].0..=self.curve[self.curve.len() - 1].0).collect();
        let point = |&i: &usize| {
            let at = self.at[i].clone();
            let correction = self.factor(i) - at.parameters[0].nominal;
            Point { at, correction }
        };
        thinned(&all, CURVE_POINTS).map(point).collect()
    }

    /// The factor on the curve.
    pub(super) fn factor(&self, i: usize) -> c64 {
        let k = self.curve.partition_point(|&(own, _)| own < i);
        let ((right, b), (left, a)) = (self.curve[k], self.curve[k.saturating_sub(1)]);
        a + fraction(self.at, left, i, right) * (b - a)
    }

    /// x_m at the nominal values.
    pub(super) fn respond(&self, i: usize) -> Result<Vec<c64>, NoConvergence> {
        self.model.respond(&self.at[i]).map_err(|_| NoConvergence)
    }

    pub(super) fn respond_with_slope(&self, i: usize, correction: c64) -> Evaluated {
        self.model.respond_with_slope(&self.at[i], correction).map_err(|_| NoConvergence)
    }

    pub(super) fn assess(&self, i: usize, correction: c64) -> Option<Assessment> {
        self.model.assess(&self.at[i], correction).ok()
    }
}

/// How far the i-th frequency is on the way from one to another, by ω²: factors that are poles of a structure of one material, or solutions of another
/// stiffness for its mass, go with that.
pub(super) fn fraction(at: &[ModelAt<'_>], left: usize, i: usize, right: usize) -> f64 {
    if right == i {
        return 1.0;
    }
    let [f, from, to] = [i, left, right].map(|i| at[i].frequency_hz.powi(2));
    (f - from) / (to - from)
}
