//! Broken files that a case names: what is said, where it points, and which key named the file.

use super::files::{edited, folder, message, refused};
use frfit_workflow::load::{Overrides, Purpose, load};

#[test]
fn matrices() {
    for (file, from, to, message) in [
        (
            "K.mtx",
            "3 3 5",
            "3 3 6",
            "K.mtx:7: expected 6 entries, as line 2 says, found 5\nnamed in case.toml:5:1: matrix.file",
        ),
        (
            "K.mtx",
            "2 1 -1",
            "4 1 -1",
            "K.mtx:4:1: expected a row from 1 to 3, found \"4\"\nnamed in case.toml:5:1: matrix.file",
        ),
        (
            "K.mtx",
            "2 1 -1",
            "2 1 nan",
            "K.mtx:4:5: expected a finite number, found \"nan\"\nnamed in case.toml:5:1: matrix.file",
        ),
        (
            "K.mtx",
            "3 3 5",
            "4000000000 4000000000 5",
            "K.mtx:2:1: expected a number of rows from 0 to 2147483647, found \"4000000000\"\nnamed in case.toml:5:1: matrix.file",
        ),
        (
            "K.mtx",
            "3 3 5",
            "2000000000 2000000000 5",
            "core.mtx: expected 2000000000 rows, as matrix \"springs\" has, found 3\nnamed in case.toml:10:1: matrix.file",
        ),
        (
            "K.mtx",
            "symmetric",
            "skew-symmetric",
            "K.mtx:3: expected nothing but zeros on the diagonal of a skew-symmetric matrix, found 2+0i in row 1\nnamed in case.toml:5:1: matrix.file",
        ),
        (
            "K.mtx",
            "real symmetric\n3 3 5",
            "real general\n3 4 5",
            "K.mtx: expected a square matrix, found 3 rows and 4 columns\nnamed in case.toml:5:1: matrix.file",
        ),
        (
            "K.mtx",
            "symmetric",
            "general",
            "K.mtx: expected a symmetric matrix (its transpose is A), found -1 at (3, 2) but 0 at (2, 3)\nnamed in case.toml:5:1: matrix.file",
        ),
        (
            "K.mtx",
            "3 3 5",
            "4 4 5",
            "core.mtx: expected 4 rows, as matrix \"springs\" has, found 3\nnamed in case.toml:10:1: matrix.file",
        ),
        (
            "M.mtx",
            "3 3 3",
            "4 4 3",
            "M.mtx: expected 3 rows, as matrix \"springs\" has, found 4\nnamed in case.toml:15:1: matrix.file",
        ),
        (
            "core.mtx",
            "3 1 -1",
            "3 1 -1.5",
            "core.mtx: expected a symmetric matrix (its transpose is A), found -1 at (1, 3) but -1.5 at (3, 1)\nnamed in case.toml:10:1: matrix.file",
        ),
        (
            "M.mtx",
            "3 3 3",
            "3 3 99999999999999999999",
            "M.mtx:2:5: expected a number of entries from 0 to 2147483647, found \"99999999999999999999\"\nnamed in case.toml:15:1: matrix.file",
        ),
    ] {
        refused(file, &edited(file, from, to), message);
    }
    for (file, text, message) in [
        (
            "K.mtx",
            "",
            "K.mtx: expected a matrix (Matrix Market, Harwell-Boeing, CalculiX, Abaqus, Nastran DMIG, Nastran OUTPUT4, NumPy, MATLAB), found an empty file\nnamed in case.toml:5:1: matrix.file",
        ),
        (
            "K.mtx",
            "%%MatrixMarket matrix coordinate real symmetric\n3 3 5\n1 1 2\n2 1 -1\n2 2",
            "K.mtx:5:4: expected a finite number, found the end of the line\nnamed in case.toml:5:1: matrix.file",
        ),
        (
            "K.mtx",
            "%%MatrixMarket matrix coordinate real symmetric\n0 0 0\n",
            "K.mtx: expected a square matrix, found 0 rows and 0 columns\nnamed in case.toml:5:1: matrix.file",
        ),
        (
            "K.mtx",
            "%%MatrixMarket matrix coordinate pattern symmetric\n3 3 1\n1 1\n",
            "K.mtx: expected a matrix with values, found a pattern: positions without values\nnamed in case.toml:5:1: matrix.file",
        ),
        (
            "K.mtx",
            "%%MatrixMarket matrix coordinate complex hermitian\n1 1 1\n1 1 1 0\n",
            "K.mtx: expected a symmetric matrix (its transpose is A), found a Hermitian one (its transpose is the conjugate of A)\nnamed in case.toml:5:1: matrix.file",
        ),
        (
            "K.mtx",
            "%%MatrixMarket matrix coordinate real skew-symmetric\n3 3 1\n2 1 1\n",
            "K.mtx: expected a symmetric matrix (its transpose is A), found a skew-symmetric one (its transpose is -A)\nnamed in case.toml:5:1: matrix.file",
        ),
    ] {
        refused(file, text, message);
    }
}

#[test]
fn tables() {
    for (file, from, to, message) in [
        (
            "modulus.csv",
            "1,10,0.1",
            "15,10,0.1",
            "case.toml:11:10: matrix.factor: expected a factor with a value at 10 Hz, found the table covers 15 Hz to 100 Hz, and 10 Hz was asked for",
        ),
        (
            "modulus.csv",
            "1,10,0.1",
            "0,10,0.1",
            "modulus.csv: expected frequencies above 0 Hz, found 0 Hz\nnamed in case.toml:11:12: matrix.factor.table",
        ),
        (
            "modulus.csv",
            "storage",
            "stroage",
            "modulus.csv:1: expected a column \"storage\", found no such name; the nearest is \"stroage\"\nnamed in case.toml:11:12: matrix.factor.table",
        ),
        (
            "dofs.csv",
            "3,2,RX",
            "4,2,RX",
            "dofs.csv:4:1: expected a row from 1 to 3 in column \"row\", found 4\nnamed in case.toml:17:1: dofs.file",
        ),
        (
            "dofs.csv",
            "3,2,RX",
            "0,2,RX",
            "dofs.csv:4:1: expected a whole number from 1 on in column \"row\", found \"0\"\nnamed in case.toml:17:1: dofs.file",
        ),
        (
            "dofs.csv",
            "3,2,RX",
            "3,2,W",
            "dofs.csv:4:5: expected X, Y, Z, RX, RY or RZ in column \"direction\", found \"W\"\nnamed in case.toml:17:1: dofs.file",
        ),
        (
            "a.csv",
            "10,1,-1,0.5",
            "10,nan,-1,0.5",
            "a.csv:3:4: expected a finite number in column \"re\", found \"nan\"\nnamed in case.toml:21:1: measurement.file",
        ),
        (
            "a.csv",
            "10,1,-1,0.5",
            "10;1;-1;0.5",
            "a.csv:3: expected 4 cells, found 1\nnamed in case.toml:21:1: measurement.file",
        ),
        (
            "a.csv",
            "10,1,-1,0.5",
            "10,1",
            "a.csv:3: expected 4 cells, found 2 (a decimal comma? write 1.5)\nnamed in case.toml:21:1: measurement.file",
        ),
        (
            "b.csv",
            "10,1,0,0.9\n20,2,0,0.8\n30,3,0,1",
            "11,1,0,0.9\n21,2,0,0.8\n31,3,0,1",
            "b.csv: expected frequencies that all measurements have, such as 10 Hz of a.csv, found 11 Hz as the nearest\nnamed in case.toml:25:1: measurement.file",
        ),
        (
            "b.csv",
            "frequency_hz,re",
            "hz,re",
            "b.csv:1:1: expected one of the columns frequency_hz, re, im, magnitude, magnitude_db, phase_deg, phase_rad, coherence, std, found \"hz\"\nnamed in case.toml:25:1: measurement.file",
        ),
        (
            "a.csv",
            "10,1,-1",
            "10,1.5e400,-1",
            "a.csv:3:4: expected a finite number in column \"re\", found \"1.5e400\"\nnamed in case.toml:21:1: measurement.file",
        ),
        (
            "a.csv",
            "20,2",
            "10,2",
            "a.csv:4:1: expected each frequency once in column \"frequency_hz\", found \"10\" again, first in line 3\nnamed in case.toml:21:1: measurement.file",
        ),
        (
            "a.csv",
            "10,1,-1,0.5",
            "10,1,-1,-0.5",
            "a.csv:3:9: expected a number from 0 on in column \"std\", found \"-0.5\"\nnamed in case.toml:21:1: measurement.file",
        ),
        (
            "a.csv",
            ",std",
            ",stdev",
            "a.csv:1:20: expected one of the columns frequency_hz, re, im, magnitude, magnitude_db, phase_deg, phase_rad, coherence, std, found \"stdev\"; did you mean \"std\"?\nnamed in case.toml:21:1: measurement.file",
        ),
        (
            "b.csv",
            "0.9",
            "1.9",
            "b.csv:2:8: expected a number from 0 to 1 in column \"coherence\", found \"1.9\"\nnamed in case.toml:25:1: measurement.file",
        ),
    ] {
        refused(file, &edited(file, from, to), message);
    }
    for (file, text, message) in [
        (
            "a.csv",
            "",
            "a.csv: expected an FRF: a UFF file or a table (CSV), found an empty file\nnamed in case.toml:21:1: measurement.file",
        ),
        (
            "a.csv",
            "frequency_hz,re,im\n",
            "a.csv:1: expected at least one line of data below the names, found none\nnamed in case.toml:21:1: measurement.file",
        ),
        (
            "a.csv",
            "nothing of the kind\n",
            "a.csv: expected an FRF: a UFF file or a table (CSV), found neither (no -1 in line 1, no names of columns)\nnamed in case.toml:21:1: measurement.file",
        ),
        (
            "a.csv",
            "frequency_hz,re,im\n10,0.5,1\n20,0.5\n",
            "a.csv:3: expected 3 cells, found 2 (a decimal comma? write 1.5)\nnamed in case.toml:21:1: measurement.file",
        ),
        (
            "a.csv",
            "frequency_hz;re;im\n10.5;0,5;1\n",
            "a.csv:2:6: expected a decimal point as in other cells (write 0.5) in column \"re\", found a decimal comma in \"0,5\"\nnamed in case.toml:21:1: measurement.file",
        ),
        (
            "a.csv",
            "%%MatrixMarket matrix coordinate real symmetric\n",
            "a.csv: expected an FRF: a UFF file or a table (CSV), found a Matrix Market file\nnamed in case.toml:21:1: measurement.file",
        ),
        (
            "dofs.csv",
            "row,node,direction\n1,1,Z\n2,2,Z\n3,2,Z\n",
            "dofs.csv:4:3: expected each node and direction once in column \"node\", found \"2\" again, first in line 3\nnamed in case.toml:17:1: dofs.file",
        ),
    ] {
        refused(file, text, message);
    }
}

/// The message about a case with one matrix.
fn one_matrix(matrix: &str) -> String {
    let case = "[[matrix]]\nname = \"k\"\nrole = \"stiffness\"\nfile = \"K.mtx\"\n[load]\nrow = 1\n\
                [[measurement]]\nrow = 1\nfile = \"b.csv\"\nquantity = \"receptance\"\n";
    let folder = folder("case.toml", Some(case.as_bytes()));
    let text = format!("%%MatrixMarket matrix coordinate real symmetric\n{matrix}");
    std::fs::write(folder.path().join("K.mtx"), text).unwrap();
    let case = load(&folder.path().join("case.toml"), &Overrides::default(), Purpose::Identify);
    message(&folder, &case.unwrap_err())
}

#[test]
fn rows_that_nothing_holds_or_moves() {
    assert_eq!(
        one_matrix("2000000000 2000000000 1\n1 1 1\n"),
        "case.toml:4:1: matrix.file: expected an entry in each of the 2000000000 rows, in some matrix, found 1 in all"
    );
    assert_eq!(
        one_matrix("3 3 3\n1 1 1\n2 2 0\n3 3 1\n"),
        "case.toml:4:1: matrix.file: expected an entry in each of the 3 rows, in some matrix, found none in row 2"
    );
    assert_eq!(one_matrix("1 1 1\n1 1 1\n"), "case.toml: expected a table [identify], found none");
}

#[test]
fn load_vectors() {
    for (text, expected) in [
        ("row,re\n1,1\n4,1\n", "f.csv:3:1: expected a row from 1 to 3 in column \"row\", found 4"),
        ("row,re\n0,1\n", "f.csv:2:1: expected a whole number from 1 on in column \"row\", found \"0\""),
        ("row,re\n1,0\n", "f.csv: expected a load that is not zero in every row, found zeros only"),
        ("row,re\n", "f.csv:1: expected at least one line of data below the names, found none"),
    ] {
        let case = edited("case.toml", "dof = \"1+Z\"", "file = \"f.csv\"");
        let folder = folder("case.toml", Some(case.as_bytes()));
        std::fs::write(folder.path().join("f.csv"), text).unwrap();
        let case = load(&folder.path().join("case.toml"), &Overrides::default(), Purpose::Identify);
        let expected = format!("{expected}\nnamed in case.toml:19:1: load.file");
        assert_eq!(message(&folder, &case.unwrap_err()), expected);
    }
}
