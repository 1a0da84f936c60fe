//! Scales and delays of channels on structures with many modes, and their error bars against noise that is drawn.

use crate::common;
use crate::noise;
use crate::tier::of_tier;

use common::{Band, Case, Setup, bar, c, plate};
use frfit::c64;
use frfit::for_each::sequential;
use frfit::frequency::{linear_hz, omega_rad_s};
use frfit::identify::{
    Calibrated, Calibration, ChannelUnknowns, Context, ModelErrors, Noise, Stage, Status, Variation,
};
use frfit::laws::LawKind;
use frfit::material::Law;
use frfit::roots::Bounds;

const BOTH: ChannelUnknowns = ChannelUnknowns { scale: true, delay: true };
const NEITHER: ChannelUnknowns = ChannelUnknowns { scale: false, delay: false };

/// A structure whose true modulus is constant, and what was measured on it: each channel with its own calibration, noise in proportion to the response.
struct Test {
    case: Case,
    truth: c64,
    frequency_hz: Vec<f64>,
    exact: Vec<Vec<c64>>,
    /// (scale, delay in s) by which what was measured becomes the receptance.
    channels: Vec<(f64, f64)>,
    share: f64,
}

/// What was measured, and its standard deviations.
type Values = (Vec<Vec<c64>>, Vec<Vec<f64>>);

impl Test {
    fn new(case: Case, truth: c64, frequency_hz: Vec<f64>, channels: Vec<(f64, f64)>, share: f64) -> Self {
        let nominal = |f: f64| case.parameter.nominal.at(f).unwrap();
        let exact = frequency_hz.iter().map(|&f| case.direct(f, truth - nominal(f)).unwrap()).collect();
        Self { case, truth, frequency_hz, exact, channels, share }
    }

    fn drawn(&self, noise: &mut noise::Noise) -> Values {
        let one = |f: f64, x: c64, (scale, late): (f64, f64), dice: c64| {
            let clean = x * c64::from_polar(1.0, -omega_rad_s(f) * late) / scale;
            (clean + self.share * clean.norm() / 2f64.sqrt() * dice, self.share * clean.norm())
        };
        let row = |(x, &f): (&Vec<c64>, &f64)| {
            x.iter().zip(&self.channels).map(|(x, &own)| one(f, *x, own, noise.complex())).unzip()
        };
        self.exact.iter().zip(&self.frequency_hz).map(row).unzip()
    }

    fn band<'b>(&'b self, (measured, std): &'b Values) -> Band<'b> {
        Band {
            model: &self.case.model,
            experiment: &self.case.experiment,
            parameter: &self.case.parameter,
            frequency_hz: &self.frequency_hz,
            measured,
            noise: Noise::Known(std),
        }
    }

    /// How many standard deviations each number that was looked for is off.
    fn pulls(&self, found: &[Calibration], unknown: &[ChannelUnknowns]) -> Vec<f64> {
        let mut pulls = Vec::new();
        for ((found, unknown), &(scale, late)) in found.iter().zip(unknown).zip(&self.channels) {
            assert_eq!([found.scale.is_some(), found.delay_s.is_some()], [unknown.scale, unknown.delay]);
            let off = |found: Option<Calibrated>, truth: f64| Some((found?.value - truth) / found?.std?);
            pulls.extend(off(found.scale, scale));
            pulls.extend(off(found.delay_s, late));
        }
        pulls
    }

    fn setup(&self) -> Setup {
        let bounds = Bounds { storage: Some([self.truth.re / 4.0, 4.0 * self.truth.re]), loss_factor: None };
        // What noise does where the model is right.
        Setup::within(bounds).with_model_errors(ModelErrors::None)
    }
}

fn context() -> Context<'static> {
    Context { for_each: &sequential, progress: &|_: Stage, _, _| {} }
}

/// Normal numbers: their mean square within four of its own standard deviations √(2/n) of one, and none that is beyond chance.
fn assert_normal(pulls: &[f64], least: usize) {
    let n = pulls.len() as f64;
    let mean_square = pulls.iter().map(|pull| pull * pull).sum::<f64>() / n;
    assert!(pulls.len() >= least, "{pulls:?}");
    assert!(pulls.iter().all(|pull| pull.abs() < 4.5), "{pulls:?}");
    assert!((mean_square - 1.0).abs() < 4.0 * (2.0 / n).sqrt(), "{mean_square} of {n}: {pulls:?}");
}

/// A clamped plate with 147 degrees of freedom, three modes in the band; one channel is right, the other has another scale and is late by nearly two periods at the top.
#[test]
fn a_plate_beside_a_channel_that_is_known() {
    let case = plate(8, 0.27, 0.02);
    assert!(case.model.dim() > 100, "{}", case.model.dim());
    let truth = c(1.7e11, 1.7e11 * 0.035);
    let channels = vec![(1.0, 0.0), (-0.6, 3.1e-3)];
    let test = Test::new(case, truth, linear_hz(150.0, 600.0, 60), channels, 0.02);
    let unknown = [NEITHER, BOTH];
    let (mut noise, mut pulls, mut per_freedom) = (noise::Noise::new(11), Vec::new(), Vec::new());
    let draws = of_tier(1, 12);
    for _ in 0..draws {
        let values = test.drawn(&mut noise);
        let outcome =
            test.band(&values).identify(Variation::PerFrequency, &unknown, &test.setup(), context());
        let found = &outcome.channels;
        pulls.extend(test.pulls(found, &unknown));
        let fit = outcome.fit.unwrap();
        // Two channels and one complex modulus leave two at each frequency, and scale and delay take one each.
        let answered = outcome.lines.iter().filter(|one| one.on_path && one.chi_squared.is_some()).count();
        assert_eq!(fit.freedom, 2 * answered - 2);
        per_freedom.push(fit.chi_squared / fit.freedom as f64);
    }
    assert_normal(&pulls, 2 * draws);
    // Each has a standard deviation of √(2/118); selection takes the better of close solutions here and there.
    let mean = per_freedom.iter().sum::<f64>() / per_freedom.len() as f64;
    assert!(of_tier(0.48..1.52, 0.85..1.1).contains(&mean), "{per_freedom:?}");
}

/// A law needs no channel that is known: a bar of 120 elements, both its channels late and of unknown scale.
#[test]
fn a_bar_with_a_law_and_no_channel_that_is_known() {
    let mut case = bar(120);
    // Of a loss factor like the true one: a response without resonances has no shape to begin with.
    let nominal = c(1.0, 0.04) * case.parameter.nominal.at(1000.0).unwrap().re;
    case.parameter.nominal = Law::Constant(nominal);
    let truth = 1.2 * nominal.re * c(1.0, 0.06);
    let [low, high] = [100.0, 1000.0];
    let sensors = case.experiment.sensors.len();
    let period = 1.0 / high;
    let channels = (0..sensors).map(|m| [(-3.0, 2.3 * period), (0.02, -0.4 * period)][m % 2]).collect();
    let test = Test::new(case, truth, linear_hz(low, high, 50), channels, 0.02);
    let unknown = vec![BOTH; sensors];
    let (mut noise, mut pulls) = (noise::Noise::new(5), Vec::new());
    let draws = of_tier(1, 6);
    for _ in 0..draws {
        let values = test.drawn(&mut noise);
        let law = Variation::law(LawKind::Constant);
        let found = test.band(&values).identify(law, &unknown, &test.setup(), context());
        assert!(found.lines.iter().all(|one| one.status == Status::Ok), "{:?}", found.channels);
        let law = &found.laws[0];
        // All numbers of the measurement, less what was fitted.
        assert_eq!(law.residuals, 2 * 50 * sensors - 2 * sensors);
        let at = law.at(test.frequency_hz[0]).unwrap();
        pulls.push((at.modulus.re - truth.re) / at.storage_std.unwrap());
        pulls.push((at.modulus.im / at.modulus.re - truth.im / truth.re) / at.loss_factor_std.unwrap());
        pulls.extend(test.pulls(&found.channels, &unknown));
    }
    assert_normal(&pulls, draws * (2 + 2 * sensors));
}

/// Delays alone, and of any size up to sixteen periods at the top of the band; where nothing is wrong, nothing is found.
#[test]
fn delays_of_many_periods_have_the_right_minimum() {
    let truth = c(1.7e11, 1.7e11 * 0.035);
    for late in [0.0, -2.4e-3, 21.3e-3] {
        let test = Test::new(
            plate(8, 0.27, 0.02),
            truth,
            linear_hz(150.0, 600.0, 60),
            vec![(1.0, 0.0), (1.0, late)],
            1e-6,
        );
        let values = test.drawn(&mut noise::Noise::new(2));
        let unknown = [NEITHER, ChannelUnknowns { scale: false, delay: true }];
        let outcome =
            test.band(&values).identify(Variation::PerFrequency, &unknown, &test.setup(), context());
        let found = &outcome.channels;
        let Calibrated { value, std } = found[1].delay_s.unwrap();
        assert!(
            (value - late).abs() < 4.5 * std.unwrap() && found[1].scale.is_none(),
            "{late} {value} {std:?}"
        );
        assert!(outcome.lines.iter().filter(|one| one.status == Status::Ok).count() > 50);
    }
}
