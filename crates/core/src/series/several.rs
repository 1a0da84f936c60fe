//! The response as a truncated Taylor series in several parameters, all mixed derivatives from one factorisation.
//!
//! P-17 with P-10 and B-8: with z_j = c_j/s_j, multi-indices α and v_0 = A₀⁻¹F,
//! $$ v_\alpha = -A_0^{-1} \sum_j \sum_{q=1}^{\min(\alpha_j, d_j)} s_j^q A_{j,q} v_{\alpha - q e_j}, \qquad x(c) \approx \sum_{|\alpha| \le n} z^\alpha v_\alpha, $$
//! and v_α = s^α/α! ∂^{|α|}x/∂c^α. For one parameter this is [`NeumannSeries`](super::NeumannSeries), term by term.
//!
//! One solve for each multi-index, C(n + J, J) in all, those of one total order as one block. A_{j,q} v_β goes into v_{β + q e_j} and nowhere
//! else, so each product is formed once: Σ_j Σ_{q ≤ d_j} C(n − q + J, J) of them.

use super::MultiIndices;
use super::recursion::scale;
use crate::c64;
use crate::response::Response;
use frfit_linalg::solve::Breakdown;
use std::collections::VecDeque;

/// Scaled Taylor coefficients of the response at every sensor, about the nominal values of all parameters of a model.
#[derive(Debug, Clone, PartialEq)]
pub struct MixedSeries {
    indices: MultiIndices,
    /// s_j in z_j = c_j/s_j; each of the unit of its parameter.
    scales: Vec<f64>,
    /// `terms[m][k]` is t_α = s^α/α! ∂^{|α|}x_m/∂c^α for the k-th multi-index, a receptance.
    terms: Vec<Vec<c64>>,
}

impl MixedSeries {
    /// All terms up to total order n in the first `parameters` parameters.
    ///
    /// C(n + J, J) solves with the nominal factor, and two more for each parameter that is nominally absent, for its scale.
    ///
    /// # Errors
    /// [`Breakdown`] where a solve with A₀ fails.
    ///
    /// # Panics
    /// Where `parameters` is zero.
    ///
    /// # Limits
    /// Parameters do not multiply one another (P-10: D has no terms c_i c_j). Memory is that of the vectors of the highest max d_j + 1 total orders, of which
    /// order k has C(k + J − 1, J − 1). Along a direction it converges as [`super::Along`] says.
    pub fn new(system: &impl Response, parameters: usize, order: usize) -> Result<Self, Breakdown> {
        let indices = MultiIndices::new(parameters, order);
        let scales = (0..parameters).map(|j| scale(system, j)).collect::<Result<Vec<f64>, _>>()?;
        let n = system.dim();
        let degree = (0..parameters).map(|j| system.degree(j)).max().unwrap_or(0);
        let mut terms = vec![Vec::with_capacity(indices.count()); system.sensors()];
        // Blocks of v_α, those of total order k − 1 first, then k − 2 … k − d.
        let mut recent: VecDeque<Vec<c64>> = VecDeque::new();
        for k in 0..=order {
            let alphas = indices.of_order(k);
            let mut block = vec![c64::default(); n * alphas.len()];
            match k {
                0 => block.copy_from_slice(system.load()),
                _ => {
                    for (alpha, force) in alphas.iter().zip(block.chunks_exact_mut(n.max(1))) {
                        add_forces(system, indices, &scales, alpha, &recent, force);
                    }
                }
            }
            system.solve_nominal_block(&mut block)?;
            for v in block.chunks_exact(n.max(1)) {
                terms.iter_mut().zip(system.observe(v)).for_each(|(sensor, t)| sensor.push(t));
            }
            recent.push_front(block);
            recent.truncate(degree.max(1));
        }
        Ok(Self { indices, scales, terms })
    }

    /// Which multi-indices there are, in the order of [`Self::coefficients`].
    pub fn indices(&self) -> MultiIndices {
        self.indices
    }

    /// s_j in z_j = c_j/s_j.
    pub fn scales(&self) -> &[f64] {
        &self.scales
    }

    /// t_α at a sensor, one for each multi-index.
    pub fn coefficients(&self, sensor: usize) -> &[c64] {
        &self.terms[sensor]
    }

    /// Receptance at the sensors with the corrections c, truncated after total order `order`, P-17.
    ///
    /// # Panics
    /// Where there is not one correction for each parameter.
    pub fn respond(&self, corrections: &[c64], order: usize) -> Vec<c64> {
        assert_eq!(corrections.len(), self.scales.len(), "one correction for each parameter");
        let z: Vec<c64> = corrections.iter().zip(&self.scales).map(|(c, s)| c / s).collect();
        let order = order.min(self.indices.order());
        let mut alpha = vec![0; z.len()];
        self.terms.iter().map(|t| nested(self.indices, t, &z, &mut alpha, 0, order)).collect()
    }

    /// ∂^{|α|}x/∂c^α at the sensors and the nominal values: m/N over the parameters' units to their powers. `None` for |α| > n.
    ///
    /// # Panics
    /// Where α has not one entry for each parameter.
    ///
    /// # Limits
    /// High ones of parameters in Pa underflow, as those of [`NeumannSeries::derivative`](super::NeumannSeries::derivative) do; relative ones
    /// ([`Self::coefficients`]) do not.
    pub fn derivative(&self, alpha: &[usize]) -> Option<Vec<c64>> {
        let k = self.indices.position(alpha)?;
        let factors = alpha.iter().zip(&self.scales).flat_map(|(&a, s)| (1..=a).map(move |i| i as f64 / s));
        Some(self.terms.iter().map(|t| factors.clone().fold(t[k], |value, factor| value * factor)).collect())
    }

    /// x_m(t d) as a polynomial in t at a sensor, for a direction d of the corrections: its coefficient of t^k is Σ_{|α|=k} t_α Π (d_j/s_j)^{α_j}.
    ///
    /// # Panics
    /// Where there is no such sensor, or not one entry of d for each parameter.
    pub fn along(&self, sensor: usize, direction: &[c64]) -> Vec<c64> {
        assert_eq!(direction.len(), self.scales.len(), "one entry for each parameter");
        let z: Vec<c64> = direction.iter().zip(&self.scales).map(|(d, s)| d / s).collect();
        let mut polynomial = vec![c64::default(); self.indices.order() + 1];
        for (alpha, t) in self.indices.all().iter().zip(&self.terms[sensor]) {
            let monomial: c64 = alpha.iter().zip(&z).map(|(&a, z)| z.powu(a as u32)).product();
            polynomial[alpha.iter().sum::<usize>()] += t * monomial;
        }
        polynomial
    }
}

/// force −= Σ_j Σ_q s_j^q A_{j,q} v_{α − q e_j}; `recent[q − 1]` has the vectors of total order |α| − q.
fn add_forces(
    system: &impl Response,
    indices: MultiIndices,
    scales: &[f64],
    alpha: &[usize],
    recent: &VecDeque<Vec<c64>>,
    force: &mut [c64],
) {
    let n = force.len();
    let mut before = alpha.to_vec();
    for (j, &scale) in scales.iter().enumerate() {
        let mut power = -1.0;
        for (q, block) in (1..=system.degree(j).min(alpha[j])).zip(recent) {
            power *= scale;
            before[j] = alpha[j] - q;
            let at = indices.within_order(&before);
            system.multiply_add(j, q, c64::new(power, 0.0), &block[at * n..][..n], force);
        }
        before[j] = alpha[j];
    }
}

/// Horner's rule, one parameter inside the other: Σ of t_α z^α over what `alpha` does not fix yet, of total order `left` at most.
fn nested(indices: MultiIndices, t: &[c64], z: &[c64], alpha: &mut [usize], j: usize, left: usize) -> c64 {
    if j == z.len() {
        return indices.position(alpha).map_or(c64::default(), |k| t[k]);
    }
    let mut sum = c64::default();
    for entry in (0..=left).rev() {
        alpha[j] = entry;
        sum = sum * z[j] + nested(indices, t, z, alpha, j + 1, left - entry);
    }
    alpha[j] = 0;
    sum
}
