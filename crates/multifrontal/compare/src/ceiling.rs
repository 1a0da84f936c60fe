//! The speed of dense matrix products: what no sparse factorisation exceeds.

use crate::case::Number;
use crate::faer_solvers::parallelism;
use crate::mkl::Mkl;
use crate::round::{Time, median, timed};
use faer::linalg::matmul::matmul;
use faer::{Accum, MatMut, MatRef};

/// Rows: large enough that the kernel counts alone, and no power of two, whose strides fall into few sets of the cache.
const ROWS: usize = 2200;

/// Products behind a median.
const PRODUCTS: usize = 5;

/// 10⁹ operations a second of a product of large matrices, by MKL (`None` without it) and by faer, all threads together.
pub fn gflops<T: Number>(mkl: Option<&Mkl>, threads: usize) -> [Option<f64>; 2] {
    let a: Vec<T> = (0..ROWS * ROWS).map(|k| T::of_parts((k % 7) as f64, (k % 5) as f64)).collect();
    let b: Vec<T> = a.iter().rev().copied().collect();
    let mut c = vec![T::default(); ROWS * ROWS];
    let flops = 2.0 * T::FLOPS * (ROWS as f64).powi(3);
    // Of one thread by its CPU time, which other work on the machine disturbs little.
    let speed = |times: Vec<Time>| {
        let time = median(&times);
        flops / 1e9 / if threads == 1 { time.cpu } else { time.wall }
    };
    let by_mkl = mkl.map(|mkl| {
        mkl.set_threads(threads);
        mkl.multiply(ROWS, &a, &b, &mut c);
        speed((0..PRODUCTS).map(|_| timed(|| mkl.multiply(ROWS, &a, &b, &mut c)).1).collect())
    });
    let mut by_faer = || {
        let a = MatRef::from_column_major_slice(&a, ROWS, ROWS);
        let b = MatRef::from_column_major_slice(&b, ROWS, ROWS);
        let c = MatMut::from_column_major_slice_mut(&mut c, ROWS, ROWS);
        matmul(c, Accum::Replace, a, b, T::of_parts(1.0, 0.0), parallelism(threads));
    };
    by_faer();
    let by_faer = speed((0..PRODUCTS).map(|_| timed(&mut by_faer).1).collect());
    [by_mkl, Some(by_faer)]
}
