//! Heat maps, strips and colour bars.

use std::collections::BTreeMap;

use super::axes;
use crate::color::{MISSING, viridis};
use crate::heat::{Cell, cells};
use crate::layout::{ColorBar, Frame};
use crate::number::N;
use crate::scale::Map;
use crate::svg::{Rect, Svg};
use crate::{HeatMap, Strip};

/// Neighbouring cells must meet without the hairline that blended edges leave.
const SHARP: &str = "shape-rendering=\"crispEdges\"";

/// Draws the cells; false if none has a value.
pub(super) fn heat_map(svg: &mut Svg, heat: &HeatMap, frame: &Frame, x: &Map) -> bool {
    let Some(bar) = &frame.color_bar else { return false };
    let (lo, hi) = bar.map.range;
    let level =
        |value: f64| value.is_finite().then(|| (256.0 * (value - lo) / (hi - lo)).clamp(0.0, 255.0) as u8);
    let columns = cells(&heat.x, x.scale);
    // one path a colour keeps the file small
    let mut paths: BTreeMap<Option<u8>, String> = BTreeMap::new();
    for row in cells(&heat.y, frame.y.scale) {
        let (Some(bottom), Some(top)) = (frame.y.place(row.from), frame.y.place(row.to)) else { continue };
        let value = |column: usize| heat.values.get(row.index * heat.x.len() + column).copied();
        for (left, right, level) in runs(&columns, x, |column| value(column).and_then(level)) {
            let (left, right) = (N(left), N(right));
            // absolute coordinates: neighbours share theirs to the digit, so that no gap opens by rounding
            *paths.entry(level).or_default() += &format!("M{left} {}H{right}V{}H{left}z", N(bottom), N(top));
        }
    }
    svg.group(SHARP, |svg| {
        for (level, path) in &paths {
            svg.path(path, &format!("fill=\"{}\"", level.map_or(MISSING.into(), viridis)));
        }
    });
    paths.keys().any(Option::is_some)
}

/// The colours of a heat map with their values.
pub(super) fn color_bar(svg: &mut Svg, label: &str, bar: &ColorBar) {
    let height = bar.bar.height / 64.0;
    svg.group(SHARP, |svg| {
        for i in 0..64u8 {
            let y = bar.bar.bottom() - f64::from(i + 1) * height;
            svg.rect(Rect { y, height, ..bar.bar }, &format!("fill=\"{}\"", viridis(4 * i + 2)));
        }
    });
    axes::bar(svg, label, bar);
}

/// The cells of a strip, neighbours of one class as one.
pub(super) fn strip(svg: &mut Svg, strip: &Strip, place: Rect, x: &Map) {
    let class = |i: usize| strip.class.get(i).and_then(|&class| strip.classes.get(class));
    let fill = |i: usize| class(i).map_or(MISSING, |c| c.color.hex());
    svg.clipped(place, |svg| {
        svg.group(SHARP, |svg| {
            for (left, right, fill) in runs(&cells(&strip.x, x.scale), x, fill) {
                svg.rect(Rect { x: left, width: right - left, ..place }, &format!("fill=\"{fill}\""));
            }
        });
    });
}

/// Cells from left to right on the page, neighbours with the same key as one.
fn runs<K: PartialEq>(cells: &[Cell], x: &Map, key: impl Fn(usize) -> K) -> Vec<(f64, f64, K)> {
    let mut runs: Vec<(f64, f64, K)> = Vec::new();
    for cell in cells {
        let (Some(left), Some(right)) = (x.place(cell.from), x.place(cell.to)) else { continue };
        let key = key(cell.index);
        match runs.last_mut() {
            Some((_, end, last)) if *last == key => *end = right,
            _ => runs.push((left, right, key)),
        }
    }
    runs
}
