//! The orthotropic plate against its strain energy and its natural frequencies, and against the isotropic plate.

use super::modes::lowest;
use super::support::{field, form, rate, relative_product};
use frfit_fem::exact::plate::{CLAMPED_SQUARE, UniformOrthotropicPlate, UniformPlate};
use frfit_fem::{Assembled, Direction, Error, Mass, OrthotropicPlate, Support};
use frfit_linalg::sparse::{SymmetricMatrix, Values};

/// D₁₁, D₂₂, D₁₂ and D₆₆ as those of spruce, relative to the first.
const SPRUCE: [f64; 4] = [1.0, 0.09, 0.03, 0.06];

/// Of a thickness of 10 mm, a density of 1 kg/m³, sides of 1 m and 0.4 m.
fn exact() -> UniformOrthotropicPlate {
    UniformOrthotropicPlate { constants: SPRUCE, density: 1.0, thickness: 0.01, sides: [1.0, 0.4] }
}

fn equal(side: f64, elements: usize) -> Vec<f64> {
    (0..=elements).map(|k| side * k as f64 / elements as f64).collect()
}

fn plate(sides: [f64; 2], elements: [usize; 2], edges: Support) -> OrthotropicPlate {
    let lines = [0, 1].map(|axis| equal(sides[axis], elements[axis]));
    OrthotropicPlate { lines, thickness: 0.01, edges: [edges; 4], mass: Mass::Consistent }
}

/// Σ D K.
fn stiffness(of: &Assembled, constants: [f64; 4]) -> SymmetricMatrix {
    let mut sum = vec![0.0; of.stiffness[0].pattern().stored()];
    for (matrix, constant) in of.stiffness.iter().zip(constants) {
        matrix.accumulate_real_into(constant, &mut sum);
    }
    SymmetricMatrix::new(of.stiffness[0].pattern().clone(), Values::Real(sum))
}

fn frequencies(plate: &OrthotropicPlate, constants: [f64; 4], count: usize) -> Vec<f64> {
    let assembled = plate.assemble().unwrap();
    let squares = lowest(&stiffness(&assembled, constants), &assembled.mass[0], count, 0.0);
    squares.into_iter().map(f64::sqrt).collect()
}

#[test]
fn simply_supported_frequencies_converge_like_h4_from_above() {
    let mut lowest_exact: Vec<f64> =
        (1..6).flat_map(|m| (1..4).map(move |n| exact().simply_supported_rad_s(m, n))).collect();
    lowest_exact.sort_by(f64::total_cmp);
    let errors = |elements| {
        let found = frequencies(&plate(exact().sides, [elements; 2], Support::Pinned), SPRUCE, 4);
        [0, 1, 2, 3].map(|i| found[i] / lowest_exact[i] - 1.0)
    };
    let (coarse, fine) = (errors(8), errors(16));
    for (coarse, fine) in coarse.into_iter().zip(fine) {
        // Up to four half-waves on eight elements: the next order is some (kh)²/30 of the first. The iteration leaves 1e-9.
        assert!(fine > 1e-7 && (rate(coarse, fine) - 4.0).abs() < 0.3, "{coarse} {fine}");
    }
}

/// D₁₁ = D₂₂ = E/(1 − ν²), D₁₂ = ν D₁₁, D₆₆ = E/2(1 + ν).
#[test]
fn an_isotropic_clamped_square_has_the_frequencies_of_ritz() {
    let poisson = 0.3;
    let bent = 1.0 / (1.0 - poisson * poisson);
    let constants = [bent, bent, poisson * bent, 0.5 / (1.0 + poisson)];
    let unit = UniformPlate { modulus: 1.0, density: 1.0, poisson, thickness: 0.01, sides: [1.0; 2] };
    let found = frequencies(&plate([1.0; 2], [12; 2], Support::Clamped), constants, CLAMPED_SQUARE.len());
    for (n, found) in (1..).zip(found) {
        let off = found / unit.clamped_square_rad_s(n).unwrap() - 1.0;
        // Of three half-waves k is some 3.5 π, and (kh)⁴/1440 on twelve elements 5e-4; the coefficients are good to 1e-6.
        assert!((-2e-6..6e-4).contains(&off), "mode {n}: {off:e}");
    }
}

/// The values of a deflection at all rows, from (w, w,x, w,y, w,xy).
fn deflection(of: &Assembled, w: impl Fn(f64, f64) -> [f64; 4]) -> Vec<f64> {
    field(of, |[x, y, _], direction| {
        let [value, x_slope, y_slope, twist] = w(x, y);
        match direction {
            Direction::Z => value,
            Direction::RX => y_slope,
            Direction::RY => -x_slope,
            _ => twist,
        }
    })
}

/// Each matrix has its own part of the strain energy, on unequal elements: of x², y², xy and x²y they are integrals by hand.
#[test]
fn each_constant_has_its_part_of_the_strain_energy() {
    let (a, b) = (0.6, 0.25);
    let lines = [vec![0.0, 0.02, 0.3, a], vec![0.0, 0.07, b]];
    let assembled =
        OrthotropicPlate { lines, thickness: 0.01, ..OrthotropicPlate::default() }.assemble().unwrap();
    let bending = 0.01_f64.powi(3) / 12.0;
    let x2 = deflection(&assembled, |x, _| [x * x, 2.0 * x, 0.0, 0.0]);
    let y2 = deflection(&assembled, |_, y| [y * y, 0.0, 2.0 * y, 0.0]);
    let xy = deflection(&assembled, |x, y| [x * y, y, x, 1.0]);
    let x2y = deflection(&assembled, |x, y| [x * x * y, 2.0 * x * y, x * x, 2.0 * x]);
    let area = a * b;
    // wᵀ K v for D₁₁, D₂₂, D₁₂ and D₆₆.
    let expected = [
        (&x2, &x2, [4.0 * area, 0.0, 0.0, 0.0]),
        (&y2, &y2, [0.0, 4.0 * area, 0.0, 0.0]),
        (&x2, &y2, [0.0, 0.0, 4.0 * area, 0.0]),
        (&xy, &xy, [0.0, 0.0, 0.0, 4.0 * area]),
        (&x2y, &x2y, [4.0 * a * b.powi(3) / 3.0, 0.0, 0.0, 16.0 * a.powi(3) * b / 3.0]),
        (&x2y, &y2, [0.0, 0.0, 2.0 * a * b * b, 0.0]),
        (&x2y, &xy, [0.0, 0.0, 0.0, 4.0 * a * a * b]),
    ];
    for (left, right, by_hand) in expected {
        for (matrix, by_hand) in assembled.stiffness.iter().zip(by_hand) {
            let found = form(left, matrix, right) / bending;
            // Of numbers up to one; entries of short elements are 1e5 times those of long ones.
            assert!((found - by_hand).abs() < 1e-9, "{found} for {by_hand}");
        }
    }
}

#[test]
fn mass_and_rigid_motion() {
    let lines = [vec![0.0, 0.02, 0.3, 0.58], vec![0.0, 0.02, 0.1, 0.217]];
    for mass in [Mass::Consistent, Mass::Lumped] {
        let plate =
            OrthotropicPlate { lines: lines.clone(), mass, thickness: 0.005, ..OrthotropicPlate::default() };
        let assembled = plate.assemble().unwrap();
        assert_eq!((assembled.stiffness.len(), assembled.mass.len(), assembled.dofs.len()), (4, 1, 64));
        let moved = deflection(&assembled, |_, _| [1.0, 0.0, 0.0, 0.0]);
        let volume = 0.58 * 0.217 * 0.005;
        assert!((form(&moved, &assembled.mass[0], &moved) - volume).abs() < 1e-12 * volume);
        let about_y = deflection(&assembled, |x, _| [x, 1.0, 0.0, 0.0]);
        let about_x = deflection(&assembled, |_, y| [y, 0.0, 1.0, 0.0]);
        for rigid in [moved, about_x, about_y] {
            for matrix in &assembled.stiffness {
                // Roundoff of entries that differ by (1/step)² between deflections and slopes.
                assert!(relative_product(matrix, &rigid) < 1e-12);
            }
        }
    }
}

#[test]
fn refusals() {
    let name = |plate: OrthotropicPlate| match plate.assemble() {
        Err(Error::OutOfRange { name, .. }) => name,
        _ => "",
    };
    let [x, y] = [vec![0.0, 0.5, 0.5, 1.0], vec![0.0, 1.0]];
    assert_eq!(
        name(OrthotropicPlate { lines: [x, y.clone()], ..Default::default() }),
        "step between grid lines"
    );
    assert_eq!(name(OrthotropicPlate { lines: [vec![0.0], y], ..Default::default() }), "number of elements");
    assert_eq!(name(OrthotropicPlate { thickness: f64::NAN, ..Default::default() }), "thickness");
    let held = plate([1.0; 2], [1; 2], Support::Clamped);
    assert_eq!(held.assemble(), Err(Error::NothingMoves));
}
