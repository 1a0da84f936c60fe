//! The error of a known factor, part of a reduced model with errors in it (B-11).

use crate::c64;
use crate::model::FactorPart;

/// The error of a known factor.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct FactorError {
    pub(crate) term: usize,
    pub(crate) part: FactorPart,
    /// ν of the storage, in its logarithm as an unknown has it, so that what one takes from the other leaves the response; Δη, absolute, of the loss factor.
    pub(crate) error: f64,
}

impl FactorError {
    /// Relative error of the storage with its slope, exp(ν) − 1 and exp(ν); Δη of the loss factor.
    pub(crate) fn relative(&self) -> [f64; 2] {
        match self.part {
            FactorPart::Storage => [self.error.exp_m1(), self.error.exp()],
            FactorPart::LossFactor => [self.error, 1.0],
        }
    }

    /// f exp(ν), or f + iΔη Re f.
    pub(super) fn applied_to(&self, factor: c64) -> c64 {
        match self.part {
            FactorPart::Storage => factor * self.error.exp(),
            FactorPart::LossFactor => factor + c64::I * self.error * factor.re,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::FactorError;
    use crate::c64;
    use crate::model::FactorPart;

    /// An unknown that is a tenth too small with a stiffness matrix that is as much too stiff is the same model: a search is not held between the two.
    #[test]
    fn an_unknown_and_the_error_of_its_matrix_add_up() {
        let by = |error| FactorError { term: 0, part: FactorPart::Storage, error };
        let factor = c64::new(5e9, 7e6);
        for nu in [-0.3, -0.01, 1e-4, 0.1, 0.4] {
            let both = by(nu).applied_to(factor * (-nu).exp());
            assert!((both / factor - 1.0).norm() < 1e-15, "{nu}: {both}");
            let [error, slope] = by(nu).relative();
            assert!((by(nu).applied_to(factor) / factor - 1.0 - error).norm() < 1e-15, "{nu}");
            let step = 1e-6;
            let difference = (by(nu + step).relative()[0] - by(nu - step).relative()[0]) / (2.0 * step);
            assert!((difference / slope - 1.0).abs() < 1e-9, "{nu}: {difference} {slope}");
        }
    }
}
