//! The bar against the rod in closed form.

use super::modes::lowest;
use super::support::{form, rate, relative_product, translation};
use frfit_fem::exact::rod::Rod;
use frfit_fem::{Bar, Direction, Error, Mass, Support};
use frfit_linalg::{c64, solve::Analysis};
use proptest::prelude::*;

const RUBBER: Rod = Rod { modulus: c64::new(1.0e6, 3.0e5), density: 950.0, area: 5.067e-4, length: 0.3048 };
const OMEGA: f64 = 700.0;

/// Displacements under nodal forces.
fn response(bar: &Bar, force: impl Fn(usize) -> f64) -> Vec<c64> {
    let assembled = bar.assemble().unwrap();
    let (k, m) = (&assembled.stiffness[0], &assembled.mass[0].on_pattern(assembled.stiffness[0].pattern()));
    let mut values = vec![c64::default(); k.pattern().stored()];
    k.accumulate_into(RUBBER.modulus, &mut values);
    m.accumulate_into(c64::new(-OMEGA.powi(2) * RUBBER.density, 0.0), &mut values);
    let mut x: Vec<c64> = (0..k.dim()).map(|row| c64::new(force(assembled.dofs[row].node), 0.0)).collect();
    Analysis::new(k.pattern()).factor(&values).unwrap().solve(&mut x).unwrap();
    x
}

fn bar(elements: usize, ends: [Support; 2], mass: Mass) -> Bar {
    Bar { length: RUBBER.length, area: RUBBER.area, elements, ends, mass }
}

/// The relative error falls like h² from 64 to 128 elements: kh is 0.1 there, so that the next order changes
/// the rate by less than 0.01.
fn check_second_order(error: impl Fn(usize) -> f64) {
    let (coarse, fine) = (error(64), error(128));
    assert!((rate(coarse, fine) - 2.0).abs() < 0.02, "{coarse} {fine}");
}

#[test]
fn transfer_receptance_of_a_free_hysteretic_rod() {
    for mass in [Mass::Consistent, Mass::Lumped, Mass::Mean] {
        check_second_order(|elements| {
            let x =
                response(&bar(elements, [Support::Free; 2], mass), |node| f64::from(node == elements + 1));
            let exact = RUBBER.free_free_end_force(OMEGA, 1.0, 0.0);
            (x[0] - exact).norm() / exact.norm()
        });
    }
}

#[test]
fn driving_point_of_a_clamped_hysteretic_rod() {
    check_second_order(|elements| {
        let ends = [Support::Clamped, Support::Free];
        let x = response(&bar(elements, ends, Mass::Consistent), |node| f64::from(node == elements + 1));
        let exact = RUBBER.clamped_free_end_force(OMEGA, 1.0, RUBBER.length);
        (x[elements - 1] - exact).norm() / exact.norm()
    });
}

#[test]
fn clamped_rod_under_a_uniform_force() {
    check_second_order(|elements| {
        let step = RUBBER.length / elements as f64;
        let ends = [Support::Clamped, Support::Free];
        let load = |node| if node == elements + 1 { step / 2.0 } else { step };
        let x = response(&bar(elements, ends, Mass::Consistent), load);
        let exact = RUBBER.clamped_free_uniform_force(OMEGA, 1.0, RUBBER.length);
        (x[elements - 1] - exact).norm() / exact.norm()
    });
}

/// The work-equivalent load of a uniform force moves the free rod without straining it, on any mesh.
#[test]
fn free_rod_under_a_uniform_force_is_rigid() {
    let step = RUBBER.length / 10.0;
    let load = |node| if node == 1 || node == 11 { step / 2.0 } else { step };
    let exact = RUBBER.free_free_uniform_force(OMEGA, 1.0);
    for x in response(&bar(10, [Support::Free; 2], Mass::Consistent), load) {
        // Roundoff of a solve of condition 1e3.
        assert!((x - exact).norm() < 1e-12 * exact.abs());
    }
}

#[test]
fn free_rod_under_equal_forces_at_all_nodes() {
    check_second_order(|elements| {
        let x = response(&bar(elements, [Support::Free; 2], Mass::Consistent), |_| 1.0);
        let exact = RUBBER.free_free_equal_forces(OMEGA, 1.0, elements, 0.0);
        let strained = exact - RUBBER.free_free_uniform_force(OMEGA, elements as f64 / RUBBER.length);
        (x[0] - exact).norm() / strained.norm()
    });
}

/// Consistent from above, lumped from below, their mean of order h⁴.
#[test]
fn natural_frequencies() {
    use Support::{Clamped, Free};
    for ends in [[Free, Free], [Clamped, Free], [Free, Clamped], [Clamped, Clamped]] {
        for (mass, order, sign) in
            [(Mass::Consistent, 2.0, 1.0), (Mass::Lumped, 2.0, -1.0), (Mass::Mean, 4.0, 1.0)]
        {
            let undamped = Rod { modulus: c64::new(1.0, 0.0), density: 1.0, ..RUBBER };
            let exact = undamped.natural_frequency_rad_s(ends, 2);
            let rigid = usize::from(ends == [Free, Free]);
            let error = |elements| {
                let assembled = bar(elements, ends, mass).assemble().unwrap();
                let (k, m) = (&assembled.stiffness[0], &assembled.mass[0]);
                lowest(k, m, 2 + rigid, exact.powi(2))[1 + rigid].sqrt() / exact - 1.0
            };
            let (coarse, fine) = (error(16), error(32));
            // kh = 0.2 at 32 elements: the next order is (kh)² of the first.
            assert!((rate(coarse, fine) - order).abs() < 0.05, "{ends:?} {mass:?} {coarse} {fine}");
            assert!(mass == Mass::Mean || fine * sign > 0.0);
        }
    }
}

proptest! {
    #[test]
    fn mass_and_rigid_motion(
        length in 1e-3..1e3_f64, area in 1e-8..1e2_f64, elements in 1_usize..50,
        mass in prop::sample::select(vec![Mass::Consistent, Mass::Lumped, Mass::Mean]),
    ) {
        let assembled = Bar { length, area, elements, mass, ..Bar::default() }.assemble().unwrap();
        let moved = translation(&assembled, Direction::X);
        // Sums of at most 100 numbers.
        let total = form(&moved, &assembled.mass[0], &moved);
        prop_assert!((total - length * area).abs() < 1e-13 * length * area);
        prop_assert!(relative_product(&assembled.stiffness[0], &moved) < 1e-15);
    }
}

#[test]
fn rows_nodes_and_dofs() {
    let assembled = bar(4, [Support::Clamped, Support::Free], Mass::Consistent).assemble().unwrap();
    assert_eq!(assembled.row(1, Direction::X), None);
    assert_eq!(assembled.row(5, Direction::X), Some(3));
    assert_eq!(assembled.row(5, Direction::Y), None);
    assert_eq!(assembled.nearest([0.0; 3]), Some(2), "node 1 is held");
    assert_eq!(assembled.nodes.len(), 5);
    assert_eq!(assembled.rows(Direction::X).collect::<Vec<_>>(), [0, 1, 2, 3]);
}

#[test]
fn refusals() {
    let found = |bar: Bar| bar.assemble().unwrap_err();
    assert!(matches!(found(Bar { length: 0.0, ..Bar::default() }), Error::OutOfRange { name: "length", .. }));
    assert!(matches!(
        found(Bar { area: f64::NAN, ..Bar::default() }),
        Error::OutOfRange { name: "area", .. }
    ));
    assert!(matches!(found(Bar { elements: 0, ..Bar::default() }), Error::OutOfRange { .. }));
    assert_eq!(found(Bar { elements: usize::MAX, ..Bar::default() }), Error::TooManyNodes);
    assert_eq!(found(Bar { ends: [Support::Clamped; 2], ..Bar::default() }), Error::NothingMoves);
    assert_eq!(found(Bar { length: 1e-200, area: 1e200, ..Bar::default() }), Error::NotFinite);
}
