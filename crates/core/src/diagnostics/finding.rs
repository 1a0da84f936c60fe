//! What may be wrong with data, and what speaks for it.

use crate::quantity::Quantity;
use crate::response::Work;

/// What came of looking at the data.
#[derive(Debug, Clone, PartialEq)]
pub struct Diagnosis {
    /// What is wrong, the mesh last; empty where nothing is, or where the data do not say what.
    pub findings: Vec<Finding>,
    /// Other explanations, the likeliest first. Beside findings the best other one; without any, those between which the data do not decide.
    pub others: Vec<OtherExplanation>,
    /// Robust standard deviation of ln(measured/model), real and imaginary part each, with the likeliest modulus and all findings; `None` where it was not judged.
    pub misfit: Option<f64>,
    /// Why the data were not judged, if they were not.
    pub not_judged: Option<NotJudged>,
    /// Frequencies that were looked at.
    pub frequencies: usize,
    /// Work of size N.
    pub work: Work,
}

impl Diagnosis {
    /// Every fault that is named, with its sensors.
    pub(super) fn faults_mut(&mut self) -> impl Iterator<Item = (&Fault, &mut Vec<usize>)> {
        let findings = self.findings.iter_mut().map(|finding| (&finding.fault, &mut finding.sensors));
        let others = self.others.iter_mut().flat_map(|other| &mut other.faults);
        findings.chain(others.map(|(fault, sensors)| (&*fault, sensors)))
    }

    /// Some sensors as those of a whole experiment.
    pub(super) fn of_sensors(&mut self, number: impl Fn(usize) -> usize) {
        for (_, sensors) in self.faults_mut() {
            sensors.iter_mut().for_each(|m| *m = number(*m));
        }
    }
}

/// Faults that would explain the data as well, or nearly.
#[derive(Debug, Clone, PartialEq)]
pub struct OtherExplanation {
    /// What would be wrong, and with which sensors.
    pub faults: Vec<(Fault, Vec<usize>)>,
    /// Misfit with them, as [`Evidence::after`].
    pub misfit: f64,
    /// By how many nats it is less likely than the best explanation.
    pub nats_behind: f64,
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
    /// 39.37: inches taken for metres.
    InchesPerMetre,
    /// 0.0254: metres taken for inches.
    MetresPerInch,
    /// 4.448: pounds-force taken for newtons.
    PoundForce,
    /// 1/4.448: newtons taken for pounds-force.
    PerPoundForce,
    /// 386.1: in/s² taken for g.
    GravityInInches,
    /// 1/386.1: g taken for in/s².
    PerGravityInInches,
    /// 2π: a derivative by Hz taken for one by rad/s.
    TwoPi,
    /// 1/2π.
    PerTwoPi,
}

impl KnownFactor {
    /// All of them.
    pub const ALL: [Self; 16] = [
        Self::StandardGravity,
        Self::PerStandardGravity,
        Self::Thousand,
        Self::Thousandth,
        Self::Million,
        Self::Millionth,
        Self::GravityInMillimetres,
        Self::PerGravityInMillimetres,
        Self::InchesPerMetre,
        Self::MetresPerInch,
        Self::PoundForce,
        Self::PerPoundForce,
        Self::GravityInInches,
        Self::PerGravityInInches,
        Self::TwoPi,
        Self::PerTwoPi,
    ];

    /// The one nearest to a factor of this logarithm, within a tolerance of it.
    pub(super) fn nearest(ln_factor: f64, tolerance: f64) -> Option<Self> {
        let off = |known: Self| (ln_factor - known.value().ln()).abs();
        let near = Self::ALL.into_iter().filter(|known| off(*known) <= tolerance);
        near.min_by(|&a, &b| off(a).total_cmp(&off(b)))
    }

    /// The number.
    pub fn value(self) -> f64 {
        const STANDARD_GRAVITY: f64 = 9.80665;
        const INCH: f64 = 0.0254;
        const POUND: f64 = 0.453_592_37;
        match self {
            Self::StandardGravity => STANDARD_GRAVITY,
            Self::PerStandardGravity => 1.0 / STANDARD_GRAVITY,
            Self::Thousand => 1e3,
            Self::Thousandth => 1e-3,
            Self::Million => 1e6,
            Self::Millionth => 1e-6,
            Self::GravityInMillimetres => 1e3 * STANDARD_GRAVITY,
            Self::PerGravityInMillimetres => 1e-3 / STANDARD_GRAVITY,
            Self::InchesPerMetre => 1.0 / INCH,
            Self::MetresPerInch => INCH,
            Self::PoundForce => POUND * STANDARD_GRAVITY,
            Self::PerPoundForce => 1.0 / (POUND * STANDARD_GRAVITY),
            Self::GravityInInches => STANDARD_GRAVITY / INCH,
            Self::PerGravityInInches => INCH / STANDARD_GRAVITY,
            Self::TwoPi => std::f64::consts::TAU,
            Self::PerTwoPi => 1.0 / std::f64::consts::TAU,
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
    /// The FRF is wrong by a factor: its value over the right one.
    Factor {
        /// Measured over model.
        factor: f64,
        /// Standard deviation of its logarithm.
        relative_std: f64,
        /// The number with a name that it is, within [`KNOWN_FACTOR_RTOL`], three standard deviations, and half of the misfit that is left.
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
    /// The frequencies are wrong by a factor, their value over the right one: rad/s taken for Hz (2π), or Hz for rad/s (1/2π).
    Axis {
        /// Given over true frequency.
        factor: f64,
    },
    /// The nominal values are powers of ten off: the true ones are larger by about this factor. This is no fault of the data.
    Nominal {
        /// True over nominal value.
        ratio: f64,
    },
    /// The channel shows nothing: at most 1e-9 of what another one shows. It is left out of everything else.
    NoSignal,
    /// The band goes beyond what the mesh can carry.
    Mesh {
        /// √(K_ii/M_ii)/2π: a quarter of all rows, moved alone, vibrate at this frequency or below it.
        row_hz: f64,
        /// Highest frequency of the band.
        top_hz: f64,
    },
}

impl Fault {
    /// Whether both are the same fault, whatever their numbers.
    pub(super) fn is_same_kind(&self, other: &Self) -> bool {
        std::mem::discriminant(self) == std::mem::discriminant(other)
    }
}

/// How near a factor must be to a number with a name, relative: what calibrations of hammer and sensor leave together.
pub const KNOWN_FACTOR_RTOL: f64 = 0.05;

/// What speaks for a finding.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Evidence {
    /// Robust standard deviation of ln(measured/model) of the sensors that it concerns, real and imaginary part each, with the likeliest moduli and without this finding.
    pub before: f64,
    /// The same with it.
    pub after: f64,
    /// Log-likelihood ratio in nats to the data without this finding, after a penalty for every free number and for every choice.
    pub nats: f64,
    /// Log-likelihood ratio in nats of all findings to the best other explanation; `None` where no other one explains anything.
    pub margin: Option<f64>,
}

/// One thing that is wrong.
#[derive(Debug, Clone, PartialEq)]
pub struct Finding {
    /// What.
    pub fault: Fault,
    /// With which sensors; all of them where it is the load or the mesh.
    pub sensors: Vec<usize>,
    /// Why; `None` of the mesh and of a channel without a signal, which no model is needed to see.
    pub evidence: Option<Evidence>,
}

/// Why data were not judged.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum NotJudged {
    /// No unknown has a positive real part to begin with.
    Parameter,
    /// Too few values: a modulus of three numbers explains them whatever they are.
    FewValues,
    /// The reduced model cannot be built or solved.
    Breakdown,
}
