//! The ranges that axes show.

use crate::axis::{Axis, Scale};
use crate::heat::cells;
use crate::scale::{LIMIT, drawable, to_linear, to_scale};
use crate::{Figure, HeatMap, Panel};

/// Spans below this part of the magnitude are taken as constant: tick labels would need more digits
/// than anyone reads.
const FLAT: f64 = 1e-9;

/// Part of the span left free at both ends of an axis with curves.
const MARGIN: f64 = 0.04;

/// All ranges of a figure, which no layout changes.
pub(crate) struct Ranges {
    pub(crate) x: (f64, f64),
    pub(crate) panels: Vec<PanelRanges>,
}

/// The range of y, and of the values of a heat map.
pub(crate) struct PanelRanges {
    pub(crate) y: (f64, f64),
    pub(crate) values: Option<(f64, f64)>,
}

impl Ranges {
    /// The ranges of a figure.
    pub(crate) fn of(figure: &Figure) -> Self {
        let panel =
            |p: &Panel| PanelRanges { y: of_y(p, figure.x.scale), values: p.heat.as_ref().map(of_values) };
        Self { x: of_x(figure), panels: figure.panels.iter().map(panel).collect() }
    }
}

/// The shared x range: of series, heat maps and strips; of bands if there is nothing else.
fn of_x(figure: &Figure) -> (f64, f64) {
    let axis = &figure.x;
    let mut values = Vec::new();
    let mut margin = 0.015;
    for panel in &figure.panels {
        for series in &panel.series {
            for (i, (x, y)) in series.points().enumerate() {
                if drawable(y, panel.y.scale) {
                    around(x, series.errors(i).0, &mut values);
                }
            }
        }
        for centres in panel.heat.iter().map(|h| &h.x).chain(panel.strip.iter().map(|s| &s.x)) {
            margin = 0.0;
            values.extend(cells(centres, axis.scale).iter().flat_map(|c| [c.from, c.to]));
        }
    }
    if !values.iter().any(|&v| drawable(v, axis.scale)) {
        let ranges = figure.panels.iter().flat_map(|p| &p.bands).flat_map(|b| &b.ranges);
        values.extend(ranges.flat_map(|r| [r.0, r.1]));
    }
    fitted(axis, values, margin)
}

/// The y range of a panel, over the points whose x can be drawn.
fn of_y(panel: &Panel, x: Scale) -> (f64, f64) {
    let mut values = Vec::new();
    for series in &panel.series {
        for (i, (at, y)) in series.points().enumerate() {
            if drawable(at, x) {
                around(y, series.errors(i).1, &mut values);
            }
        }
    }
    if let Some(heat) = &panel.heat {
        values.extend(cells(&heat.y, panel.y.scale).iter().flat_map(|c| [c.from, c.to]));
    }
    values.extend(panel.levels.iter().map(|l| l.y));
    fitted(&panel.y, values, if panel.heat.is_some() { 0.0 } else { MARGIN })
}

/// The range of a colour bar, without margin: its ends are colours.
fn of_values(heat: &HeatMap) -> (f64, f64) {
    let axis = Axis { range: heat.range, ..Axis::default() };
    fitted(&axis, heat.values.iter().copied(), 0.0)
}

/// A value and the ends of its error bar.
fn around(value: f64, error: Option<f64>, values: &mut Vec<f64>) {
    let error = error.unwrap_or(0.0);
    values.extend([value - error, value, value + error]);
}

/// The axis' own range if it can be drawn, else that of the values with `margin` on both sides.
fn fitted(axis: &Axis, values: impl IntoIterator<Item = f64>, margin: f64) -> (f64, f64) {
    let scale = axis.scale;
    let own = axis.range.map(|(a, b)| (a.min(b), a.max(b)));
    if let Some((lo, hi)) = own
        && [lo, hi].iter().all(|&v| drawable(v, scale))
        && !flat(to_scale(lo, scale), to_scale(hi, scale))
    {
        return (lo, hi);
    }
    let extent =
        values.into_iter().filter(|&v| drawable(v, scale)).fold(None, |extent: Option<(f64, f64)>, v| {
            extent.map_or(Some((v, v)), |(lo, hi)| Some((lo.min(v), hi.max(v))))
        });
    let Some((lo, hi)) = extent else {
        return if scale == Scale::Log { (1.0, 10.0) } else { (0.0, 1.0) };
    };
    let (lo, hi) = (to_scale(lo, scale), to_scale(hi, scale));
    let spread = match scale {
        _ if !flat(lo, hi) => margin * (hi - lo),
        Scale::Log => 0.5,
        Scale::Linear | Scale::Whole if lo.abs().max(hi.abs()) < 1.0 / LIMIT => 1.0,
        Scale::Linear | Scale::Whole => 0.1 * lo.abs().max(hi.abs()),
    };
    (to_linear(lo - spread, scale), to_linear(hi + spread, scale))
}

/// Whether two coordinates are one for the eye.
fn flat(lo: f64, hi: f64) -> bool {
    let magnitude = lo.abs().max(hi.abs());
    magnitude < 1.0 / LIMIT || hi - lo <= FLAT * magnitude
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(axis: Axis, values: &[f64]) -> (f64, f64) {
        fitted(&axis, values.iter().copied(), MARGIN)
    }

    #[test]
    fn margins_are_a_part_of_the_span() {
        assert_eq!(of(Axis::linear(""), &[100.0, f64::NAN, 0.0]), (-4.0, 104.0));
        let (lo, hi) = of(Axis::log(""), &[1.0, 1e10, -3.0, 0.0]);
        // one rounding of 10^x
        assert!((lo.log10() + 0.4).abs() < 1e-12 && (hi.log10() - 10.4).abs() < 1e-12);
    }

    #[test]
    fn constants_and_nothing_have_a_range() {
        assert_eq!(of(Axis::linear(""), &[5.0, 5.0]), (4.5, 5.5));
        assert_eq!(of(Axis::linear(""), &[0.0]), (-1.0, 1.0));
        assert_eq!(of(Axis::linear(""), &[f64::INFINITY]), (0.0, 1.0));
        assert_eq!(of(Axis::log(""), &[-1.0]), (1.0, 10.0));
    }

    #[test]
    fn an_own_range_rules_only_if_it_can_be_drawn() {
        let axis = |range| Axis { range: Some(range), ..Axis::log("") };
        assert_eq!(of(axis((10.0, 1.0)), &[3.0, 4.0]), (1.0, 10.0));
        for bad in [(0.0, 1.0), (f64::NAN, 1.0), (2.0, 2.0), (1.0, f64::INFINITY)] {
            let (lo, hi) = of(axis(bad), &[3.0, 4.0]);
            assert!(lo > 2.5 && hi < 4.5, "{bad:?} gave {lo} to {hi}");
        }
    }
}
