//! MUMPS as an engine of [`frfit_linalg`].

use crate::protocol::{Named, Request, Verb};
use crate::{Mumps, Shared};
use frfit_linalg::c64;
use frfit_linalg::solve::{
    Analysis, Breakdown, DENSE_LIMIT, Engine, Factor, FactorMemory, Multifrontal, Symbolic, elimination_order,
};
use frfit_linalg::sparse::Pattern;
use std::sync::{Arc, OnceLock};

impl Engine for Mumps {
    /// Patterns of at most [`DENSE_LIMIT`] unknowns stay in this process: a request costs more than their factor.
    fn analyse(&self, pattern: &Arc<Pattern>) -> Analysis {
        if pattern.dim() <= DENSE_LIMIT {
            return Multifrontal.analyse(pattern);
        }
        let shared = Arc::clone(&self.shared);
        let sent = Arc::new(Sent { pattern: Arc::clone(pattern), shared, name: OnceLock::new() });
        let name = format!("mumps {}, ranks: {}", self.version(), self.ranks());
        Analysis::of_engine(name, pattern, Arc::new(OfPattern(Arc::clone(&sent))), Arc::new(OfPattern(sent)))
    }
}

/// A pattern that the ranks have, or will get with the first question about it.
struct Sent {
    pattern: Arc<Pattern>,
    shared: Arc<Shared>,
    name: OnceLock<Result<u32, Breakdown>>,
}

impl Sent {
    fn name(&self) -> Result<u32, Breakdown> {
        self.name.get_or_init(|| self.send()).clone()
    }

    fn send(&self) -> Result<u32, Breakdown> {
        let (n, entries) = (self.pattern.dim(), self.pattern.stored());
        let mut position = vec![0; n];
        for (place, row) in (1..).zip(elimination_order(&self.pattern)?) {
            position[row as usize] = place;
        }
        // Both fit: an order exists only where rows and entries are numbered in 32 bits.
        let one_based = |index: usize| index as u32 + 1;
        self.shared.with(|connection| {
            let name = connection.name();
            let request = Request { pattern: name, size: n, entries, ..Request::new(Verb::Pattern) };
            let mut positions = position.into_iter();
            let mut rows = self.pattern.row_idx().iter().map(|&row| one_based(row));
            let mut columns = self.pattern.positions().map(|(_, column)| one_based(column));
            connection.pattern(request, [&mut positions, &mut rows, &mut columns])?;
            Ok(name)
        })
    }
}

impl Drop for Sent {
    fn drop(&mut self) {
        if let Some(Ok(pattern)) = self.name.get() {
            let request = Request { pattern: *pattern, ..Request::new(Verb::ForgetPattern) };
            let _ = self.shared.with(|connection| connection.forget(request)); // an ended job has forgotten it
        }
    }
}

/// What the ranks know of a pattern.
struct OfPattern(Arc<Sent>);

impl OfPattern {
    fn factor<T: Named>(&self, values: &[T]) -> Result<OfRanks, Breakdown> {
        let pattern = self.0.name()?;
        self.0.shared.with(|connection| {
            let name = connection.name();
            let request = Request { scalar: T::SCALAR, pattern, factor: name, ..Request::new(Verb::Factor) };
            match connection.factor(request, values) {
                Ok(outcome) => {
                    let negative = usize::try_from(outcome.negative).ok();
                    Ok(OfRanks { of: Arc::clone(&self.0), name, negative })
                }
                Err(breakdown) => {
                    // The solver that tried it is free for the next one.
                    connection.forget(Request { factor: name, ..Request::new(Verb::ForgetFactor) })?;
                    Err(breakdown)
                }
            }
        })
    }

    fn memory<T: Named>(&self) -> Result<FactorMemory, Breakdown> {
        let pattern = self.0.name()?;
        let request = Request { scalar: T::SCALAR, pattern, ..Request::new(Verb::Forecast) };
        let (needed, available) = self.0.shared.with(|connection| connection.forecast(request))?;
        if available >= 0 && needed.bytes > available {
            let gigabytes = |bytes: i64| bytes as f64 / 1e9;
            return Err(Breakdown::Engine(format!(
                "mumps: a factor needs {:.1} GB on one of the machines, and {:.1} GB are free there",
                gigabytes(needed.bytes),
                gigabytes(available)
            )));
        }
        Ok(FactorMemory { kept: 0, scratch: 0 }) // in this process
    }
}

impl Symbolic<f64> for OfPattern {
    fn factor(&self, values: &[f64], _threads: usize) -> Result<Box<dyn Factor<f64>>, Breakdown> {
        Ok(Box::new(self.factor(values)?))
    }

    fn memory(&self) -> Result<FactorMemory, Breakdown> {
        self.memory::<f64>()
    }
}

impl Symbolic<c64> for OfPattern {
    fn factor(&self, values: &[c64], _threads: usize) -> Result<Box<dyn Factor<c64>>, Breakdown> {
        Ok(Box::new(self.factor(values)?))
    }

    fn memory(&self) -> Result<FactorMemory, Breakdown> {
        self.memory::<c64>()
    }
}

/// A factor that the ranks hold.
struct OfRanks {
    of: Arc<Sent>,
    name: u32,
    negative: Option<usize>,
}

impl<T: Named> Factor<T> for OfRanks {
    fn solve_in_place(&self, rhs: &mut [T], _threads: usize) -> Result<(), Breakdown> {
        let size = rhs.len() / self.of.pattern.dim();
        let request = Request { factor: self.name, size, ..Request::new(Verb::Solve) };
        self.of.shared.with(|connection| connection.solve(request, rhs))
    }

    fn negative_eigenvalues(&self) -> Option<usize> {
        self.negative
    }
}

impl Drop for OfRanks {
    fn drop(&mut self) {
        let request = Request { factor: self.name, ..Request::new(Verb::ForgetFactor) };
        let _ = self.of.shared.with(|connection| connection.forget(request)); // an ended job has forgotten it
    }
}
