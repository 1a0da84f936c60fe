//! What files in the wild do beyond the letter of their format.

use frfit_formats::{CoordinateMatrix, Entries, FileKind, Symmetry, detect, harwell_boeing, matrix_market};
use num_complex::Complex64 as c64;

fn market(text: &str) -> CoordinateMatrix {
    matrix_market::read(text.as_bytes()).unwrap_or_else(|e| panic!("{e}\n{text}"))
}

/// Positions from 1.
fn positions(matrix: &CoordinateMatrix) -> Vec<(usize, usize)> {
    matrix.rows.iter().zip(&matrix.cols).map(|(row, col)| (row + 1, col + 1)).collect()
}

#[test]
fn comments_blank_lines_cr_lf_and_letter_case_do_not_matter() {
    let matrix = market(
        "\u{feff}%%matrixmarket MATRIX Coordinate REAL General \r\n% one\r\n\r\n  %two \r\n\t2  3   2 \r\n\
         % three\r\n\r\n  2 1\t1.5D+01  \r\n1 3 -2.5-1",
    );
    assert_eq!((matrix.nrows, matrix.ncols, matrix.title.as_str()), (2, 3, "one\ntwo"));
    assert_eq!(positions(&matrix), [(2, 1), (1, 3)]);
    assert_eq!(matrix.entries, Entries::Real(vec![15.0, -0.25]));
}

#[test]
fn duplicates_are_summed_in_the_order_of_the_file() {
    let matrix =
        market("%%MatrixMarket matrix coordinate real general\n1 1 3\n1 1 1e100\n1 1 -1e100\n1 1 1\n");
    assert_eq!(matrix.entries, Entries::Real(vec![1.0]));
    let matrix = market("%%MatrixMarket matrix coordinate pattern general\n2 1 3\n2 1\n1 1\n2 1\n");
    assert_eq!((positions(&matrix), matrix.entries), (vec![(1, 1), (2, 1)], Entries::Pattern));
}

#[test]
fn an_upper_triangle_is_mirrored() {
    let read = |field: &str, symmetry: &str, value: &str| {
        let text = format!("%%MatrixMarket matrix coordinate {field} {symmetry}\n2 2 1\n1 2 {value}\n");
        let matrix = market(&text);
        assert_eq!(positions(&matrix), [(2, 1)]);
        matrix.entries
    };
    assert_eq!(read("integer", "symmetric", "7"), Entries::Real(vec![7.0]));
    assert_eq!(read("real", "skew-symmetric", "7"), Entries::Real(vec![-7.0]));
    assert_eq!(read("complex", "hermitian", "7 8"), Entries::Complex(vec![c64::new(7.0, -8.0)]));
    assert_eq!(read("complex", "symmetric", "7 8"), Entries::Complex(vec![c64::new(7.0, 8.0)]));
}

#[test]
fn arrays_are_read_column_by_column_without_their_zeros() {
    let read = |symmetry: &str, size: &str, values: &[i32]| {
        let lines: Vec<_> = values.iter().map(i32::to_string).collect();
        let text = format!("%%MatrixMarket matrix array real {symmetry}\n{size}\n{}\n", lines.join("\n"));
        let matrix = market(&text);
        let Entries::Real(entries) = &matrix.entries else { panic!("{matrix:?}") };
        positions(&matrix).into_iter().zip(entries.iter().map(|x| *x as i32)).collect::<Vec<_>>()
    };
    assert_eq!(
        read("general", "2 3", &[1, 0, 3, 4, 0, 6]),
        [((1, 1), 1), ((1, 2), 3), ((2, 2), 4), ((2, 3), 6)]
    );
    assert_eq!(
        read("symmetric", "3 3", &[1, 2, 3, 4, 5, 6]),
        [((1, 1), 1), ((2, 1), 2), ((3, 1), 3), ((2, 2), 4), ((3, 2), 5), ((3, 3), 6)]
    );
    assert_eq!(read("skew-symmetric", "3 3", &[1, 2, 3]), [((2, 1), 1), ((3, 1), 2), ((3, 2), 3)]);
}

/// A Harwell–Boeing file of the matrix [1 4; 2 5; 3 6] by columns, or of what `kind` makes of its entries.
fn boeing(kind: &str, size: &str, formats: &str, counts: [usize; 4], body: &str) -> String {
    let total: usize = counts.iter().sum();
    let [pointers, indices, values, rhs] = counts;
    format!(
        "{:<72}{:<8}\n{total:14}{pointers:14}{indices:14}{values:14}{rhs:14}\n{kind:<14}{size}\n{formats}\n{body}",
        "Title", "Key"
    )
}

fn read_boeing(text: &str) -> CoordinateMatrix {
    assert_eq!(detect(text.as_bytes()), Some(FileKind::HarwellBoeing));
    harwell_boeing::read(text.as_bytes()).unwrap_or_else(|e| panic!("{e}\n{text}"))
}

const RECTANGLE: &str = "             3             2             6             0";
const SQUARE: &str = "             2             2             3             0";

#[test]
fn harwell_boeing_values_are_read_by_their_format() {
    for (format, lines, values) in [
        ("(10F7.1)", 1, "     10     20    3.0    4.0     50     60\n"),
        ("(3F4.0)", 2, "   1   2   3\r\n 4.  5.  6. \r\n"),
        (
            "(1P,3D25.17)",
            2,
            &format!(
                "{:>25}{:>25}{:>25}\n{:>25}{:>25}{:>25}\n",
                "1D0", "10.", "3.0D+00", "4.+0", "5.0q0", "0.06+2"
            ),
        ),
        ("(3(1PE8.1))", 2, " 1.0E+00 2.0E+00 3.0E+00\n 4.0E+00 5.0E+00 0.6E+01\n"),
        ("(2(1X,E9.2))", 3, "  1.00E+00  2.00E+00\n  3.00E+00  4.00E+00\n  5.00E+00  6.00E+00\n"),
    ] {
        // In (1P,3D25.17) a field without a point has 17 implied decimals, one without an exponent is
        // divided by ten.
        let first = if format.starts_with("(1P") { 1e-17 } else { 1.0 };
        let body = format!("  1  4  7\n  1  2  3  1  2  3\n{values}");
        let formats = format!("{:<16}{:<16}{format:<20}", "(10I3)", "(10I3)");
        let matrix = read_boeing(&boeing("RRA", RECTANGLE, &formats, [1, 1, lines, 0], &body));
        let expected = [first, if first == 1.0 { 2.0 } else { 1.0 }, 3.0, 4.0, 5.0, 6.0];
        assert_eq!(matrix.entries, Entries::Real(expected.to_vec()), "{format}");
        assert_eq!(matrix.title, "Title\nKey");
    }
}

#[test]
fn harwell_boeing_types_are_read_by_their_letters() {
    let formats = "(3I2)           (3I2)           (2F3.0)";
    let pattern = read_boeing(&boeing("PUA", SQUARE, formats, [1, 1, 0, 0], " 1 3 4\n 2 1 2\n"));
    assert_eq!((positions(&pattern), pattern.entries), (vec![(1, 1), (2, 1), (2, 2)], Entries::Pattern));
    let body = " 1 2 4\n 1 1 2\n 1. 0.\n 2. 5.\n 3. 0.\n";
    let hermitian = read_boeing(&boeing("cha", SQUARE, formats, [1, 1, 3, 0], body));
    assert_eq!(
        (hermitian.symmetry, positions(&hermitian)),
        (Symmetry::Hermitian, vec![(1, 1), (2, 1), (2, 2)])
    );
    let [one, two, three] = [c64::new(1.0, 0.0), c64::new(2.0, -5.0), c64::new(3.0, 0.0)];
    assert_eq!(hermitian.entries, Entries::Complex(vec![one, two, three]));
}

#[test]
fn harwell_boeing_right_hand_sides_are_read_or_skipped() {
    let formats = "(3I2)           (3I2)           (3F3.0)             (2F4.1)";
    let body = "F X                        2             0\n 1 3 4\n 1 2 2\n 1. 2. 3.\n  15 2.5\n   3  40\n 1.0 1.0\n 2.0 2.0\n";
    let text = boeing("RSA", SQUARE, formats, [1, 1, 1, 4], body);
    let whole = harwell_boeing::read_with_rhs(text.as_bytes()).unwrap();
    assert_eq!(whole.matrix, read_boeing(&text));
    let rhs = whole.rhs.unwrap();
    assert_eq!((rhs.count, rhs.vectors), (2, Entries::Real(vec![1.5, 2.5, 0.3, 4.0])));
    assert_eq!((rhs.guesses, rhs.solutions), (None, Some(Entries::Real(vec![1.0, 1.0, 2.0, 2.0]))));
}

#[test]
fn kinds_are_told_by_content() {
    assert_eq!(detect(b"%%MatrixMarket matrix"), Some(FileKind::MatrixMarket));
    assert_eq!(detect(b"\n    -1\n    58\n"), Some(FileKind::Uff));
    assert_eq!(detect(b"# measured\n\xEF\xBB\xBFrow;re\n"), Some(FileKind::Csv));
    assert_eq!(detect(b"frequency_hz,re,im\n"), Some(FileKind::Csv));
    for nothing in [&b""[..], b"\n\n", b"hello", b"\x00,\x01", b"\xFF\xFE,"] {
        assert_eq!(detect(nothing), None);
    }
    let message = |bytes: &[u8]| frfit_formats::read_matrix(bytes).unwrap_err().to_string();
    assert_eq!(
        message(b"    -1\n    58\n"),
        "input: expected a matrix (Matrix Market, Harwell-Boeing, CalculiX, Abaqus, Nastran DMIG, Nastran OUTPUT4, NumPy, \
         MATLAB), found a Universal File Format (UFF) file"
    );
    assert_eq!(
        message(b"{}"),
        "input: expected a matrix (Matrix Market, Harwell-Boeing, CalculiX, Abaqus, Nastran DMIG, Nastran OUTPUT4, NumPy, \
         MATLAB), found none of them (no %%MatrixMarket, OUTPUT4 header or entry in line 1, no matrix type such as RSA in \
         line 3, no DMIG card)"
    );
}
