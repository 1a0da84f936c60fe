//! The orthotropic plate against its strain energy and its natural frequencies, and against the isotropic plate.

use super::modes::lowest;
use super::support::{field, form, rate, relative_product};
use frfit_fem::exact::plate::{CLAMPED_SQUARE, UniformOrthotropicPlate, UniformPlate};
use frfit_fem::{Assembled, Direction, Error, Mass, OrthotropicPlate, Support};
use frfit_linalg::sparse::{SymmetricMatrix, Values};
use nalgebra::Matrix3;
use std::f64::consts::PI;

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
    OrthotropicPlate { lines, thickness: 0.01, edges: [edges; 4], ..OrthotropicPlate::default() }
}

/// Of spruce beside [`SPRUCE`]: G₁₃ and G₂₃, of which the second is that of rolling shear.
const SHEAR: [f64; 2] = [0.055, 0.0035];

/// Natural frequency in rad/s of m and n half-waves along sides a and b of a simply supported thick plate with density 1: w = W sin sin, θ₁ = A cos sin, θ₂ = B sin cos make the energy
/// a form of (W, A, B), and so the motion.
fn thick_rad_s([a, b]: [f64; 2], h: f64, constants: [f64; 4], shear: [f64; 2], m: usize, n: usize) -> f64 {
    let [d11, d22, d12, d66] = constants.map(|constant| constant * h.powi(3) / 12.0);
    let [s1, s2] = shear.map(|constant| 5.0 / 6.0 * constant * h);
    let [p, q] = [m as f64 * PI / a, n as f64 * PI / b];
    let stiffness = Matrix3::new(
        s1 * p * p + s2 * q * q,
        s1 * p,
        s2 * q,
        s1 * p,
        d11 * p * p + d66 * q * q + s1,
        (d12 + d66) * p * q,
        s2 * q,
        (d12 + d66) * p * q,
        d22 * q * q + d66 * p * p + s2,
    );
    let root = Matrix3::from_diagonal(
        &[h, h.powi(3) / 12.0, h.powi(3) / 12.0].map(|mass| mass.sqrt().recip()).into(),
    );
    (root * stiffness * root).symmetric_eigenvalues().min().sqrt()
}

/// Of 20 mm in 0.4 m the shear lowers the frequencies by a per cent to a half. What bilinear shear strains err by is a thousandth of that.
#[test]
fn simply_supported_thick_plates_have_the_frequencies_of_their_closed_form() {
    let (sides, thickness) = (exact().sides, 0.02);
    let constants = [SPRUCE.as_slice(), &SHEAR].concat();
    let by = |sheared: bool| {
        let of = |m, n| {
            let shear = if sheared { SHEAR } else { [1e3; 2] };
            thick_rad_s(sides, thickness, SPRUCE, shear, m, n)
        };
        let mut all: Vec<f64> = (1..7).flat_map(|m| (1..4).map(move |n| of(m, n))).collect();
        all.sort_by(f64::total_cmp);
        all
    };
    let (expected, stiff) = (by(true), by(false));
    let errors = |elements: [usize; 2]| {
        let plate = OrthotropicPlate { thick: true, thickness, ..plate(sides, elements, Support::Pinned) };
        let found = frequencies(&plate, &constants, 4);
        [0, 1, 2, 3].map(|i| found[i] / expected[i] - 1.0)
    };
    let (coarse, fine) = (errors([10, 8]), errors([20, 16]));
    for (i, (coarse, fine)) in coarse.into_iter().zip(fine).enumerate() {
        let lowered = stiff[i] / expected[i] - 1.0;
        assert!(lowered > 0.01 && fine > 0.0 && fine < 1e-3 * lowered, "{fine:e} of {lowered:e}");
        // Between the second order of the bilinear shear and the fourth of the deflection.
        assert!(rate(coarse, fine) > 1.9, "{coarse:e} {fine:e}");
    }
}

/// As G grows the thick plate becomes the thin one; nothing locks on elements ten times longer than thick and more.
#[test]
fn a_thick_plate_without_shear_is_the_thin_one() {
    let thin = OrthotropicPlate { thickness: 1e-4, ..plate(exact().sides, [6, 4], Support::Clamped) };
    let thick = OrthotropicPlate { thick: true, ..thin.clone() };
    let expected = frequencies(&thin, &SPRUCE, 4);
    for (found, expected) in
        frequencies(&thick, &[SPRUCE.as_slice(), &SHEAR].concat(), 4).iter().zip(expected)
    {
        let off = found / expected - 1.0;
        // (kh)² E/12κG of four half-waves is 1e-5.
        assert!(off < 1e-8 && off > -2e-5, "{off:e}");
    }
}

/// Clamped, a tenth of its side thick, isotropic with ν = 0.3: ω a √(ρ/G) of Rayleigh–Ritz with κ = 0.8601 are 1.594, 3.039, 3.039, 4.265 (Dawe & Roufaeil, J. Sound Vib. 69 (1980)
/// 345–359).
#[test]
fn a_clamped_thick_square_has_the_frequencies_of_ritz() {
    let poisson = 0.3;
    let modulus = 2.0 * (1.0 + poisson);
    let bent = modulus / (1.0 - poisson * poisson);
    let shear = 0.8601 / (5.0 / 6.0);
    let constants = [bent, bent, poisson * bent, 1.0, shear, shear];
    let plate =
        OrthotropicPlate { thick: true, thickness: 0.1, ..plate([1.0; 2], [16; 2], Support::Clamped) };
    for (found, expected) in frequencies(&plate, &constants, 4).iter().zip([1.594, 3.039, 3.039, 4.265]) {
        // The mesh, and the digits given.
        assert!((found / expected - 1.0).abs() < 2e-3, "{found} {expected}");
    }
}

/// Σ D K.
fn stiffness(of: &Assembled, constants: &[f64]) -> SymmetricMatrix {
    let mut sum = vec![0.0; of.stiffness[0].pattern().stored()];
    for (matrix, constant) in of.stiffness.iter().zip(constants) {
        matrix.accumulate_real_into(*constant, &mut sum);
    }
    SymmetricMatrix::new(of.stiffness[0].pattern().clone(), Values::Real(sum))
}

fn frequencies(plate: &OrthotropicPlate, constants: &[f64], count: usize) -> Vec<f64> {
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
        let found = frequencies(&plate(exact().sides, [elements; 2], Support::Pinned), &SPRUCE, 4);
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
    let found = frequencies(&plate([1.0; 2], [12; 2], Support::Clamped), &constants, CLAMPED_SQUARE.len());
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
            Direction::Twist => twist,
            _ => 0.0,
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

/// Of a thick plate: bending as that of the thin one where there is no shear strain, constant shear strains by hand, and rigid motions with their inertia.
#[test]
fn a_thick_plate_has_the_energy_of_bending_of_shear_and_of_rotation() {
    let (a, b, h) = (0.6, 0.25, 0.01);
    let lines = [vec![0.0, 0.02, 0.3, a], vec![0.0, 0.07, b]];
    let thin = OrthotropicPlate { lines, thickness: h, ..OrthotropicPlate::default() };
    let thick = OrthotropicPlate { thick: true, ..thin.clone() }.assemble().unwrap();
    let thin = thin.assemble().unwrap();
    assert_eq!((thick.stiffness.len(), thick.mass.len(), thick.dofs.len()), (6, 1, 72));
    let x2y = |of: &Assembled| deflection(of, |x, y| [x * x * y, 2.0 * x * y, x * x, 2.0 * x]);
    for (thin_matrix, matrix) in thin.stiffness.iter().zip(&thick.stiffness) {
        let [expected, found] =
            [(&thin, thin_matrix), (&thick, matrix)].map(|(of, matrix)| form(&x2y(of), matrix, &x2y(of)));
        assert!((found - expected).abs() < 1e-9 * expected.abs().max(h.powi(3)), "{found:e} {expected:e}");
    }
    // γ alone: w = γ₁ x + γ₂ y, and no rotation.
    let [g1, g2] = [0.3, -0.7];
    let sheared = field(&thick, |[x, y, _], direction| match direction {
        Direction::Z => g1 * x + g2 * y,
        Direction::ShearX => g1,
        Direction::ShearY => g2,
        _ => 0.0,
    });
    let of_shear = [g1, g2].map(|g| 5.0 / 6.0 * h * g * g * a * b);
    for (matrix, expected) in thick.stiffness.iter().zip([0.0; 4].into_iter().chain(of_shear)) {
        let found = form(&sheared, matrix, &sheared);
        assert!((found - expected).abs() < 1e-12, "{found:e} {expected:e}");
    }
    let about_y = deflection(&thick, |x, _| [x, 1.0, 0.0, 0.0]);
    for matrix in &thick.stiffness {
        assert!(relative_product(matrix, &about_y) < 1e-12);
    }
    let inertia = h * b * a.powi(3) / 3.0 + h.powi(3) / 12.0 * a * b;
    assert!((form(&about_y, &thick.mass[0], &about_y) / inertia - 1.0).abs() < 1e-12);
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
