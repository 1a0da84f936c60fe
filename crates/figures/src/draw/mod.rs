//! From a laid-out figure to SVG, one kind of mark a file.

mod axes;
mod cells;
mod curves;
mod key;

use crate::layout::{BORDER, Frame, Layout, TEXT, TITLE};
use crate::number::N;
use crate::scale::Map;
use crate::svg::{Anchor, Letters, Rect, Svg};
use crate::text::fitted;
use crate::{Bands, Figure, Level, Panel};

/// The whole drawing.
pub(crate) fn figure(figure: &Figure, letters: Letters) -> String {
    let layout = Layout::of(figure);
    let (width, _) = layout.size;
    let mut svg = Svg::new(layout.size, &figure.title, letters);
    let (title, size) = fitted(&figure.title, TITLE, width - 2.0 * BORDER);
    svg.text((0.5 * width, BORDER + TITLE), size, Anchor::Middle, &title);
    for (panel, frame) in figure.panels.iter().zip(&layout.frames) {
        draw_panel(&mut svg, panel, frame, &layout);
    }
    axes::x_labels(&mut svg, &figure.x.label, &layout);
    svg.finish()
}

/// One panel from back to front.
fn draw_panel(svg: &mut Svg, panel: &Panel, frame: &Frame, layout: &Layout) {
    let x = &layout.x;
    let mut empty = true;
    svg.clipped(frame.plot, |svg| {
        bands(svg, &panel.bands, frame, x);
        if let Some(heat) = &panel.heat {
            empty &= !cells::heat_map(svg, heat, frame, x);
        } else {
            axes::grid(svg, frame, layout);
        }
        levels(svg, &panel.levels, frame);
        for series in &panel.series {
            empty &= !curves::lines(svg, series, x, &frame.y);
        }
    });
    for series in &panel.series {
        curves::markers(svg, series, x, &frame.y);
    }
    if empty {
        let middle = (frame.plot.x + 0.5 * frame.plot.width, frame.plot.y + 0.5 * frame.plot.height);
        svg.group("fill=\"#707070\"", |svg| svg.text(middle, TEXT, Anchor::Middle, "no data"));
    }
    if let (Some(strip), Some(place)) = (&panel.strip, frame.strip) {
        cells::strip(svg, strip, place, x);
    }
    if let (Some(heat), Some(bar)) = (&panel.heat, &frame.color_bar) {
        cells::color_bar(svg, &heat.label, bar);
    }
    axes::frame(svg, &panel.y.label, frame, layout);
    key::legend(svg, frame);
}

/// Shaded ranges, each at least one unit wide so that a single frequency shows.
fn bands(svg: &mut Svg, bands: &[Bands], frame: &Frame, x: &Map) {
    for band in bands {
        svg.group(&format!("fill=\"{}\" fill-opacity=\"{}\"", band.color.hex(), key::SHADE), |svg| {
            for &(from, to) in &band.ranges {
                if let (Some(a), Some(b)) = (x.place(from), x.place(to)) {
                    let width = (b - a).abs().max(1.0);
                    svg.rect(Rect { x: 0.5 * (a + b - width), width, ..frame.plot }, "");
                }
            }
        });
    }
}

/// Reference lines.
fn levels(svg: &mut Svg, levels: &[Level], frame: &Frame) {
    svg.group("fill=\"none\" stroke=\"#000\" stroke-width=\"1.1\" stroke-dasharray=\"7 4\"", |svg| {
        for level in levels {
            if let Some(y) = frame.y.place_inside(level.y) {
                svg.path(&format!("M{} {}H{}", N(frame.plot.x), N(y), N(frame.plot.right())), "");
            }
        }
    });
}
