//! Where a fit begins: for given times and exponents every law is a sum with coefficients that are positive.

use super::{Datum, LawKind, ParameterKind, Parametrization};
use crate::c64;
use crate::material::saturation;

/// Times of the starts of a law with one, over the band and a decade to either side.
const RELAXATION_TIMES: usize = 6;

/// Exponents of the starts.
const START_EXPONENTS: [f64; 4] = [0.2, 0.4, 0.6, 0.85];

/// Coefficients at least, as a share of the modulus: their logarithm is to be finite, and their slope to be felt.
const MIN_COEFFICIENT_SHARE: f64 = 1e-3;

/// Sweeps over the coefficients. A start need not be exact.
const COEFFICIENT_SWEEPS: usize = 200;

/// θ of all starts for these data, which are not empty.
pub(crate) fn starts(parametrization: &Parametrization, data: &[Datum]) -> Vec<Vec<f64>> {
    let omegas = || data.iter().map(|datum| datum.omega_rad_s);
    let first = omegas().fold(f64::INFINITY, f64::min);
    let last = omegas().fold(0.0, f64::max);
    let one = |_: f64| c64::new(1.0, 0.0);
    let of = |p: Vec<f64>| parametrization.coordinates(&p);
    match parametrization.kind {
        LawKind::Constant => {
            let a = coefficients(data, &[&one, &|_| c64::I], false);
            // A storage modulus that is not positive is no start, but one there has to be.
            let size = data.iter().map(|datum| datum.modulus.norm()).sum::<f64>() / data.len() as f64;
            let storage = if a[0] > 0.0 { a[0] } else { size };
            vec![of(vec![storage, a[1] / storage])]
        }
        LawKind::Maxwell { branches } => {
            // Times over the band, beyond it, and over either half.
            let middle = (first * last).sqrt();
            let ranges = [
                [first, last],
                [first / 3.0, 3.0 * last],
                [first, middle],
                [middle, last],
                [first, 10.0 * last],
            ];
            let start = |[low, high]: [f64; 2]| {
                let times = spread(1.0 / high, 1.0 / low, branches);
                let turns: Vec<_> = times
                    .iter()
                    .map(|&tau| move |omega: f64| saturation(c64::new(0.0, omega * tau)))
                    .collect();
                let mut functions: Vec<&dyn Fn(f64) -> c64> = vec![&one];
                functions.extend(turns.iter().map(|turn| turn as &dyn Fn(f64) -> c64));
                let a = coefficients(data, &functions, true);
                let pairs = a[1..].iter().zip(&times).flat_map(|(&e, &tau)| [e, tau]);
                of(std::iter::once(a[0]).chain(pairs).collect())
            };
            ranges.into_iter().map(start).collect()
        }
        kind => {
            let has = |wanted| (0..kind.count()).any(|i| kind.parameter_kind(i) == wanted);
            let times = match has(ParameterKind::Time) {
                true => spread(0.1 / last, 10.0 / first, RELAXATION_TIMES),
                false => vec![1.0],
            };
            let exponents = if has(ParameterKind::Exponent) { &START_EXPONENTS[..] } else { &[1.0] };
            let pairs = times.iter().flat_map(|&tau| exponents.iter().map(move |&alpha| (tau, alpha)));
            pairs.map(|(tau, alpha)| of(with_moduli_of(kind, tau, alpha, data))).collect()
        }
    }
}

/// The parameters of a law with this time and this exponent whose moduli fit the data.
fn with_moduli_of(kind: LawKind, tau: f64, alpha: f64, data: &[Datum]) -> Vec<f64> {
    let of_moduli = |moduli: &[f64]| -> Vec<f64> {
        let mut left = moduli.iter().copied();
        let value = |i| match kind.parameter_kind(i) {
            ParameterKind::Modulus | ParameterKind::ModulusTimesPower => left.next().unwrap_or(0.0),
            ParameterKind::ModulusAboveFirst => moduli[0] + left.next().unwrap_or(0.0),
            ParameterKind::Time => tau,
            ParameterKind::Exponent => alpha,
            ParameterKind::LossFactor => 0.0,
        };
        (0..kind.count()).map(value).collect()
    };
    let count = (0..kind.count()).filter(|&i| kind.parameter_kind(i).is_modulus()).count();
    let units: Vec<Vec<f64>> = (0..count)
        .map(|j| of_moduli(&(0..count).map(|k| f64::from(u8::from(j == k))).collect::<Vec<_>>()))
        .collect();
    // The modulus is linear in them.
    let functions: Vec<_> =
        units.iter().map(|p| move |omega: f64| kind.with_slopes(p, c64::new(0.0, omega)).0).collect();
    let functions: Vec<&dyn Fn(f64) -> c64> = functions.iter().map(|f| f as &dyn Fn(f64) -> c64).collect();
    of_moduli(&coefficients(data, &functions, true))
}

/// `count` times from the first to the last, in equal ratios; their middle if `count` is one.
fn spread(first: f64, last: f64, count: usize) -> Vec<f64> {
    let share = |k: usize| if count == 1 { 0.5 } else { k as f64 / (count - 1) as f64 };
    (0..count).map(|k| first * (last / first).powf(share(k))).collect()
}

/// a that make Σ_j a_j b_j(ω) the data's modulus by weighted least squares, positive where they have to be: the minimum along one coefficient after the other
/// (C. L. Lawson, R. J. Hanson, *Solving Least Squares Problems*, SIAM 1995, ch. 23, for what it solves).
fn coefficients(data: &[Datum], functions: &[&dyn Fn(f64) -> c64], positive: bool) -> Vec<f64> {
    let columns: Vec<Vec<f64>> = functions
        .iter()
        .map(|b| data.iter().flat_map(|datum| datum.whitened(b(datum.omega_rad_s))).collect())
        .collect();
    let wanted: Vec<f64> = data.iter().flat_map(|datum| datum.whitened(datum.modulus)).collect();
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let size: f64 = data.iter().map(|datum| datum.modulus.norm()).sum();
    let least: Vec<f64> = functions
        .iter()
        .map(|b| {
            MIN_COEFFICIENT_SHARE * size / data.iter().map(|datum| b(datum.omega_rad_s).norm()).sum::<f64>()
        })
        .collect();
    let (mut a, mut rest) = (vec![0.0; columns.len()], wanted);
    for _ in 0..COEFFICIENT_SWEEPS {
        for (j, column) in columns.iter().enumerate() {
            let step = dot(column, &rest) / dot(column, column);
            let next = if positive { (a[j] + step).max(least[j]) } else { a[j] + step };
            let moved = if next.is_finite() { next - a[j] } else { 0.0 };
            rest.iter_mut().zip(column).for_each(|(r, c)| *r -= moved * c);
            a[j] += moved;
        }
    }
    a
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn coefficients_are_found_and_kept_positive() {
        let one = |_: f64| c64::new(1.0, 0.0);
        let slope = |omega: f64| c64::new(0.0, omega);
        let data: Vec<Datum> =
            [1.0, 2.0, 4.0].map(|omega| Datum::relative(omega, c64::new(3.0, 0.5 * omega))).to_vec();
        let a = coefficients(&data, &[&one, &slope], true);
        assert!((a[0] - 3.0).abs() < 1e-9 && (a[1] - 0.5).abs() < 1e-9, "{a:?}");
        let against: Vec<Datum> =
            data.iter().map(|d| Datum::relative(d.omega_rad_s, d.modulus.conj())).collect();
        let a = coefficients(&against, &[&one, &slope], true);
        assert!(a[1] > 0.0 && a[1] < 0.01, "{a:?}");
    }
}
