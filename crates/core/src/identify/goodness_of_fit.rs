//! Whether the model explains the band: χ² and its meaning.

use super::noise::{NoiseLevel, NoiseSource};
use crate::frfs::Noise;

/// How well the answers explain the sensors over the band.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GoodnessOfFit {
    /// χ² of all answers, noise at the level of [`NoiseLevel`].
    pub chi_squared: f64,
    /// Its degrees of freedom.
    pub freedom: usize,
    /// Normal deviate of that χ², by Wilson and Hilferty: how many standard deviations it is above what noise gives.
    pub deviate: f64,
    /// What that says.
    pub verdict: Explained,
}

impl GoodnessOfFit {
    /// The same, not explained where another model is needed for it.
    pub(super) fn of_model(self, other: bool) -> Self {
        Self { verdict: if other { Explained::No } else { self.verdict }, ..self }
    }

    /// Whether noise is all that is left, or nearly.
    pub(super) fn is_explained(&self) -> bool {
        matches!(self.verdict, Explained::Yes | Explained::Nearly)
    }

    pub(super) fn is_nearly_explained(&self) -> bool {
        self.verdict == Explained::Nearly
    }

    /// The same, at best nearly explained where the response has a rest that neither noise nor errors of the model explain.
    pub(super) fn beside(self, rest: f64) -> Self {
        let nearly = rest > 0.0 && self.verdict == Explained::Yes;
        Self { verdict: if nearly { Explained::Nearly } else { self.verdict }, ..self }
    }

    /// √(χ²/n) of a band that is nearly explained, by which bars of the given noise are too short; else 1.
    pub(super) fn excess(&self) -> f64 {
        let ratio = (self.chi_squared / self.freedom as f64).sqrt();
        if self.is_nearly_explained() { ratio.max(1.0) } else { 1.0 }
    }
}

/// Whether noise is all that is left.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Explained {
    /// The residual is noise of the size that was given, or of the size that the scatter of the answers shows too.
    Yes,
    /// A little more is left than the given noise, by a factor of up to two in χ², or by a few per cent of the response beside errors of the model: the
    /// noise is larger than given, or the model not quite right.
    Nearly,
    /// The residual is no noise: the model cannot explain these measurements.
    No,
    /// The level of the noise was found from the residual, and there is no other evidence of it.
    Untested,
}

impl Explained {
    /// The word that summaries use.
    pub fn name(self) -> &'static str {
        match self {
            Self::Yes => "explained",
            Self::Nearly => "nearly explained",
            Self::No => "not explained",
            Self::Untested => "untested",
        }
    }
}

/// A normal deviate beyond which it is not chance: once in thirty thousand.
const CHANCE_DEVIATE: f64 = 4.0;

/// χ² up to this many times its degrees of freedom is noise that was given too small by less than half.
const MAX_NEARLY_REDUCED_CHI_SQUARED: f64 = 2.0;

/// Sensors that disagree more than the answers scatter, by this factor, do not disagree by noise, which shows in both alike: ten times in χ², where
/// the two levels of some dozens of frequencies differ by a third.
const CONTRADICTION_RATIO: f64 = 3.0;

/// No average leaves noise of this part of the response: then sensors contradict one another.
const MAX_NOISE_OVER_RESPONSE: f64 = 0.3;

/// A thousandth of the response is as good as measured responses get: a smaller misfit is no reason to doubt anything.
pub(super) const MIN_DOUBTFUL_MISFIT: f64 = 1e-3;

/// Largest ε (P-40) of an answer for status `ok`, however small the noise: the error that the paper reports for a measurement
/// at n = 30.
pub(super) const MAX_ERROR: f64 = 1e-2;

/// A misfit of a line of more standard deviations than this, root mean square over the sensors, is not noise.
pub(super) const MAX_RMS_MISFIT: f64 = 5.0;

/// What a χ² over the band says; `None` without a degree of freedom.
pub(super) fn judge(
    chi_squared: f64,
    freedom: usize,
    noise: &NoiseLevel,
    given: Noise<'_>,
) -> Option<GoodnessOfFit> {
    if freedom == 0 {
        return None;
    }
    let n = freedom as f64;
    let deviate = normal_deviate(chi_squared, n);
    let found = noise.of_sensors.unwrap_or(0.0);
    let verdict = match noise.source {
        NoiseSource::Given if deviate <= CHANCE_DEVIATE => Explained::Yes,
        NoiseSource::Given if chi_squared <= MAX_NEARLY_REDUCED_CHI_SQUARED * n => Explained::Nearly,
        NoiseSource::Given => Explained::No,
        _ if given.is_part_of_response() && found > MAX_NOISE_OVER_RESPONSE => Explained::No,
        // Below what a test can show there is nothing to contradict.
        _ if found <= MIN_DOUBTFUL_MISFIT => Explained::Yes,
        _ => match noise.of_scatter {
            Some(scatter) if found > CONTRADICTION_RATIO * scatter => Explained::No,
            Some(_) => Explained::Yes,
            None => Explained::Untested,
        },
    };
    Some(GoodnessOfFit { chi_squared, freedom, deviate, verdict })
}

/// χ² of n degrees of freedom as a normal deviate, after Wilson and Hilferty.
fn normal_deviate(chi_squared: f64, n: f64) -> f64 {
    ((chi_squared / n).cbrt() - (1.0 - 2.0 / (9.0 * n))) / (2.0 / (9.0 * n)).sqrt()
}

/// χ²/n where that is more than noise leaves by chance; else 1.
pub(super) fn excess(chi_squared: f64, n: f64) -> f64 {
    if n > 0.0 && normal_deviate(chi_squared, n) > CHANCE_DEVIATE { chi_squared / n } else { 1.0 }
}

/// Whether χ² per degree of freedom of a stretch, at a given noise, says that the model does not explain it.
pub(super) fn is_unexplained_stretch(excess: f64, noise: &NoiseLevel) -> bool {
    noise.source == NoiseSource::Given && excess > MAX_NEARLY_REDUCED_CHI_SQUARED
}

/// A sensor over the band.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SensorFit {
    /// Root mean square of its misfit over its assumed standard deviation and the level of the noise, over all answers; `None` without answers. Noise
    /// alone gives less than 1, the less the more of the answers it determines.
    pub misfit: Option<f64>,
    /// Whether it contradicts all others, which agree with one another without it.
    pub contradicts: bool,
    /// Whether it shows nothing beside the others: at most 1e-9 of the largest response.
    pub dead: bool,
    /// Whether it was left out for that, or for its contradiction.
    pub left_out: bool,
}
