//! Files that look alike, each recognised as what it is.

use frfit_formats::{
    CoordinateMatrix, Entries, FileKind, Symmetry, detect, harwell_boeing, matrix_market, op4, read_matrix,
};
use std::fs;
use std::path::Path;

#[test]
fn numbers_in_columns_are_told_by_what_they_can_be() {
    for (text, kind) in [
        // A frequency of tenths, or whole ones beside values, is no row and column.
        ("10.0,0.5,0.25\n20.0,0.5,0.25\n", Some(FileKind::Csv)),
        ("10,0.5,0.25\n20,0.5,0.25\n", Some(FileKind::Csv)),
        ("frequency_hz,re,im\n10,1,2.5\n", Some(FileKind::Csv)),
        ("row,column,value\n1,2,3.5\n", Some(FileKind::Csv)),
        ("# rows\nrow;re\n1;2.0\n", Some(FileKind::Csv)),
        ("LabVIEW Measurement\t\nWriter_Version\t2\n1,1,2.5\n", Some(FileKind::Lvm)),
        ("    -1\n   151\n1 1 2.5\n", Some(FileKind::Uff)),
        ("1 1 2.5\n2 1 -1.0\n", Some(FileKind::Triplets)),
        ("1,1,2.5\n2,1,-1.0\n", Some(FileKind::Triplets)),
        ("** MATRIX\n\n1 1 2.5D+00\n", Some(FileKind::Triplets)),
        ("1,1,1,1,2.5\n", Some(FileKind::Abaqus)),
        // Columns of eight: an OUTPUT4 header, were 2.5E+00 a name, or 2E+05 a format.
        ("       1       1       1       1 2.5E+00\n", Some(FileKind::Abaqus)),
        ("       1       1       1       1           2E+05\n", Some(FileKind::Abaqus)),
        ("       1       1       1       2K       1P,3E24.16\n", Some(FileKind::Op4)),
        ("       1      -1       1       2K       \n", Some(FileKind::Op4)),
        ("               1               1       1       2K       1P,3E24.16|I16\n", Some(FileKind::Op4)),
        ("$ stiffness, in N/m\nGRID,1,,0.,0.,0.\nDMIG,K,0,6,2,0,,,\n", Some(FileKind::Dmig)),
        ("DMIG    K              0       6       2       0\n", Some(FileKind::Dmig)),
        // Sizes without a banner, and entries without a point.
        ("5 5 13\n1 1 3.0\n", None),
        ("1 1 1 1 2\n", None),
    ] {
        assert_eq!(detect(text.as_bytes()), kind, "{text}");
    }
}

#[test]
fn what_is_written_is_told_to_be_what_it_is_whatever_its_title() {
    let titles = [
        "1 1 2.5",
        "1,1,1,1,2.5",
        "-1",
        "a,b",
        "DMIG,K,0",
        "       1       1       1       2K       1P,3E24.16",
    ];
    for title in titles {
        let matrix = CoordinateMatrix {
            nrows: 2,
            ncols: 2,
            symmetry: Symmetry::Symmetric,
            rows: vec![0, 1, 1],
            cols: vec![0, 0, 1],
            entries: Entries::Real(vec![2.5, -1.0, 3.0]),
            title: title.into(),
        };
        for (written, kind) in [
            (matrix_market::write(&matrix).unwrap(), FileKind::MatrixMarket),
            (harwell_boeing::write(&matrix).unwrap(), FileKind::HarwellBoeing),
            (op4::write(&[("K", &matrix)]).unwrap(), FileKind::Op4),
        ] {
            assert_eq!(detect(&written), Some(kind), "{title}");
            let read = read_matrix(&written).unwrap();
            assert_eq!(
                (read.rows, read.cols, read.entries),
                (matrix.rows.clone(), matrix.cols.clone(), matrix.entries.clone())
            );
        }
    }
}

/// Each sample of the other tests is of the kind that its ending says.
#[test]
fn samples_are_what_their_endings_say() {
    let tests = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests");
    let mut counted = 0;
    for folder in ["labels/samples", "containers/samples"] {
        for file in fs::read_dir(tests.join(folder)).unwrap() {
            let path = file.unwrap().path();
            let name = path.file_name().unwrap().to_string_lossy().into_owned();
            let kind = match name.rsplit_once('.').unwrap().1 {
                "sti" | "mas" => FileKind::Triplets,
                "pch" => FileKind::Dmig,
                "op4" => FileKind::Op4,
                "npy" | "npz" => FileKind::Numpy,
                "mat" => FileKind::Mat,
                "mtx" if name == "chain_coordinate.mtx" => FileKind::Triplets,
                "mtx" if name.starts_with("chain_") => FileKind::Abaqus,
                "mtx" => FileKind::MatrixMarket,
                _ => continue,
            };
            assert_eq!(detect(&fs::read(&path).unwrap()), Some(kind), "{name}");
            counted += 1;
        }
    }
    assert!(counted > 50, "{counted}");
}
