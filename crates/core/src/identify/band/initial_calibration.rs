//! Where the search for a channel's scale and delay begins.

use crate::c64;
use crate::identify::channel::{Channel, ChannelUnknowns};
use crate::median::median;

/// Delays that are tried go up to this many radians of phase at the top of a band, either way: one of sixteen periods is another recording.
pub(crate) const MAX_DELAY_PHASE_RAD: f64 = 100.0;

/// And are so many radians apart.
pub(crate) const DELAY_PHASE_STEP_RAD: f64 = 0.5;

/// On the grid a delay in the middle of two agrees to 1 − cos ¼ less; others may agree to less than this less and be better between.
const GRID_AGREEMENT_LOSS: f64 = 0.1;

/// How often the distance is divided by ten about a delay.
const DELAY_REFINEMENTS: usize = 2;

/// Agreements that differ by this part are alike: more than the finest distance leaves, 1 − cos 0.0025.
const AGREEMENT_RTOL: f64 = 1e-4;

/// The calibration with which most of some ratios (ω, x/y) of a channel are one; `None` where no calibration does that.
///
/// The delay is where the phases of the ratios agree best, Σ cos(arg(x/y) − ωτ): whatever the sizes, and though some be wrong. The least of several: lines
/// at equal distance cannot distinguish a delay of a period of that distance from none.
pub(super) fn aligned(ratios: &[(f64, c64)], unknown: ChannelUnknowns, top: f64) -> Option<Channel> {
    let usable: Vec<(f64, c64)> =
        ratios.iter().copied().filter(|(_, ratio)| ratio.is_finite() && ratio.norm() > 0.0).collect();
    if !unknown.any() {
        return Some(Channel::CALIBRATED);
    }
    if usable.is_empty() {
        return None;
    }
    let turned = |delay_s: f64| {
        usable.iter().map(move |(omega, ratio)| ratio * c64::from_polar(1.0, -omega * delay_s))
    };
    let delay_s = if unknown.delay {
        let agreement = |delay_s: f64| {
            let sum: f64 = turned(delay_s).map(|ratio| ratio.re / ratio.norm()).sum();
            if unknown.scale { sum.abs() } else { sum }
        };
        best_delay(agreement, top)
    } else {
        0.0
    };
    let scale = match unknown.scale {
        true => median(turned(delay_s).map(|ratio| ratio.re).collect()).filter(|&median| median != 0.0)?,
        false => 1.0,
    };
    Some(Channel { scale, delay_s })
}

/// The same of responses of which the shape alone is right: the size of the scale is the median of logarithms, as shapes are compared in them, and its sense that of most ratios.
pub(in crate::identify) fn by_shape(
    ratios: &[(f64, c64)],
    unknown: ChannelUnknowns,
    top: f64,
) -> Option<Channel> {
    let found = aligned(ratios, unknown, top)?;
    let size =
        median(ratios.iter().map(|(_, ratio)| ratio.norm().ln()).filter(|ln| ln.is_finite()).collect())?;
    let same = |(omega, ratio): &&(f64, c64)| (ratio * c64::from_polar(1.0, -omega * found.delay_s)).re > 0.0;
    let sense = if 2 * ratios.iter().filter(same).count() >= ratios.len() { 1.0 } else { -1.0 };
    Some(if unknown.scale { Channel { scale: sense * size.exp(), ..found } } else { found })
}

/// The delay of most agreement, nearest to none of those that agree alike.
fn best_delay(agreement: impl Fn(f64) -> f64, top: f64) -> f64 {
    let steps = (MAX_DELAY_PHASE_RAD / DELAY_PHASE_STEP_RAD) as i32;
    let step = DELAY_PHASE_STEP_RAD / top;
    let at_delay = |delay_s: f64| (agreement(delay_s), delay_s);
    let grid: Vec<(f64, f64)> = (-steps..=steps).map(|k| at_delay(f64::from(k) * step)).collect();
    let most = |all: &[(f64, f64)]| all.iter().map(|one| one.0).fold(f64::MIN, f64::max);
    let enough = most(&grid) - GRID_AGREEMENT_LOSS * most(&grid).abs();
    let closer = |&(_, delay_s): &(f64, f64)| {
        let (mut best, mut step) = (at_delay(delay_s), step);
        for _ in 0..DELAY_REFINEMENTS {
            step /= 10.0;
            let middle = best.1;
            let near = (-10..=10).map(|k| at_delay(middle + f64::from(k) * step));
            best = near.fold(best, |best, one| if one.0 > best.0 { one } else { best });
        }
        best
    };
    let found: Vec<(f64, f64)> = grid.iter().filter(|one| one.0 >= enough).map(closer).collect();
    let alike = most(&found) - AGREEMENT_RTOL * most(&found).abs();
    let nearest = found.iter().filter(|one| one.0 >= alike).map(|one| one.1);
    nearest.min_by(|a, b| a.abs().total_cmp(&b.abs())).unwrap_or(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    #[test]
    fn scale_and_delay_are_found_though_a_third_is_wrong() {
        let top = TAU * 400.0;
        for (scale, late) in [(-0.3, 4.7e-3), (2.0, -2e-2), (1.0, 1e-5)] {
            let ratio = |k: usize| {
                let omega = TAU * (20.0 + 3.8 * k as f64);
                let wrong =
                    if k.is_multiple_of(3) { c64::from_polar(3.0, k as f64) } else { c64::new(1.0, 0.0) };
                (omega, scale * wrong * c64::from_polar(1.0, omega * late))
            };
            let ratios: Vec<(f64, c64)> = (0..100).map(ratio).collect();
            let found = aligned(&ratios, ChannelUnknowns { scale: true, delay: true }, top).unwrap();
            // Half of the finest step in phase at the top, and what is wrong moves the best place within a few of them.
            assert!(((found.delay_s - late) * top).abs() < 0.05, "{found:?}");
            assert!((found.scale / scale - 1.0).abs() < 0.05, "{found:?}");
        }
    }

    #[test]
    fn what_is_known_stays() {
        let ratios = [(1.0, c64::new(0.5, 0.5))];
        assert_eq!(aligned(&ratios, ChannelUnknowns::default(), 1.0), Some(Channel::CALIBRATED));
        let known = aligned(&ratios, ChannelUnknowns { scale: false, delay: true }, 1.0).unwrap();
        // Among phases of a hundred radians the one that is nearest to none.
        assert!(
            known.scale == 1.0 && (known.delay_s - std::f64::consts::FRAC_PI_4).abs() < 0.01,
            "{known:?}"
        );
        assert_eq!(aligned(&[], ChannelUnknowns { scale: true, delay: false }, 1.0), None);
    }
}
