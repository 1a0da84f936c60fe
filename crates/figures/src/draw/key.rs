//! The legend: outside the plot, above it.

use super::curves;
use crate::layout::{Frame, ROW};
use crate::legend::{Look, SAMPLE};
use crate::number::N;
use crate::svg::{Anchor, Rect, Svg};

/// Opacity of shaded ranges.
pub(super) const SHADE: f64 = 0.2;

/// Draws each entry as it looks in the plot.
pub(super) fn legend(svg: &mut Svg, frame: &Frame) {
    for placed in &frame.legend {
        let x = frame.plot.x + placed.x;
        let y = frame.legend_y + (placed.row as f64 + 0.5) * ROW;
        let patch = Rect { x, y: y - 5.5, width: SAMPLE, height: 11.0 };
        match placed.entry.look {
            Look::Curve { color, line, marker } => {
                if let Some(dash) = line {
                    svg.path(
                        &format!("M{} {}h{}", N(x), N(y), N(SAMPLE)),
                        &curves::stroke(color.hex(), dash),
                    );
                }
                if let Some(marker) = marker {
                    curves::marker(svg, color.hex(), marker, (x + 0.5 * SAMPLE, y));
                }
            }
            Look::Shade(color) => {
                svg.rect(patch, &format!("fill=\"{}\" fill-opacity=\"{SHADE}\"", color.hex()));
            }
            Look::Fill(color) => svg.rect(patch, &format!("fill=\"{}\"", color.hex())),
        }
        let (text, size) = &placed.text;
        svg.text((frame.plot.x + placed.text_x(), y + 0.36 * size), *size, Anchor::Start, text);
    }
}
