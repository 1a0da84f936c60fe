//! The lowest natural modes of an undamped structure: K φ = ω² M φ.
//!
//! Shift-and-invert block Lanczos with full M-orthogonalisation: one real factorisation of K − σM, then
//! Krylov blocks of (K − σM)⁻¹M. Blocks, so that double modes of square plates and the six rigid-body modes
//! of free bodies come out as often as they occur.
//!
//! # Source
//! R. G. Grimes, J. G. Lewis, H. D. Simon, SIAM J. Matrix Anal. Appl. 15 (1994) 228–272.

use crate::c64;
use crate::dense::symmetric_eigen;
use crate::solve::{Analysis, Breakdown};
use crate::sparse::{Pattern, SymmetricMatrix, side_by_side};
use crate::spectral::pseudo_random;

/// Natural modes, lowest first.
#[derive(Debug, Clone, PartialEq)]
pub struct Modes {
    /// ω² of each mode, in (rad/s)²; that of a rigid-body mode is zero up to roundoff, of either sign.
    pub omega_squared: Vec<f64>,
    /// φ of each mode with φᵀMφ = 1.
    pub shapes: Vec<Vec<f64>>,
    /// ‖νφ − (K − σM)⁻¹Mφ‖_M / ν of each mode with ν = 1/(ω² − σ): the relative error of ω² − σ is its square.
    pub residuals: Vec<f64>,
}

impl Modes {
    /// Natural frequencies in Hz: √ω² / 2π, zero for a rigid-body mode.
    pub fn frequencies_hz(&self) -> Vec<f64> {
        self.omega_squared.iter().map(|w2| w2.max(0.0).sqrt() / std::f64::consts::TAU).collect()
    }

    /// How many have residuals of [`CONVERGED_RESIDUAL`], or of roundoff.
    fn converged(&self, sigma: f64) -> usize {
        let lowest = self.omega_squared.first().map_or(0.0, |w2| w2 - sigma);
        let is_converged = |(&w2, &residual): (&f64, &f64)| {
            let roundoff = ROUNDOFF * f64::EPSILON * (w2 - sigma) / lowest;
            residual < roundoff.clamp(CONVERGED_RESIDUAL, LARGEST_RESIDUAL)
        };
        self.omega_squared.iter().zip(&self.residuals).filter(|&one| is_converged(one)).count()
    }
}

/// Why there are no modes.
#[derive(Debug, Clone, PartialEq)]
pub enum ModesError {
    /// K or M has complex values.
    Complex,
    /// K and M differ in size.
    Sizes {
        /// Rows of K.
        stiffness: usize,
        /// Rows of M.
        mass: usize,
    },
    /// K − σM could not be factorised or solved with.
    Breakdown(Breakdown),
    /// M is zero, or the iteration did not bring all residuals down.
    NotConverged {
        /// How many modes did converge.
        converged: usize,
    },
}

impl std::fmt::Display for ModesError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Complex => write!(f, "natural modes need real K and M"),
            Self::Sizes { stiffness, mass } => write!(f, "K has {stiffness} rows, M has {mass}"),
            Self::Breakdown(breakdown) => write!(f, "{breakdown}"),
            Self::NotConverged { converged } => write!(f, "only {converged} modes converged"),
        }
    }
}

impl std::error::Error for ModesError {}

impl From<Breakdown> for ModesError {
    fn from(breakdown: Breakdown) -> Self {
        Self::Breakdown(breakdown)
    }
}

/// Largest residual that counts as converged: eigenvalue errors are its square.
const CONVERGED_RESIDUAL: f64 = 1e-8;

/// What roundoff leaves of a residual, over ε ν_max/ν: the solution of a mode has ε of the largest of the others, which is that of a rigid-body mode. Measured are 5 to 20.
const ROUNDOFF: f64 = 100.0;

/// Residual up to which roundoff is accepted: of ω² − σ it is 1e-8.
const LARGEST_RESIDUAL: f64 = 1e-4;

/// The `count` modes of lowest |ω²|, fewer where M has a smaller rank.
///
/// # Errors
/// [`ModesError`].
///
/// # Limits
/// Modes of a multiplicity above the block size (8) may be found less often than they occur.
pub fn lowest(k: &SymmetricMatrix, m: &SymmetricMatrix, count: usize) -> Result<Modes, ModesError> {
    if k.dim() != m.dim() {
        return Err(ModesError::Sizes { stiffness: k.dim(), mass: m.dim() });
    }
    let pattern = Pattern::union(&[k.pattern(), m.pattern()]);
    let (k, m) = (k.on_pattern(&pattern), m.on_pattern(&pattern));
    let (Some(k), Some(m)) = (k.real_values(), m.real_values()) else { return Err(ModesError::Complex) };
    // A little below zero: K − σM is then positive definite for a free structure too. tr K / tr M is of
    // the order of the highest ω², and 1e-9 of it disturbs no bending mode.
    let trace = |values: &[f64]| -> f64 {
        (0..pattern.dim()).filter_map(|i| pattern.find(i, i)).map(|at| values[at]).sum()
    };
    let sigma = if trace(m) > 0.0 { -1e-9 * (trace(k) / trace(m)).abs() } else { 0.0 };
    let shifted: Vec<f64> = k.iter().zip(m).map(|(k, m)| k - sigma * m).collect();
    let factor = Analysis::new(&pattern).factor(&shifted)?;
    let times = |values: &[f64], x: &[f64]| {
        let mut out = vec![0.0; x.len()];
        side_by_side::multiply_add(&pattern, values, |a| a, x, &mut out);
        out
    };
    // A whole block at once: the factor is read once for all of its vectors.
    let solve = |columns: Vec<Vec<f64>>| -> Result<Vec<Vec<f64>>, Breakdown> {
        let mut block = columns.concat();
        factor.solve(&mut block)?;
        Ok(block.chunks(pattern.dim()).map(<[f64]>::to_vec).collect())
    };
    let mut space = Lanczos::default();
    let n = pattern.dim();
    let count = count.min(n);
    let block = (count + 1).clamp(2, 8);
    let mut candidates: Vec<Vec<f64>> = pseudo_random(n * block.div_ceil(2))
        .chunks(n)
        .flat_map(|chunk| [chunk.iter().map(|z| z.re).collect(), chunk.iter().map(|z: &c64| z.im).collect()])
        .collect();
    let limit = n.min(20 * count + 80);
    let mut modes = Modes { omega_squared: Vec::new(), shapes: Vec::new(), residuals: Vec::new() };
    while space.basis.len() < limit {
        let first = space.basis.len();
        // Through the operator once more, so that nothing is left in the null space of M.
        for candidate in solve(candidates.iter().map(|x| times(m, x)).collect())? {
            space.append(candidate, |x| times(m, x));
        }
        if space.basis.len() == first {
            break;
        }
        candidates = solve(space.mass_times[first..].to_vec())?;
        for image in &candidates {
            space.projected.push(space.mass_times.iter().map(|mv| dot(mv, image)).collect());
            space.images.push(image.clone());
        }
        modes = space.rayleigh_ritz(count, sigma, |x| times(m, x));
        if modes.converged(sigma) == count {
            return Ok(modes);
        }
    }
    let converged = modes.converged(sigma);
    // A mass matrix of small rank has fewer modes than were asked for: those there are, are all.
    if converged > 0 && converged == modes.residuals.len() && space.basis.len() < limit {
        return Ok(modes);
    }
    Err(ModesError::NotConverged { converged })
}

/// M-orthonormal basis V, MV, W = (K − σM)⁻¹MV, and T = VᵀMW by columns (entries known so far).
#[derive(Default)]
struct Lanczos {
    basis: Vec<Vec<f64>>,
    mass_times: Vec<Vec<f64>>,
    images: Vec<Vec<f64>>,
    projected: Vec<Vec<f64>>,
}

impl Lanczos {
    fn append(&mut self, mut x: Vec<f64>, mass: impl Fn(&[f64]) -> Vec<f64>) {
        let before = dot(&x, &mass(&x)).max(0.0).sqrt();
        for _ in 0..2 {
            for (v, mv) in self.basis.iter().zip(&self.mass_times) {
                let overlap = dot(mv, &x);
                x.iter_mut().zip(v).for_each(|(x, v)| *x -= overlap * v);
            }
        }
        let mx = mass(&x);
        let size = dot(&x, &mx).max(0.0).sqrt();
        // What is left after orthogonalisation is roundoff: the direction is already in the space.
        if size > 1e-12 * before {
            self.basis.push(x.iter().map(|x| x / size).collect());
            self.mass_times.push(mx.iter().map(|x| x / size).collect());
        }
    }

    fn rayleigh_ritz(&self, count: usize, sigma: f64, mass: impl Fn(&[f64]) -> Vec<f64>) -> Modes {
        let size = self.basis.len();
        let mut t = vec![0.0; size * size];
        for (j, column) in self.projected.iter().enumerate() {
            for (i, &value) in column.iter().enumerate() {
                // Both triangles from the later column: each pair is known once or twice, always the same.
                t[i + j * size] = value;
                t[j + i * size] = value;
            }
        }
        let mut modes = Modes { omega_squared: Vec::new(), shapes: Vec::new(), residuals: Vec::new() };
        let Ok((values, vectors)) = symmetric_eigen(size, &t) else { return modes };
        // ν = 1/(ω² − σ): the largest ν are the lowest modes.
        for j in (0..size).rev().take(count).filter(|&j| values[j] > 0.0) {
            let y = &vectors[j * size..(j + 1) * size];
            let shape = combine(&self.basis, y);
            let mut gap = combine(&self.images, y);
            gap.iter_mut().zip(&shape).for_each(|(g, s)| *g -= values[j] * s);
            modes.omega_squared.push(sigma + 1.0 / values[j]);
            modes.residuals.push(dot(&gap, &mass(&gap)).max(0.0).sqrt() / values[j]);
            modes.shapes.push(shape);
        }
        modes
    }
}

/// Σ y_j v_j.
fn combine(vectors: &[Vec<f64>], y: &[f64]) -> Vec<f64> {
    let mut sum = vec![0.0; vectors[0].len()];
    for (v, y) in vectors.iter().zip(y) {
        sum.iter_mut().zip(v).for_each(|(s, v)| *s += y * v);
    }
    sum
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
