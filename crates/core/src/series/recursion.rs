//! From one term of the series to the next, and the scale in which all terms are of the size of the response.

use crate::c64;
use crate::response::Response;
use frfit_linalg::solve::Breakdown;
use frfit_linalg::vector::norm;
use std::collections::VecDeque;

/// P-26 over k!/s^k, B-8: −A₀⁻¹ Σ_q s^q A_q v_{k−q}; `recent[q − 1]` is v_{k−q}.
pub(super) fn next_term(
    system: &impl Response,
    parameter: usize,
    scale: f64,
    recent: &VecDeque<Vec<c64>>,
) -> Result<Vec<c64>, Breakdown> {
    let mut next = vec![c64::default(); system.dim()];
    let mut power = -1.0;
    for (q, v) in recent.iter().take(system.degree(parameter)).enumerate() {
        power *= scale;
        system.multiply_add(parameter, q + 1, c64::new(power, 0.0), v, &mut next);
    }
    system.solve_nominal(&mut next)?;
    Ok(next)
}

/// s in z = c/s: |p̄|, or for a parameter that is nominally absent the change at which the first term equals the response.
pub(crate) fn scale(system: &impl Response, parameter: usize) -> Result<f64, Breakdown> {
    let nominal = system.nominal(parameter).norm();
    if nominal > 0.0 {
        return Ok(nominal);
    }
    let mut x = system.load().to_vec();
    system.solve_nominal(&mut x)?;
    let size = norm(&x);
    let ratio = size / norm(&next_term(system, parameter, 1.0, &VecDeque::from([x]))?);
    Ok(if ratio.is_finite() && ratio > 0.0 { ratio } else { 1.0 })
}
