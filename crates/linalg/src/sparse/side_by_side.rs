//! A sparse matrix times several real vectors side by side: every entry is met once for all of them.

use super::{Pattern, accumulate};
use pulp::{Arch, NullaryFnOnce};

/// Vectors that are side by side: a register of the widest instruction set, or a few of the others.
const LANES: usize = 8;

/// One entry of each vector.
type Row = [f64; LANES];

/// out += A X for real vectors X and out, n × k column after column.
pub(crate) fn multiply_add<A: Copy>(
    pattern: &Pattern,
    values: &[A],
    part: impl Fn(A) -> f64 + Copy,
    x: &[f64],
    out: &mut [f64],
) {
    let n = pattern.dim();
    assert!(x.len() == out.len() && x.len().is_multiple_of(n.max(1)));
    if x.len() == n {
        // One vector has no others to share an entry with.
        return accumulate(pattern, values, x, out, |a, x| part(a) * x);
    }
    let (mut rows, mut sums) = (Vec::new(), Vec::new());
    for (x, out) in x.chunks(LANES * n.max(1)).zip(out.chunks_mut(LANES * n.max(1))) {
        rows.clear();
        rows.resize(n, Row::default());
        sums.clear();
        sums.resize(n, Row::default());
        for (lane, x) in x.chunks_exact(n).enumerate() {
            rows.iter_mut().zip(x).for_each(|(row, &x)| row[lane] = x);
        }
        Arch::new().dispatch(Products { pattern, values, part, x: &rows, sums: &mut sums });
        for (lane, out) in out.chunks_exact_mut(n).enumerate() {
            out.iter_mut().zip(&sums).for_each(|(out, sum)| *out += sum[lane]);
        }
    }
}

struct Products<'a, A, P> {
    pattern: &'a Pattern,
    values: &'a [A],
    part: P,
    x: &'a [Row],
    sums: &'a mut [Row],
}

impl<A: Copy, P: Fn(A) -> f64> NullaryFnOnce for Products<'_, A, P> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Self { pattern, values, part, x, sums } = self;
        let mut start = 0;
        for (col, &end) in pattern.col_ptr()[1..].iter().enumerate() {
            let (mut here, own) = (Row::default(), x[col]);
            for (&row, &value) in pattern.row_idx()[start..end].iter().zip(&values[start..end]) {
                let a = part(value);
                // A term's matrix is on the pattern of the whole model, where most of it may be zero.
                if a == 0.0 {
                    continue;
                }
                let other = x[row];
                (0..LANES).for_each(|lane| here[lane] += a * other[lane]);
                if row != col {
                    let sum = &mut sums[row];
                    (0..LANES).for_each(|lane| sum[lane] += a * own[lane]);
                }
            }
            (0..LANES).for_each(|lane| sums[col][lane] += here[lane]);
            start = end;
        }
    }
}
