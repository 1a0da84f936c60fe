//! Solutions: forward through the subtrees, through what is above them and back, and back through the subtrees.
//!
//! Every part works on numbers of its own, so that parts can be shared out to threads; the sums are the same
//! whoever makes them.

mod kernel;

use crate::factor::{Factor, Node};
use crate::part::Part;
use crate::scalar::Scalar;
use crate::threads::share;
use kernel::{Backward, Buffers, Forward, Step};
use std::sync::Mutex;

/// Numbers of a factor below which another thread costs more than it brings.
const SHARE_FROM: usize = 200_000;

impl<T: Scalar> Factor<T> {
    /// Overwrites k right-hand sides (n × k, column after column) with the solutions of A X = B.
    ///
    /// Parts of the factor that a right-hand side does not touch are skipped on the way forward.
    ///
    /// # Panics
    /// Where there are not whole right-hand sides.
    ///
    /// # Limits
    /// Nothing is checked or refined here.
    pub fn solve_in_place(&self, rhs: &mut [T], threads: usize) {
        let dim = self.dim();
        if dim == 0 || rhs.is_empty() {
            return;
        }
        assert_eq!(rhs.len() % dim, 0, "whole right-hand sides");
        let columns = rhs.len() / dim;
        let numbers: usize = self.nodes.iter().map(|node| node.values.len()).sum();
        let threads = if numbers * columns < SHARE_FROM { 1 } else { threads.max(1) };
        let Some((top, subtrees)) = self.parts.split_last() else { return };
        let given: &[T] = rhs;
        let below = share(threads, subtrees, |part| {
            let mut local = self.gather(part, given, columns);
            self.forward(part, &mut local, columns);
            local
        });
        let mut above = self.gather(top, given, columns);
        for (part, local) in subtrees.iter().zip(&below) {
            let (own, size, top_size) = (part.len(), part.size(), top.len());
            for column in 0..columns {
                let changes = &local[column * size + own..][..part.outside.len()];
                for (&place, &change) in part.outside.iter().zip(changes) {
                    above[column * top_size + place as usize] += change;
                }
            }
        }
        self.forward(top, &mut above, columns);
        self.backward(top, &mut above, columns);
        let all: Vec<_> = subtrees.iter().zip(below).map(|(part, local)| (part, Mutex::new(local))).collect();
        let below = share(threads, &all, |(part, local)| {
            let mut local =
                std::mem::take(&mut *local.lock().unwrap_or_else(std::sync::PoisonError::into_inner));
            let (own, size, top_size) = (part.len(), part.size(), top.len());
            for column in 0..columns {
                for (k, &place) in part.outside.iter().enumerate() {
                    local[column * size + own + k] = above[column * top_size + place as usize];
                }
            }
            self.backward(part, &mut local, columns);
            local
        });
        self.scatter(top, &above, rhs);
        subtrees.iter().zip(&below).for_each(|(part, local)| self.scatter(part, local, rhs));
    }

    /// S b in the order of a part's positions, zeros for those outside of it.
    fn gather(&self, part: &Part, rhs: &[T], columns: usize) -> Vec<T> {
        let mut local = Vec::with_capacity(part.size() * columns);
        for b in rhs.chunks_exact(self.dim()) {
            for run in &part.own {
                let rows = self.order[run.clone()].iter().zip(&self.scale[run.clone()]);
                local.extend(rows.map(|(&row, &scale)| b[row as usize].scale(scale)));
            }
            local.resize(local.len() + part.outside.len(), T::default());
        }
        local
    }

    /// x = S y.
    fn scatter(&self, part: &Part, local: &[T], rhs: &mut [T]) {
        for (x, local) in rhs.chunks_exact_mut(self.dim()).zip(local.chunks_exact(part.size())) {
            let rows =
                part.own.iter().flat_map(|run| self.order[run.clone()].iter().zip(&self.scale[run.clone()]));
            rows.zip(local).for_each(|((&row, &scale), y)| x[row as usize] = y.scale(scale));
        }
    }

    fn nodes_of<'a>(&'a self, part: &'a Part) -> impl DoubleEndedIterator<Item = &'a Node<T>> {
        part.nodes.iter().flat_map(|run| &self.nodes[run.clone()])
    }

    /// y = L⁻¹ b over the nodes of a part; places outside receive what they have to add.
    fn forward(&self, part: &Part, local: &mut [T], columns: usize) {
        let mut buffers = Buffers::default();
        for node in self.nodes_of(part) {
            crate::arch().dispatch(Forward(Step { node, local, columns, buffers: &mut buffers }));
        }
    }

    /// x = L⁻ᵀ D⁻¹ y over the nodes of a part.
    fn backward(&self, part: &Part, local: &mut [T], columns: usize) {
        let mut buffers = Buffers::default();
        for node in self.nodes_of(part).rev() {
            crate::arch().dispatch(Backward(Step { node, local, columns, buffers: &mut buffers }));
        }
    }
}
