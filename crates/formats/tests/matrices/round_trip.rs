//! What is written is read back equal, for every type and symmetry.

use frfit_formats::{CoordinateMatrix, Entries, Symmetry, harwell_boeing, matrix_market};
use num_complex::Complex64 as c64;
use proptest::prelude::*;

/// Any finite double, subnormal numbers and -0 among them.
fn number() -> impl Strategy<Value = f64> {
    use proptest::num::f64::{NEGATIVE, NORMAL, POSITIVE, SUBNORMAL, ZERO};
    NORMAL | SUBNORMAL | ZERO | POSITIVE | NEGATIVE
}

#[derive(Debug, Clone, Copy)]
enum Kind {
    Pattern,
    Real,
    Complex,
}

fn matrix() -> impl Strategy<Value = CoordinateMatrix> {
    let symmetry = prop_oneof![
        Just(Symmetry::General),
        Just(Symmetry::Symmetric),
        Just(Symmetry::SkewSymmetric),
        Just(Symmetry::Hermitian)
    ];
    let kind = prop_oneof![Just(Kind::Pattern), Just(Kind::Real), Just(Kind::Complex)];
    let places = proptest::collection::btree_map((0_usize..12, 0_usize..12), (number(), number()), 0..40);
    (symmetry, kind, 12_usize..15, 12_usize..15, places).prop_map(|(symmetry, kind, nrows, ncols, places)| {
        let general = symmetry == Symmetry::General;
        let places: Vec<_> = places
            .into_iter()
            .filter(|((col, row), _)| {
                general || row > col || (row == col && symmetry != Symmetry::SkewSymmetric)
            })
            .collect();
        let value = |((col, row), (re, im)): &((usize, usize), (f64, f64))| {
            c64::new(*re, if symmetry == Symmetry::Hermitian && row == col { 0.0 } else { *im })
        };
        CoordinateMatrix {
            nrows,
            ncols: if general { ncols } else { nrows },
            symmetry,
            rows: places.iter().map(|((_, row), _)| *row).collect(),
            cols: places.iter().map(|((col, _), _)| *col).collect(),
            entries: match kind {
                Kind::Pattern => Entries::Pattern,
                Kind::Real => Entries::Real(places.iter().map(|p| value(p).re).collect()),
                Kind::Complex => Entries::Complex(places.iter().map(value).collect()),
            },
            title: "A title".into(),
        }
    })
}

/// Bits, so that -0 and 0 differ.
fn bits(matrix: &CoordinateMatrix) -> Vec<u64> {
    match &matrix.entries {
        Entries::Pattern => Vec::new(),
        Entries::Real(values) => values.iter().map(|x| x.to_bits()).collect(),
        Entries::Complex(values) => values.iter().flat_map(|z| [z.re.to_bits(), z.im.to_bits()]).collect(),
    }
}

proptest! {
    #[test]
    fn matrix_market_gives_the_bits_back(matrix in matrix()) {
        let written = matrix_market::write(&matrix);
        let (mut matrix, is_complex) = (matrix.clone(), matches!(matrix.entries, Entries::Complex(_)));
        if matrix.symmetry == Symmetry::SkewSymmetric && matrix.entries == Entries::Pattern {
            prop_assert!(written.is_err());
            return Ok(());
        }
        if matrix.symmetry == Symmetry::Hermitian && !is_complex {
            matrix.symmetry = Symmetry::Symmetric;
        }
        let again = matrix_market::read(&written.unwrap()).unwrap();
        prop_assert_eq!(bits(&again), bits(&matrix));
        prop_assert_eq!(again, matrix);
    }

    #[test]
    fn harwell_boeing_gives_the_bits_back(matrix in matrix()) {
        let again = harwell_boeing::read(&harwell_boeing::write(&matrix).unwrap()).unwrap();
        prop_assert_eq!(bits(&again), bits(&matrix));
        prop_assert_eq!(again, matrix);
    }

    #[test]
    fn the_order_of_entries_does_not_matter(matrix in matrix(), seed in any::<u64>()) {
        prop_assume!(!(matrix.symmetry == Symmetry::SkewSymmetric && matrix.entries == Entries::Pattern));
        let text = String::from_utf8(matrix_market::write(&matrix).unwrap()).unwrap();
        let (header, mut entries): (Vec<_>, Vec<_>) = {
            let mut lines = text.lines();
            (lines.by_ref().take(3).collect(), lines.collect())
        };
        entries.sort_by_key(|line| line.bytes().fold(seed, |hash, b| hash.rotate_left(7) ^ u64::from(b)));
        let shuffled = [header, entries].concat().join("\r\n");
        prop_assert_eq!(matrix_market::read(shuffled.as_bytes()), matrix_market::read(text.as_bytes()));
    }
}
