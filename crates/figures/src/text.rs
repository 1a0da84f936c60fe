//! Text as it is set: raised and lowered digits, widths, outlines, shortening.

use std::fmt::Write;
use std::sync::LazyLock;

use ttf_parser::{Face, OutlineBuilder};

use crate::number::N;

/// The embedded font, DejaVu Sans: it has the Greek, mathematical and superscript signs. It is part of the program; widths are a fair guess if it could not be
/// read.
static FONT: LazyLock<Option<Face<'static>>> = LazyLock::new(|| Face::parse(dejavu::sans::regular(), 0).ok());

/// Name of [`FONT`].
pub(crate) const FAMILY: &str = "DejaVu Sans";

/// Size of raised and lowered text relative to the text around it.
const SMALL: f64 = 0.72;

/// How a run of characters stands on the line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Rise {
    Base,
    Super,
    Sub,
}

impl Rise {
    /// How far it is above the line, and how large it is, in a text of a size.
    pub(crate) fn set(self, size: f64) -> (f64, f64) {
        match self {
            Self::Base => (0.0, size),
            Self::Super => (0.38 * size, SMALL * size),
            Self::Sub => (-0.18 * size, SMALL * size),
        }
    }
}

/// The text in runs of one rise each, superscript and subscript signs replaced by full-size ones:
/// not every font has the former, and those that do mix sizes.
pub(crate) fn runs(text: &str) -> Vec<(Rise, String)> {
    let mut runs: Vec<(Rise, String)> = Vec::new();
    for (rise, c) in text.chars().map(plain) {
        match runs.last_mut() {
            Some((last, run)) if *last == rise => run.push(c),
            _ => runs.push((rise, c.to_string())),
        }
    }
    runs
}

/// A character's rise and its full-size form.
fn plain(c: char) -> (Rise, char) {
    const FULL: &str = "0123456789+−n";
    let full = |small: &str| small.chars().zip(FULL.chars()).find(|(s, _)| *s == c).map(|(_, f)| f);
    if let Some(f) = full("⁰¹²³⁴⁵⁶⁷⁸⁹⁺⁻ⁿ") {
        (Rise::Super, f)
    } else if let Some(f) = full("₀₁₂₃₄₅₆₇₈₉₊₋ₙ") {
        (Rise::Sub, f)
    } else {
        (Rise::Base, c)
    }
}

/// Width of the text set in the embedded font at `size`.
pub(crate) fn width(text: &str, size: f64) -> f64 {
    let Some(font) = &*FONT else { return 0.6 * size * text.chars().count() as f64 };
    let run = |(rise, run): (Rise, String)| {
        let (_, size) = rise.set(size);
        size * run.chars().map(|c| advance(font, c)).sum::<f64>()
    };
    runs(text).into_iter().map(run).sum()
}

/// How far a character leads, in a font of size 1.
fn advance(font: &Face<'_>, c: char) -> f64 {
    let units = font.glyph_index(c).and_then(|glyph| font.glyph_hor_advance(glyph));
    units.map_or(1.0, |units| f64::from(units) / f64::from(font.units_per_em()))
}

/// The outlines of the text set in the embedded font at `size`, from the origin to the right, as the commands of an SVG path; each point is put to its place by `at`.
pub(crate) fn outlines(text: &str, size: f64, at: impl Fn(f64, f64) -> (f64, f64)) -> String {
    let mut commands = String::new();
    let Some(font) = &*FONT else { return commands };
    let mut x = 0.0;
    for (rise, run) in runs(text) {
        let (height, size) = rise.set(size);
        let scale = size / f64::from(font.units_per_em());
        for c in run.chars() {
            // A character that the font lacks is shown as glyph 0.
            let glyph = font.glyph_index(c).unwrap_or_default();
            let place = |dx: f32, up: f32| at(x + scale * f64::from(dx), -height - scale * f64::from(up));
            font.outline_glyph(glyph, &mut Outline { commands: &mut commands, place });
            x += size * advance(font, c);
        }
    }
    commands
}

/// Writes the outline of a glyph.
struct Outline<'c, P> {
    commands: &'c mut String,
    place: P,
}

impl<P: Fn(f32, f32) -> (f64, f64)> Outline<'_, P> {
    fn add(&mut self, command: char, points: &[(f32, f32)]) {
        self.commands.push(command);
        for &(x, y) in points {
            let (x, y) = (self.place)(x, y);
            // Writing to a text does not fail.
            let _ = write!(self.commands, "{} {} ", N(x), N(y));
        }
    }
}

impl<P: Fn(f32, f32) -> (f64, f64)> OutlineBuilder for Outline<'_, P> {
    fn move_to(&mut self, x: f32, y: f32) {
        self.add('M', &[(x, y)]);
    }

    fn line_to(&mut self, x: f32, y: f32) {
        self.add('L', &[(x, y)]);
    }

    fn quad_to(&mut self, x1: f32, y1: f32, x: f32, y: f32) {
        self.add('Q', &[(x1, y1), (x, y)]);
    }

    fn curve_to(&mut self, x1: f32, y1: f32, x2: f32, y2: f32, x: f32, y: f32) {
        self.add('C', &[(x1, y1), (x2, y2), (x, y)]);
    }

    fn close(&mut self) {
        self.commands.push('Z');
    }
}

/// The text and the size at which it fits into `room`: smaller by up to 30 %, then cut with an ellipsis.
pub(crate) fn fitted(text: &str, size: f64, room: f64) -> (String, f64) {
    let full = width(text, size);
    if full <= room {
        return (text.to_owned(), size);
    }
    let size = size * (room / full).max(0.7);
    let mut kept: String = text.chars().take((room / (0.2 * size)).ceil().max(0.0) as usize).collect();
    if kept == text && width(&kept, size) <= room * (1.0 + 1e-9) {
        return (kept, size);
    }
    while !kept.is_empty() && width(&kept, size) + width("…", size) > room {
        kept.pop();
    }
    (kept + "…", size)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_font_has_the_signs_of_the_trade() {
        let font = FONT.as_ref().expect("embedded font");
        for c in "ηρωεδαλΔΣ′″−×·…⁻₀°≤≥→µ".chars() {
            assert!(font.glyph_index(c).is_some(), "no glyph for {c}");
        }
    }

    #[test]
    fn superscripts_become_raised_runs() {
        let got = runs("10⁻⁵ c₁");
        let want = [(Rise::Base, "10"), (Rise::Super, "−5"), (Rise::Base, " c"), (Rise::Sub, "1")];
        assert_eq!(got, want.map(|(rise, run)| (rise, run.to_owned())));
        assert!(width("10⁻⁵", 13.0) < width("10−5", 13.0));
    }

    #[test]
    fn outlines_end_where_the_width_does() {
        let ends = |text: &str| {
            let numbers = outlines(text, 100.0, |x, y| (x, y));
            let numbers = numbers.split(|c: char| !(c.is_ascii_digit() || ".-".contains(c)));
            let numbers: Vec<f64> = numbers.filter_map(|number| number.parse().ok()).collect();
            let of = |axis: usize| numbers.iter().skip(axis).step_by(2).copied();
            [of(0).fold(0.0, f64::max), of(1).fold(f64::INFINITY, f64::min), of(1).fold(-99.0, f64::max)]
        };
        // An H of DejaVu Sans is 0.729 high, and ends 0.098 before the next letter.
        let [right, top, bottom] = ends("HHH");
        assert!(
            (right - (width("HHH", 100.0) - 9.8)).abs() < 0.1 && (top + 72.9).abs() < 0.1 && bottom == 0.0
        );
        assert!(ends("H²")[1] < -80.0 && ends("H₂")[2] > 15.0);
        assert_eq!(outlines(" ", 100.0, |x, y| (x, y)), "");
    }

    #[test]
    fn long_text_shrinks_and_is_then_cut() {
        assert_eq!(fitted("short", 10.0, 100.0), ("short".into(), 10.0));
        let room = 0.8 * width("some words", 10.0);
        let (text, size) = fitted("some words", 10.0, room);
        assert_eq!(text, "some words");
        assert!((size - 8.0).abs() < 1e-9); // one rounding of a product
        let (text, size) = fitted(&"word ".repeat(1000), 10.0, 100.0);
        assert!(text.ends_with('…') && text.len() > 10);
        assert!(width(&text, size) <= 100.0);
    }
}
