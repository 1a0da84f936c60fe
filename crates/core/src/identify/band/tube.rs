//! A model for what is near one curve of factors over frequency: far fewer vectors than for a box.

use super::space::{ANSWER, thinned};
use super::explore::Evaluated;
use crate::c64;
use crate::model::ModelAt;
use crate::subspace::{Assessment, Point, Projection};
use frfit_linalg::dense::NoConvergence;

/// Points of a curve at which its model is made good.
const POINTS: usize = 9;

/// A curve, and the model for it.
pub(super) struct Tube<'a> {
    at: &'a [ModelAt<'a>],
    /// Frequencies (index) and factors there.
    curve: Vec<(usize, c64)>,
    model: Projection,
}

impl<'a> Tube<'a> {
    /// From the model of the neighbourhood, or with that where the curve is not worth one of its `own`.
    pub(super) fn new(at: &'a [ModelAt<'a>], curve: Vec<(usize, c64)>, model: &Projection, own: bool) -> Self {
        if !own {
            return Self { at, curve, model: model.clone() };
        }
        let (first, last) = (curve[0].0, curve[curve.len() - 1].0);
        let all: Vec<usize> = (first..=last).collect();
        let points: Vec<Point<'_>> = thinned(&all, POINTS)
            .map(|&i| Point { at: at[i].clone(), correction: factor(at, &curve, i) - at[i].parameters[0].nominal })
            .collect();
        let model = model.localised(&points, ANSWER);
        Self { at, curve, model }
    }

    /// The factor on the curve.
    pub(super) fn factor(&self, i: usize) -> c64 {
        factor(self.at, &self.curve, i)
    }

    pub(super) fn respond_with_slope(&self, i: usize, correction: c64) -> Evaluated {
        self.model.respond_with_slope(&self.at[i], correction).map_err(|_| NoConvergence)
    }

    pub(super) fn assess(&self, i: usize, correction: c64) -> Option<Assessment> {
        self.model.assess(&self.at[i], correction).ok()
    }
}

/// A curve is straight between two of its points.
fn factor(at: &[ModelAt<'_>], curve: &[(usize, c64)], i: usize) -> c64 {
    let k = curve.partition_point(|&(own, _)| own < i);
    let ((right, b), (left, a)) = (curve[k], curve[k.saturating_sub(1)]);
    a + fraction(at, left, i, right) * (b - a)
}

/// How far the i-th frequency is on the way from one to another.
pub(super) fn fraction(at: &[ModelAt<'_>], left: usize, i: usize, right: usize) -> f64 {
    if right == i {
        return 1.0;
    }
    let [f, from, to] = [i, left, right].map(|i| at[i].frequency_hz);
    (f - from) / (to - from)
}
