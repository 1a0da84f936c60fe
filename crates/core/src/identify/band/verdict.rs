//! From the choice at a frequency to its line.

use super::candidates::Candidates;
use super::neighbourhoods::{MAX_REDUCTION_ERROR, reduction_error};
use crate::c64;
use crate::identify::goodness_of_fit::{MAX_ERROR, MAX_RMS_MISFIT};
use crate::identify::outcome::{Line, Status};
use crate::identify::uncertainty::Uncertainty;
use crate::model::ModelAt;
use crate::rational::Poles;
use crate::response::relative_error_without;
use crate::roots::Candidate;
use crate::select::Choice;
use crate::series::ConvergenceRadius;
use crate::subspace::Assessment;

/// What there is to judge by at one frequency.
pub(super) struct Evidence<'a> {
    pub(super) at: &'a ModelAt<'a>,
    pub(super) measured: &'a [c64],
    pub(super) is_real: bool,
    /// The solution that is given: the chosen one, or the likeliest of a line that the path leaves out.
    pub(super) solution: Option<usize>,
    /// Sensors that count for nothing.
    pub(super) left_out: &'a [usize],
    /// Noise over the assumed standard deviations.
    pub(super) noise: Option<f64>,
    /// Degrees of freedom of χ².
    pub(super) freedom: usize,
    /// ‖∂²x/∂c²‖ at the chosen correction, weighed by the standard deviations.
    pub(super) second: f64,
    /// `None` for a parameter with powers.
    pub(super) poles: Option<&'a Poles>,
    /// How good the subspace is at the chosen correction; `None` on the full model.
    pub(super) assessment: Option<Assessment>,
}

pub(super) fn verdict(evidence: &Evidence<'_>, found: &Candidates, choice: &Choice) -> Line {
    let nominal = evidence.at.parameters[0].nominal;
    let mut line = Line::unknown(evidence.at.frequency_hz, nominal, found.order);
    line.nominal_response = found.nominal_response.clone();
    line.roots = found.candidates();
    line.radius = evidence.poles.map(|poles| ConvergenceRadius {
        per_unit: poles.radius_per_unit(),
        residual: 0.0,
        converged: true,
    });
    line.breakdown = found.breakdown.clone();
    let Some(chosen) = evidence.solution.map(|k| &found.solutions[k]) else {
        line.status = if found.breakdown.is_some() { Status::Failed } else { Status::NoRoot };
        return line;
    };
    line.on_path = choice.chosen.is_some();
    let mut rivals = choice.rivals.clone();
    if !line.on_path {
        // Solutions, but none that belongs to those of the other lines: more than one is possible, or none is right.
        rivals = (0..found.solutions.len()).filter(|&k| evidence.solution != Some(k)).collect();
    }
    let factor = nominal + chosen.correction;
    let error = relative_error_without(evidence.left_out, evidence.measured, &chosen.response);
    line.set_correction(chosen.correction);
    line.error = Some(error).filter(|error| error.is_finite());
    line.spectral_radius = line.radius.map(|radius| radius.at(chosen.correction));
    line.updated_response = chosen.response.clone();
    line.rivals = rivals.iter().map(|&k| vec![nominal + found.solutions[k].correction]).collect();
    line.required_order = evidence.poles.and_then(|poles| {
        let order = |m| poles.required_order(m, chosen.correction, SERIES_ORDER_TOL);
        (0..evidence.measured.len()).map(order).try_fold(0, |most, n| Some(most.max(n?)))
    });
    let certified = evidence.assessment.as_ref().map(|a| reduction_error(a, factor, evidence.measured));
    line.reduction_error = certified.map(|certified| certified.response).filter(|c| c.is_finite());
    let noise = evidence.noise.unwrap_or(0.0);
    let square = chosen.misfit / evidence.freedom.max(1) as f64;
    let unexplained = error > MAX_ERROR && square.sqrt() > MAX_RMS_MISFIT * noise;
    let per_freedom = evidence.noise.filter(|_| evidence.freedom > 0).map(|noise| square / (noise * noise));
    line.chi_squared = per_freedom.filter(|chi_squared| chi_squared.is_finite());
    let bars = |level| Uncertainty::new(factor, evidence.is_real, chosen.std, evidence.second, level);
    let uncertainty = evidence.noise.map(bars);
    let unknown = uncertainty.is_some_and(|bars| !bars.is_known(factor) || !bars.is_linear());
    line.values[0].uncertainty = uncertainty.filter(|bars| bars.correction_std.is_finite());
    let uncertain = certified.is_some_and(|certified| certified.factor > MAX_REDUCTION_ERROR);
    line.status = Status::of([
        (unexplained, Status::Unexplained),
        (!line.rivals.is_empty(), Status::Ambiguous),
        // The only solution, and it contradicts those of the other lines.
        (!line.on_path, Status::Unexplained),
        (unknown, Status::NotIdentifiable),
        (uncertain || chosen.is_unsure(), Status::Failed),
    ]);
    line
}

/// Error for which the order of the series is predicted: that to which the modulus is to be right.
const SERIES_ORDER_TOL: f64 = 1e-6;

impl Candidates {
    /// Everything that was found, as candidates: solutions first.
    fn candidates(&self) -> Vec<Candidate> {
        let admitted = self.solutions.iter().map(|s| Candidate {
            correction: s.correction,
            drift: s.residual,
            refusal: None,
        });
        admitted.chain(self.refused.iter().copied()).collect()
    }
}
