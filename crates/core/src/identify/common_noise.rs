//! Noise that all sensors have in common, as the responses themselves show it.
//!
//! Noise of the force, leakage of the window and a force that is weak at resonances change the responses of all sensors by the same factor. The sensors agree
//! then, and say together hardly more than each of them alone. What a local rational function leaves of neighbouring lines ([`super::local_fit`]), r, shows it:
//! of residuals over responses, z = r |H|/H, sensors m and n have in common
//! $$ c = \frac{\mathrm{Re} \sum z_m \bar z_n}{\frac{1}{2} \sum (|z_m|^2 + |z_n|^2)} $$

use super::dead_channel::live_channels;
use super::local_fit::{FREEDOM, LINES, neighbourhood, residuals};
use crate::c64;
use crate::frfs::{CommonNoise, Frfs, Noise, standard_deviations};
use crate::thinned::thinned;

/// Sensors and neighbourhoods that are looked at, at most, and neighbourhoods at least.
const MAX_SENSORS: usize = 12;
const MAX_NEIGHBOURHOODS: usize = 60;
const MIN_NEIGHBOURHOODS: usize = 3;

/// A neighbourhood that leaves more than this for each degree of freedom has something else than noise: modes that are too many for the function.
const MAX_CHI_SQUARED: f64 = 4.0;

/// A correlation is taken where it is so many of its standard deviations, and no smaller than this.
const MIN_DEVIATIONS: f64 = 4.0;
const MIN_CORRELATION: f64 = 0.05;

/// The same noise with what it has in common, where its size is known.
pub(super) fn with_correlation<'a>(frfs: Frfs<'a>) -> Noise<'a> {
    let Noise::Known(std) = frfs.noise else { return frfs.noise };
    let live = live_channels(frfs.receptance);
    match correlation(frfs, &live) {
        Some(correlation) => {
            let times = (1.0 + (live.len() - 1) as f64 * correlation).sqrt();
            Noise::Common(CommonNoise { std, correlation, times })
        }
        None => frfs.noise,
    }
}

/// The correlation c of all pairs of sensors; `None` if it is not significant.
fn correlation(frfs: Frfs<'_>, live: &[usize]) -> Option<f64> {
    let sensors: Vec<usize> = thinned(live, MAX_SENSORS).copied().collect();
    let firsts: Vec<usize> = (0..frfs.frequency_hz.len() / LINES).map(|k| k * LINES).collect();
    let sigma = standard_deviations(frfs.frequency_hz, frfs.receptance, frfs.noise);
    // z of each sensor whose residual is noise.
    let left = |&from: &usize| -> Vec<Vec<c64>> {
        let of_sensor = |&m: &usize| {
            let lines = neighbourhood((frfs.frequency_hz, frfs.receptance), &sigma, m, from);
            let rest = residuals(&lines)?;
            let chi_squared: f64 = rest.iter().map(|r| r.norm_sqr()).sum();
            let turned = rest.iter().zip(&lines).map(|(r, (_, h, _))| r * h.conj() / h.norm());
            (chi_squared <= MAX_CHI_SQUARED * FREEDOM as f64).then(|| turned.collect())
        };
        sensors.iter().filter_map(of_sensor).collect()
    };
    let (mut product, mut power, mut pairs, mut neighbourhoods) = (0.0, 0.0, 0, 0);
    for each in thinned(&firsts, MAX_NEIGHBOURHOODS).map(left) {
        neighbourhoods += usize::from(each.len() > 1);
        for (m, one) in each.iter().enumerate() {
            for other in &each[..m] {
                product += one.iter().zip(other).map(|(a, b)| (a * b.conj()).re).sum::<f64>();
                power += 0.5 * one.iter().chain(other).map(|z| z.norm_sqr()).sum::<f64>();
                pairs += 1;
            }
        }
    }
    if neighbourhoods < MIN_NEIGHBOURHOODS {
        return None;
    }
    let correlation = product / power;
    // Of independent noise each product has this variance: a pair has as many products as there are degrees of freedom.
    let std = ((FREEDOM * pairs) as f64).sqrt().recip();
    (correlation > MIN_CORRELATION.max(MIN_DEVIATIONS * std)).then(|| correlation.min(1.0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frequency::linear_hz;
    use crate::identify::simulated::{five_modes, normal_numbers};

    /// What is found of three sensors whose noise of one per cent has this correlation.
    fn found(correlation: f64) -> Option<CommonNoise<'static>> {
        let frequency_hz = linear_hz(20.0, 500.0, 200);
        let mut normal = normal_numbers(11);
        let exact = five_modes(0.05);
        let noisy = |&f: &f64| -> Vec<c64> {
            let common = correlation.sqrt() * normal();
            let mut own = || 1.0 + 0.01 * (common + (1.0 - correlation).sqrt() * normal());
            [0.0, 0.5, -0.4].map(|m| exact(f, m) * own()).to_vec()
        };
        let receptance: Vec<Vec<c64>> = frequency_hz.iter().map(noisy).collect();
        // √E|δx|²: twice the variance of real and imaginary part each.
        let std: Vec<Vec<f64>> =
            receptance.iter().map(|u| u.iter().map(|u| 2f64.sqrt() * 0.01 * u.norm()).collect()).collect();
        let frfs = Frfs { frequency_hz: &frequency_hz, receptance: &receptance, noise: Noise::Known(&std) };
        match with_correlation(frfs) {
            Noise::Common(common) => Some(CommonNoise { std: &[], ..common }),
            _ => None,
        }
    }

    #[test]
    fn noise_that_sensors_have_in_common_is_found() {
        assert_eq!(found(0.0), None);
        for correlation in [0.5, 1.0] {
            let common = found(correlation).unwrap();
            assert!((common.correlation - correlation).abs() < 0.15, "{common:?}");
            assert!((common.times * common.times - 1.0 - 2.0 * common.correlation).abs() < 1e-12);
        }
    }
}
