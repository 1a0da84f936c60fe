//! The diagonal block of a few candidates, factorised with pivots of one and two.

use super::Front;
use super::rook::{largest, rook};
use crate::scalar::{Real, Scalar};
use pulp::{Simd, WithSimd};

/// Columns of a diagonal_block: their rows fill whole registers of every instruction set.
pub(super) const DIAGONAL_BLOCK_COLUMNS: usize = 32;

type Columns<R> = [[R; DIAGONAL_BLOCK_COLUMNS]; DIAGONAL_BLOCK_COLUMNS];

/// L and D of a diagonal block, in parts so that registers hold real numbers.
pub(super) struct DiagonalBlock<T: Scalar> {
    parts: [Columns<T::Real>; 2],
    /// Exchanges that were made, in their order.
    pub(super) exchanges: Vec<(usize, usize)>,
    /// D of the columns that could be eliminated.
    pub(super) d: Vec<[T; 2]>,
    width: usize,
}

impl<T: Scalar> DiagonalBlock<T> {
    pub(super) fn new() -> Box<Self> {
        let parts = [[[T::Real::default(); DIAGONAL_BLOCK_COLUMNS]; DIAGONAL_BLOCK_COLUMNS]; 2];
        Box::new(Self { parts, exchanges: Vec::new(), d: Vec::new(), width: 0 })
    }

    /// Factorises the block of `width` candidates from `at`.
    pub(super) fn factor(&mut self, front: &Front<'_, T>, at: usize, width: usize) {
        self.clear(width);
        for j in 0..width {
            for part in 0..T::PARTS {
                let column = &front.part(at + j, part, at + j)[..width - j];
                self.parts[part][j][j..width].copy_from_slice(column);
            }
        }
        crate::arch().dispatch(Factor(self));
    }

    /// A block of one or two candidates as a pivot, whatever it is.
    pub(super) fn force(&mut self, front: &Front<'_, T>, at: usize, width: usize) {
        self.clear(width);
        self.d.push([front.at(at, at), T::default()]);
        if width == 2 {
            self.d[0][1] = front.at(at + 1, at);
            self.d.push([front.at(at + 1, at + 1), T::default()]);
        }
    }

    fn clear(&mut self, width: usize) {
        self.width = width;
        self.exchanges.clear();
        self.d.clear();
        // Whole columns are worked on: what is behind the block stays 0.
        self.parts.iter_mut().flatten().for_each(|column| column.fill(T::Real::default()));
    }

    /// Entry of L below its diagonal.
    #[inline(always)]
    pub(super) fn get(&self, row: usize, col: usize) -> T {
        T::from_parts([self.parts[0][col][row], self.parts[1][col][row]])
    }

    #[inline(always)]
    fn set(&mut self, row: usize, col: usize, value: T) {
        let parts = value.parts();
        for p in 0..T::PARTS {
            self.parts[p][col][row] = parts[p];
        }
    }

    fn exchange(&mut self, i: usize, j: usize) {
        if i == j {
            return;
        }
        let (i, j) = (i.min(j), i.max(j));
        self.exchanges.push((i, j));
        for columns in self.parts.iter_mut().take(T::PARTS) {
            columns.iter_mut().take(i).for_each(|column| column.swap(i, j));
            let (left, right) = columns.split_at_mut(j);
            std::mem::swap(&mut left[i][i], &mut right[0][j]);
            for k in i + 1..j {
                let entry = left[k][j];
                left[k][j] = std::mem::replace(&mut left[i][k], entry);
            }
            left[i][j + 1..].swap_with_slice(&mut right[0][j + 1..]);
        }
    }
}

struct Factor<'a, T: Scalar>(&'a mut DiagonalBlock<T>);

impl<T: Scalar> WithSimd for Factor<'_, T> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let diagonal_block = self.0;
        let (mut at, mut end) = (0, diagonal_block.width);
        // What is nothing against entries of at most 1, as scaling leaves them.
        let nothing = T::Real::ROUNDOFF * T::Real::ROUNDOFF;
        while at < end {
            let size = |i: usize, j: usize| diagonal_block.get(i, j).size();
            let found = largest(at, at..end, size);
            if size(at, at).max(found.1) <= nothing {
                end -= 1;
                diagonal_block.exchange(at, end);
                continue;
            }
            let (first, second) = rook(at..end, found, size);
            diagonal_block.exchange(at, first);
            if let Some(second) = second {
                diagonal_block.exchange(at + 1, second);
                diagonal_block.eliminate_pair(simd, at);
            } else {
                diagonal_block.eliminate_one(simd, at);
            }
            at += 1 + usize::from(second.is_some());
        }
    }
}

impl<T: Scalar> DiagonalBlock<T> {
    #[inline(always)]
    fn eliminate_one<S: Simd>(&mut self, simd: S, at: usize) {
        let d = self.get(at, at);
        let inverse = T::ONE / d;
        let w = [self.parts[0][at], self.parts[1][at]];
        for row in at + 1..self.width {
            self.set(row, at, T::from_parts([w[0][row], w[1][row]]) * inverse);
        }
        let l = [self.parts[0][at], self.parts[1][at]];
        for col in at + 1..self.width {
            self.subtract(simd, col, &l, T::from_parts([w[0][col], w[1][col]]));
        }
        self.d.push([d, T::default()]);
    }

    #[inline(always)]
    fn eliminate_pair<S: Simd>(&mut self, simd: S, at: usize) {
        let d = [[self.get(at, at), self.get(at + 1, at)], [self.get(at + 1, at + 1), T::default()]];
        let [first, below, second] = invert_pair(d);
        let w = [[self.parts[0][at], self.parts[1][at]], [self.parts[0][at + 1], self.parts[1][at + 1]]];
        let of = |k: usize, row: usize| T::from_parts([w[k][0][row], w[k][1][row]]);
        for row in at + 2..self.width {
            self.set(row, at, of(0, row) * first + of(1, row) * below);
            self.set(row, at + 1, of(0, row) * below + of(1, row) * second);
        }
        let l = [[self.parts[0][at], self.parts[1][at]], [self.parts[0][at + 1], self.parts[1][at + 1]]];
        for col in at + 2..self.width {
            self.subtract(simd, col, &l[0], of(0, col));
            self.subtract(simd, col, &l[1], of(1, col));
        }
        self.set(at + 1, at, T::default());
        self.d.extend(d);
    }

    /// Column −= l·w; what stands above the diagonal is changed too, and means nothing.
    #[inline(always)]
    fn subtract<S: Simd>(&mut self, simd: S, col: usize, l: &[[T::Real; DIAGONAL_BLOCK_COLUMNS]; 2], w: T) {
        let minus = (-w).parts();
        let [re, im] = minus.map(|part| T::Real::splat(simd, part));
        let minus_im = T::Real::splat(simd, w.parts()[1]);
        let (l_re, l_im) = (T::Real::vectors::<S>(&l[0]).0, T::Real::vectors::<S>(&l[1]).0);
        let [column_re, column_im] = &mut self.parts;
        let column_re = T::Real::vectors_mut::<S>(&mut column_re[col]).0;
        for (c, &l) in column_re.iter_mut().zip(l_re) {
            *c = T::Real::mul_add(simd, l, re, *c);
        }
        if T::PARTS == 2 {
            let column_im = T::Real::vectors_mut::<S>(&mut column_im[col]).0;
            for (c, &l) in column_re.iter_mut().zip(l_im) {
                *c = T::Real::mul_add(simd, l, minus_im, *c);
            }
            for ((c, &l_re), &l_im) in column_im.iter_mut().zip(l_re).zip(l_im) {
                *c = T::Real::mul_add(simd, l_re, im, T::Real::mul_add(simd, l_im, re, *c));
            }
        }
    }
}

/// Inverse of a symmetric block of two: first, below, second; stable where the entry below is the largest.
pub(crate) fn invert_pair<T: Scalar>([[a, b], [c, _]]: [[T; 2]; 2]) -> [T; 3] {
    // Of [a b; b c] = b [a/b 1; 1 c/b]: the determinant of the bracket is of the order of 1.
    let (p, q) = (a / b, c / b);
    let scale = T::ONE / ((p * q - T::ONE) * b);
    [q * scale, -scale, p * scale]
}
