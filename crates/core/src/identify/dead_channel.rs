//! Channels that show nothing: a cable that came off, a column of zeros.

use crate::c64;

/// No sensor of a structure shows so little of what another one shows, over a whole band: it is roundoff, or the noise of an input without a sensor. The 24 bits of
/// an analyser reach to 6e-8, and a reduced model, whose digits are those of the largest response, has none left for its noise.
const DEAD_RATIO: f64 = 1e-9;

/// The sensors whose largest response is at most 1e-9 of the largest of all; none where all are zero. They know nothing, but a standard deviation in proportion to their
/// response would make them count for more than all others.
pub(crate) fn dead_channels(measured: &[Vec<c64>]) -> Vec<usize> {
    let sensors = measured.first().map_or(0, Vec::len);
    let largest = |m: usize| measured.iter().map(|line| line[m].norm()).fold(0.0, f64::max);
    let levels: Vec<f64> = (0..sensors).map(largest).collect();
    let loudest = levels.iter().copied().fold(0.0, f64::max);
    (0..sensors).filter(|&m| levels[m] <= DEAD_RATIO * loudest && loudest > 0.0).collect()
}

/// The other sensors.
pub(crate) fn live_channels(measured: &[Vec<c64>]) -> Vec<usize> {
    let dead = dead_channels(measured);
    (0..measured.first().map_or(0, Vec::len)).filter(|m| !dead.contains(m)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_dead_channel_is_one_beside_a_channel_that_is_not() {
        let line = |a: f64, b: f64| vec![c64::new(a, 0.0), c64::new(0.0, b)];
        assert_eq!(dead_channels(&[line(1e-8, 0.0), line(3e-6, 1e-20)]), [1]);
        assert_eq!(dead_channels(&[line(1e-8, 1e-18), line(3e-6, 1e-15)]), [1]);
        // A node of the structure at most frequencies, or micrometres beside metres.
        assert!(dead_channels(&[line(1e-8, 1e-20), line(3e-6, 1e-13)]).is_empty());
        assert!(dead_channels(&[line(0.0, 0.0)]).is_empty() && dead_channels(&[]).is_empty());
    }
}
