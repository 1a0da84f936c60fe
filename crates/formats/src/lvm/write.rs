//! The writer.

use super::file_header::{END, MAGIC};
use super::{Abscissa, Channel, DecimalSign, Lvm, Segment, Separator};
use crate::FormatError;

/// Writes a measurement file. Numbers have the shortest digits that read back to the same bits.
///
/// # Errors
/// No segment, or one without channels; texts that hold a separator or a line break or begin or end with blanks; a key that
/// the writer itself writes; a number that is not finite, a step that is not positive; listed abscissae
/// in one channel and a step in another, or not as many as there are samples; a comma as separator and decimal sign.
pub fn write(file: &Lvm) -> Result<String, FormatError> {
    let writer = Writer::new(file)?;
    let mut out = String::from_utf8_lossy(MAGIC).into_owned();
    out.push(writer.separator);
    out.push('\n');
    let (separator, decimal) = match (file.separator, file.decimal) {
        (Separator::Tab, DecimalSign::Point) => ("Tab", "."),
        (Separator::Tab, DecimalSign::Comma) => ("Tab", ","),
        (Separator::Comma, _) => ("Comma", "."),
    };
    let own = [
        ("Writer_Version", "2"),
        ("Reader_Version", "2"),
        ("Separator", separator),
        ("Decimal_Separator", decimal),
        ("Multi_Headings", "Yes"),
        ("X_Columns", if writer.listed { "Multi" } else { "No" }),
    ];
    for (key, value) in own {
        writer.line(&mut out, [key, value].map(str::to_owned));
    }
    for (key, value) in &file.header {
        if matches!(key.as_str(), "" | "Separator" | "Decimal_Separator" | "X_Columns")
            || key.as_bytes() == END
            || key.starts_with("Separator")
        {
            return Err(FormatError::whole("a key that is not the writer's own", format!("{key:?}")));
        }
        if WRITTEN.contains(&key.as_str()) {
            continue;
        }
        writer.line(&mut out, [writer.text(key)?, writer.text(value)?]);
    }
    writer.end(&mut out);
    for segment in &file.segments {
        writer.segment(&mut out, segment)?;
    }
    Ok(out)
}

/// Keys of a file that was read and that say nothing about its contents.
const WRITTEN: [&str; 3] = ["Writer_Version", "Reader_Version", "Multi_Headings"];

struct Writer {
    separator: char,
    decimal: DecimalSign,
    listed: bool,
}

impl Writer {
    fn new(file: &Lvm) -> Result<Self, FormatError> {
        if (file.separator, file.decimal) == (Separator::Comma, DecimalSign::Comma) {
            return Err(FormatError::whole("different signs for columns and decimals", "a comma for both"));
        }
        let mut channels = file.segments.iter().flat_map(|segment| &segment.channels);
        let is_listed = |channel: &Channel| matches!(channel.abscissa, Abscissa::Listed(_));
        let listed = channels.clone().next().is_some_and(is_listed);
        if channels.any(|channel| is_listed(channel) != listed) {
            let found = "listed abscissae and even ones";
            return Err(FormatError::whole("abscissae of one kind in a file", found));
        }
        if file.segments.is_empty() || file.segments.iter().any(|segment| segment.channels.is_empty()) {
            return Err(FormatError::whole("at least one segment, and channels in each", "none"));
        }
        Ok(Self { separator: file.separator.byte().into(), decimal: file.decimal, listed })
    }

    fn segment(&self, out: &mut String, segment: &Segment) -> Result<(), FormatError> {
        let channels = &segment.channels;
        out.push('\n');
        self.line(out, ["Channels".to_owned(), channels.len().to_string()]);
        self.entry(out, "Samples", channels, |channel| Ok(channel.values.len().to_string()))?;
        for (key, value) in [("Date", &segment.date), ("Time", &segment.time)] {
            if !value.is_empty() {
                self.entry(out, key, channels, |_| self.text(value))?;
            }
        }
        self.entry(out, "Y_Unit_Label", channels, |channel| self.text(&channel.unit))?;
        self.entry(out, "X_Dimension", channels, |_| Ok("Time".to_owned()))?;
        if !self.listed {
            let even = |channel: &Channel| match channel.abscissa {
                Abscissa::Even { start, step } => [start, step],
                Abscissa::Listed(_) => [f64::NAN; 2],
            };
            self.entry(out, "X0", channels, |channel| self.number(even(channel)[0]))?;
            self.entry(out, "Delta_X", channels, |channel| match even(channel)[1] {
                step if step > 0.0 => self.number(step),
                step => Err(FormatError::whole("a step above 0", step.to_string())),
            })?;
        }
        self.end(out);
        let mut names = vec!["X_Value".to_owned()];
        for (k, channel) in channels.iter().enumerate() {
            if self.listed && k > 0 {
                names.push("X_Value".to_owned());
            }
            names.push(self.text(&channel.name)?);
        }
        names.push("Comment".to_owned());
        self.line(out, names);
        self.rows(out, channels)
    }

    fn rows(&self, out: &mut String, channels: &[Channel]) -> Result<(), FormatError> {
        for channel in channels {
            let (points, values) = match &channel.abscissa {
                Abscissa::Listed(x) => (x.len(), channel.values.len()),
                Abscissa::Even { .. } => continue,
            };
            if points != values {
                let expected = format!("{values} abscissae of {:?}", channel.name);
                return Err(FormatError::whole(expected, points.to_string()));
            }
        }
        let rows = channels.iter().map(|channel| channel.values.len()).max().unwrap_or(0);
        for row in 0..rows {
            let mut cells = Vec::with_capacity(2 * channels.len());
            for (k, channel) in channels.iter().enumerate() {
                let cell = |values: &[f64]| values.get(row).map_or(Ok(String::new()), |&x| self.number(x));
                match &channel.abscissa {
                    Abscissa::Listed(x) => cells.push(cell(x)?),
                    Abscissa::Even { .. } if k == 0 => cells.push(String::new()),
                    Abscissa::Even { .. } => {}
                }
                cells.push(cell(&channel.values)?);
            }
            self.line(out, cells);
        }
        Ok(())
    }

    /// A key with one value a channel.
    fn entry(
        &self,
        out: &mut String,
        key: &str,
        channels: &[Channel],
        value: impl Fn(&Channel) -> Result<String, FormatError>,
    ) -> Result<(), FormatError> {
        let mut cells = vec![key.to_owned()];
        for channel in channels {
            cells.push(value(channel)?);
        }
        self.line(out, cells);
        Ok(())
    }

    fn line(&self, out: &mut String, cells: impl IntoIterator<Item = String>) {
        for (k, cell) in cells.into_iter().enumerate() {
            if k > 0 {
                out.push(self.separator);
            }
            out.push_str(&cell);
        }
        out.push('\n');
    }

    fn end(&self, out: &mut String) {
        self.line(out, [String::from_utf8_lossy(END).into_owned()]);
    }

    /// A text that reads back as it is.
    fn text(&self, text: &str) -> Result<String, FormatError> {
        let is_plain = !text.contains([self.separator, '\n', '\r']) && text.trim_ascii() == text;
        match is_plain && !text.starts_with('\u{feff}') {
            true => Ok(text.to_owned()),
            false => Err(FormatError::whole(
                "text without separators, line breaks and outer blanks",
                format!("{text:?}"),
            )),
        }
    }

    fn number(&self, value: f64) -> Result<String, FormatError> {
        if !value.is_finite() {
            return Err(FormatError::whole("finite numbers", value.to_string()));
        }
        let text = format!("{value:?}");
        Ok(match self.decimal {
            DecimalSign::Point => text,
            DecimalSign::Comma => text.replace('.', ","),
        })
    }
}
