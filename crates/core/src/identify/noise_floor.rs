//! The floor of the noise, as the responses themselves show it.
//!
//! Where no standard deviations are given, noise is taken for a part of the response. That of an amplifier or a converter does not grow with the response, and then sensors
//! near their antiresonances count for far too much. What a local rational function leaves of neighbouring lines ([`super::local_fit`]) shows which of both it is.
//!
//! With σ = √(|x|² + floor²) and what is left of a neighbourhood, χ² = Σ|r|²/σ² with n degrees of freedom,
//! $$ \ln p = -\frac{n}{2} \left( \ln s^2 + \overline{\ln \sigma^2} \right) - \frac{\chi^2}{2 s^2} $$
//! or, where modes are too many for a neighbourhood, a size of its own that may be anything: the same whatever the noise is.

use super::dead_channel::live_channels;
use super::local_fit::{FREEDOM, LINES, neighbourhood, what_is_left};
use crate::frfs::{Frfs, Noise, NoiseFloor, standard_deviations};
use crate::median::median;
use crate::thinned::thinned;
use std::f64::consts::LN_2;

/// Floors that are tried, over the median of the response.
const FLOORS: [f64; 6] = [0.3, 0.6, 1.2, 2.5, 6.0, 20.0];

/// How a floor of the receptance falls: see [`NoiseFloor::power`].
const POWERS: [i32; 3] = [0, 1, 2];

/// Neighbourhoods that are looked at, at most and at least.
const MAX_NEIGHBOURHOODS: usize = 150;
const MIN_NEIGHBOURHOODS: usize = 5;

/// So small a floor, over the median of the response, stands for noise without one.
const NO_FLOOR: f64 = 0.02;

/// Prior probability that a neighbourhood has a residual other than noise, and the share of neighbourhoods that noise has to explain.
const UNEXPLAINED: f64 = 0.1;
const MIN_SHARE: f64 = 0.7;

/// ln of the range of sizes that something else may have: all sizes are as likely.
const RANGE: f64 = 20.0;

/// ln Γ(n/2).
const LN_GAMMA: f64 = 4.787_491_742_782_046;

/// Logarithm of the ratio of likelihoods from which on a floor is taken: of all neighbourhoods, and without those that say most for it.
///
/// Of 270 random structures whose noise is a part of the response six had more than this in all, at most 39, from what a rational function leaves of a few
/// neighbourhoods; without those they had −1.5 at most. With a floor that shows in a tenth of the lines there were 19 and more in all, and 2.1 without them.
const MIN_NATS: f64 = 15.0;
const MIN_NATS_OF_MOST: f64 = 1.0;

/// The share of neighbourhoods that is left out of the latter.
const TRIMMED: f64 = 0.15;

/// A residual below this part of the response is roundoff and the error of the rational function, and not noise.
const MIN_LEVEL: f64 = 1e-4;

/// Steps to the scale s of largest likelihood.
const SCALE_STEPS: usize = 12;

/// The same noise with the floor that the responses show, where it is not known at all.
pub(super) fn with_floor<'a>(frfs: Frfs<'a>) -> Noise<'a> {
    match frfs.noise {
        Noise::Unknown => shown_floor(frfs).map_or(Noise::Unknown, Noise::Floor),
        known => known,
    }
}

/// The likeliest floor, if noise with it is far likelier than without.
fn shown_floor(frfs: Frfs<'_>) -> Option<NoiseFloor> {
    let places: Vec<(usize, usize)> = live_channels(frfs.receptance)
        .into_iter()
        .flat_map(|m| (0..frfs.frequency_hz.len() / LINES).map(move |k| (m, k * LINES)))
        .collect();
    let places: Vec<(usize, usize)> = thinned(&places, MAX_NEIGHBOURHOODS).copied().collect();
    if places.len() < MIN_NEIGHBOURHOODS {
        return None;
    }
    let left = |noise: Noise<'_>| what_noise_leaves(frfs, noise, &places);
    let assumed = left(Noise::Unknown)?;
    let as_assumed = Likelihood::new(&assumed, &assumed).filter(|one| one.level >= MIN_LEVEL)?;
    let of = |floor: NoiseFloor| Likelihood::new(&left(Noise::Floor(floor))?, &assumed);
    let base = match of(NoiseFloor { over_median: NO_FLOOR, power: 0 }) {
        Some(proportional) if proportional.nats() > as_assumed.nats() => proportional,
        _ => as_assumed,
    };
    let floors =
        POWERS.into_iter().flat_map(|power| FLOORS.map(|over_median| NoiseFloor { over_median, power }));
    let tried = floors.filter_map(|floor| Some((of(floor)?, floor)));
    let (best, floor) = tried.max_by(|(a, _), (b, _)| a.nats().total_cmp(&b.nats()))?;
    let is_likelier =
        best.nats() - base.nats() > MIN_NATS && best.nats_of_most_over(&base) > MIN_NATS_OF_MOST;
    (is_likelier && best.share >= MIN_SHARE).then_some(floor)
}

/// χ² of what a rational function leaves of each neighbourhood (sensor, first line), and the mean of ln σ² there; `None` where one has no fit.
fn what_noise_leaves(frfs: Frfs<'_>, noise: Noise<'_>, places: &[(usize, usize)]) -> Option<Vec<(f64, f64)>> {
    let sigma = standard_deviations(frfs.frequency_hz, frfs.receptance, noise);
    let left = |&(m, from): &(usize, usize)| {
        let lines = neighbourhood((frfs.frequency_hz, frfs.receptance), &sigma, m, from);
        let of_sigma = lines.iter().map(|line| 2.0 * line.2.ln()).sum::<f64>() / LINES as f64;
        Some((what_is_left(&lines)?, of_sigma))
    };
    places.iter().map(left).collect()
}

/// How likely noise is.
struct Likelihood {
    /// ln p of each neighbourhood.
    each: Vec<f64>,
    /// s, at which that is largest.
    level: f64,
    /// The share of neighbourhoods that noise explains.
    share: f64,
}

impl Likelihood {
    /// Of what is left with some noise, beside what is left with the noise that is assumed otherwise.
    fn new(left: &[(f64, f64)], assumed: &[(f64, f64)]) -> Option<Self> {
        let n = FREEDOM as f64;
        let count = left.len() as f64;
        // Both without (2π)^−n/2.
        let of_noise = |square: f64, (chi, of_sigma): (f64, f64)| {
            (1.0 - UNEXPLAINED).ln() - 0.5 * n * (square.ln() + of_sigma) - 0.5 * chi / square
        };
        // ∫ of the same over all sizes s, of which each e-fold is as likely.
        let of_other = |(chi, of_sigma): (f64, f64)| {
            (0.5 * UNEXPLAINED / RANGE).ln() + LN_GAMMA - 0.5 * n * (chi.ln() + of_sigma - LN_2)
        };
        let each = |square: f64| {
            let of_one = move |(&one, &assumed): (&(f64, f64), &(f64, f64))| {
                let (noise, other) = (of_noise(square, one), of_other(assumed));
                let most = noise.max(other);
                let sum = most + ((noise - most).exp() + (other - most).exp()).ln();
                (sum, (noise - sum).exp(), one.0)
            };
            left.iter().zip(assumed).map(of_one).collect::<Vec<(f64, f64, f64)>>()
        };
        // What most neighbourhoods have, then what those have that it explains.
        let mut square = median(left.iter().map(|(chi, _)| *chi).collect())? / n;
        for _ in 0..SCALE_STEPS {
            let each = each(square);
            let shares: f64 = each.iter().map(|(_, share, _)| share).sum();
            if shares < 1.0 {
                return None;
            }
            square = each.iter().map(|(_, share, chi)| share * chi).sum::<f64>() / (n * shares);
        }
        let each = each(square);
        let share = each.iter().map(|(_, share, _)| share).sum::<f64>() / count;
        let each: Vec<f64> = each.into_iter().map(|(sum, ..)| sum).collect();
        each.iter().all(|sum| sum.is_finite()).then_some(Self { each, level: square.sqrt(), share })
    }

    fn nats(&self) -> f64 {
        self.each.iter().sum()
    }

    /// By how much ln p is larger than another one, without the neighbourhoods that gain most: what a rational function leaves of a few of them may look like a floor.
    fn nats_of_most_over(&self, other: &Self) -> f64 {
        let mut gains: Vec<f64> = self.each.iter().zip(&other.each).map(|(a, b)| a - b).collect();
        gains.sort_by(f64::total_cmp);
        let counted = ((1.0 - TRIMMED) * gains.len() as f64) as usize;
        gains[..counted].iter().sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::c64;
    use crate::frequency::linear_hz;
    use crate::identify::simulated::{five_modes, normal_numbers};

    /// A structure of some modes, as narrow as asked, and noise that is a part of the response, or has a floor that is white in some derivative of the displacement.
    fn found(loss: f64, of: impl Fn(f64, f64) -> f64) -> Option<NoiseFloor> {
        let frequency_hz = linear_hz(20.0, 500.0, 200);
        let mut normal = normal_numbers(11);
        let exact = five_modes(loss);
        let receptance: Vec<Vec<c64>> = frequency_hz
            .iter()
            .map(|&f| [0.0, 0.5].map(|m| exact(f, m)).map(|u| u + of(u.norm(), f) * normal()).to_vec())
            .collect();
        let frfs = Frfs { frequency_hz: &frequency_hz, receptance: &receptance, noise: Noise::Unknown };
        assert_eq!(with_floor(Frfs { noise: Noise::Known(&[]), ..frfs }), Noise::Known(&[]));
        match with_floor(frfs) {
            Noise::Floor(floor) => Some(floor),
            _ => None,
        }
    }

    #[test]
    fn a_floor_is_taken_where_the_noise_has_one() {
        for noise in [0.0, 1e-3, 0.02] {
            assert_eq!(found(0.05, |size, _| noise * size), None, "{noise}");
        }
        for (power, floor) in [(0, 1e-6), (2, 0.03)] {
            let of = |_: f64, f: f64| floor * f.powi(-power);
            let found = found(0.05, of).unwrap();
            assert!(found.power == power && found.over_median >= 2.5, "{found:?}");
        }
    }

    /// Between antiresonances the noise is a part of the response.
    #[test]
    fn a_floor_is_taken_that_shows_in_few_lines() {
        assert!(found(0.1, |size, _| 0.01 * size.hypot(5e-5)).is_some());
    }

    /// Resonances narrower than two lines are no noise.
    #[test]
    fn what_a_rational_function_leaves_of_narrow_modes_is_no_floor() {
        assert_eq!(found(1e-4, |size, _| 1e-3 * size), None);
    }
}
