//! The innermost product: a few registers of rows times a few columns.

use crate::scalar::Real;
use pulp::Simd;

/// Registers of rows and columns of a tile on a processor with so many registers: its sums stay in them, beside the
/// rows and one number of the other factor.
pub(crate) const TILE_OF_32_REGISTERS: (usize, usize) = (3, 8);
/// The same for the sixteen registers of AVX2.
pub(crate) const TILE_OF_16_REGISTERS: (usize, usize) = (2, 6);
/// The most rows of a tile: three registers of sixteen single-precision numbers.
pub(crate) const MAX_TILE_ROWS: usize = 48;

/// Whether a tile has the shape [`TILE_OF_32_REGISTERS`], not [`TILE_OF_16_REGISTERS`].
pub(crate) const fn many<S: Simd>() -> bool {
    S::REGISTER_COUNT >= 32
}

/// Registers of rows and columns of a tile.
pub(super) const fn shape<S: Simd>() -> (usize, usize) {
    if many::<S>() { TILE_OF_32_REGISTERS } else { TILE_OF_16_REGISTERS }
}

/// Rows of a tile.
#[inline(always)]
pub(crate) fn tile_rows<R: Real, S: Simd>() -> usize {
    shape::<S>().0 * R::lanes::<S>()
}

/// Σₖ aₖ bₖᵀ with the rows a packed register after register and the columns b number after number.
#[inline(always)]
pub(super) fn tile<R: Real, S: Simd, const M: usize, const N: usize>(
    simd: S,
    a: &[R::Vector<S>],
    b: &[R],
) -> [[R::Vector<S>; M]; N] {
    let mut sums = [[R::splat(simd, R::default()); M]; N];
    for (a, b) in a.as_chunks::<M>().0.iter().zip(b.as_chunks::<N>().0) {
        for (sums, &b) in sums.iter_mut().zip(b) {
            let b = R::splat(simd, b);
            for (sum, &a) in sums.iter_mut().zip(a) {
                *sum = R::mul_add(simd, a, b, *sum);
            }
        }
    }
    sums
}

/// The sums of a tile as numbers, the columns `step` apart.
#[inline(always)]
pub(super) fn store<R: Real, S: Simd, const M: usize, const N: usize>(
    sums: [[R::Vector<S>; M]; N],
    into: &mut [R],
    step: usize,
) {
    for (into, sums) in into.chunks_mut(step).zip(sums) {
        R::vectors_mut::<S>(into).0[..M].copy_from_slice(&sums);
    }
}

/// Copies the rows of a tile, and clears what is behind them.
#[inline(always)]
pub(crate) fn copy<R: Real, S: Simd>(from: &[R], into: &mut [R]) {
    let height = tile_rows::<R, S>();
    let into = &mut into[..height];
    if from.len() == height {
        // In registers: a call for so few numbers costs more than they do.
        let (from, into) = (R::vectors::<S>(from).0, R::vectors_mut::<S>(into).0);
        from.iter().zip(into).for_each(|(&from, into)| *into = from);
    } else {
        into[..from.len()].copy_from_slice(from);
        into[from.len()..].fill(R::default());
    }
}
