//! The fit of the answers of a band: χ² over all frequencies, and the misfit of each sensor.

use crate::c64;
use crate::identify::goodness_of_fit::{GoodnessOfFit, excess, judge};
use crate::identify::measured::Band;
use crate::identify::noise::NoiseLevel;
use crate::identify::outcome::{Line, Status};

/// The fit of answers that have χ² per degree of freedom, where so many numbers were fitted to the whole band too; `None` where no degree of freedom is left.
pub(super) fn goodness(
    lines: &[Line],
    freedom: usize,
    fitted: usize,
    noise: &NoiseLevel,
    band: &Band<'_>,
) -> Option<GoodnessOfFit> {
    let on_path = lines.iter().filter(|line| line.on_path);
    let each: Vec<f64> = on_path.filter_map(|line| line.chi_squared).collect();
    let chi_squared = freedom as f64 * each.iter().sum::<f64>();
    judge(chi_squared, (freedom * each.len()).saturating_sub(fitted), noise, band.noise)
}

/// Lines on each side that are looked at together with a line.
const NEIGHBOURS: usize = 10;

/// More lines than this share that are not explained are no outliers.
const MAX_OUTLIER_SHARE: f64 = 0.25;

/// χ² per degree of freedom of each line and its neighbours, where it is larger than noise makes it by chance; 1 elsewhere. Lines that
/// alone are not explained count only where they are many: single ones are outliers, as hum is.
pub(super) fn excess_of_neighbours(lines: &[Line], fit: &GoodnessOfFit) -> Vec<f64> {
    let counts = |line: &&Line| line.on_path && line.chi_squared.is_some();
    let each = fit.freedom as f64 / lines.iter().filter(counts).count().max(1) as f64;
    let of = |i: usize| {
        let near = &lines[i.saturating_sub(NEIGHBOURS)..lines.len().min(i + NEIGHBOURS + 1)];
        let is_explained = |line: &&Line| line.on_path && line.status != Status::Unexplained;
        let explained = near.iter().filter(is_explained).count();
        let is_stretch = (near.len() - explained) as f64 > MAX_OUTLIER_SHARE * near.len() as f64;
        let counted = near.iter().filter(|line| is_stretch || is_explained(line));
        let squares: Vec<f64> = counted.filter_map(|line| line.chi_squared).collect();
        excess(each * squares.iter().sum::<f64>(), each * squares.len() as f64)
    };
    (0..lines.len()).map(of).collect()
}

/// What each sensor says of the answers.
pub(super) fn sensor_misfit(
    lines: &[Line],
    measured: &[Vec<c64>],
    sigma: &[Vec<f64>],
    sensor: usize,
    level: Option<f64>,
) -> Option<f64> {
    let square = |k: usize| {
        let x = lines[k].updated_response.get(sensor).filter(|_| lines[k].on_path)?;
        Some((measured[k][sensor] - x).norm_sqr() / (2.0 * (level? * sigma[k][sensor]).powi(2)))
    };
    let squares: Vec<f64> = (0..lines.len()).filter_map(square).filter(|s| s.is_finite()).collect();
    (!squares.is_empty()).then(|| (squares.iter().sum::<f64>() / squares.len() as f64).sqrt())
}
