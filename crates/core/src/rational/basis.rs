//! An orthonormal basis of the Neumann vectors, and what the matrices make of it.

use crate::c64;
use crate::response::Response;
use frfit_linalg::solve::Breakdown;
use frfit_linalg::vector::{norm, orthogonalise};
use std::collections::VecDeque;

/// V, A_qV for q = 0 … d, and F.
#[derive(Debug, Clone)]
pub(super) struct Basis {
    /// Orthonormal vectors.
    pub(super) vectors: Vec<Vec<c64>>,
    /// `images[q][j]` is A_q v_j.
    pub(super) images: Vec<Vec<Vec<c64>>>,
    /// F.
    pub(super) load: Vec<c64>,
    /// Right-hand sides of which A₀⁻¹ may lead out of the space.
    candidates: VecDeque<Vec<c64>>,
}

impl Basis {
    /// No vector yet; the first will be x₀ = A₀⁻¹F.
    pub(super) fn start(system: &impl Response, parameter: usize) -> Self {
        let load = system.load().to_vec();
        let images = vec![Vec::new(); system.degree(parameter) + 1];
        Self { vectors: Vec::new(), images, candidates: VecDeque::from([load.clone()]), load }
    }

    /// A₀⁻¹A_q v for each vector v in turn, until there are n + 1 or the space is invariant.
    pub(super) fn extend(
        &mut self,
        system: &impl Response,
        parameter: usize,
        order: usize,
    ) -> Result<(), Breakdown> {
        while self.len() <= order {
            let Some(mut candidate) = self.candidates.pop_front() else { break };
            system.solve_nominal(&mut candidate)?;
            if !self.append(candidate) {
                continue;
            }
            let v = &self.vectors[self.vectors.len() - 1];
            for (q, image) in self.images.iter_mut().enumerate() {
                let mut product = vec![c64::default(); v.len()];
                system.multiply_add(parameter, q, c64::new(1.0, 0.0), v, &mut product);
                if q > 0 {
                    self.candidates.push_back(product.clone());
                }
                image.push(product);
            }
        }
        Ok(())
    }

    /// Whether no candidate is left: the reduced model is then the full one, as far as the load reaches.
    pub(super) fn is_invariant(&self) -> bool {
        self.candidates.is_empty()
    }

    pub(super) fn len(&self) -> usize {
        self.vectors.len()
    }

    /// Adds what of a vector is new; false where nothing is.
    fn append(&mut self, mut x: Vec<c64>) -> bool {
        let before = norm(&x);
        orthogonalise(&self.vectors, &mut x);
        let rest = norm(&x);
        // Below this the direction is made of roundoff.
        let is_new = rest > 1e-13 * before;
        if is_new {
            x.iter_mut().for_each(|x| *x /= rest);
            self.vectors.push(x);
        }
        is_new
    }
}
