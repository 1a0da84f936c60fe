//! What a factorisation allocates against what was foretold; alone in its process, which counts all bytes.

use frfit_linalg::solve::Analysis;
use frfit_linalg::sparse::{Pattern, Triplets};
use peak_alloc::PeakAlloc;
use std::sync::Arc;

#[global_allocator]
static MEMORY: PeakAlloc = PeakAlloc;

/// An n × n grid of nodes with three dofs each, every node coupled to its eight neighbours.
fn grid(n: usize) -> Arc<Pattern> {
    let node = |a: usize, b: usize| a * n + b;
    let pairs = (0..n * n).flat_map(move |p| {
        let (a, b) = (p / n, p % n);
        let near =
            (a..(a + 2).min(n)).flat_map(move |c| (b.max(1) - 1..(b + 2).min(n)).map(move |d| node(c, d)));
        near.map(move |q| (p, q))
    });
    let dofs = pairs.flat_map(|(p, q)| (0..9).map(move |k| (3 * p + k / 3, 3 * q + k % 3)));
    Arc::new(Pattern::new(3 * n * n, dofs))
}

#[test]
fn the_forecast_of_a_real_factor_holds() {
    for (n, sign) in [(60, 1.0), (60, -1.0), (20, 1.0)] {
        let pattern = grid(n);
        let mut triplets = Triplets::new(pattern.dim());
        for (row, col) in pattern.positions() {
            triplets.add(
                row,
                col,
                if row != col {
                    -1.0
                } else if row % 2 == 0 {
                    40.0
                } else {
                    40.0 * sign
                },
            );
        }
        let matrix = triplets.assemble();
        let values = matrix.real_values().unwrap();
        let analysis = Analysis::sparse(&pattern);
        let forecast = analysis.factor_memory::<f64>().unwrap();
        // Once before counting: matrix products keep a buffer in each thread.
        drop(analysis.factor(values).unwrap());
        let before = MEMORY.current_usage();
        MEMORY.reset_peak_usage();
        let factor = analysis.factor(values).unwrap();
        let (kept, peak) = (MEMORY.current_usage() - before, MEMORY.peak_usage() - before);
        drop(factor);
        // A handful of pointers (the factor's own struct) is not counted.
        let slack = 1024;
        assert!(kept <= forecast.kept + slack && forecast.kept <= 2 * kept, "{kept} of {forecast:?}");
        let foretold = forecast.kept + forecast.scratch;
        assert!(peak <= foretold + slack && foretold <= 2 * peak, "{peak} of {forecast:?}");
    }
}
