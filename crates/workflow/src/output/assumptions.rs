//! What is taken for known and contradicted by the measurements, in words.

use crate::load::Case;
use frfit::identify::{Assumption, ContradictedAssumption};
use frfit::model::FactorPart;

/// One of them as a sentence without its first capital and its full stop.
pub fn contradicted(case: &Case, one: &ContradictedAssumption) -> String {
    let (off, std) = (100.0 * one.error.abs(), 100.0 * one.std);
    let sense = if one.error > 0.0 { "larger" } else { "smaller" };
    match one.what {
        Assumption::Calibration => format!(
            "all measured responses are {off:.1} % {sense} than the model's, and the calibration is taken to be good to {std:.1} %"
        ),
        Assumption::Factor { term, part } => {
            let name = &case.model.terms()[term].name;
            match part {
                FactorPart::Storage => format!(
                    "the factor of {name} would have to be {off:.1} % {sense}, and is taken to be known to {std:.1} %"
                ),
                FactorPart::LossFactor => format!(
                    "the loss factor of {name} would have to be {:.2e} {sense}, and is taken to be known to {:.1e}",
                    one.error.abs(),
                    one.std
                ),
            }
        }
    }
}
