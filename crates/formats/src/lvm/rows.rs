//! The rows of a segment.

use super::fields::{fields, is_empty};
use super::file_header::XColumns;
use super::segment_header::Announced;
use super::{Abscissa, Lvm, Segment};
use crate::FormatError;
use crate::text::{Lines, quoted};

/// Reads rows up to an empty line or the end of the file.
///
/// Channels may have different numbers of samples: the columns of those that have ended are empty. A channel with fewer
/// samples than its header says belongs to a file that was cut short, and is refused; one with more does not, since
/// a program that appends to a file leaves its header as it is.
pub(super) fn rows(
    announced: Announced,
    lines: &mut Lines<'_>,
    file: &Lvm,
    x_columns: XColumns,
) -> Result<Segment, FormatError> {
    let Announced { mut segment, samples } = announced;
    let separator = file.separator.byte();
    for (row, line) in lines.by_ref().take_while(|line| !is_empty(line, separator)).enumerate() {
        let mut columns = fields(line, separator);
        let mut x = None;
        for (k, channel) in segment.channels.iter_mut().enumerate() {
            if k == 0 || x_columns == XColumns::Multi {
                x = columns.next();
            }
            // A row that ends early: the channels to its right have ended.
            let (Some(x), Some(y)) = (x, columns.next()) else { break };
            if y.bytes.is_empty() {
                continue;
            }
            if channel.values.len() < row {
                return Err(y.error("an empty column, as in the rows above"));
            }
            channel.values.push(y.number(file.decimal)?);
            match &mut channel.abscissa {
                Abscissa::Listed(abscissa) => abscissa.push(x.number(file.decimal)?),
                Abscissa::Even { .. } if x.bytes.is_empty() => {}
                Abscissa::Even { .. } => return Err(x.error("an empty column, as X_Columns is No")),
            }
        }
        // One more is a comment.
        if let (Some(_), Some(extra)) = (columns.next(), columns.next()) {
            let found = quoted(extra.bytes);
            return Err(line.error(
                extra.start,
                "the end of the row after all channels and a comment",
                found,
            ));
        }
    }
    for (channel, promised) in segment.channels.iter().zip(samples) {
        if let Some(promised) = promised.filter(|&promised| promised > channel.values.len() as u64) {
            let expected = format!("{promised} samples of {:?}, as the header says", channel.name);
            return Err(FormatError::line(segment.line, expected, channel.values.len().to_string()));
        }
    }
    Ok(segment)
}
