//! Leakage of a Hann window: what it adds to measured responses, and whether they show it.
//!
//! Poles and residues are fitted to all lines twice: as resonances, and as what a Hann window makes of them (`hann`). The second fit says what the window
//! has added, and the difference of both says whether there was one.

use super::hann::hann_resonance;
use super::measured_modes::{PoleSearch, candidates};
use super::rational_fit::{Fit, Measured};
use super::stabilisation::stabilisation;
use crate::c64;
use crate::for_each::ForEach;
use crate::frequency::laplace_per_s;
use crate::frfs::{Frfs, standard_deviations};
use crate::thinned::thinned;
use frfit_linalg::dense::NoConvergence;
use std::ops::Range;

/// Standard deviation of [`hann_leakage`] over its size. It is where poles that few lines show, and a force whose spectrum is not flat, leave it; error
/// bars of simulated records (120 cases) are alike from 0.03 to 0.2.
pub const HANN_LEAKAGE_RSTD: f64 = 0.1;

/// The lines of a piece of the band, and how many of them it shares with the next one: a search over poles costs the cube of their number, and a
/// resonance needs both of its sides.
const PIECE: usize = 400;
const SHARED: usize = 60;

/// Sensors whose responses lead to the poles, at most.
const MAX_SENSORS: usize = 6;

/// The largest order of the stabilisation diagram of a piece.
const MAX_ORDER: usize = 40;

/// Where so much speaks against a window, no further piece is asked; nor after so many pieces where nothing speaks for one.
const AGAINST_NATS: f64 = -100.0;
pub(super) const UNDECIDED_PIECES: usize = 6;

/// What the FRF (H1) of a random force has more with a Hann window on records of length T, `[frequency][sensor]`:
/// $$ \sum_r R_{mr} \Big(g(i\omega - s_r) - \frac{1}{i\omega - s_r}\Big) + \bar R_{mr} \Big(g(i\omega - \bar s_r) - \frac{1}{i\omega - \bar s_r}\Big) . $$
///
/// # Errors
/// [`NoConvergence`] where a response is not finite.
///
/// # Limits
/// The spectrum of the force is taken as flat across a resonance; that of a shaker may dip there. Of modes with much less than a line between their
/// half-power points the damping, and with it the height of the peak, is uncertain. What a mode beyond the first or the last line leaks into the lines near it is not found.
pub fn hann_leakage(
    frfs: Frfs<'_>,
    record_s: f64,
    for_each: ForEach<'_>,
) -> Result<Vec<Vec<c64>>, NoConvergence> {
    let (shown, all) = (Shown::of_some(frfs, 0.0), Shown::of_all(frfs, 0.0));
    let mut leakage = vec![vec![c64::default(); all.sensors()]; frfs.frequency_hz.len()];
    for piece in pieces(frfs.frequency_hz) {
        let Some([_, hann]) = shown.fitted_twice(&piece.lines, record_s, for_each)? else { continue };
        let Some(fitted) = all.measured(&piece.lines, Some(record_s)).fitted(&hann.fit, for_each) else {
            continue;
        };
        for i in piece.own {
            let bias = |pole: c64| {
                let z = laplace_per_s(frfs.frequency_hz[i], 0.0) - pole;
                hann_resonance(z, record_s)[0] - z.inv()
            };
            for (pole, residues) in hann.fit.poles.iter().zip(&fitted.residues) {
                let [near, far] = [bias(*pole), bias(pole.conj())];
                for (sum, residue) in leakage[i].iter_mut().zip(residues) {
                    *sum += residue * near + residue.conj() * far;
                }
            }
        }
    }
    Ok(leakage)
}

/// By how many nats (BIC) measured responses are likelier with a Hann window on records of length T than without one. Where the first lines speak
/// clearly against it, the others are not asked.
///
/// # Errors
/// [`NoConvergence`] where a response is not finite.
///
/// # Limits
/// Where all resonances have many lines between their half-power points, a window changes nothing, and nothing speaks for or against it. Standard
/// deviations have to be right: without them a window is often missed.
pub fn hann_evidence(frfs: Frfs<'_>, record_s: f64, for_each: ForEach<'_>) -> Result<f64, NoConvergence> {
    let shown = Shown::of_some(frfs, 0.0);
    let mut nats = 0.0;
    for (k, piece) in pieces(frfs.frequency_hz).into_iter().enumerate() {
        if k >= UNDECIDED_PIECES && nats < 0.0 {
            break;
        }
        let Some([plain, hann]) = shown.fitted_twice(&piece.lines, record_s, for_each)? else { continue };
        nats += 0.5 * (plain.information - hann.information);
        if nats < AGAINST_NATS {
            break;
        }
    }
    Ok(nats)
}

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
    information: f64,
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
    fn fitted_twice(
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
