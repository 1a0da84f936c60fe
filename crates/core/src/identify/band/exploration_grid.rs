//! Frequencies at which all solutions are searched.

/// Bands of fewer frequencies are explored at each.
const MIN_FOLLOWED_BAND: usize = 300;

/// Largest step between anchors, relative. Solutions move by a few times that between them, and are to stay nearer to themselves than to one another;
/// where they do not, the step is halved.
const MAX_GRID_STEP: f64 = 0.02;

/// The ends of each neighbourhood (first and last frequency), and as many between them as keep the step.
pub(super) fn exploration_grid(
    frequency_hz: &[f64],
    neighbourhoods: impl Iterator<Item = [usize; 2]>,
) -> Vec<usize> {
    if frequency_hz.len() < MIN_FOLLOWED_BAND {
        return (0..frequency_hz.len()).collect();
    }
    let mut exploration_grid = Vec::new();
    for [first, last] in neighbourhoods {
        let mut next = first;
        exploration_grid.push(first);
        while next < last {
            let reach = frequency_hz[next] * (1.0 + MAX_GRID_STEP);
            let beyond = frequency_hz.partition_point(|&f| f <= reach);
            next = beyond.saturating_sub(1).clamp(next + 1, last);
            exploration_grid.push(next);
        }
    }
    exploration_grid
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn anchors_keep_the_step_and_do_not_grow_with_the_band() {
        let band = |n: usize| (0..n).map(|i| 50.0 + 950.0 * i as f64 / n as f64).collect::<Vec<f64>>();
        let halves = |n: usize| [[0, n / 2 - 1], [n / 2, n - 1]].into_iter();
        assert_eq!(exploration_grid(&band(200), halves(200)), (0..200).collect::<Vec<usize>>());
        let counts = [3000, 30_000].map(|n| {
            let (f, exploration_grid) = (band(n), exploration_grid(&band(n), halves(n)));
            assert!(
                [0, n / 2 - 1, n / 2, n - 1].iter().all(|end| exploration_grid.binary_search(end).is_ok())
            );
            let kept =
                |pair: &[usize]| pair[1] == pair[0] + 1 || f[pair[1]] <= (1.0 + MAX_GRID_STEP) * f[pair[0]];
            assert!(exploration_grid.windows(2).all(kept) && exploration_grid.is_sorted());
            exploration_grid.len()
        });
        assert!(counts[1] <= counts[0] && counts[1] < 200, "{counts:?}");
    }

    #[test]
    fn a_band_that_begins_at_rest_has_anchors() {
        let f: Vec<f64> = (0..400).map(f64::from).collect();
        let exploration_grid = exploration_grid(&f, [[0, 399]].into_iter());
        assert_eq!(exploration_grid[..3], [0, 1, 2]);
        assert!(exploration_grid.len() < 260, "{}", exploration_grid.len());
    }
}
