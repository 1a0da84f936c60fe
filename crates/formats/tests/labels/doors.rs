//! One small structure in the files of four programs: a chain of springs at nodes 1 to 4, the last with a spring along Y.

use frfit_formats::{
    CoordinateMatrix, DofLabel, Entries, FileKind, Labels, Symmetry, abaqus, ansys, choose_matrix, detect,
    dmig, listed_labels, read_matrices, triplets,
};
use num_complex::Complex64 as c64;
use std::path::Path;

fn sample(name: &str) -> Vec<u8> {
    std::fs::read(Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/labels/samples").join(name)).unwrap()
}

fn label(node: i64, component: u8) -> DofLabel {
    DofLabel { node, component }
}

/// Sorted: that is the order of Abaqus' and Nastran's matrices here.
fn sorted() -> [DofLabel; 5] {
    [label(1, 1), label(2, 1), label(3, 1), label(4, 1), label(4, 2)]
}

fn dense(matrix: &CoordinateMatrix) -> Vec<Vec<c64>> {
    let mut dense = vec![vec![c64::default(); matrix.ncols]; matrix.nrows];
    for (k, (&row, &col)) in matrix.rows.iter().zip(&matrix.cols).enumerate() {
        let value = match &matrix.entries {
            Entries::Pattern => panic!("no values"),
            Entries::Real(values) => c64::new(values[k], 0.0),
            Entries::Complex(values) => values[k],
        };
        dense[row][col] = value;
        if matrix.symmetry == Symmetry::Symmetric {
            dense[col][row] = value;
        }
    }
    dense
}

fn stiffness() -> Vec<Vec<c64>> {
    let k = [
        [3e6, -1.5e6, 0.0, 0.0, 0.0],
        [-1.5e6, 3e6, -1.5e6, 0.0, 0.0],
        [0.0, -1.5e6, 3e6, -1.5e6, 0.0],
        [0.0, 0.0, -1.5e6, 1.75e6, 2.5e5],
        [0.0, 0.0, 0.0, 2.5e5, 5e5],
    ];
    k.map(|row| row.map(|value| c64::new(value, 0.0)).to_vec()).to_vec()
}

/// On the sorted rows.
fn in_order(matrix: &CoordinateMatrix, rows: &[DofLabel]) -> CoordinateMatrix {
    let to: Vec<_> = rows.iter().map(|row| sorted().iter().position(|label| label == row)).collect();
    matrix.renumbered(&to, 5).unwrap()
}

#[test]
fn calculix_names_its_rows_in_a_file_beside() {
    let rows = triplets::read_dofs(&sample("chain.dof")).unwrap();
    assert_eq!(rows, [label(4, 1), label(1, 1), label(4, 2), label(2, 1), label(3, 1)]);
    let k = triplets::read(&sample("chain.sti")).unwrap();
    assert_eq!((k.nrows, k.symmetry), (5, Symmetry::Symmetric));
    assert_eq!(dense(&in_order(&k, &rows)), stiffness());
    let m = triplets::read(&sample("chain.mas")).unwrap();
    assert_eq!(dense(&in_order(&m, &rows))[4][4], c64::new(0.125, 0.0));
}

#[test]
fn abaqus_names_them_in_every_line_and_fixes_by_a_large_number() {
    let (k, labels) = abaqus::read(&sample("chain_STIF1.mtx")).unwrap();
    assert_eq!(labels, Labels { fixed: vec![label(9, 1)], ..Labels::of_rows(sorted().to_vec()) });
    assert_eq!((k.symmetry, &*k.title), (Symmetry::Symmetric, "ASSEMBLED NODES"));
    assert_eq!(dense(&k), stiffness());
    let (m, labels) = abaqus::read(&sample("chain_MASS1.mtx")).unwrap();
    assert_eq!((m.nrows, labels.rows[5], labels.fixed.len()), (6, label(9, 1), 0));
    // Both triangles, without names.
    let full = triplets::read(&sample("chain_coordinate.mtx")).unwrap();
    assert_eq!(full.symmetry, Symmetry::General);
    assert_eq!(dense(&full), stiffness());
}

#[test]
fn nastran_has_several_matrices_in_all_widths_of_fields() {
    let all = dmig::read(&sample("chain.pch")).unwrap();
    let names: Vec<_> = all.iter().map(|entry| entry.name.as_str()).collect();
    assert_eq!(names, ["KAAX", "MAAX", "ZAAX", "BAAX"]);
    let matrix = |k: usize| all[k].matrix.as_ref().unwrap();
    assert_eq!(all[0].labels, Labels::of_rows(sorted().to_vec()));
    assert_eq!((matrix(0).symmetry, dense(matrix(0))), (Symmetry::Symmetric, stiffness()));
    assert_eq!(matrix(1).entries, Entries::Real(vec![0.125, 0.25, 0.25, 0.125, 0.125]));
    // Amplitude 2 at 90°, 1 at 180°, 5 at nothing; a cosine of 90° in binary is 6e-17.
    assert_eq!(all[2].labels.rows, [label(1, 1), label(2, 1), label(4, 2)]);
    let z = dense(matrix(2));
    let expected = [c64::new(0.0, 2.0), c64::new(-1.0, 0.0), c64::new(5.0, 0.0)];
    for (value, expected) in z[0].iter().zip(expected) {
        assert!((value - expected).norm() < 1e-15, "{value}");
    }
    assert_eq!(z[2][0], z[0][2]);
    // Two columns, counted; the rows that occur.
    assert_eq!((matrix(3).nrows, matrix(3).ncols), (2, 2));
    assert_eq!(
        dense(matrix(3)),
        [[c64::new(1.0, 0.0), c64::default()], [c64::new(-0.25, 0.0), c64::default()]]
    );
}

#[test]
fn ansys_names_the_rows_of_a_harwell_boeing_file() {
    let rows = ansys::read_mapping(&sample("chain.mapping")).unwrap();
    assert_eq!(rows, triplets::read_dofs(&sample("chain.dof")).unwrap());
    assert_eq!(listed_labels(&rows), "4+X, 1+X, 4+Y and 2 more");
}

#[test]
fn all_are_told_by_content_and_read_by_one_door() {
    for (name, kind) in [
        ("chain.sti", FileKind::Triplets),
        ("chain_coordinate.mtx", FileKind::Triplets),
        ("chain_STIF1.mtx", FileKind::Abaqus),
        ("chain.pch", FileKind::Dmig),
    ] {
        assert_eq!(detect(&sample(name)), Some(kind), "{name}");
    }
    let all = read_matrices(&sample("chain.pch")).unwrap();
    assert_eq!(choose_matrix(&all, Some("KAAX")).unwrap().labels.rows, sorted());
    let message = choose_matrix(&all, None).unwrap_err().to_string();
    assert!(message.ends_with("found KAAX (5 x 5), MAAX (5 x 5), ZAAX (3 x 3), BAAX (2 x 2)"), "{message}");
    // Neither the names of rows nor a size line without its banner are a matrix.
    for nothing in [&sample("chain.dof")[..], &sample("chain.mapping"), b"5 5 13\n1 1 3.0\n"] {
        assert_eq!(detect(nothing), None);
    }
}

#[test]
fn degrees_of_freedom_without_a_direction_have_labels_too() {
    let text = b"-1,1, -1,1, 2.0\n1,8, -1,1, 1.0\n1,8, 1,8, 3.0\n";
    let (matrix, labels) = abaqus::read(text).unwrap();
    assert_eq!(labels.rows, [label(-1, 1), label(1, 8)]);
    assert_eq!(matrix.symmetry, Symmetry::Symmetric);
    let blanks = abaqus::read(b"-1 1 -1 1 2.0\n1 8 -1 1 1.0\n1 8 1 8 3.0\n").unwrap();
    assert_eq!(blanks, (matrix, labels));
}
