//! What came out at one frequency, with its evidence.

use super::goodness_of_fit::{Explained, GoodnessOfFit};
use super::uncertainty::Uncertainty;
use crate::c64;
use crate::material::loss_factor;
use crate::response::Work;
use crate::roots::Candidate;
use crate::series::ConvergenceRadius;
use frfit_linalg::solve::Breakdown;

/// What a value is good for: the rank of a [`Status`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Trust {
    /// A result.
    Trusted,
    /// The likeliest of several values.
    Ambiguous,
    /// Evidence, not a result: a curve shows it apart from the others.
    EvidenceOnly,
    /// No value, or only the last one of a series that diverges: for tables, not for curves.
    NoAnswer,
    /// No value was asked for.
    NotAsked,
}

impl Trust {
    /// In a word or two.
    pub fn name(self) -> &'static str {
        match self {
            Self::Trusted => "trusted",
            Self::Ambiguous => "ambiguous",
            Self::EvidenceOnly => "evidence only",
            Self::NoAnswer => "no answer",
            Self::NotAsked => "not asked",
        }
    }
}

/// How far a value can be trusted. A value that exists is given whatever the status.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Status {
    /// One value explains the sensors, and no other does nearly as well.
    Ok,
    /// Several values explain the measurement; the likeliest is given with its rivals.
    Ambiguous,
    /// No value within the bounds solves the equations.
    NoRoot,
    /// Noise leaves the value unknown: the response hardly depends on it, or so nonlinearly that the error bar is not
    /// valid ([`super::Uncertainty`]).
    NotIdentifiable,
    /// The model does not explain the measurement of this line, or of the band, within its errors.
    Unexplained,
    /// The series does not converge at the root: its spectral radius is above one, or the root moves as terms are added.
    Diverged,
    /// A system could not be solved, or not accurately enough, or a search did not converge.
    Failed,
    /// The frequency is outside the band or without data.
    OutOfBand,
}

/// What is said of a status wherever it is shown.
struct About {
    name: &'static str,
    label: &'static str,
    trust: Trust,
    meaning: &'static str,
}

impl Status {
    /// All of them, in the order in which they are listed.
    pub const ALL: [Self; Self::OutOfBand as usize + 1] = [
        Self::Ok,
        Self::Ambiguous,
        Self::NoRoot,
        Self::NotIdentifiable,
        Self::Unexplained,
        Self::Diverged,
        Self::Failed,
        Self::OutOfBand,
    ];

    /// The only place that gives the name of a status and its meaning.
    fn about(self) -> About {
        match self {
            Self::Ok => About {
                name: "ok",
                label: "trusted",
                trust: Trust::Trusted,
                meaning: "one value explains the sensors, and no other does nearly as well",
            },
            Self::Ambiguous => About {
                name: "ambiguous",
                label: "ambiguous",
                trust: Trust::Ambiguous,
                meaning: "several values explain the measurement",
            },
            Self::NoRoot => About {
                name: "no_root",
                label: "no solution",
                trust: Trust::NoAnswer,
                meaning: "no value within the bounds solves the equations",
            },
            Self::NotIdentifiable => About {
                name: "not_identifiable",
                label: "not identifiable",
                trust: Trust::EvidenceOnly,
                meaning: "noise leaves the value unknown",
            },
            Self::Unexplained => About {
                name: "unexplained",
                label: "not explained",
                trust: Trust::EvidenceOnly,
                meaning: "the model does not explain the measurement within its errors",
            },
            Self::Diverged => About {
                name: "diverged",
                label: "diverged",
                trust: Trust::NoAnswer,
                meaning: "the series does not converge, as near resonances of lightly damped structures; \
                          its root of least correction is evidence, not a result",
            },
            Self::Failed => About {
                name: "failed",
                label: "failed",
                trust: Trust::EvidenceOnly,
                meaning: "a system could not be solved accurately, or a search did not converge",
            },
            Self::OutOfBand => About {
                name: "out_of_band",
                label: "left out",
                trust: Trust::NotAsked,
                meaning: "outside the band, left out, or without data",
            },
        }
    }

    /// The word that tables use.
    pub fn name(self) -> &'static str {
        self.about().name
    }

    /// The status with this [name](Self::name).
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|status| status.name() == name)
    }

    /// The word or two that a reader sees in place of the name.
    pub fn label(self) -> &'static str {
        self.about().label
    }

    /// A clause with its meaning: `noise leaves the value unknown`.
    pub fn meaning(self) -> &'static str {
        self.about().meaning
    }

    /// What a value with this status is good for.
    pub fn trust(self) -> Trust {
        self.about().trust
    }

    /// The status of the first doubt that holds.
    pub(super) fn of(doubts: impl IntoIterator<Item = (bool, Self)>) -> Self {
        doubts.into_iter().find(|(holds, _)| *holds).map_or(Self::Ok, |(_, status)| status)
    }

    /// This status where the band has a fit: no value is `ok` where the band is not explained.
    pub(super) fn within(self, fit: Option<GoodnessOfFit>) -> Self {
        let unexplained = fit.is_some_and(|fit| fit.verdict == Explained::No);
        if self == Self::Ok && unexplained { Self::Unexplained } else { self }
    }
}

/// One unknown at one frequency.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LineValue {
    /// Nominal value p̄.
    pub nominal: c64,
    /// The identified value p = p̄ + c, P-35, whatever the status of the line; of an unknown that holds for the band its
    /// value at this frequency. `None` where nothing was found.
    pub value: Option<c64>,
    /// The correction c. With status `diverged` it is the root of least |c| within the bounds.
    pub correction: Option<c64>,
    /// Its error bars: of a joint selection, where the noise is known or the band shows it.
    pub uncertainty: Option<Uncertainty>,
}

impl LineValue {
    /// Nothing but the nominal value.
    pub(super) fn unknown(nominal: c64) -> Self {
        Self { nominal, value: None, correction: None, uncertainty: None }
    }

    /// Real part of the value: the storage modulus E′.
    pub fn storage(&self) -> Option<f64> {
        self.value.map(|value| value.re)
    }

    /// Loss factor η of the value, P-31.
    pub fn loss_factor(&self) -> Option<f64> {
        self.value.map(loss_factor)
    }
}

/// What the data say of one of several solutions.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Standing {
    /// Its values are those of the line.
    Chosen,
    /// The data cannot exclude it.
    Rival,
    /// The other frequencies exclude it.
    Excluded,
}

/// A solution of a line with several unknowns.
#[derive(Debug, Clone, PartialEq)]
pub struct LineSolution {
    /// One value for each unknown of the problem, those that hold for the band too.
    pub values: Vec<c64>,
    /// χ² of the sensors per degree of freedom; `None` as in [`Line::chi_squared`].
    pub chi_squared: Option<f64>,
    /// What the data say of it.
    pub standing: Standing,
}

/// What was found at one frequency. What does not exist is `None`, never zero.
#[derive(Debug, Clone, PartialEq)]
pub struct Line {
    /// The frequency.
    pub frequency_hz: f64,
    /// One for each unknown of the problem, those that hold for the band too.
    pub values: Vec<LineValue>,
    /// How far the values of this frequency can be trusted; where all unknowns hold for the band, whether they explain it.
    pub status: Status,
    /// Whether the values lie on the path that a joint selection chose through the band. Otherwise they are the likeliest of
    /// the solutions of a line that the path leaves out.
    pub on_path: bool,
    /// Other values of all unknowns that the data cannot exclude.
    pub rivals: Vec<Vec<c64>>,
    /// All solutions that were found with several unknowns, the least misfit first; empty of a single unknown, which has
    /// [`Self::roots`].
    pub solutions: Vec<LineSolution>,
    /// ε over all sensors but those that were left out, P-40; `None` where nothing but zeros was measured.
    pub error: Option<f64>,
    /// χ² of the sensors per degree of freedom; `None` where there is no degree of freedom, as for the complex factor of one
    /// sensor.
    pub chi_squared: Option<f64>,
    /// Estimated error of the reduced model's response at the sensors, relative to the measured one; `None` where the full
    /// model answered, or nothing but zeros was measured.
    pub reduction_error: Option<f64>,
    /// Why a system could not be solved, where one could not.
    pub breakdown: Option<Breakdown>,
    /// Receptance at the sensors with the nominal values; empty where it could not be solved.
    pub nominal_response: Vec<c64>,
    /// Receptance at the sensors with the identified values; empty where there are no values.
    pub updated_response: Vec<c64>,
    /// Roots of the highest order, least |c| first, each admissible or with the reason why not: of a single unknown.
    pub roots: Vec<Candidate>,
    /// Order of the series or of the rational response, or iterations: of a single unknown.
    pub order: usize,
    /// ρ(−c A₀⁻¹A₁) at the correction, P-14: of a single unknown.
    pub spectral_radius: Option<f64>,
    /// The radius of convergence behind it.
    pub radius: Option<ConvergenceRadius>,
    /// Order that the paper's series would need for a truncation error of 1e-6 at the correction; `None` where it diverges, or
    /// was not asked.
    pub required_order: Option<usize>,
    /// Work done at this frequency alone.
    pub work: Work,
}

impl Line {
    /// A line with nothing known yet.
    pub(super) fn of_values(frequency_hz: f64, values: Vec<LineValue>) -> Self {
        Self {
            frequency_hz,
            values,
            status: Status::NoRoot,
            on_path: false,
            rivals: Vec::new(),
            solutions: Vec::new(),
            error: None,
            chi_squared: None,
            reduction_error: None,
            breakdown: None,
            nominal_response: Vec::new(),
            updated_response: Vec::new(),
            roots: Vec::new(),
            order: 0,
            spectral_radius: None,
            radius: None,
            required_order: None,
            work: Work::default(),
        }
    }

    /// The same for a single unknown.
    pub(super) fn unknown(frequency_hz: f64, nominal: c64, order: usize) -> Self {
        Self { order, ..Self::of_values(frequency_hz, vec![LineValue::unknown(nominal)]) }
    }

    /// What is known of this frequency before a law or a curve answers for it: the nominal response and the solutions there.
    pub(super) fn unanswered(&self) -> Self {
        Self {
            radius: self.radius,
            roots: self.roots.clone(),
            breakdown: self.breakdown.clone(),
            nominal_response: self.nominal_response.clone(),
            status: Status::Failed,
            ..Self::unknown(self.frequency_hz, self.nominal(), self.order)
        }
    }

    /// Drops the value and keeps the evidence: for a value outside its bounds.
    pub(super) fn forget_value(&mut self, status: Status) {
        *self = Self { status, ..self.unanswered() };
    }

    /// A line that is left out.
    pub fn out_of_band(frequency_hz: f64, nominal: &[c64]) -> Self {
        let values = nominal.iter().map(|&nominal| LineValue::unknown(nominal)).collect();
        Self { status: Status::OutOfBand, ..Self::of_values(frequency_hz, values) }
    }

    /// A line where the nominal system could not even be factorised.
    pub(super) fn broken(frequency_hz: f64, nominal: &[c64], order: usize, breakdown: Breakdown) -> Self {
        let values = nominal.iter().map(|&nominal| LineValue::unknown(nominal)).collect();
        let status = Status::Failed;
        Self { status, order, breakdown: Some(breakdown), ..Self::of_values(frequency_hz, values) }
    }

    pub(super) fn set_correction(&mut self, correction: c64) {
        let value = &mut self.values[0];
        (value.correction, value.value) = (Some(correction), Some(value.nominal + correction));
    }

    /// Nominal value of the first unknown.
    pub fn nominal(&self) -> c64 {
        self.values[0].nominal
    }

    /// Correction c of the first unknown.
    pub fn correction(&self) -> Option<c64> {
        self.values[0].correction
    }

    /// Value p̄ + c of the first unknown, P-35.
    pub fn factor(&self) -> Option<c64> {
        self.values[0].value
    }

    /// Error bars of the first unknown.
    pub fn uncertainty(&self) -> Option<Uncertainty> {
        self.values[0].uncertainty
    }

    /// Storage modulus E′ of the first unknown.
    pub fn storage(&self) -> Option<f64> {
        self.values[0].storage()
    }

    /// Loss factor η of the first unknown, P-31.
    pub fn loss_factor(&self) -> Option<f64> {
        self.values[0].loss_factor()
    }

    /// Distance of the nearest pole of the response from the nominal value, over |p̄|: how far the parameter may change before
    /// the series diverges.
    pub fn convergence_radius(&self) -> Option<f64> {
        self.radius.map(|radius| 1.0 / (radius.per_unit * self.nominal().norm()))
    }

    /// Whether a root of the only unknown is a rival of the value that is given.
    pub fn is_rival(&self, root: &Candidate) -> bool {
        let factor = self.nominal() + root.correction;
        self.rivals.iter().any(|rival| rival[0] == factor)
    }

    /// Makes all error bars longer; a value that they leave unknown is no longer `ok`.
    pub(super) fn lengthen_bars(&mut self, by: f64) {
        if by <= 1.0 {
            return;
        }
        for value in &mut self.values {
            let (Some(factor), Some(bars)) = (value.value, value.uncertainty.as_mut()) else { continue };
            bars.lengthen(by);
            if self.status == Status::Ok && !(bars.is_known(factor) && bars.is_linear()) {
                self.status = Status::NotIdentifiable;
            }
        }
    }

    /// Number of solutions that were found within the bounds.
    pub fn candidate_count(&self) -> usize {
        if !self.solutions.is_empty() {
            return self.solutions.len();
        }
        let admissible = self.roots.iter().filter(|root| root.refusal.is_none()).count();
        let known = usize::from(self.values.iter().any(|value| value.value.is_some())) + self.rivals.len();
        if self.roots.is_empty() { known } else { admissible }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn every_status_has_words_of_its_own() {
        for words in [Status::name, Status::label, Status::meaning] {
            let all: BTreeSet<&str> = Status::ALL.map(words).into();
            assert_eq!(all.len(), Status::ALL.len(), "{all:?}");
        }
        assert!(Status::ALL.into_iter().all(|status| Status::named(status.name()) == Some(status)));
        assert_eq!(Status::named("fine"), None);
    }
}
