//! From values to places on the page.

use crate::Scale;

/// Magnitudes beyond this (and positive ones below its inverse on a logarithmic axis) are not drawn:
/// inside it no difference, margin or tick can overflow.
pub(crate) const LIMIT: f64 = 1e250;

/// Whether a value has a place on an axis of this scale.
pub(crate) fn drawable(value: f64, scale: Scale) -> bool {
    match scale {
        Scale::Linear | Scale::Whole => value.abs() <= LIMIT,
        Scale::Log => (1.0 / LIMIT..=LIMIT).contains(&value),
    }
}

/// The coordinate in which the axis is even: the value or its decimal logarithm.
pub(crate) fn to_scale(value: f64, scale: Scale) -> f64 {
    if scale == Scale::Log { value.log10() } else { value }
}

/// Inverse of [`to_scale`].
pub(crate) fn to_linear(coordinate: f64, scale: Scale) -> f64 {
    if scale == Scale::Log { 10f64.powf(coordinate) } else { coordinate }
}

/// An axis laid on the page: `range` of values from `page.0` to `page.1`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Map {
    pub(crate) scale: Scale,
    pub(crate) range: (f64, f64),
    pub(crate) page: (f64, f64),
}

impl Map {
    /// Place of a value, if it has one; at most 10⁵ units off the page, where SVG readers that count in
    /// single precision still draw.
    pub(crate) fn place(&self, value: f64) -> Option<f64> {
        drawable(value, self.scale).then(|| {
            let (lo, hi) = (to_scale(self.range.0, self.scale), to_scale(self.range.1, self.scale));
            let part = (to_scale(value, self.scale) - lo) / (hi - lo);
            (self.page.0 + part * (self.page.1 - self.page.0)).clamp(-1e5, 1e5)
        })
    }

    /// Place of a value within the range, with a breath for rounding.
    pub(crate) fn place_inside(&self, value: f64) -> Option<f64> {
        let (first, last) = (self.page.0.min(self.page.1), self.page.0.max(self.page.1));
        self.place(value).filter(|p| (first - 0.01..=last + 0.01).contains(p))
    }

    /// Length on the page.
    pub(crate) fn length(&self) -> f64 {
        (self.page.1 - self.page.0).abs()
    }
}
