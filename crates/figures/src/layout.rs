//! Where everything goes: text is measured first, plots take the rest.

use crate::legend::{Entry, Placed, entries, place};
use crate::range::{PanelRanges, Ranges};
use crate::scale::Map;
use crate::svg::Rect;
use crate::text::width;
use crate::ticks::{Ticks, names, shared_exponent, ticks};
use crate::{Figure, Panel, Scale};

/// Size of axis labels, tick labels and legend; of the title.
pub(crate) const TEXT: f64 = 13.0;
pub(crate) const SMALL_TEXT: f64 = 12.0;
pub(crate) const TITLE: f64 = 15.0;
/// Length of a tick with the gap to its label.
pub(crate) const TICK: f64 = 8.0;
/// Free border of the page.
pub(crate) const BORDER: f64 = 10.0;
/// Height of a legend row.
pub(crate) const ROW: f64 = 19.0;
/// Height of a strip and its distance from the plot.
const STRIP: (f64, f64) = (12.0, 5.0);
/// Distance between panels.
const BETWEEN: f64 = 14.0;
/// Smallest plot that can be read.
const MIN_PLOT_SIZE: (f64, f64) = (160.0, 70.0);
/// Rounds after which a page is taken as it is; each lets in another set of tick labels, of which an axis has few.
const ROUNDS: usize = 20;

/// The page.
pub(crate) struct Layout {
    pub(crate) size: (f64, f64),
    pub(crate) x: Map,
    pub(crate) x_ticks: Ticks,
    pub(crate) frames: Vec<Frame>,
}

/// One panel's places.
pub(crate) struct Frame {
    pub(crate) plot: Rect,
    pub(crate) y: Map,
    pub(crate) y_ticks: Ticks,
    /// Top of the legend.
    pub(crate) legend_y: f64,
    pub(crate) legend: Vec<Placed>,
    pub(crate) color_bar: Option<ColorBar>,
    pub(crate) strip: Option<Rect>,
}

/// The scale of a heat map.
pub(crate) struct ColorBar {
    pub(crate) bar: Rect,
    pub(crate) map: Map,
    pub(crate) ticks: Ticks,
}

/// Space left and right of the plots.
#[derive(Clone, Copy)]
struct Margins {
    left: f64,
    right: f64,
}

impl Layout {
    /// The layout of a figure.
    pub(crate) fn of(figure: &Figure) -> Self {
        let ranges = Ranges::of(figure);
        let mut margins = Margins { left: 70.0, right: 30.0 };
        // margins follow from tick labels, these from plot heights, these from legend rows, and these from
        // the margins: two rounds come near
        for _ in 0..2 {
            margins = Self::within(figure, &ranges, margins).margins_needed();
        }
        // labels that come and go with the width could take turns for ever: from here on margins only grow
        for _ in 0..ROUNDS {
            let layout = Self::within(figure, &ranges, margins);
            let needed = layout.margins_needed();
            if needed.left <= margins.left && needed.right <= margins.right {
                return layout;
            }
            margins = Margins { left: needed.left.max(margins.left), right: needed.right.max(margins.right) };
        }
        Self::within(figure, &ranges, margins)
    }

    /// The layout with given margins.
    fn within(figure: &Figure, ranges: &Ranges, margins: Margins) -> Self {
        let side = |length: f64, usual: f64| if length.is_finite() { length.min(1e4) } else { usual };
        let plot_width = (side(figure.size.0, 720.0) - margins.left - margins.right).max(MIN_PLOT_SIZE.0);
        let legends = figure.legends(plot_width);
        let above: Vec<f64> = (0..legends.len()).map(|i| figure.room_above(i, &legends[i], ranges)).collect();
        let below: Vec<f64> =
            figure.panels.iter().map(|p| if p.strip.is_some() { STRIP.0 + STRIP.1 } else { 0.0 }).collect();
        let head = BORDER + if figure.title.is_empty() { 0.0 } else { TITLE + 9.0 };
        let foot = BORDER + TICK + SMALL_TEXT + if figure.x.label.is_empty() { 0.0 } else { TEXT + 9.0 };
        let taken = head + foot + above.iter().chain(&below).sum::<f64>();
        let weight = |p: &Panel| if (1e-3..=1e3).contains(&p.height) { p.height } else { 1.0 };
        let weights: f64 = figure.panels.iter().map(weight).sum();
        let unit = (side(figure.size.1, 460.0) - taken) / weights;

        let mut top = head;
        let mut frames = Vec::new();
        for (i, (panel, legend)) in figure.panels.iter().zip(legends).enumerate() {
            let plot = Rect {
                x: margins.left,
                y: top + above[i],
                width: plot_width,
                height: (unit * weight(panel)).max(MIN_PLOT_SIZE.1),
            };
            frames.push(Frame::new(panel, &ranges.panels[i], plot, legend));
            top = plot.bottom() + below[i];
        }
        let x =
            Map { scale: figure.x.scale, range: ranges.x, page: (margins.left, margins.left + plot_width) };
        let x_ticks = ticks(&x, &|label: &str| (width(label, SMALL_TEXT) + 16.0).max(44.0));
        Self { size: (margins.left + plot_width + margins.right, top + foot), x, x_ticks, frames }
    }

    /// The margins that hold the tick labels as they are.
    fn margins_needed(&self) -> Margins {
        let overhang = |end: f64| {
            let beyond = |label: &str, at: f64| 0.5 * width(label, SMALL_TEXT) - (at - end).abs();
            let labels =
                self.x_ticks.major.iter().filter_map(|t| Some(beyond(&t.label, self.x.place(t.value)?)));
            labels.fold(0.0, f64::max)
        };
        let left = self.frames.iter().map(|f| f.y_axis_width()).fold(overhang(self.x.page.0), f64::max);
        let bars = self.frames.iter().filter_map(|f| f.color_bar.as_ref());
        let right = bars.map(ColorBar::block_width).fold(overhang(self.x.page.1).max(6.0), f64::max);
        Margins { left: BORDER + left, right: BORDER + right }
    }
}

impl Frame {
    fn new(panel: &Panel, ranges: &PanelRanges, plot: Rect, legend: Vec<Placed>) -> Self {
        let legend_y = plot.y - legend_height(&legend);
        let upward = |range, scale| Map { scale, range, page: (plot.bottom(), plot.y) };
        let line = |_: &str| 2.4 * SMALL_TEXT;
        let y = upward(ranges.y, panel.y.scale);
        let color_bar = ranges.values.map(|range| {
            let bar = Rect { x: plot.right() + 14.0, width: 14.0, ..plot };
            let map = upward(range, Scale::Linear);
            ColorBar { bar, map, ticks: ticks(&map, &line) }
        });
        let strip =
            panel.strip.as_ref().map(|_| Rect { y: plot.bottom() + STRIP.1, height: STRIP.0, ..plot });
        let named = panel.heat.as_ref().filter(|heat| !heat.names.is_empty());
        let y_ticks = named.map_or_else(|| ticks(&y, &line), |heat| names(&y, &heat.y, &heat.names, &line));
        Self { plot, y, y_ticks, legend_y, legend, color_bar, strip }
    }

    /// Room for tick labels and the axis label.
    fn y_axis_width(&self) -> f64 {
        TICK + labels_width(&self.y_ticks) + 8.0 + TEXT
    }
}

impl ColorBar {
    /// From the plot's right side to the end of the bar's label.
    fn block_width(&self) -> f64 {
        28.0 + TICK + labels_width(&self.ticks) + 8.0 + TEXT
    }

    /// Baseline of the bar's label.
    pub(crate) fn label_x(&self) -> f64 {
        self.bar.right() + TICK + labels_width(&self.ticks) + 5.0 + TEXT
    }
}

/// Height of a legend with the gap to the plot.
fn legend_height(legend: &[Placed]) -> f64 {
    legend.last().map_or(0.0, |p| (p.row + 1) as f64 * ROW + 5.0)
}

/// Width of the widest tick label or of the multiplier.
fn labels_width(ticks: &Ticks) -> f64 {
    let labels = ticks.major.iter().map(|t| width(&t.label, SMALL_TEXT));
    labels.fold(width(&ticks.multiplier(), SMALL_TEXT), f64::max)
}

impl Figure {
    /// Room above the plot of panel `i`: its legend, or the multiplier of its y axis, or a mere gap.
    fn room_above(&self, i: usize, legend: &[Placed], ranges: &Ranges) -> f64 {
        let panel = &ranges.panels[i];
        let y = if self.panels[i].y.scale == Scale::Log { None } else { Some(panel.y) };
        let multiplied = y.into_iter().chain(panel.values).any(|range| shared_exponent(range) != 0);
        let gap = if i > 0 { BETWEEN } else { 8.0 };
        let least = if multiplied { gap + 10.0 } else { gap };
        let apart = if i > 0 { 10.0 } else { 0.0 };
        if legend.is_empty() { least } else { legend_height(legend) + apart }
    }

    /// Legends of the panels; what an earlier panel named is not named again.
    fn legends(&self, room: f64) -> Vec<Vec<Placed>> {
        let mut named: Vec<Entry> = Vec::new();
        let mut legend = |panel: &Panel| {
            let new: Vec<Entry> = entries(panel).into_iter().filter(|e| !named.contains(e)).collect();
            named.extend(new.iter().cloned());
            place(new, SMALL_TEXT, room)
        };
        self.panels.iter().map(&mut legend).collect()
    }
}
