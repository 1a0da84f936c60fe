//! What a factorisation allocates against what was foretold; alone in its process, which counts all bytes.

use frfit_linalg::solve::{Analysis, FactorMemory};
use frfit_linalg::sparse::{Pattern, SymmetricMatrix, Triplets};
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

fn matrix(n: usize, sign: f64) -> SymmetricMatrix {
    let pattern = grid(n);
    let mut triplets = Triplets::new(pattern.dim());
    for (row, col) in pattern.positions() {
        let diagonal = if row % 2 == 0 { 40.0 } else { 40.0 * sign };
        triplets.add(row, col, if row == col { diagonal } else { -1.0 });
    }
    triplets.assemble()
}

/// Kept and at the most, beside what there was before.
fn check(kept: usize, peak: usize, forecast: FactorMemory, slack: usize) {
    assert!(kept <= forecast.kept + slack && forecast.kept <= 2 * kept, "{kept} of {forecast:?}");
    let foretold = forecast.kept + forecast.scratch;
    assert!(peak <= foretold + slack && foretold <= 2 * peak, "{peak} of {forecast:?}");
}

#[test]
fn the_forecast_of_a_real_factor_holds() {
    // Below 2 MB, for larger pieces come from the system and not from the allocator that counts.
    for (n, sign) in [(22, 1.0), (22, -1.0), (14, 1.0)] {
        let matrix = matrix(n, sign);
        let values = matrix.real_values().unwrap();
        let double = Analysis::sparse(matrix.pattern());
        let single = double.in_single_precision().unwrap();
        let [of_double, of_single] = [&double, &single].map(|of| of.factor_memory::<f64>().unwrap());
        assert!(of_double.kept < 2 << 20 && of_single.kept < 2 * of_double.kept / 3);
        // A handful of pointers (the factor's own struct) is not counted.
        let [kept, peak] = measured(&double, values);
        check(kept, peak, of_double, 1024);
        // Refinement may take more than the factorisation, and is foretold with it.
        let [kept, peak] = measured(&single, values);
        assert!(kept <= of_single.kept + 1024 && of_single.kept <= 2 * kept, "{kept} of {of_single:?}");
        assert!(peak <= of_single.kept + of_single.scratch + 1024, "{peak} of {of_single:?}");
    }
    large();
}

/// What a factor keeps, and the peak of its making.
fn measured(analysis: &Analysis, values: &[f64]) -> [usize; 2] {
    // Once before counting: matrix products keep a buffer in each thread.
    drop(analysis.factor(values).unwrap());
    let before = MEMORY.current_usage();
    MEMORY.reset_peak_usage();
    let factor = analysis.factor(values).unwrap();
    let measured = [MEMORY.current_usage(), MEMORY.peak_usage()].map(|bytes| bytes - before);
    drop(factor);
    measured
}

/// The same of a large factor, by what is resident: here and not in a test of its own, which would count at the same time.
#[cfg(target_os = "linux")]
fn large() {
    let resident = |name: &str| {
        let status = std::fs::read_to_string("/proc/self/status").unwrap();
        let line = status.lines().find_map(|line| line.strip_prefix(name)).unwrap();
        1024 * line.trim_end_matches("kB").trim().parse::<usize>().unwrap()
    };
    let matrix = matrix(150, 1.0);
    let values = matrix.real_values().unwrap();
    let analysis = Analysis::sparse(matrix.pattern());
    let forecast = analysis.factor_memory::<f64>().unwrap();
    assert!(forecast.kept > 64 << 20);
    let before = resident("VmRSS:");
    // 5 resets the peak, see proc_pid_clear_refs(5).
    std::fs::write("/proc/self/clear_refs", "5").unwrap();
    let factor = analysis.factor(values).unwrap();
    let (kept, peak) = (resident("VmRSS:") - before, resident("VmHWM:") - before);
    drop(factor);
    // Whole large pages of the factor and of two stacks, and what the allocator keeps of what it was given back.
    check(kept, peak, forecast, 8 << 20);
}

#[cfg(not(target_os = "linux"))]
fn large() {}
