//! Several unknowns at once, against models that are solved directly at known values.

use crate::common;
use crate::noise::Noise as Draws;
use crate::tier::{is_long, of_tier};

use common::{bar, c, constant, plate, sandwich, term, two_part_chain};
use frfit::c64;
use frfit::for_each::sequential;
use frfit::frequency::linear_hz;
use frfit::identify::{
    Context, Dependence, Frfs, Identification, ModelErrors, Noise, Options, Problem, Standing, Status,
    Unknown, Variation, identify,
};
use frfit::material::Law;
use frfit::model::{DynamicStiffness, Experiment, Role, Sensor, Term};
use frfit::roots::Bounds;

const CONTEXT: Context<'static> = Context { for_each: &sequential, progress: &|_, _, _| {} };

/// x at the sensors, by direct solves with these factors in place of the terms' own: the oracle.
fn direct(
    model: &DynamicStiffness,
    experiment: &Experiment,
    factors: &[Law],
    frequency_hz: &[f64],
) -> Vec<Vec<c64>> {
    let terms = model.terms().iter().zip(factors);
    let terms = terms.map(|(term, factor)| Term { factor: factor.clone(), ..term.clone() }).collect();
    let model = DynamicStiffness::new(terms).unwrap();
    let one = |&f: &f64| {
        let factor = model.analysis().factor(&model.at(f, &[]).unwrap().assemble(&[])).unwrap();
        let mut x = experiment.load.clone();
        factor.solve(&mut x).unwrap();
        experiment.observe(&x)
    };
    frequency_hz.iter().map(one).collect()
}

/// Circular noise of this part of each response, and its standard deviation √E|δx|².
fn noisy(exact: &[Vec<c64>], part: f64, seed: u64) -> (Vec<Vec<c64>>, Vec<Vec<f64>>) {
    let mut draws = Draws::new(seed);
    let std: Vec<Vec<f64>> = exact.iter().map(|x| x.iter().map(|x| part * x.norm()).collect()).collect();
    let mut normal = || draws.complex() / 2f64.sqrt();
    let measured =
        exact.iter().zip(&std).map(|(x, s)| x.iter().zip(s).map(|(x, s)| x + s * normal()).collect());
    (measured.collect(), std)
}

/// What was measured on what, and what is unknown.
#[derive(Clone, Copy)]
struct Setup<'a> {
    model: &'a DynamicStiffness,
    experiment: &'a Experiment,
    unknowns: &'a [Unknown],
    frequency_hz: &'a [f64],
    measured: &'a [Vec<c64>],
    noise: Noise<'a>,
}

fn run(setup: &Setup<'_>) -> Identification {
    let Setup { model, experiment, unknowns, frequency_hz, measured, noise } = *setup;
    let frfs = Frfs { frequency_hz, receptance: measured, noise };
    let problem = Problem::new(model, experiment, unknowns, &[], frfs).unwrap();
    identify(&problem, &Options::default(), CONTEXT).unwrap()
}

/// A plate whose thickness is 10 % off: h³ in bending, h in the mass.
struct Thickness {
    model: DynamicStiffness,
    experiment: Experiment,
    frequency_hz: Vec<f64>,
    exact: Vec<Vec<c64>>,
}

const TRUE_THICKNESS: f64 = 1.1;

fn thickness() -> Thickness {
    let case = plate(6, 0.4, 1e-2);
    let frequency_hz = linear_hz(100.0, 2000.0, 60);
    let mut experiment = case.experiment.clone();
    experiment.sensors.push(Sensor { row: experiment.sensors[0].row.min(30), sign: 1.0 });
    let h = TRUE_THICKNESS;
    let factors = [c(2e11, 2e9) * h.powi(3), c(7800.0 * h, 0.0)].map(Law::Constant);
    let exact = direct(&case.model, &experiment, &factors, &frequency_hz);
    Thickness { model: case.model, experiment, frequency_hz, exact }
}

#[test]
fn a_plate_tells_its_thickness() {
    let plate = thickness();
    let unknowns = [constant("h", Dependence::Powers(vec![(0, 3), (1, 1)]), 1.0, [0.5, 2.0])];
    let band = Setup {
        model: &plate.model,
        experiment: &plate.experiment,
        unknowns: &unknowns,
        frequency_hz: &plate.frequency_hz,
        measured: &plate.exact,
        noise: Noise::Unknown,
    };
    let outcome = run(&band);
    // Exact data: what is left is the subspace (1e-9 of the response).
    assert!((outcome.constants[0].numbers[0].value - TRUE_THICKNESS).abs() < 1e-8, "{:?}", outcome.constants);
    assert_eq!(outcome.constants[0].status, Status::Ok);
    assert!(outcome.lines.iter().all(|at| at.status == Status::Ok));
    assert!(
        outcome.search.work.factorisations <= 2 && outcome.search.work.solves < 100,
        "{:?}",
        outcome.search.work
    );

    let (measured, std) = noisy(&plate.exact, 0.01, 7);
    let outcome = run(&Setup { measured: &measured, noise: Noise::Known(&std), ..band });
    let number = &outcome.constants[0].numbers[0];
    let std = number.std.unwrap();
    assert!((number.value - TRUE_THICKNESS).abs() < 4.0 * std && std < 1e-3, "{number:?}");
}

#[test]
fn the_error_bar_of_the_thickness_covers_the_truth() {
    let plate = thickness();
    let every_other = |rows: &[Vec<c64>]| rows.iter().step_by(2).cloned().collect::<Vec<_>>();
    let frequency_hz: Vec<f64> = plate.frequency_hz.iter().copied().step_by(2).collect();
    let unknowns = [constant("h", Dependence::Powers(vec![(0, 3), (1, 1)]), 1.0, [0.5, 2.0])];
    let (mut within_one, mut within_two) = (0, 0);
    let seeds = of_tier(1, 50);
    for seed in 0..seeds {
        let (measured, std) = noisy(&every_other(&plate.exact), 0.01, 1000 + seed);
        let outcome = run(&Setup {
            model: &plate.model,
            experiment: &plate.experiment,
            unknowns: &unknowns,
            frequency_hz: &frequency_hz,
            measured: &measured,
            noise: Noise::Known(&std),
        });
        let number = &outcome.constants[0].numbers[0];
        assert_eq!(outcome.constants[0].status, Status::Ok, "{seed}: {number:?}");
        let off = (number.value - TRUE_THICKNESS).abs() / number.std.unwrap();
        // Once in 16,000 by chance.
        assert!(off < 4.0, "{seed}: {number:?}");
        within_one += usize::from(off < 1.0);
        within_two += usize::from(off < 2.0);
    }
    if seeds < 50 {
        return;
    }
    // 68 and 95 of 100 of a normal deviate; of 50, 34 and 47.7 with standard deviations of 3.3 and 1.5: three of them. Bars hold errors of a mesh that noise hides, so that more
    // are within. The seeds are fixed.
    assert!(within_one >= 24 && within_two >= 44, "{within_one} and {within_two} of 50");
}

#[test]
fn two_moduli_at_every_frequency() {
    let frequencies = of_tier(16, 80);
    let (right, wrong_and_ok) = two_moduli(3, frequencies);
    assert!(right + 1 >= frequencies && wrong_and_ok == 0, "{right} right, {wrong_and_ok} wrong and ok");
}

#[test]
fn two_moduli_from_two_sensors() {
    // as many equations as unknowns: each frequency has up to a dozen solutions, of which the band selects one
    let frequencies = of_tier(14, 32);
    let (right, wrong_and_ok) = two_moduli(2, frequencies);
    assert!(right + 1 >= frequencies && wrong_and_ok == 0, "{right} right, {wrong_and_ok} wrong and ok");
}

/// Frequencies of so many at which both moduli of a sandwich are right, and those where one is not though it is called `ok`.
fn two_moduli(sensors: usize, frequencies: usize) -> (usize, usize) {
    let case = sandwich(10, 2);
    let mut experiment = case.experiment.clone();
    let last = experiment.sensors[0].row;
    experiment.sensors.push(Sensor { row: last / 3, sign: 1.0 });
    assert_eq!(experiment.sensors.len(), 3);
    experiment.sensors.truncate(sensors);
    let frequency_hz = linear_hz(20.0, of_tier(500.0, 1000.0), frequencies);
    let core = Law::Fractional { e0: 8.14e5, e1: 7.31e4, alpha: 0.528 };
    let skins = Law::Constant(c(6.2e10, 6.2e8));
    let factors = [skins.clone(), core.clone(), Law::Constant(c(2700.0, 0.0)), Law::Constant(c(910.0, 0.0))];
    let exact = direct(&case.model, &experiment, &factors, &frequency_hz);
    let unknowns = [0, 1].map(|term| Unknown {
        name: case.model.terms()[term].name.clone(),
        dependence: Dependence::Factor(vec![term]),
        nominal: case.model.terms()[term].factor.clone(),
        varies: Variation::PerFrequency,
        real: false,
        bounds: Bounds::default(),
    });
    let outcome = run(&Setup {
        model: &case.model,
        experiment: &experiment,
        unknowns: &unknowns,
        frequency_hz: &frequency_hz,
        measured: &exact,
        noise: Noise::Unknown,
    });
    let truth = |f: f64| [skins.at(f).unwrap(), core.at(f).unwrap()];
    let (mut right, mut wrong_and_ok) = (0, 0);
    for at in &outcome.lines {
        let exact = truth(at.frequency_hz);
        let is_right = (0..2).all(|j| {
            at.values[j].value.is_some_and(|found| (found - exact[j]).norm() <= 1e-5 * exact[j].norm())
        });
        right += usize::from(is_right);
        wrong_and_ok += usize::from(!is_right && at.status == Status::Ok);
    }
    assert!(
        outcome.search.work.factorisations <= 3 && outcome.search.work.solves < 200,
        "{:?}",
        outcome.search.work
    );
    (right, wrong_and_ok)
}

/// As many equations as unknowns at three frequencies: no path distinguishes all solutions, and an ambiguous line has them all.
#[test]
fn an_ambiguous_line_has_its_likeliest_values_and_its_rivals() {
    let mut case = two_part_chain(24);
    case.experiment.sensors.truncate(2);
    let truth = [c(1.2, 0.036), c(0.8, 0.024)];
    let frequency_hz = [0.1, 0.14, 0.18];
    let factors = [truth[0], truth[1], c(1.0, 0.0)].map(Law::Constant);
    let exact = direct(&case.model, &case.experiment, &factors, &frequency_hz);
    let unknowns = [0, 1].map(|term| Unknown {
        bounds: Bounds { storage: Some([0.4, 2.5]), loss_factor: Some([0.0, 0.3]) },
        ..Unknown::factor_of(&case.model, &[case.model.terms()[term].name.as_str()]).unwrap()
    });
    let frfs = Frfs { frequency_hz: &frequency_hz, receptance: &exact, noise: Noise::Unknown };
    let problem = Problem::new(&case.model, &case.experiment, &unknowns, &[], frfs).unwrap();
    // Three lines cannot exclude errors of the model of some per cent.
    for (model_errors, within) in [(ModelErrors::None, 1e-5), (ModelErrors::Estimated, 0.05)] {
        let options = Options::default().with_model_errors(model_errors);
        let found = identify(&problem, &options, CONTEXT).unwrap();
        for line in &found.lines {
            let values: Vec<c64> = line.values.iter().filter_map(|value| value.value).collect();
            let of = |standing| line.solutions.iter().filter(move |one| one.standing == standing);
            assert_eq!(of(Standing::Chosen).map(|one| &one.values).collect::<Vec<_>>(), [&values]);
            assert!(of(Standing::Rival).map(|one| &one.values).eq(&line.rivals), "{line:?}");
            assert_eq!(line.candidate_count(), line.solutions.len());
            // The truth is the answer, or a rival of it.
            let is_true = |values: &Vec<c64>| values.iter().zip(truth).all(|(v, t)| (v - t).norm() < within);
            assert!(is_true(&values) || line.rivals.iter().any(is_true), "{line:?}");
        }
        let mut ambiguous = found.lines.iter().filter(|line| line.status == Status::Ambiguous).peekable();
        assert!(ambiguous.peek().is_some() && ambiguous.all(|line| !line.rivals.is_empty()));
    }
}

#[test]
fn length_and_density_of_a_bar() {
    let case = bar(40);
    let frequency_hz = linear_hz(200.0, 2000.0, 60);
    let modulus = Law::Fractional { e0: 8.14e5, e1: 7.31e4, alpha: 0.528 };
    let (length, density) = (1.07, 850.0);
    let terms = case.model.terms();
    let model = DynamicStiffness::new(vec![
        Term { factor: modulus.scaled(1.0), ..terms[0].clone() },
        term("mass", Role::Mass, terms[1].matrix.clone(), c(910.0, 0.0)),
    ])
    .unwrap();
    let factors = [modulus.scaled(1.0 / length), Law::Constant(c(density * length, 0.0))];
    let exact = direct(&model, &case.experiment, &factors, &frequency_hz);
    let (measured, std) = noisy(&exact, 0.01, 3);
    let unknowns = vec![
        constant("length", Dependence::Powers(vec![(0, -1), (1, 1)]), 1.0, [0.7, 1.4]),
        constant("density", Dependence::Factor(vec![1]), 910.0, [500.0, 1500.0]),
    ];
    let mut with_modulus = unknowns.clone();
    with_modulus.push(Unknown {
        name: "modulus".into(),
        dependence: Dependence::Factor(vec![0]),
        nominal: modulus.scaled(1.2),
        varies: Variation::law(frfit::laws::LawKind::Fractional),
        real: false,
        bounds: Bounds::default(),
    });
    let band = |unknowns| {
        let noise = Noise::Known(&std);
        Setup {
            model: &model,
            experiment: &case.experiment,
            unknowns,
            frequency_hz: &frequency_hz,
            measured: &measured,
            noise,
        }
    };
    // The modulus is known: both are identifiable.
    let outcome = run(&band(&unknowns));
    for (found, truth) in outcome.constants.iter().zip([length, density]) {
        let number = &found.numbers[0];
        assert_eq!(found.status, Status::Ok, "{number:?}");
        assert!((number.value - truth).abs() < 4.0 * number.std.unwrap(), "{number:?}");
    }
    // The modulus is not: E/L and ρL are all that there is, and one combination of the three is not identifiable.
    let outcome = run(&band(&with_modulus));
    assert_eq!(outcome.constants[0].status, Status::NotIdentifiable);
    assert_eq!(outcome.constants[1].status, Status::NotIdentifiable);
    assert!(
        outcome.identifiability.directions[0].std > 1.0 && outcome.identifiability.directions[1].std < 0.1,
        "{:?}",
        outcome.identifiability.directions
    );
    // ln L goes with −ln ρ and with ln E: the same size for all, e0 and e1 both.
    let weight =
        |c: usize| outcome.identifiability.directions[0].weights.iter().find(|(k, _)| *k == c).unwrap().1;
    for (c, sign) in [(0, 1.0), (1, -1.0), (2, 1.0), (3, 1.0)] {
        assert!(
            (weight(c) * sign - weight(0)).abs() < 1e-3,
            "{c}: {:?}",
            outcome.identifiability.directions[0]
        );
    }
}

/// A length that is longer than its bounds allow stops at them, and says so; the density is found for that length.
#[test]
fn a_constant_stops_at_its_bounds() {
    let case = bar(40);
    let frequency_hz = linear_hz(200.0, 2000.0, of_tier(30, 60));
    let modulus = Law::Fractional { e0: 8.14e5, e1: 7.31e4, alpha: 0.528 };
    let (length, density) = (1.07, 850.0);
    let terms = case.model.terms();
    let model = DynamicStiffness::new(vec![
        Term { factor: modulus.scaled(1.0), ..terms[0].clone() },
        term("mass", Role::Mass, terms[1].matrix.clone(), c(910.0, 0.0)),
    ])
    .unwrap();
    let factors = [modulus.scaled(1.0 / length), Law::Constant(c(density * length, 0.0))];
    let exact = direct(&model, &case.experiment, &factors, &frequency_hz);
    let (measured, std) = noisy(&exact, 0.01, 3);
    let lengths = [[0.7, 0.95], [1.2, 1.4], [0.7, 1.4]].map(|bounds| {
        let unknowns = [
            constant("length", Dependence::Powers(vec![(0, -1), (1, 1)]), 1.0, bounds),
            constant("density", Dependence::Factor(vec![1]), 910.0, [500.0, 1500.0]),
        ];
        let found = run(&Setup {
            model: &model,
            experiment: &case.experiment,
            unknowns: &unknowns,
            frequency_hz: &frequency_hz,
            measured: &measured,
            noise: Noise::Known(&std),
        });
        let value = found.constants[0].numbers[0].value;
        assert!((bounds[0]..=bounds[1]).contains(&value), "{value} in {bounds:?}");
        // At the bound the data are not explained, and nothing is ok.
        let ok = found.lines.iter().filter(|at| at.status == Status::Ok).count();
        assert_eq!(ok > 0, !found.constants[0].at_bound, "{:?}", found.fit);
        (value, found.constants[0].at_bound, found.constants[0].status)
    });
    for ((value, at_bound, status), bound) in lengths.into_iter().zip([0.95, 1.2]) {
        // The search for errors ends at the bound. On the model that is corrected for them the constant moves by less than its error bar.
        assert!((value / bound - 1.0).abs() < 1e-4, "{value}");
        assert_eq!((at_bound, status), (true, Status::NoRoot));
    }
    assert!(
        !lengths[2].1 && lengths[2].2 == Status::Ok && (lengths[2].0 - length).abs() < 0.01,
        "{lengths:?}"
    );
}

/// A modulus known to a per cent whose loss factor noise leaves unknown, away from the resonances of a lightly damped plate: the modulus and the density are `ok`, also where
/// the loss factor stops at a bound, and the true modulus is within its error bar. Of a loss factor that is known a bound binds.
#[test]
fn a_constant_is_known_though_its_loss_factor_is_not() {
    let case = plate(6, 0.4, 1e-2);
    let frequency_hz = linear_hz(100.0, 2500.0, 24);
    let identified = |eta: f64, noise: f64, bounds: [f64; 2]| {
        let factors = [c(1.8e11, 1.8e11 * eta), c(7400.0, 0.0)].map(Law::Constant);
        let exact = direct(&case.model, &case.experiment, &factors, &frequency_hz);
        let (measured, std) = noisy(&exact, noise, 5);
        let modulus = Unknown {
            bounds: Bounds { storage: Some([1e11, 3e11]), loss_factor: Some(bounds) },
            varies: Variation::Constant,
            ..Unknown::factor_of(&case.model, &["stiffness"]).unwrap()
        };
        let found = run(&Setup {
            model: &case.model,
            experiment: &case.experiment,
            unknowns: &[modulus, constant("density", Dependence::Factor(vec![1]), 7800.0, [5000.0, 10000.0])],
            frequency_hz: &frequency_hz,
            measured: &measured,
            noise: Noise::Known(&std),
        });
        let [storage, loss_factor] = found.constants[0].numbers.as_slice() else { panic!() };
        assert!((storage.value - 1.8e11).abs() < 3.0 * storage.std.unwrap(), "{storage:?}");
        let ok = found.lines.iter().filter(|line| line.status == Status::Ok).count();
        (found.constants[0].status, loss_factor.value, loss_factor.std.unwrap(), ok)
    };
    for bounds in [[0.0, 0.1], [0.0, 5e-4]] {
        let (status, eta, std, ok) = identified(1e-3, 0.1, bounds);
        assert!(std > 0.5 * eta, "{bounds:?}: {eta} {std}");
        assert!(status == Status::Ok && ok > 20, "{bounds:?}: {status:?}, {ok} of 24");
    }
    let (status, _, std, ok) = identified(2e-2, 0.01, [0.0, 1.5e-2]);
    assert!(status == Status::NoRoot && ok == 0, "{status:?}, {std}, {ok} of 24");
}

/// Of five sensors one measures half of what it should: it is named and left out, and the unknowns are right without it; kept, it
/// leaves the band unexplained. Without a fault no sensor is named.
#[test]
fn a_sensor_that_contradicts_the_others_is_named_and_left_out() {
    let plate = thickness();
    let mut experiment = plate.experiment.clone();
    experiment.sensors.push(Sensor { row: 45, sign: 1.0 });
    experiment.sensors.push(Sensor { row: 12, sign: 1.0 });
    let h = TRUE_THICKNESS;
    let factors = [c(2e11, 2e9) * h.powi(3), c(7800.0 * h, 0.0)].map(Law::Constant);
    let frequency_hz: Vec<f64> = plate.frequency_hz.iter().copied().step_by(of_tier(5, 2)).collect();
    let exact = direct(&plate.model, &experiment, &factors, &frequency_hz);
    let unknowns = [constant("h", Dependence::Powers(vec![(0, 3), (1, 1)]), 1.0, [0.5, 2.0])];
    let (measured, std) = noisy(&exact, 0.01, 21);
    let faulty: Vec<Vec<c64>> = measured
        .iter()
        .map(|row| row.iter().enumerate().map(|(m, u)| if m == 2 { 0.5 * u } else { *u }).collect())
        .collect();
    for noise in [Noise::Known(&std), Noise::Unknown] {
        let setup = Setup {
            model: &plate.model,
            experiment: &experiment,
            unknowns: &unknowns,
            frequency_hz: &frequency_hz,
            measured: &faulty,
            noise,
        };
        let found = run(&setup);
        let named: Vec<bool> = found.sensors.iter().map(|sensor| sensor.contradicts).collect();
        assert_eq!(named, [false, false, true, false, false], "{:?}", found.sensors);
        assert!(found.sensors[2].left_out && found.sensors[2].misfit.unwrap() > 5.0);
        let number = &found.constants[0].numbers[0];
        assert!(
            (number.value - h).abs() < 4.0 * number.std.unwrap() && number.std.unwrap() < 1e-3,
            "{number:?}"
        );
        assert!(found.constants[0].status == Status::Ok, "{:?}", found.fit);

        // By day each noise has one half of the rest.
        if is_long() || noise == Noise::Unknown {
            let right = run(&Setup { measured: &measured, ..setup });
            assert!(right.sensors.iter().all(|sensor| !sensor.contradicts), "{:?}", right.sensors);
        }
        if is_long() || noise != Noise::Unknown {
            // A dead one beside it.
            let dead = |(m, u): (usize, &c64)| if m == 4 { c64::default() } else { *u };
            let with_dead: Vec<Vec<c64>> =
                faulty.iter().map(|row| row.iter().enumerate().map(dead).collect()).collect();
            let found = run(&Setup { measured: &with_dead, ..setup });
            let named: Vec<[bool; 3]> = (found.sensors.iter())
                .map(|sensor| [sensor.contradicts, sensor.dead, sensor.left_out])
                .collect();
            assert_eq!(
                named[2..],
                [[true, false, true], [false; 3], [false, true, true]],
                "{:?}",
                found.sensors
            );
            let number = &found.constants[0].numbers[0];
            assert!((number.value - h).abs() < 4.0 * number.std.unwrap() && number.std.unwrap() < 1e-3);
        }

        // By day only where the noise is known, and more is asserted.
        if !is_long() && noise == Noise::Unknown {
            continue;
        }
        let Setup { model, experiment, unknowns, frequency_hz, .. } = setup;
        let frfs = Frfs { frequency_hz, receptance: &faulty, noise };
        let problem = Problem::new(model, experiment, unknowns, &[], frfs).unwrap();
        let options = Options::default().with_reject_outliers(false);
        let kept = identify(&problem, &options, CONTEXT).unwrap();
        assert!(kept.sensors[2].contradicts && !kept.sensors[2].left_out);
        if noise != Noise::Unknown {
            assert!(kept.lines.iter().all(|line| line.status != Status::Ok), "{:?}", kept.fit);
        }
    }
}
