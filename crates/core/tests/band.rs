//! A band at once against direct solves of the full model.

use crate::common;
use crate::tier::of_tier;

use common::{Band, Case, Setup, bar, beam, c, chain, plate, sandwich, term, thickness, tip_load};
use frfit::c64;
use frfit::for_each::{ForEach, sequential};
use frfit::frequency::linear_hz;
use frfit::identify::{Context, Identification, Line, Noise, Stage, Variation};
use frfit::identify::{Method, Reduction, Selection, Status, relative_error};
use frfit::material::Law;
use frfit::model::{DynamicStiffness, Experiment, Parameter, Role, Sensor, Term};
use frfit::response::Work;
use frfit::roots::Bounds;
use frfit_fem::Mass;
use frfit_linalg::sparse::{SymmetricMatrix, Triplets};
use std::sync::atomic::{AtomicUsize, Ordering};

fn quiet(_: Stage, _: usize, _: usize) {}

/// What would be measured if the factor were the case's nominal one: direct solves.
fn measured(case: &Case, frequency_hz: &[f64]) -> Vec<Vec<c64>> {
    frequency_hz.iter().map(|&f| case.direct(f, c64::default()).unwrap()).collect()
}

fn case_band<'a>(case: &'a Case, frequency_hz: &'a [f64], measured: &'a [Vec<c64>]) -> Band<'a> {
    Band {
        model: &case.model,
        experiment: &case.experiment,
        parameter: &case.parameter,
        frequency_hz,
        measured,
        noise: Noise::Unknown,
    }
}

fn identify(case: &Case, frequency_hz: &[f64], measured: &[Vec<c64>], setup: &Setup) -> Identification {
    let context = Context { for_each: &sequential, progress: &quiet };
    case_band(case, frequency_hz, measured).identify(Variation::PerFrequency, &[], setup, context)
}

/// Distance of the nearest admitted root from the truth, relative to it.
fn nearest(line: &Line, truth: c64) -> f64 {
    let admitted = line.roots.iter().filter(|root| root.refusal.is_none());
    admitted
        .map(|root| (line.nominal() + root.correction - truth).norm() / truth.norm())
        .fold(f64::INFINITY, f64::min)
}

/// Wide bounds about a real factor of this size, passive.
fn within(size: f64, by: f64) -> Setup {
    let bounds = Bounds { storage: Some([size / by, size * by]), loss_factor: Some([0.0, 2.0]) };
    Setup::within(bounds)
}

/// Everything that an line says is a number.
fn assert_no_nan(line: &Line) {
    let text = format!("{line:?}");
    assert!(!text.contains("NaN"), "{text}");
    let shown = [line.error, line.spectral_radius, line.reduction_error, line.convergence_radius()];
    assert!(shown.iter().flatten().all(|value| value.is_finite()), "{text}");
}

/// The truth is an admitted root at every frequency, and what is chosen is what the full model says it is.
fn assert_truth(mut case: Case, offs: &[f64], frequencies: usize, digits: f64) {
    let truth = case.parameter.nominal.clone();
    let frequency_hz = linear_hz(case.band_hz[0], case.band_hz[1], frequencies);
    let u = measured(&case, &frequency_hz);
    for &off in offs {
        case.parameter.nominal = truth.scaled(off);
        let setup = within(truth.at(case.band_hz[1]).unwrap().re, 10.0);
        let band = identify(&case, &frequency_hz, &u, &setup);
        assert!(band.search.reduced_size.is_some_and(|size| size < 130), "{:?}", band.search.reduced_size);
        for line in &band.lines {
            let f = line.frequency_hz;
            let missed = nearest(line, truth.at(f).unwrap());
            assert!(missed < digits, "{} × {off} at {f} Hz: {missed:e}", case.name);
            assert_no_nan(line);
            let correction = line.correction().unwrap();
            let exact = case.direct(f, correction).unwrap();
            let error = relative_error(&exact, &line.updated_response);
            let reduction_error = line.reduction_error.unwrap();
            assert!(
                error <= 5.0 * reduction_error,
                "{} × {off} at {f} Hz: {error:e} {reduction_error:e}",
                case.name
            );
        }
    }
}

/// Nominal over true factor.
const OFF: [f64; 6] = [1.25, 0.75, 1.5, 0.5, 3.0, 1.0 / 3.0];

#[test]
fn the_truth_is_admitted_on_plates_with_double_modes_and_almost_no_damping() {
    assert_truth(plate(8, 0.32, 1e-3), of_tier(&OFF[..1], &OFF), 30, 1e-6);
    assert_truth(plate(8, 0.4, 1e-5), of_tier(&[1.5], &[0.75, 1.5, 3.0]), 30, 1e-6);
}

#[test]
fn the_truth_is_admitted_on_bar_and_sandwich() {
    assert_truth(bar(80), of_tier(&[0.5], &[0.75, 0.5, 1.5]), 30, 1e-6);
    assert_truth(sandwich(12, 1), of_tier(&[3.0], &[0.5, 3.0]), 30, 1e-6);
}

#[test]
fn the_truth_is_admitted_on_antiresonances_and_resonances() {
    // The extremes of the response of a fine sweep, each with its neighbours.
    for case in [plate(8, 0.32, 1e-4), beam(20, 1e-4, Mass::Consistent)] {
        let sweep = linear_hz(case.band_hz[0], case.band_hz[1], 1000);
        let (model, _) = case.trained(1e-9);
        let size =
            |f: f64| model.projection().assess(&case.at(f), c64::default()).unwrap().response[0].norm();
        let sizes: Vec<f64> = sweep.iter().map(|&f| size(f)).collect();
        let extreme = |i: &usize| {
            let [a, b, c] = [sizes[i - 1], sizes[*i], sizes[i + 1]];
            (b - a) * (c - b) < 0.0
        };
        let found: Vec<f64> = (1..sweep.len() - 1).filter(extreme).map(|i| sweep[i]).collect();
        assert!(found.len() > 8, "{}", found.len());
        let last = found[found.len() - 1];
        let truth = case.parameter.nominal.clone();
        let u = measured(&case, &found);
        drop(model);
        let mut case = case;
        for off in [0.75, 1.5] {
            case.parameter.nominal = truth.scaled(off);
            let band = identify(&case, &found, &u, &within(truth.at(last).unwrap().re, 10.0));
            for line in &band.lines {
                let missed = nearest(line, truth.at(line.frequency_hz).unwrap());
                assert!(missed < 1e-6, "{} at {} Hz: {missed:e}", case.name, line.frequency_hz);
            }
        }
    }
}

/// Measurements at many frequencies without a direct solve for each: from a subspace of their own, compared with a few of them.
fn simulated(case: &Case, ratio: f64, frequency_hz: &[f64]) -> Vec<Vec<c64>> {
    let (model, trained) = case.trained(1e-7);
    assert!(trained.converged);
    let small = |f: f64| model.projection().assess(&case.at(f), case.correction(f, ratio)).unwrap().response;
    let count = frequency_hz.len();
    for i in [0, count / 3, count / 2, count - 1] {
        let f = frequency_hz[i];
        let exact = case.direct(f, case.correction(f, ratio)).unwrap();
        assert!(relative_error(&exact, &small(f)) < 1e-6);
    }
    frequency_hz.iter().map(|&f| small(f)).collect()
}

/// Work for this many frequencies.
fn work(case: &Case, frequencies: usize, bounds: [f64; 2]) -> Work {
    let frequency_hz = linear_hz(case.band_hz[0], case.band_hz[1], frequencies);
    let u = simulated(case, 0.8, &frequency_hz);
    let size = case.parameter.nominal.at(case.band_hz[1]).unwrap().re;
    let bounds = Bounds { storage: Some(bounds.map(|by| by * size)), loss_factor: Some([0.0, 2.0]) };
    let band = identify(case, &frequency_hz, &u, &Setup::within(bounds));
    assert_eq!(band.search.work.solves, band.search.reduced_size.unwrap());
    band.search.work
}

/// Four times as many frequencies cost the same.
fn assert_independent(few: Work, many: Work) {
    assert_eq!(few.factorisations, many.factorisations);
    let ratio = many.solves as f64 / few.solves as f64;
    assert!((0.9..1.1).contains(&ratio), "{few:?} {many:?}");
}

#[test]
fn a_plate_with_one_modulus_takes_two_factorisations_and_some_dozens_of_solves() {
    let plate = plate(20, 0.32, 1e-3); // 1083 rows
    let [few, many] = [100, 400].map(|count| work(&plate, count, [0.5, 1.5]));
    // One to solve with, one to count modes by.
    assert!(few.factorisations == 2 && few.solves <= 61, "{few:?}");
    assert_independent(few, many);
}

#[test]
fn a_sandwich_takes_a_handful_of_factorisations_whatever_the_number_of_frequencies() {
    let sandwich = sandwich(of_tier(10, 30), 2); // 360 or 1080 rows
    let [few, many] = of_tier([100, 400], [250, 1000]).map(|count| work(&sandwich, count, [0.1, 10.0]));
    assert!(many.factorisations <= 4 && many.solves <= 200, "{many:?}");
    assert_independent(few, many);
}

#[test]
fn the_papers_way_is_the_same_on_the_subspace() {
    for (case, off) in [(plate(8, 0.4, 1e-2), 1.25), (bar(60), 1.5), (sandwich(12, 1), 1.3)] {
        let mut case = case;
        let truth = case.parameter.nominal.clone();
        let frequency_hz = linear_hz(case.band_hz[0], case.band_hz[1], 24);
        let u = measured(&case, &frequency_hz);
        case.parameter.nominal = truth.scaled(off);
        let wide = within(truth.at(case.band_hz[1]).unwrap().re, 10.0);
        let paper = Setup::paper(wide.bounds);
        let on = |reduction| identify(&case, &frequency_hz, &u, &paper.with_reduction(reduction));
        let (full, small) = (on(Reduction::Full), on(Reduction::Subspace));
        assert_eq!((full.search.reduced_size, small.search.reduced_size.is_some()), (None, true));
        assert!(full.search.work.factorisations >= 2 * 24 && small.search.work.factorisations <= 4);
        assert_eq!(on(Reduction::Auto).search.reduced_size, None);
        let mut settled = 0;
        for (a, b) in full.lines.iter().zip(&small.lines) {
            let at = format!("{} at {} Hz:\n{a:?}\n{b:?}", case.name, a.frequency_hz);
            assert_eq!(a.status, b.status, "{at}");
            assert_no_nan(b);
            if !matches!(a.status, Status::Ok | Status::Ambiguous) {
                continue; // ghosts are roots of a truncated series, and as they please
            }
            let (x, y) = (a.correction().unwrap(), b.correction().unwrap());
            assert!((x - y).norm() < 1e-5 * a.factor().unwrap().norm(), "{at}");
            // Where the nearest pole is far outside the box, the subspace does not know it well.
            let [r, s] = [a, b].map(|line| line.spectral_radius.unwrap());
            assert!((r - s).abs() < 0.05 * r, "{at}");
            settled += 1;
        }
        assert!(settled >= 6, "{} {settled}", case.name);
    }
}

#[test]
fn order_and_threads_of_the_work_do_not_change_a_bit() {
    let mut case = sandwich(8, 1);
    let truth = case.parameter.nominal.clone();
    let frequency_hz = linear_hz(20.0, 1000.0, 40);
    let u = measured(&case, &frequency_hz);
    case.parameter.nominal = truth.scaled(1.4);
    let setup = within(truth.at(1000.0).unwrap().re, 10.0);
    let backwards = |n: usize, each: &(dyn Fn(usize) + Sync)| (0..n).rev().for_each(each);
    let threads = |n: usize, each: &(dyn Fn(usize) + Sync)| {
        let next = AtomicUsize::new(0);
        std::thread::scope(|scope| {
            for _ in 0..3 {
                scope.spawn(|| {
                    let indices = std::iter::from_fn(|| Some(next.fetch_add(1, Ordering::Relaxed)));
                    indices.take_while(|&i| i < n).for_each(each);
                });
            }
        });
    };
    for setup in [setup, Setup::paper(setup.bounds).with_reduction(Reduction::Subspace)] {
        let by = |for_each: ForEach<'_>| {
            let context = Context { for_each, progress: &quiet };
            // Every digit is written out: equal texts are equal bits.
            format!(
                "{:?}",
                case_band(&case, &frequency_hz, &u).identify(Variation::PerFrequency, &[], &setup, context)
            )
        };
        let forwards = by(&sequential);
        assert!(forwards == by(&backwards) && forwards == by(&threads));
    }
}

#[test]
fn one_and_two_frequencies_are_bands() {
    let mut case = plate(8, 0.4, 1e-3);
    let truth = case.parameter.nominal.clone();
    let u = measured(&case, &[700.0, 1900.0]);
    case.parameter.nominal = truth.scaled(1.3);
    for reduction in [Reduction::Auto, Reduction::Full, Reduction::Subspace] {
        for (frequency_hz, u) in [(&[700.0][..], &u[..1]), (&[700.0, 1900.0], &u)] {
            let band = identify(&case, frequency_hz, u, &within(2e11, 10.0).with_reduction(reduction));
            assert_eq!(band.lines.len(), frequency_hz.len());
            assert_eq!(band.search.reduced_size.is_some(), reduction == Reduction::Subspace);
            for line in &band.lines {
                assert_no_nan(line);
                assert!(nearest(line, truth.at(700.0).unwrap()) < 1e-6, "{reduction:?}: {line:?}");
            }
        }
    }
}

#[test]
fn a_band_may_begin_at_rest() {
    let mut case = plate(8, 0.4, 1e-3);
    let truth = case.parameter.nominal.clone();
    for frequency_hz in [&[0.0][..], &[0.0, 100.0, 200.0, 900.0]] {
        let u = measured(&case, frequency_hz);
        case.parameter.nominal = truth.scaled(1.3);
        for reduction in [Reduction::Full, Reduction::Subspace] {
            let band = identify(&case, frequency_hz, &u, &within(2e11, 10.0).with_reduction(reduction));
            assert_eq!(band.search.reduced_size.is_some(), reduction == Reduction::Subspace);
            for line in &band.lines {
                assert_no_nan(line);
                assert!(nearest(line, truth.at(0.0).unwrap()) < 1e-6, "{reduction:?}: {line:?}");
            }
        }
        case.parameter.nominal = truth.clone();
    }
}

#[test]
fn a_free_structure_at_rest_has_no_answer_there() {
    let mut case = bar(30);
    let frequency_hz = [0.0, 50.0, 400.0, 900.0];
    let mut u = vec![vec![c64::new(1.0, 0.0); 2]];
    u.extend(measured(&case, &frequency_hz[1..]));
    let truth = case.parameter.nominal.clone();
    case.parameter.nominal = truth.scaled(1.3);
    for reduction in [Reduction::Full, Reduction::Subspace] {
        let band = identify(&case, &frequency_hz, &u, &within(5e6, 20.0).with_reduction(reduction));
        band.lines.iter().for_each(assert_no_nan);
        assert_ne!(band.lines[0].status, Status::Ok, "{reduction:?}");
        for line in &band.lines[1..] {
            assert!(nearest(line, truth.at(line.frequency_hz).unwrap()) < 1e-6, "{reduction:?}: {line:?}");
        }
    }
}

/// The chain with a spring of unknown stiffness to the ground in its middle, nominally absent.
fn absent() -> Case {
    let (n, chain) = (80, chain(80, c(1e4, 100.0), 1.0));
    let mut spring = Triplets::new(n);
    spring.add(n / 2, n / 2, 1.0);
    let mut terms = chain.terms().to_vec();
    terms.push(term("ground", Role::Stiffness, spring.assemble(), c(0.0, 0.0)));
    let model = DynamicStiffness::new(terms).unwrap();
    let parameter = Parameter::factor_of(&model, &["ground"]).unwrap();
    let experiment = tip_load(&model, &[n - 1, n / 3]);
    Case { name: "absent", model, experiment, parameter, band_hz: [0.5, 10.0], box_ratio: [1.0, 2.0] }
}

#[test]
fn what_is_nominally_absent_is_found() {
    let case = absent();
    let truth = c(4e3, 40.0);
    let frequency_hz = linear_hz(0.5, 10.0, 12);
    let u: Vec<Vec<c64>> = frequency_hz.iter().map(|&f| case.direct(f, truth).unwrap()).collect();
    for reduction in [Reduction::Full, Reduction::Subspace] {
        let band = identify(&case, &frequency_hz, &u, &Setup::default().with_reduction(reduction));
        for line in &band.lines {
            assert!(nearest(line, truth) < 1e-5, "{reduction:?}: {line:?}");
            assert!(!format!("{line:?}").contains("NaN"), "{reduction:?}: {line:?}");
        }
    }
}

#[test]
fn a_sensor_that_measures_nothing_does_no_harm() {
    let mut case = plate(8, 0.4, 1e-3);
    let truth = case.parameter.nominal.clone();
    let frequency_hz = [300.0, 700.0, 1100.0, 1500.0];
    let mut u = measured(&case, &frequency_hz);
    case.parameter.nominal = truth.scaled(1.2);
    for m in [0, 1] {
        let kept = std::mem::take(&mut u[2][m]);
        for reduction in [Reduction::Full, Reduction::Subspace] {
            let setup = within(2e11, 10.0).with_reduction(reduction);
            for setup in [setup, setup.with_selection(Selection::Smallest)] {
                let band = identify(&case, &frequency_hz, &u, &setup);
                band.lines.iter().for_each(assert_no_nan);
                assert_ne!(band.lines[2].status, Status::Ok, "{:?}", band.lines[2]);
                assert!(nearest(&band.lines[1], truth.at(0.0).unwrap()) < 1e-6);
            }
        }
        u[2][m] = kept;
    }
    // Both: nothing was measured there.
    u[2].fill(c64::default());
    for reduction in [Reduction::Full, Reduction::Subspace] {
        for selection in [Selection::Joint, Selection::Smallest] {
            let band = identify(
                &case,
                &frequency_hz,
                &u,
                &within(2e11, 10.0).with_reduction(reduction).with_selection(selection),
            );
            band.lines.iter().for_each(assert_no_nan);
            assert_ne!(band.lines[2].status, Status::Ok);
        }
    }
}

#[test]
fn a_load_on_a_massless_degree_of_freedom_is_a_load() {
    let mut case = beam(40, 1e-3, Mass::Lumped);
    let rotation = 31;
    assert_eq!(case.model.terms()[1].matrix.get(rotation, rotation), c64::default());
    case.experiment.load.fill(c64::default());
    case.experiment.load[rotation] = c(1.0, 0.0);
    assert_truth(case, &[1.3], 20, 1e-6);
}

#[test]
fn a_singular_model_is_a_status() {
    // The last degree of freedom is attached to nothing.
    let (k, m) = (chain(80, c(1e4, 100.0), 1.0), 1.0);
    let grown = |matrix: &SymmetricMatrix| {
        let mut t = Triplets::new(81);
        let (positions, values) = (matrix.pattern().positions(), matrix.real_values().unwrap());
        positions.zip(values).for_each(|((i, j), &v)| t.add(i, j, v * m));
        t.assemble()
    };
    let terms = k.terms().iter().map(|own| Term { matrix: grown(&own.matrix), ..own.clone() }).collect();
    let model = DynamicStiffness::new(terms).unwrap();
    let parameter = Parameter::factor_of(&model, &["springs"]).unwrap();
    let mut experiment = tip_load(&model, &[3]);
    experiment.load.swap(79, 80);
    let case =
        Case { name: "loose", model, experiment, parameter, band_hz: [1.0, 5.0], box_ratio: [0.5, 2.0] };
    let frequency_hz = linear_hz(1.0, 5.0, 6);
    let u = vec![vec![c(1e-4, 1e-5)]; 6];
    for reduction in [Reduction::Full, Reduction::Subspace, Reduction::Auto] {
        for paper in [Setup::default(), Setup::paper(Bounds::default())] {
            let band = identify(&case, &frequency_hz, &u, &paper.with_reduction(reduction));
            for line in &band.lines {
                assert_eq!(line.status, Status::Failed, "{reduction:?}");
                assert!(line.breakdown.is_some());
                assert_no_nan(line);
            }
        }
    }
}

#[test]
fn bounds_may_exclude_the_nominal() {
    let mut case = plate(8, 0.4, 1e-3);
    let truth = case.parameter.nominal.clone();
    let frequency_hz = linear_hz(100.0, 2000.0, 10);
    let u = measured(&case, &frequency_hz);
    for off in [0.2, 6.0] {
        case.parameter.nominal = truth.scaled(off);
        for reduction in [Reduction::Full, Reduction::Subspace] {
            let setup = within(2e11, 1.5).with_reduction(reduction).with_order(60);
            let band = identify(&case, &frequency_hz, &u, &setup);
            for line in &band.lines {
                assert_no_nan(line);
                assert!(nearest(line, truth.at(0.0).unwrap()) < 1e-6, "{off} {reduction:?}: {line:?}");
                for root in line.roots.iter().filter(|root| root.refusal.is_none()) {
                    assert_eq!(setup.bounds.broken_by(line.nominal() + root.correction), None);
                }
            }
        }
    }
}

#[test]
fn odd_bounds_are_no_reason_to_panic() {
    let case = plate(6, 0.4, 1e-3);
    let frequency_hz = [100.0, 500.0];
    let u = measured(&case, &frequency_hz);
    for storage in [
        None,
        Some([0.0, 1e12]),
        Some([-1e12, 1e12]),
        Some([-2.0, -1.0]),
        Some([2e11, 2e11]),
        Some([0.0, 0.0]),
    ] {
        for whole_box in [false, true] {
            let bounds = Bounds { storage, loss_factor: None };
            let setup = Setup::within(bounds).with_whole_box(whole_box).with_reduction(Reduction::Subspace);
            let band = identify(&case, &frequency_hz, &u, &setup);
            band.lines.iter().for_each(assert_no_nan);
            // To bounds without width roundoff is outside.
            let wide = storage.is_none_or(|[low, high]| low < high);
            if wide && bounds.broken_by(case.parameter.nominal.at(100.0).unwrap()).is_none() {
                assert!(nearest(&band.lines[1], c(2e11, 2e8)) < 1e-6, "{storage:?}");
            }
        }
    }
}

#[test]
fn a_real_factor_is_real() {
    let mut case = absent();
    // A nominal with an imaginary part has to lose it.
    for nominal in [c(4e3, 0.0), c(5e3, 2e3)] {
        case.parameter.nominal = Law::Constant(nominal);
        let truth = c(3.5e3, 0.0);
        // Ten frequencies over a dozen modes: neighbours have little in common.
        let frequency_hz = linear_hz(0.5, 9.0, 10);
        let u: Vec<_> = frequency_hz.iter().map(|&f| case.direct(f, truth - nominal).unwrap()).collect();
        for reduction in [Reduction::Full, Reduction::Subspace] {
            let setup = Setup { real: true, ..within(3.5e3, 3.0).with_reduction(reduction) };
            let band = identify(&case, &frequency_hz, &u, &setup);
            for line in &band.lines {
                assert_no_nan(line);
                assert!(nearest(line, truth) < 1e-6, "{reduction:?}: {line:?}");
                for root in line.roots.iter().filter(|root| root.refusal.is_none()) {
                    let factor = nominal + root.correction;
                    assert!(factor.im.abs() < 1e-12 * factor.norm(), "{factor}");
                    assert_eq!(setup.bounds.broken_by(c(factor.re, 0.0)), None);
                }
            }
        }
    }
}

#[test]
fn a_nominal_that_is_right_stays() {
    let case = plate(8, 0.4, 1e-3);
    let frequency_hz = linear_hz(100.0, 3000.0, 10);
    let u = measured(&case, &frequency_hz);
    for reduction in [Reduction::Full, Reduction::Subspace] {
        let joint = within(2e11, 10.0).with_reduction(reduction);
        let rational = joint.with_selection(Selection::Smallest);
        for setup in [joint, rational, rational.with_method(Method::Series)] {
            let band = identify(&case, &frequency_hz, &u, &setup);
            for line in &band.lines {
                assert_no_nan(line);
                assert!(nearest(line, line.nominal()) < 1e-9, "{setup:?}: {line:?}");
            }
        }
    }
}

/// Nothing bounds the modulus of a rod, and its nominal is up to ten times off: nearly all of the modulus is found, and nothing else.
#[test]
fn a_nominal_that_is_far_off_needs_no_bounds() {
    let mut case = bar(60);
    let truth = case.parameter.nominal.clone();
    let frequency_hz = linear_hz(case.band_hz[0], case.band_hz[1], of_tier(40, 200));
    let u = measured(&case, &frequency_hz);
    for &off in of_tier([0.1, 10.0].as_slice(), &[0.1, 0.2, 5.0, 10.0]) {
        case.parameter.nominal = truth.scaled(off);
        let band = identify(&case, &frequency_hz, &u, &Setup::default());
        let ok: Vec<&Line> = band.lines.iter().filter(|line| line.status == Status::Ok).collect();
        // Far from the nominal some roots are lost to roundoff where the response is that of a spring.
        assert!(
            10 * ok.len() >= 9 * band.lines.len(),
            "× {off}: {} of {} are ok",
            ok.len(),
            band.lines.len()
        );
        for line in ok {
            assert!(nearest(line, truth.at(line.frequency_hz).unwrap()) < 1e-6, "× {off}: {line:?}");
        }
    }
}

/// A chain that carries light oscillators, each tuned a little higher than the one before. At the top of the band many modes lie between two of the values of the modulus
/// for which the models of neighbourhoods are made.
#[test]
fn a_dense_band_is_identified_to_its_end() {
    let (carriers, carried) = (8, 72);
    let n = carriers + carried;
    let (mut k, mut m) = (Triplets::new(n), Triplets::new(n));
    let mut spring = |a: usize, b: usize, stiffness: f64| {
        k.add_element(&[Some(a), Some(b)], &[1.0, -1.0, -1.0, 1.0].map(|one| one * stiffness));
    };
    for i in 0..carriers {
        spring(i, (i + 1) % carriers, 1.0);
        m.add(i, i, 1.0);
    }
    for j in 0..carried {
        let (own, mass, omega) = (carriers + j, 0.01, 1.3 + 1.2 * j as f64 / carried as f64);
        spring(j % carriers, own, mass * omega * omega);
        m.add(own, own, mass);
    }
    let truth = c(1.0, 0.0025);
    let terms = vec![
        term("springs", Role::Stiffness, k.assemble(), truth),
        term("masses", Role::Mass, m.assemble(), c(1.0, 0.0)),
    ];
    let model = DynamicStiffness::new(terms).unwrap();
    let sensor = |row| Sensor { row, sign: 1.0 };
    let experiment = Experiment::driven_at(n, sensor(3), vec![sensor(6), sensor(1)]);
    let parameter = Parameter::factor_of(&model, &["springs"]).unwrap();
    let mut case =
        Case { name: "carrier", model, experiment, parameter, band_hz: [0.08, 0.3], box_ratio: [0.25, 4.0] };
    let frequency_hz = linear_hz(0.08, 0.3, 80);
    let u = measured(&case, &frequency_hz);
    case.parameter.nominal = Law::Constant(2.8 * truth);
    let band = identify(&case, &frequency_hz, &u, &Setup::default().with_reduction(Reduction::Subspace));
    let off = |line: &Line| line.factor().map_or(f64::INFINITY, |factor| (factor - truth).norm());
    assert!(band.lines.iter().all(|line| line.status == Status::Ok && off(line) < 1e-6));
}

#[test]
fn a_thickness_is_found_too() {
    let mut case = thickness();
    let truth = case.parameter.nominal.clone();
    let frequency_hz = linear_hz(100.0, 3000.0, of_tier(6, 12));
    let u = measured(&case, &frequency_hz);
    for off in [0.8, 1.3] {
        case.parameter.nominal = truth.scaled(off);
        for reduction in [Reduction::Full, Reduction::Subspace] {
            let band = identify(&case, &frequency_hz, &u, &within(1.0, 2.0).with_reduction(reduction));
            for line in &band.lines {
                assert_no_nan(line);
                let missed = nearest(line, truth.at(0.0).unwrap());
                assert!(missed < 1e-6, "× {off} at {} Hz, {reduction:?}: {missed:e}", line.frequency_hz);
            }
        }
    }
}
