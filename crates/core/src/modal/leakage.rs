//! Leakage: what a Hann window adds to measured responses, and whether they show it; and what is cut off with the end of a record.
//!
//! Poles and residues are fitted to all lines twice: as resonances, and as what a Hann window makes of them (`hann`). The second fit says what the window
//! has added, and the difference of both says whether there was one.

use super::hann::hann_resonance;
use super::pieces::{Explained, Shown, UNDECIDED_PIECES, pieces};
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
    let mut leakage: Vec<Vec<c64>> =
        frfs.receptance.iter().map(|row| vec![c64::default(); row.len()]).collect();
    each_resonance(frfs, 0.0, Some(record_s), for_each, |i, pole, residues| {
        let bias = |pole: c64| {
            let z = laplace_per_s(frfs.frequency_hz[i], 0.0) - pole;
            hann_resonance(z, record_s)[0] - z.inv()
        };
        let [near, far] = [bias(pole), bias(pole.conj())];
        for (sum, residue) in leakage[i].iter_mut().zip(residues) {
            *sum += residue * near + residue.conj() * far;
        }
    })?;
    Ok(leakage)
}

/// Calls `add` for each line and each resonance of its piece of the band: the line, the pole, and its residue at each sensor. With the length of the records under a Hann window
/// the resonances are fitted through that.
fn each_resonance(
    frfs: Frfs<'_>,
    decay_per_s: f64,
    hann_record_s: Option<f64>,
    for_each: ForEach<'_>,
    mut add: impl FnMut(usize, c64, &[c64]),
) -> Result<(), NoConvergence> {
    let (shown, all) = (Shown::of_some(frfs, decay_per_s), Shown::of_all(frfs, decay_per_s));
    for piece in pieces(frfs.frequency_hz) {
        let found = match hann_record_s {
            Some(record_s) => shown.fitted_twice(&piece.lines, record_s, for_each)?.map(|[_, hann]| hann),
            None => shown.resonances(&piece.lines, for_each)?,
        };
        let Some(Explained { fit, .. }) = found else { continue };
        let Some(fitted) = all.measured(&piece.lines, hann_record_s).fitted(&fit, for_each) else { continue };
        for i in piece.own {
            fit.poles.iter().zip(&fitted.residues).for_each(|(&pole, residues)| add(i, pole, residues));
        }
    }
    Ok(())
}

/// How much FRFs of impacts are wrong because their records of length T end before the responses have decayed, `[frequency][sensor]`; s = iω + α with the decay α of an
/// exponential window:
/// $$ \Big( \sum_r \Big| \frac{R_{mr}}{s - s_r} \Big|^2 e^{2 (\operatorname{Re} s_r - \alpha) T} \Big)^{1/2} . $$
/// The transform of a free vibration ends with the factor 1 − e^{(s_r − s)T}. Its phase depends on when in the record the impact was.
///
/// # Errors
/// [`NoConvergence`] where a response is not finite.
///
/// # Limits
/// Modes outside of the lines are not in it. The time before the impact counts as if the response had decayed in it too.
pub fn cut_off(
    frfs: Frfs<'_>,
    decay_per_s: f64,
    record_s: f64,
    for_each: ForEach<'_>,
) -> Result<Vec<Vec<f64>>, NoConvergence> {
    let mut cut_off: Vec<Vec<f64>> = frfs.receptance.iter().map(|row| vec![0.0; row.len()]).collect();
    each_resonance(frfs, decay_per_s, None, for_each, |i, pole, residues| {
        let s = laplace_per_s(frfs.frequency_hz[i], decay_per_s);
        let left = ((pole.re - decay_per_s) * record_s).exp() / (s - pole).norm();
        for (sum, residue) in cut_off[i].iter_mut().zip(residues) {
            *sum = sum.hypot(left * residue.norm());
        }
    })?;
    Ok(cut_off)
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
