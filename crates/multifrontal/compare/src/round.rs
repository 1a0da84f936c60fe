//! What one run of one solver shows.

use cpu_time::ProcessTime;
use std::time::Instant;

/// Seconds of some work.
#[derive(Debug, Clone, Copy, Default)]
pub struct Time {
    /// On the clock.
    pub wall: f64,
    /// Of the processor, over all threads of the process.
    pub cpu: f64,
}

/// Analysis, factorisation and solves once.
#[derive(Debug, Clone, Default)]
pub struct Round<T> {
    /// Ordering and symbolic factorisation.
    pub analysis: Time,
    /// Numerical factorisation.
    pub factor: Time,
    /// Solve with one right-hand side.
    pub solve_1: Time,
    /// Solve with all right-hand sides at once.
    pub solve_8: Time,
    /// What the solver says of itself.
    pub report: Report,
    /// Growth of the largest resident memory, in MB, where it was measured by the solver itself.
    pub peak: Option<f64>,
    /// Solutions of all right-hand sides, or of the first.
    pub solution: Vec<T>,
}

/// What a solver says of itself; `None` where it does not.
#[derive(Debug, Clone, Default)]
pub struct Report {
    /// Memory of factor and solve in MB.
    pub memory: Option<f64>,
    /// Entries of L, in millions.
    pub entries: Option<f64>,
    /// Operations of the factorisation in 10⁹, real ones.
    pub gflop: Option<f64>,
    /// Negative pivots: natural frequencies below ω.
    pub negative: Option<usize>,
    /// Perturbed pivots, refinement and the like; empty for nothing.
    pub remark: String,
}

/// Repetitions of each solve in a round, behind a median.
const SOLVES: usize = 3;

/// Result and seconds of some work.
pub fn timed<T>(work: impl FnOnce() -> T) -> (T, Time) {
    let (wall, cpu) = (Instant::now(), ProcessTime::now());
    let result = work();
    (result, Time { wall: wall.elapsed().as_secs_f64(), cpu: cpu.elapsed().as_secs_f64() })
}

/// The solution of the last, and the median seconds, of several solves that start from the same right-hand side.
pub fn solves<T: Clone, E>(
    rhs: &[T],
    mut solve: impl FnMut(&mut [T]) -> Result<(), E>,
) -> Result<(Vec<T>, Time), E> {
    let mut times = Vec::new();
    let mut x = rhs.to_vec();
    for _ in 0..SOLVES {
        x.clone_from_slice(rhs);
        let (outcome, time) = timed(|| solve(&mut x));
        outcome?;
        times.push(time);
    }
    Ok((x, median(&times)))
}

/// Medians of wall and CPU seconds, each for itself.
pub fn median<'a>(times: impl IntoIterator<Item = &'a Time>) -> Time {
    let (wall, cpu) = times.into_iter().map(|time| (time.wall, time.cpu)).unzip();
    Time { wall: frfit_bench::clock::median(wall), cpu: frfit_bench::clock::median(cpu) }
}
