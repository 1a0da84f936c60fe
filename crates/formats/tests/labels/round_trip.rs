//! Matrices written here in every dialect of the formats are read back equal.

use frfit_formats::{CoordinateMatrix, DofLabel, Entries, Symmetry, abaqus, ansys, dmig, triplets};
use num_complex::Complex64 as c64;
use proptest::prelude::*;
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;

type Place = (DofLabel, DofLabel);

/// Column and row, and the bits of the real and the imaginary part.
type Bits = BTreeMap<(usize, usize), [u64; 2]>;

fn label(components: std::ops::Range<u8>) -> impl Strategy<Value = DofLabel> {
    (1_i64..12, components).prop_map(|(node, component)| DofLabel { node, component })
}

fn number() -> impl Strategy<Value = f64> {
    use proptest::num::f64::{NEGATIVE, NORMAL, POSITIVE, SUBNORMAL, ZERO};
    NORMAL | SUBNORMAL | ZERO | POSITIVE | NEGATIVE
}

/// Entries of one triangle, in any order; which triangle differs from entry to entry.
fn triangle(components: std::ops::Range<u8>) -> impl Strategy<Value = Vec<(Place, c64)>> {
    let entry = ((label(components.clone()), label(components)), (number(), number(), any::<bool>()));
    proptest::collection::vec(entry, 1..30).prop_map(|entries| {
        let mut met = BTreeSet::new();
        let once = entries.into_iter().filter(|((a, b), _)| met.insert((*a.max(b), *a.min(b))));
        let turned =
            once.map(|((a, b), (re, im, turn))| (if turn { (b, a) } else { (a, b) }, c64::new(re, im)));
        turned.collect()
    })
}

/// What a symmetric matrix of these entries is: sorted rows, lower triangle, bits of the values.
fn expected(entries: &[(Place, c64)]) -> (Vec<DofLabel>, Bits) {
    let labels: BTreeSet<_> = entries.iter().flat_map(|((a, b), _)| [*a, *b]).collect();
    let labels: Vec<_> = labels.into_iter().collect();
    let at = |label: &DofLabel| labels.binary_search(label).unwrap();
    let folded = entries.iter().map(|((a, b), value)| {
        let (row, col) = (at(a).max(at(b)), at(a).min(at(b)));
        ((col, row), [value.re.to_bits(), value.im.to_bits()])
    });
    let folded = folded.collect();
    (labels, folded)
}

fn bits(matrix: &CoordinateMatrix) -> Bits {
    let value = |k: usize| match &matrix.entries {
        Entries::Real(values) => [values[k].to_bits(), 0],
        Entries::Complex(values) => [values[k].re.to_bits(), values[k].im.to_bits()],
        Entries::Pattern => panic!("no values"),
    };
    (matrix.cols.iter().zip(&matrix.rows))
        .enumerate()
        .map(|(k, (&col, &row))| ((col, row), value(k)))
        .collect()
}

fn real(entries: &[(Place, c64)]) -> Vec<(Place, c64)> {
    entries.iter().map(|(place, value)| (*place, c64::new(value.re, 0.0))).collect()
}

#[derive(Debug, Clone, Copy)]
enum Fields {
    Large,
    Free,
    FreeLarge,
}

/// DMIG cards, one for each entry or, for neighbours of one column, continued.
fn dmig_text(name: &str, entries: &[(Place, c64)], is_complex: bool, fields: Fields) -> String {
    let mut text = format!("$ comment\nDMIG,{name},0,6,{},0,,,\n", if is_complex { 4 } else { 2 });
    let mut last = None;
    for ((row, col), value) in entries {
        // 17 digits and an exponent have to fit: only free fields have the room for all of them.
        let shown = |x: f64| format!("{x:.16e}");
        let (re, im) = (shown(value.re), if is_complex { shown(value.im) } else { String::new() });
        let again = last.replace(*col) == Some(*col);
        match fields {
            Fields::Free if again => {
                let _ = writeln!(text, "+,{},{},{re},{im}", row.node, row.component);
            }
            Fields::Free => {
                let (j, cj) = (col.node, col.component);
                let _ = writeln!(text, "DMIG,{name},{j},{cj},,{},{},{re},{im},+", row.node, row.component);
            }
            Fields::FreeLarge => {
                if !again {
                    let _ = writeln!(text, "DMIG*,{name},{},{},", col.node, col.component);
                }
                let _ = writeln!(text, "*,{},{},{re},{im}", row.node, row.component);
            }
            Fields::Large => {
                if !again {
                    let _ = writeln!(text, "DMIG*   {name:<16}{:>16}{:>16}", col.node, col.component);
                }
                let im = if is_complex { format!("{:>16}", digits(value.im)) } else { String::new() };
                let _ = writeln!(
                    text,
                    "*       {:>16}{:>16}{:>16}{im}",
                    row.node,
                    row.component,
                    digits(value.re)
                );
            }
        }
    }
    text
}

/// Nine digits in sixteen columns.
fn digits(x: f64) -> String {
    format!("{x:.8e}").replace('e', "D")
}

proptest! {
    #[test]
    fn abaqus_labels_give_the_bits_back(entries in triangle(1..9), blanks in any::<bool>()) {
        let entries = real(&entries);
        let mut text = String::from("** ASSEMBLED\n");
        for ((row, col), value) in &entries {
            let line = format!("{},{}, {},{}, {:.16e}", row.node, row.component, col.node, col.component, value.re);
            let _ = writeln!(text, "{}", if blanks { line.replace(',', " ") } else { line });
        }
        let (matrix, labels) = abaqus::read(text.as_bytes()).unwrap();
        let (rows, folded) = expected(&entries);
        prop_assert_eq!(matrix.symmetry, Symmetry::Symmetric);
        prop_assert_eq!(bits(&matrix), folded);
        prop_assert_eq!(labels.rows, rows);
        matrix.validate().unwrap();
    }

    #[test]
    fn both_triangles_are_a_general_matrix(entries in triangle(1..4)) {
        let entries = real(&entries);
        let mut text = String::new();
        let mut pairs = 0;
        for ((row, col), value) in &entries {
            let (a, b) = (format!("{},{}", row.node, row.component), format!("{},{}", col.node, col.component));
            let _ = writeln!(text, "{a}, {b}, {:.16e}", value.re);
            if a != b {
                pairs += 1;
                let _ = writeln!(text, "{b}, {a}, {:.16e}", value.re);
            }
        }
        let (matrix, _) = abaqus::read(text.as_bytes()).unwrap();
        let kind = if pairs > 0 { Symmetry::General } else { Symmetry::Symmetric };
        prop_assert_eq!(matrix.symmetry, kind);
        prop_assert_eq!(matrix.rows.len(), entries.len() + pairs);
    }

    #[test]
    fn dmig_gives_the_bits_back_in_free_fields(
        entries in triangle(0..7), is_complex in any::<bool>(), large in any::<bool>(),
    ) {
        let mut entries = if is_complex { entries } else { real(&entries) };
        entries.sort_by_key(|((_, col), _)| *col);
        let fields = if large { Fields::FreeLarge } else { Fields::Free };
        let text = dmig_text("KAAX", &entries, is_complex, fields);
        let all = dmig::read(text.as_bytes()).unwrap();
        let (rows, folded) = expected(&entries);
        prop_assert_eq!(bits(all[0].matrix.as_ref().unwrap()), folded, "{}", text);
        prop_assert_eq!(&all[0].labels.rows, &rows);
    }

    #[test]
    fn dmig_gives_nine_digits_back_in_large_fields(entries in triangle(0..7), is_complex in any::<bool>()) {
        // Of exponents of three digits the field has no room for a sign and a letter: as Nastran, none are written.
        let small = |x: f64| if x == 0.0 || (1e-99..1e99).contains(&x.abs()) { x } else { 1.0 };
        let to_nine = |x: f64| format!("{:.8e}", small(x)).parse::<f64>().unwrap();
        let mut entries: Vec<_> = if is_complex { entries } else { real(&entries) };
        for (_, value) in &mut entries {
            *value = c64::new(to_nine(value.re), if is_complex { to_nine(value.im) } else { 0.0 });
        }
        entries.sort_by_key(|((_, col), _)| *col);
        let text = dmig_text("M", &entries, is_complex, Fields::Large).replace('\n', "\r\n");
        let all = dmig::read(text.as_bytes()).unwrap();
        prop_assert_eq!(bits(all[0].matrix.as_ref().unwrap()), expected(&entries).1, "{}", text);
    }

    #[test]
    fn triplets_give_the_bits_back(entries in triangle(1..3), upper in any::<bool>()) {
        let entries = real(&entries);
        let (rows, folded) = expected(&entries);
        let mut text = String::new();
        for ((col, row), value) in &folded {
            let (i, j) = if upper { (col, row) } else { (row, col) };
            let _ = writeln!(text, "{} {} {:20.13e}", i + 1, j + 1, f64::from_bits(value[0]));
        }
        let matrix = triplets::read(text.as_bytes()).unwrap();
        let rounded: BTreeMap<_, _> = folded.iter().map(|(place, value)| {
            (*place, [format!("{:.13e}", f64::from_bits(value[0])).parse::<f64>().unwrap().to_bits(), 0])
        }).collect();
        prop_assert_eq!(bits(&matrix), rounded);
        prop_assert_eq!((matrix.nrows, matrix.symmetry), (rows.len(), Symmetry::Symmetric));
    }

    #[test]
    fn names_of_rows_come_back_in_their_order(labels in proptest::collection::hash_set(label(1..7), 1..40)) {
        let labels: Vec<_> = labels.into_iter().collect();
        let dofs: String = labels.iter().map(|l| format!("{}.{}\n", l.node, l.component)).collect();
        prop_assert_eq!(&triplets::read_dofs(dofs.as_bytes()).unwrap(), &labels);
        let names = ["UX", "UY", "UZ", "ROTX", "ROTY", "ROTZ"];
        let mut mapping = String::from("    Matrix Eqn          Node    DOF     \r\n");
        for (k, l) in labels.iter().enumerate() {
            let _ = write!(mapping, "{:14}{:14}    {:<4}\r\n", k + 1, l.node, names[l.component as usize - 1]);
        }
        prop_assert_eq!(&ansys::read_mapping(mapping.as_bytes()).unwrap(), &labels);
    }

    #[test]
    fn a_matrix_that_is_renumbered_there_and_back_is_the_same(
        entries in triangle(1..4), seed in any::<u64>(), more in 0_usize..3,
    ) {
        let mut text = String::new();
        for ((row, col), value) in &real(&entries) {
            let _ = writeln!(text, "{} {} {} {} {:.16e}", row.node, row.component, col.node, col.component, value.re);
        }
        let (matrix, labels) = abaqus::read(text.as_bytes()).unwrap();
        let size = matrix.nrows + more;
        let mut places: Vec<usize> = (0..size).collect();
        places.sort_by_key(|&k| (k as u64 + 1).wrapping_mul(seed | 1).rotate_left(17));
        let there: Vec<_> = places.iter().take(matrix.nrows).map(|&k| Some(k)).collect();
        let mut back = vec![None; size];
        there.iter().enumerate().for_each(|(k, place)| back[place.unwrap()] = Some(k));
        let moved = matrix.renumbered(&there, size).unwrap();
        moved.validate().unwrap();
        prop_assert_eq!(moved.renumbered(&back, labels.rows.len()).unwrap(), matrix);
    }
}
