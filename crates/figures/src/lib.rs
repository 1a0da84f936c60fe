//! Line plots and heat maps with labelled axes, as SVG and PNG.
//!
//! A [`Figure`] is a stack of [`Panel`]s on one shared x axis. Everything is a plain struct with a
//! default; [`Figure::svg`] draws it and [`Figure::png`] rasterises that same drawing. The crate
//! knows no physics, writes no file and starts no thread; the same figure gives the same bytes.
//!
//! What cannot be drawn (NaN, infinity, a number ≤ 0 on a logarithmic axis, a magnitude beyond
//! 1e±250) is a gap in a curve, a grey cell in a heat map, and never joined across. A panel with
//! nothing to draw says "no data".
//!
//! Labels are Unicode text. Superscript and subscript digits (`10⁻³`, `c₁`) are set as raised or
//! lowered text, so that they look alike in every font.
//!
//! ```
//! use frfit_figures::{Axis, Color, Dash, Figure, Panel, Series};
//!
//! let frequency_hz: Vec<f64> = (1..=200).map(|k| 10.0 * f64::from(k)).collect();
//! let gain = frequency_hz.iter().map(|f| 1.0 / (1.0 - (f / 700.0).powi(2)).abs()).collect();
//! let figure = Figure {
//!     title: "One resonance".into(),
//!     x: Axis::linear("Frequency (Hz)"),
//!     panels: vec![Panel {
//!         y: Axis::log("Gain"),
//!         series: vec![Series {
//!             label: "nominal".into(),
//!             x: frequency_hz,
//!             y: gain,
//!             color: Color::Blue,
//!             line: Some(Dash::Dashed),
//!             ..Series::default()
//!         }],
//!         ..Panel::default()
//!     }],
//!     ..Figure::default()
//! };
//! assert!(figure.svg().starts_with("<svg"));
//! assert!(figure.png(1.25)?.starts_with(b"\x89PNG"));
//! # Ok::<(), frfit_figures::PngError>(())
//! ```

mod axis;
mod color;
mod draw;
mod figure;
mod heat;
mod layout;
mod legend;
mod number;
mod png;
mod range;
mod scale;
mod series;
mod svg;
mod text;
mod ticks;

pub use axis::{Axis, Scale};
pub use color::{Color, Shades};
pub use figure::{Bands, Figure, Level, Panel};
pub use heat::{Class, HeatMap, Strip};
pub use png::PngError;
pub use series::{Dash, Marker, Series};
