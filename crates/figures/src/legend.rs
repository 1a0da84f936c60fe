//! What is named above a panel.

use crate::series::{Dash, Marker};
use crate::text::{fitted, width};
use crate::{Color, Panel};

/// Length of a sample and the gaps after it and after its name.
pub(crate) const SAMPLE: f64 = 28.0;
const GAP: f64 = 6.0;
const SPACE: f64 = 18.0;

/// How a thing looks in the plot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Look {
    Curve { color: Color, line: Option<Dash>, marker: Option<Marker> },
    Shade(Color),
    Fill(Color),
}

/// A look and its name.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Entry {
    pub(crate) look: Look,
    pub(crate) label: String,
}

/// An entry's place: left end within the legend, row, and its name as it fits.
#[derive(Clone, Debug)]
pub(crate) struct Placed {
    pub(crate) entry: Entry,
    pub(crate) x: f64,
    pub(crate) row: usize,
    pub(crate) text: (String, f64),
}

/// Everything named in a panel. What shares name and colour is one thing: a curve and its points.
pub(crate) fn entries(panel: &Panel) -> Vec<Entry> {
    let curve = |color, line, marker| Look::Curve { color, line, marker };
    let series = panel.series.iter().map(|s| (curve(s.color, s.line, s.marker), &s.label));
    let levels = panel.levels.iter().map(|l| (curve(Color::Black, Some(Dash::Dashed), None), &l.label));
    let bands = panel.bands.iter().map(|b| (Look::Shade(b.color), &b.label));
    let classes = panel.strip.iter().flat_map(|strip| {
        let occurring = strip.classes.iter().enumerate().filter(|(i, _)| strip.class.contains(i));
        occurring.map(|(_, c)| (Look::Fill(c.color), &c.label))
    });
    let mut entries: Vec<Entry> = Vec::new();
    for (look, label) in series.chain(levels).chain(bands).chain(classes).filter(|(_, l)| !l.is_empty()) {
        match entries.iter_mut().find(|e| e.label == *label && e.look.color() == look.color()) {
            Some(entry) => entry.look = entry.look.with(look),
            None => entries.push(Entry { look, label: label.clone() }),
        }
    }
    entries
}

impl Look {
    fn color(self) -> Color {
        match self {
            Self::Curve { color, .. } | Self::Shade(color) | Self::Fill(color) => color,
        }
    }

    /// This look, with the line or the marker of the other where it has none.
    fn with(self, other: Self) -> Self {
        match (self, other) {
            (Self::Curve { color, line, marker }, Self::Curve { line: l, marker: m, .. }) => {
                Self::Curve { color, line: line.or(l), marker: marker.or(m) }
            }
            _ => self,
        }
    }
}

/// The entries in one row, or in columns if that would be longer than `room`.
pub(crate) fn place(entries: Vec<Entry>, size: f64, room: f64) -> Vec<Placed> {
    let texts: Vec<_> = entries.iter().map(|e| fitted(&e.label, size, room - SAMPLE - GAP)).collect();
    let lengths: Vec<f64> =
        texts.iter().map(|(text, size)| SAMPLE + GAP + width(text, *size) + SPACE).collect();
    let column = if lengths.iter().sum::<f64>() - SPACE > room {
        lengths.iter().copied().fold(0.0, f64::max)
    } else {
        0.0
    };
    let (mut x, mut row) = (0.0, 0);
    let mut placed = Vec::new();
    for ((entry, text), length) in entries.into_iter().zip(texts).zip(lengths) {
        let length = length.max(column);
        if x > 0.0 && x + length - SPACE > room {
            (x, row) = (0.0, row + 1);
        }
        placed.push(Placed { entry, x, row, text });
        x += length;
    }
    placed
}

impl Placed {
    /// Left end of the name.
    pub(crate) fn text_x(&self) -> f64 {
        self.x + SAMPLE + GAP
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_curve_and_its_points_are_one_entry() {
        let series = |line, marker| crate::Series { label: "N".into(), line, marker, ..Default::default() };
        let series = vec![series(Some(Dash::Dotted), None), series(None, Some(Marker::Plus))];
        let look = Look::Curve { color: Color::Black, line: Some(Dash::Dotted), marker: Some(Marker::Plus) };
        let entry = Entry { look, label: "N".into() };
        assert_eq!(entries(&Panel { series, ..Panel::default() }), [entry]);
    }

    #[test]
    fn entries_wrap_within_the_room() {
        let look = Look::Fill(Color::Blue);
        let entries = (0..9).map(|i| Entry { look, label: format!("entry {i}") }).collect();
        let placed = place(entries, 12.0, 300.0);
        assert!(placed.last().is_some_and(|p| p.row > 1));
        for p in &placed {
            assert!(p.text_x() + width(&p.text.0, p.text.1) <= 300.0);
        }
    }
}
