//! Sensitivities against closed forms, finite differences of direct solves and brute force.

use crate::common;

use common::{Case, bar, c, chain, plate, sandwich, term, tip_load};
use frfit::c64;
use frfit::for_each::sequential;
use frfit::frequency::{linear_hz, omega_rad_s};
use frfit::material::Law;
use frfit::model::{DynamicStiffness, Experiment, Role, Sensor, Term};
use frfit::response::{FullModel, Response};
use frfit::sensitivity::{
    Change, Inseparable, Resolved, SensitivityBand, Variable, change_points, inseparable, next_sensors,
    with_each_added, worst_bar,
};
use frfit::subspace::{ChangeOptions, Subspace};
use frfit_linalg::sparse::Triplets;
use proptest::prelude::*;

fn band<'m>(
    model: &'m DynamicStiffness,
    experiment: &'m Experiment,
    variables: &'m [Variable],
    frequency_hz: &[f64],
    options: ChangeOptions,
) -> SensitivityBand<'m> {
    let points = change_points(model, variables, frequency_hz).unwrap();
    SensitivityBand::new(experiment, variables, &points, &options, &sequential).unwrap()
}

/// x and ∂x/∂ln p at every row, by direct solves.
fn direct(
    model: &DynamicStiffness,
    experiment: &Experiment,
    variables: &[Variable],
    frequency_hz: f64,
) -> Vec<Vec<c64>> {
    let system = FullModel::new(model.at(frequency_hz, &[]).unwrap(), experiment).unwrap();
    let mut x = experiment.load.clone();
    system.solve_nominal(&mut x).unwrap();
    let mut all = vec![x];
    for variable in variables {
        let mut w = vec![c64::default(); model.dim()];
        let change = variable.derivative(model, frequency_hz).unwrap();
        change.multiply_add(model, c(-1.0, 0.0), &all[0], &mut w);
        system.solve_nominal(&mut w).unwrap();
        all.push(w);
    }
    all
}

fn one_by_one(value: f64) -> frfit_linalg::sparse::SymmetricMatrix {
    let mut matrix = Triplets::new(1);
    matrix.add(0, 0, value);
    matrix.assemble()
}

#[test]
fn one_degree_of_freedom_is_the_closed_form() {
    let (k, eta, d, m) = (400.0, 0.05, 0.3, 2.0);
    let model = DynamicStiffness::new(vec![
        term("spring", Role::Stiffness, one_by_one(1.0), c(k, k * eta)),
        term("dashpot", Role::Viscous, one_by_one(3.0), c(d, 0.0)),
        term("mass", Role::Mass, one_by_one(1.0), c(m, 0.0)),
        term("absent", Role::Mass, one_by_one(1.0), c(0.0, 0.0)),
    ])
    .unwrap();
    let experiment = tip_load(&model, &[0]);
    // Below, on and above the resonance at 2.25 Hz.
    let frequency_hz = [0.5, 2.25, 9.0];
    let variables = Variable::of_model(&model, &frequency_hz).unwrap();
    let names: Vec<&str> = variables.iter().map(|v| v.name.as_str()).collect();
    assert_eq!(names, ["spring", "spring loss factor", "dashpot", "mass"]);
    let band = band(&model, &experiment, &variables, &frequency_hz, ChangeOptions::default());
    for (i, &f) in frequency_hz.iter().enumerate() {
        let omega = omega_rad_s(f);
        let dynamic = c(k - omega * omega * m, k * eta + omega * 3.0 * d);
        let exact = [c(k, k * eta), c(0.0, k * eta), c(0.0, omega * 3.0 * d), c(-omega * omega * m, 0.0)]
            .map(|a| -a / dynamic);
        for (p, exact) in exact.into_iter().enumerate() {
            let (found, error) = band.logarithmic(i, p, 0).unwrap();
            // One vector is all there is: roundoff.
            assert!((found - exact).norm() < 1e-13 * exact.norm(), "{f} Hz, {p}: {found} against {exact}");
            assert!(error < 1e-12 * found.norm());
        }
    }
}

/// k ∝ h³ and m ∝ h of one dof: ∂ ln x/∂ ln h = −(3k − ω²m)/(k − ω²m), by closed form; and h stands for itself beside neither k nor m.
#[test]
fn a_dimension_has_the_slope_of_its_powers() {
    let (k, m) = (c(400.0, 20.0), 2.0);
    let model = DynamicStiffness::new(vec![
        term("spring", Role::Stiffness, one_by_one(1.0), k),
        term("mass", Role::Mass, one_by_one(1.0), c(m, 0.0)),
    ])
    .unwrap();
    let experiment = tip_load(&model, &[0]);
    let frequency_hz = [0.5, 2.25, 9.0];
    let change = Change::Powers(vec![(0, 3), (1, 1)]);
    let variables = [Variable { name: "h".into(), change }];
    let band = band(&model, &experiment, &variables, &frequency_hz, ChangeOptions::default());
    for (i, &f) in frequency_hz.iter().enumerate() {
        let inertia = omega_rad_s(f).powi(2) * m;
        let exact = -(3.0 * k - inertia) / (k - inertia);
        let (found, _) = band.logarithmic(i, 0, 0).unwrap();
        // one vector is all there is: roundoff
        assert!((found - exact).norm() < 1e-13 * exact.norm(), "{f} Hz: {found} against {exact}");
    }
}

/// The bar with its law as the factor of its stiffness.
fn rubber_bar() -> Case {
    let mut case = bar(40);
    let mut terms = case.model.terms().to_vec();
    terms[0].factor = case.parameter.nominal.clone();
    case.model = DynamicStiffness::new(terms).unwrap();
    case
}

fn cases() -> Vec<(Case, Vec<f64>)> {
    vec![
        (sandwich(8, 2), linear_hz(20.0, 1000.0, 40)),
        (plate(8, 0.32, 1e-2), linear_hz(100.0, 3000.0, 40)),
        (rubber_bar(), linear_hz(20.0, 2000.0, 40)),
    ]
}

#[test]
fn derivatives_are_those_of_direct_solves_to_the_estimated_error() {
    for (case, frequency_hz) in cases() {
        let variables = Variable::of_model(&case.model, &frequency_hz).unwrap();
        let band = band(&case.model, &case.experiment, &variables, &frequency_hz, ChangeOptions::default());
        assert!(band.trained().converged, "{}: {:?}", case.name, band.trained());
        let mut too_large = Vec::new();
        for (i, &f) in frequency_hz.iter().enumerate() {
            let exact = direct(&case.model, &case.experiment, &variables, f);
            let x = case.experiment.observe(&exact[0]);
            for (p, w) in exact[1..].iter().enumerate() {
                for (m, slope) in case.experiment.observe(w).into_iter().enumerate() {
                    let (found, estimate) = band.logarithmic(i, p, m).unwrap();
                    let off = (found - slope / x[m]).norm();
                    too_large.push(estimate / (off + 1e-15 * found.norm()));
                    // The estimate may fall short at resonances of modes that load and sensors hardly see; on these structures it does not. What a direct
                    // solve leaves of its own, some 1e-9 where metal and rubber meet, is not in it.
                    assert!(
                        off <= estimate + 1e-8 * found.norm(),
                        "{} {f} Hz {p} {m}: {off:e} {estimate:e}",
                        case.name
                    );
                    assert!(estimate < 1e-3 * found.norm().max(1.0), "{} {f} Hz: {estimate:e}", case.name);
                }
            }
        }
        too_large.sort_by(f64::total_cmp);
        let median = too_large[too_large.len() / 2];
        assert!(
            median < 1e3,
            "{}: an estimate that is always far too large is of no use: {median:e}",
            case.name
        );
    }
}

/// The same model with some factors changed.
fn changed(model: &DynamicStiffness, of: impl Fn(usize, c64) -> c64) -> DynamicStiffness {
    let term = |(index, term): (usize, &Term)| {
        let Law::Constant(factor) = term.factor else { panic!("a constant factor") };
        Term { factor: Law::Constant(of(index, factor)), ..term.clone() }
    };
    DynamicStiffness::new(model.terms().iter().enumerate().map(term).collect()).unwrap()
}

#[test]
fn derivatives_are_finite_differences_of_direct_solves() {
    let case = plate(6, 0.32, 2e-2);
    let frequency_hz = [150.0, 700.0, 1900.0];
    let variables = Variable::of_model(&case.model, &frequency_hz).unwrap();
    let band = band(&case.model, &case.experiment, &variables, &frequency_hz, ChangeOptions::default());
    let h: f64 = 1e-3;
    for (p, variable) in variables.iter().enumerate() {
        let respond = |step: f64, f: f64| {
            let of = |index: usize, factor: c64| match &variable.change {
                Change::Factor(terms) if terms[0] == index => factor * step.exp(),
                Change::LossFactor(terms) if terms[0] == index => c(factor.re, factor.im * step.exp()),
                _ => factor,
            };
            let model = changed(&case.model, of);
            let system = FullModel::new(model.at(f, &[]).unwrap(), &case.experiment).unwrap();
            system.respond_nominal().unwrap()
        };
        for (i, &f) in frequency_hz.iter().enumerate() {
            let at = [-2.0, -1.0, 1.0, 2.0].map(|k| respond(k * h, f));
            for m in 0..2 {
                let x = at.each_ref().map(|x| x[m].ln());
                // Fourth order: 1e-12 times the fifth derivative, which is below 1e5 between resonances.
                let difference = (x[0] - 8.0 * x[1] + 8.0 * x[2] - x[3]) / (12.0 * h);
                let (found, _) = band.logarithmic(i, p, m).unwrap();
                let off = (found - difference).norm();
                assert!(
                    off < 1e-6 * found.norm().max(1e-2),
                    "{} {f} Hz: {found} {difference}",
                    variable.name
                );
            }
        }
    }
}

#[test]
fn a_dense_band_is_good_at_every_frequency() {
    // More than are drawn for the training; a loss factor of 1e-3 makes resonances narrower than the distance of those that are.
    let case = plate(6, 0.32, 1e-3);
    let frequency_hz = linear_hz(100.0, 3500.0, 700);
    let variables = Variable::of_model(&case.model, &frequency_hz).unwrap();
    let band = band(&case.model, &case.experiment, &variables, &frequency_hz, ChangeOptions::default());
    assert!(band.trained().converged && band.at().iter().all(Option::is_some), "{:?}", band.trained());
    for i in (0..700).step_by(23) {
        let exact = direct(&case.model, &case.experiment, &variables, frequency_hz[i]);
        let x = case.experiment.observe(&exact[0]);
        for (p, w) in exact[1..].iter().enumerate() {
            let (found, estimate) = band.logarithmic(i, p, 0).unwrap();
            let off = (found - case.experiment.observe(w)[0] / x[0]).norm();
            // What a direct solve leaves of its own at a resonance is not in the estimate.
            assert!(
                off <= estimate + 1e-9 * found.norm(),
                "{} Hz, {p}: {off:e}, {estimate:e}",
                frequency_hz[i]
            );
        }
    }
}

#[test]
fn elsewhere_is_as_good_as_it_says() {
    for (case, frequency_hz) in [cases().remove(0), cases().remove(2)] {
        let variables = Variable::of_model(&case.model, &frequency_hz).unwrap();
        let points = change_points(&case.model, &variables, &frequency_hz).unwrap();
        let trained = |everywhere| {
            let mut subspace = Subspace::new(&case.experiment, &points[points.len() - 1].at).unwrap();
            let options = ChangeOptions::default().with_everywhere(everywhere);
            assert!(subspace.train_changes(&points, &options, &sequential).unwrap().converged);
            subspace
        };
        let (plain, subspace) = (trained(None), trained(Some(1e-6)));
        assert!(subspace.size() > plain.size(), "{}: it had to grow", case.name);
        let rows: Vec<usize> = (0..case.model.dim()).collect();
        let v = subspace.rows(&rows);
        let mut worst = 0.0f64;
        for (point, &f) in points.iter().zip(&frequency_hz) {
            let changed = subspace.projection().changes(point).unwrap();
            let exact = direct(&case.model, &case.experiment, &variables, f);
            for ((y, exact), estimate) in changed.coordinates.iter().zip(&exact).zip(&changed.everywhere) {
                assert!(*estimate <= 1e-6, "{} {f} Hz: {estimate:e}", case.name);
                let found =
                    |i: usize| y.iter().enumerate().map(|(k, y)| y * v[i + k * rows.len()]).sum::<c64>();
                let off = exact.iter().enumerate().map(|(i, x)| (found(i) - x).norm_sqr()).sum::<f64>();
                let off = (off / exact.iter().map(|x| x.norm_sqr()).sum::<f64>()).sqrt();
                worst = worst.max(off);
                // One residual, without what resonances make of it, and in another norm: ten times more on these structures. Roundoff, up to 1.1e-7 where metal and rubber
                // meet, is not in it.
                assert!(off <= 20.0 * estimate + 2e-7, "{} {f} Hz: {off:e}, {estimate:e}", case.name);
            }
        }
        assert!(worst > 3e-7, "{}: the estimate was put to the test, {worst:e}", case.name);
    }
}

fn two_springs() -> DynamicStiffness {
    // A chain whose springs are each two in parallel, of factors 300 and 100, and one more spring at its end.
    let springs = chain(12, c(300.0, 15.0), 1.0).terms().to_vec();
    let mut end = Triplets::new(12);
    end.add(11, 11, 1.0);
    let [first, masses] = springs.as_slice() else { panic!("two terms") };
    DynamicStiffness::new(vec![
        Term { factor: Law::Constant(c(300.0, 0.0)), ..first.clone() },
        Term { name: "beside".into(), factor: Law::Constant(c(100.0, 0.0)), ..first.clone() },
        term("dashpot", Role::Viscous, end.assemble(), c(0.7, 0.0)),
        masses.clone(),
    ])
    .unwrap()
}

#[test]
fn springs_in_parallel_are_inseparable_and_only_their_sum_is_seen() {
    let model = two_springs();
    let experiment = tip_load(&model, &[11, 4]);
    let frequency_hz = linear_hz(0.1, 4.0, 30);
    let variables = Variable::of_model(&model, &frequency_hz).unwrap();
    let band = band(&model, &experiment, &variables, &frequency_hz, ChangeOptions::default());
    let resolved = band.resolved(&band.proportional(0.01), &[0, 1]).unwrap();
    let groups = inseparable(&resolved);
    let [Inseparable { variables, unknown: 1, direction, std: None }] = groups.as_slice() else {
        panic!("{groups:?}")
    };
    assert_eq!(variables, &[0, 1]);
    // 300 δln a + 100 δln b = 0: a third as much of the stronger one.
    assert!((direction[0] / direction[1] + 1.0 / 3.0).abs() < 1e-6, "{direction:?}");
    // Their sum is known: 3/4 ln a + 1/4 ln b. Each alone is not, the others are.
    assert!(resolved.std(&[0.75, 0.25, 0.0, 0.0]).unwrap() < 0.01);
    let bars = resolved.bars();
    assert!(bars[0].is_none() && bars[1].is_none() && bars[2].unwrap() < 0.1 && bars[3].unwrap() < 0.01);
    let worst = worst_bar(&resolved);
    assert_eq!((worst.unseen, worst.worst.unwrap().variable), (2, 2));
}

#[test]
fn modulus_and_density_with_an_unknown_scale_have_only_their_ratio() {
    let mut case = rubber_bar();
    case.experiment.sensors.truncate(1);
    let frequency_hz = linear_hz(50.0, 1500.0, 60);
    let mut variables = Variable::of_model(&case.model, &frequency_hz).unwrap();
    let known = band(&case.model, &case.experiment, &variables, &frequency_hz, ChangeOptions::default());
    let resolved = known.resolved(&known.proportional(0.01), &[0]).unwrap();
    // A known force separates stiffness and mass.
    assert!(inseparable(&resolved).is_empty() && resolved.bars().iter().all(|bar| bar.unwrap() < 0.02));
    variables.push(Variable { name: "scale".into(), change: Change::Scale(0) });
    let band = band(&case.model, &case.experiment, &variables, &frequency_hz, ChangeOptions::default());
    let resolved = band.resolved(&band.proportional(0.01), &[0]).unwrap();
    let groups = inseparable(&resolved);
    let [Inseparable { variables: group, unknown: 1, direction, std: None }] = groups.as_slice() else {
        panic!("{groups:?}")
    };
    // E, ρ and the scale (not the loss factor), all by the same factor.
    assert_eq!(group, &[0, 2, 3]);
    assert!(direction.iter().all(|d| (d - 1.0).abs() < 1e-6), "{direction:?}");
    assert!(resolved.std(&[1.0, 0.0, -1.0, 0.0]).unwrap() < 0.01, "E/ρ is what resonances identify");
    assert!(resolved.bars()[1].unwrap() < 0.05, "and the loss factor");
}

#[test]
fn the_next_sensor_is_the_best_of_all_rows() {
    let case = sandwich(6, 2);
    let frequency_hz = linear_hz(20.0, 1000.0, 40);
    let variables = Variable::of_model(&case.model, &frequency_hz).unwrap();
    let options = ChangeOptions::default().with_everywhere(Some(1e-3));
    let band = band(&case.model, &case.experiment, &variables, &frequency_hz, options);
    let deviations = band.proportional(0.01);
    let rows: Vec<usize> = (0..case.model.dim()).collect();
    let ranked = next_sensors(&band, &deviations, &rows, &sequential);
    assert_eq!(ranked.len(), rows.len());

    // Every row really added, from direct solves of the full model.
    let exact: Vec<Vec<Vec<c64>>> =
        frequency_hz.iter().map(|&f| direct(&case.model, &case.experiment, &variables, f)).collect();
    let with = |extra: Option<usize>| {
        let mut columns = vec![Vec::new(); variables.len()];
        for (i, all) in exact.iter().enumerate() {
            let present = case.experiment.sensors.iter().map(|s| s.row);
            let least = deviations[i].iter().copied().fold(f64::INFINITY, f64::min);
            for (m, row) in present.chain(extra).enumerate() {
                let deviation = deviations[i].get(m).copied().unwrap_or(0.01 * all[0][row].norm()).max(least);
                for (column, w) in columns.iter_mut().zip(&all[1..]) {
                    let slope = w[row] * 2f64.sqrt() / deviation;
                    column.extend([slope.re, slope.im]);
                }
            }
        }
        worst_bar(&Resolved::new(&columns.concat(), variables.len(), 0.0).unwrap())
    };
    let before = with(None);
    let mut brute: Vec<f64> = Vec::new();
    for candidate in &ranked {
        let really = with(Some(candidate.row));
        let (found, exact) = (candidate.after.worst.unwrap().std, really.worst.unwrap().std);
        assert_eq!(candidate.after.unseen, 0);
        // Three digits from a subspace that is good to that everywhere.
        assert!((found / exact - 1.0).abs() < 1e-2, "row {}: {found} against {exact}", candidate.row);
        assert!(exact <= before.worst.unwrap().std * (1.0 + 1e-9), "one more sensor never hurts");
        brute.push(exact);
    }
    let best = brute.iter().copied().fold(f64::INFINITY, f64::min);
    assert!(brute[0] <= best * 1.01, "{} against {best}", brute[0]);
    assert!(best < 0.9 * before.worst.unwrap().std, "a place that helps: {best} from {before:?}");

    // And as a sensor of a subspace of its own.
    let mut experiment = case.experiment.clone();
    experiment.sensors.push(Sensor { row: ranked[0].row, sign: 1.0 });
    let points = change_points(&case.model, &variables, &frequency_hz).unwrap();
    let added =
        SensitivityBand::new(&experiment, &variables, &points, &ChangeOptions::default(), &sequential)
            .unwrap();
    let bar = with_each_added(&added, &deviations, 2).unwrap()[0].worst.unwrap().std;
    assert!((bar / brute[0] - 1.0).abs() < 1e-4, "{bar} against {}", brute[0]);
}

#[test]
fn a_frequency_without_an_answer_has_none() {
    // Undamped, and exactly on the resonance of one mass on one spring.
    let omega = omega_rad_s(1.0);
    let model = DynamicStiffness::new(vec![
        term("spring", Role::Stiffness, one_by_one(1.0), c(omega * omega, 0.0)),
        term("mass", Role::Mass, one_by_one(1.0), c(1.0, 0.0)),
    ])
    .unwrap();
    let experiment = tip_load(&model, &[0]);
    let frequency_hz = [0.5, 1.0, 1.5];
    let variables = Variable::of_model(&model, &frequency_hz).unwrap();
    let band = band(&model, &experiment, &variables, &frequency_hz, ChangeOptions::default());
    assert!(band.logarithmic(0, 0, 0).is_some() && band.logarithmic(1, 0, 0).is_none());
    let resolved = band.resolved(&band.proportional(0.01), &[0]).unwrap();
    assert!(resolved.bars().iter().all(Option::is_some));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(32))]

    /// ln p is dimensionless: bars do not depend on the units of factors, are in proportion to the noise, and never grow by another sensor.
    #[test]
    fn bars_are_relative(
        unit in 1e-6f64..1e6,
        loss in 0.0f64..0.2,
        rows in (0usize..10, 0usize..10),
    ) {
        let frequency_hz = linear_hz(0.2, 3.0, 25);
        let resolved = |unit: f64, noise: f64, sensors: &[usize]| {
            let mut terms = chain(10, c(100.0, 100.0 * loss), 1.0).terms().to_vec();
            let values = terms[0].matrix.real_values().unwrap().iter().map(|v| v * unit).collect();
            let pattern = terms[0].matrix.pattern().clone();
            terms[0].matrix =
                frfit_linalg::sparse::SymmetricMatrix::new(pattern, frfit_linalg::sparse::Values::Real(values));
            terms[0].factor = Law::Constant(c(100.0, 100.0 * loss) / unit);
            let mut damper = Triplets::new(10);
            damper.add(9, 9, 1.0);
            terms.push(term("damper", Role::Viscous, damper.assemble(), c(0.5, 0.0)));
            let model = DynamicStiffness::new(terms).unwrap();
            let experiment = tip_load(&model, &[rows.0, rows.1]);
            let variables = Variable::of_model(&model, &frequency_hz).unwrap();
            let band = band(&model, &experiment, &variables, &frequency_hz, ChangeOptions::default());
            band.resolved(&band.proportional(noise), sensors).unwrap().bars()
        };
        let (one, other) = (resolved(1.0, 0.01, &[0, 1]), resolved(unit, 0.02, &[0, 1]));
        let fewer = resolved(1.0, 0.01, &[0]);
        for ((a, b), fewer) in one.iter().zip(&other).zip(&fewer) {
            let (a, b) = (a.unwrap(), b.unwrap());
            prop_assert!((b / (2.0 * a) - 1.0).abs() < 1e-6, "{} against {}", b, a);
            prop_assert!(fewer.is_none_or(|fewer| a <= fewer * (1.0 + 1e-9)));
        }
    }
}
