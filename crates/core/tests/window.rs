//! The exponential window of an impact test: what the transform of windowed records is, and that every way through the model says the same.

use crate::common;

use common::{Case, bar, c, plate, structure, term, tip_load};
use frfit::c64;
use frfit::diagnostics::diagnose;
use frfit::for_each::sequential;
use frfit::frequency::{laplace_per_s, linear_hz, omega_rad_s};
use frfit::identify::{
    Context, Dependence, Frfs, Identification, Line, ModelErrors, Noise, Options, Problem, Reduction, Status,
    Unknown, Variation, identify,
};
use frfit::laws::LawKind;
use frfit::material::{Law, loss_factor};
use frfit::model::{DynamicStiffness, Experiment, Role, Term};
use frfit::quantity::Quantity;
use frfit::roots::Bounds;
use frfit::sensitivity::{SensitivityBand, Variable, change_points};
use frfit::subspace::{ChangeOptions, Subspace, TrainOptions};
use frfit_fem::{Bar, Support};
use frfit_linalg::sparse::Triplets;
use proptest::prelude::*;
use std::f64::consts::PI;

const CONTEXT: Context<'static> = Context { for_each: &sequential, progress: &|_, _, _| {} };

/// A mode: what it adds to the receptance is residue · e^{−δt} sin(ω_d t)/ω_d.
#[derive(Clone, Copy)]
struct Mode {
    residue: f64,
    decay_per_s: f64,
    omega_d: f64,
}

impl Mode {
    fn new(residue: f64, omega: f64, decay_per_s: f64) -> Self {
        Self { residue, decay_per_s, omega_d: (omega * omega - decay_per_s * decay_per_s).sqrt() }
    }

    fn at(self, t: f64) -> f64 {
        self.residue * (-self.decay_per_s * t).exp() * (self.omega_d * t).sin() / self.omega_d
    }
}

const STEP_S: f64 = 2e-5;
const SAMPLES: usize = 400_000;

/// Σ x(t) e^{−αt} e^{−iωt} Δt of the record: the transform of the windowed response over that of the windowed force, a unit impulse at t = 0.
///
/// The trapezoidal rule is off by Δt² x′(0)/12 (Euler and Maclaurin), x′(0) the sum of the residues: taken out, what is left is of Δt⁴.
fn transformed(modes: &[Mode], window_per_s: f64, frequency_hz: f64) -> c64 {
    let turn = c64::from_polar(1.0, -omega_rad_s(frequency_hz) * STEP_S);
    let (mut phase, mut sum) = (c(1.0, 0.0), c(0.0, 0.0));
    for k in 0..SAMPLES {
        let t = k as f64 * STEP_S;
        let x: f64 = modes.iter().map(|mode| mode.at(t)).sum();
        // From the angle itself now and then: a product of 400,000 turns would have lost digits.
        if k % 256 == 0 {
            phase = c64::from_polar(1.0, -omega_rad_s(frequency_hz) * t);
        }
        sum += x * (-window_per_s * t).exp() * phase;
        phase *= turn;
    }
    let slope: f64 = modes.iter().map(|mode| mode.residue).sum();
    sum * STEP_S + STEP_S * STEP_S / 12.0 * slope
}

fn solved(model: &DynamicStiffness, experiment: &Experiment, f: f64) -> Vec<c64> {
    let factor = model.analysis().factor(&model.at(f, &[]).unwrap().assemble(&[])).unwrap();
    let mut x = experiment.load.clone();
    factor.solve(&mut x).unwrap();
    experiment.observe(&x)
}

/// Closed forms of the impulse response, windowed and transformed, against the model at ω − iα: it shows the sign, for the model at ω + iα is far off.
fn is_transformed(model: DynamicStiffness, experiment: &Experiment, modes: &[Vec<Mode>], hz: &[f64]) {
    for window_per_s in [0.0, 6.0] {
        let model = model.clone().with_decay_per_s(window_per_s);
        let other = model.clone().with_decay_per_s(-window_per_s);
        let mut farthest = 0.0_f64;
        for &f in hz {
            let (found, wrong) = (solved(&model, experiment, f), solved(&other, experiment, f));
            for (m, modes) in modes.iter().enumerate() {
                let measured = transformed(modes, window_per_s, f);
                // Δt⁴ ω⁴ of the rule and e^{−12} · e^{−8α} of what the record cuts off without a window.
                let tolerance = if window_per_s == 0.0 { 1e-4 } else { 1e-9 };
                let off = (found[m] - measured).norm() / measured.norm();
                assert!(off < tolerance, "{window_per_s}/s, {f} Hz, sensor {m}: {off:e}");
                farthest = farthest.max((wrong[m] - measured).norm() / measured.norm());
            }
        }
        assert!(window_per_s == 0.0 || farthest > 1.0, "the other sign is off by {farthest}");
    }
}

fn diagonal(values: &[f64]) -> Triplets {
    let mut matrix = Triplets::new(values.len());
    values.iter().enumerate().for_each(|(i, &value)| matrix.add(i, i, value));
    matrix
}

#[test]
fn a_windowed_oscillator_is_the_model_at_the_complex_frequency() {
    let (m, k, d) = (2.0, 2.0 * (2.0 * PI * 10.0_f64).powi(2), 6.0);
    let model = DynamicStiffness::new(vec![
        term("spring", Role::Stiffness, diagonal(&[1.0]).assemble(), c(k, 0.0)),
        term("dashpot", Role::Viscous, diagonal(&[1.0]).assemble(), c(d, 0.0)),
        term("mass", Role::Mass, diagonal(&[1.0]).assemble(), c(m, 0.0)),
    ])
    .unwrap();
    let experiment = tip_load(&model, &[0]);
    let modes = vec![vec![Mode::new(1.0 / m, (k / m).sqrt(), d / (2.0 * m))]];
    is_transformed(model, &experiment, &modes, &[0.0, 3.0, 9.5, 10.0, 10.3, 25.0, 60.0]);
}

/// Three masses between walls: K = k tridiag(−1, 2, −1), M = m 1, C = a M + b K, with the modes sin(jπr/4) in closed form.
#[test]
fn a_windowed_chain_with_viscous_damping_is_the_model_at_the_complex_frequency() {
    let (m, k, a, b) = (0.5, 4000.0, 3.0, 2e-4);
    let mut springs = diagonal(&[2.0; 3]);
    let mut dampers = diagonal(&[a * m + 2.0 * b * k; 3]);
    for i in 0..2 {
        springs.add(i + 1, i, -1.0);
        dampers.add(i + 1, i, -b * k);
    }
    let model = DynamicStiffness::new(vec![
        term("springs", Role::Stiffness, springs.assemble(), c(k, 0.0)),
        term("dampers", Role::Viscous, dampers.assemble(), c(1.0, 0.0)),
        term("masses", Role::Mass, diagonal(&[1.0; 3]).assemble(), c(m, 0.0)),
    ])
    .unwrap();
    let experiment = tip_load(&model, &[0, 2]);
    let modes_at = |row: usize| -> Vec<Mode> {
        let mode = |j: usize| {
            let shape = |row: usize| ((j * (row + 1)) as f64 * PI / 4.0).sin() / 2f64.sqrt();
            let squared = k / m * (2.0 - 2.0 * (j as f64 * PI / 4.0).cos());
            Mode::new(shape(row) * shape(2) / m, squared.sqrt(), 0.5 * (a + b * squared))
        };
        (1..=3).map(mode).collect()
    };
    // Natural frequencies 10.9, 20.1 and 26.3 Hz.
    is_transformed(model, &experiment, &[modes_at(0), modes_at(2)], &[2.0, 10.9, 15.0, 20.1, 26.3, 50.0]);
}

/// A s^p, whose loss factor tan(pπ/2) is the same at all frequencies, with the size and the loss factor of a constant modulus at iω.
fn power_law(modulus: c64, s: c64) -> c64 {
    let p = loss_factor(modulus).atan() / (0.5 * PI);
    let size = modulus.norm() * (s.norm() / s.im).powf(p);
    c64::from_polar(size, p * (s.im / s.re).atan())
}

/// The model at one frequency with s and s² as factors of stiffnesses: nothing in it knows of windows.
fn by_hand(model: &DynamicStiffness, experiment: &Experiment, decay_per_s: f64, f: f64) -> Vec<c64> {
    by_hand_with(model, experiment, decay_per_s, f, &|term, s| match term.role {
        Role::Stiffness => power_law(term.factor.at(f).unwrap(), s),
        _ => term.factor.at(f).unwrap(),
    })
}

/// The same with the factors of an own function of s.
fn by_hand_with(
    model: &DynamicStiffness,
    experiment: &Experiment,
    decay_per_s: f64,
    f: f64,
    factor_at: &dyn Fn(&Term, c64) -> c64,
) -> Vec<c64> {
    let s = c(decay_per_s, 2.0 * PI * f);
    let terms = model.terms().iter().map(|term| {
        let by = match term.role {
            Role::Stiffness => c(1.0, 0.0),
            Role::Viscous => s,
            Role::Mass => s * s,
        };
        let factor = Law::Constant(by * factor_at(term, s));
        Term { role: Role::Stiffness, factor, ..term.clone() }
    });
    solved(&DynamicStiffness::new(terms.collect()).unwrap(), experiment, f)
}

/// A bar of one percent loss with a viscous damper at its driven end.
fn damped_bar() -> Case {
    let fixed = [Support::Clamped, Support::Free];
    let bar =
        Bar { length: 1.0, area: 1e-4, elements: 30, ends: fixed, ..Bar::default() }.assemble().unwrap();
    let experiment = tip_load(
        &DynamicStiffness::new(vec![term("k", Role::Stiffness, bar.stiffness[0].clone(), c(1.0, 0.0))])
            .unwrap(),
        &[9, 29],
    );
    let case = structure("bar", &bar, [c(1e7, 1e5), c(1000.0, 0.0)], experiment, [15.0, 200.0]);
    let mut terms = case.model.terms().to_vec();
    let mut damper = Triplets::new(bar.dofs.len());
    damper.add(29, 29, 1.0);
    terms.push(term("damper", Role::Viscous, damper.assemble(), c(0.5, 0.0)));
    Case { model: DynamicStiffness::new(terms).unwrap(), ..case }
}

const DECAY: f64 = 6.0;

fn windowed(case: Case) -> Case {
    Case { model: case.model.with_decay_per_s(DECAY), ..case }
}

#[test]
fn full_and_reduced_model_and_their_derivatives_are_those_of_the_complex_frequency() {
    for case in [windowed(damped_bar()), windowed(plate(4, 0.4, 1e-2))] {
        let (subspace, trained) = case.trained(1e-9);
        assert!(trained.converged, "{}", case.name);
        for (f, ratio) in case.scattered(20) {
            // The nominal value is that at s too.
            let correction = (ratio - 1.0) * case.at(f).parameters[0].nominal;
            let mut terms = case.model.terms().to_vec();
            terms[0].factor = terms[0].factor.scaled(ratio);
            let model = DynamicStiffness::new(terms).unwrap();
            let exact = by_hand(&model, &case.experiment, DECAY, f);
            let full = case.direct(f, correction).unwrap();
            let reduced = subspace.projection().assess(&case.at(f), correction).unwrap().response;
            for m in 0..exact.len() {
                // Roundoff; the error that was asked for.
                assert!((full[m] - exact[m]).norm() < 1e-10 * exact[m].norm());
                assert!((reduced[m] - exact[m]).norm() < 1e-6 * exact[m].norm(), "{f} Hz");
            }
        }
        let frequency_hz = linear_hz(case.band_hz[0], case.band_hz[1], 7);
        let variables = Variable::of_model(&case.model, &frequency_hz).unwrap();
        let points = change_points(&case.model, &variables, &frequency_hz).unwrap();
        let options = ChangeOptions::default();
        let band =
            SensitivityBand::new(&case.experiment, &variables, &points, &options, &sequential).unwrap();
        for (i, &f) in frequency_hz.iter().enumerate() {
            for (p, variable) in variables.iter().enumerate() {
                let Some(term) = case.model.terms().iter().position(|term| term.name == variable.name) else {
                    continue;
                };
                let step = 1e-5;
                let moved = |by: f64| {
                    let mut terms = case.model.terms().to_vec();
                    terms[term].factor = terms[term].factor.scaled(by);
                    by_hand(&DynamicStiffness::new(terms).unwrap(), &case.experiment, DECAY, f)
                };
                let (more, less) = (moved(1.0 + step), moved(1.0 - step));
                let changed = band.at()[i].as_ref().unwrap();
                for m in 0..more.len() {
                    let difference = (more[m] - less[m]) / (2.0 * step);
                    let (found, x) = (changed.slopes[p][m], changed.response[m]);
                    // Third derivatives of 100 at a resonance of 1 % with steps of 1e-5.
                    let size = found.norm().max(x.norm());
                    assert!((found - difference).norm() < 1e-5 * size, "{f} Hz, {}, {m}", variable.name);
                }
            }
        }
    }
}

fn found(
    model: &DynamicStiffness,
    experiment: &Experiment,
    unknowns: &[Unknown],
    (frequency_hz, measured): (&[f64], &[Vec<c64>]),
    options: &Options,
) -> Identification {
    let frfs = Frfs { frequency_hz, receptance: measured, noise: Noise::Unknown };
    identify(&Problem::new(model, experiment, unknowns, &[], frfs).unwrap(), options, CONTEXT).unwrap()
}

/// Windowed responses say η if the model knows of the window, and far more if it does not. Every way to find it is tried.
#[test]
fn the_loss_factor_is_found_from_windowed_responses_in_every_way() {
    let case = damped_bar();
    let frequency_hz = linear_hz(15.0, 200.0, 60);
    let measured: Vec<Vec<c64>> =
        frequency_hz.iter().map(|&f| by_hand(&case.model, &case.experiment, DECAY, f)).collect();
    let mut model = windowed(case).model;
    let experiment = damped_bar().experiment;
    let mut terms = model.terms().to_vec();
    terms[0].factor = Law::complex_modulus(1.2e7, 0.02);
    model = DynamicStiffness::new(terms).unwrap().with_decay_per_s(DECAY);
    let unknown = |varies| {
        let bounds = Bounds { storage: Some([5e6, 2e7]), loss_factor: Some([0.0, 0.3]) };
        Unknown { varies, bounds, ..Unknown::factor_of(&model, &["stiffness"]).unwrap() }
    };
    let data = (&frequency_hz[..], &measured[..]);
    let exact = |value: c64, within: f64| {
        (value - c(1e7, 1e5)).norm() < within * 1e7 && (loss_factor(value) - 0.01).abs() < within
    };
    let full = Options::default().with_reduction(Reduction::Full);
    for (varies, options) in [
        (Variation::PerFrequency, Options::default()),
        (Variation::PerFrequency, full),
        (Variation::Smooth, Options::default()),
        (Variation::law(LawKind::Constant), Options::default()),
    ] {
        let found = found(&model, &experiment, &[unknown(varies.clone())], data, &options);
        let ok: Vec<c64> =
            found.lines.iter().filter(|l| l.status == Status::Ok).filter_map(|l| l.factor()).collect();
        assert!(ok.len() > 55, "{varies:?}: {}", ok.len());
        assert!(ok.iter().all(|&value| exact(value, 1e-6)), "{varies:?}");
    }
    // Two unknowns in one least squares.
    let density = Unknown {
        name: "density".into(),
        dependence: Dependence::Factor(vec![1]),
        nominal: Law::Constant(c(1080.0, 0.0)),
        varies: Variation::Constant,
        real: true,
        bounds: Bounds { storage: Some([800.0, 1300.0]), loss_factor: None },
    };
    let modulus = unknown(Variation::Constant);
    let both = found(&model, &experiment, &[modulus, density], data, &Options::default());
    let of_band: Vec<c64> = (0..2).map(|j| both.constants[j].law.at(100.0).unwrap()).collect();
    assert!(exact(of_band[0], 1e-6) && (of_band[1].re - 1000.0).abs() < 1e-3, "{of_band:?}");
    // And without the decay in the model: η = 0.01 becomes 0.01 + 2α/ω, 0.137 at 15 Hz.
    let without = model.clone().with_decay_per_s(0.0);
    // Errors of the damping of modes would take most of that up.
    let as_it_is = Options::default().with_model_errors(ModelErrors::None);
    let wrong = found(&without, &experiment, &[unknown(Variation::PerFrequency)], data, &as_it_is);
    let farthest = wrong.lines.iter().filter_map(|line| Some((line.frequency_hz, line.loss_factor()?)));
    let farthest = farthest.max_by(|a, b| a.1.total_cmp(&b.1)).unwrap();
    assert!(farthest.1 > 0.05, "{farthest:?}");
    // Nothing is wrong with these data, in any quantity, if the model knows of the window.
    let unknowns = [unknown(Variation::PerFrequency)];
    for quantity in Quantity::ALL {
        let frfs = Frfs { frequency_hz: data.0, receptance: data.1, noise: Noise::Unknown };
        let problem = Problem::new(&model, &experiment, &unknowns, &[], frfs).unwrap();
        let diagnosis = diagnose(&problem, &[quantity; 2], &Options::default(), &sequential).unwrap();
        assert!(diagnosis.findings.is_empty(), "{quantity}: {:?}", diagnosis.findings);
        // No misfit is taken to be smaller.
        assert!(diagnosis.misfit.unwrap() <= 0.01, "{quantity}: {:?}", diagnosis.misfit);
    }
}

/// The modulus of a material that relaxes is seen at s. A law is found as it is; what has a value at each frequency is known but for (α/ω)².
#[test]
fn the_modulus_is_that_at_real_frequencies() {
    let case = damped_bar();
    let frequency_hz = linear_hz(15.0, 200.0, 60);
    // E₀ + E₁ s^α is written out.
    let (e0, e1, alpha) = (6e6, 2e5, 0.4);
    let modulus = |s: c64| e0 + e1 * (alpha * s.ln()).exp();
    let factor_at = |term: &Term, s: c64| match term.role {
        Role::Stiffness => modulus(s),
        _ => term.factor.at(100.0).unwrap(),
    };
    let seen = |&f: &f64| by_hand_with(&case.model, &case.experiment, DECAY, f, &factor_at);
    let measured: Vec<Vec<c64>> = frequency_hz.iter().map(seen).collect();
    let model = case.model.clone().with_decay_per_s(DECAY);
    let off = |lines: &[Line]| {
        let of_line = |line: &Line| {
            let exact = modulus(c(0.0, omega_rad_s(line.frequency_hz)));
            Some((line.factor()? - exact).norm() / exact.norm())
        };
        lines
            .iter()
            .filter(|line| line.status == Status::Ok)
            .map(|line| of_line(line).unwrap())
            .fold(0.0, f64::max)
    };
    // (α/ω)² is 0.004 at 15 Hz.
    for (varies, within) in [
        (Variation::PerFrequency, 4e-3),
        (Variation::Smooth, 4e-3),
        (Variation::law(LawKind::Fractional), 1e-6),
    ] {
        let bounds = Bounds { storage: Some([5e6, 2e7]), loss_factor: Some([0.0, 0.9]) };
        let unknown = Unknown { varies, bounds, ..Unknown::factor_of(&model, &["stiffness"]).unwrap() };
        let unknowns = [unknown];
        let data = (&frequency_hz[..], &measured[..]);
        let found = found(&model, &case.experiment, &unknowns, data, &Options::default());
        assert!(found.count(Status::Ok) > 55, "{:?}", unknowns[0].varies);
        assert!(off(&found.lines) < within, "{:?}: {:e}", unknowns[0].varies, off(&found.lines));
        for fit in &found.laws {
            let [at_f, exact] = [fit.at(50.0).unwrap().modulus, fit.law.at(50.0).unwrap()];
            assert!((at_f - exact).norm() < 1e-12 * exact.norm());
        }
    }
}

/// Weights without a window are those of e^{+iωt} bit for bit, the sign of zeros included, and a model of no decay is the model.
#[test]
fn no_decay_changes_nothing() {
    let bits = |x: c64| [x.re.to_bits(), x.im.to_bits()];
    for f in [0.0, 1e-3, 17.3, 4000.0] {
        let omega = omega_rad_s(f);
        let plain = [c(1.0, 0.0), c(0.0, omega), c(-omega * omega, 0.0)];
        for ((role, quantity), plain) in
            [Role::Stiffness, Role::Viscous, Role::Mass].into_iter().zip(Quantity::ALL).zip(plain)
        {
            assert_eq!(bits(role.weight(f, 0.0)), bits(plain));
            assert_eq!(bits(quantity.over_receptance(f)), bits(plain));
            assert_eq!(bits(quantity.over_receptance_windowed(f, 0.0)), bits(plain));
        }
    }
    let case = bar(12);
    let same = case.model.clone().with_decay_per_s(0.0);
    assert_eq!(same.decay_per_s(), 0.0);
    let parameter = std::slice::from_ref(&case.parameter);
    for f in [20.0, 333.0] {
        let (a, b) = (case.model.at(f, parameter).unwrap(), same.at(f, parameter).unwrap());
        assert_eq!((a.nominal, a.parameters), (b.nominal, b.parameters));
    }
}

proptest! {
    /// s = iω + α, and s² as its product, to roundoff.
    #[test]
    fn weights_are_powers_of_the_laplace_variable(f in 0.0..1e4_f64, decay in 0.0..100.0_f64) {
        let s = laplace_per_s(f, decay);
        prop_assert_eq!(s, c64::i() * c(omega_rad_s(f), -decay));
        prop_assert_eq!(Role::Viscous.weight(f, decay), s);
        prop_assert!((Role::Mass.weight(f, decay) - s * s).norm() <= 1e-15 * s.norm_sqr());
    }
}

#[test]
fn the_subspace_of_a_window_needs_no_more_factorisations() {
    // The stand-in S = Re K + σ Re M is real as ever: what is complex in the weights is not in it.
    let plain = damped_bar();
    let window = windowed(damped_bar());
    let work = |case: &Case| {
        let mut subspace = Subspace::new(&case.experiment, &case.at(case.band_hz[1])).unwrap();
        subspace.train(&case.grid(40, 5), &TrainOptions::default(), &sequential).unwrap();
        subspace.work()
    };
    let (plain, window) = (work(&plain), work(&window));
    assert_eq!(plain.factorisations, window.factorisations);
    assert!(window.solves <= plain.solves + 8, "{window:?} and {plain:?}");
}
