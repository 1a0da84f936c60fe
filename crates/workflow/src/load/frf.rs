//! A frequency response function from a file of either kind.

use frfit::c64;
use frfit::dof::DofName;
use frfit::quantity::Quantity;

/// A measured frequency response function, and what its file says about it.
#[derive(Debug, Clone, PartialEq)]
pub struct Frf {
    /// Frequencies in hertz, not negative, strictly ascending; at least one.
    pub frequency_hz: Vec<f64>,
    /// The complex values, in the quantity of the file, in SI units where the file says its units.
    pub response: Vec<c64>,
    /// Coherence γ² of each value.
    pub coherence: Option<Vec<f64>>,
    /// Standard deviation √E|δH|² of each complex value.
    pub std: Option<Vec<f64>>,
    /// What was measured, where the file says.
    pub quantity: Option<Quantity>,
    /// Where and in which direction it was measured, where the file says.
    pub measured_at: Option<DofName>,
    /// Where and in which direction it was driven, where the file says.
    pub driven_at: Option<DofName>,
    /// The decay rate α in 1/s of an exponential window e^{−αt} on force and response, where the file says: the line `decay_per_s = 6` among the ID lines of a UFF
    /// function, or `# decay_per_s = 6` in a table, as `frfit frf` writes them.
    pub decay_per_s: Option<f64>,
}

/// The line that says so.
pub(crate) fn decay_line(decay_per_s: f64) -> String {
    format!("decay_per_s = {decay_per_s}")
}

/// Which of several FRFs of a file.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Choice {
    /// Its number among the FRFs of the file, from 1.
    pub record: Option<i64>,
    /// The degree of freedom that was measured.
    pub measured_at: Option<DofName>,
    /// The degree of freedom that was driven.
    pub driven_at: Option<DofName>,
    /// Names of the columns of a table, in place of its own; `-` for one that is not read.
    pub columns: Option<Vec<String>>,
}
