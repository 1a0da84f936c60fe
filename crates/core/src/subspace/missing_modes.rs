//! B-10: modes that the basis has not, counted and brought.
//!
//! Errors that are estimated at points of a box miss a narrow resonance of a mode that the basis has never met. But poles can be counted: Re D(ω, c) of a model
//! has as many negative pivots as it has modes below ω (Sylvester), and VᵀRe D V as many negative eigenvalues as it has of them. Of a box that corner counts
//! where most modes are below. With the number of missing modes m, and U the vectors that are diag(d)-orthogonal to V, the form
//! $$ A = Q\\,(\mathrm{Re}\\,D)^{-1} \mathrm{diag}(d)\\, Q, \qquad Q = 1 - V V^T \mathrm{diag}(d), $$
//! has just m negative eigenvalues on U (its inverse is the Schur complement of VᵀRe D V in Re D). Block Lanczos with A, begun with what load and sensors
//! see, meets those that matter first. Each of its Ritz vectors u of a negative value gives (Re D)⁻¹diag(d)u, which makes V count one more.
//!
//! # Source
//! J. J. Sylvester, Phil. Mag. 4 (1852) 138–142; R. G. Grimes, J. G. Lewis, H. D. Simon, SIAM J. Matrix Anal. Appl. 15 (1994) 228–272.

use super::assess::weights;
use super::basis::Basis;
use super::train::real_directions;
use super::trained_box::TrainedBox;
use super::{Point, Projection, Subspace, TrainOptions};
use crate::c64;
use crate::for_each::ForEach;
use frfit_linalg::column_block::{ColumnBlock, product};
use frfit_linalg::dense::symmetric_eigen;
use frfit_linalg::solve::{Breakdown, CheckedFactor};

/// What a count of modes found, and what was done about it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct ModeCount {
    /// Modes of the model below the corner of the box.
    pub model: usize,
    /// Those that the basis had not.
    pub missing: usize,
    /// Those of them that were brought: load or sensors see them.
    pub brought: usize,
}

/// Rows of a model up to which the modes of a box are counted: their second factor does not matter beside the first in time and memory.
pub const MAX_COUNTED_DOFS: usize = 100_000;

/// Vectors of one Lanczos block.
const BLOCK: usize = 6;

/// Lanczos vectors at most.
const MAX_LANCZOS_VECTORS: usize = 240;

/// What each mode that was brought adds to the solves that a training may take.
const SOLVES_PER_MODE: usize = 4;

/// ‖Au − θu‖ over |θ| of a Ritz vector that is good enough: the relative error of θ is about its square.
const RITZ_RTOL: f64 = 1e-4;

/// Blocks without a new negative Ritz value after which what is missing still is seen by neither load nor sensors.
const MAX_IDLE_BLOCKS: usize = 4;

/// An eigenvalue of A below this part of the largest is roundoff.
const EIGENVALUE_ROUNDOFF: f64 = 1e-13;

impl Projection {
    /// Negative eigenvalues of VᵀRe D V, the modes that the basis has below a point, and its trace.
    fn modes_below(&self, point: &Point<'_>) -> (usize, f64) {
        let theta = weights(self, &point.at, point.correction).0;
        let real: Vec<(usize, f64)> = theta.iter().map(|theta| theta.re).enumerate().collect();
        let real = self.real_sum(&real);
        let values = symmetric_eigen(self.size, &real).map_or(Vec::new(), |(values, _)| values);
        (values.iter().filter(|value| **value < 0.0).count(), values.iter().sum())
    }
}

impl<'m> Subspace<'m> {
    /// Trains over a box, and brings the modes that the basis lacks there; a box within one that it was trained in needs neither.
    ///
    /// # Errors
    /// [`Breakdown`] where a solve of the training fails.
    ///
    /// # Limits
    /// At a corner whose Re D breaks down nothing is counted, nor in a model of more than 100,000 rows.
    pub fn train_box(
        &mut self,
        points: &[Point<'m>],
        corners: &[Point<'m>],
        options: &TrainOptions,
        for_each: ForEach<'_>,
    ) -> Result<(), Breakdown> {
        let trained = TrainedBox::of(self.model, points);
        if self.boxes.iter().any(|before| before.contains(&trained)) {
            return Ok(());
        }
        self.train(points, options, for_each)?;
        if self.model.dim() <= MAX_COUNTED_DOFS {
            // At a corner on an undamped resonance modes cannot be counted. The training is valid without it.
            let count = self.bring_missing_modes(corners).ok().flatten();
            if count.is_some_and(|count| count.brought > 0) {
                self.train(points, options, for_each)?;
            }
        }
        self.boxes.push(trained);
        Ok(())
    }

    /// Counts the modes below that corner of the box where most are (B-10), and brings those that the basis has not; `None` where they cannot be
    /// counted, as Re K + σ Re M is not positive definite.
    ///
    /// # Errors
    /// [`Breakdown`] where the corner's Re D cannot be factorised or solved with.
    ///
    /// # Limits
    /// Modes that neither load nor sensors see are counted and not brought.
    pub fn bring_missing_modes(&mut self, corners: &[Point<'m>]) -> Result<Option<ModeCount>, Breakdown> {
        if !self.is_definite {
            return Ok(None);
        }
        let counted = corners.iter().map(|point| (self.projection().modes_below(point), point));
        // A basis that lacks modes may have as many at all of them: the smallest Re D decides then.
        let most = counted.max_by(|((a, of_a), _), ((b, of_b), _)| a.cmp(b).then(of_b.total_cmp(of_a)));
        let Some(((basis, _), corner)) = most else { return Ok(None) };
        let mut corrections = vec![c64::default(); corner.at.parameters.len()];
        corrections.first_mut().into_iter().for_each(|first| *first = corner.correction);
        let values: Vec<f64> = corner.at.assemble(&corrections).iter().map(|value| value.re).collect();
        let factor = self.model.analysis().factor_on(&values, self.model.threads())?;
        self.work.factorisations += 1;
        let model = factor.negative_eigenvalues();
        let missing = model.saturating_sub(basis);
        let mut count = ModeCount { model, missing, brought: 0 };
        if missing > 0 {
            let before = self.work.solves;
            let modes = self.missing_modes(&factor, missing)?;
            count.brought = self.basis.append(self.model, self.experiment, modes);
            self.more_solves += self.work.solves - before + SOLVES_PER_MODE * count.brought;
        }
        Ok(Some(count))
    }

    /// (Re D)⁻¹diag(d)u of the Ritz vectors u of negative value, N × k column after column.
    fn missing_modes(&mut self, factor: &CheckedFactor<f64>, missing: usize) -> Result<Vec<f64>, Breakdown> {
        let sensors = (0..self.experiment.sensors.len()).map(|m| self.experiment.unit_force(m));
        let seen = std::iter::once(self.experiment.load.clone()).chain(sensors);
        let dot = |a: &[f64], b: &[f64]| self.basis.force_dot(a, b);
        let mut forces: Vec<f64> =
            seen.flat_map(|force| real_directions(&force, dot)).take(BLOCK).flatten().collect();
        let mut lanczos = Lanczos::new(self.model.dim());
        let (mut found, mut idle): (Vec<Ritz>, usize) = (Vec::new(), 0);
        factor.solve(&mut forces)?;
        self.work.solves += forces.len() / self.model.dim();
        let mut next = forces;
        while lanczos.vectors.ncols() < MAX_LANCZOS_VECTORS && lanczos.append(&self.basis, next) {
            let mut images = lanczos.forces(&self.basis);
            factor.solve(&mut images)?;
            self.work.solves += images.len() / self.model.dim();
            next = lanczos.add_images(&self.basis, images);
            let negative = lanczos.negative();
            idle = if negative.len() > found.len() { 0 } else { idle + 1 };
            found = negative;
            let good = found.iter().all(|ritz| lanczos.residual(&self.basis, ritz) < RITZ_RTOL);
            if good && (found.len() >= missing || idle >= MAX_IDLE_BLOCKS) {
                break;
            }
        }
        Ok(found.iter().flat_map(|ritz| product(&lanczos.images, self.model.dim(), &ritz.y)).collect())
    }
}

/// Block Lanczos with A on the vectors outside V, with full orthogonalisation.
struct Lanczos {
    /// U, orthonormal in diag(d).
    vectors: ColumnBlock,
    /// (Re D)⁻¹diag(d)U.
    images: Vec<f64>,
    /// AU, what of the images is outside V.
    outside: Vec<f64>,
    /// Uᵀdiag(d)AU by columns, each as long as U was then.
    projected: Vec<Vec<f64>>,
}

/// An approximate eigenvalue θ of A and its vector Uy.
struct Ritz {
    theta: f64,
    y: Vec<f64>,
}

impl Lanczos {
    fn new(n: usize) -> Self {
        Self { vectors: ColumnBlock::new(n), images: Vec::new(), outside: Vec::new(), projected: Vec::new() }
    }

    /// Adds what some vectors have beyond V and U; whether there is any.
    fn append(&mut self, basis: &Basis, block: Vec<f64>) -> bool {
        let before = self.vectors.ncols();
        basis.append_outside(&mut self.vectors, block);
        self.vectors.ncols() > before
    }

    /// diag(d)u of those vectors that have no image yet.
    fn forces(&self, basis: &Basis) -> Vec<f64> {
        basis.weighted(self.vectors.columns(self.projected.len()..self.vectors.ncols()))
    }

    /// Takes in their images; returns what of them is outside V.
    fn add_images(&mut self, basis: &Basis, images: Vec<f64>) -> Vec<f64> {
        let mut outside = images.clone();
        basis.take_out(&mut outside);
        let columns = self.vectors.transpose_times(&basis.weighted(&outside));
        self.projected.extend(columns.chunks_exact(self.vectors.ncols()).map(<[f64]>::to_vec));
        self.images.extend(images);
        self.outside.extend_from_slice(&outside);
        outside
    }

    fn negative(&self) -> Vec<Ritz> {
        let k = self.projected.len();
        let mut matrix = vec![0.0; k * k];
        for (j, column) in self.projected.iter().enumerate() {
            for (i, &value) in column.iter().enumerate() {
                // Of each pair the later column has both.
                matrix[i + j * k] = value;
                matrix[j + i * k] = value;
            }
        }
        let Ok((values, vectors)) = symmetric_eigen(k, &matrix) else { return Vec::new() };
        let largest = values.iter().fold(0.0, |largest: f64, value| largest.max(value.abs()));
        let pairs = values.iter().zip(vectors.chunks_exact(k.max(1)));
        let negative = pairs.filter(|(theta, _)| **theta < -EIGENVALUE_ROUNDOFF * largest);
        negative.map(|(&theta, y)| Ritz { theta, y: y.to_vec() }).collect()
    }

    /// ‖AUy − θUy‖/|θ|.
    fn residual(&self, basis: &Basis, Ritz { theta, y }: &Ritz) -> f64 {
        let mut gap = product(&self.outside, self.vectors.nrows(), y);
        let scaled: Vec<f64> = y.iter().map(|y| theta * y).collect();
        self.vectors.subtract_times(&scaled, &mut gap);
        basis.norm(&gap) / theta.abs()
    }
}
