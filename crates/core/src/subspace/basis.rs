//! A real basis V, orthonormal in a norm in which all degrees of freedom count alike.

use super::parts::Parts;
use super::projection::Projection;
use super::sketch::Sketch;
use crate::c64;
use crate::model::{DynamicStiffness, Experiment};
use frfit_linalg::column_block::ColumnBlock;
use std::sync::Arc;

/// V with Vᵀ diag(d) V = 1, and everything small that belongs to it. A clone shares what is long, until it grows.
#[derive(Debug, Clone)]
pub(super) struct Basis {
    /// d, the diagonal of the first shifted stiffness: it makes translations and rotations, steel and rubber comparable.
    pub(super) weight: Arc<[f64]>,
    vectors: Arc<ColumnBlock>,
    sketch: Sketch,
    pub(super) projection: Projection,
}

/// A vector of which less than this is new (in the d-norm) adds roundoff, not a direction.
const NEW_DIRECTION_RTOL: f64 = 1e-8;

impl Basis {
    pub(super) fn new(weight: Vec<f64>, parts: Parts, experiment: &Experiment) -> Self {
        let sketch = Sketch::new(weight.iter().map(|d| 1.0 / d));
        let sensors = experiment.sensors.len();
        let forces =
            std::iter::once(experiment.load.clone()).chain((0..sensors).map(|m| experiment.unit_force(m)));
        let projection = Projection {
            size: 0,
            matrices: vec![Vec::new(); parts.len()],
            images: vec![Vec::new(); parts.len()],
            load: Vec::new(),
            sensors: vec![Vec::new(); sensors],
            sketched: forces.map(|force| sketch.of(&force)).collect(),
            gain: 0.0,
            parts,
        };
        Self { vectors: Arc::new(ColumnBlock::new(weight.len())), sketch, weight: weight.into(), projection }
    }

    /// One that was kept.
    pub(super) fn kept(weight: Vec<f64>, vectors: Vec<f64>, projection: Projection) -> Self {
        let sketch = Sketch::new(weight.iter().map(|d| 1.0 / d));
        let vectors = Arc::new(ColumnBlock::from_columns(weight.len(), vectors));
        Self { vectors, sketch, weight: weight.into(), projection }
    }

    /// V.
    pub(super) fn vectors(&self) -> &ColumnBlock {
        &self.vectors
    }

    /// √Σ d x².
    pub(super) fn norm(&self, x: &[f64]) -> f64 {
        self.weight.iter().zip(x).map(|(d, x)| d * x * x).sum::<f64>().sqrt()
    }

    /// Σ a b / d, the product that belongs to forces.
    pub(super) fn force_dot(&self, a: &[f64], b: &[f64]) -> f64 {
        self.weight.iter().zip(a.iter().zip(b)).map(|(d, (a, b))| a * b / d).sum()
    }

    /// f/√d: the plain product of two of these is that of the forces.
    pub(super) fn plain_force(&self, force: &[f64]) -> Vec<f64> {
        self.weight.iter().zip(force).map(|(d, f)| f / d.sqrt()).collect()
    }

    /// diag(d) X, N × k column after column.
    pub(super) fn weighted(&self, block: &[f64]) -> Vec<f64> {
        let n = self.weight.len();
        block.chunks_exact(n).flat_map(|x| x.iter().zip(self.weight.iter()).map(|(x, d)| x * d)).collect()
    }

    /// Takes out of some vectors (N × k, column after column) what V has of them.
    pub(super) fn take_out(&self, block: &mut [f64]) {
        // Twice is enough (Kahan, Parlett).
        for _ in 0..2 {
            let overlap = self.vectors.transpose_times(&self.weighted(block));
            self.vectors.subtract_times(&overlap, block);
        }
    }

    /// Adds what is new of some vectors (N × k, column after column); returns how many were.
    pub(super) fn append(
        &mut self,
        model: &DynamicStiffness,
        experiment: &Experiment,
        mut block: Vec<f64>,
    ) -> usize {
        let n = self.weight.len();
        let before: Vec<f64> = block.chunks_exact(n).map(|x| self.norm(x)).collect();
        let first = self.vectors.ncols();
        self.take_out(&mut block);
        let vectors = Arc::make_mut(&mut self.vectors);
        for (x, before) in block.chunks_exact_mut(n).zip(before) {
            append_new(&self.weight, (vectors, first), x, NEW_DIRECTION_RTOL * before);
        }
        self.project(model, experiment, first);
        self.vectors.ncols() - first
    }

    /// Adds to other vectors, orthonormal in diag(d), what is new of some (N × k, column after column): beyond them, and beyond V.
    pub(super) fn append_outside(&self, vectors: &mut ColumnBlock, mut block: Vec<f64>) {
        let n = self.weight.len();
        let before: Vec<f64> = block.chunks_exact(n).map(|x| self.norm(x)).collect();
        self.take_out(&mut block);
        for (x, before) in block.chunks_exact_mut(n).zip(before) {
            append_new(&self.weight, (vectors, 0), x, NEW_DIRECTION_RTOL * before);
        }
    }

    /// Everything small that belongs to the vectors from `first` on.
    fn project(&mut self, model: &DynamicStiffness, experiment: &Experiment, first: usize) {
        let (n, r) = (self.weight.len(), self.vectors.ncols());
        let small = &mut self.projection;
        let (new, count) = (self.vectors.columns(first..r), small.parts.len());
        // S_g V_new for all g side by side: V, which is long, is met once for all of them.
        let mut images = vec![0.0; count * new.len()];
        for (g, images) in images.chunks_exact_mut(new.len().max(1)).enumerate() {
            small.parts.multiply_add(model, g, new, images);
            images.chunks_exact(n).for_each(|image| small.images[g].extend(self.sketch.of(image)));
        }
        let columns = self.vectors.transpose_times(&images);
        for (matrix, columns) in small.matrices.iter_mut().zip(columns.chunks(r * (r - first).max(1))) {
            *matrix = bordered(matrix, first, columns, r);
        }
        for j in first..r {
            let v = self.vectors.column(j);
            small.load.push(experiment.load.iter().zip(v).map(|(f, v)| f * v).sum::<c64>());
            for (sensor, at) in small.sensors.iter_mut().zip(&experiment.sensors) {
                sensor.push(at.sign * v[at.row]);
            }
        }
        small.size = r;
    }
}

/// Adds to vectors that are orthonormal in diag(d) what a vector has beyond those from `first` on, where that is longer than `least`.
fn append_new(weight: &[f64], (vectors, first): (&mut ColumnBlock, usize), x: &mut [f64], least: f64) {
    let dot = |a: &[f64], b: &[f64]| -> f64 {
        weight.iter().zip(a.iter().zip(b)).map(|(d, (a, b))| d * a * b).sum()
    };
    for _ in 0..2 {
        for j in first..vectors.ncols() {
            let v = vectors.column(j);
            let overlap = dot(v, x);
            x.iter_mut().zip(v).for_each(|(x, v)| *x -= overlap * v);
        }
    }
    let rest = dot(x, x).sqrt();
    if rest > least {
        x.iter_mut().for_each(|x| *x /= rest);
        vectors.push(x);
    }
}

/// A symmetric `first` × `first` matrix grown to r × r by its last columns (r rows each).
fn bordered(old: &[f64], first: usize, columns: &[f64], r: usize) -> Vec<f64> {
    let mut grown = vec![0.0; r * r];
    for j in 0..first {
        grown[j * r..j * r + first].copy_from_slice(&old[j * first..(j + 1) * first]);
    }
    for (j, column) in (first..r).zip(columns.chunks_exact(r)) {
        // The upper triangle of the new columns, and its mirror image.
        for (i, &value) in column[..=j].iter().enumerate() {
            grown[i + j * r] = value;
            grown[j + i * r] = value;
        }
    }
    grown
}
