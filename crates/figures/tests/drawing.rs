//! What a reader of the SVG or of the PNG sees.

use frfit_figures::{Axis, Bands, Class, Color, Figure, HeatMap, Marker, Panel, PngError, Series, Strip};
use resvg::tiny_skia::Pixmap;
use roxmltree::Document;

/// A figure of one panel on linear axes.
fn figure(panel: Panel) -> Figure {
    Figure { title: "A title".into(), x: Axis::linear("x (m)"), panels: vec![panel], ..Figure::default() }
}

fn series(x: &[f64], y: &[f64]) -> Series {
    Series { label: "s".into(), x: x.into(), y: y.into(), color: Color::Blue, ..Series::default() }
}

/// The commands of all paths with this attribute.
fn paths(svg: &str, attribute: (&str, &str)) -> Vec<String> {
    let document = Document::parse(svg).expect("valid XML");
    let nodes = document.descendants().filter(|n| n.attribute(attribute.0) == Some(attribute.1));
    nodes.filter_map(|n| n.attribute("d")).map(str::to_owned).collect()
}

/// All texts of a drawing.
fn texts(svg: &str) -> Vec<String> {
    let document = Document::parse(svg).expect("valid XML");
    let texts = document.descendants().filter(|n| n.has_tag_name("text"));
    texts.map(|t| t.descendants().filter(|n| n.is_text()).filter_map(|n| n.text()).collect()).collect()
}

const BLUE: &str = "#0072b2";

#[test]
fn a_curve_is_never_joined_across_a_gap() {
    let y = [1.0, 2.0, f64::NAN, 2.0, 3.0, f64::INFINITY, -1.0, 0.0];
    let x: Vec<f64> = (0..8).map(f64::from).collect();
    let svg = figure(Panel { series: vec![series(&x, &y)], ..Panel::default() }).svg();
    let curve = paths(&svg, ("stroke", BLUE));
    assert_eq!(curve[0].matches('M').count(), 3, "{curve:?}");
    // on a logarithmic axis the last two have no place either
    let panel = Panel { y: Axis::log(""), series: vec![series(&x, &y)], ..Panel::default() };
    let curve = paths(&figure(panel).svg(), ("stroke", BLUE));
    assert_eq!(curve[0].matches('M').count(), 2, "{curve:?}");
}

#[test]
fn text_is_escaped_and_superscripts_are_raised() {
    let mut figure = figure(Panel { series: vec![series(&[0.0, 1.0], &[1.0, 2.0])], ..Panel::default() });
    figure.title = "ε < 10⁻⁸ & \"ρ\" > 1 \u{0}".into();
    assert!(texts(&figure.svg()).contains(&"ε < 10−8 & \"ρ\" > 1 \u{fffd}".to_owned()));
}

#[test]
fn an_empty_panel_says_so() {
    let of = |panel| texts(&figure(panel).svg()).contains(&"no data".to_owned());
    assert!(of(Panel::default()));
    assert!(of(Panel { series: vec![series(&[1.0], &[f64::NAN])], ..Panel::default() }));
    let heat = HeatMap { x: vec![1.0], y: vec![1.0], values: vec![f64::NAN], ..HeatMap::default() };
    assert!(of(Panel { heat: Some(heat), ..Panel::default() }));
    assert!(!of(Panel { series: vec![series(&[1.0], &[1.0])], ..Panel::default() }));
}

#[test]
fn rows_of_a_heat_map_have_their_names() {
    let heat = |rows: u32| HeatMap {
        x: vec![1.0, 2.0],
        y: (1..=rows).map(f64::from).collect(),
        values: vec![0.5; 2 * rows as usize],
        names: (1..=rows).map(|k| format!("row {k}")).collect(),
        ..HeatMap::default()
    };
    let drawn = |rows| texts(&figure(Panel { heat: Some(heat(rows)), ..Panel::default() }).svg());
    let names = |rows| drawn(rows).into_iter().filter(|text| text.starts_with("row ")).collect::<Vec<_>>();
    assert_eq!(names(3), ["row 1", "row 2", "row 3"]);
    // so many would touch: every so many are named, the first among them
    let few = names(200);
    assert!(few.len() < 30 && few.len() > 5 && few[0] == "row 1", "{few:?}");
}

#[test]
fn heat_cells_stand_at_their_true_places() {
    // cells 0.5..1.5, 1.5..3, 3..5 on a frame without margin: widths 1 : 1.5 : 2
    let heat = HeatMap {
        x: vec![1.0, 2.0, 4.0],
        y: vec![1.0],
        values: vec![0.0, f64::NAN, 1.0],
        ..HeatMap::default()
    };
    let svg = figure(Panel { heat: Some(heat), ..Panel::default() }).svg();
    let width = |fill: &str| {
        let path = &paths(&svg, ("fill", fill))[0];
        let place = |s: Option<&str>| s.and_then(|s| s.parse::<f64>().ok()).expect("M x y H x V");
        let right = path.split(['H', 'V']).nth(1);
        place(right) - place(path.trim_start_matches('M').split(' ').next())
    };
    let (low, missing, high) = (width("#440154"), width("#c8c8c8"), width("#fde725"));
    // coordinates are written to two decimals
    assert!((missing / low - 1.5).abs() < 1e-3 && (high / low - 2.0).abs() < 1e-3, "{low} {missing} {high}");
}

#[test]
fn only_classes_that_occur_are_named() {
    let class = |label: &str, color| Class { label: label.into(), color };
    let strip = Strip {
        x: vec![1.0, 2.0, 3.0],
        class: vec![0, 7, 0],
        classes: vec![class("ok", Color::Green), class("diverged", Color::Vermilion)],
    };
    let texts = texts(&figure(Panel { strip: Some(strip), ..Panel::default() }).svg());
    assert!(texts.contains(&"ok".into()) && !texts.contains(&"diverged".into()));
}

#[test]
fn panels_do_not_repeat_a_legend() {
    let panel = || Panel { series: vec![series(&[0.0, 1.0], &[0.0, 1.0])], ..Panel::default() };
    let figure = Figure { panels: vec![panel(), panel()], ..Figure::default() };
    assert_eq!(texts(&figure.svg()).iter().filter(|t| *t == "s").count(), 1);
}

#[test]
fn an_error_bar_that_reaches_zero_runs_to_the_frame_of_a_logarithmic_axis() {
    let bar = Series { y_error: vec![2.0, 0.0], ..series(&[1.0, 2.0], &[1.0, 100.0]) };
    let svg = figure(Panel { y: Axis::log(""), series: vec![bar], ..Panel::default() }).svg();
    let bars = &paths(&svg, ("stroke-width", "1"))[0];
    let from = bars.split([' ', 'V']).nth(1).and_then(|s| s.parse::<f64>().ok()).expect("M x y");
    assert!(from > Figure::default().size.1, "{bars}");
}

/// Of a thousand points the markers are smaller than of ten, and all are there.
#[test]
fn many_markers_are_small_and_leave_something_to_be_seen() {
    let markers = |count: usize| {
        let x: Vec<f64> = (0..count).map(|k| k as f64).collect();
        let points =
            Series { label: String::new(), marker: Some(Marker::Disc), line: None, ..series(&x, &x) };
        let svg = figure(Panel { series: vec![points], ..Panel::default() }).svg();
        paths(&svg, ("fill", BLUE)).concat()
    };
    // Each disc is two arcs of its radius: `a r r 0 1 0 …`.
    let radius = |path: &str| {
        let arc = path.split('a').nth(1).unwrap();
        arc.split(' ').next().unwrap().parse::<f64>().unwrap()
    };
    let (few, many) = (markers(10), markers(1000));
    assert_eq!((few.matches('M').count(), many.matches('M').count()), (10, 1000));
    assert!(
        radius(&few) > 3.0 && radius(&many) < 1.5 && radius(&many) > 0.9,
        "{} {}",
        radius(&few),
        radius(&many)
    );
}

#[test]
fn a_curve_far_outside_the_range_keeps_its_direction() {
    let axis = Axis { range: Some((0.0, 1.0)), ..Axis::linear("y") };
    let panel = Panel { y: axis, series: vec![series(&[0.0, 1.0], &[0.5, 1e200])], ..Panel::default() };
    let curve = paths(&figure(panel).svg(), ("stroke", BLUE));
    assert!(curve[0].ends_with("-100000"), "{curve:?}");
}

#[test]
fn the_png_is_the_picture_at_the_size_asked_for() -> Result<(), PngError> {
    let band = Bands { ranges: vec![(0.2, 0.4)], color: Color::Vermilion, ..Bands::default() };
    let points = Series { marker: Some(Marker::Disc), ..series(&[0.0, 1.0], &[0.0, 1.0]) };
    let figure = figure(Panel { series: vec![points], bands: vec![band], ..Panel::default() });
    let picture = Pixmap::decode_png(&figure.png(1.25)?).expect("a PNG");
    assert_eq!((picture.width(), picture.height()), (900, 575));
    let count = |rgb: [u8; 3]| {
        picture.pixels().iter().filter(|p| [p.red(), p.green(), p.blue()] == rgb && p.alpha() == 255).count()
    };
    assert!(count([0x00, 0x72, 0xb2]) > 100, "no curve");
    // the shade is a fifth of the colour on white
    assert!(count([0xf7, 0xdf, 0xcc]) > 10_000, "no band");
    // text is there: some pixels have its ink, beside the frame
    assert!(count([0x1a, 0x1a, 0x1a]) > 100, "no text");
    Ok(())
}

#[test]
fn outlines_have_the_words_of_the_text() {
    let figure = figure(Panel { series: vec![series(&[0.0, 1.0], &[0.0, 1.0])], ..Panel::default() });
    let outlined = figure.outlined_svg();
    let document = Document::parse(&outlined).expect("valid XML");
    let mut labels: Vec<&str> = document.descendants().filter_map(|n| n.attribute("aria-label")).collect();
    let mut words = texts(&figure.svg());
    words.retain(|text| !text.is_empty());
    assert!(texts(&outlined).is_empty() && words.len() > 8);
    labels.sort_unstable();
    words.sort();
    assert_eq!(labels, words);
}

#[test]
fn a_resolution_without_picture_is_refused() {
    let figure = figure(Panel::default());
    for resolution in [0.0, -1.0, 1e-9, 1e9, f64::NAN, f64::INFINITY] {
        let got = figure.png(resolution);
        assert!(matches!(got, Err(PngError::Size { .. })), "{resolution}: {:?}", got.map(|p| p.len()));
    }
}
