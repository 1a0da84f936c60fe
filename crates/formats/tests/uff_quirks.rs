//! What vendors write, as far as its meaning is known.

use crate::uff_support;

use frfit_formats::uff::{self, DataType, Endian, Form, Function, Record, Spacing, Values};
use frfit_formats::{FormatError, Position};

use uff_support::function;

const EVEN: Spacing = Spacing::Even { minimum: 0.0, increment: 0.5 };

/// A dataset 58 with these lines 6 and 7 and these data.
fn text(record_6: &str, record_7: &str, data: &str) -> String {
    let ids = "NONE\n".repeat(5);
    let axes = "         0    0    0    0 NONE                 NONE\n".repeat(4);
    format!("    -1\n    58\n{ids}{record_6}\n{record_7}\n{axes}{data}    -1\n")
}

const RECORD_6: &str = "    4         0    0         0 NONE               1   3 NONE               1   3";

fn read(bytes: impl AsRef<[u8]>) -> Result<Function, FormatError> {
    uff::File::new(bytes.as_ref())?.function(0)
}

fn real(bytes: impl AsRef<[u8]>) -> Vec<f64> {
    match read(bytes).expect("a readable function").values {
        Values::Real(values) => values,
        Values::Complex(_) => panic!("real values"),
    }
}

fn binary(data_type: DataType, spacing: Spacing, numbers: &[f64]) -> Vec<u8> {
    let form = Form::Binary { endian: Endian::Little };
    uff::write::function(&function(data_type, spacing, numbers), form).expect("a writable function")
}

/// The bytes with `old`, which is there once, replaced.
fn replaced(bytes: &[u8], old: &[u8], new: &[u8]) -> Vec<u8> {
    let places: Vec<usize> = (0..bytes.len()).filter(|&at| bytes[at..].starts_with(old)).collect();
    assert_eq!(places.len(), 1, "{:?} is there once", String::from_utf8_lossy(old));
    [&bytes[..places[0]], new, &bytes[places[0] + old.len()..]].concat()
}

#[test]
fn exponents_with_d_without_letter_and_with_three_digits() {
    let data = "  1.50000D+01  1.50000+101 1.50000E-005 -1.5000d-001  1.50000-300  1.50000E+00\n";
    let values =
        real(text(RECORD_6, "         2         6         1  0.00000E+00  5.00000E-01  0.00000E+00", data));
    assert_eq!(values, [15.0, 1.5e101, 1.5e-5, -0.15, 1.5e-300, 1.5]);
}

#[test]
fn a_short_record_7_and_lines_with_trailing_blanks() {
    let data = "  1.00000E+00  2.00000E+00                                        \r\n 3.0\r\n\r\n";
    let values = real(text(RECORD_6, "         2         3         1", data));
    assert_eq!(values, [1.0, 2.0, 3.0]);
}

#[test]
fn blank_axis_fields_are_zero_but_the_quantity_must_be_there() {
    let record_7 = "         2         1         1";
    let short = text(RECORD_6, record_7, "1.0\n")
        .replace("         0    0    0    0 NONE                 NONE", "        12");
    assert_eq!(real(&short), [1.0]);
    let none = short.replacen("        12\n", "\n", 1);
    let error = read(none).expect_err("a record 8 without a quantity");
    assert_eq!(error.position, Position::Line { line: 10, column: Some(1) });
}

#[test]
fn data_lines_that_are_a_delimiter() {
    let record_7 = "         2         5         1  0.00000E+00  5.00000E-01  0.00000E+00";
    let lone = text(RECORD_6, record_7, "     7\n    -1\n     8\n    -1\n    -1\n");
    let two = lone.clone() + &lone;
    let file = uff::File::new(two.as_bytes()).expect("a readable list");
    assert_eq!(file.entries().len(), 2);
    let values = Values::Real(vec![7.0, -1.0, 8.0, -1.0, -1.0]);
    assert_eq!(file.function(0).map(|function| function.values), Ok(values.clone()));
    assert_eq!(file.function(1).map(|function| function.values), Ok(values));
}

#[test]
fn binary_data_that_hold_a_delimiter() {
    let delimiter = f64::from_le_bytes(*b"    -1\n ");
    let numbers = [1.0, delimiter, 2.0, delimiter, delimiter];
    let bytes = binary(DataType::RealDouble, EVEN, &numbers);
    let two = [bytes.clone(), bytes.clone()].concat();
    let file = uff::File::new(&two).expect("a readable list");
    assert_eq!(file.entries().len(), 2);
    assert_eq!(real(bytes), numbers);
}

#[test]
fn a_line_end_after_binary_data() {
    let bytes = binary(DataType::RealSingle, EVEN, &[1.0, 2.0, 3.0]);
    let end = bytes.len() - b"    -1\n".len();
    for line_end in [&b"\n"[..], b"\r\n", b"\r"] {
        assert_eq!(real([&bytes[..end], line_end, &bytes[end..]].concat()), [1.0, 2.0, 3.0]);
    }
}

#[test]
fn a_wrong_or_missing_byte_count_falls_back_to_the_number_of_points() {
    let delimiter = f64::from_le_bytes(*b"    -1\n ");
    let numbers = [1.0, delimiter, 2.0, 3.0];
    let bytes = binary(DataType::ComplexDouble, EVEN, &numbers);
    for count in ["          16", "           0", "            ", " 99999999999"] {
        let wrong = replaced(&bytes, b"          32     0", format!("{count}     0").as_bytes());
        let function = read(wrong).expect("a readable function");
        assert_eq!(function, self::function(DataType::ComplexDouble, EVEN, &numbers));
    }
}

#[test]
fn binary_data_cut_short_end_at_their_delimiter() {
    let bytes = binary(DataType::RealDouble, EVEN, &[1.0, 2.0, 3.0]);
    let end = bytes.len() - b"    -1\n".len();
    let short = [&bytes[..end - 8], &bytes[end..]].concat();
    let function = read(&short).expect("a readable function");
    assert_eq!((function.values, function.header.points), (Values::Real(vec![1.0, 2.0]), 3));
    let error = uff::scan(&bytes[..end]).expect_err("an unclosed dataset");
    assert_eq!(error.position, Position::Line { line: 1, column: None });
}

#[test]
fn more_data_than_the_header_says_are_refused() {
    let error =
        read(text(RECORD_6, "         2         2         1", "1 2\n3\n")).expect_err("one value too many");
    assert_eq!(error.position, Position::Line { line: 15, column: None });
    let bytes = binary(DataType::RealDouble, EVEN, &[1.0, 2.0, 3.0]);
    let fewer = replaced(&bytes, b"         4         3", b"         4         2");
    let error = read(&fewer).expect_err("one value too many");
    assert!(matches!(error.position, Position::Byte(_)));
}

#[test]
fn a_broken_function_does_not_hide_the_others() {
    let good = text(RECORD_6, "         2         1         1", "1.0\n");
    let bad = text("    x", "         2         1         1", "1.0\n");
    let both = bad + &good;
    let file = uff::File::new(both.as_bytes()).expect("a readable list");
    assert!(file.function_header(0).is_err());
    assert!(file.function(1).is_ok());
    assert!(uff::read_all(both.as_bytes()).is_err());
    assert!(file.function(2).is_err());
}

#[test]
fn other_datasets_are_places() {
    let bytes = b"    -1\n  2420\n anything\n    -1\n    -1\n   999\n    -1\n";
    let records = uff::read_all(bytes).expect("a readable file");
    let [Record::Other { dataset: 2420, bytes: first }, Record::Other { dataset: 999, bytes: second }] =
        &records[..]
    else {
        panic!("two datasets: {records:?}")
    };
    assert_eq!((first.clone(), second.clone()), (0..31, 31..bytes.len()));
    assert!(uff::File::new(bytes).expect("a list").function(0).is_err());
}

#[test]
fn summaries_name_the_ends_of_every_abscissa() {
    let numbers: Vec<f64> = (0..14).map(f64::from).collect();
    for (data_type, spacing) in uff_support::variants() {
        for form in [Form::Ascii, Form::Binary { endian: Endian::Big }] {
            let function = function(data_type, spacing, &numbers);
            let bytes = uff::write::function(&function, form).expect("a writable function");
            let summary = uff::File::new(&bytes).and_then(|file| file.summary(0)).expect("a summary");
            assert_eq!((summary.dataset, summary.line), (58, 1));
            let summary = summary.function.expect("a function");
            let ends = [function.abscissa[0], function.abscissa[function.abscissa.len() - 1]];
            assert_eq!(summary.range, Some(ends), "{data_type:?} {spacing:?} {form:?}");
            assert_eq!((summary.response.as_str(), summary.reference.as_str()), ("34+Z", "1234567-RY"));
            assert_eq!(summary.units, ["Hz", "m/s²", "N"]);
        }
    }
}
