//! Measured responses in pieces of the band, and the resonances that each piece shows.

use super::measured_modes::{PoleSearch, candidates};
use super::rational_fit::{Fit, Measured};
use super::stabilisation::stabilisation;
use crate::c64;
use crate::for_each::ForEach;
use crate::frfs::{Frfs, standard_deviations};
use crate::thinned::thinned;
use frfit_linalg::dense::NoConvergence;
use std::ops::Range;

/// The lines of a piece of the band, and how many of them it shares with the next one: a search over poles costs the cube of their number, and a
/// resonance needs both of its sides.
const PIECE: usize = 400;
const SHARED: usize = 60;

/// Sensors whose responses lead to the poles, at most.
const MAX_SENSORS: usize = 6;

/// The largest order of the stabilisation diagram of a piece.
const MAX_ORDER: usize = 40;

/// After so many pieces in which nothing speaks for what is asked, no further one is fitted.
pub(super) const UNDECIDED_PIECES: usize = 6;

/// A part of the band.
#[derive(Debug, PartialEq)]
pub(super) struct Piece {
    /// What is fitted.
    pub(super) lines: Range<usize>,
    /// The lines that this piece knows best: each line is of one piece.
    pub(super) own: Range<usize>,
}

/// Pieces of the band, one after the other; lines at 0 Hz are in none.
pub(super) fn pieces(frequency_hz: &[f64]) -> Vec<Piece> {
    let count = frequency_hz.len();
    let mut from = frequency_hz.iter().take_while(|&&f| f <= 0.0).count();
    let mut own = from;
    let mut pieces = Vec::new();
    loop {
        let end = count.min(from + PIECE);
        let known = if end < count { end - SHARED / 2 } else { end };
        pieces.push(Piece { lines: from..end, own: own..known });
        if end == count {
            return pieces;
        }
        (from, own) = (end - SHARED, known);
    }
}

/// Responses of sensors, and 1/σ.
pub(super) struct Shown<'a> {
    frequency_hz: &'a [f64],
    responses: Vec<Vec<c64>>,
    weights: Vec<Vec<f64>>,
    noise_known: bool,
    decay_per_s: f64,
}

/// Poles, and −2 ln of how likely they make the responses.
pub(super) struct Explained {
    pub(super) information: f64,
    pub(super) fit: Fit,
}

impl<'a> Shown<'a> {
    pub(super) fn of_all(frfs: Frfs<'a>, decay_per_s: f64) -> Self {
        Self::of(frfs, decay_per_s, usize::MAX)
    }

    pub(super) fn of_some(frfs: Frfs<'a>, decay_per_s: f64) -> Self {
        Self::of(frfs, decay_per_s, MAX_SENSORS)
    }

    fn of(frfs: Frfs<'a>, decay_per_s: f64, sensors: usize) -> Self {
        let std = standard_deviations(frfs.frequency_hz, frfs.receptance, frfs.noise);
        let responses = frfs.receptance.iter().map(|row| thinned(row, sensors).copied().collect());
        let weights = std.iter().map(|row| thinned(row, sensors).map(|std| std.recip()).collect());
        Self {
            frequency_hz: frfs.frequency_hz,
            responses: responses.collect(),
            weights: weights.collect(),
            noise_known: frfs.noise.is_known(),
            decay_per_s,
        }
    }

    pub(super) fn sensors(&self) -> usize {
        self.responses.first().map_or(0, Vec::len)
    }

    pub(super) fn measured(&self, lines: &Range<usize>, hann_record_s: Option<f64>) -> Measured<'_> {
        Measured {
            frequency_hz: &self.frequency_hz[lines.clone()],
            responses: &self.responses[lines.clone()],
            weights: &self.weights[lines.clone()],
            decay_per_s: self.decay_per_s,
            hann_record_s,
        }
    }

    /// The lines as resonances; `None` where they show none.
    pub(super) fn resonances(
        &self,
        lines: &Range<usize>,
        for_each: ForEach<'_>,
    ) -> Result<Option<Explained>, NoConvergence> {
        let diagram = stabilisation(&self.measured(lines, None), MAX_ORDER, for_each)?;
        Ok(self.explained(lines, None, &candidates(&diagram), for_each))
    }

    /// The same, and the lines through a Hann window.
    pub(super) fn fitted_twice(
        &self,
        lines: &Range<usize>,
        record_s: f64,
        for_each: ForEach<'_>,
    ) -> Result<Option<[Explained; 2]>, NoConvergence> {
        let Some(plain) = self.resonances(lines, for_each)? else { return Ok(None) };
        let poles = [plain.fit.poles.clone(), Vec::new()];
        Ok(self.explained(lines, Some(record_s), &poles, for_each).map(|hann| [plain, hann]))
    }

    fn explained(
        &self,
        lines: &Range<usize>,
        hann_record_s: Option<f64>,
        poles: &[Vec<c64>; 2],
        for_each: ForEach<'_>,
    ) -> Option<Explained> {
        let measured = self.measured(lines, hann_record_s);
        let search = PoleSearch { measured, noise_known: self.noise_known, for_each };
        let (fit, fitted) = search.selected(poles)?;
        let information = search.information(&fit, &fitted);
        Some(Explained { information, fit }).filter(|found| !found.fit.poles.is_empty())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_line_is_of_one_piece() {
        for count in [1, 399, 400, 401, 740, 741, 5000] {
            let frequency_hz: Vec<f64> = (0..count).map(|k| k as f64).collect();
            let pieces = pieces(&frequency_hz);
            let own: Vec<usize> = pieces.iter().flat_map(|piece| piece.own.clone()).collect();
            assert_eq!(own, (1..count).collect::<Vec<usize>>());
            let inside =
                |piece: &Piece| piece.lines.start <= piece.own.start && piece.own.end <= piece.lines.end;
            assert!(pieces.iter().all(|piece| inside(piece) && piece.lines.len() <= PIECE));
        }
    }
}
