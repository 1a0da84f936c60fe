//! The data of a 58b.

use crate::FormatError;

use super::entry::BinaryForm;
use super::function_header::{FunctionHeader, Spacing};

/// Order of the bytes of a number.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Endian {
    /// Lowest byte first.
    #[default]
    Little,
    /// Highest byte first.
    Big,
}

const SINGLE: usize = 4;
const DOUBLE: usize = 8;

/// Bytes of one point: all numbers in the precision of the ordinate and, where the ordinate is double and the
/// abscissa stored, with the abscissa in single precision, as the format document has it.
fn point_lengths(header: &FunctionHeader) -> (usize, Option<usize>) {
    let numbers = header.numbers_per_point();
    match (header.data_type.is_double(), header.spacing) {
        (false, _) => (numbers * SINGLE, None),
        (true, Spacing::Even { .. }) => (numbers * DOUBLE, None),
        (true, Spacing::Uneven) => (numbers * DOUBLE, Some(numbers * DOUBLE - SINGLE)),
    }
}

/// How many bytes the promised points may take.
pub(super) fn lengths(header: &FunctionHeader) -> [Option<usize>; 2] {
    let (uniform, mixed) = point_lengths(header);
    [header.points.checked_mul(uniform), mixed.and_then(|mixed| header.points.checked_mul(mixed))]
}

/// The numbers in the order of the file. `offset` is the place of `data` in the file.
pub(super) fn numbers(
    header: &FunctionHeader,
    form: BinaryForm,
    data: &[u8],
    offset: usize,
) -> Result<Vec<f64>, FormatError> {
    let endian = endian(form, offset)?;
    let (uniform, mixed) = point_lengths(header);
    let [_, mixed_total] = lengths(header);
    let is_mixed =
        mixed_total.is_some_and(|total| (total..total.saturating_add(SINGLE)).contains(&data.len()));
    let point = mixed.filter(|_| is_mixed).unwrap_or(uniform);
    if data.len() / point > header.points {
        let expected = format!("{} bytes for {} points", header.points.saturating_mul(point), header.points);
        return Err(FormatError::byte(offset, expected, format!("{} bytes", data.len())));
    }
    let data = &data[..data.len() - data.len() % point];
    Ok(match (header.data_type.is_double(), is_mixed) {
        (false, _) => data.chunks_exact(SINGLE).map(|bytes| single(bytes, endian)).collect(),
        (true, false) => data.chunks_exact(DOUBLE).map(|bytes| double(bytes, endian)).collect(),
        (true, true) => data.chunks_exact(point).flat_map(|bytes| mixed_point(bytes, endian)).collect(),
    })
}

fn endian(form: BinaryForm, offset: usize) -> Result<Endian, FormatError> {
    let BinaryForm { byte_order, float_format } = form;
    // A writer that leaves the floating point format out writes the one that machines have.
    if !matches!(float_format, 0 | 2) {
        return Err(FormatError::byte(
            offset,
            "IEEE 754 numbers (format 2)",
            format!("format {float_format}"),
        ));
    }
    match byte_order {
        1 => Ok(Endian::Little),
        2 => Ok(Endian::Big),
        _ => Err(FormatError::byte(offset, "byte order 1 or 2", format!("{byte_order}"))),
    }
}

fn mixed_point(bytes: &[u8], endian: Endian) -> impl Iterator<Item = f64> {
    let (abscissa, ordinate) = bytes.split_at(SINGLE);
    std::iter::once(single(abscissa, endian))
        .chain(ordinate.chunks_exact(DOUBLE).map(move |bytes| double(bytes, endian)))
}

/// The number in the first four bytes, of which there have to be four.
fn single(bytes: &[u8], endian: Endian) -> f64 {
    let bytes = bytes.first_chunk().copied().unwrap_or_default();
    f64::from(match endian {
        Endian::Little => f32::from_le_bytes(bytes),
        Endian::Big => f32::from_be_bytes(bytes),
    })
}

/// The number in the first eight bytes, of which there have to be eight.
fn double(bytes: &[u8], endian: Endian) -> f64 {
    let bytes = bytes.first_chunk().copied().unwrap_or_default();
    match endian {
        Endian::Little => f64::from_le_bytes(bytes),
        Endian::Big => f64::from_be_bytes(bytes),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::uff::DataType;

    fn header(data_type: DataType, points: usize) -> FunctionHeader {
        FunctionHeader { data_type, points, spacing: Spacing::Uneven, ..FunctionHeader::default() }
    }

    const BIG: BinaryForm = BinaryForm { byte_order: 2, float_format: 2 };

    #[test]
    fn the_length_tells_single_from_double_abscissae() {
        let double: Vec<u8> = [0.5, 7.0, 1.5, 8.0_f64].iter().flat_map(|x| x.to_be_bytes()).collect();
        let mut mixed = Vec::new();
        for (x, y) in [(0.5_f32, 7.0_f64), (1.5, 8.0)] {
            mixed.extend(x.to_be_bytes());
            mixed.extend(y.to_be_bytes());
        }
        let header = header(DataType::RealDouble, 2);
        assert_eq!(numbers(&header, BIG, &double, 0), Ok(vec![0.5, 7.0, 1.5, 8.0]));
        assert_eq!(numbers(&header, BIG, &mixed, 0), Ok(vec![0.5, 7.0, 1.5, 8.0]));
    }

    #[test]
    fn a_line_end_after_the_data_is_no_number() {
        let mut data: Vec<u8> = [0.5, 7.0_f32].iter().flat_map(|x| x.to_be_bytes()).collect();
        data.extend(b"\r\n");
        assert_eq!(numbers(&header(DataType::RealSingle, 1), BIG, &data, 0), Ok(vec![0.5, 7.0]));
    }

    #[test]
    fn more_points_than_promised_and_other_number_formats_are_refused() {
        let header = header(DataType::RealSingle, 1);
        assert!(numbers(&header, BIG, &[0; 16], 0).is_err());
        assert!(numbers(&header, BinaryForm { byte_order: 1, float_format: 1 }, &[0; 8], 0).is_err());
        assert!(numbers(&header, BinaryForm { byte_order: 0, float_format: 2 }, &[0; 8], 0).is_err());
    }
}
