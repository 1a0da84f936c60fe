//! The beam against the characteristic equations.

use super::modes::lowest;
use super::support::{field, form, rate, relative_product, translation};
use frfit_fem::exact::beam::UniformBeam;
use frfit_fem::{Beam, Direction, Error, Mass, Support};
use proptest::prelude::*;

const UNIT: UniformBeam = UniformBeam { modulus: 1.0, density: 1.0, area: 1.0, inertia: 1.0, length: 1.0 };

#[test]
fn natural_frequencies_of_all_ends_converge_from_above_like_h4() {
    use Support::{Clamped, Free, Pinned};
    for (ends, rigid) in [
        ([Free, Free], 2),
        ([Clamped, Free], 0),
        ([Free, Clamped], 0),
        ([Clamped, Clamped], 0),
        ([Clamped, Pinned], 0),
        ([Free, Pinned], 1),
        ([Pinned, Pinned], 0),
    ] {
        for n in 1..=3 {
            let exact = UNIT.natural_frequency_rad_s(ends, n);
            let error = |elements| {
                let assembled = Beam { elements, ends, ..Beam::default() }.assemble().unwrap();
                let (k, m) = (&assembled.stiffness[0], &assembled.mass[0]);
                lowest(k, m, n + rigid, exact.powi(2))[n + rigid - 1].sqrt() / exact - 1.0
            };
            let (coarse, fine) = (error(16), error(32));
            // βh ≤ 0.4 at 32 elements, and the next order is some (βh)² of the first.
            assert!(fine > 0.0 && (rate(coarse, fine) - 4.0).abs() < 0.1, "{ends:?} {n} {coarse} {fine}");
        }
    }
}

#[test]
fn lumped_mass_converges_from_below_like_h2() {
    let ends = [Support::Clamped, Support::Free];
    let exact = UNIT.natural_frequency_rad_s(ends, 1);
    let error = |elements| {
        let assembled = Beam { elements, ends, mass: Mass::Lumped, ..Beam::default() }.assemble().unwrap();
        lowest(&assembled.stiffness[0], &assembled.mass[0], 1, 0.0)[0].sqrt() / exact - 1.0
    };
    let (coarse, fine) = (error(8), error(16));
    assert!(fine < 0.0 && (rate(coarse, fine) - 2.0).abs() < 0.05, "{coarse} {fine}");
}

/// Deflection F L³/3EI and rotation RY = −F L²/2EI of the tip: cubics are exact on one element.
#[test]
fn cantilever_under_a_tip_force() {
    let beam = Beam { length: 2.0, inertia: 3.0, ends: [Support::Clamped, Support::Free], ..Beam::default() };
    let k = &beam.assemble().unwrap().stiffness[0];
    let (w, ry) = (8.0 / 9.0, -4.0 / 6.0);
    let force = |row| k.get(row, 0).re * w + k.get(row, 1).re * ry;
    assert!((force(0) - 1.0).abs() < 1e-14 && force(1).abs() < 1e-14);
}

/// ω² of Timoshenko's beam on two pins with ρ = E = 1, the lower root of (κG A k² − A ω²)(I k² + κG A − I ω²) = (κG A k)², k = nπ/L.
fn timoshenko_squared(area: f64, inertia: f64, shear: f64, k: f64) -> f64 {
    let stiff = shear * area;
    let b = stiff * k * k * inertia + area * (inertia * k * k + stiff);
    let c = stiff * k * k * inertia * k * k;
    // The root without cancellation of AI ω⁴ − b ω² + c = 0.
    2.0 * c / (b + (b * b - 4.0 * area * inertia * c).sqrt())
}

#[test]
fn with_shear_natural_frequencies_converge_to_timoshenko_s() {
    // A beam a tenth as thick as long: the fifth mode is a quarter lower than without shear and rotary inertia.
    let (inertia, shear) = (0.01 / 12.0, 0.85 / 2.6);
    let ends = [Support::Pinned; 2];
    for n in [1, 3, 5] {
        let exact = timoshenko_squared(1.0, inertia, shear, n as f64 * std::f64::consts::PI).sqrt();
        let error = |elements| {
            let beam = Beam { inertia, elements, ends, shear: Some(shear), ..Beam::default() };
            let assembled = beam.assemble().unwrap();
            lowest(&assembled.stiffness[0], &assembled.mass[0], n, exact.powi(2))[n - 1].sqrt() / exact - 1.0
        };
        let (coarse, fine) = (error(16), error(32));
        // (kh)²/12 of the share that shear has: a third of 2 % for five half-waves on 32 elements.
        assert!(fine > 0.0 && fine < 6e-3 && rate(coarse, fine) > 1.9, "{n} {coarse} {fine}");
    }
    let euler = UniformBeam { inertia, ..UNIT }.natural_frequency_rad_s(ends, 5);
    let exact = timoshenko_squared(1.0, inertia, shear, 5.0 * std::f64::consts::PI).sqrt();
    assert!((0.6..0.8).contains(&(exact / euler)), "{}", exact / euler);
    // A slender beam has no shear to speak of: (h/L)² of a thousandth.
    let exact = timoshenko_squared(1.0, 1e-6 / 12.0, shear, std::f64::consts::PI).sqrt();
    let slender = UniformBeam { inertia: 1e-6 / 12.0, ..UNIT }.natural_frequency_rad_s(ends, 1);
    assert!((exact / slender - 1.0).abs() < 1e-5);
}

#[test]
fn with_shear_a_tip_bends_and_slides() {
    // F L³/3EI + F L/κGA on one element.
    let (inertia, shear) = (0.02, 0.3);
    let ends = [Support::Clamped, Support::Free];
    let beam = Beam { length: 2.0, inertia, ends, shear: Some(shear), ..Beam::default() };
    let k = &beam.assemble().unwrap().stiffness[0];
    let (w, ry) = (8.0 / (3.0 * inertia) + 2.0 / shear, -4.0 / (2.0 * inertia));
    let force = |row| k.get(row, 0).re * w + k.get(row, 1).re * ry;
    // Roundoff of terms some hundred times the force.
    assert!((force(0) - 1.0).abs() < 1e-12 && force(1).abs() < 1e-12);
}

proptest! {
    #[test]
    fn mass_and_rigid_motion(
        length in 1e-2..1e2_f64, area in 1e-8..1e2_f64, inertia in 1e-12..1e2_f64, elements in 1_usize..50,
        mass in prop::sample::select(vec![Mass::Consistent, Mass::Lumped, Mass::Mean]),
        shear in prop::sample::select(vec![None, Some(0.33)]),
    ) {
        let assembled = Beam { length, area, inertia, elements, mass, shear, ..Beam::default() }.assemble().unwrap();
        let moved = translation(&assembled, Direction::Z);
        let turned = field(&assembled, |[x, ..], direction| if direction == Direction::Z { -x } else { 1.0 });
        // Sums of at most 200 numbers of both signs.
        let total = form(&moved, &assembled.mass[0], &moved);
        prop_assert!((total - length * area).abs() < 1e-12 * length * area);
        prop_assert!(relative_product(&assembled.stiffness[0], &moved) < 1e-13);
        prop_assert!(relative_product(&assembled.stiffness[0], &turned) < 1e-13);
        // Moment of inertia about x = 0, ρA L³/3, and that of the cross-sections, exact for the consistent mass.
        if mass == Mass::Consistent {
            let rotary = if shear.is_some() { inertia * length } else { 0.0 };
            let about_zero = area * length.powi(3) / 3.0 + rotary;
            prop_assert!((form(&turned, &assembled.mass[0], &turned) - about_zero).abs() < 1e-12 * about_zero);
        }
    }
}

#[test]
fn refusals() {
    let found = |beam: Beam| beam.assemble().unwrap_err();
    let name = |error| if let Error::OutOfRange { name, .. } = error { name } else { "" };
    assert_eq!(name(found(Beam { length: -1.0, ..Beam::default() })), "length");
    assert_eq!(name(found(Beam { inertia: 0.0, ..Beam::default() })), "second moment of area");
    assert_eq!(found(Beam { ends: [Support::Clamped; 2], ..Beam::default() }), Error::NothingMoves);
}
