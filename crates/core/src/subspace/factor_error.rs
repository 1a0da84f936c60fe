//! The error of a known factor, part of a reduced model with errors in it (B-11).

use crate::c64;
use crate::model::FactorPart;

/// The error of a known factor.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct FactorError {
    pub(crate) term: usize,
    pub(crate) part: FactorPart,
    /// ν, relative, of the storage; Δη, absolute, of the loss factor.
    pub(crate) error: f64,
}

impl FactorError {
    /// f(1 + ν), or f + iΔη Re f.
    pub(super) fn applied_to(&self, factor: c64) -> c64 {
        match self.part {
            FactorPart::Storage => factor * (1.0 + self.error),
            FactorPart::LossFactor => factor + c64::I * self.error * factor.re,
        }
    }
}
