//! Whether a model fits into memory, estimated before any of it is factorised.

use crate::load::Case;
use frfit::subspace::MAX_COUNTED_DOFS;
use frfit_linalg::c64;
use frfit_linalg::solve::{Analysis, Breakdown, FactorMemory};
use std::fmt;
use std::sync::Arc;

/// Vectors of a subspace to reckon with, beside the one factor that it has at a time.
const VECTORS: usize = 256;

/// A model that would not fit.
#[derive(Debug, Clone, PartialEq)]
pub struct MemoryError {
    /// Degrees of freedom.
    pub dofs: usize,
    /// Bytes that the computation would take; `None` where even the structure of the factor does not fit.
    pub needed: Option<u64>,
    /// Bytes that there are, or that the user allows.
    pub available: u64,
    /// What takes them.
    pub what: String,
    /// Why an engine elsewhere cannot hold a factor, where it is that.
    pub engine: Option<String>,
}

impl fmt::Display for MemoryError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(words) = &self.engine {
            return write!(f, "a model of {} degrees of freedom: {words}", self.dofs);
        }
        let needed = self.needed.map_or("more than can be counted".into(), bytes);
        write!(
            f,
            "a model of {} degrees of freedom: expected {} of memory for {}, found {} (--memory sets how much may be used)",
            self.dofs,
            needed,
            self.what,
            bytes(self.available)
        )
    }
}

impl std::error::Error for MemoryError {}

fn bytes(count: u64) -> String {
    const UNITS: [&str; 5] = ["B", "kB", "MB", "GB", "TB"];
    let mut value = count as f64;
    let mut unit = 0;
    while value >= 1000.0 && unit + 1 < UNITS.len() {
        value /= 1000.0;
        unit += 1;
    }
    format!("{value:.3} {}", UNITS[unit])
}

/// Sees that an identification fits into `limit` bytes, or without one into what the system says is available: with factors in double precision, or else in
/// single precision.
///
/// # Errors
/// [`MemoryError`] with the numbers, where neither fits.
///
/// # Limits
/// An estimate: exact for the real factors, an experience for the complex ones. Where the system does not say what is available, everything fits.
pub fn fit_identify(case: &mut Case, limit: Option<u64>) -> Result<(), MemoryError> {
    let Some(identify) = &case.identify else { return Ok(()) };
    let dofs = case.model.dim();
    let options = &identify.options;
    let reduced = options.reduction.is_subspace(options.method, dofs, identify.frequency_hz.len());
    let factors = if dofs > MAX_COUNTED_DOFS { 1 } else { 2 };
    if reduced || !identify.is_single() { fit_subspace(case, factors, limit) } else { fit_full(case, limit) }
}

/// The same for the subspace of a band, with so many factors at a time.
///
/// # Errors
/// [`MemoryError`] with the numbers.
pub fn fit_subspace(case: &mut Case, factors: usize, limit: Option<u64>) -> Result<(), MemoryError> {
    fit(case, |analysis| check(analysis, factors, limit))
}

/// The same for a computation on the full model: a complex factor a thread.
///
/// # Errors
/// [`MemoryError`] with the numbers.
pub fn fit_full(case: &mut Case, limit: Option<u64>) -> Result<(), MemoryError> {
    // The nominal factor and that of the check, in each thread.
    let factors = 2 * rayon::current_num_threads();
    let what = format!("{factors} complex factors");
    fit(case, |analysis| refuse(analysis, analysis.factor_memory::<c64>(), factors, 0, what.clone(), limit))
}

/// Refuses a subspace with so many factors in double precision at a time.
///
/// # Errors
/// [`MemoryError`] with the numbers.
pub fn check_subspace(case: &Case, factors: usize, limit: Option<u64>) -> Result<(), MemoryError> {
    check(case.model.analysis(), factors, limit)
}

/// Takes factors in single precision where those in double do not fit.
fn fit(case: &mut Case, check: impl Fn(&Analysis) -> Result<(), MemoryError>) -> Result<(), MemoryError> {
    let Err(error) = check(case.model.analysis()) else { return Ok(()) };
    let fits = |single: &Analysis| check(single).is_ok();
    if case.model.analysis().in_single_precision().as_ref().is_some_and(fits) {
        Arc::make_mut(&mut case.model).use_single_precision();
        return Ok(());
    }
    Err(error)
}

fn check(analysis: &Analysis, factors: usize, limit: Option<u64>) -> Result<(), MemoryError> {
    let basis = 8 * analysis.dim() * VECTORS;
    let what = match factors {
        1 => format!("one real factor and {VECTORS} vectors"),
        _ => format!("{factors} real factors and {VECTORS} vectors"),
    };
    refuse(analysis, analysis.factor_memory::<f64>(), factors, basis, what, limit)
}

fn refuse(
    analysis: &Analysis,
    factor: Result<FactorMemory, Breakdown>,
    count: usize,
    beside: usize,
    what: String,
    limit: Option<u64>,
) -> Result<(), MemoryError> {
    let dofs = analysis.dim();
    if let Err(Breakdown::Engine(words)) = factor {
        return Err(MemoryError { dofs, needed: None, available: 0, what, engine: Some(words) });
    }
    let Some(available) = limit.or_else(available) else { return Ok(()) };
    let needed = factor.ok().map(|FactorMemory { kept, scratch }| {
        let all = kept.saturating_mul(count).saturating_add(scratch).saturating_add(beside);
        u64::try_from(all).unwrap_or(u64::MAX)
    });
    match needed {
        Some(needed) if needed <= available => Ok(()),
        _ => Err(MemoryError { dofs, needed, available, what, engine: None }),
    }
}

/// What the system can give without swapping: `MemAvailable` of Linux; `None` elsewhere.
fn available() -> Option<u64> {
    let text = std::fs::read_to_string("/proc/meminfo").ok()?;
    let line = text.lines().find_map(|line| line.strip_prefix("MemAvailable:"))?;
    let kilobytes: u64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(kilobytes * 1024)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_units_that_are_read() {
        assert_eq!([bytes(999), bytes(1000), bytes(12_345_678)], ["999.000 B", "1.000 kB", "12.346 MB"]);
    }

    #[test]
    #[cfg(target_os = "linux")]
    fn the_system_says_how_much_there_is() {
        assert!(available().unwrap() > 1_000_000);
    }
}
