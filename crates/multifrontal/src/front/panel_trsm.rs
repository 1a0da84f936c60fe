//! The rows below a diagonal_block: L₂₁ = A₂₁ L₁₁⁻ᵀ D⁻¹, and whether it stayed small.

use super::Front;
use super::diagonal_block::{DIAGONAL_BLOCK_COLUMNS, DiagonalBlock, invert_pair};
use crate::kernel::{MAX_TILE_ROWS, TILE_OF_16_REGISTERS, TILE_OF_32_REGISTERS, copy, many, tile_rows};
use crate::scalar::{Real, Scalar, add_product};
use crate::threads::{Idle, map};
use pulp::{Simd, WithSimd};

/// Rows that one thread takes at a time.
const ROWS_PER_PIECE: usize = 192;

/// Numbers below which another thread costs more than it brings.
const MIN_SHARED_PANEL_NUMBERS: usize = 15_000;

/// What the rows below a diagonal_block are held to.
#[derive(Clone, Copy)]
pub(super) struct Limits {
    /// Of an entry of L.
    pub(super) l: f64,
    /// Of what one pivot takes from a diagonal entry, |l²d|.
    pub(super) growth: f64,
}

/// Overwrites the diagonal_block and the rows below it by L; how many of its pivots keep to the limits in every row, counted
/// up to the first that does not (a block of two counts as a whole).
pub(super) fn solve_rows<T: Scalar>(
    front: &mut Front<'_, T>,
    at: usize,
    diagonal_block: &DiagonalBlock<T>,
    limits: Limits,
    tiles: &Idle<Box<Tile<T::Real>>>,
    threads: usize,
) -> usize {
    let (count, rows) = (diagonal_block.d.len(), front.rows());
    for (j, i) in (0..count).flat_map(|j| (j + 1..count).map(move |i| (j, i))) {
        let parts = diagonal_block.get(i, j).parts();
        for part in 0..T::PARTS {
            front.part_mut(at + j, part, at + i)[0] = parts[part];
        }
    }
    // D⁻¹ by columns: what takes part, and with which factors.
    let inverse: Vec<[(usize, T); 2]> = (0..count).map(|j| inverse_column(&diagonal_block.d, j)).collect();
    let below = rows - at - count;
    let threads = if below * count < MIN_SHARED_PANEL_NUMBERS { 1 } else { threads };
    let chunk = if threads == 1 { below.max(1) } else { ROWS_PER_PIECE };
    let mut tasks: Vec<SolveRows<'_, T>> = Vec::new();
    let limits = [limits.l, limits.growth].map(T::Real::from_f64);
    tasks.resize_with(below.div_ceil(chunk), || SolveRows {
        columns: Vec::with_capacity(count * T::PARTS),
        diagonal_block,
        inverse: &inverse,
        limits,
    });
    let (packed_lower, start) = (front.packed_lower, front.packed_lower.start::<T>(at));
    for column in packed_lower.parts_mut::<T>(&mut front.panel[start..], at..at + count, at + count) {
        let chunks = column.chunks_mut(chunk);
        tasks.iter_mut().zip(chunks).for_each(|(task, chunk)| task.columns.push(chunk));
    }
    let fine = map(threads, tasks, |task| {
        tiles.lend(new_tile, |tile| crate::arch().dispatch(InTile { rows: task, tile }))
    });
    let small = |j: usize| fine.iter().all(|fine| fine[j]);
    let mut accepted = 0;
    while accepted < count {
        let width = 1 + usize::from(diagonal_block.d[accepted][1] != T::default());
        if !(accepted..accepted + width).all(small) {
            break;
        }
        accepted += width;
    }
    accepted
}

/// Some rows: the parts of their columns.
struct SolveRows<'a, T: Scalar> {
    columns: Vec<&'a mut [T::Real]>,
    diagonal_block: &'a DiagonalBlock<T>,
    inverse: &'a [[(usize, T); 2]],
    /// Of L, and of growth.
    limits: [T::Real; 2],
}

/// L D of the rows of a tile: `w[part][column][row]`.
pub(super) type Tile<R> = [[[R; MAX_TILE_ROWS]; DIAGONAL_BLOCK_COLUMNS]; 2];

fn new_tile<R: Real>() -> Box<Tile<R>> {
    Box::new([[[R::default(); MAX_TILE_ROWS]; DIAGONAL_BLOCK_COLUMNS]; 2])
}

/// Some rows, and a tile to work in.
struct InTile<'a, 'b, T: Scalar> {
    rows: SolveRows<'a, T>,
    tile: &'b mut Tile<T::Real>,
}

impl<T: Scalar> WithSimd for InTile<'_, '_, T> {
    /// Whether all entries of each column keep to the limits, the sizes of their parts added.
    type Output = [bool; DIAGONAL_BLOCK_COLUMNS];

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> [bool; DIAGONAL_BLOCK_COLUMNS] {
        let Self { rows: SolveRows { mut columns, diagonal_block, inverse, limits }, tile: w } = self;
        let height = tile_rows::<T::Real, S>();
        let rows = columns.first().map_or(0, |column| column.len());
        let mut fine = [true; DIAGONAL_BLOCK_COLUMNS];
        let mut l = [[T::Real::default(); MAX_TILE_ROWS]; 2];
        for from in (0..rows).step_by(height) {
            let len = height.min(rows - from);
            for (j, parts) in columns.chunks_exact(T::PARTS).enumerate() {
                for part in 0..T::PARTS {
                    copy::<T::Real, S>(&parts[part][from..from + len], &mut w[part][j]);
                }
            }
            substitute::<T, S>(simd, w, diagonal_block);
            for (j, parts) in columns.chunks_exact_mut(T::PARTS).enumerate() {
                times_inverse::<T>(w, &inverse[j], height, &mut l);
                fine[j] &= within::<T>(&l, [&w[0][j], &w[1][j]], height, limits);
                for part in 0..T::PARTS {
                    let column = &mut parts[part][from..from + len];
                    if len == height {
                        copy::<T::Real, S>(&l[part][..len], column);
                    } else {
                        column.copy_from_slice(&l[part][..len]);
                    }
                }
            }
        }
        fine
    }
}

/// Whether a column of L, and its products with that of L D, keep to the limits; what is no number does not.
#[inline(always)]
fn within<T: Scalar>(
    l: &[[T::Real; MAX_TILE_ROWS]; 2],
    w: [&[T::Real; MAX_TILE_ROWS]; 2],
    height: usize,
    [most, growth]: [T::Real; 2],
) -> bool {
    let size = |parts: [&[T::Real; MAX_TILE_ROWS]; 2], i: usize| {
        let re = parts[0][i].absolute();
        if T::PARTS == 2 { re + parts[1][i].absolute() } else { re }
    };
    (0..height).fold(true, |fine, i| {
        let entry = size([&l[0], &l[1]], i);
        fine & (entry <= most) & (entry * size(w, i) <= growth)
    })
}

/// A column of L: one column of L D, or two, by their factors.
#[inline(always)]
fn times_inverse<T: Scalar>(
    w: &Tile<T::Real>,
    factors: &[(usize, T); 2],
    height: usize,
    l: &mut [[T::Real; MAX_TILE_ROWS]; 2],
) {
    let [l_re, l_im] = l;
    for (term, &(k, factor)) in factors.iter().take(1 + usize::from(factors[1].1 != T::default())).enumerate()
    {
        let ([re, im], first) = (factor.parts(), term == 0);
        let (w_re, w_im) = (&w[0][k], &w[1][k]);
        for i in 0..height {
            let (mut x, mut y) = (w_re[i] * re, T::Real::default());
            if T::PARTS == 2 {
                x -= w_im[i] * im;
                y = w_re[i] * im + w_im[i] * re;
            }
            l_re[i] = if first { x } else { l_re[i] + x };
            l_im[i] = if first { y } else { l_im[i] + y };
        }
    }
}

/// The columns of L D that make a column of L, and their factors.
fn inverse_column<T: Scalar>(d: &[[T; 2]], j: usize) -> [(usize, T); 2] {
    if d[j][1] != T::default() {
        let [first, between, _] = invert_pair([d[j], d[j + 1]]);
        [(j, first), (j + 1, between)]
    } else if j > 0 && d[j - 1][1] != T::default() {
        let [_, between, second] = invert_pair([d[j - 1], d[j]]);
        [(j - 1, between), (j, second)]
    } else {
        [(j, T::ONE / d[j][0]), (j, T::default())]
    }
}

/// w_j −= Σ_{i<j} w_i l_ji.
#[inline(always)]
fn substitute<T: Scalar, S: Simd>(simd: S, w: &mut Tile<T::Real>, diagonal_block: &DiagonalBlock<T>) {
    // Constant, so that only one of them is compiled.
    match const { (many::<S>(), T::PARTS) } {
        (true, 1) => substitute_together::<T, S, { TILE_OF_32_REGISTERS.0 }, 4>(simd, w, diagonal_block),
        (true, _) => substitute_together::<T, S, { TILE_OF_32_REGISTERS.0 }, 2>(simd, w, diagonal_block),
        (false, 1) => substitute_together::<T, S, { TILE_OF_16_REGISTERS.0 }, 4>(simd, w, diagonal_block),
        (false, _) => substitute_together::<T, S, { TILE_OF_16_REGISTERS.0 }, 2>(simd, w, diagonal_block),
    }
}

/// The same for C columns of M registers at a time; what is behind the last column means nothing.
#[inline(always)]
fn substitute_together<T: Scalar, S: Simd, const M: usize, const C: usize>(
    simd: S,
    w: &mut Tile<T::Real>,
    diagonal_block: &DiagonalBlock<T>,
) {
    // No closures: they would not be compiled for these registers.
    let zero = T::Real::splat(simd, T::Real::default());
    for first in (0..diagonal_block.d.len()).step_by(C) {
        let mut sums = [[[zero; M]; 2]; C];
        for c in 0..C {
            load::<T, S, M>(w, first + c, &mut sums[c]);
        }
        let mut x = [[zero; M]; 2];
        for i in 0..first {
            load::<T, S, M>(w, i, &mut x);
            for c in 0..C {
                term::<T, S, M>(simd, &x, diagonal_block.get(first + c, i), &mut sums[c]);
            }
        }
        for c in 1..C {
            for d in 0..c {
                let x = sums[d];
                term::<T, S, M>(simd, &x, diagonal_block.get(first + c, first + d), &mut sums[c]);
            }
        }
        for c in 0..C {
            for part in 0..T::PARTS {
                T::Real::vectors_mut::<S>(&mut w[part][first + c]).0[..M].copy_from_slice(&sums[c][part]);
            }
        }
    }
}

/// The rows of a column of a tile.
#[inline(always)]
fn load<T: Scalar, S: Simd, const M: usize>(
    w: &Tile<T::Real>,
    col: usize,
    into: &mut [[<T::Real as Real>::Vector<S>; M]; 2],
) {
    for part in 0..T::PARTS {
        into[part].copy_from_slice(&T::Real::vectors::<S>(&w[part][col]).0[..M]);
    }
}

/// sum −= x l.
#[inline(always)]
fn term<T: Scalar, S: Simd, const M: usize>(
    simd: S,
    x: &[[<T::Real as Real>::Vector<S>; M]; 2],
    l: T,
    sum: &mut [[<T::Real as Real>::Vector<S>; M]; 2],
) {
    let minus = (-l).parts();
    for k in 0..M {
        [sum[0][k], sum[1][k]] = add_product::<T, S>(simd, [x[0][k], x[1][k]], minus, [sum[0][k], sum[1][k]]);
    }
}
