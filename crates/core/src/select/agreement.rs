//! What several sensors agree on, whatever a material would do (B-12).

use super::RIVAL_NATS;
use super::band::{Band, DEFAULT_CURVATURE};
use super::path::Point;
use super::trend::Trend;

/// Nats that a frequency may hold against its best solution beyond what noise does.
const MAX_SURPRISE: f64 = 4.0;

/// A modulus may jump, but not at more than this share of the frequencies: what scatters from line to line is an error.
const MAX_JUMP_SHARE: f64 = 0.05;

/// The solution at each frequency that all sensors have in common, with the nats by which the next one is worse; `None` where they agree at too few
/// frequencies, or on what is no curve.
pub(super) fn agreement(band: &Band) -> Option<Vec<Option<(usize, f64)>>> {
    let agreed: Vec<Option<(usize, f64)>> = band.points.iter().map(|points| only(points)).collect();
    let count = agreed.iter().flatten().count() as f64;
    let is_common = count > 0.0 && band.is_covered(&agreed);
    (is_common && jumps(band, &agreed) as f64 <= MAX_JUMP_SHARE * count).then_some(agreed)
}

/// The one solution that fits all sensors.
fn only(points: &[Point]) -> Option<(usize, f64)> {
    let (index, best) = points.iter().enumerate().min_by(|(_, a), (_, b)| a.misfit.total_cmp(&b.misfit))?;
    let others = points.iter().filter(|other| !other.is(best)).map(|other| other.misfit - best.misfit);
    let next = others.fold(f64::INFINITY, f64::min);
    (best.misfit <= MAX_SURPRISE && next >= RIVAL_NATS).then_some((index, next))
}

/// How often the solutions leave the curve on which those before lie.
fn jumps(band: &Band, agreed: &[Option<(usize, f64)>]) -> usize {
    let mut jumps = 0;
    let mut before: Option<(f64, Trend)> = None;
    for (k, index) in agreed.iter().enumerate().filter_map(|(k, one)| Some((k, one.as_ref()?.0))) {
        let (at, point) = (band.log_frequency[k], &band.points[k][index]);
        let expected = before.map(|(last, trend)| trend.advanced(at - last, DEFAULT_CURVATURE));
        let on_curve = expected.filter(|trend| trend.surprise(point.log, point.variance) <= RIVAL_NATS);
        jumps += usize::from(expected.is_some() && on_curve.is_none());
        let trend = on_curve.map(|trend| trend.joined(point.log, point.variance));
        before = Some((at, trend.unwrap_or_else(|| Trend::start(point.log, point.variance))));
    }
    jumps
}
