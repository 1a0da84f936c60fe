//! Records of a hammer test, computed from the accelerance of a structure.

use crate::Error;
use frfit::c64;
use frfit::frequency::omega_rad_s;
use frfit_formats::lvm::{self, Abscissa, Channel, Lvm, Segment};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Share of the Nyquist frequency at which the anti-aliasing filter of both channels begins to close.
const FILTER_OPEN: f64 = 0.8;

/// Step between two numbers of the file, as LabVIEW writes them: six decimals.
const DECIMALS: f64 = 1e6;

/// How a structure is struck and recorded.
#[derive(Debug, Clone, Copy)]
pub(crate) struct HammerTest {
    /// Sampling interval in s.
    pub(crate) step_s: f64,
    /// Number of samples of a record.
    pub(crate) samples: usize,
    /// The response is computed as a sum over frequencies, and so periodic: its period is so many records long that nothing of
    /// the last one is left.
    pub(crate) periods: usize,
    /// When the hammer touches, in s.
    pub(crate) hit_s: f64,
    /// Length in s of the half-sine that the hammer's tip makes.
    pub(crate) contact_s: f64,
    /// Its largest force in N.
    pub(crate) peak_n: f64,
}

/// A channel of the records.
#[derive(Debug)]
pub(crate) struct Recorded<'a> {
    /// What it is called.
    pub(crate) name: &'a str,
    /// The unit of the samples.
    pub(crate) unit: &'a str,
    /// What they are without noise.
    pub(crate) clean: &'a [f64],
    /// Standard deviation of the noise of every sample, as a share of the largest value.
    pub(crate) noise: f64,
}

impl HammerTest {
    /// Force in N and acceleration in m/s² of an impact at the instants of a record.
    ///
    /// Both channels pass the same anti-aliasing filter, without phase, which so cancels in their quotient; what the structure does
    /// above the Nyquist frequency does not fold back.
    ///
    /// # Errors
    /// Those of the accelerance, which is asked for at frequencies from zero to below the Nyquist frequency.
    pub(crate) fn signals(
        &self,
        mut accelerance: impl FnMut(f64) -> Result<c64, Error>,
    ) -> Result<[Vec<f64>; 2], Error> {
        let points = self.periods * self.samples;
        let step_hz = 1.0 / (points as f64 * self.step_s);
        let turns: Vec<c64> =
            (0..points).map(|k| c64::from_polar(1.0, TAU * k as f64 / points as f64)).collect();
        let [mut force, mut acceleration] = [vec![0.0; self.samples], vec![0.0; self.samples]];
        for k in 0..points / 2 {
            let f = k as f64 * step_hz;
            let omega = omega_rad_s(f);
            let shift = c64::from_polar(1.0, -omega * self.hit_s);
            // Both sides of the spectrum, except at zero.
            let sides = if k == 0 { 1.0 } else { 2.0 };
            let at_hammer = sides * step_hz * self.peak_n * self.filter(f) * self.half_sine(omega) * shift;
            let at_sensor = accelerance(f)? * at_hammer;
            for n in 0..self.samples {
                let turn = turns[k * n % points];
                force[n] += (at_hammer * turn).re;
                acceleration[n] += (at_sensor * turn).re;
            }
        }
        Ok([force, acceleration])
    }

    /// So many impacts, one a segment, of sizes between 0.8 and 1.2, with noise that is the same each time.
    ///
    /// # Errors
    /// [`Error::Format`] where a number cannot be written, as with noise that is not finite.
    pub(crate) fn records(&self, impacts: usize, channels: &[Recorded<'_>]) -> Result<Vec<u8>, Error> {
        let mut random = Random(1);
        let mut channel = |of: &Recorded<'_>, size: f64| {
            let largest = of.clean.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
            let sample =
                |x: &f64| ((size * x + of.noise * largest * random.normal()) * DECIMALS).round() / DECIMALS;
            Channel {
                name: of.name.to_owned(),
                unit: of.unit.to_owned(),
                abscissa: Abscissa::Even { start: 0.0, step: self.step_s },
                values: of.clean.iter().map(sample).collect(),
            }
        };
        // No two impacts are alike.
        let mut segment = |impact: usize| {
            let size = 1.0 + 0.2 * (2.4 * impact as f64).sin();
            let channels = channels.iter().map(|of| channel(of, size)).collect();
            Segment { channels, ..Segment::default() }
        };
        let file = Lvm { segments: (0..impacts).map(&mut segment).collect(), ..Lvm::default() };
        Ok(lvm::write(&file)?.into_bytes())
    }

    /// ∫ sin(πt/T) e^{−iωt} dt over the contact 0 ≤ t ≤ T.
    fn half_sine(&self, omega_rad_s: f64) -> c64 {
        let contact_s = self.contact_s;
        let part = |rate: f64| {
            let half = rate * contact_s / 2.0;
            let sinc = if half == 0.0 { 1.0 } else { half.sin() / half };
            contact_s * sinc * c64::from_polar(1.0, half)
        };
        let rate = PI / contact_s;
        (part(rate - omega_rad_s) - part(-rate - omega_rad_s)) / c64::new(0.0, 2.0)
    }

    /// Gain of the anti-aliasing filter: 1, then a squared cosine down to 0 at the Nyquist frequency.
    fn filter(&self, frequency_hz: f64) -> f64 {
        let nyquist_hz = 0.5 / self.step_s;
        let closing = (frequency_hz / nyquist_hz - FILTER_OPEN) / (1.0 - FILTER_OPEN);
        (FRAC_PI_2 * closing.clamp(0.0, 1.0)).cos().powi(2)
    }
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
