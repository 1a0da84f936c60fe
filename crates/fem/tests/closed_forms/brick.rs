//! Boxes of bricks against bars and beams, and their layers.

use super::modes::lowest;
use super::support::{field, form, product, rate, relative_product, translation};
use frfit_fem::brick::{Face, Formulation, Layer};
use frfit_fem::exact::beam::UniformBeam;
use frfit_fem::exact::rod::Rod;
use frfit_fem::{Bar, Brick, Direction, Error, Mass, Support};
use frfit_linalg::{c64, solve::Analysis};
use proptest::prelude::*;

fn one_layer(thickness: f64, elements: usize, poisson: f64) -> Vec<Layer> {
    vec![Layer { thickness, elements, poisson, material: 0 }]
}

/// With ν = 0 and uniform cross-sections, bricks along x are the elements of a bar: same forces, same inertia.
#[test]
fn without_poissons_ratio_a_row_of_bricks_is_a_bar() {
    for formulation in [Formulation::Incompatible, Formulation::Standard] {
        let brick = Brick {
            length: 0.3,
            width: 0.02,
            elements: [7, 2],
            layers: one_layer(0.01, 2, 0.0),
            formulation,
            ..Brick::default()
        };
        let bar = Bar { length: 0.3, area: 0.02 * 0.01, elements: 7, ..Bar::default() }.assemble().unwrap();
        let box_of_bricks = brick.assemble().unwrap();
        let shape = |x: f64| (9.0 * x).cos() + x * x;
        let uniform = |x: f64| {
            move |at: [f64; 3], along| {
                if along == Direction::X && (at[0] - x).abs() < 1e-9 { 1.0 } else { 0.0 }
            }
        };
        let along_box =
            field(&box_of_bricks, |[x, ..], along| if along == Direction::X { shape(x) } else { 0.0 });
        let along_bar = field(&bar, |[x, ..], _| shape(x));
        for (of_box, of_bar) in
            [(&box_of_bricks.stiffness[0], &bar.stiffness[0]), (&box_of_bricks.mass[0], &bar.mass[0])]
        {
            let (forces, expected) = (product(of_box, &along_box), product(of_bar, &along_bar));
            for ([x, ..], expected) in bar.nodes.iter().zip(&expected) {
                let section = field(&box_of_bricks, uniform(*x));
                let found: f64 = section.iter().zip(&forces).map(|(one, force)| one * force).sum();
                // Differences of forces of the size of an entry.
                assert!((found - expected).abs() < 1e-12 * of_bar.get(1, 1).re, "{found} {expected}");
            }
        }
    }
}

/// The first longitudinal frequency of a slender bar with ν = 0.3 is the rod's; the inertia of its contraction
/// lowers it by (νkr)²/2 with k = π/2L and r² = (b² + h²)/12 (Rayleigh), 5e-5 here, below the tolerance.
#[test]
fn slender_bar() {
    let (length, side) = (1.0, 0.05);
    let exact = Rod { modulus: c64::new(1.0, 0.0), density: 1.0, area: 1.0, length }
        .natural_frequency_rad_s([Support::Clamped, Support::Free], 1);
    // Displacement of the free end under equal forces on its nodes.
    let receptance = |elements: usize, omega: f64| {
        let brick = Brick {
            length,
            width: side,
            elements: [elements, 1],
            layers: one_layer(side, 1, 0.3),
            clamped: vec![Face::XMin],
            ..Brick::default()
        };
        let assembled = brick.assemble().unwrap();
        let (k, m) = (&assembled.stiffness[0], &assembled.mass[0]);
        let values: Vec<f64> = k
            .real_values()
            .unwrap()
            .iter()
            .zip(m.real_values().unwrap())
            .map(|(k, m)| k - omega.powi(2) * m)
            .collect();
        let load = field(&assembled, |[x, ..], along| f64::from(along == Direction::X && x > 0.999 * length));
        let mut u = load.clone();
        Analysis::new(k.pattern()).factor(&values).unwrap().solve(&mut u).unwrap();
        load.iter().zip(&u).map(|(load, u)| load * u).sum::<f64>()
    };
    // The receptance changes its sign at the resonance. The clamped end holds the contraction: it stiffens by
    // some ν² of one width, (side/length) · 0.1 = 0.5 %.
    assert!(receptance(40, 0.997 * exact) > 0.0 && receptance(40, 1.008 * exact) < 0.0);
}

fn cantilever(length_elements: usize, formulation: Formulation) -> Brick {
    Brick {
        length: 1.0,
        width: 0.04,
        elements: [length_elements, 1],
        layers: one_layer(0.02, 1, 0.3),
        clamped: vec![Face::XMin],
        formulation,
        ..Brick::default()
    }
}

/// One element through the thickness, aspect ratio 2.5: bends like a beam, of which trilinear bricks are far.
#[test]
fn cantilever_bends_like_a_beam() {
    let beam = UniformBeam {
        modulus: 1.0,
        density: 1.0,
        area: 8e-4,
        inertia: 0.04 * 0.02_f64.powi(3) / 12.0,
        length: 1.0,
    };
    let exact = beam.natural_frequency_rad_s([Support::Clamped, Support::Free], 1);
    let frequency = |formulation| {
        let assembled = cantilever(20, formulation).assemble().unwrap();
        lowest(&assembled.stiffness[0], &assembled.mass[0], 1, 0.0)[0].sqrt() / exact
    };
    // Held contraction at the clamped end stiffens by less than ν² of one width, 0.4 %; shear softens by 1e-4.
    let found = frequency(Formulation::Incompatible);
    assert!((found - 1.0).abs() < 0.005, "{found}");
    assert!(frequency(Formulation::Standard) > 1.3);
}

/// Richardson's rate of the first bending frequency under refinement along the length, ν = 0 so that the
/// clamped end has no singular corner.
#[test]
fn cantilever_converges_like_h2() {
    let frequency = |elements| {
        let brick = Brick {
            length: 0.2,
            layers: one_layer(0.02, 1, 0.0),
            ..cantilever(elements, Formulation::Incompatible)
        };
        let assembled = brick.assemble().unwrap();
        lowest(&assembled.stiffness[0], &assembled.mass[0], 1, 0.0)[0].sqrt()
    };
    let [coarse, middle, fine] = [8, 16, 32].map(frequency);
    let found = rate(coarse - middle, middle - fine);
    assert!((found - 2.0).abs() < 0.1, "{found}");
}

fn sandwich(materials: [usize; 3], mass: Mass) -> Brick {
    let layer = |thickness, elements, material| Layer { thickness, elements, poisson: 0.3, material };
    let [bottom, core, top] = materials;
    Brick {
        length: 0.2,
        width: 0.05,
        elements: [4, 2],
        layers: vec![layer(0.01, 1, bottom), layer(0.02, 2, core), layer(0.01, 1, top)],
        clamped: vec![Face::XMin, Face::ZMin],
        mass,
        ..Brick::default()
    }
}

#[test]
fn layers_of_two_materials_add_up_to_one() {
    for mass in [Mass::Consistent, Mass::Lumped] {
        let (two, one) =
            (sandwich([0, 1, 0], mass).assemble().unwrap(), sandwich([0; 3], mass).assemble().unwrap());
        assert_eq!((two.stiffness.len(), two.mass.len(), one.stiffness.len()), (2, 2, 1));
        assert_eq!(two.dofs, one.dofs);
        for (parts, whole) in [(&two.stiffness, &one.stiffness[0]), (&two.mass, &one.mass[0])] {
            let mut sum = vec![c64::default(); whole.pattern().stored()];
            for part in parts {
                part.on_pattern(whole.pattern()).accumulate_into(c64::new(1.0, 0.0), &mut sum);
            }
            for (sum, whole) in sum.iter().zip(whole.real_values().unwrap()) {
                // The same elements in another order of addition.
                assert!((sum.re - whole).abs() <= 1e-15 * whole.abs().max(1e-3));
            }
        }
    }
}

#[test]
fn only_held_faces_are_held() {
    let assembled = sandwich([0; 3], Mass::Lumped).assemble().unwrap();
    assert_eq!(assembled.nodes.len(), 5 * 3 * 5);
    assert_eq!(assembled.dofs.len(), 3 * 4 * 3 * 4);
    let moving = |node: usize| assembled.row(node, Direction::Y).is_some();
    for (label, [x, _, z]) in (1..).zip(&assembled.nodes) {
        assert_eq!(moving(label), *x > 0.0 && *z > 0.0);
    }
    for face in [Face::XMin, Face::XMax, Face::YMin, Face::YMax, Face::ZMin, Face::ZMax] {
        let cube = Brick { clamped: vec![face], ..Brick::default() }.assemble().unwrap();
        assert_eq!(cube.dofs.len(), 12);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]
    #[test]
    fn mass_and_rigid_motion(
        size in prop::array::uniform3(0.1..10.0_f64), share in 0.1..0.9_f64, poisson in -0.5..0.49_f64,
        elements in prop::array::uniform3(1_usize..4),
        mass in prop::sample::select(vec![Mass::Consistent, Mass::Lumped, Mass::Mean]),
    ) {
        let [length, width, height] = size;
        let [nx, ny, nz] = elements;
        let layer = |share: f64, material| Layer { thickness: share * height, elements: nz, poisson, material };
        let layers = vec![layer(share, 0), layer(1.0 - share, 1)];
        let assembled = Brick { length, width, elements: [nx, ny], layers, mass, ..Brick::default() }.assemble().unwrap();
        let shares = [share, 1.0 - share];
        for (material, share) in shares.into_iter().enumerate() {
            for along in [Direction::X, Direction::Y, Direction::Z] {
                let moved = translation(&assembled, along);
                let total = form(&moved, &assembled.mass[material], &moved);
                let exact = share * length * width * height;
                prop_assert!((total - exact).abs() < 1e-12 * exact);
                // Aspect ratios up to 100 leave the entries of one row 1e4 apart.
                prop_assert!(relative_product(&assembled.stiffness[material], &moved) < 1e-12);
            }
            let about_y = field(&assembled, |[x, _, z], along| match along {
                Direction::X => z,
                Direction::Z => -x,
                _ => 0.0,
            });
            prop_assert!(relative_product(&assembled.stiffness[material], &about_y) < 1e-12);
        }
    }
}

#[test]
fn refusals() {
    let name = |brick: Brick| match brick.assemble() {
        Err(Error::OutOfRange { name, .. }) => name,
        _ => "",
    };
    let layer = |layer| Brick { layers: vec![layer], ..Brick::default() };
    assert_eq!(name(Brick { width: -1.0, ..Brick::default() }), "width");
    assert_eq!(name(Brick { layers: Vec::new(), ..Brick::default() }), "number of elements");
    assert_eq!(name(layer(Layer { thickness: 0.0, ..Layer::default() })), "thickness");
    assert_eq!(name(layer(Layer { poisson: 0.5, ..Layer::default() })), "Poisson's ratio");
    assert_eq!(name(layer(Layer { material: 1, ..Layer::default() })), "material");
    let empty = Layer { elements: 0, ..Layer::default() };
    assert_eq!(
        name(Brick { layers: vec![Layer::default(), empty], ..Brick::default() }),
        "number of elements"
    );
    let found = |brick: Brick| brick.assemble().unwrap_err();
    assert_eq!(found(layer(Layer { elements: usize::MAX, ..Layer::default() })), Error::TooManyNodes);
    assert_eq!(
        found(Brick { clamped: vec![Face::XMin, Face::XMax], ..Brick::default() }),
        Error::NothingMoves
    );
}
