//! The header of a segment: one value a channel.

use super::fields::{Field, fields, is_empty};
use super::file_header::{END, XColumns};
use super::{Abscissa, Channel, DecimalSign, Lvm, Segment};
use crate::FormatError;
use crate::text::{Line, Lines, quoted, whole};

/// What is between these two lines belongs to the program that wrote it.
const SPECIAL: [&[u8]; 2] = [b"***Start_Special***", b"***End_Special***"];

/// Channels without their samples, and how many samples each is said to have.
pub(super) struct Announced {
    pub(super) segment: Segment,
    pub(super) samples: Vec<Option<u64>>,
}

/// Reads from the first line of a segment's header to the line with the names.
pub(super) fn segment_header(
    first: Line<'_>,
    lines: &mut Lines<'_>,
    file: &Lvm,
    x_columns: XColumns,
) -> Result<Announced, FormatError> {
    let separator = file.separator.byte();
    let mut entries: Vec<(String, Vec<Field<'_>>)> = Vec::new();
    let mut line = first;
    let mut special = false;
    loop {
        let mut values = fields(line, separator);
        let key = values.next().map_or(String::new(), |key| key.text());
        if key.as_bytes() == END && !special {
            break;
        }
        special = key.as_bytes() == SPECIAL[0] || special && key.as_bytes() != SPECIAL[1];
        if !special && !key.is_empty() {
            entries.push((key, values.collect()));
        }
        let end =
            || FormatError::line(first.number, "***End_of_Header*** of a segment", "the end of the file");
        line = lines.next().ok_or_else(end)?;
    }
    let find = |key: &str| entries.iter().find(|(k, _)| k == key).map_or(&[][..], |(_, values)| values);
    let Some(channels) = find("Channels").first() else {
        let found = format!("a header without it in line {}", first.number);
        return Err(FormatError::line(line.number, "the number of Channels of a segment", found));
    };
    let names = names(lines, line, separator)?;
    // Columns with names before the first channel, and from one channel to the next.
    let (skip, stride) = match x_columns {
        XColumns::No | XColumns::One => (1, 1),
        XColumns::Multi => (1, 2),
    };
    let there = names.iter().skip(skip).step_by(stride).count();
    let count = whole(channels.bytes).and_then(|n| usize::try_from(n).ok()).filter(|&n| n > 0 && n <= there);
    let Some(count) = count else {
        return Err(channels.error(format!("1 to {there} channels, as many as there are names below")));
    };
    let mut announced = Announced {
        segment: Segment {
            line: first.number,
            date: find("Date").first().map_or(String::new(), Field::text),
            time: find("Time").first().map_or(String::new(), Field::text),
            channels: Vec::with_capacity(count),
        },
        samples: Vec::with_capacity(count),
    };
    for (k, name) in names.iter().skip(skip).step_by(stride).take(count).enumerate() {
        let at = |key: &str| find(key).get(k).filter(|field| !field.bytes.is_empty());
        let abscissa = match x_columns {
            XColumns::No => even(at("X0"), at("Delta_X"), name, file.decimal)?,
            XColumns::One | XColumns::Multi => Abscissa::Listed(Vec::new()),
        };
        let unit = at("Y_Unit_Label").map_or(String::new(), Field::text);
        announced.segment.channels.push(Channel { name: name.text(), unit, abscissa, values: Vec::new() });
        let samples = at("Samples")
            .map(|field| whole(field.bytes).ok_or_else(|| field.error("a number of samples")))
            .transpose()?;
        announced.samples.push(samples);
    }
    Ok(announced)
}

/// The fields of the line with the names.
fn names<'a>(lines: &mut Lines<'a>, header: Line<'_>, separator: u8) -> Result<Vec<Field<'a>>, FormatError> {
    let missing = |line: usize, found: String| {
        FormatError::line(line, "a line X_Value with the names of the columns", found)
    };
    let line = lines.find(|line| !is_empty(line, separator));
    let line = line.ok_or_else(|| missing(header.number, "the end of the file".into()))?;
    let names: Vec<Field<'_>> = fields(line, separator).collect();
    match names.first() {
        Some(first) if first.bytes == b"X_Value" => Ok(names),
        _ => Err(missing(line.number, quoted(line.bytes))),
    }
}

fn even(
    start: Option<&Field<'_>>,
    step: Option<&Field<'_>>,
    name: &Field<'_>,
    decimal: DecimalSign,
) -> Result<Abscissa, FormatError> {
    let start = start.map_or(Ok(0.0), |field| field.number(decimal))?;
    let Some(field) = step else {
        return Err(FormatError::line(
            name.line.number,
            "a Delta_X for each channel, as there is no column of X",
            format!("none for {}", quoted(name.bytes)),
        ));
    };
    match field.number(decimal)? {
        step if step > 0.0 => Ok(Abscissa::Even { start, step }),
        _ => Err(field.error("a Delta_X above 0")),
    }
}
