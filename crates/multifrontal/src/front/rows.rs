//! The rows below a corner: L₂₁ = A₂₁ L₁₁⁻ᵀ D⁻¹, and whether it stayed small.

use super::Front;
use super::corner::{CORNER, Corner, invert_pair};
use crate::kernel::{WIDE, copy, tile_rows};
use crate::scalar::{Real, Scalar};
use crate::threads::map;
use pulp::{Simd, WithSimd};

/// Rows that one thread takes at a time.
const CHUNK: usize = 384;

/// Numbers below which another thread costs more than it brings.
const SHARE_FROM: usize = 30_000;

/// Overwrites the corner and the rows below it by L; how many of its pivots keep every entry of L under
/// the limit, counted up to the first that does not (a block of two counts as a whole).
pub(super) fn solve_rows<T: Scalar>(
    front: &mut Front<'_, T>,
    at: usize,
    corner: &Corner<T>,
    limit: f64,
    threads: usize,
) -> usize {
    let (count, rows) = (corner.d.len(), front.rows());
    for (j, i) in (0..count).flat_map(|j| (j + 1..count).map(move |i| (j, i))) {
        let parts = corner.get(i, j).parts();
        for part in 0..T::PARTS {
            front.part_mut(at + j, part, at)[i] = parts[part];
        }
    }
    // D⁻¹ by columns: what takes part, and with which factors.
    let inverse: Vec<[(usize, T); 2]> = (0..count).map(|j| inverse_column(&corner.d, j)).collect();
    let below = rows - at - count;
    let threads = if below * count < SHARE_FROM { 1 } else { threads };
    let chunk = if threads == 1 { below.max(1) } else { CHUNK };
    let mut tasks: Vec<SolveRows<'_, T>> = Vec::new();
    tasks.resize_with(below.div_ceil(chunk), || SolveRows { columns: Vec::new(), corner, inverse: &inverse });
    let (step, stride) = (front.step(), front.stride);
    for column in front.panel[at * step..].chunks_mut(stride).take(count * T::PARTS) {
        let chunks = column[at + count..rows].chunks_mut(chunk);
        tasks.iter_mut().zip(chunks).for_each(|(task, chunk)| task.columns.push(chunk));
    }
    let largest = map(threads, tasks, |task| crate::arch().dispatch(task));
    // A number that is none must not pass for a small one.
    let small = |j: usize| largest.iter().all(|largest| largest[j].into() <= limit);
    let mut accepted = 0;
    while accepted < count {
        let width = 1 + usize::from(corner.d[accepted][1] != T::default());
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
    corner: &'a Corner<T>,
    inverse: &'a [[(usize, T); 2]],
}

/// L D of the rows of a tile: `w[part][column][row]`.
type Tile<R> = [[[R; WIDE]; CORNER]; 2];

impl<T: Scalar> WithSimd for SolveRows<'_, T> {
    /// The largest entry of each column, the sum of its parts.
    type Output = [T::Real; CORNER];

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> [T::Real; CORNER] {
        let Self { mut columns, corner, inverse } = self;
        let (height, count) = (tile_rows::<T::Real, S>(), corner.d.len());
        let rows = columns.first().map_or(0, |column| column.len());
        let mut largest = [T::Real::default(); CORNER];
        let mut w: Tile<T::Real> = [[[T::Real::default(); WIDE]; CORNER]; 2];
        for from in (0..rows).step_by(height) {
            let len = height.min(rows - from);
            for j in 0..count {
                for part in 0..T::PARTS {
                    copy::<T::Real, S>(&columns[j * T::PARTS + part][from..from + len], &mut w[part][j]);
                }
                substitute::<T, S>(simd, &mut w, j, height, corner);
            }
            for (j, factors) in inverse.iter().enumerate() {
                let mut l = [[T::Real::default(); WIDE]; 2];
                for &(k, factor) in factors.iter().take(1 + usize::from(factors[1].1 != T::default())) {
                    let [re, im] = factor.parts();
                    for i in 0..len {
                        if T::PARTS == 1 {
                            l[0][i] += w[0][k][i] * re;
                        } else {
                            l[0][i] += w[0][k][i] * re - w[1][k][i] * im;
                            l[1][i] += w[0][k][i] * im + w[1][k][i] * re;
                        }
                    }
                }
                let mut most = largest[j];
                for i in 0..len {
                    let size = l[0][i].absolute() + l[1][i].absolute();
                    // A number that is none must not pass for a small one, nor be forgotten for the next.
                    #[expect(clippy::eq_op, reason = "only what is no number differs from itself")]
                    if size > most || size != size {
                        most = size;
                    }
                }
                largest[j] = most;
                for part in 0..T::PARTS {
                    let column = &mut columns[j * T::PARTS + part][from..from + len];
                    if len == height {
                        copy::<T::Real, S>(&l[part][..len], column);
                    } else {
                        column.copy_from_slice(&l[part][..len]);
                    }
                }
            }
        }
        largest
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
fn substitute<T: Scalar, S: Simd>(
    simd: S,
    w: &mut Tile<T::Real>,
    j: usize,
    height: usize,
    corner: &Corner<T>,
) {
    let [w_re, w_im] = w;
    let (before_re, own_re) = w_re.split_at_mut(j);
    let (before_im, own_im) = w_im.split_at_mut(j);
    let own_re = T::Real::vectors_mut::<S>(&mut own_re[0][..height]).0;
    let own_im = T::Real::vectors_mut::<S>(&mut own_im[0][..height]).0;
    let factors = |i: usize| {
        let l = corner.get(j, i);
        let minus = (-l).parts().map(|part| T::Real::splat(simd, part));
        (minus, T::Real::splat(simd, l.parts()[1]))
    };
    for (k, (r, m)) in own_re.iter_mut().zip(own_im).enumerate() {
        for i in 0..j {
            let (minus, im) = factors(i);
            let x = T::Real::vectors::<S>(&before_re[i][..height]).0[k];
            *r = T::Real::mul_add(simd, x, minus[0], *r);
            if T::PARTS == 2 {
                let y = T::Real::vectors::<S>(&before_im[i][..height]).0[k];
                *r = T::Real::mul_add(simd, y, im, *r);
                *m = T::Real::mul_add(simd, x, minus[1], *m);
                *m = T::Real::mul_add(simd, y, minus[0], *m);
            }
        }
    }
}
