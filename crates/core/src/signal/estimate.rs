//! Estimators of the frequency response function, and how sure they are.

use super::spectra::Spectra;
use super::variance::variances;
use crate::c64;
use std::fmt;
use std::str::FromStr;

/// Which noise an estimator of H assumes. S is the mean over the impacts of products of transforms, S_fx that of F̄X.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum Estimator {
    /// $H_1 = S_{fx} / S_{ff}$: noise in the response alone; too small where there is noise in the force.
    #[default]
    H1,
    /// $H_2 = S_{xx} / S_{xf}$: noise in the force alone; too large where there is noise in the response.
    H2,
    /// $H_v = \sqrt{H_1 H_2}$, of the phase that both have: noise in both, alike relative to the signals.
    Hv,
}

impl Estimator {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::H1, Self::H2, Self::Hv];

    /// `h1`, `h2` or `hv`.
    pub fn name(self) -> &'static str {
        match self {
            Self::H1 => "h1",
            Self::H2 => "h2",
            Self::Hv => "hv",
        }
    }
}

impl fmt::Display for Estimator {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// A word that names no [`Estimator`].
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct UnknownEstimator(pub String);

impl fmt::Display for UnknownEstimator {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "expected h1, h2 or hv, found {:?}", self.0)
    }
}

impl std::error::Error for UnknownEstimator {}

impl FromStr for Estimator {
    type Err = UnknownEstimator;

    fn from_str(name: &str) -> Result<Self, UnknownEstimator> {
        let wanted = name.to_ascii_lowercase();
        Self::ALL.into_iter().find(|e| e.name() == wanted).ok_or_else(|| UnknownEstimator(name.to_owned()))
    }
}

/// The FRF of one response channel over [`super::Measured::frequency_hz`].
#[derive(Debug, Clone, PartialEq)]
pub struct Frf {
    /// Response over force in SI units.
    pub response: Vec<c64>,
    /// Coherence γ² = |S_fx|²/(S_ff S_xx). `None` of a single impact, of which it is 1 whatever was measured.
    pub coherence: Option<Vec<f64>>,
    /// Variance of the real and of the imaginary part, B-6 ([`variances`]); `None` without a coherence.
    pub variance: Option<Vec<f64>>,
    /// √(Σ|X|²/n) of the response's transform over that of the force: the gain that the spectra alone show.
    pub gain: Vec<f64>,
}

pub(super) fn frf(
    spectra: &Spectra,
    response: usize,
    lines: &[usize],
    averages: usize,
    estimator: Estimator,
) -> Frf {
    let (sum, cross) = (&spectra.responses[response], &spectra.cross[response]);
    let of = |&k: &usize| {
        let (ff, xx, fx) = (spectra.force[k], sum[k], cross[k]);
        match estimator {
            Estimator::H1 => fx / ff,
            // Where both spectra have nothing in common there is no phase: H₁ = 0 is all that is left.
            _ if fx.norm() == 0.0 => fx,
            Estimator::H2 => xx / fx.conj(),
            Estimator::Hv => fx / fx.norm() * (xx / ff).sqrt(),
        }
    };
    let values: Vec<c64> = lines.iter().map(of).collect();
    // Roundoff may carry it beyond 1.
    let coherence: Option<Vec<f64>> = (averages > 1).then(|| {
        lines.iter().map(|&k| (cross[k].norm_sqr() / (spectra.force[k] * sum[k])).min(1.0)).collect()
    });
    Frf {
        variance: coherence.as_ref().map(|coherence| variances(&values, coherence, averages)),
        coherence,
        gain: lines.iter().map(|&k| (sum[k] / spectra.force[k]).sqrt()).collect(),
        response: values,
    }
}
