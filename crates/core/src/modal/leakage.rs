//! Leakage of a Hann window: what it adds to measured responses, and whether they show it.
//!
//! Poles and residues are fitted to all lines twice: as resonances, and as what a Hann window makes of them (`hann`). The second fit says what the window
//! has added, and the difference of both says whether there was one.

use super::hann::hann_resonance;
use super::pieces::{Shown, UNDECIDED_PIECES, pieces};
use crate::c64;
use crate::for_each::ForEach;
use crate::frequency::laplace_per_s;
use crate::frfs::Frfs;
use frfit_linalg::dense::NoConvergence;

/// Standard deviation of [`hann_leakage`] over its size. It is where poles that few lines show, and a force whose spectrum is not flat, leave it; error
/// bars of simulated records (120 cases) are alike from 0.03 to 0.2.
pub const HANN_LEAKAGE_RSTD: f64 = 0.1;

/// Where so much speaks against a window, no further piece is fitted.
const AGAINST_NATS: f64 = -100.0;

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
