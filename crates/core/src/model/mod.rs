//! The dynamic stiffness as a sum of named terms, and what is unknown in it.

mod at;
mod experiment;
mod parameter;
mod stiffness;

pub use at::{Combination, ModelAt, ParameterAt, WeightedTerm};
pub use experiment::{Experiment, Sensor};
pub use parameter::{Member, Parameter};
pub use stiffness::{DynamicStiffness, FactorPart, FactorStd, ModelError, Role, Term};
