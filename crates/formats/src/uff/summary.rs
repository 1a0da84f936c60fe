//! A dataset in a few words, for lists.

use crate::FormatError;

use super::binary;
use super::data::field_widths;
use super::data_lines;
use super::entry::Entry;
use super::function_header::{FunctionHeader, Spacing};
use super::lines::Lines;
use super::read_header::function_header;

/// A dataset in a few words.
#[derive(Debug, Clone, PartialEq)]
pub struct Summary {
    /// Dataset number.
    pub dataset: u32,
    /// Whether its data are binary.
    pub binary: bool,
    /// Line of the opening `-1`, from 1.
    pub line: usize,
    /// What function it is, for a 58.
    pub function: Option<FunctionSummary>,
}

/// A function in a few words.
#[derive(Debug, Clone, PartialEq)]
pub struct FunctionSummary {
    /// ID line 1.
    pub id: String,
    /// Name of the function type.
    pub function_type: &'static str,
    /// Response degree of freedom: `34+Z`.
    pub response: String,
    /// Reference degree of freedom.
    pub reference: String,
    /// Number of points that the header promises.
    pub points: usize,
    /// Whether the abscissa is evenly spaced.
    pub even: bool,
    /// First and last abscissa, in the unit of the abscissa; `None` without points, or where the end of a
    /// stored abscissa is not where the header and the format say.
    pub range: Option<[f64; 2]>,
    /// Real or complex, single or double precision.
    pub data_type: &'static str,
    /// What abscissa, ordinate and ordinate denominator are.
    pub quantities: [&'static str; 3],
    /// Unit labels of abscissa, ordinate and ordinate denominator; empty where the file gives none.
    pub units: [String; 3],
}

impl FunctionSummary {
    pub(super) fn read(file: &[u8], entry: &Entry) -> Result<Self, FormatError> {
        let mut lines = entry.lines(file);
        let header = function_header(&mut lines)?;
        let range = match header.spacing {
            Spacing::Even { minimum, increment } => {
                let last = header.points.checked_sub(1);
                last.map(|last| [minimum, minimum + last as f64 * increment])
            }
            Spacing::Uneven if entry.is_binary() => ends_of_binary(&header, entry, lines.rest()),
            Spacing::Uneven => ends_of_text(&header, &lines),
        };
        let axes = [&header.abscissa, &header.ordinate, &header.denominator];
        Ok(Self {
            function_type: header.function_type.name(),
            response: header.response.label(),
            reference: header.reference.label(),
            points: header.points,
            even: header.spacing != Spacing::Uneven,
            range,
            data_type: header.data_type.name(),
            quantities: axes.map(|axis| axis.quantity.name()),
            units: axes.map(|axis| axis.unit.clone()),
            id: header.id.into_iter().next().unwrap_or_default(),
        })
    }
}

fn ends_of_binary(header: &FunctionHeader, entry: &Entry, data: &[u8]) -> Option<[f64; 2]> {
    let last = header.points.checked_sub(1)?;
    let length =
        binary::lengths(header).into_iter().flatten().find(|&length| data.len().abs_diff(length) <= 2)?;
    let point = length / header.points;
    let one = FunctionHeader { points: 1, ..header.clone() };
    let abscissa = |k: usize| {
        let bytes = data.get(k.checked_mul(point)?..)?.get(..point)?;
        binary::numbers(&one, entry.binary?, bytes, 0).ok()?.first().copied()
    };
    Some([abscissa(0)?, abscissa(last)?])
}

/// The first number of the first line, and the abscissa of the last point on the last line, which holds as many
/// points as the lines before it leave.
fn ends_of_text(header: &FunctionHeader, lines: &Lines<'_>) -> Option<[f64; 2]> {
    let last_point = header.points.checked_sub(1)?;
    let numbers_per_line = if header.data_type.is_double() { 4 } else { 6 };
    let per_point = header.numbers_per_point();
    let points_per_line = numbers_per_line / per_point;
    let text = lines.rest().trim_ascii_end();
    let last_line = text.iter().rposition(|&byte| byte == b'\n').map_or(0, |newline| newline + 1);
    let number = |text: &[u8], place: usize| {
        let mut line = Lines::new(text, 1).find(|line| !line.is_blank())?;
        line.bytes = line.bytes.get(..LONGEST_LINE).unwrap_or(line.bytes);
        let mut numbers = Vec::new();
        data_lines::read_line(line, field_widths(header), place + 1, &mut numbers).ok()?;
        numbers.get(place).copied()
    };
    Some([number(text, 0)?, number(text.get(last_line..)?, last_point % points_per_line * per_point)?])
}

/// A line of the format has at most 80 characters; more than that is looked at for those who pad.
const LONGEST_LINE: usize = 256;
