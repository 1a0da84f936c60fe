//! Which measured lines count: those that are not left out, and of too many, those that show the unknowns best.

use super::band::Band;
use crate::case::{Exclusion, Located};
use crate::error::InputError;
use frfit::c64;

/// Which frequencies of a band are not used: those of excluded bands, and of more than `most` others those that show the least.
///
/// # Errors
/// [`InputError`] where `most` is less than three, or none is left of a band that has any.
pub(super) fn unused(
    data: &Band,
    exclude: &Located<Vec<Exclusion>>,
    most: Option<&Located<i64>>,
) -> Result<Vec<bool>, InputError> {
    let most = most.map(max_lines).transpose()?;
    let mut out = left_out(&exclude.value, &data.frequency_hz);
    let used: Vec<usize> = (0..out.len()).filter(|&i| !out[i]).collect();
    if used.is_empty() && !out.is_empty() {
        return Err(InputError::at(&exclude.place, "a frequency of the band that is not left out", "none"));
    }
    if let Some(most) = most.filter(|&most| used.len() > most) {
        let measured: Vec<&[c64]> = used.iter().map(|&i| data.measured[i].as_slice()).collect();
        used.iter().for_each(|&i| out[i] = true);
        telling(&measured, most).into_iter().for_each(|k| out[used[k]] = false);
    }
    Ok(out)
}

/// The fewest lines that `max_lines` may ask for: ends, and something between them.
const LEAST: usize = 3;

/// `max_lines` as a number of lines.
///
/// # Errors
/// [`InputError`] where it is less than three.
fn max_lines(written: &Located<i64>) -> Result<usize, InputError> {
    let found = usize::try_from(written.value).ok().filter(|&most| most >= LEAST);
    found.ok_or_else(|| {
        InputError::at(&written.place, "a whole number of at least 3", written.value.to_string())
    })
}

/// So many stretches of a band have a size of their own, against which a change counts: what is large at one end may be small at the other.
const STRETCHES: usize = 32;

/// At most so many of some lines (ascending): one half of them evenly spread, the other half where the responses change most from line to line against the median of their stretch. Those are
/// the resonances, whose widths and places show a modulus best; against the response itself it would be the noise between them.
fn telling(measured: &[&[c64]], most: usize) -> Vec<usize> {
    let n = measured.len();
    let stretch = n.div_ceil(STRETCHES);
    let middle = |own: &[&[c64]], m: usize| {
        let mut sizes: Vec<f64> = own.iter().map(|u| u[m].norm()).collect();
        sizes.sort_by(f64::total_cmp);
        sizes[sizes.len() / 2]
    };
    let sensors = 0..measured[0].len();
    let middles: Vec<Vec<f64>> =
        measured.chunks(stretch).map(|own| sensors.clone().map(|m| middle(own, m)).collect()).collect();
    let change = |k: usize| {
        let (left, right) = (measured[k.saturating_sub(1)], measured[(k + 1).min(n - 1)]);
        let against = |m: usize| Some(middles[k / stretch][m]).filter(|&middle| middle > 0.0);
        sensors.clone().filter_map(|m| Some((right[m] - left[m]).norm() / against(m)?)).sum()
    };
    let changes: Vec<f64> = (0..n).map(change).collect();
    // A line is taken with this share at a scale, never more than once: at resonances all are.
    let even = most as f64 / (2.0 * n as f64);
    let share = |k: usize, scale: f64| (even + scale * changes[k]).min(1.0);
    let count = |scale: f64| (0..n).map(|k| share(k, scale)).sum::<f64>();
    let largest = changes.iter().copied().fold(0.0, f64::max);
    let least =
        changes.iter().copied().filter(|&change| change > 1e-12 * largest).fold(f64::INFINITY, f64::min);
    // Where nothing changes, all of the shares are even.
    if !least.is_finite() {
        return (0..most).map(|k| k * (n - 1) / (most - 1)).collect();
    }
    let (mut low, mut high) = (0.0, 1.0 / least);
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        if count(middle) <= most as f64 { low = middle } else { high = middle }
    }
    let mut sum = 0.5;
    let taken = |k: &usize| {
        let before = sum;
        sum += share(*k, low);
        sum.floor() > f64::floor(before)
    };
    (0..n).filter(taken).collect()
}

/// A scale to the last bit.
const HALVINGS: usize = 60;

/// A frequency this near to a line, as a part of their distance, is that line: between two lines a disturbance is in both.
const ON_LINE: f64 = 0.01;

/// Which frequencies (ascending) are left out.
fn left_out(exclude: &[Exclusion], frequency_hz: &[f64]) -> Vec<bool> {
    let mut out = vec![false; frequency_hz.len()];
    for entry in exclude {
        let (first, end) = match *entry {
            Exclusion::Band([low, high]) => {
                (frequency_hz.partition_point(|&f| f < low), frequency_hz.partition_point(|&f| f <= high))
            }
            Exclusion::Line(line) => lines_of(line, frequency_hz),
        };
        out[first..end.max(first)].fill(true);
    }
    out
}

/// The lines [first, end) that a frequency is on, or between.
fn lines_of(frequency: f64, frequency_hz: &[f64]) -> (usize, usize) {
    let above = frequency_hz.partition_point(|&f| f < frequency);
    match (above.checked_sub(1).map(|below| frequency_hz[below]), frequency_hz.get(above)) {
        (Some(low), Some(&high)) => {
            let near = ON_LINE * (high - low);
            match (frequency - low <= near, high - frequency <= near) {
                (true, _) => (above - 1, above),
                (_, true) => (above, above + 1),
                _ => (above - 1, above + 1),
            }
        }
        // At the ends of the band, or outside: the line itself only, to the rounding of twelve digits.
        (None, Some(&high)) if high - frequency <= 1e-9 * high => (above, above + 1),
        (Some(low), None) if frequency - low <= 1e-9 * low => (above - 1, above),
        _ => (above, above),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_and_bands_are_left_out() {
        let lines: Vec<f64> = (0..10).map(|k| 10.0 + 2.0 * k as f64).collect();
        let out = |entries: &[Exclusion]| {
            let out = left_out(entries, &lines);
            lines.iter().zip(out).filter(|(_, out)| *out).map(|(f, _)| *f).collect::<Vec<_>>()
        };
        assert_eq!(out(&[Exclusion::Band([12.0, 15.9]), Exclusion::Line(20.0)]), [12.0, 14.0, 20.0]);
        // Between two lines a hum is in both; next to one, in that one.
        assert_eq!(out(&[Exclusion::Line(13.0), Exclusion::Line(20.019)]), [12.0, 14.0, 20.0]);
        assert_eq!(out(&[Exclusion::Line(10.0), Exclusion::Line(28.0)]), [10.0, 28.0]);
        // Nothing of the band is there.
        assert_eq!(
            out(&[Exclusion::Line(9.0), Exclusion::Line(50.0), Exclusion::Band([30.0, 40.0])]),
            [0.0; 0]
        );
        assert_eq!(out(&[Exclusion::Band([12.5, 13.5])]), [0.0; 0]);
    }

    /// Two resonances of a thousandth on 4000 lines with noise, the second of them weak: of 200 lines each has those within its width at half power, where an even spread has none.
    #[test]
    fn of_too_many_lines_those_at_resonances_stay() {
        let frequency_hz: Vec<f64> = (0..4000).map(|k| 10.0 + 0.05 * k as f64).collect();
        let resonance = |f: f64, at: f64| 1.0 / c64::new(at * at - f * f, 0.001 * at * at);
        let noise = |k: usize| 1.0 + 0.05 * ((k * k) as f64 * 0.618_034).fract();
        let row = |(k, &f): (usize, &f64)| vec![(resonance(f, 50.0) + 0.1 * resonance(f, 150.0)) * noise(k)];
        let measured: Vec<Vec<c64>> = frequency_hz.iter().enumerate().map(row).collect();
        let rows: Vec<&[c64]> = measured.iter().map(Vec::as_slice).collect();
        let chosen = telling(&rows, 200);
        assert!((195..=200).contains(&chosen.len()) && chosen.is_sorted(), "{}", chosen.len());
        for at in [50.0, 150.0] {
            let within = |k: &&usize| (frequency_hz[**k] - at).abs() <= 0.0005 * at;
            let all = (0..4000).collect::<Vec<usize>>();
            assert_eq!(chosen.iter().filter(within).count(), all.iter().filter(within).count(), "{at}");
        }
        // An even half of a hundred lines leaves no gap of more than a hundredth of the band.
        assert!(chosen.windows(2).all(|pair| pair[1] - pair[0] <= 41));
        // What never changes is spread evenly.
        let still = vec![vec![c64::new(1.0, 0.0)]; 100];
        let rows: Vec<&[c64]> = still.iter().map(Vec::as_slice).collect();
        assert_eq!(telling(&rows, 4), [0, 33, 66, 99]);
    }
}
