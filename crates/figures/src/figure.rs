//! The figure and its panels.

use crate::svg::Letters;
use crate::{Axis, Color, HeatMap, Series, Strip, draw};

/// Panels from top to bottom on one shared x axis.
#[derive(Clone, Debug, PartialEq)]
pub struct Figure {
    /// Heading above the first panel; empty for none.
    pub title: String,
    /// The x axis of every panel, labelled below the last.
    pub x: Axis,
    /// The panels.
    pub panels: Vec<Panel>,
    /// Width and height in SVG units (text is 13 units high). The picture grows beyond them where its
    /// panels would become too small to read.
    pub size: (f64, f64),
}

impl Default for Figure {
    fn default() -> Self {
        Self { title: String::new(), x: Axis::default(), panels: Vec::new(), size: (720.0, 460.0) }
    }
}

impl Figure {
    /// The figure as an SVG document. Its labels are text, which can be searched, in the font of the reader.
    pub fn svg(&self) -> String {
        draw::figure(self, Letters::Text)
    }

    /// The same with labels as outlines of the embedded font: it looks the same everywhere. Each has its words as `aria-label`.
    pub fn outlined_svg(&self) -> String {
        draw::figure(self, Letters::Outlines)
    }
}

/// One plot: what is drawn is, from the back, bands, heat map, grid, levels, series.
#[derive(Clone, Debug, PartialEq)]
pub struct Panel {
    /// The y axis.
    pub y: Axis,
    /// Curves and points.
    pub series: Vec<Series>,
    /// A field of values in colours.
    pub heat: Option<HeatMap>,
    /// Shaded ranges of x.
    pub bands: Vec<Bands>,
    /// Horizontal reference lines.
    pub levels: Vec<Level>,
    /// A row of classes below the plot.
    pub strip: Option<Strip>,
    /// Height relative to the other panels, from 1/1000 to 1000; any other number stands for 1.
    pub height: f64,
}

impl Default for Panel {
    fn default() -> Self {
        Self {
            y: Axis::default(),
            series: Vec::new(),
            heat: None,
            bands: Vec::new(),
            levels: Vec::new(),
            strip: None,
            height: 1.0,
        }
    }
}

/// Ranges of x that share a meaning, shaded over the panel's whole height.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Bands {
    /// Name in the legend; empty for none.
    pub label: String,
    /// Colour of the (light) shade.
    pub color: Color,
    /// First and last x of each range.
    pub ranges: Vec<(f64, f64)>,
}

/// A horizontal reference line. The y axis is fitted such that it shows.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Level {
    /// Name in the legend; empty for none.
    pub label: String,
    /// Its height.
    pub y: f64,
}
