//! Broken files: each is refused with a word about where and what.

use frfit_formats::{harwell_boeing, matrix_market};

#[test]
fn broken_matrix_market_files_are_refused_with_a_word() {
    for (text, message) in [
        ("", "input: expected a line that begins with %%MatrixMarket, found an empty file"),
        ("hello\n", "input:1:1: expected %%MatrixMarket, found \"hello\""),
        (
            "%%MatrixMarket\n",
            "input:1:15: expected matrix (the only object that is read), found the end of the line",
        ),
        (
            "%%MatrixMarket vector coordinate real general\n",
            "input:1:16: expected matrix (the only object that is read), found \"vector\"",
        ),
        (
            "%%MatrixMarket matrix sparse real general\n",
            "input:1:23: expected coordinate or array, found \"sparse\"",
        ),
        (
            "%%MatrixMarket matrix coordinate double general\n",
            "input:1:34: expected real, integer, complex or pattern, found \"double\"",
        ),
        (
            "%%MatrixMarket matrix array pattern general\n",
            "input:1: expected real, integer or complex values in an array file, found pattern",
        ),
        (
            "%%MatrixMarket matrix coordinate real hermitian\n",
            "input:1:39: expected general, symmetric or skew-symmetric, found \"hermitian\"",
        ),
        (
            "%%MatrixMarket matrix coordinate real general 1 1 1\n",
            "input:1:47: expected the end of the line, found \"1\"",
        ),
        (
            "%%MatrixMarket matrix coordinate real general\n",
            "input:1: expected a size line, found the end of the file",
        ),
        (
            "%%MatrixMarket matrix coordinate real general\n% only comments\n",
            "input:2: expected a size line, found the end of the file",
        ),
        (
            "%%MatrixMarket matrix coordinate real general\n3 3\n",
            "input:2:4: expected a number of entries from 0 to 2147483647, found the end of the line",
        ),
        (
            "%%MatrixMarket matrix coordinate real general\n3 x 1\n",
            "input:2:3: expected a number of columns from 0 to 2147483647, found \"x\"",
        ),
        (
            "%%MatrixMarket matrix coordinate real general\n3 3 1 7\n",
            "input:2:7: expected the end of the line, found \"7\"",
        ),
        (
            "%%MatrixMarket matrix coordinate real general\n4000000000 4000000000 3\n1 1 1\n",
            "input:2:1: expected a number of rows from 0 to 2147483647, found \"4000000000\"",
        ),
        (
            "%%MatrixMarket matrix coordinate real general\n2000000000 2000000000 3\n1 1 1\n",
            "input:3: expected 3 entries, as line 2 says, found 1",
        ),
        (
            "%%MatrixMarket matrix coordinate real general\n-3 3 1\n",
            "input:2:1: expected a number of rows from 0 to 2147483647, found \"-3\"",
        ),
        (
            "%%MatrixMarket matrix coordinate real symmetric\n3 4 1\n1 1 1\n",
            "input:2: expected as many rows as columns in a matrix given by one triangle, found 3 rows and 4 columns",
        ),
        (
            "%%MatrixMarket matrix coordinate real general\n3 3 4000000000000\n1 1 1\n",
            "input:2:5: expected a number of entries from 0 to 2147483647, found \"4000000000000\"",
        ),
        (
            "%%MatrixMarket matrix coordinate real general\n3 3 18446744073709551615\n1 1 1\n",
            "input:2:5: expected a number of entries from 0 to 2147483647, found \"18446744073709551615\"",
        ),
        (
            "%%MatrixMarket matrix coordinate real general\n3 3 2\n1 1 1.0\n",
            "input:3: expected 2 entries, as line 2 says, found 1",
        ),
        (
            "%%MatrixMarket matrix coordinate real general\n3 3 1\n1 1 1.0\n\n2 2 1.0\n",
            "input:5: expected 1 entry, as line 2 says, found one more line",
        ),
        (
            "%%MatrixMarket matrix coordinate real general\n3 3 1\n4 1 1.0\n",
            "input:3:1: expected a row from 1 to 3, found \"4\"",
        ),
        (
            "%%MatrixMarket matrix coordinate real general\n3 3 1\n0 1 1.0\n",
            "input:3:1: expected a row from 1 to 3, found \"0\"",
        ),
        (
            "%%MatrixMarket matrix coordinate real general\n3 3 1\n1 -1 1.0\n",
            "input:3:3: expected a column from 1 to 3, found \"-1\"",
        ),
        (
            "%%MatrixMarket matrix coordinate real general\n3 3 1\n1 1 nan\n",
            "input:3:5: expected a finite number, found \"nan\"",
        ),
        (
            "%%MatrixMarket matrix coordinate real general\n3 3 1\n1 1 -Inf\n",
            "input:3:5: expected a finite number, found \"-Inf\"",
        ),
        (
            "%%MatrixMarket matrix coordinate real general\n3 3 1\n1 1 1e400\n",
            "input:3:5: expected a finite number, found \"1e400\"",
        ),
        (
            "%%MatrixMarket matrix coordinate real general\n3 3 1\n1 1 1,5\n",
            "input:3:5: expected a finite number, found \"1,5\"",
        ),
        (
            "%%MatrixMarket matrix coordinate real general\n3 3 1\n1 1 é\n",
            "input:3:5: expected a finite number, found \"é\"",
        ),
        (
            "%%MatrixMarket matrix coordinate real general\n3 3 1\n1 1\n",
            "input:3:4: expected a finite number, found the end of the line",
        ),
        (
            "%%MatrixMarket matrix coordinate real general\n3 3 1\n1 1 1 0\n",
            "input:3:7: expected the end of the line, found \"0\"",
        ),
        (
            "%%MatrixMarket matrix coordinate real general\n3 3 1\n1 1 9x9x9x9x9x9x9x9x9x9x9x9x9x9x9x9x9x9x9x9x9x9x9x9x9x\n",
            "input:3:5: expected a finite number, found \"9x9x9x9x9x9x9x9x9x9x9x9x9x9x9x9x9x9x9x9x\"...",
        ),
        (
            "%%MatrixMarket matrix coordinate real general\n3 3 2\n1 1 1e308\n1 1 1e308\n",
            "input:4: expected entries with a finite sum, found a sum beyond the largest double at row 1, column 1",
        ),
        (
            "%%MatrixMarket matrix coordinate real symmetric\n3 3 3\n2 1 1.0\n3 3 1\n1 2 1.0\n",
            "input:5: expected one triangle only, as the banner says, found both (2, 1) and (1, 2)",
        ),
        (
            "%%MatrixMarket matrix coordinate integer general\n1 1 1\n1 1 1.5\n",
            "input:3:5: expected a whole number below 2^53 in an integer file, found 1.5",
        ),
        (
            "%%MatrixMarket matrix coordinate complex general\n1 1 1\n1 1 1.5\n",
            "input:3:8: expected a finite number, found the end of the line",
        ),
        (
            "%%MatrixMarket matrix coordinate integer general\n1 1 1\n1 1 9007199254740993\n",
            "input:3:5: expected a whole number below 2^53 in an integer file, found 9007199254740992",
        ),
        (
            "%%MatrixMarket matrix coordinate real skew-symmetric\n2 2 1\n1 1 1.5\n",
            "input:3: expected nothing but zeros on the diagonal of a skew-symmetric matrix, found 1.5+0i in row 1",
        ),
        (
            "%%MatrixMarket matrix coordinate complex hermitian\n2 2 1\n2 2 1.5 1\n",
            "input:3: expected a real diagonal of a Hermitian matrix, found 1.5+1i in row 2",
        ),
        (
            "%%MatrixMarket matrix array real general\n2000000000 2000000000\n1\n",
            "input:3: expected 4000000000000000000 entries, as line 2 says, found 1",
        ),
        (
            "%%MatrixMarket matrix array real general\n2 1\n1\n2\n3\n",
            "input:5: expected 2 entries, as line 2 says, found one more line",
        ),
        (
            "%%MatrixMarket matrix array real general\n2 1\n1 2\n",
            "input:3:3: expected the end of the line, found \"2\"",
        ),
    ] {
        assert_eq!(matrix_market::read(text.as_bytes()).unwrap_err().to_string(), message, "{text:?}");
    }
}

/// [1 2; 2 3] by its lower triangle.
const GOOD: &str = "\
Title
             4             1             1             2             0
RSA                        2             2             3             0
(3I2)           (3I2)           (2E10.2)
 1 3 4
 1 2 2
  1.00E+00  2.00E+00
  3.00E+00
";

#[test]
fn broken_harwell_boeing_files_are_refused_with_a_word() {
    assert!(harwell_boeing::read(GOOD.as_bytes()).is_ok());
    for (good, bad, message) in [
        (
            "             4 ",
            "             5 ",
            "input:2: expected TOTCRD, the sum of the other counts, 4, found 5",
        ),
        (
            "             4             1 ",
            "             5             2 ",
            "input:2: expected PTRCRD = 1, the lines that 3 fields take by the format in line 4, found 2",
        ),
        (
            "             4             1",
            "            4x             1",
            "input:2:1: expected TOTCRD, the number of lines, in columns 1 to 14, found \"4x\"",
        ),
        (
            "RSA",
            "RSE",
            "input:3:3: expected an assembled matrix, such as RSA (elemental ones are not read: assemble it first), found \"RSE\"",
        ),
        (
            "RSA",
            "XSA",
            "input:3:1: expected a matrix type that begins with R, C, P or I, such as RSA, found \"XSA\"",
        ),
        (
            "RSA",
            "RXA",
            "input:3:2: expected a matrix type with S, U, H, Z or R in the middle, such as RSA, found \"RXA\"",
        ),
        ("RSA", "RSX", "input:3:3: expected a matrix type that ends with A, such as RSA, found \"RSX\""),
        ("RSA", "R\n", "input:3:1: expected a matrix type of three letters, such as RSA, found \"R\""),
        (
            "   2             2             3",
            "   2             3             3",
            "input:3: expected as many rows as columns in a matrix given by one triangle, found 2 rows and 3 columns",
        ),
        (
            "             2             2             3",
            "    4000000000    4000000000             3",
            "input:3:15: expected NROW, a number of rows, up to 2147483647, found 4000000000",
        ),
        (
            "             2             2             3",
            "    2000000000    2000000000             3",
            "input:2: expected PTRCRD = 666666667, the lines that 2000000001 fields take by the format in line 4, found 1",
        ),
        (
            "             3             0\n(",
            "    2000000000             0\n(",
            "input:2: expected INDCRD = 666666667, the lines that 2000000000 fields take by the format in line 4, found 1",
        ),
        (
            "(3I2)           (3I2)",
            "(3F2.0)         (3I2)",
            "input:4:1: expected PTRFMT, a format of whole numbers (I), found another",
        ),
        ("(2E10.2)", "", "input:4:22: expected VALFMT, a Fortran format, found the end of the line"),
        (
            "(2E10.2)",
            "(2A10)",
            "input:4:33: expected VALFMT: a Fortran format of I, F, E, D, G, X and P, found \"(2A10)\"",
        ),
        (
            "(2E10.2)",
            "(99999999999E10.2)",
            "input:4:33: expected VALFMT: numbers of at most five digits in a format, found \"(99999999999E10.2)\"",
        ),
        (
            "(3I2)           (3I2)",
            "(3I2            (3I2)",
            "input:4:1: expected PTRFMT: a format without fields before a group, found \"(3I2            (3I2)           (2E10.2)\"",
        ),
        (
            " 1 3 4\n",
            " 2 3 4\n",
            "input:5:2: expected a column pointer from 1 to 1 in columns 1 to 2, found \"2\"",
        ),
        (
            " 1 3 4\n",
            " 1 5 4\n",
            "input:5:4: expected a column pointer from 1 to 4 in columns 3 to 4, found \"5\"",
        ),
        (
            " 1 3 4\n",
            " 1 3 3\n",
            "input:5:6: expected a column pointer from 4 to 4 in columns 5 to 6, found \"3\"",
        ),
        (
            " 1 3 4\n",
            " 1   4\n",
            "input:5:3: expected a column pointer from 1 to 4 in columns 3 to 4, found a blank field",
        ),
        (
            " 1 3 4\n",
            " 1\t3 4\n",
            "input:5:3: expected a column pointer from 1 to 4 in columns 3 to 4, found a tab (fields are cut by column)",
        ),
        (
            " 1 3 4\n",
            " 1\n",
            "input:5:3: expected a column pointer from 1 to 4 in columns 3 to 4, found a blank field",
        ),
        (
            " 1 3 4\n",
            " 1é 4\n",
            "input:5:3: expected a column pointer from 1 to 4 in columns 3 to 4, found \"é\"",
        ),
        (
            " 1 2 2\n",
            " 1 3 2\n",
            "input:6:4: expected a row index from 1 to 2 in columns 3 to 4, found \"3\"",
        ),
        (
            " 1 2 2\n",
            " 0 2 2\n",
            "input:6:2: expected a row index from 1 to 2 in columns 1 to 2, found \"0\"",
        ),
        (" 1 2 2\n", " 2 2 2\n", "input:6: expected each position once, found (2, 1) twice"),
        (" 1 2 2\n", " 1 2 1\n", "input:6: expected each position once, found both (2, 1) and (1, 2)"),
        (
            " 1 2 2\n",
            "\n",
            "input:6:1: expected a row index from 1 to 2 in columns 1 to 2, found a blank field",
        ),
        (
            "  2.00E+00\n",
            "       NaN\n",
            "input:7:18: expected a finite number as value in columns 11 to 20, found \"NaN\"",
        ),
        (
            "  2.00E+00\n",
            "  2.00F+00\n",
            "input:7:13: expected a finite number as value in columns 11 to 20, found \"2.00F+00\"",
        ),
        (
            "  2.00E+00\n",
            "\n",
            "input:7:11: expected a finite number as value in columns 11 to 20, found a blank field",
        ),
        ("  3.00E+00\n", "", "input:7: expected 3 value fields, found the end of the file after 2"),
        (
            "  3.00E+00\n",
            "  3.00E+00\n   9\n",
            "input:9: expected the end of the file, as line 2 says, found more lines",
        ),
        (
            "  1.00E+00  2.00E+00\n  3.00E+00\n",
            "",
            "input:6: expected 3 value fields, found the end of the file after 0",
        ),
        (
            "RSA",
            "RZA",
            "input:7: expected nothing but zeros on the diagonal of a skew-symmetric matrix, found 1+0i in row 1",
        ),
        (GOOD, "", "input: expected the header lines of a Harwell-Boeing file, found an empty file"),
        (GOOD, "Title\n", "input:2: expected a header line, found the end of the file"),
    ] {
        assert!(GOOD.contains(good), "{good:?}");
        let error = harwell_boeing::read(GOOD.replacen(good, bad, 1).as_bytes()).unwrap_err();
        assert_eq!(error.to_string(), message, "{bad:?} for {good:?}");
    }
}

/// The same matrix with two right-hand sides of two values each.
const WITH_RHS: &str = "\
Title
             6             1             1             2             2
RSA                        2             2             3             0
(3I2)           (3I2)           (2E10.2)            (2F5.1)
F                       2             0
 1 3 4
 1 2 2
  1.00E+00  2.00E+00
  3.00E+00
  1.0  2.0
  3.0  4.0
";

#[test]
fn broken_right_hand_sides_are_refused_with_a_word() {
    assert!(harwell_boeing::read_with_rhs(WITH_RHS.as_bytes()).is_ok());
    for (good, bad, message) in [
        (
            "             2             0\n 1",
            "    4000000000             0\n 1",
            "input:5:15: expected NRHS, a number of right-hand sides, up to 2147483647, found 4000000000",
        ),
        (
            "             2             0\n 1",
            "    2000000000             0\n 1",
            "input:5: expected 4000000000 right-hand side fields, found 22 bytes",
        ),
        (
            "F  ",
            "M  ",
            "input:5: expected full right-hand sides (RHSTYP begins with F), found sparse ones (RHSTYP begins with M)",
        ),
        ("F  ", "Q  ", "input:5:1: expected RHSTYP: F or M, then G or blank, then X or blank, found \"Q  \""),
        (
            "  3.0  4.0\n",
            "",
            "input:10: expected 4 right-hand side fields, found the end of the file after 2",
        ),
        (
            "  4.0\n",
            "  inf\n",
            "input:11:8: expected a finite number as right-hand side in columns 6 to 10, found \"inf\"",
        ),
    ] {
        assert!(WITH_RHS.contains(good), "{good:?}");
        let error = harwell_boeing::read_with_rhs(WITH_RHS.replacen(good, bad, 1).as_bytes()).unwrap_err();
        assert_eq!(error.to_string(), message, "{bad:?} for {good:?}");
    }
    let torn = WITH_RHS.replacen("  3.0  4.0\n", "", 1);
    let error = harwell_boeing::read(torn.as_bytes()).unwrap_err();
    assert_eq!(error.to_string(), "input:10: expected RHSCRD = 2 lines, found the end of the file after 1");
}
