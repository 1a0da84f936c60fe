//! The plate against Navier, and the clamped square plate against Ritz.

use super::modes::lowest;
use super::support::{field, form, rate, relative_product, translation};
use frfit_fem::exact::plate::{CLAMPED_SQUARE, UniformPlate};
use frfit_fem::{Direction, Error, Mass, Plate, Support};
use nalgebra::{DMatrix, SymmetricEigen};
use proptest::prelude::*;

const STEEL: UniformPlate =
    UniformPlate { modulus: 1.0, density: 1.0, poisson: 0.3, thickness: 0.01, sides: [1.0, 0.7] };

fn plate(sides: [f64; 2], elements: usize, edges: Support, mass: Mass) -> Plate {
    let (thickness, poisson) = (STEEL.thickness, STEEL.poisson);
    Plate { sides, thickness, poisson, elements: [elements; 2], edges: [edges; 4], mass }
}

fn frequencies(plate: &Plate, count: usize) -> Vec<f64> {
    let assembled = plate.assemble().unwrap();
    let squares = lowest(&assembled.stiffness[0], &assembled.mass[0], count, 0.0);
    squares.into_iter().map(f64::sqrt).collect()
}

#[test]
fn simply_supported_frequencies_converge_like_h2() {
    // Ascending for sides 1 and 0.7.
    let half_waves = [(1, 1), (2, 1), (1, 2)];
    for mass in [Mass::Consistent, Mass::Lumped] {
        let errors = |elements| {
            let found = frequencies(&plate(STEEL.sides, elements, Support::Pinned, mass), 3);
            let exact = half_waves.map(|(m, n)| STEEL.simply_supported_rad_s(m, n));
            [0, 1, 2].map(|i| found[i] / exact[i] - 1.0)
        };
        let (coarse, fine) = (errors(12), errors(24));
        for (coarse, fine) in coarse.into_iter().zip(fine) {
            // kh = 0.26 at most: the next order is some (kh)² of the first.
            assert!(fine.abs() > 1e-5 && (rate(coarse, fine) - 2.0).abs() < 0.1, "{mass:?} {coarse} {fine}");
        }
    }
}

#[test]
fn clamped_square_frequencies_converge_like_h2() {
    let unit = UniformPlate { sides: [1.0; 2], ..STEEL };
    let errors = |elements| {
        let found = frequencies(&plate([1.0; 2], elements, Support::Clamped, Mass::Consistent), 6);
        (1..=6).map(|n| found[n - 1] / unit.clamped_square_rad_s(n).unwrap() - 1.0).collect::<Vec<_>>()
    };
    for (coarse, fine) in errors(16).into_iter().zip(errors(32)) {
        // The coefficients are good to 1e-6, a thousandth of the error at 32 × 32.
        assert!(fine.abs() > 1e-4 && (rate(coarse, fine) - 2.0).abs() < 0.1, "{coarse} {fine}");
    }
}

/// ∫ f g over (−1, 1) of polynomials given by their coefficients, lowest power first.
fn inner(f: &[f64], g: &[f64]) -> f64 {
    let mut sum = 0.0;
    for (i, f) in f.iter().enumerate() {
        for (j, g) in g.iter().enumerate().filter(|(j, _)| (i + j) % 2 == 0) {
            sum += 2.0 * f * g / (i + j + 1) as f64;
        }
    }
    sum
}

fn derivative(f: &[f64]) -> Vec<f64> {
    f.iter().enumerate().skip(1).map(|(power, f)| power as f64 * f).collect()
}

/// Polynomials of clamped ends, (1 − x²)² xⁱ made orthonormal.
fn clamped_polynomials(count: usize) -> Vec<Vec<f64>> {
    let mut basis: Vec<Vec<f64>> = Vec::new();
    for i in 0..count {
        let mut f = vec![0.0; count + 4];
        [1.0, 0.0, -2.0, 0.0, 1.0].iter().enumerate().for_each(|(k, coefficient)| f[i + k] = *coefficient);
        for _ in 0..2 {
            for other in &basis {
                let along = inner(&f, other);
                f.iter_mut().zip(other).for_each(|(f, other)| *f -= along * other);
            }
        }
        let norm = inner(&f, &f).sqrt();
        basis.push(f.into_iter().map(|f| f / norm).collect());
    }
    basis
}

/// Rayleigh–Ritz of the clamped square plate of side 2, energy ∫ (∇²w)², which clamped edges make right for any ν.
fn clamped_square_by_ritz(terms: usize) -> Vec<f64> {
    let basis = clamped_polynomials(terms);
    let first: Vec<_> = basis.iter().map(|f| derivative(f)).collect();
    let second: Vec<_> = first.iter().map(|f| derivative(f)).collect();
    let gram = |f: &[Vec<f64>]| DMatrix::from_fn(terms, terms, |i, j| inner(&f[i], &f[j]));
    let (mass, slope, curvature) = (DMatrix::identity(terms, terms), gram(&first), gram(&second));
    // ∫ f″ f = −∫ f′ f′ for clamped ends.
    let energy = curvature.kronecker(&mass) + mass.kronecker(&curvature) + slope.kronecker(&slope) * 2.0;
    let mut squares: Vec<f64> = SymmetricEigen::new(energy).eigenvalues.iter().copied().collect();
    squares.sort_by(f64::total_cmp);
    squares.into_iter().take(6).map(|square| 4.0 * square.sqrt()).collect()
}

#[test]
fn coefficients_of_the_clamped_square_plate() {
    let (fewer, found) = (clamped_square_by_ritz(10), clamped_square_by_ritz(12));
    for ((found, fewer), table) in found.iter().zip(&fewer).zip(CLAMPED_SQUARE) {
        // Rounded to four places; two terms more change the sixth digit at most.
        assert!((found - table).abs() < 1e-4, "{found} {table}");
        assert!((fewer - found).abs() < 1e-4, "{fewer} {found}");
    }
}

#[test]
fn clamped_20_by_20_has_1083_dofs() {
    let assembled = plate([1.0; 2], 20, Support::Clamped, Mass::Lumped).assemble().unwrap();
    assert_eq!(assembled.dofs.len(), 1083);
    assert_eq!(assembled.nodes.len(), 441);
    let centre = assembled.nearest([0.5, 0.5, 0.0]).unwrap();
    assert_eq!(assembled.row(centre, Direction::Z), Some(541 - 1));
    let massless = assembled.rows(Direction::RX).chain(assembled.rows(Direction::RY));
    assert!(massless.into_iter().all(|row| assembled.mass[0].get(row, row).re == 0.0));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]
    #[test]
    fn mass_and_rigid_motion(
        a in 1e-1..1e1_f64, aspect in 0.2..5.0_f64, thickness in 1e-4..1e-1_f64, poisson in -0.9..0.49_f64,
        nx in 1_usize..8, ny in 1_usize..8,
        mass in prop::sample::select(vec![Mass::Consistent, Mass::Lumped, Mass::Mean]),
    ) {
        let sides = [a, a * aspect];
        let options = Plate { sides, thickness, poisson, elements: [nx, ny], mass, ..Plate::default() };
        let assembled = options.assemble().unwrap();
        let moved = translation(&assembled, Direction::Z);
        let about_x = field(&assembled, |[_, y, _], direction| match direction {
            Direction::Z => y,
            Direction::RX => 1.0,
            _ => 0.0,
        });
        let about_y = field(&assembled, |[x, ..], direction| match direction {
            Direction::Z => -x,
            Direction::RY => 1.0,
            _ => 0.0,
        });
        let volume = a * a * aspect * thickness;
        prop_assert!((form(&moved, &assembled.mass[0], &moved) - volume).abs() < 1e-12 * volume);
        for rigid in [moved, about_x, about_y] {
            // Entries of the stiffness differ by (side/step)² between deflections and rotations.
            prop_assert!(relative_product(&assembled.stiffness[0], &rigid) < 1e-12);
        }
    }
}

#[test]
fn refusals() {
    let name = |plate: Plate| match plate.assemble() {
        Err(Error::OutOfRange { name, .. }) => name,
        _ => "",
    };
    assert_eq!(name(Plate { sides: [1.0, f64::INFINITY], ..Plate::default() }), "side");
    assert_eq!(name(Plate { poisson: 0.5, ..Plate::default() }), "Poisson's ratio");
    assert_eq!(name(Plate { thickness: 0.0, ..Plate::default() }), "thickness");
    assert_eq!(name(Plate { elements: [3, 0], ..Plate::default() }), "number of elements");
}
