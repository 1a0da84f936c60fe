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
    /// Not known: in proportion to the responses, by a factor that is estimated from several sensors.
    Unknown,
    /// Known up to a common factor, as from a coherence without the number of averages.
    Relative(&'a [Vec<f64>]),
    /// Known.
    Known(&'a [Vec<f64>]),
}

/// σ of real and imaginary part each, `[frequency][sensor]`: as given, or in proportion to the response.
pub(crate) fn standard_deviations(measured: &[Vec<c64>], noise: Noise<'_>) -> Vec<Vec<f64>> {
    let sensors = 0..measured.first().map_or(0, Vec::len);
    let sorted = |m: usize| {
        let mut sizes: Vec<f64> = measured.iter().map(|u| u[m].norm()).collect();
        sizes.sort_by(f64::total_cmp);
        sizes
    };
    let sizes: Vec<Vec<f64>> = sensors.map(sorted).collect();
    let row = |(i, u): (usize, &Vec<c64>)| {
        let of = |(m, u): (usize, &c64)| match noise {
            Noise::Known(std) | Noise::Relative(std) => {
                (std[i][m] / 2f64.sqrt()).max(MIN_STD_OVER_LARGEST * sizes[m][sizes[m].len() - 1])
            }
            Noise::Unknown => u.norm().max(MIN_SIZE_OVER_MEDIAN * sizes[m][sizes[m].len() / 2]),
        };
        u.iter().enumerate().map(of).collect()
    };
    measured.iter().enumerate().map(row).collect()
}
