//! Lines, markers and error bars.

use crate::Series;
use crate::number::N;
use crate::scale::Map;
use crate::series::{Dash, Marker};
use crate::svg::Svg;

/// Width of curves.
pub(super) const LINE: f64 = 1.7;
/// Half-size of markers.
const RADIUS: f64 = 3.2;
/// Half-size of markers of which there are so many that they would hide everything else.
const SMALL: f64 = 1.1;
/// So many markers without a line lie side by side at their full size.
const SPARSE: f64 = 120.0;
/// Markers on a line keep this distance.
const APART: f64 = 7.0;
/// Half-length of the caps of error bars.
const CAP: f64 = 2.5;

/// Draws line and error bars (to be clipped by the frame); false if no point can be drawn.
pub(super) fn lines(svg: &mut Svg, series: &Series, x: &Map, y: &Map) -> bool {
    let places: Vec<Option<(f64, f64)>> = series.points().map(|(a, b)| x.place(a).zip(y.place(b))).collect();
    let color = series.color.hex();
    let bars = error_bars(series, x, y);
    svg.path(&bars, &format!("fill=\"none\" stroke=\"{color}\" stroke-width=\"1\""));
    if let Some(dash) = series.line {
        let (path, lone) = polyline(&places);
        svg.path(&path, &stroke(color, dash));
        // a point between two gaps has no line to show it
        svg.path(&lone, &format!("fill=\"{color}\""));
    }
    places.iter().any(Option::is_some)
}

/// Attributes of a line.
pub(super) fn stroke(color: &str, dash: Dash) -> String {
    let pattern = match dash {
        Dash::Solid => "",
        Dash::Dashed => " stroke-dasharray=\"7 4\"",
        Dash::Dotted => " stroke-dasharray=\"1.8 2.8\"",
        Dash::DashDot => " stroke-dasharray=\"9 3 1.8 3\"",
    };
    format!("fill=\"none\" stroke=\"{color}\" stroke-width=\"{LINE}\" stroke-linejoin=\"round\"{pattern}")
}

/// A path that starts again after each gap, and dots for points between two gaps.
fn polyline(places: &[Option<(f64, f64)>]) -> (String, String) {
    let (mut path, mut lone) = (String::new(), String::new());
    for piece in places.split(Option::is_none) {
        let mut points = piece.iter().flatten();
        match (points.next(), piece.len()) {
            (Some(&point), 1) => lone += &outline(Marker::Disc, point, 1.3),
            (Some(&(x, y)), _) => {
                path += &format!("M{} {}L", N(x), N(y));
                let rest: Vec<String> = points.map(|&(x, y)| format!("{} {}", N(x), N(y))).collect();
                path += &rest.join(" ");
            }
            (None, _) => {}
        }
    }
    (path, lone)
}

/// Error bars with caps. On a logarithmic axis an end at or below 0 lies beyond the frame.
fn error_bars(series: &Series, x: &Map, y: &Map) -> String {
    let ends = |map: &Map, value: f64, error: f64| {
        (map.place(value - error).unwrap_or(2.0 * map.page.0 - map.page.1), map.place(value + error))
    };
    let mut path = String::new();
    for (i, (a, b)) in series.points().enumerate() {
        let Some((px, py)) = x.place(a).zip(y.place(b)) else { continue };
        let (x_error, y_error) = series.errors(i);
        if let Some((from, Some(to))) = x_error.map(|e| ends(x, a, e)) {
            let (from, to, top, cap) = (N(from), N(to), N(py - CAP), N(2.0 * CAP));
            path += &format!("M{from} {}H{to}M{from} {top}v{cap}M{to} {top}v{cap}", N(py));
        }
        if let Some((from, Some(to))) = y_error.map(|e| ends(y, b, e)) {
            let (from, to, left, cap) = (N(from), N(to), N(px - CAP), N(2.0 * CAP));
            path += &format!("M{} {from}V{to}M{left} {from}h{cap}M{left} {to}h{cap}", N(px));
        }
    }
    path
}

/// Markers of the points within the frame, whole even at its edge.
pub(super) fn markers(svg: &mut Svg, series: &Series, x: &Map, y: &Map) {
    let Some(marker) = series.marker else { return };
    let mut last: Option<(f64, f64)> = None;
    let mut path = String::new();
    let radius = radius(series);
    for point in series.points().filter_map(|(a, b)| x.place_inside(a).zip(y.place_inside(b))) {
        let crowded = last.is_some_and(|(a, b)| (point.0 - a).hypot(point.1 - b) < APART);
        if series.line.is_none() || !crowded {
            path += &outline(marker, point, radius);
            last = Some(point);
        }
    }
    svg.path(&path, &paint(series.color.hex(), marker));
}

/// Half-size of the markers of a series. On a line those that would crowd are left out; without one all are drawn, and are the smaller the more there are: their area with their
/// number, so that what they cover stays the same.
fn radius(series: &Series) -> f64 {
    if series.line.is_some() {
        return RADIUS;
    }
    let count = series.points().filter(|(x, y)| x.is_finite() && y.is_finite()).count() as f64;
    (RADIUS * (SPARSE / count.max(SPARSE)).sqrt()).max(SMALL)
}

/// Attributes of markers.
fn paint(color: &str, marker: Marker) -> String {
    match marker {
        Marker::Disc => format!("fill=\"{color}\""),
        _ => format!("fill=\"none\" stroke=\"{color}\" stroke-width=\"1.2\""),
    }
}

/// One marker alone, for the legend.
pub(super) fn marker(svg: &mut Svg, color: &str, marker: Marker, place: (f64, f64)) {
    svg.path(&outline(marker, place, RADIUS), &paint(color, marker));
}

/// Path of a marker of half-size `r`.
fn outline(marker: Marker, (x, y): (f64, f64), r: f64) -> String {
    let (left, r2) = (N(x - r), N(2.0 * r));
    match marker {
        Marker::Circle | Marker::Disc => {
            let (r, back) = (N(r), N(-2.0 * r));
            format!("M{left} {}a{r} {r} 0 1 0 {r2} 0a{r} {r} 0 1 0 {back} 0z", N(y))
        }
        Marker::Square => format!("M{left} {}h{r2}v{r2}h{}z", N(y - r), N(-2.0 * r)),
        Marker::Triangle => format!("M{left} {}h{r2}L{} {}z", N(y + 0.8 * r), N(x), N(y - 1.1 * r)),
        Marker::Diamond => {
            let a = 1.25 * r;
            format!(
                "M{} {}L{} {}L{} {}L{} {}z",
                N(x - a),
                N(y),
                N(x),
                N(y - a),
                N(x + a),
                N(y),
                N(x),
                N(y + a)
            )
        }
        Marker::Cross => {
            let (up, down) = (N(-2.0 * r), N(2.0 * r));
            format!("M{left} {}l{r2} {down}M{left} {}l{r2} {up}", N(y - r), N(y + r))
        }
        Marker::Plus => format!("M{left} {}h{r2}M{} {}v{r2}", N(y), N(x), N(y - r)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_gap_starts_the_path_anew_and_a_lone_point_is_a_dot() {
        let p = |x| Some((x, 5.0));
        let (path, lone) = polyline(&[p(1.0), p(2.0), None, p(3.0), None, None, p(4.0), p(5.0), p(6.0)]);
        assert_eq!(path, "M1 5L2 5M4 5L5 5 6 5");
        assert_eq!(lone.matches('M').count(), 1);
        assert!(lone.starts_with("M1.7 5"));
    }
}
