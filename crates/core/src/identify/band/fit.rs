//! Whether the model explains the band: χ² over all frequencies.

use super::noise::{NoiseLevel, NoiseSource};
use super::{Band, Noise};
use crate::c64;
use crate::identify::{Line, Status};

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
    pub(in crate::identify) fn of_model(self, other: bool) -> Self {
        Self { verdict: if other { Explained::No } else { self.verdict }, ..self }
    }

    /// √(χ²/n) of a band that is nearly explained, by which bars of the given noise are too short; else 1.
    pub(in crate::identify) fn excess(&self) -> f64 {
        let is_nearly = self.verdict == Explained::Nearly;
        if is_nearly { (self.chi_squared / self.freedom as f64).sqrt() } else { 1.0 }
    }
}

/// Whether noise is all that is left.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Explained {
    /// What is left is noise of the size that was given, or of the size that the scatter of the answers shows too.
    Yes,
    /// A little more is left than the given noise, by a factor of up to two in χ²: the noise is larger than told, or the model not quite right.
    Nearly,
    /// What is left is no noise: the model cannot explain these measurements.
    No,
    /// The level of the noise was found from what is left, and nothing else tells it.
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
const CHANCE: f64 = 4.0;

/// χ² up to this many times its degrees of freedom is the noise told too small by less than half.
const NEARLY: f64 = 2.0;

/// Sensors that disagree by so many times what the answers scatter by do not disagree by noise, which shows in both alike: ten times in χ², where
/// the two levels of some dozens of frequencies differ by a third.
const CONTRADICTION: f64 = 3.0;

/// No average leaves noise of this part of the response: then sensors contradict one another.
const NO_NOISE: f64 = 0.3;

/// The fit of answers that have χ² per degree of freedom, where so many numbers were fitted to the whole band too; `None` where nothing is left to tell.
pub(super) fn goodness(
    outcomes: &[Line],
    freedom: usize,
    fitted: usize,
    noise: &NoiseLevel,
    band: &Band<'_>,
) -> Option<GoodnessOfFit> {
    let on_path = outcomes.iter().filter(|outcome| outcome.on_path);
    let each: Vec<f64> = on_path.filter_map(|outcome| outcome.chi_squared).collect();
    let chi_squared = freedom as f64 * each.iter().sum::<f64>();
    judge(chi_squared, (freedom * each.len()).saturating_sub(fitted), noise, band.noise)
}

/// What a χ² over the band says; `None` without a degree of freedom.
pub(in crate::identify) fn judge(
    chi_squared: f64,
    freedom: usize,
    noise: &NoiseLevel,
    told: Noise<'_>,
) -> Option<GoodnessOfFit> {
    if freedom == 0 {
        return None;
    }
    let n = freedom as f64;
    let deviate = normal_deviate(chi_squared, n);
    let found = noise.of_sensors.unwrap_or(0.0);
    let verdict = match noise.source {
        NoiseSource::Given if deviate <= CHANCE => Explained::Yes,
        NoiseSource::Given if chi_squared <= NEARLY * n => Explained::Nearly,
        NoiseSource::Given => Explained::No,
        _ if told == Noise::Unknown && found > NO_NOISE => Explained::No,
        // Below what a test can show there is nothing to contradict.
        _ if found <= LEAST => Explained::Yes,
        _ => match noise.of_scatter {
            Some(scatter) if found > CONTRADICTION * scatter => Explained::No,
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

/// Lines on each side that are looked at together with a line.
const NEIGHBOURS: usize = 10;

/// χ² per degree of freedom of each line and its neighbours, where that is more than noise leaves by chance; 1 elsewhere. Lines that are
/// not explained by themselves do not count.
pub(super) fn excess_of_neighbours(outcomes: &[Line], fit: &GoodnessOfFit) -> Vec<f64> {
    let counts = |line: &&Line| line.on_path && line.chi_squared.is_some();
    let each = fit.freedom as f64 / outcomes.iter().filter(counts).count().max(1) as f64;
    let of = |i: usize| {
        let near = &outcomes[i.saturating_sub(NEIGHBOURS)..outcomes.len().min(i + NEIGHBOURS + 1)];
        let near = near.iter().filter(|line| line.on_path && line.status != Status::Unexplained);
        let squares: Vec<f64> = near.filter_map(|line| line.chi_squared).collect();
        let n = each * squares.len() as f64;
        let chi_squared = each * squares.iter().sum::<f64>();
        if n > 0.0 && normal_deviate(chi_squared, n) > CHANCE { chi_squared / n } else { 1.0 }
    };
    (0..outcomes.len()).map(of).collect()
}

/// Whether χ² per degree of freedom of a stretch, at a given noise, says that the model does not explain it.
pub(super) fn is_unexplained_stretch(excess: f64, noise: &NoiseLevel) -> bool {
    noise.source == NoiseSource::Given && excess > NEARLY
}

/// A thousandth of the response is as good as measured responses get: a smaller misfit is no reason to doubt anything.
pub(super) const LEAST: f64 = 1e-3;

/// A sensor over the band.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SensorFit {
    /// Root mean square of its misfit over its assumed deviation and the level of the noise, over all answers; `None` where there is none. Noise
    /// alone gives less than 1, the less the more of the answers it determines.
    pub misfit: Option<f64>,
    /// Whether it contradicts all others, which agree with one another without it.
    pub contradicts: bool,
    /// Whether it was left out for that.
    pub left_out: bool,
}

/// What each sensor says of the answers.
pub(super) fn sensor_misfit(
    outcomes: &[Line],
    measured: &[Vec<c64>],
    sigma: &[Vec<f64>],
    sensor: usize,
    level: Option<f64>,
) -> Option<f64> {
    let square = |k: usize| {
        let x = outcomes[k].updated_response.get(sensor).filter(|_| outcomes[k].on_path)?;
        Some((measured[k][sensor] - x).norm_sqr() / (2.0 * (level? * sigma[k][sensor]).powi(2)))
    };
    let squares: Vec<f64> = (0..outcomes.len()).filter_map(square).filter(|s| s.is_finite()).collect();
    (!squares.is_empty()).then(|| (squares.iter().sum::<f64>() / squares.len() as f64).sqrt())
}
