//! The paper's Section 7 with a known answer: a bar of polyurethane, struck at one end, measured at the other.

use crate::Error;
use crate::model::{Model, names, nearest, real, term};
use frfit::c64;
use frfit::frequency::omega_rad_s;
use frfit::material::{Law, Table};
use frfit::model::{DynamicStiffness, Experiment, Parameter, Role};
use frfit::quantity::Quantity;
use frfit_fem::exact::rod::Rod;
use frfit_fem::{Bar, Direction};
use frfit_formats::lvm::{self, Abscissa, Channel, Lvm, Segment};
use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI, TAU};

/// Length and diameter in m, as the paper has them.
const LENGTH: f64 = 0.3048;
const DIAMETER: f64 = 0.0254;

/// Density of polyurethane in kg/m³.
const DENSITY: f64 = 1180.0;

/// The paper's sampling interval in s and number of samples.
const STEP_S: f64 = 0.3125e-3;
const SAMPLES: usize = 1600;

/// When the hammer touches, in s: in the paper's Figs 14 and 15 a little after 0.08 s.
const HIT_S: f64 = 0.08;

/// Length in s and largest force in N of the half-sine that the hammer's tip makes.
const CONTACT_S: f64 = 0.8e-3;
const PEAK_N: f64 = 200.0;

/// The solution is a sum over frequencies, and so periodic: its period is so many records long that nothing of the last
/// one is left.
const PERIODS: usize = 8;

/// Share of the Nyquist frequency at which the anti-aliasing filter of both channels begins to close.
const FILTER_OPEN: f64 = 0.8;

/// Step between two numbers of the file, as LabVIEW writes them: six decimals.
const DECIMALS: f64 = 1e6;

/// The nominal modulus: the constant one that fits the first mode best, over 200 Hz to 300 Hz, as in the paper.
pub(crate) const NOMINAL: [f64; 2] = [2.7097e7, 0.1043];

/// The true modulus at a frequency: fractional Zener, E = (E₀ + E∞ (iωτ)^α)/(1 + (iωτ)^α).
///
/// Causal, with its transition below the band, so that the modulus comes to rest. Of E ~ (iω)^β, with a loss factor that stays, a nominal from the
/// first mode has ρ = (6^β − 1)/sin(βπ/2) > 1.13 at the sixth.
///
/// # Source
/// T. Pritz, Analysis of four-parameter fractional derivative model of real solid materials, J. Sound Vib. 195 (1996) 103–115.
pub fn polyurethane(frequency_hz: f64) -> c64 {
    const E0: f64 = 4e6;
    const E_INFINITY: f64 = 2.9e7;
    const TAU_S: f64 = 0.01;
    const ALPHA: f64 = 0.7;
    let power = c64::from_polar((omega_rad_s(frequency_hz) * TAU_S).powf(ALPHA), ALPHA * FRAC_PI_2);
    (E0 + E_INFINITY * power) / (1.0 + power)
}

/// The bar as a continuum at a frequency, with its true modulus.
pub fn hammer_rod(frequency_hz: f64) -> Rod {
    let area = FRAC_PI_4 * DIAMETER * DIAMETER;
    Rod { modulus: polyurethane(frequency_hz), density: DENSITY, area, length: LENGTH }
}

/// Exact accelerance at the end x = 0 of a force at the end x = L, P-39.
pub fn hammer_accelerance(frequency_hz: f64) -> c64 {
    let rod = hammer_rod(frequency_hz);
    if frequency_hz == 0.0 {
        return c64::new(1.0 / (rod.density * rod.area * rod.length), 0.0);
    }
    let receptance = rod.free_free_end_force(omega_rad_s(frequency_hz), 1.0, 0.0);
    Quantity::Accelerance.from_receptance(frequency_hz, receptance)
}

/// The free–free bar in elements, a unit force at one end, measured at the other. 200 Hz to 1550 Hz, as the paper's Fig. 7.
///
/// # Errors
/// [`Error::Mesh`] for no element or too many.
pub fn hammer_bar(elements: usize) -> Result<Model, Error> {
    let area = FRAC_PI_4 * DIAMETER * DIAMETER;
    let bar = Bar { length: LENGTH, area, elements, ..Bar::default() }.assemble()?;
    let at = |x| nearest(&bar, [x, 0.0, 0.0], Direction::X);
    let stiffness = DynamicStiffness::new(vec![
        term(
            "polyurethane",
            Role::Stiffness,
            &bar.stiffness[0],
            Law::complex_modulus(NOMINAL[0], NOMINAL[1]),
        ),
        term("mass", Role::Mass, &bar.mass[0], real(DENSITY)),
    ])?;
    Ok(Model {
        parameter: Parameter::factor_of(&stiffness, &["polyurethane"])?,
        stiffness,
        experiment: Experiment::driven_at(bar.dofs.len(), at(0.0), vec![at(LENGTH)]),
        truth: Law::Table(truth()),
        band_hz: [200.0, 1550.0],
        step_hz: 1.0 / (SAMPLES as f64 * STEP_S),
        dofs: names(&bar),
    })
}

/// The true modulus at the lines of the records' transform.
fn truth() -> Table {
    let step_hz = 1.0 / (SAMPLES as f64 * STEP_S);
    let frequency_hz: Vec<f64> = (1..SAMPLES / 2).map(|k| k as f64 * step_hz).collect();
    let values = frequency_hz.iter().map(|&f| polyurethane(f)).collect();
    Table::new(frequency_hz, values).expect("ascending frequencies and finite values")
}

/// Records of force (N) and acceleration (m/s²) of some impacts, one a segment, computed from the exact solution.
///
/// Both channels pass the same anti-aliasing filter, without phase, which so cancels in their quotient; what the bar does
/// above the Nyquist frequency does not fold back. Noise is the standard deviation of what is added to every sample, as a
/// share of the channel's largest value; the same each time.
///
/// The response is a sum over frequencies k/(8 T), and so periodic in eight records of T = 0.5 s: were its period one record, what is
/// left of it at the end would be found again at the beginning, and the transform of the record would be the exact FRF
/// whatever the damping. As it is, the end of the record cuts off what is left, and an FRF from it is exact as far as the
/// response has decayed by then.
///
/// # Errors
/// [`Error::Format`] where a number cannot be written, as with noise that is not finite.
pub fn hammer_records(impacts: usize, noise: f64) -> Result<Vec<u8>, Error> {
    let [force, acceleration] = signals();
    let mut random = Random(1);
    let mut channel = |name: &str, unit: &str, clean: &[f64], size: f64| {
        let largest = clean.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
        let sample = |x: &f64| ((size * x + noise * largest * random.normal()) * DECIMALS).round() / DECIMALS;
        Channel {
            name: name.to_owned(),
            unit: unit.to_owned(),
            abscissa: Abscissa::Even { start: 0.0, step: STEP_S },
            values: clean.iter().map(sample).collect(),
        }
    };
    // No two impacts are alike: sizes between 0.8 and 1.2.
    let mut segment = |impact: usize| {
        let size = 1.0 + 0.2 * (2.4 * impact as f64).sin();
        let channels =
            vec![channel("Force", "N", &force, size), channel("Acceleration", "m/s^2", &acceleration, size)];
        Segment { channels, ..Segment::default() }
    };
    let file = Lvm { segments: (0..impacts).map(&mut segment).collect(), ..Lvm::default() };
    Ok(lvm::write(&file)?.into_bytes())
}

/// Force and acceleration of an impact at the instants of a record.
fn signals() -> [Vec<f64>; 2] {
    let points = PERIODS * SAMPLES;
    let step_hz = 1.0 / (points as f64 * STEP_S);
    let turns: Vec<c64> = (0..points).map(|k| c64::from_polar(1.0, TAU * k as f64 / points as f64)).collect();
    let [mut force, mut acceleration] = [vec![0.0; SAMPLES], vec![0.0; SAMPLES]];
    for k in 0..points / 2 {
        let f = k as f64 * step_hz;
        let omega = omega_rad_s(f);
        let shift = c64::from_polar(1.0, -omega * HIT_S);
        // Both sides of the spectrum, except at zero.
        let sides = if k == 0 { 1.0 } else { 2.0 };
        let at_hammer = sides * step_hz * PEAK_N * filter(f) * half_sine(omega) * shift;
        let at_sensor = hammer_accelerance(f) * at_hammer;
        for n in 0..SAMPLES {
            let turn = turns[k * n % points];
            force[n] += (at_hammer * turn).re;
            acceleration[n] += (at_sensor * turn).re;
        }
    }
    [force, acceleration]
}

/// ∫ sin(πt/T) e^{−iωt} dt over the contact 0 ≤ t ≤ T.
fn half_sine(omega_rad_s: f64) -> c64 {
    let part = |rate: f64| {
        let half = rate * CONTACT_S / 2.0;
        let sinc = if half == 0.0 { 1.0 } else { half.sin() / half };
        CONTACT_S * sinc * c64::from_polar(1.0, half)
    };
    let rate = PI / CONTACT_S;
    (part(rate - omega_rad_s) - part(-rate - omega_rad_s)) / c64::new(0.0, 2.0)
}

/// Gain of the anti-aliasing filter: 1, then a squared cosine down to 0 at the Nyquist frequency.
fn filter(frequency_hz: f64) -> f64 {
    let nyquist_hz = 0.5 / STEP_S;
    let closing = (frequency_hz / nyquist_hz - FILTER_OPEN) / (1.0 - FILTER_OPEN);
    (FRAC_PI_2 * closing.clamp(0.0, 1.0)).cos().powi(2)
}

/// The same numbers each time.
struct Random(u64);

impl Random {
    /// Uniform in 0 < x < 1: the congruential generator of D. E. Knuth, *The Art of Computer Programming* 2, section 3.3.4, line 26.
    fn uniform(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        ((self.0 >> 12) as f64 + 0.5) / (1_u64 << 52) as f64
    }

    /// Standard normal, after Box and Muller.
    fn normal(&mut self) -> f64 {
        let radius = (-2.0 * self.uniform().ln()).sqrt();
        radius * (TAU * self.uniform()).cos()
    }
}
