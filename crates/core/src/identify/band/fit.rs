//! The fit of the answers of a band: χ² over all frequencies, and the misfit of each sensor.

use crate::c64;
use crate::identify::goodness_of_fit::{GoodnessOfFit, judge};
use crate::identify::measured::Band;
use crate::identify::noise::NoiseLevel;
use crate::identify::outcome::Line;

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
