//! What was measured: frequency response functions, and how well they are known.

use crate::c64;

/// Where no standard deviation is given, sensors count by their own size, but not below this fraction of their median over the band: an antiresonance is
/// not measured any better than the rest.
const MIN_SIZE_OVER_MEDIAN: f64 = 0.1;

/// No instrument is better than this fraction of the largest response: a smaller standard deviation, or none at all, is not believed.
const MIN_STD_OVER_LARGEST: f64 = 1e-9;

/// Measured frequency response functions.
#[derive(Debug, Clone, Copy)]
pub struct Frfs<'a> {
    /// Frequencies, strictly ascending.
    pub frequency_hz: &'a [f64],
    /// Receptance, `[frequency][sensor]`, m/N: of windowed records that of
    /// [`Quantity::over_receptance_windowed`](crate::quantity::Quantity::over_receptance_windowed), with the decay of the model.
    pub receptance: &'a [Vec<c64>],
    /// How well each was measured.
    pub noise: Noise<'a>,
}

/// Standard deviations √E|δx|² of measured receptances, `[frequency][sensor]`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Noise<'a> {
    /// Not known: in proportion to the responses, by a factor that is estimated from several sensors. Where the responses show a floor, that is part of it
    /// ([`Noise::Floor`]).
    Unknown,
    /// Not known: in proportion to √(|x|² + floor²), by a factor that is estimated from several sensors.
    Floor(NoiseFloor),
    /// Known up to a common factor, as from a coherence without the number of averages.
    Relative(&'a [Vec<f64>]),
    /// Known. Where the responses show that a part of it is common to all sensors, that is part of it ([`Noise::Common`]).
    Known(&'a [Vec<f64>]),
    /// Known, and in part common to all sensors: that of the force, or of leakage.
    Common(CommonNoise<'a>),
}

impl Noise<'_> {
    /// Whether its size is known.
    pub(crate) fn is_known(&self) -> bool {
        matches!(self, Self::Known(_) | Self::Common(_))
    }

    /// Whether nothing is known of its size: it is found as a part of the response.
    pub(crate) fn is_part_of_response(&self) -> bool {
        matches!(self, Self::Unknown | Self::Floor(_))
    }
}

/// Noise of which a part is the same in all sensors over their responses. Sensors then say less than their number.
///
/// Of n sensors with correlation c, an error that they have in common is √(1 + (n − 1) c) times what n independent ones would leave; all standard deviations are
/// longer by that.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CommonNoise<'a> {
    /// The standard deviations that were given, `[frequency][sensor]`.
    pub std: &'a [Vec<f64>],
    /// c: the correlation of two sensors' noise over their responses.
    pub correlation: f64,
    /// √(1 + (n − 1) c).
    pub times: f64,
}

/// A part of the noise that does not grow with the response: that of an amplifier or a converter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NoiseFloor {
    /// The floor in the middle of the band, over the median of the sensor's response.
    pub over_median: f64,
    /// The floor of a receptance falls as ω^−power: 2 of a white floor of the acceleration, 1 of the velocity, 0 of the displacement.
    pub power: i32,
}

impl NoiseFloor {
    /// √(|x|² + floor²) over what that is for a floor and a response of median size: a part of the response again.
    fn std(&self, size: f64, median: f64, frequency_over_middle: f64) -> f64 {
        let floor = self.over_median * median * frequency_over_middle.powi(-self.power);
        size.hypot(floor) / self.over_median.hypot(1.0)
    }
}

/// σ of real and imaginary part each, `[frequency][sensor]`: as given, or in proportion to the response.
pub(crate) fn standard_deviations(
    frequency_hz: &[f64],
    measured: &[Vec<c64>],
    noise: Noise<'_>,
) -> Vec<Vec<f64>> {
    let sensors = 0..measured.first().map_or(0, Vec::len);
    let sorted = |m: usize| {
        let mut sizes: Vec<f64> = measured.iter().map(|u| u[m].norm()).collect();
        sizes.sort_by(f64::total_cmp);
        sizes
    };
    let sizes: Vec<Vec<f64>> = sensors.map(sorted).collect();
    let given =
        |std: f64, m: usize| (std / 2f64.sqrt()).max(MIN_STD_OVER_LARGEST * sizes[m][sizes[m].len() - 1]);
    let row = |(i, u): (usize, &Vec<c64>)| {
        let of = |(m, u): (usize, &c64)| match noise {
            Noise::Known(std) | Noise::Relative(std) => given(std[i][m], m),
            Noise::Common(common) => common.times * given(common.std[i][m], m),
            Noise::Unknown => u.norm().max(MIN_SIZE_OVER_MEDIAN * sizes[m][sizes[m].len() / 2]),
            Noise::Floor(floor) => {
                floor.std(u.norm(), sizes[m][sizes[m].len() / 2], frequency_hz[i] / middle_hz(frequency_hz))
            }
        };
        u.iter().enumerate().map(of).collect()
    };
    measured.iter().enumerate().map(row).collect()
}

/// The geometric mean of the ends of a band; without its first line where that is at 0 Hz.
fn middle_hz(frequency_hz: &[f64]) -> f64 {
    let first = frequency_hz.iter().copied().find(|&f| f > 0.0).unwrap_or(1.0);
    (first * frequency_hz.last().copied().unwrap_or(1.0)).sqrt()
}
