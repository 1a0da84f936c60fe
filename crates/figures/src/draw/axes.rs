//! Frame, grid, ticks and their labels.

use crate::layout::{BORDER, ColorBar, Frame, Layout, SMALL_TEXT, TEXT, TICK};
use crate::number::N;
use crate::svg::{Anchor, Svg};
use crate::text::fitted;

/// Lengths of major and minor ticks.
const MAJOR: f64 = 5.0;
const MINOR: f64 = 2.5;
/// From the middle of a tick label to its baseline.
const HALF_HEIGHT: f64 = 0.36 * SMALL_TEXT;
/// The lines of frame and ticks.
const INK: &str = "fill=\"none\" stroke=\"#333\" stroke-width=\"0.9\"";

/// Thin lines at the major ticks.
pub(super) fn grid(svg: &mut Svg, frame: &Frame, layout: &Layout) {
    let plot = frame.plot;
    let mut lines = String::new();
    for x in layout.x_ticks.major.iter().filter_map(|t| layout.x.place_inside(t.value)) {
        lines += &format!("M{} {}V{}", N(x), N(plot.y), N(plot.bottom()));
    }
    for y in frame.y_ticks.major.iter().filter_map(|t| frame.y.place_inside(t.value)) {
        lines += &format!("M{} {}H{}", N(plot.x), N(y), N(plot.right()));
    }
    svg.path(&lines, "fill=\"none\" stroke=\"#dcdcdc\" stroke-width=\"0.6\"");
}

/// The plot's frame with the ticks of both axes, and everything written on the left.
pub(super) fn frame(svg: &mut Svg, label: &str, frame: &Frame, layout: &Layout) {
    let plot = frame.plot;
    svg.rect(plot, INK);
    let base = frame.strip.map_or(plot.bottom(), |s| s.bottom());
    let ticks = &layout.x_ticks;
    let majors = ticks.major.iter().map(|t| (t.value, MAJOR));
    let mut lines = String::new();
    for (value, length) in majors.chain(ticks.minor.iter().map(|&v| (v, MINOR))) {
        if let Some(x) = layout.x.place_inside(value) {
            lines += &format!("M{} {}v{}", N(x), N(base), N(length));
        }
    }
    let majors = frame.y_ticks.major.iter().map(|t| (t.value, MAJOR));
    for (value, length) in majors.chain(frame.y_ticks.minor.iter().map(|&v| (v, MINOR))) {
        if let Some(y) = frame.y.place_inside(value) {
            lines += &format!("M{} {}h{}", N(plot.x), N(y), N(-length));
        }
    }
    svg.path(&lines, INK);

    let x = plot.x - TICK;
    for tick in &frame.y_ticks.major {
        if let Some(y) = frame.y.place_inside(tick.value) {
            svg.text((x, y + HALF_HEIGHT), SMALL_TEXT, Anchor::End, &tick.label);
        }
    }
    svg.text((x, plot.y - 10.0), SMALL_TEXT, Anchor::End, &frame.y_ticks.multiplier());
    let (label, size) = fitted(label, TEXT, plot.height + 16.0);
    svg.upward_text((BORDER + 0.8 * TEXT, plot.y + 0.5 * plot.height), size, Anchor::Middle, &label);
}

/// Tick labels and the label of the shared x axis, below the last panel.
pub(super) fn x_labels(svg: &mut Svg, label: &str, layout: &Layout) {
    let Some(last) = layout.frames.last() else { return };
    let baseline = last.strip.unwrap_or(last.plot).bottom() + TICK + 0.8 * SMALL_TEXT;
    for tick in &layout.x_ticks.major {
        if let Some(x) = layout.x.place_inside(tick.value) {
            svg.text((x, baseline), SMALL_TEXT, Anchor::Middle, &tick.label);
        }
    }
    let below = baseline + TEXT + 7.0;
    let multiplier = layout.x_ticks.multiplier();
    svg.text((last.plot.right(), below), SMALL_TEXT, Anchor::End, &multiplier);
    let room = last.plot.width - if multiplier.is_empty() { -2.0 * BORDER } else { 100.0 };
    let (label, size) = fitted(label, TEXT, room);
    svg.text((last.plot.x + 0.5 * last.plot.width, below), size, Anchor::Middle, &label);
}

/// Frame, ticks and words of a colour bar.
pub(super) fn bar(svg: &mut Svg, label: &str, bar: &ColorBar) {
    let r = bar.bar;
    svg.rect(r, INK);
    let mut lines = String::new();
    for tick in &bar.ticks.major {
        if let Some(y) = bar.map.place_inside(tick.value) {
            lines += &format!("M{} {}h{}", N(r.right()), N(y), N(MAJOR));
            svg.text((r.right() + TICK, y + HALF_HEIGHT), SMALL_TEXT, Anchor::Start, &tick.label);
        }
    }
    svg.path(&lines, INK);
    svg.text((r.right() + TICK, r.y - 10.0), SMALL_TEXT, Anchor::Start, &bar.ticks.multiplier());
    let (label, size) = fitted(label, TEXT, r.height + 16.0);
    svg.upward_text((bar.label_x(), r.y + 0.5 * r.height), size, Anchor::Middle, &label);
}
