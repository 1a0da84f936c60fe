//! The response as a truncated Neumann series in one parameter, all terms from one factorisation.
//!
//! P-17 with P-26, in scaled form: with z = c/s and v₀ = A₀⁻¹F,
//! $$ v_k = -A_0^{-1} \sum_{q=1}^{\min(k,d)} s^q A_q v_{k-q}, \qquad x(c) \approx \sum_{k=0}^n z^k v_k. $$
//! For d = 1 this is the paper's recursion: v_k = s^k/k! ∂ᵏx/∂cᵏ. The scale s = |p̄| keeps every v_k of the size of the
//! response, where the raw derivatives overflow at E = 1e11 Pa; no factorial is formed. Powers d > 1 are B-8.

mod along;
mod multi_index;
mod neumann;
mod radius;
mod recursion;
mod several;

pub use along::Along;
pub use multi_index::MultiIndices;
pub use neumann::NeumannSeries;
pub use radius::{ConvergenceRadius, convergence_radius};
pub(crate) use recursion::scale;
pub use several::MixedSeries;
