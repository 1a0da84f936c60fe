//! Inputs that once broke a reader, and the samples cut short anywhere: it may refuse them, but has to come back.

use std::path::Path;

use frfit_formats::{CoordinateMatrix, NamedMatrix, abaqus, ansys, dmig, triplets};

/// Reads anything with every reader; what one accepts is valid.
fn read_all(bytes: &[u8]) {
    let valid = |matrix: &CoordinateMatrix| matrix.validate().unwrap();
    if let Ok(matrix) = triplets::read(bytes) {
        valid(&matrix);
    }
    if let Ok((matrix, labels)) = abaqus::read(bytes) {
        valid(&matrix);
        assert_eq!(labels.rows.len(), matrix.nrows);
    }
    for NamedMatrix { matrix, labels, .. } in dmig::read(bytes).unwrap_or_default() {
        if let Ok(matrix) = matrix {
            valid(&matrix);
            assert_eq!(labels.rows.len(), matrix.nrows);
        }
    }
    let _ = triplets::read_dofs(bytes);
    let _ = ansys::read_mapping(bytes);
}

#[test]
fn samples_cut_short_anywhere_are_refused_or_read() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/labels/samples");
    for file in std::fs::read_dir(folder).unwrap() {
        let bytes = std::fs::read(file.unwrap().path()).unwrap();
        for end in 0..=bytes.len() {
            read_all(&bytes[..end]);
        }
    }
}

#[test]
fn samples_with_bytes_exchanged_are_refused_or_read() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/labels/samples");
    let alphabet = b"0123456789.,-+*$ \n\tDMIGE\xFF";
    let mut state = 1_u64;
    let mut below = |most: usize| {
        // Knuth's linear congruential generator: the same files in every run.
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as usize % most
    };
    for file in std::fs::read_dir(folder).unwrap() {
        let bytes = std::fs::read(file.unwrap().path()).unwrap();
        for _ in 0..2000 {
            let mut bytes = bytes.clone();
            for _ in 0..=below(4) {
                let at = below(bytes.len());
                bytes[at] = alphabet[below(alphabet.len())];
            }
            read_all(&bytes);
        }
    }
}
