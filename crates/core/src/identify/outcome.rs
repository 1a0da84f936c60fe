//! What came out at one frequency, with its evidence.

use super::{Explained, GoodnessOfFit, Uncertainty};
use crate::c64;
use crate::material::loss_factor;
use crate::response::Work;
use crate::roots::Candidate;
use crate::series::ConvergenceRadius;
use frfit_linalg::solve::Breakdown;

/// How far a value can be trusted. A value that exists is given whatever the status.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Status {
    /// One value, and nothing known speaks against it.
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

impl Status {
    /// All of them.
    pub const ALL: [Self; 8] = [
        Self::Ok,
        Self::Ambiguous,
        Self::NoRoot,
        Self::NotIdentifiable,
        Self::Unexplained,
        Self::Diverged,
        Self::Failed,
        Self::OutOfBand,
    ];

    /// The word that tables use.
    pub fn name(self) -> &'static str {
        match self {
            Self::Ok => "ok",
            Self::Ambiguous => "ambiguous",
            Self::NoRoot => "no_root",
            Self::NotIdentifiable => "not_identifiable",
            Self::Unexplained => "unexplained",
            Self::Diverged => "diverged",
            Self::Failed => "failed",
            Self::OutOfBand => "out_of_band",
        }
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

/// The outcome at one frequency. What does not exist is `None`, never zero.
#[derive(Debug, Clone, PartialEq)]
pub struct Identified {
    /// The frequency.
    pub frequency_hz: f64,
    /// Nominal value p̄ of the parameter.
    pub nominal: c64,
    /// The correction c, whatever the status. With `diverged` it is the root of least |c| within the bounds.
    pub correction: Option<c64>,
    /// Whether the correction lies on the path that a joint selection chose through the band. Otherwise it is the likeliest of
    /// the solutions of a line that the path leaves out.
    pub on_path: bool,
    /// ε over all sensors but those that were left out, P-40, from a fresh direct solve with the corrected parameter; `None` where nothing but
    /// zeros was measured.
    pub error: Option<f64>,
    /// ρ(−c A₀⁻¹A₁) at the correction, P-14.
    pub spectral_radius: Option<f64>,
    /// The radius of convergence behind it.
    pub radius: Option<ConvergenceRadius>,
    /// Order of the series, or iterations.
    pub order: usize,
    /// Roots of the highest order, least |c| first, each admissible or with the reason why not.
    pub roots: Vec<Candidate>,
    /// The verdict.
    pub status: Status,
    /// Why a system could not be solved, where one could not.
    pub breakdown: Option<Breakdown>,
    /// Receptance at the sensors with the nominal parameter; empty where it could not be solved.
    pub nominal_response: Vec<c64>,
    /// Receptance at the sensors with the corrected parameter, from the direct solve; empty where there is none.
    pub updated_response: Vec<c64>,
    /// Corrections that the data cannot exclude beside the one that is given: of a joint selection with status `ambiguous`.
    pub alternatives: Vec<c64>,
    /// Estimated error of the reduced model's response at the sensors, relative to the measured one, at the correction; `None` where the
    /// full model answered, or nothing but zeros was measured.
    pub reduction_error: Option<f64>,
    /// Order that the paper's series would need for a truncation error of 1e-6 at the correction; `None` where it diverges, or was not asked.
    pub required_order: Option<usize>,
    /// Error bars of the factor: of a joint selection, where the noise is known or the band tells it.
    pub uncertainty: Option<Uncertainty>,
    /// χ² of the sensors per degree of freedom; `None` where there is no degree of freedom, as for the complex factor of one sensor.
    pub chi_squared: Option<f64>,
    /// Work done.
    pub work: Work,
}

impl Identified {
    /// An outcome with nothing known yet.
    pub(super) fn unknown(frequency_hz: f64, nominal: c64, order: usize) -> Self {
        Self {
            frequency_hz,
            nominal,
            correction: None,
            on_path: false,
            error: None,
            spectral_radius: None,
            radius: None,
            order,
            roots: Vec::new(),
            status: Status::NoRoot,
            breakdown: None,
            nominal_response: Vec::new(),
            updated_response: Vec::new(),
            alternatives: Vec::new(),
            reduction_error: None,
            required_order: None,
            uncertainty: None,
            chi_squared: None,
            work: Work::default(),
        }
    }

    /// What is known of this frequency before a law or a curve answers for it: the nominal response and the solutions there.
    pub(super) fn unanswered(&self) -> Self {
        Self {
            radius: self.radius,
            roots: self.roots.clone(),
            breakdown: self.breakdown.clone(),
            nominal_response: self.nominal_response.clone(),
            status: Status::Failed,
            ..Self::unknown(self.frequency_hz, self.nominal, self.order)
        }
    }

    /// No value is given beyond its bounds.
    pub(super) fn forget_value(&mut self, status: Status) {
        *self = Self { status, ..self.unanswered() };
    }

    /// The outcome at a frequency that is left out.
    pub fn out_of_band(frequency_hz: f64, nominal: c64) -> Self {
        Self { status: Status::OutOfBand, ..Self::unknown(frequency_hz, nominal, 0) }
    }

    /// The outcome where the nominal system could not even be factorised.
    pub fn broken(frequency_hz: f64, nominal: c64, order: usize, breakdown: Breakdown) -> Self {
        let status = Status::Failed;
        Self { status, breakdown: Some(breakdown), ..Self::unknown(frequency_hz, nominal, order) }
    }

    /// Updated factor p̄ + c, P-35.
    pub fn factor(&self) -> Option<c64> {
        self.correction.map(|c| self.nominal + c)
    }

    /// Distance of the nearest pole of the response from the nominal value, over |p̄|: how far the parameter may change before the series
    /// diverges.
    pub fn convergence_radius(&self) -> Option<f64> {
        self.radius.map(|radius| 1.0 / (radius.per_unit * self.nominal.norm()))
    }

    /// Storage modulus E′, the updated factor's real part.
    pub fn storage(&self) -> Option<f64> {
        self.factor().map(|factor| factor.re)
    }

    /// Loss factor η of the updated factor, P-31.
    pub fn loss_factor(&self) -> Option<f64> {
        self.factor().map(loss_factor)
    }

    /// Number of admissible roots.
    pub fn admissible(&self) -> usize {
        self.roots.iter().filter(|root| root.refusal.is_none()).count()
    }
}
