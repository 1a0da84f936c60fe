//! The subspace of a band against direct solves of the full model.

use crate::common;

use common::{Case, bar, beam, c, chain, plate, sandwich, term, thickness, tip_load};
use frfit::c64;
use frfit::for_each::sequential;
use frfit::material::Law;
use frfit::model::{DynamicStiffness, Experiment, Parameter, Role, Sensor, Term};
use frfit::rational::RationalResponse;
use frfit::response::{FullModel, Response};
use frfit::series::{NeumannSeries, convergence_radius};
use frfit::subspace::{Point, Subspace, TrainOptions};
use frfit_fem::Mass;
use frfit_linalg::sparse::{SymmetricMatrix, Triplets, Values};
use proptest::prelude::*;

fn springs(n: usize, loss_factor: f64, rows: &[usize]) -> Case {
    let model = chain(n, c(1e4, 1e4 * loss_factor), 1.0);
    let experiment = tip_load(&model, rows);
    let parameter = Parameter::factor_of(&model, &["springs"]).unwrap();
    Case { name: "chain", model, experiment, parameter, band_hz: [0.5, 12.0], box_ratio: [0.5, 2.0] }
}

/// The chain with dashpots between the masses of its outer half and one to the ground.
fn dashpots(factor: f64) -> Case {
    let n = 60;
    let mut dampers = Triplets::new(n);
    dampers.add(n / 3, n / 3, 5.0);
    for i in n / 2..n - 1 {
        dampers.add_element(&[Some(i), Some(i + 1)], &[1.0, -1.0, -1.0, 1.0]);
    }
    let undamped = springs(n, 0.0, &[n - 1, 10]);
    let mut terms: Vec<Term> = undamped.model.terms().to_vec();
    terms.push(term("dashpots", Role::Viscous, dampers.assemble(), c(factor, 0.0)));
    let model = DynamicStiffness::new(terms).unwrap();
    Case { name: "dashpots", model, ..undamped }
}

fn renamed(name: &'static str, case: Case) -> Case {
    Case { name, ..case }
}

/// The plate's stiffness as one complex matrix, hysteresis included.
fn complex_plate() -> Case {
    let case = plate(8, 0.32, 0.0);
    let mut terms: Vec<Term> = case.model.terms().to_vec();
    let pattern = terms[0].matrix.pattern().clone();
    let lossy = |(k, v): (usize, &f64)| c64::new(*v, *v * 0.01 * (1.0 + (k % 7) as f64));
    let values = terms[0].matrix.real_values().unwrap().iter().enumerate().map(lossy).collect();
    terms[0].matrix = SymmetricMatrix::new(pattern, Values::Complex(values));
    Case { name: "complex plate", model: DynamicStiffness::new(terms).unwrap(), ..case }
}

fn density() -> Case {
    let case = plate(8, 0.32, 1e-3);
    let parameter = Parameter::factor_of(&case.model, &["mass"]).unwrap();
    Case { name: "density", parameter, ..case }
}

fn dashpot_factor() -> Case {
    let case = dashpots(3.0);
    let parameter = Parameter::factor_of(&case.model, &["dashpots"]).unwrap();
    Case { name: "dashpot factor", parameter, box_ratio: [0.1, 10.0], ..case }
}

/// Two forces of different phase.
fn complex_load() -> Case {
    let mut case = springs(60, 1e-2, &[0, 59]);
    case.experiment.load[20] = c(0.3, -2.0);
    case.experiment.sensors[1].sign = -1.0;
    Case { name: "complex load", ..case }
}

fn cases() -> Vec<Case> {
    vec![
        springs(60, 1e-3, &[59, 10]),
        dashpots(3.0),
        complex_load(),
        dashpot_factor(),
        bar(120),
        beam(40, 1e-3, Mass::Consistent),
        renamed("lumped beam", beam(40, 1e-3, Mass::Lumped)),
        renamed("square plate", plate(12, 0.32, 1e-3)),
        renamed("almost undamped plate", plate(12, 0.4, 1e-5)),
        complex_plate(),
        thickness(),
        density(),
        sandwich(12, 1),
    ]
}

/// What the estimate may fall short of the error: γ is the gain of the shifted stiffness, and the modes above the band, which the basis
/// has not met, answer more strongly at its upper end, by 1/(1 − ω²/ω_next²).
const SHORT: f64 = 5.0;

/// (estimate, true error) at every sensor, at points anywhere in the box.
fn estimates(case: &Case, subspace: &Subspace<'_>, count: usize) -> Vec<(f64, f64)> {
    let mut pairs = Vec::new();
    for (frequency_hz, ratio) in case.scattered(count) {
        let correction = case.correction(frequency_hz, ratio);
        let exact = case.direct(frequency_hz, correction).unwrap();
        let assessed = subspace.projection().assess(&case.at(frequency_hz), correction).unwrap();
        for (m, exact) in exact.iter().enumerate() {
            pairs.push((assessed.error(m), (assessed.response[m] - exact).norm()));
        }
    }
    pairs
}

#[test]
fn the_estimate_is_no_less_than_the_error_and_not_much_more() {
    for case in cases() {
        let (subspace, trained) = case.trained(1e-6);
        assert!(trained.converged, "{}: {trained:?}", case.name);
        let pairs = estimates(&case, &subspace, 60);
        for &(estimate, error) in &pairs {
            assert!(error <= SHORT * estimate, "{}: error {error:e}, estimate {estimate:e}", case.name);
        }
        // By Cauchy and Schwarz a scalar product of two residuals with 64 sums each is less than the product of their norms, seldom by more
        // than some orders of magnitude.
        let mut over: Vec<f64> = pairs.iter().map(|(estimate, error)| estimate / error).collect();
        over.sort_by(f64::total_cmp);
        let quantile = |q: f64| over[(q * (over.len() - 1) as f64) as usize];
        let [median, most] = [quantile(0.5), quantile(0.9)];
        assert!(median < 300.0 && most < 2000.0, "{}: {median:e} {most:e}", case.name);
    }
}

#[test]
fn the_slope_is_that_of_direct_solves() {
    for case in cases() {
        let (subspace, _) = case.trained(1e-9);
        for (frequency_hz, ratio) in case.scattered(3) {
            let correction = case.correction(frequency_hz, ratio);
            let assessed = subspace.projection().assess(&case.at(frequency_hz), correction).unwrap();
            // The sandwich's direct solves are worth 1e-8: over a step of 1e-5 too little.
            let relative = if case.name == "sandwich" { 1e-4 } else { 1e-5 };
            let step = case.parameter.nominal.at(frequency_hz).unwrap() * relative;
            let [after, before] =
                [correction + step, correction - step].map(|c| case.direct(frequency_hz, c).unwrap());
            for m in 0..after.len() {
                let slope = (after[m] - before[m]) / (2.0 * step);
                // Central differences: h² of the third derivative, which near a resonance is (1/η)² times more, and roundoff over h.
                let scale = slope.norm().max((assessed.response[m] / step).norm() * relative);
                let off = (assessed.slope[m] - slope).norm() / scale;
                assert!(off < 1e-3, "{} at {frequency_hz} Hz: {off:e}", case.name);
            }
        }
    }
}

/// A random structure on a ring with chords: two materials, masses of which some are zero, dashpots; each of them may be the unknown.
#[derive(Debug, Clone)]
struct Random {
    n: usize,
    seed: u64,
    loss_factor: f64,
    grounded: bool,
    massless: bool,
    complex: bool,
    unknown: usize,
}

fn random() -> impl Strategy<Value = Random> {
    let kinds = (any::<bool>(), any::<bool>(), any::<bool>(), 0usize..4);
    (20usize..60, any::<u64>(), 1e-3f64..0.1, kinds).prop_map(
        |(n, seed, loss_factor, (grounded, massless, complex, unknown))| Random {
            n,
            seed,
            loss_factor,
            grounded,
            massless,
            complex,
            unknown,
        },
    )
}

impl Random {
    fn case(&self) -> Case {
        let n = self.n;
        let mut state = self.seed;
        let mut uniform = || {
            // An LCG (Knuth); its upper bits are good enough for a test.
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1u64 << 53) as f64
        };
        let mut link = |t: &mut Triplets, i: usize, j: usize, scale: f64| {
            let k = scale * 10f64.powf(2.0 * uniform() - 1.0);
            t.add_element(&[Some(i), Some(j)], &[k, -k, -k, k]);
        };
        let [mut steel, mut rubber, mut dampers] = [0; 3].map(|_| Triplets::new(n));
        let mut mass = Triplets::new(n);
        for i in 0..n {
            let material = if i % 3 == 0 { &mut rubber } else { &mut steel };
            link(material, i, (i + 1) % n, 1.0);
            if i % 4 == 1 {
                link(&mut rubber, i, (i * 7 + 3) % n, 0.3);
            }
            if i % 5 == 2 {
                link(&mut dampers, i, (i * 11 + 5) % n, 0.05);
            }
        }
        if self.grounded {
            steel.add(0, 0, 2.0);
        }
        for i in 0..n {
            let m = 10f64.powf(uniform() - 0.5);
            mass.add(i, i, if self.massless && i % 4 == 2 { 0.0 } else { m });
        }
        let mut load = vec![c64::default(); n];
        load[n / 2] = c(1.0, uniform() - 0.5);
        load[n / 5] = c(uniform(), -uniform());
        let lossy = c(1.0, self.loss_factor);
        let mut terms = vec![
            term("steel", Role::Stiffness, steel.assemble(), lossy),
            term("rubber", Role::Stiffness, rubber.assemble(), 3.0 * lossy),
            term("dashpots", Role::Viscous, dampers.assemble(), c(1.0, 0.0)),
            term("mass", Role::Mass, mass.assemble(), c(1.0, 0.0)),
        ];
        if self.complex {
            let matrix = &terms[0].matrix;
            let values = matrix.real_values().unwrap().iter().map(|&v| c(v, 0.05 * v)).collect();
            terms[0].matrix = SymmetricMatrix::new(matrix.pattern().clone(), Values::Complex(values));
        }
        let name = terms[self.unknown].name.clone();
        let model = DynamicStiffness::new(terms).unwrap();
        let parameter = Parameter::factor_of(&model, &[&name]).unwrap();
        let sensors = vec![
            Sensor { row: n / 2, sign: 1.0 },
            Sensor { row: 1, sign: -1.0 },
            Sensor { row: n - 2, sign: 1.0 },
        ];
        let experiment = Experiment { load, sensors };
        // Modes from the first to about the tenth.
        Case { name: "random", model, experiment, parameter, band_hz: [0.02, 0.3], box_ratio: [0.5, 2.0] }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(32))]

    #[test]
    fn the_estimate_holds_for_any_small_structure(random in random()) {
        let case = random.case();
        let mut subspace = Subspace::new(&case.experiment, &case.at(case.band_hz[1])).unwrap();
        let options = TrainOptions::default().with_tolerance(1e-5);
        let trained = subspace.train(&case.grid(15, 4), &options, &sequential).unwrap();
        prop_assert!(trained.converged || subspace.size() == random.n, "{trained:?}");
        // At a resonance that the basis has not met D⁻¹ amplifies by up to 1/η more than γ says: there the estimate falls short, and what holds is
        // what the training was asked for, with the same slack.
        for (frequency_hz, ratio) in case.scattered(25) {
            let correction = case.correction(frequency_hz, ratio);
            let exact = case.direct(frequency_hz, correction).unwrap();
            let assessed = subspace.projection().assess(&case.at(frequency_hz), correction).unwrap();
            for (m, exact) in exact.iter().enumerate() {
                let error = (assessed.response[m] - exact).norm();
                let asked = options.tolerance * exact.norm().max((assessed.slope[m] * correction).norm());
                let estimate = assessed.error(m);
                prop_assert!(error <= SHORT * estimate.max(asked), "error {error:e}, estimate {estimate:e}, asked {asked:e}");
            }
        }
    }
}

#[test]
fn an_untrained_model_says_how_bad_it_is() {
    // Two or three vectors for a whole band: the error is of the order of the response, and the estimate says so.
    for case in [springs(60, 1e-2, &[59, 10]), plate(8, 0.4, 1e-2), sandwich(12, 1)] {
        let subspace = Subspace::new(&case.experiment, &case.at(case.band_hz[1])).unwrap();
        let pairs = estimates(&case, &subspace, 100);
        let covered = pairs.iter().filter(|(estimate, error)| *error <= SHORT * estimate).count();
        // On the resonances it cannot know the gain yet.
        assert!(covered as f64 > 0.8 * pairs.len() as f64, "{}: {covered} of {}", case.name, pairs.len());
        let case_error = pairs.iter().map(|(_, error)| *error).fold(0.0, f64::max);
        let case_estimate = pairs.iter().map(|(estimate, _)| *estimate).fold(0.0, f64::max);
        assert!(case_estimate > 0.1 * case_error, "{}: {case_estimate:e} {case_error:e}", case.name);
    }
}

#[test]
fn a_model_of_a_neighbourhood_tells_errors_of_the_full_one() {
    let case = sandwich(12, 1);
    let (subspace, _) = case.trained(1e-9);
    let near: Vec<Point<'_>> = case.grid(40, 5).into_iter().skip(100).take(15).collect();
    let local = subspace.projection().localised(&near, 1e-9);
    assert!(local.size() < subspace.size(), "{} of {}", local.size(), subspace.size());
    for point in &near {
        let assessed = local.assess(&point.at, point.correction).unwrap();
        let exact = case.direct(point.at.frequency_hz, point.correction).unwrap();
        for (m, exact) in exact.iter().enumerate() {
            let error = (assessed.response[m] - exact).norm();
            assert!(error <= SHORT * assessed.error(m), "{error:e} {:e}", assessed.error(m));
        }
    }
    // Far away it is bad, and knows it.
    let far = case.at(900.0);
    let assessed = local.assess(&far, c64::default()).unwrap();
    let error = (assessed.response[0] - case.direct(900.0, c64::default()).unwrap()[0]).norm();
    assert!(error > 1e-6 * assessed.response[0].norm() && error <= SHORT * assessed.error(0));
}

/// A search may run off to a stiffness so large that nothing responds. There is no local model about it.
#[test]
fn there_is_no_model_where_nothing_responds() {
    let case = sandwich(12, 1);
    let (subspace, _) = case.trained(1e-9);
    let stiff = Parameter::factor_of(&case.model, &["skins", "core"]).unwrap();
    let about = |size: f64| {
        let stiff = Parameter { nominal: Law::Constant(c64::new(size, size)), ..stiff.clone() };
        let at = case.model.at(100.0, &[stiff]).unwrap();
        subspace.projection().about(&at).map(|model| model.size())
    };
    assert!(about(1e6).is_some_and(|size| size > 0));
    // Vectors whose square is zero.
    assert_eq!(about(1e220), None);
}

#[test]
fn solves_are_answered_as_by_the_full_model() {
    for case in cases() {
        let (subspace, _) = case.trained(1e-9);
        for (frequency_hz, ratio) in case.scattered(3) {
            let at = case.at(frequency_hz);
            let reduced = subspace.projection().at(&at).unwrap();
            let full = FullModel::new(at.clone(), &case.experiment).unwrap();
            assert_eq!(reduced.frequency_hz(), full.frequency_hz());
            assert_eq!((reduced.nominal(0), reduced.degree(0)), (full.nominal(0), full.degree(0)));
            let correction = case.correction(frequency_hz, ratio);
            let pairs = [
                (reduced.respond_nominal().unwrap(), full.respond_nominal().unwrap()),
                (reduced.solve_at(&[correction]).unwrap(), full.solve_at(&[correction]).unwrap()),
            ];
            for (small, large) in pairs {
                for (a, b) in small.iter().zip(&large) {
                    // Trained to 1e-9 at points of a grid; between them, and at antiresonances, a hundred times that; the sandwich's own
                    // direct solves are worth 1e-8.
                    assert!((a - b).norm() < 1e-6 * b.norm(), "{} at {frequency_hz} Hz: {a} {b}", case.name);
                }
            }
        }
    }
}

#[test]
fn series_are_those_of_the_full_model() {
    for case in cases() {
        let (subspace, _) = case.trained(1e-9);
        for (frequency_hz, _) in case.scattered(2) {
            let at = case.at(frequency_hz);
            let reduced = NeumannSeries::new(&subspace.projection().at(&at).unwrap(), 0, 12).unwrap();
            let system = FullModel::new(at.clone(), &case.experiment).unwrap();
            let full = NeumannSeries::new(&system, 0, 12).unwrap();
            // Coefficients are integrals of the response over a circle: on one inside the box and the circle of convergence both agree as
            // the responses do.
            let radius = convergence_radius(&system, 0).unwrap();
            let r = 0.4f64.min(0.5 / (radius.per_unit * full.scale()));
            assert_eq!(reduced.scale(), full.scale());
            for m in 0..full.sensors() {
                let size = full.coefficients(m)[0].norm();
                for (k, (a, b)) in reduced.coefficients(m).iter().zip(full.coefficients(m)).enumerate() {
                    let off = (a - b).norm() * r.powi(k as i32) / size;
                    assert!(off < 1e-5, "{} at {frequency_hz} Hz, order {k}: {off:e}", case.name);
                }
            }
        }
    }
}

#[test]
fn spectral_radii_are_those_of_the_full_model_where_the_nearest_pole_is_in_the_box() {
    let mut compared = 0;
    // Structures of which the load excites every mode.
    for case in
        [springs(60, 1e-3, &[59, 10]), bar(120), beam(40, 1e-3, Mass::Consistent), plate(12, 0.4, 1e-3)]
    {
        let (subspace, _) = case.trained(1e-9);
        for (frequency_hz, _) in case.scattered(12) {
            let at = case.at(frequency_hz);
            let system = FullModel::new(at.clone(), &case.experiment).unwrap();
            let full = convergence_radius(&system, 0).unwrap();
            if full.per_unit * system.nominal(0).norm() < 2.5 {
                continue; // its distance is more than 0.4 of the nominal: near the edge of the box, or outside
            }
            let reduced = convergence_radius(&subspace.projection().at(&at).unwrap(), 0).unwrap();
            let rational = RationalResponse::new(&system, 0, 40).unwrap();
            let poles = rational.poles().unwrap().unwrap();
            for (by, other) in [("subspace", reduced.per_unit), ("poles", poles.radius_per_unit())] {
                let off = (other / full.per_unit - 1.0).abs();
                // The full one's eigenpair has a residual of up to 1e-4.
                assert!(off < 1e-3, "{} at {frequency_hz} Hz by {by}: {off:e}", case.name);
            }
            compared += 1;
        }
    }
    assert!(compared >= 12, "{compared}");
}

#[test]
fn rational_roots_in_the_box_are_those_of_the_full_model() {
    let mut compared = 0;
    for case in cases() {
        let (subspace, _) = case.trained(1e-9);
        for (frequency_hz, ratio) in case.scattered(2) {
            let at = case.at(frequency_hz);
            let system = FullModel::new(at.clone(), &case.experiment).unwrap();
            let small = subspace.projection().at(&at).unwrap();
            let truth = case.correction(frequency_hz, ratio);
            let measured = system.solve_at(&[truth]).unwrap()[0];
            let nominal = system.nominal(0);
            let roots = |rational: RationalResponse| -> Vec<(c64, f64)> {
                let roots = rational.roots(0, measured).unwrap();
                let inside = roots.iter().filter(|root| {
                    let factor = (nominal + root.correction) / nominal;
                    let [low, high] = case.box_ratio;
                    root.residual < 1e-9 && (low..high).contains(&factor.re) && factor.im.abs() < 0.05
                });
                inside.map(|root| (root.correction, root.residual)).collect()
            };
            let of_full = roots(RationalResponse::new(&system, 0, 40).unwrap());
            let of_small = roots(RationalResponse::new(&small, 0, small.dim()).unwrap());
            for (correction, _) in of_full {
                let off = of_small
                    .iter()
                    .map(|(other, _)| (other - correction).norm() / (nominal + correction).norm())
                    .fold(f64::INFINITY, f64::min);
                assert!(off < 1e-5, "{} at {frequency_hz} Hz: {correction} {off:e}", case.name);
                compared += 1;
            }
        }
    }
    assert!(compared >= 20, "{compared}");
}

/// Modes of a chain of n unit masses, held at one end, below a frequency: ω_k = 2√k sin((2k − 1)π/(4n + 2)).
fn modes_of_chain(n: usize, stiffness: f64, below_hz: f64) -> usize {
    let omega = |k: usize| {
        2.0 * stiffness.sqrt() * ((2 * k - 1) as f64 * std::f64::consts::PI / (4 * n + 2) as f64).sin()
    };
    (1..=n).filter(|&k| omega(k) < std::f64::consts::TAU * below_hz).count()
}

/// Modes below the corner of a box are as many as the closed form says; those that the basis has not are brought, and the response at their resonances is then
/// that of the full model.
#[test]
fn modes_that_the_basis_lacks_are_counted_and_brought() {
    let (n, corner_hz) = (200, 4.0);
    let case = springs(n, 1e-4, &[n - 1, 71]);
    let at = case.at(corner_hz);
    let mut subspace = Subspace::new(&case.experiment, &at).unwrap();
    let corner = Point { at: at.clone(), correction: case.correction(corner_hz, 0.7) };
    let box_points = [corner, Point { at, correction: c64::default() }];
    let count = subspace.bring_missing_modes(&box_points).unwrap().unwrap();
    assert_eq!(count.model, modes_of_chain(n, 0.7e4, corner_hz));
    assert!(count.missing > 10 && count.brought == count.missing, "{count:?}");
    let again = subspace.bring_missing_modes(&box_points).unwrap().unwrap();
    assert_eq!((again.model, again.missing), (count.model, 0));
}

/// What neither load nor sensors see is counted, and not brought: the antisymmetric modes of a chain that is driven and measured in its middle.
#[test]
fn modes_that_nothing_sees_are_not_brought() {
    let n = 61;
    let mut case = springs(n, 1e-3, &[n / 2]);
    let mut stiffness = Triplets::new(n);
    for i in 0..n - 1 {
        stiffness.add_element(&[Some(i), Some(i + 1)], &[1.0, -1.0, -1.0, 1.0]);
    }
    [0, n - 1].into_iter().for_each(|end| stiffness.add(end, end, 1.0));
    let mut terms = case.model.terms().to_vec();
    terms[0].matrix = stiffness.assemble();
    case.model = DynamicStiffness::new(terms).unwrap();
    case.parameter = Parameter::factor_of(&case.model, &["springs"]).unwrap();
    case.experiment = Experiment::driven_at(n, Sensor { row: n / 2, sign: 1.0 }, case.experiment.sensors);
    let at = case.at(12.0);
    let mut subspace = Subspace::new(&case.experiment, &at).unwrap();
    let corner = Point { at, correction: c64::default() };
    let count = subspace.bring_missing_modes(&[corner]).unwrap().unwrap();
    // 2·100·sin(kπ/124) < 2π·12: 15 modes, every other one of which has a node in the middle.
    assert_eq!(count.model, 15);
    // Roundoff may have a little of one that no sensor sees.
    assert!((7..=8).contains(&count.brought) && count.missing == 14, "{count:?}");
}

/// A corner whose Re D is singular (a free chain at 0 Hz) is no reason to do without what was trained.
#[test]
fn a_corner_that_breaks_down_spoils_no_training() {
    let n = 60;
    let mut case = springs(n, 1e-3, &[n - 1]);
    let mut stiffness = Triplets::new(n);
    for i in 0..n - 1 {
        stiffness.add_element(&[Some(i), Some(i + 1)], &[1.0, -1.0, -1.0, 1.0]);
    }
    let mut terms = case.model.terms().to_vec();
    terms[0].matrix = stiffness.assemble();
    case.model = DynamicStiffness::new(terms).unwrap();
    let point = |f: f64| Point { at: case.at(f), correction: c64::default() };
    let mut subspace = Subspace::new(&case.experiment, &case.at(8.0)).unwrap();
    let corner = [point(0.0)];
    assert!(subspace.bring_missing_modes(&corner).is_err());
    let points = [point(2.0), point(8.0)];
    subspace.train_box(&points, &corner, &TrainOptions::default(), &sequential).unwrap();
    let exact = case.direct(8.0, c64::default()).unwrap();
    let found = subspace.projection().respond(&case.at(8.0)).unwrap();
    // The tolerance is of p ∂x/∂p where that is larger than x.
    assert!((found[0] - exact[0]).norm() < 1e-6 * exact[0].norm(), "{} {}", found[0], exact[0]);
}
