//! The cantilever of two examples.

use crate::Error;
use frfit_fem::{Assembled, Beam, Support};

/// Length, width and height in m.
pub(crate) const LENGTH: f64 = 0.5;
const WIDTH: f64 = 0.03;
const HEIGHT: f64 = 0.006;

/// A rectangular beam in bending, clamped at x = 0.
pub(crate) fn cantilever(elements: usize) -> Result<Assembled, Error> {
    let beam = Beam {
        length: LENGTH,
        area: WIDTH * HEIGHT,
        inertia: WIDTH * HEIGHT.powi(3) / 12.0,
        elements,
        ends: [Support::Clamped, Support::Free],
        ..Beam::default()
    };
    Ok(beam.assemble()?)
}
