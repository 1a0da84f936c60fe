//! Scales and delays of channels beside several unknowns, against models that are solved directly at known values.

use crate::common;
use crate::noise;
use crate::tier::of_tier;

use common::{Case, c, constant, plate, sandwich, term, two_part_chain};
use frfit::c64;
use frfit::for_each::sequential;
use frfit::frequency::{linear_hz, omega_rad_s};
use frfit::identify::{
    Calibrated, Calibration, ChannelUnknowns, Context, Dependence, Frfs, Identification, ModelErrors, Noise,
    NumberOf, Options, Problem, ProblemError, Status, Unknown, Variation, identify,
};
use frfit::laws::LawKind;
use frfit::material::{Law, Table};
use frfit::model::{DynamicStiffness, Experiment, Role, Sensor, Term};
use frfit::roots::Bounds;

const CONTEXT: Context<'static> = Context { for_each: &sequential, progress: &|_, _, _| {} };
const KNOWN: ChannelUnknowns = ChannelUnknowns { scale: false, delay: false };
const SCALE: ChannelUnknowns = ChannelUnknowns { scale: true, delay: false };
const BOTH: ChannelUnknowns = ChannelUnknowns { scale: true, delay: true };

/// A model, what is measured on it, and by which scale and delay each channel is off.
struct Test {
    model: DynamicStiffness,
    experiment: Experiment,
    unknowns: Vec<Unknown>,
    frequency_hz: Vec<f64>,
    exact: Vec<Vec<c64>>,
    /// (scale, delay in s) by which what was measured becomes the receptance.
    channels: Vec<(f64, f64)>,
}

impl Test {
    /// Measurements by direct solves with these factors in place of the terms' own.
    fn new(
        case: Case,
        unknowns: Vec<Unknown>,
        factors: &[Law],
        frequency_hz: Vec<f64>,
        channels: Vec<(f64, f64)>,
    ) -> Self {
        let terms = case.model.terms().iter().zip(factors);
        let terms = terms.map(|(term, factor)| Term { factor: factor.clone(), ..term.clone() }).collect();
        let (model, experiment) = (DynamicStiffness::new(terms).unwrap(), case.experiment);
        let one = |&f: &f64| {
            let factor = model.analysis().factor(&model.at(f, &[]).unwrap().assemble(&[])).unwrap();
            let mut x = experiment.load.clone();
            factor.solve(&mut x).unwrap();
            experiment.observe(&x)
        };
        let exact = frequency_hz.iter().map(one).collect();
        Self { model: case.model, experiment, unknowns, frequency_hz, exact, channels }
    }

    /// What the channels show, with circular noise of this part of it, and its standard deviation.
    fn drawn(&self, part: f64, noise: &mut noise::Noise) -> (Vec<Vec<c64>>, Vec<Vec<f64>>) {
        let mut one = |f: f64, x: c64, (scale, late): (f64, f64)| {
            let clean = x * c64::from_polar(1.0, -omega_rad_s(f) * late) / scale;
            let std = part * clean.norm();
            (clean + std / 2f64.sqrt() * noise.complex(), std)
        };
        let rows = self.exact.iter().zip(&self.frequency_hz);
        rows.map(|(x, &f)| x.iter().zip(&self.channels).map(|(x, &own)| one(f, *x, own)).unzip()).unzip()
    }

    fn problem<'p>(
        &'p self,
        unknown: &'p [ChannelUnknowns],
        receptance: &'p [Vec<c64>],
        noise: Noise<'p>,
    ) -> Result<Problem<'p>, ProblemError> {
        let frfs = Frfs { frequency_hz: &self.frequency_hz, receptance, noise };
        Problem::new(&self.model, &self.experiment, &self.unknowns, unknown, frfs)
    }

    /// From measurements without noise.
    fn exactly(&self, unknown: &[ChannelUnknowns]) -> Identification {
        let (measured, _) = self.drawn(0.0, &mut noise::Noise::new(1));
        identify(&self.problem(unknown, &measured, Noise::Unknown).unwrap(), &right_model(), CONTEXT).unwrap()
    }

    /// How far a calibration is off: of its scale relatively, and in radians at the top of the band.
    fn off(&self, found: &[Calibration], m: usize) -> [f64; 2] {
        let (scale, late) = self.channels[m];
        let top = omega_rad_s(*self.frequency_hz.last().unwrap());
        let scale = found[m].scale.map_or(0.0, |found| found.value / scale - 1.0);
        [scale, found[m].delay_s.map_or(0.0, |found| (found.value - late) * top)].map(f64::abs)
    }
}

fn modulus(name: &str, terms: Vec<usize>, nominal: Law, varies: Variation) -> Unknown {
    let dependence = Dependence::Factor(terms);
    Unknown { name: name.into(), dependence, nominal, varies, real: false, bounds: Bounds::default() }
}

/// A plate 10 % thicker and 17 % softer than its nominal values, whose mass is known; these channels.
fn thicker_plate(channels: Vec<(f64, f64)>) -> Test {
    let h: f64 = 1.1;
    let unknowns = vec![
        constant("h", Dependence::Powers(vec![(0, 3), (1, 1)]), 1.0, [0.5, 2.0]),
        modulus("E", vec![0], Law::Constant(c(2.4e11, 2.4e9)), Variation::Constant),
    ];
    let factors = [c(2e11, 2e9) * h.powi(3), c(7800.0 * h, 0.0)].map(Law::Constant);
    Test::new(plate(6, 0.27, 1e-2), unknowns, &factors, linear_hz(150.0, 900.0, 50), channels)
}

/// A sandwich measured by three sensors, both its moduli unknown.
fn sandwich_with(skins: Variation, core: Variation, channels: Vec<(f64, f64)>) -> Test {
    let mut case = sandwich(10, 2);
    let last = case.experiment.sensors[0].row;
    case.experiment.sensors.push(Sensor { row: last / 3, sign: 1.0 });
    let [nominal_skins, nominal_core] = [0, 1].map(|term| case.model.terms()[term].factor.clone());
    let unknowns =
        vec![modulus("skins", vec![0], nominal_skins, skins), modulus("core", vec![1], nominal_core, core)];
    let factors = [
        Law::Constant(c(6.2e10, 6.2e8)),
        Law::Fractional { e0: 8.14e5, e1: 7.31e4, alpha: 0.528 },
        Law::Constant(c(2700.0, 0.0)),
        Law::Constant(c(910.0, 0.0)),
    ];
    Test::new(case, unknowns, &factors, linear_hz(20.0, 1000.0, of_tier(24, 40)), channels)
}

/// What was measured of a band without noise is found to what is left of the reduced model: 1e-9 of the response.
const EXACT: f64 = 1e-6;

/// Thickness and modulus beside one calibrated channel; nothing is factorised for the other one.
#[test]
fn constants_beside_a_calibrated_channel() {
    let test = thicker_plate(vec![(1.0, 0.0), (-0.02, 2.3e-3)]);
    let found = test.exactly(&[KNOWN, BOTH]);
    assert!((found.constants[0].numbers[0].value - 1.1).abs() < EXACT, "{:?}", found.constants);
    assert!((found.constants[1].numbers[0].value / 2e11 - 1.0).abs() < EXACT, "{:?}", found.constants);
    assert!(found.constants.iter().all(|value| value.status == Status::Ok), "{:?}", found.constants);
    assert!(found.lines.iter().all(|line| line.status == Status::Ok));
    assert_eq!(found.channels[0], Calibration::default());
    assert!(test.off(&found.channels, 1).iter().all(|off| *off < EXACT), "{:?}", found.channels);
    let calibrated = thicker_plate(vec![(1.0, 0.0); 2]).exactly(&[]);
    assert_eq!(found.search.work.factorisations, calibrated.search.work.factorisations);
    // h, both numbers of E, then those of the channel.
    let coordinates = found.identifiability.coordinates.iter();
    let names: Vec<_> = coordinates.map(|one| (one.of, one.number.as_str())).collect();
    assert_eq!(names[3..], [(NumberOf::Channel(1), "scale"), (NumberOf::Channel(1), "delay_s")]);
    assert_eq!(found.identifiability.correlation.len(), 5);
}

/// No channel is calibrated: resonances show the thickness, the known mass per thickness shows every size.
#[test]
fn a_constant_without_a_calibrated_channel() {
    let mut test = thicker_plate(vec![(-40.0, 2.3e-3), (0.02, -0.6e-3)]);
    test.unknowns.truncate(1);
    let found = test.exactly(&[BOTH, BOTH]);
    assert!((found.constants[0].numbers[0].value - 1.1).abs() < EXACT, "{:?}", found.constants);
    for m in 0..2 {
        assert!(test.off(&found.channels, m).iter().all(|off| *off < EXACT), "{:?}", found.channels);
    }
}

/// What noise does where the model is right.
fn right_model() -> Options {
    Options::default().with_model_errors(ModelErrors::None)
}

/// A mass of a millionth of the structure's is all that is known of its size: scales, thickness and modulus are not identifiable.
#[test]
fn a_scale_beside_a_free_stiffness_and_mass_is_not_identifiable() {
    let mut test = thicker_plate(vec![(2.0, 0.0), (0.5, 0.0)]);
    let terms = test.model.terms().to_vec();
    let small = term("paint", Role::Mass, terms[1].matrix.clone(), c(7800.0 * 1e-9, 0.0));
    test.model = DynamicStiffness::new(terms.into_iter().chain([small]).collect()).unwrap();
    let (measured, std) = test.drawn(0.01, &mut noise::Noise::new(3));
    let unknown = [SCALE, SCALE];
    let problem = test.problem(&unknown, &measured, Noise::Known(&std)).unwrap();
    let found = identify(&problem, &right_model(), CONTEXT).unwrap();
    assert!(
        found.constants.iter().all(|value| value.status == Status::NotIdentifiable),
        "{:?}",
        found.constants
    );
    for channel in &found.channels {
        let scale = channel.scale.unwrap();
        assert!(scale.std.unwrap() > scale.value.abs(), "{:?}", found.channels);
    }
    // Without the paint nothing at all is known of the size, and the problem says so.
    let bare = thicker_plate(vec![(2.0, 0.0), (0.5, 0.0)]);
    let refused = bare.problem(&unknown, &measured, Noise::Known(&std)).unwrap_err().to_string();
    assert!(refused.contains("the unknowns scale the whole model"), "{refused}");
    // One channel of known scale is enough.
    let delays = ChannelUnknowns { scale: false, delay: true };
    assert!(bare.problem(&[SCALE, delays], &measured, Noise::Known(&std)).is_ok());
}

/// A modulus at each frequency and a constant thickness beside two of three channels of unknown scale and delay.
#[test]
fn a_modulus_at_each_frequency_beside_channels() {
    let mut case = plate(6, 0.27, 1e-2);
    case.experiment.sensors.push(Sensor { row: 30, sign: 1.0 });
    let modulus_of = |f: f64| c(2e11, 2e9) * (1.0 + 2e-4 * f);
    let frequency_hz = linear_hz(150.0, 900.0, 30);
    let h: f64 = 1.1;
    let values = frequency_hz.iter().map(|&f| modulus_of(f) * h.powi(3)).collect();
    let table = Law::Table(Table::new(frequency_hz.clone(), values).unwrap());
    let mut unknowns = thicker_plate(Vec::new()).unknowns;
    unknowns[1].varies = Variation::PerFrequency;
    let channels = vec![(1.0, 0.0), (-3.0, 1.2e-3), (0.1, -4e-4)];
    let test = Test::new(case, unknowns, &[table, Law::Constant(c(7800.0 * h, 0.0))], frequency_hz, channels);
    let found = test.exactly(&[KNOWN, BOTH, BOTH]);
    for m in [1, 2] {
        assert!(test.off(&found.channels, m).iter().all(|off| *off < EXACT), "{:?}", found.channels);
    }
    assert!((found.constants[0].numbers[0].value / h - 1.0).abs() < EXACT, "{:?}", found.constants);
    for line in &found.lines {
        let exact = modulus_of(line.frequency_hz);
        let off = (line.values[1].value.unwrap() - exact).norm() / exact.norm();
        assert!(line.status == Status::Ok && off < 10.0 * EXACT, "{line:?}");
    }
    // Three complex measurements and one complex modulus at each frequency, the thickness, and four numbers of channels.
    assert_eq!(found.fit.unwrap().freedom, 2 * 3 * 30 - 2 * 30 - 1 - 4);
}

/// Two moduli at each frequency: two calibrated sensors are as many equations, and the third one's scale is found with them.
#[test]
fn two_moduli_at_each_frequency_beside_a_scale() {
    let bounds = Bounds { storage: Some([0.4, 2.5]), loss_factor: Some([0.0, 0.3]) };
    let half = |name: &str, term| {
        let nominal = Law::Constant(c(1.0, 0.03));
        Unknown { bounds, ..modulus(name, vec![term], nominal, Variation::PerFrequency) }
    };
    let unknowns = vec![half("first", 0), half("second", 1)];
    let truth = [c(1.2, 0.036), c(0.8, 0.024)];
    let factors = [truth[0], truth[1], c(1.0, 0.0)].map(Law::Constant);
    let channels = vec![(1.0, 0.0), (1.0, 0.0), (-3.0, 0.0)];
    let test = Test::new(two_part_chain(12), unknowns, &factors, linear_hz(0.1, 0.18, 10), channels);
    let found = test.exactly(&[KNOWN, KNOWN, SCALE]);
    assert!(test.off(&found.channels, 2)[0] < EXACT, "{:?}", found.channels);
    for line in &found.lines {
        let off = |j: usize| line.values[j].value.map(|value| (value - truth[j]).norm() / truth[j].norm());
        let is_right = (0..2).all(|j| off(j).is_some_and(|off| off < 10.0 * EXACT));
        assert!(is_right && line.status == Status::Ok, "{line:?}");
    }

    let (measured, std) = test.drawn(0.01, &mut noise::Noise::new(1));
    let refused = test.problem(&[SCALE; 3], &measured, Noise::Known(&std)).unwrap_err().to_string();
    assert!(refused.contains("a free value at each frequency explains every scale"), "{refused}");
}

/// Three unknowns, a law among them, and no calibrated channel, against noise that is drawn: all error bars cover what they should.
#[test]
fn error_bars_of_channels_and_three_unknowns_cover_the_truth() {
    let channels = vec![(-3.0, 1.2e-3), (0.1, -4e-4), (5.0, 0.0)];
    let law = Variation::law(LawKind::Fractional);
    let mut test = sandwich_with(Variation::Constant, law, channels);
    test.unknowns.push(constant("core-mass", Dependence::Factor(vec![3]), 700.0, [300.0, 2000.0]));
    let unknown = [BOTH, BOTH, SCALE];
    let truth = [6.2e10, 0.01, 8.14e5, 7.31e4, 0.528, 910.0];
    let draws = of_tier(1, 20);
    let (mut noise, mut pulls) = (noise::Noise::new(17), Vec::new());
    for _ in 0..draws {
        let (measured, std) = test.drawn(0.01, &mut noise);
        let problem = test.problem(&unknown, &measured, Noise::Known(&std)).unwrap();
        let found = identify(&problem, &right_model(), CONTEXT).unwrap();
        let fit = found.fit.unwrap();
        assert_eq!(fit.freedom, 2 * 3 * test.frequency_hz.len() - 6 - 5);
        assert!(fit.deviate.abs() < 4.0, "{fit:?}");
        let numbers = found.constants.iter().flat_map(|value| &value.numbers);
        pulls.extend(numbers.zip(truth).map(|(found, truth)| (found.value - truth) / found.std.unwrap()));
        for (found, (scale, late)) in found.channels.iter().zip(&test.channels) {
            let off = |found: Option<Calibrated>, truth| {
                found.map(|found| (found.value - truth) / found.std.unwrap())
            };
            pulls.extend(off(found.scale, *scale));
            pulls.extend(off(found.delay_s, *late));
        }
    }
    assert_eq!(pulls.len(), 11 * draws);
    // 4.5 standard deviations once in 150,000. Pulls of one draw are correlated, so that the mean square of draws has its standard deviation, √2 at most for each, over √draws.
    assert!(pulls.iter().all(|pull| pull.abs() < 4.5), "{pulls:?}");
    let mean_square = pulls.iter().map(|pull| pull * pull).sum::<f64>() / pulls.len() as f64;
    assert!(
        draws < 20 || (mean_square - 1.0).abs() < 4.0 * (2.0 / draws as f64).sqrt() / 2.0,
        "{mean_square}"
    );
}
