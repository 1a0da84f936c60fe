//! Curves and points.

use crate::Color;

/// The dash pattern of a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs)] // the names say it
pub enum Dash {
    Solid,
    Dashed,
    Dotted,
    DashDot,
}

/// The shape of a marker; all but `Disc` are open.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs)] // the names say it
pub enum Marker {
    Circle,
    Disc,
    Square,
    Triangle,
    Diamond,
    Cross,
    Plus,
}

/// One curve or cloud of points. Series are drawn in their order, the last on top.
#[derive(Clone, Debug, PartialEq)]
pub struct Series {
    /// Name in the legend; empty for none.
    pub label: String,
    /// Abscissae; the shorter of `x` and `y` rules.
    pub x: Vec<f64>,
    /// Ordinates; NaN is a gap.
    pub y: Vec<f64>,
    /// Half-lengths of horizontal error bars; may be shorter than `x`, NaN or 0 for none.
    pub x_error: Vec<f64>,
    /// Half-lengths of vertical error bars. On a logarithmic axis a bar that reaches 0 runs to the frame.
    pub y_error: Vec<f64>,
    /// Colour of all that is drawn.
    pub color: Color,
    /// Line joining consecutive points; `None` for points alone.
    pub line: Option<Dash>,
    /// Marker at each point. Where there is a line too, markers that would crowd are left out; the line
    /// still passes through every point.
    pub marker: Option<Marker>,
}

impl Default for Series {
    /// A solid black line without points.
    fn default() -> Self {
        Self {
            label: String::new(),
            x: Vec::new(),
            y: Vec::new(),
            x_error: Vec::new(),
            y_error: Vec::new(),
            color: Color::Black,
            line: Some(Dash::Solid),
            marker: None,
        }
    }
}

impl Series {
    /// The points (x, y), drawable or not.
    pub(crate) fn points(&self) -> impl Iterator<Item = (f64, f64)> {
        self.x.iter().copied().zip(self.y.iter().copied())
    }

    /// The half-lengths (x, y) of the error bars at point `i`, if they can be drawn.
    pub(crate) fn errors(&self, i: usize) -> (Option<f64>, Option<f64>) {
        let at = |errors: &[f64]| errors.get(i).copied().filter(|e| e.is_finite() && *e > 0.0);
        (at(&self.x_error), at(&self.y_error))
    }
}
