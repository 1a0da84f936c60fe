//! Matrices of a bar of bricks that CalculiX has written.

use crate::outside::shared;
use frfit_formats::{Entries, FileKind, Symmetry, detect, triplets};

#[test]
#[ignore = "needs the data of ../shared/data"]
fn calculix_bar_has_names_a_mass_and_no_asymmetry_needs_data() {
    let folder = shared("calculix_bar");
    let bytes = |ending: &str| std::fs::read(folder.join(format!("bar_matrix.{ending}"))).unwrap();
    let rows = triplets::read_dofs(&bytes("dof")).unwrap();
    assert_eq!(rows.len(), 1829);
    let mut mass_along_x = 0.0;
    for ending in ["sti", "mas"] {
        assert_eq!(detect(&bytes(ending)), Some(FileKind::Triplets));
        let matrix = triplets::read(&bytes(ending)).unwrap();
        assert_eq!((matrix.nrows, matrix.rows.len()), (1829, 91545));
        assert_eq!(matrix.symmetry, Symmetry::Symmetric);
        let Entries::Real(values) = &matrix.entries else { panic!("real") };
        for ((&row, &col), value) in matrix.rows.iter().zip(&matrix.cols).zip(values) {
            let along_x = [row, col].iter().all(|&k| rows[k].component == 1);
            if ending == "mas" && along_x {
                mass_along_x += if row == col { *value } else { 2.0 * value };
            }
        }
    }
    // A quarter of a bar of 0.3 m by 25 mm by 25 mm of the density in bar_frf.inp: Σ m_ij along x is the mass of what
    // was meshed, however the elements share it among their nodes.
    let input = std::fs::read_to_string(folder.join("bar_frf.inp")).unwrap();
    let density: f64 = input
        .lines()
        .skip_while(|line| !line.starts_with("*DENSITY"))
        .nth(1)
        .unwrap()
        .trim_end_matches(',')
        .trim()
        .parse()
        .unwrap();
    let nodes = std::fs::read_to_string(folder.join("nodes.csv")).unwrap();
    let volume: f64 = (1..4)
        .map(|k| {
            let at = |line: &str| line.split(',').nth(k).unwrap().parse::<f64>().unwrap();
            let (low, high) = nodes
                .lines()
                .skip(1)
                .map(at)
                .fold((f64::MAX, f64::MIN), |(low, high), x| (low.min(x), high.max(x)));
            high - low
        })
        .product();
    // 14 digits of each of 91545 entries.
    assert!((mass_along_x / (density * volume) - 1.0).abs() < 1e-9, "{mass_along_x} {}", density * volume);
}
