//! What may be wrong with data, and what speaks for it.

use crate::quantity::Quantity;
use crate::response::Work;

/// What came of looking at the data.
#[derive(Debug, Clone, PartialEq)]
pub struct Diagnosis {
    /// What is wrong, the mesh last; empty where nothing is.
    pub findings: Vec<Finding>,
    /// Robust standard deviation of ln(measured/model), real and imaginary part each, with the likeliest modulus and all findings; `None` where it was not judged.
    pub misfit: Option<f64>,
    /// Why the data were not judged, if they were not.
    pub not_judged: Option<NotJudged>,
    /// Frequencies that were looked at.
    pub frequencies: usize,
    /// Work of size N.
    pub work: Work,
}

/// A number that has a name: what units and habits make of an FRF.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum KnownFactor {
    /// 9.80665: m/s² taken for g.
    StandardGravity,
    /// 1/9.80665: g taken for m/s².
    PerStandardGravity,
    /// 1e3.
    Thousand,
    /// 1e-3.
    Thousandth,
    /// 1e6.
    Million,
    /// 1e-6.
    Millionth,
    /// 9806.65: mm/s² taken for g.
    GravityInMillimetres,
    /// 1/9806.65: g taken for mm/s².
    PerGravityInMillimetres,
}

impl KnownFactor {
    /// All of them.
    pub const ALL: [Self; 8] = [
        Self::StandardGravity,
        Self::PerStandardGravity,
        Self::Thousand,
        Self::Thousandth,
        Self::Million,
        Self::Millionth,
        Self::GravityInMillimetres,
        Self::PerGravityInMillimetres,
    ];

    /// The number.
    pub fn value(self) -> f64 {
        const STANDARD_GRAVITY: f64 = 9.80665;
        match self {
            Self::StandardGravity => STANDARD_GRAVITY,
            Self::PerStandardGravity => 1.0 / STANDARD_GRAVITY,
            Self::Thousand => 1e3,
            Self::Thousandth => 1e-3,
            Self::Million => 1e6,
            Self::Millionth => 1e-6,
            Self::GravityInMillimetres => 1e3 * STANDARD_GRAVITY,
            Self::PerGravityInMillimetres => 1e-3 / STANDARD_GRAVITY,
        }
    }
}

/// A row of the model that would explain a measurement.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OtherRow {
    /// From 0.
    pub row: usize,
    /// Misfit with it, as [`Evidence::after`].
    pub misfit: f64,
}

/// What is wrong.
#[derive(Debug, Clone, PartialEq)]
pub enum Fault {
    /// The FRF is the complex conjugate: it is of the convention e^{−iωt}.
    Conjugated,
    /// The FRF has the opposite sign.
    Sign,
    /// It is another quantity than it is taken for.
    Quantity {
        /// What the case says.
        taken_for: Quantity,
        /// What it is.
        is: Quantity,
        /// Slope of ln|measured/model| over ln ω that is left when it is taken for what the case says.
        slope: f64,
        /// Standard deviation of the slope.
        slope_std: f64,
    },
    /// The FRF is so many times what it should be.
    Factor {
        /// Measured over model.
        factor: f64,
        /// Standard deviation of its logarithm.
        relative_std: f64,
        /// The number with a name that it is, within [`KNOWN_FACTOR_RTOL`] and five standard deviations.
        known: Option<KnownFactor>,
    },
    /// The response is late: its phase falls in proportion to frequency.
    Delay {
        /// Positive where the response is late.
        seconds: f64,
        /// Standard deviation.
        std: f64,
    },
    /// The response was measured on another row than the case says.
    ResponseDof {
        /// Best first; those behind it cannot be distinguished from it.
        rows: Vec<OtherRow>,
    },
    /// The structure was driven on another row than the case says.
    LoadDof {
        /// Best first; those behind it cannot be distinguished from it.
        rows: Vec<OtherRow>,
    },
    /// The band goes beyond what the mesh can carry.
    Mesh {
        /// √(K_ii/M_ii)/2π: a quarter of all rows, moved alone, vibrate at this frequency or below it.
        row_hz: f64,
        /// Highest frequency of the band.
        top_hz: f64,
    },
}

/// How near a factor must be to a number with a name, relative: what calibrations of hammer and sensor leave together.
pub const KNOWN_FACTOR_RTOL: f64 = 0.05;

/// What speaks for a finding.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Evidence {
    /// Robust standard deviation of ln(measured/model), real and imaginary part each, with the likeliest modulus and without this finding.
    pub before: f64,
    /// The same with it.
    pub after: f64,
    /// Log-likelihood ratio in nats, after a penalty for every free number.
    pub nats: f64,
}

/// One thing that is wrong.
#[derive(Debug, Clone, PartialEq)]
pub struct Finding {
    /// What.
    pub fault: Fault,
    /// With which sensors; all of them where it is the load or the mesh.
    pub sensors: Vec<usize>,
    /// Why; `None` of the mesh, about which the matrices speak without any data.
    pub evidence: Option<Evidence>,
}

/// Why data were not judged.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum NotJudged {
    /// The unknown factor has no positive real part to begin with, or enters with a power.
    Parameter,
    /// Too few values: a modulus of three numbers explains them whatever they are.
    FewValues,
    /// The reduced model cannot be built or solved.
    Breakdown,
    /// With none of several unknowns free, the others at their nominal values, are the data explained, as they are or with a finding.
    SeveralUnknowns,
}
