//! Files that are damaged say where, and no damage brings a reader down.

use super::samples;
use frfit_formats::{op4, read_matrices, read_matrix};
use std::fs;

fn op4_error(text: &str) -> String {
    match op4::read(text.as_bytes()) {
        Err(error) => error.to_string(),
        Ok(matrices) => matrices.into_iter().find_map(|one| one.matrix.err()).expect("an error").to_string(),
    }
}

const OP4: &str = "       2      -2       6       2KAA     1P,3E24.16
       1       0       4
       3       1
  2.0000000000000000E+00
       3       1       1
  1.0000000000000000E+00
";

#[test]
fn op4_says_where_it_is_broken() {
    assert!(op4::read(OP4.as_bytes()).unwrap()[0].matrix.is_ok());
    for (from, to, message) in [
        (
            "KAA     1P,3E24.16",
            "KAA     1P,3X24.16",
            "input:1:1: expected the header of a matrix: columns, rows, form, type (1 to 4), name, format such as 1P,3E23.16, found \"       2      -2       6       2KAA     \"...",
        ),
        (
            "       6       2KAA",
            "       6       5KAA",
            "input:1:1: expected the header of a matrix: columns, rows, form, type (1 to 4), name, format such as 1P,3E23.16, found \"       2      -2       6       5KAA     \"...",
        ),
        (
            "       1       0       4\n",
            "       1       0       5\n",
            "input:5:9: expected the length of a string (at least 1) and its row, found \"1       1\"",
        ),
        (
            "       1       0       4\n",
            "       1       0       3\n",
            "input:3:1: expected a string within the 3 words of its column, found \"3       1\"",
        ),
        (
            "       3       1\n  2",
            "       0       1\n  2",
            "input:3:1: expected the length of a string (at least 1) and its row, found \"0       1\"",
        ),
        (
            "       3       1\n  2",
            "       3       0\n  2",
            "input:3:1: expected a row from 1, found \"3       0\"",
        ),
        (
            "  2.0000000000000000E+00",
            "  2.0000000000000000X+00",
            "input:4:1: expected a finite number with a point in columns 1 to 24, found \"2.0000000000000000X+00\"",
        ),
        (
            "  2.0000000000000000E+00",
            " -2.00000000000000000E+300",
            "input:4:25: expected at most 24 characters in a line of 1 numbers, found 26",
        ),
        (
            "       3       1\n  2",
            "       3       9\n  2",
            "input:4:1: expected a position in 2 by 2, found row 9, column 1",
        ),
        (
            "       2      -2",
            "       x      -2",
            "input:1:1: expected the header of a matrix: columns, rows, form, type (1 to 4), name, format such as 1P,3E23.16, found \"       x      -2       6       2KAA     \"...",
        ),
        (
            "       6       2KAA",
            "       8       2KAA",
            "input: expected a matrix that stores its entries, found form 8, an identity",
        ),
        (
            "       3       1       1\n  1.0000000000000000E+00\n",
            "",
            "input:4: expected a column, its first row (0 of a sparse one) and its words, found the end of the file",
        ),
    ] {
        let text = OP4.replacen(from, to, 1);
        assert_ne!(text, OP4, "{from}");
        assert_eq!(op4_error(&text), message, "{from} -> {to}");
    }
}

/// Cuts and flips: a file is read or refused. The count is what keeps this from testing nothing.
#[test]
fn no_damage_brings_a_reader_down() {
    let mut tried = 0;
    for entry in fs::read_dir(samples()).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_some_and(|ending| ending == "mtx") {
            continue;
        }
        let bytes = fs::read(&path).unwrap();
        // Some of the places: all of them in small files.
        for at in (0..bytes.len()).step_by(1 + bytes.len() / 400) {
            for flip in [0x01, 0x80, 0xFF] {
                let mut damaged = bytes.clone();
                damaged[at] ^= flip;
                for matrix in read_matrices(&damaged).into_iter().flatten().filter_map(|one| one.matrix.ok())
                {
                    matrix.validate().unwrap_or_else(|error| panic!("{}: {error}", path.display()));
                }
            }
            let _ = read_matrices(&bytes[..at]);
            tried += 1;
        }
    }
    assert!(tried > 2000, "{tried}");
}

fn error_of(bytes: &[u8]) -> String {
    match read_matrices(bytes) {
        Err(error) => error.to_string(),
        Ok(matrices) => matrices.into_iter().find_map(|one| one.matrix.err()).expect("an error").to_string(),
    }
}

/// An array with a header of this text, and some bytes behind it.
fn npy(header: &str, data: &[u8]) -> Vec<u8> {
    let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
    bytes.extend(u16::try_from(header.len()).unwrap().to_le_bytes());
    bytes.extend(header.as_bytes());
    bytes.extend(data);
    bytes
}

#[test]
fn numpy_says_what_is_wrong() {
    let dict = |descr: &str, shape: &str| {
        npy(&format!("{{'descr': {descr}, 'fortran_order': False, 'shape': {shape}, }}\n"), &[0; 32])
    };
    assert!(read_matrices(&dict("'<f8'", "(2, 2)")).is_ok());
    for (bytes, message) in [
        (
            dict("'<f8'", "(4,)"),
            "input: expected an array of numbers with rows and columns, found a vector of 4",
        ),
        (
            dict("'<f8'", "(2, 2, 1)"),
            "input: expected an array of numbers with rows and columns, found an array of 2 x 2 x 1",
        ),
        (dict("'<f8'", "()"), "input, byte 66: expected 8 bytes for a single element, found 32 bytes"),
        (
            dict("'<U8'", "(1,)"),
            "input: expected an array of numbers with rows and columns, found an array of texts",
        ),
        (dict("'<f8'", "(2, 3)"), "input, byte 70: expected 48 bytes for an array of 2 x 3, found 32 bytes"),
        (
            dict("'<f8'", "(9999999999, 9999999999)"),
            "input, byte 88: expected an array that fits into memory, found an array of 9999999999 x 9999999999",
        ),
        (
            dict("'|O'", "(2, 2)"),
            "input, byte 0: expected an array of real or complex numbers of 4 or 8 bytes, or of whole numbers, found descr \"'|O'\"",
        ),
        (
            dict("[('a', '<f8')]", "(2, 2)"),
            "input, byte 0: expected an array of real or complex numbers of 4 or 8 bytes, or of whole numbers, found descr \"[('a'\"",
        ),
        (
            b"\x93NUMPY\x01\x00\xFF\xFF{".to_vec(),
            "input, byte 0: expected a header of a text, found 65535 bytes that are no text, or too few",
        ),
        (
            b"PK\x03\x04 and so on".to_vec(),
            "input: expected an archive of arrays (.npz), found invalid Zip archive: Could not find EOCD",
        ),
    ] {
        assert_eq!(error_of(&bytes), message);
    }
}

#[test]
fn sparse_arrays_that_contradict_each_other_are_refused() {
    use std::io::Write;
    let file = |indices: &[u8], indptr: &[u8], format: &str| {
        let mut zip = zip::ZipWriter::new(std::io::Cursor::new(Vec::new()));
        let vector = |kind: &str, data: &[u8]| {
            npy(&format!("{{'descr': '{kind}', 'fortran_order': False, 'shape': ({},), }}", data.len()), data)
        };
        let scalar = "{'descr': '|S3', 'fortran_order': False, 'shape': (), }";
        for (name, bytes) in [
            ("indices", vector("|u1", indices)),
            ("indptr", vector("|u1", indptr)),
            ("data", vector("|i1", &[1, 2, 3])),
            ("shape", vector("|u1", &[2, 3])),
            ("format", npy(scalar, format.as_bytes())),
        ] {
            zip.start_file(format!("{name}.npy"), zip::write::SimpleFileOptions::default()).unwrap();
            zip.write_all(&bytes).unwrap();
        }
        zip.finish().unwrap().into_inner()
    };
    assert_eq!(read_matrix(&file(&[0, 2, 1], &[0, 2, 3], "csr")).unwrap().rows, [0, 1, 0]);
    let fits = |found: &str| {
        format!(
            "input: expected an array \"indptr\" that fits to the others of a matrix of format csr, found {found}"
        )
    };
    for (indices, indptr, format, message) in [
        (&[0, 2, 1][..], &[0, 2][..], "csr", fits("a vector of 2")),
        (&[0, 2, 1], &[0, 3, 2], "csr", fits("a vector of 3")),
        (&[0, 2, 1], &[0, 2, 9], "csr", fits("a vector of 3")),
        (&[0, 2], &[0, 2, 3], "csr", fits("a vector of 3")),
        (&[0, 3, 1], &[0, 2, 3], "csr", "input: expected a position in 2 by 3, found row 1, column 4".into()),
        (
            &[0, 2, 1],
            &[0, 2, 3],
            "lil",
            "input: expected a sparse matrix of format csr, csc, coo, bsr or dia, found \"lil\"".into(),
        ),
        (&[0, 2, 1], &[0, 2, 3], "coo", "input: expected an array \"coords\", found none".into()),
    ] {
        assert_eq!(error_of(&file(indices, indptr, format)), message);
    }
}

#[test]
fn matlab_says_what_is_wrong() {
    let sound = fs::read(samples().join("matlab.mat")).unwrap();
    let mut newer = sound[..200].to_vec();
    newer[124..128].copy_from_slice(b"\x00\x02IM");
    assert_eq!(
        error_of(&newer),
        "input: expected a MATLAB file of version 5, 6 or 7, found one of version 7.3 (HDF5): save it with save('file.mat', ..., '-v7')"
    );
    assert_eq!(
        error_of(&sound[..150]),
        "input, byte 136: expected 288 bytes: a variable, found 14 to the end"
    );
    let packed = fs::read(samples().join("matlab_packed.mat")).unwrap();
    let mut torn = packed;
    torn[140] ^= 0xFF;
    assert!(
        error_of(&torn).starts_with("input, byte 136: expected a compressed variable, found "),
        "{}",
        error_of(&torn)
    );
}
