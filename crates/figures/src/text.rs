//! Text as it is set: raised and lowered digits, widths, shortening.

use skrifa::instance::{LocationRef, Size};
use skrifa::{FontRef, MetadataProvider};

/// The embedded font, DejaVu Sans: it has the Greek, mathematical and superscript signs.
pub(crate) fn font() -> &'static [u8] {
    dejavu::sans::regular()
}

/// Name of [`font`].
pub(crate) const FAMILY: &str = "DejaVu Sans";

/// Size of raised and lowered text relative to the text around it.
pub(crate) const SMALL: f64 = 0.72;

/// How a run of characters stands on the line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Rise {
    Base,
    Super,
    Sub,
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
    // the font is part of the program; a reader that could not read it would still get a fair guess
    let Ok(font) = FontRef::new(font()) else { return 0.6 * size * text.chars().count() as f64 };
    let (charmap, metrics) = (font.charmap(), font.glyph_metrics(Size::new(1.0), LocationRef::default()));
    let advance = |c: char| f64::from(charmap.map(c).and_then(|g| metrics.advance_width(g)).unwrap_or(1.0));
    let run = |(rise, run): (Rise, String)| {
        let size = if rise == Rise::Base { size } else { SMALL * size };
        size * run.chars().map(advance).sum::<f64>()
    };
    runs(text).into_iter().map(run).sum()
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
        let font = FontRef::new(font()).expect("embedded font");
        for c in "ηρωεδαλΔΣ′″−×·…⁻₀°≤≥→µ".chars() {
            assert!(font.charmap().map(c).is_some(), "no glyph for {c}");
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
