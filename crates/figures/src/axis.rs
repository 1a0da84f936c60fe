//! What an axis says and how it counts.

/// How values are spread along an axis.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Scale {
    /// Evenly, with ticks at 1, 2 or 5 × 10ⁿ.
    #[default]
    Linear,
    /// Evenly, with ticks at whole numbers only (orders, counts).
    Whole,
    /// Evenly in the decimal logarithm; numbers ≤ 0 cannot be drawn.
    Log,
}

/// An axis of a plot.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Axis {
    /// Quantity and unit, as it is to be read: `Frequency (Hz)`.
    pub label: String,
    /// Linear, whole numbers or logarithmic.
    pub scale: Scale,
    /// First and last value shown. `None`, and any range that cannot be drawn (not finite, empty, ≤ 0
    /// on a logarithmic axis), stands for the extent of the data with a small margin.
    pub range: Option<(f64, f64)>,
}

impl Axis {
    /// A linear axis fitted to the data.
    pub fn linear(label: impl Into<String>) -> Self {
        Self { label: label.into(), scale: Scale::Linear, range: None }
    }

    /// A linear axis for whole numbers, fitted to the data.
    pub fn whole(label: impl Into<String>) -> Self {
        Self { label: label.into(), scale: Scale::Whole, range: None }
    }

    /// A logarithmic axis fitted to the data.
    pub fn log(label: impl Into<String>) -> Self {
        Self { label: label.into(), scale: Scale::Log, range: None }
    }
}
