//! The few SVG elements a plot needs.

use crate::number::N;
use crate::text::{FAMILY, Rise, outlines, runs, width};

/// Text or attribute value with the signs of XML escaped and characters outside XML replaced.
pub(crate) fn escaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => out += "&amp;",
            '<' => out += "&lt;",
            '>' => out += "&gt;",
            '"' => out += "&quot;",
            '\t' | '\n' | '\r' => out.push(' '),
            '\0'..' ' | '\u{fffe}' | '\u{ffff}' => out.push('\u{fffd}'),
            c => out.push(c),
        }
    }
    out
}

/// A rectangle on the page; y grows downwards.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Rect {
    pub(crate) x: f64,
    pub(crate) y: f64,
    pub(crate) width: f64,
    pub(crate) height: f64,
}

impl Rect {
    pub(crate) fn right(&self) -> f64 {
        self.x + self.width
    }

    pub(crate) fn bottom(&self) -> f64 {
        self.y + self.height
    }
}

/// Which point of a text stands at its place.
#[derive(Clone, Copy)]
pub(crate) enum Anchor {
    Start,
    Middle,
    End,
}

/// Where a text runs.
#[derive(Clone, Copy)]
enum Direction {
    Right,
    Up,
}

/// How letters are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Letters {
    /// As text, which can be searched and is set in the font of the reader.
    Text,
    /// As outlines of the embedded font.
    Outlines,
}

/// A document being written.
pub(crate) struct Svg {
    written: String,
    letters: Letters,
}

impl Svg {
    /// An empty white page.
    pub(crate) fn new((width, height): (f64, f64), title: &str, letters: Letters) -> Self {
        let (w, h) = (N(width), N(height));
        let written = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{w}\" height=\"{h}\" viewBox=\"0 0 {w} {h}\" \
             font-family=\"{FAMILY}, Verdana, Arial, sans-serif\" fill=\"#1a1a1a\" \
             xml:space=\"preserve\">\n\
             <title>{}</title>\n",
            escaped(title)
        );
        let mut svg = Self { written, letters };
        svg.rect(Rect { x: 0.0, y: 0.0, width, height }, "fill=\"#fff\"");
        svg
    }

    /// Elements that share attributes.
    pub(crate) fn group(&mut self, attributes: &str, content: impl FnOnce(&mut Self)) {
        self.written += &format!("<g {attributes}>\n");
        content(self);
        self.written += "</g>\n";
    }

    /// Elements of which only what lies within `view` shows.
    pub(crate) fn clipped(&mut self, view: Rect, content: impl FnOnce(&mut Self)) {
        // a nested picture clips without an id, which another figure on the same HTML page could share
        let (x, y, w, h) = (N(view.x), N(view.y), N(view.width), N(view.height));
        self.written += &format!(
            "<svg x=\"{x}\" y=\"{y}\" width=\"{w}\" height=\"{h}\" viewBox=\"{x} {y} {w} {h}\" overflow=\"hidden\">\n"
        );
        content(self);
        self.written += "</svg>\n";
    }

    /// A path given by its commands; nothing if there are no commands.
    pub(crate) fn path(&mut self, commands: &str, attributes: &str) {
        if !commands.is_empty() {
            self.written += &format!("<path d=\"{commands}\" {attributes}/>\n");
        }
    }

    pub(crate) fn rect(&mut self, r: Rect, attributes: &str) {
        let (x, y, w, h) = (N(r.x), N(r.y), N(r.width), N(r.height));
        self.written += &format!("<rect x=\"{x}\" y=\"{y}\" width=\"{w}\" height=\"{h}\" {attributes}/>\n");
    }

    /// A line of text whose baseline passes through (x, y).
    pub(crate) fn text(&mut self, place: (f64, f64), size: f64, anchor: Anchor, text: &str) {
        self.set_text(place, size, anchor, text, Direction::Right);
    }

    /// The same, read from bottom to top.
    pub(crate) fn upward_text(&mut self, place: (f64, f64), size: f64, anchor: Anchor, text: &str) {
        self.set_text(place, size, anchor, text, Direction::Up);
    }

    fn set_text(&mut self, place: (f64, f64), size: f64, anchor: Anchor, text: &str, direction: Direction) {
        match self.letters {
            Letters::Text => self.as_text(place, size, anchor, text, direction),
            Letters::Outlines => self.as_outlines(place, size, anchor, text, direction),
        }
    }

    /// The text as one path.
    fn as_outlines(
        &mut self,
        (x, y): (f64, f64),
        size: f64,
        anchor: Anchor,
        text: &str,
        direction: Direction,
    ) {
        let before = match anchor {
            Anchor::Start => 0.0,
            Anchor::Middle => 0.5,
            Anchor::End => 1.0,
        };
        let start = -before * width(text, size);
        let commands = outlines(text, size, |dx, dy| match direction {
            Direction::Right => (x + start + dx, y + dy),
            Direction::Up => (x + dy, y - start - dx),
        });
        self.path(&commands, &format!("aria-label=\"{}\"", escaped(text)));
    }

    /// The text as a text element.
    fn as_text(&mut self, (x, y): (f64, f64), size: f64, anchor: Anchor, text: &str, direction: Direction) {
        let turn = match direction {
            Direction::Right => String::new(),
            Direction::Up => format!(" transform=\"rotate(-90 {} {})\"", N(x), N(y)),
        };
        let anchor = match anchor {
            Anchor::Start => "start",
            Anchor::Middle => "middle",
            Anchor::End => "end",
        };
        let (x, y, size_n) = (N(x), N(y), N(size));
        self.written +=
            &format!("<text x=\"{x}\" y=\"{y}\" font-size=\"{size_n}\" text-anchor=\"{anchor}\"{turn}>");
        let mut height = 0.0;
        for (rise, run) in runs(text) {
            let (target, size) = rise.set(size);
            let (dy, run) = (N(height - target), escaped(&run));
            match rise {
                Rise::Base if height == 0.0 => self.written += &run,
                _ => self.written += &format!("<tspan dy=\"{dy}\" font-size=\"{}\">{run}</tspan>", N(size)),
            }
            height = target;
        }
        self.written += "</text>\n";
    }

    /// The document.
    pub(crate) fn finish(self) -> String {
        self.written + "</svg>\n"
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_is_escaped() {
        assert_eq!(escaped("a<b & \"c\">\u{1}\n"), "a&lt;b &amp; &quot;c&quot;&gt;\u{fffd} ");
    }
}
