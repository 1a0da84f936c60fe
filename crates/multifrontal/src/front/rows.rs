//! The rows below a corner: L₂₁ = A₂₁ L₁₁⁻ᵀ D⁻¹, and whether it stayed small.

use super::Front;
use super::corner::{CORNER, Corner, invert_pair};
use crate::kernel::{WIDE, copy, tile_rows};
use crate::scalar::{Real, Scalar};
use pulp::{Simd, WithSimd};

/// Overwrites the corner and the rows below it by L; how many of its pivots keep every entry of L under
/// the limit, counted up to the first that does not (a block of two counts as a whole).
pub(super) fn solve_rows<T: Scalar>(
    front: &mut Front<'_, T>,
    at: usize,
    corner: &Corner<T>,
    limit: f64,
) -> usize {
    let count = corner.d.len();
    for (j, i) in (0..count).flat_map(|j| (j + 1..count).map(move |i| (j, i))) {
        let parts = corner.get(i, j).parts();
        for part in 0..T::PARTS {
            front.part_mut(at + j, part, at)[i] = parts[part];
        }
    }
    crate::arch().dispatch(SolveRows { front, at, corner, limit })
}

struct SolveRows<'a, 'f, T: Scalar> {
    front: &'a mut Front<'f, T>,
    at: usize,
    corner: &'a Corner<T>,
    limit: f64,
}

/// L D of the rows of a tile: `w[part][column][row]`.
type Tile<R> = [[[R; WIDE]; CORNER]; 2];

impl<T: Scalar> WithSimd for SolveRows<'_, '_, T> {
    type Output = usize;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> usize {
        let Self { front, at, corner, limit } = self;
        let (height, count, rows) = (tile_rows::<T::Real, S>(), corner.d.len(), front.rows());
        // D⁻¹ by columns: what takes part, and with which factors.
        let inverse: Vec<[(usize, T); 2]> = (0..count).map(|j| inverse_column(&corner.d, j)).collect();
        let mut largest = [T::Real::default(); CORNER];
        let mut w: Tile<T::Real> = [[[T::Real::default(); WIDE]; CORNER]; 2];
        for from in (at + count..rows).step_by(height) {
            let len = height.min(rows - from);
            for j in 0..count {
                for part in 0..T::PARTS {
                    copy::<T::Real, S>(&front.part(at + j, part, from)[..len], &mut w[part][j]);
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
                    // A number that is none must not pass for a small one.
                    most = if size <= most { most } else { size };
                }
                largest[j] = most;
                for part in 0..T::PARTS {
                    let column = &mut front.part_mut(at + j, part, from)[..len];
                    if len == height {
                        copy::<T::Real, S>(&l[part][..len], column);
                    } else {
                        column.copy_from_slice(&l[part][..len]);
                    }
                }
            }
        }
        let mut accepted = 0;
        while accepted < count {
            let width = 1 + usize::from(corner.d[accepted][1] != T::default());
            if !largest[accepted..accepted + width].iter().all(|&size| size.into() <= limit) {
                break;
            }
            accepted += width;
        }
        accepted
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
