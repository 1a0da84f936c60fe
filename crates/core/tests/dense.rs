//! A dense band, of which solutions are followed between some of its frequencies, against all solutions at every frequency.

use crate::common;
use crate::tier::{is_long, of_tier};

use common::{Band, Case, Setup, plate, sandwich};
use frfit::c64;
use frfit::for_each::sequential;
use frfit::frequency::linear_hz;
use frfit::identify::{Context, Identification, ModelErrors, Noise, Status, Variation, relative_error};
use frfit::model::Parameter;
use frfit::roots::Bounds;

/// Dense for a structure of a dozen modes.
fn frequencies() -> usize {
    of_tier(500, 2000)
}

/// Complex Gaussian numbers of variance one, always the same.
struct Gauss(u64);

impl Gauss {
    fn uniform(&mut self) -> f64 {
        // L. E. Moses' constants, as in Knuth's MMIX.
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        ((self.0 >> 11) as f64 + 0.5) / (1u64 << 53) as f64
    }

    fn next(&mut self) -> c64 {
        let (size, angle) = ((-self.uniform().ln()).sqrt(), std::f64::consts::TAU * self.uniform());
        c64::from_polar(size, angle)
    }
}

/// A measurement with this much relative noise, identified from a nominal off by this factor, both ways: followed, and everywhere.
fn both(mut case: Case, frequencies: usize, off: f64, noise: f64, sensors: usize) -> [Identification; 2] {
    let frequency_hz = linear_hz(case.band_hz[0], case.band_hz[1], frequencies);
    case.experiment.sensors.truncate(sensors);
    let mut gauss = Gauss(7);
    let mut noisy = |x: &c64| x * (1.0 + noise * gauss.next());
    let measured: Vec<Vec<c64>> =
        exact(&case, &frequency_hz).iter().map(|row| row.iter().map(&mut noisy).collect()).collect();
    let std: Vec<Vec<f64>> = measured.iter().map(|u| u.iter().map(|u| noise * u.norm()).collect()).collect();
    let noise = if noise > 0.0 { Noise::Known(&std) } else { Noise::Unknown };
    [false, true].map(|everywhere| {
        let data = (frequency_hz.as_slice(), measured.as_slice(), noise);
        identified(&case, off, data, |setup| setup.with_everywhere(everywhere))
    })
}

/// What the sensors show with the nominal factor.
fn exact(case: &Case, frequency_hz: &[f64]) -> Vec<Vec<c64>> {
    let (model, trained) = case.trained(1e-10);
    assert!(trained.converged);
    let exact = |&f: &f64| model.projection().assess(&case.at(f), c64::default()).unwrap().response;
    frequency_hz.iter().map(exact).collect()
}

/// Identified from a nominal that is off by this factor, with wide bounds.
fn identified(
    case: &Case,
    off: f64,
    (frequency_hz, measured, noise): (&[f64], &[Vec<c64>], Noise<'_>),
    with: impl FnOnce(Setup) -> Setup,
) -> Identification {
    let truth = &case.parameter.nominal;
    let size = truth.at(case.band_hz[1]).unwrap().re;
    let bounds = Bounds { storage: Some([size / 10.0, size * 10.0]), loss_factor: Some([0.0, 2.0]) };
    let parameter = Parameter { nominal: truth.scaled(off), ..case.parameter.clone() };
    let band = Band {
        model: &case.model,
        experiment: &case.experiment,
        parameter: &parameter,
        frequency_hz,
        measured,
        noise,
    };
    let context = Context { for_each: &sequential, progress: &|_, _, _| {} };
    band.identify(Variation::PerFrequency, &[], &with(Setup::within(bounds)), context)
}

/// The same statuses and answers, and no more than this part of 2000 lines explored, which does not grow with the band.
fn assert_same(name: &str, [followed, everywhere]: &[Identification; 2], most: f64) {
    let n = everywhere.lines.len();
    assert_eq!((everywhere.search.explored, followed.lines.len()), (n, n));
    let explored = followed.search.explored;
    assert!((explored as f64) < 2000.0 * most && 4 * explored < 3 * n, "{name}: {explored} of {n}");
    let (mut ok, mut radii) = (0, 0);
    for (a, b) in followed.lines.iter().zip(&everywhere.lines) {
        let at = format!("{name} at {} Hz: {a:?}\n{b:?}", a.frequency_hz);
        assert_eq!(a.status, b.status, "{at}");
        assert_eq!(a.rivals.len(), b.rivals.len(), "{at}");
        // What either subspace may have done to a factor is of this size.
        let same = |x: c64, y: c64| (x - y).norm() <= 1e-6 * (b.nominal() + y).norm();
        assert!(a.correction().zip(b.correction()).is_none_or(|(x, y)| same(x, y)), "{at}");
        assert_eq!(a.correction().is_some(), b.correction().is_some(), "{at}");
        assert!(a.nominal_response.len() == b.nominal_response.len(), "{at}");
        let off = relative_error(&b.nominal_response, &a.nominal_response);
        assert!(off < 1e-6, "{at}");
        ok += usize::from(b.status == Status::Ok);
        let ratio = a.spectral_radius.zip(b.spectral_radius).map(|(r, s)| (r / s - 1.0).abs());
        radii += usize::from(ratio.is_none_or(|ratio| ratio < 0.05));
    }
    assert!(ok > n / 2, "{name}: {ok}");
    // A weak pole is seen at one frequency and not at the next, also where all are explored.
    assert!(radii > n * 99 / 100, "{name}: {radii} spectral radii of {n}");
}

#[test]
fn a_dense_sandwich_is_followed() {
    assert_same("noise", &both(sandwich(12, 1), frequencies(), 1.5, 0.01, 2), 0.25);
    if is_long() {
        assert_same("one sensor", &both(sandwich(12, 1), frequencies(), 1.5, 0.0, 1), 0.25);
    }
}

/// Many solutions at each frequency, which come and go, and jump with the noise.
#[test]
fn a_dense_plate_is_followed_where_that_is_beyond_doubt() {
    assert_same("noise", &both(plate(8, 0.32, 1e-2), frequencies(), 1.5, 0.01, 1), 0.5);
    if is_long() {
        assert_same("one sensor", &both(plate(8, 0.32, 1e-2), frequencies(), 1.5, 0.0, 1), 0.5);
        let little_damping = both(plate(8, 0.32, 1e-3), frequencies(), 0.75, 0.0, 2);
        assert_same("two sensors, little damping", &little_damping, 0.6);
    }
}

/// Of several sensors only solutions that could be chosen are followed: how many lines are explored does not grow with the band.
#[test]
fn explored_lines_do_not_grow_with_the_band() {
    let explored = of_tier([1000, 2500], [1000, 4000]).map(|frequencies| {
        let mut case = plate(8, 0.32, 1e-3);
        case.experiment.sensors.truncate(2);
        let frequency_hz = linear_hz(case.band_hz[0], case.band_hz[1], frequencies);
        let measured = exact(&case, &frequency_hz);
        let found = identified(&case, 0.75, (&frequency_hz, &measured, Noise::Unknown), right_model);
        assert_eq!(found.count(Status::Ok), frequencies);
        found.search.explored
    });
    assert!(4 * explored[1] < 5 * explored[0] && explored[0] < 500, "{explored:?}");
}

/// Only every eighth line is right, the others are on straight lines between: no modulus explains two sensors there. Both boxes are searched
/// on one reduced model, and no line that is off is `ok`.
#[test]
fn data_that_no_modulus_explains_cost_no_second_training() {
    let mut case = sandwich(12, 1);
    case.experiment.sensors.truncate(2);
    let count = of_tier(400, 800);
    let frequency_hz = linear_hz(case.band_hz[0], case.band_hz[1], count);
    let right = exact(&case, &frequency_hz);
    let between = |i: usize| {
        let (left, t) = (i / 8 * 8, (i % 8) as f64 / 8.0);
        let pairs = right[left].iter().zip(&right[(left + 8).min(count - 1)]);
        pairs.map(|(a, b)| a * (1.0 - t) + b * t).collect()
    };
    let measured: Vec<Vec<c64>> = (0..count).map(between).collect();
    let found = identified(&case, 0.75, (&frequency_hz, &measured, Noise::Unknown), right_model);
    let work = found.search.work;
    assert!(work.factorisations <= 4, "{work:?}");
    for line in found.lines.iter().filter(|line| line.status == Status::Ok) {
        let truth = case.parameter.nominal.at(line.frequency_hz).unwrap();
        assert!((line.factor().unwrap() - truth).norm() < 0.05 * truth.norm(), "{line:?}");
    }
}

/// Errors of the model are not looked for.
fn right_model(setup: Setup) -> Setup {
    setup.with_model_errors(ModelErrors::None)
}

#[test]
fn a_short_band_is_explored_everywhere() {
    let [short, everywhere] = both(sandwich(12, 1), 250, 1.5, 0.0, 1);
    assert_eq!(short.search.explored, 250);
    assert!(short == everywhere);
}
