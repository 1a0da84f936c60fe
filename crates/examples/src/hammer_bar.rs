//! The paper's Section 7 with a known answer: a bar of polyurethane, struck at one end, measured at the other.

use crate::Error;
use crate::hammer_test::{HammerTest, Recorded};
use crate::model::{Model, names, nearest, real, term};
use frfit::c64;
use frfit::frequency::omega_rad_s;
use frfit::material::{Law, Table};
use frfit::model::{DynamicStiffness, Experiment, Parameter, Role};
use frfit::quantity::Quantity;
use frfit_fem::exact::rod::Rod;
use frfit_fem::{Bar, Direction};
use std::f64::consts::{FRAC_PI_2, FRAC_PI_4};

/// Length and diameter in m, as the paper has them.
const LENGTH: f64 = 0.3048;
const DIAMETER: f64 = 0.0254;

/// Density of polyurethane in kg/m³.
const DENSITY: f64 = 1180.0;

/// The paper's sampling interval in s and number of samples.
const STEP_S: f64 = 0.3125e-3;
const SAMPLES: usize = 1600;

/// In the paper's Figs 14 and 15 the hammer touches a little after 0.08 s.
const TEST: HammerTest = HammerTest {
    step_s: STEP_S,
    samples: SAMPLES,
    periods: 8,
    hit_s: 0.08,
    contact_s: 0.8e-3,
    peak_n: 200.0,
};

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
/// Noise is the standard deviation of what is added to every sample, as a share of the channel's largest value; the same each time.
///
/// The response is a sum over frequencies k/(8 T), and so periodic in eight records of T = 0.5 s: were its period one record, the rest
/// of it at the end would be found again at the beginning, and the transform of the record would be the exact FRF
/// whatever the damping. As it is, the end of the record cuts off the rest, and an FRF from it is exact as far as the
/// response has decayed by then.
///
/// # Errors
/// [`Error::Format`] where a number cannot be written, as with noise that is not finite.
pub fn hammer_records(impacts: usize, noise: f64) -> Result<Vec<u8>, Error> {
    let [force, acceleration] = TEST.signals(|f| Ok(hammer_accelerance(f)))?;
    let channels = [("Force", "N", &force), ("Acceleration", "m/s^2", &acceleration)];
    TEST.records(impacts, &channels.map(|(name, unit, clean)| Recorded { name, unit, clean, noise }))
}
