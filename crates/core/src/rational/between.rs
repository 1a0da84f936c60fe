//! Poles between two frequencies at which they are known.

use super::Poles;
use crate::c64;

/// Poles of two neighbouring frequencies, those that are one and the same paired.
///
/// In the plane of the factor p̄ + c poles and residues move smoothly with the frequency, whatever the nominal value does: they are interpolated there, over ω². Where one
/// material is all stiffness that there is, p_k/ω² does not change at all: by it poles are paired.
///
/// # Limits
/// Off by the square of the step in frequency. A pole without a partner, weak or far from the nominal value as a rule, moves in proportion to ω² from where the nearer frequency has it.
#[derive(Debug, Clone, PartialEq)]
pub struct PolesBetween {
    ends: [Vec<Pole>; 2],
    /// ω² at both ends.
    omega_squared: [f64; 2],
    sensors: usize,
}

/// R_m/(p − p_k), or the constant R_m for a pole at infinity.
#[derive(Debug, Clone, PartialEq)]
struct Pole {
    /// p_k; `None` at infinity.
    factor: Option<c64>,
    /// R_m at each sensor.
    residues: Vec<c64>,
    /// Index of the same pole at the other end.
    partner: Option<usize>,
}

impl PolesBetween {
    /// From the poles at both ends, with the nominal values p̄ and ω² > 0 there.
    pub fn new(ends: [&Poles; 2], nominal: [c64; 2], omega_squared: [f64; 2]) -> Self {
        let [mut left, mut right] = [0, 1].map(|end| poles(ends[end], nominal[end]));
        let [low, high] = omega_squared;
        let nearest = |pole: &Pole, ratio: f64, others: &[Pole]| {
            let apart = |other: &Pole| Some((pole.factor? * ratio - other.factor?).norm_sqr());
            let apart = others.iter().enumerate().filter_map(|(k, other)| Some((k, apart(other)?)));
            apart.min_by(|a, b| a.1.total_cmp(&b.1)).map(|(k, _)| k)
        };
        for k in 0..left.len() {
            let back = |&other: &usize| nearest(&right[other], low / high, &left) == Some(k);
            let partner = nearest(&left[k], high / low, &right).filter(back);
            left[k].partner = partner;
            if let Some(other) = partner {
                right[other].partner = Some(k);
            }
        }
        Self { ends: [left, right], omega_squared, sensors: ends[0].residues.len() }
    }

    /// At a fraction t of the way from one ω² to the other, with the nominal value there.
    pub fn at(&self, t: f64, nominal: c64) -> Poles {
        let nearer = usize::from(t > 0.5);
        let (own, others) = (&self.ends[nearer], &self.ends[1 - nearer]);
        let weight = if nearer == 0 { t } else { 1.0 - t };
        let [low, high] = self.omega_squared;
        let gone = (low + t * (high - low)) / self.omega_squared[nearer];
        let mut lambda = Vec::with_capacity(own.len());
        let mut residues = vec![Vec::with_capacity(own.len()); self.sensors];
        for pole in own {
            let other = pole.partner.map(|k| &others[k]);
            let mixed = |a: c64, b: Option<c64>| b.map_or(a, |b| a + weight * (b - a));
            let there = other.and_then(|other| other.factor);
            let factor =
                pole.factor.map(|factor| there.map_or(factor * gone, |there| mixed(factor, Some(there))));
            // ρ/(1 + cλ) = R/(p − p_k) with λ = −1/(p_k − p̄) and ρ = Rλ.
            let inverse = factor.map(|factor| -(factor - nominal).inv());
            lambda.push(inverse.unwrap_or_default());
            for (m, residues) in residues.iter_mut().enumerate() {
                let residue = mixed(pole.residues[m], other.map(|other| other.residues[m]));
                residues.push(residue * inverse.unwrap_or(c64::new(1.0, 0.0)));
            }
        }
        Poles { scale: 1.0, lambda, residues }
    }
}

/// Those that the load excites and a sensor sees: the others are roundoff, and are anywhere.
fn poles(poles: &Poles, nominal: c64) -> Vec<Pole> {
    let pole = |(k, lambda): (usize, &c64)| {
        let distance = Some(-poles.scale / lambda).filter(|distance| distance.is_finite());
        let strength = distance.map_or(c64::new(1.0, 0.0), |distance| -distance);
        Pole {
            factor: distance.map(|distance| nominal + distance),
            residues: poles.residues.iter().map(|residues| residues[k] * strength).collect(),
            partner: None,
        }
    };
    let seen = poles.seen();
    poles.lambda.iter().enumerate().filter(|&(k, _)| seen[k]).map(pole).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn c(re: f64, im: f64) -> c64 {
        c64::new(re, im)
    }

    /// Two poles p_k(t) that move linearly, about a nominal value that jumps, in another scale and another order at the other end.
    #[test]
    fn poles_that_move_evenly_are_found_between() {
        let of = |t: f64, nominal: c64, scale: f64, backwards: bool| {
            let poles = [(c(3.0 + t, 0.2), c(1.0, 2.0 * t)), (c(7.0 - t, 0.1 * t), c(0.5 - t, 1.0))];
            let mut all: Vec<(c64, c64)> = poles
                .iter()
                .map(|&(p, residue)| (-scale / (p - nominal), -residue / (p - nominal)))
                .collect();
            all.push((c64::default(), c(0.3 * t, 0.0))); // at infinity
            if backwards {
                all.reverse();
            }
            let (lambda, rho) = all.into_iter().unzip();
            Poles { scale, lambda, residues: vec![rho] }
        };
        let ends = [of(0.0, c(1.0, 0.0), 2.0, false), of(1.0, c(1.5, 0.1), 5.0, true)];
        let between = PolesBetween::new([&ends[0], &ends[1]], [c(1.0, 0.0), c(1.5, 0.1)], [1.0, 1.04]);
        for t in [0.0, 0.3, 0.6, 1.0] {
            let nominal = c(1.2, -0.1);
            let (exact, found) = (of(t, nominal, 1.0, false), between.at(t, nominal));
            assert!(
                (exact.radius_per_unit() - found.radius_per_unit()).abs() < 1e-12 * exact.radius_per_unit()
            );
            let p = c(0.4, 0.2);
            let ([[x], [y]], [[a], [b]]) = (
                [exact.respond_with_slope(p).0, exact.respond_with_slope(p).1].map(|v| [v[0]]),
                [found.respond_with_slope(p).0, found.respond_with_slope(p).1].map(|v| [v[0]]),
            );
            // What is at infinity has no partner and stays as it is nearer by.
            let constant = c(0.3 * t, 0.0) - c(if t > 0.5 { 0.3 } else { 0.0 }, 0.0);
            assert!((x - a - constant).norm() < 1e-12 && (y - b).norm() < 1e-12, "{t}");
        }
    }
}
