//! Laws of the complex modulus with few parameters, fitted to moduli or straight to the FRFs (B-7).
//!
//! A law says at all frequencies together what the data say at each: the fewer its parameters, the narrower its error bars, if it is the right law.
//! χ² per degree of freedom shows that, and BIC decides between laws.
//!
//! [`fit_modulus`] fits to a table of moduli, [`crate::identify::identify`] to what was measured on a structure.

mod correlated;
mod datum;
mod fit;
mod kind;
mod parametrization;
mod starts;

pub use correlated::Correlated;
pub use datum::Datum;
pub use fit::{Estimate, LawFit, ModulusEstimate, best, fit_modulus};
pub use kind::{LawKind, MAX_BRANCHES, Parameter, ParameterKind, USUAL_BRANCHES, UnknownLawKind};

pub(crate) use correlated::LineResidual;
pub(crate) use fit::Evidence;
pub(crate) use parametrization::Parametrization;
pub(crate) use starts::starts;
