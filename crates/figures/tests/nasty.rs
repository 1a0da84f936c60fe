//! Whatever is put in: the drawing is valid, the same each time, and no label is cut or covers another.

use crate::tier::of_tier;

use frfit_figures::{
    Axis, Bands, Class, Color, Dash, Figure, HeatMap, Level, Marker, Panel, Scale, Series, Strip,
};
use proptest::collection::vec;
use proptest::prelude::*;
use resvg::tiny_skia::Pixmap;
use resvg::usvg::Rect;

/// Numbers with all that can go wrong.
fn number() -> impl Strategy<Value = f64> {
    prop_oneof![
        6 => -1e3..1e3f64,
        2 => any::<f64>(),
        1 => (-320.0..308.0f64).prop_map(|e| 10f64.powf(e)),
        1 => prop_oneof![Just(f64::NAN), Just(f64::INFINITY), Just(f64::NEG_INFINITY), Just(0.0), Just(-0.0)],
    ]
}

fn numbers() -> impl Strategy<Value = Vec<f64>> {
    vec(number(), 0..12)
}

fn scale() -> impl Strategy<Value = Scale> {
    prop_oneof![Just(Scale::Linear), Just(Scale::Whole), Just(Scale::Log)]
}

fn axis() -> impl Strategy<Value = Axis> {
    let range = proptest::option::weighted(0.3, (number(), number()));
    (".{0,60}", scale(), range).prop_map(|(label, scale, range)| Axis { label, scale, range })
}

fn series() -> impl Strategy<Value = Series> {
    let marker = proptest::option::of(prop_oneof![Just(Marker::Circle), Just(Marker::Triangle)]);
    let line = proptest::option::of(prop_oneof![Just(Dash::Solid), Just(Dash::Dotted)]);
    ((".{0,40}", line, marker), numbers(), numbers(), numbers(), numbers()).prop_map(
        |((label, line, marker), x, y, x_error, y_error)| Series {
            label,
            x,
            y,
            x_error,
            y_error,
            color: Color::Green,
            line,
            marker,
        },
    )
}

fn panel() -> impl Strategy<Value = Panel> {
    let range = proptest::option::of((number(), number()));
    let heat = (numbers(), numbers(), vec(number(), 0..100), ".{0,20}", range, vec(".{0,30}", 0..6))
        .prop_map(|(x, y, values, label, range, names)| HeatMap { x, y, values, label, range, names });
    let classes = || vec![Class { label: "<a>".into(), color: Color::Blue }, Class::default()];
    let strip =
        (numbers(), vec(0..4usize, 0..12)).prop_map(move |(x, class)| Strip { x, class, classes: classes() });
    let bands = vec((number(), number()), 0..3);
    let bands = bands.prop_map(|ranges| vec![Bands { label: "band".into(), color: Color::Orange, ranges }]);
    let levels = vec(number().prop_map(|y| Level { label: "level".into(), y }), 0..3);
    (
        axis(),
        vec(series(), 0..3),
        proptest::option::of(heat),
        bands,
        levels,
        proptest::option::of(strip),
        number(),
    )
        .prop_map(|(y, series, heat, bands, levels, strip, height)| Panel {
            y,
            series,
            heat,
            bands,
            levels,
            strip,
            height,
        })
}

fn figure() -> impl Strategy<Value = Figure> {
    (".{0,90}", axis(), vec(panel(), 0..4), (number(), number()))
        .prop_map(|(title, x, panels, size)| Figure { title, x, panels, size })
}

/// Every number in the attributes that hold nothing else.
fn check_numbers(document: &roxmltree::Document<'_>) -> Result<(), TestCaseError> {
    for node in document.descendants() {
        for attribute in node.attributes() {
            let name = attribute.name();
            if !["x", "y", "width", "height", "d", "dy", "viewBox", "font-size", "transform"].contains(&name)
            {
                continue;
            }
            let parts = attribute.value().split(|c: char| !(c.is_ascii_digit() || ".-eE".contains(c)));
            for part in parts.filter(|p| !p.is_empty() && *p != "e") {
                let number = part.parse::<f64>();
                // 10⁵ units is where places end; widths between two of them are at most twice that
                prop_assert!(number.is_ok_and(|n| n.abs() <= 2e5), "{name}=\"{}\"", attribute.value());
            }
        }
    }
    Ok(())
}

/// Boxes of all texts, with their words.
fn texts(document: &roxmltree::Document<'_>) -> Vec<(Rect, String)> {
    let text = |node: roxmltree::Node<'_, '_>| -> Option<(Rect, String)> {
        let words = node.attribute("aria-label")?;
        let numbers = node.attribute("d")?.split(|c: char| c.is_ascii_alphabetic() || c == ' ');
        let numbers: Vec<f32> = numbers.filter_map(|number| number.parse().ok()).collect();
        let of = |axis: usize| numbers.iter().skip(axis).step_by(2).copied();
        let ends = |axis: usize| (of(axis).reduce(f32::min), of(axis).reduce(f32::max));
        let ((left, right), (top, bottom)) = (ends(0), ends(1));
        Some((Rect::from_ltrb(left?, top?, right?, bottom?)?, words.to_owned()))
    };
    document.descendants().filter_map(text).collect()
}

/// A page of equal panels, and the words and numbers on it.
#[derive(Clone)]
struct Page {
    scales: (Scale, Scale),
    panels: usize,
    heat: bool,
    named: bool,
    x: (f64, f64),
    y: (f64, f64),
    title: String,
    label: String,
    size: (f64, f64),
}

/// No label of the page leaves it or covers another.
fn labels_are_whole(page: Page) -> Result<(), TestCaseError> {
    let Page { scales: (x_scale, y_scale), panels, heat, named, x, y, title, label, size } = page;
    // ends such as 1e3 and 1e3·(1 + 10^k): narrow and wide ranges of all magnitudes
    let ends = |(power, span): (f64, f64)| {
        vec![10f64.powf(power), 10f64.powf(power) * (1.0 + 10f64.powf(span - 5.0))]
    };
    let axis = |scale| Axis { label: label.clone(), scale, range: None };
    let curve = Series { label: label.clone(), x: ends(x), y: ends(y), ..Series::default() };
    let names = if named { vec![label.clone(); 2] } else { Vec::new() };
    let map = HeatMap { x: ends(x), y: ends(y), values: ends(y), label: label.clone(), range: None, names };
    let panel = |i: usize| Panel {
        y: axis(y_scale),
        series: vec![Series { color: [Color::Blue, Color::Green, Color::Black][i], ..curve.clone() }],
        heat: heat.then(|| map.clone()),
        ..Panel::default()
    };
    let figure = Figure { title, x: axis(x_scale), panels: (0..panels).map(panel).collect(), size };
    let svg = figure.outlined_svg();
    let document = roxmltree::Document::parse(&svg).expect("a drawing");
    let side = |name: &str| document.root_element().attribute(name).and_then(|side| side.parse().ok());
    let (width, height) = (side("width").unwrap_or(0.0f32), side("height").unwrap_or(0.0));
    let found = texts(&document);
    prop_assert!(!found.is_empty());
    for (i, (a, words)) in found.iter().enumerate() {
        prop_assert!(
            a.left() >= 0.0 && a.top() >= 0.0 && a.right() <= width && a.bottom() <= height,
            "{words} is cut: {a:?} of {width} × {height}"
        );
        for (b, others) in &found[i + 1..] {
            let apart = a.left() >= b.right() - 0.5
                || b.left() >= a.right() - 0.5
                || a.top() >= b.bottom() - 0.5
                || b.top() >= a.bottom() - 0.5;
            prop_assert!(apart, "{words} {a:?} covers {others} {b:?}");
        }
    }
    Ok(())
}

/// The tick labels that a width leaves asked for margins that left others, in turns for ever.
#[test]
fn margins_that_took_turns_settle() {
    let page = Page {
        scales: (Scale::Linear, Scale::Linear),
        panels: 1,
        heat: false,
        named: false,
        x: (6.398_972_449_954_682, 0.918_305_779_530_471_5),
        y: (0.0, 8.162_482_858_109_067),
        title: String::new(),
        label: " ".into(),
        size: (802.359_212_166_608_6, 100.0),
    };
    labels_are_whole(page.clone()).expect("the page that was found");
    for width in (240..1200).step_by(of_tier(7, 1)) {
        labels_are_whole(Page { size: (f64::from(width), 100.0), ..page.clone() }).expect("any width");
    }
}

/// By day a quarter of the cases, each of which is a drawing.
fn cases() -> ProptestConfig {
    let all = ProptestConfig::default();
    ProptestConfig { cases: all.cases / of_tier(4, 1), ..all }
}

proptest! {
    #![proptest_config(cases())]
    #[test]
    fn any_figure_is_a_valid_drawing(figure in figure()) {
        let svg = figure.svg();
        let document = roxmltree::Document::parse(&svg);
        prop_assert!(document.is_ok(), "{document:?}");
        check_numbers(&document.expect("checked"))?;
        prop_assert!(!svg.contains("\"NaN") && !svg.contains("NaN\""));
        prop_assert_eq!(svg, figure.clone().svg());
    }

    #[test]
    fn any_figure_can_be_rasterised(figure in figure()) {
        // a tenth of the resolution: what is tested is the reader of the drawing, not its pixels
        let png = figure.png(0.1);
        prop_assert!(png.is_ok(), "{png:?}");
        prop_assert!(Pixmap::decode_png(&png.unwrap()).is_ok());
    }

    #[test]
    fn no_label_is_cut_or_covers_another(
        x_scale in scale(), y_scale in scale(), panels in 1..4usize, heat in any::<bool>(), named in any::<bool>(),
        x in (-12.0..12.0f64, 0.01..12.0f64), y in (-12.0..12.0f64, 0.01..12.0f64),
        title in "[a-zρε₁⁻ ]{0,150}", label in "[A-Za-zωη⁻¹ ]{1,50}", size in (240.0..1200.0f64, 100.0..900.0f64),
    ) {
        labels_are_whole(Page { scales: (x_scale, y_scale), panels, heat, named, x, y, title, label, size })?;
    }
}
