//! Which status each stretch of the band has: one answer for the strip, the ground of the plots and the words.

use crate::results::Band;
use frfit::identify::{Status, Trust};

/// Left-out lines are shown if they leave a gap of more than this number times the usual distance of the others.
const WIDE: f64 = 4.0;

/// Of a band narrower stretches are not seen.
const NARROWEST: f64 = 1.0 / 3000.0;

/// A stretch of one status, in hertz.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Stretch {
    pub(crate) status: Status,
    pub(crate) from: f64,
    pub(crate) to: f64,
}

/// Frequencies and statuses without the lines that were left out between others only to save time.
pub(crate) fn points(band: &Band) -> Vec<(f64, Status)> {
    let is_asked = |row: usize| band.status[row].trust() != Trust::NotAsked;
    let asked: Vec<f64> =
        (0..band.len()).filter(|&row| is_asked(row)).map(|row| band.frequency_hz[row]).collect();
    let mut gaps: Vec<f64> = asked.windows(2).map(|pair| pair[1] - pair[0]).collect();
    gaps.sort_by(f64::total_cmp);
    let usual = gaps.get(gaps.len() / 2).copied().unwrap_or(0.0);
    let is_in_wide_gap = |f: f64| {
        let next = asked.partition_point(|&other| other < f);
        let from = if next > 0 { asked[next - 1] } else { band.frequency_hz[0] };
        let to = asked.get(next).copied().unwrap_or(band.frequency_hz[band.len() - 1]);
        to - from > WIDE * usual
    };
    let all = band.frequency_hz.iter().zip(&band.status).enumerate();
    all.filter(|&(row, (&f, _))| is_asked(row) || is_in_wide_gap(f))
        .map(|(_, (&f, &status))| (f, status))
        .collect()
}

/// The stretches, from half-way to the neighbour before to half-way to the one behind; one that is too narrow to be seen belongs to its neighbour.
pub(crate) fn stretches(band: &Band) -> Vec<Stretch> {
    let points = points(band);
    let (first, last) = (band.frequency_hz[0], band.frequency_hz[band.len() - 1]);
    let edge = |k: usize| match k {
        0 => first,
        k if k >= points.len() => last,
        k => f64::midpoint(points[k - 1].0, points[k].0),
    };
    let mut all: Vec<Stretch> = Vec::new();
    let mut start = 0;
    for k in 1..=points.len() {
        if k < points.len() && points[k].1 == points[start].1 {
            continue;
        }
        let (from, to) = (all.last().map_or(edge(start), |before| before.to), edge(k));
        let status = points[start].1;
        start = k;
        match all.last_mut() {
            Some(before) if before.status == status || to - from < NARROWEST * (last - first) => {
                before.to = to
            }
            _ => all.push(Stretch { status, from, to }),
        }
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    fn band(lines: &[(f64, Status)]) -> Band {
        let (frequency_hz, status) = lines.iter().copied().unzip();
        Band { frequency_hz, status, numbers: Vec::new() }
    }

    fn of(lines: &[(f64, Status)]) -> Vec<(Status, f64, f64)> {
        stretches(&band(lines)).into_iter().map(|one| (one.status, one.from, one.to)).collect()
    }

    use Status::{NotIdentifiable, Ok, OutOfBand};

    #[test]
    fn stretches_meet_half_way_between_lines_and_fill_the_band() {
        let lines = [(10.0, Ok), (20.0, Ok), (30.0, NotIdentifiable), (50.0, Ok)];
        assert_eq!(of(&lines), [(Ok, 10.0, 25.0), (NotIdentifiable, 25.0, 40.0), (Ok, 40.0, 50.0)]);
        assert_eq!(of(&[(10.0, Ok)]), [(Ok, 10.0, 10.0)]);
        assert_eq!(of(&[(10.0, OutOfBand), (20.0, OutOfBand)]), [(OutOfBand, 10.0, 20.0)]);
    }

    #[test]
    fn lines_that_were_passed_over_leave_no_gap_and_a_stretch_that_was_left_out_does() {
        let is_used = |k: i32| k % 10 == 0 && !(300..=500).contains(&k);
        let lines: Vec<(f64, Status)> =
            (0..=1000).map(|k| (f64::from(k), if is_used(k) { Ok } else { OutOfBand })).collect();
        assert_eq!(of(&lines), [(Ok, 0.0, 290.5), (OutOfBand, 290.5, 509.5), (Ok, 509.5, 1000.0)]);
    }

    #[test]
    fn what_is_too_narrow_to_be_seen_belongs_to_its_neighbour() {
        let lines: Vec<(f64, Status)> =
            (0..10_000).map(|k| (f64::from(k), if k == 5000 { NotIdentifiable } else { Ok })).collect();
        assert_eq!(of(&lines), [(Ok, 0.0, 9999.0)]);
    }
}
