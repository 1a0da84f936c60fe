//! D(ω) = Σ factor · stiffness + iω Σ factor · viscous − ω² Σ factor · mass, P-9.

use crate::c64;
use crate::frequency::omega_rad_s;
use crate::material::Law;
use frfit_linalg::solve::Analysis;
use frfit_linalg::sparse::{Pattern, SymmetricMatrix};
use std::fmt;

/// What a matrix multiplies: displacement, velocity or acceleration.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Role {
    /// Displacement: enters as it is.
    Stiffness,
    /// Velocity: enters with iω.
    Viscous,
    /// Acceleration: enters with −ω².
    Mass,
}

impl Role {
    /// 1, iω or −ω².
    pub fn weight(self, frequency_hz: f64) -> c64 {
        let omega = omega_rad_s(frequency_hz);
        match self {
            Self::Stiffness => c64::new(1.0, 0.0),
            Self::Viscous => c64::new(0.0, omega),
            Self::Mass => c64::new(-omega * omega, 0.0),
        }
    }
}

/// One term of the dynamic stiffness: a named matrix, its role, and the factor that multiplies it.
#[derive(Debug, Clone, PartialEq)]
pub struct Term {
    /// The name by which it is asked for.
    pub name: String,
    /// Stiffness, viscous or mass.
    pub role: Role,
    /// The matrix, with the factor (such as E or ρ) taken out.
    pub matrix: SymmetricMatrix,
    /// The factor, at its nominal value where it is unknown.
    pub factor: Law,
}

/// What is wrong with a set of terms.
#[derive(Debug, Clone, PartialEq)]
pub enum ModelError {
    /// There is no term.
    Empty,
    /// Two matrices differ in size.
    Sizes {
        /// Name and rows of the first matrix.
        first: (String, usize),
        /// Name and rows of one that differs.
        other: (String, usize),
    },
    /// Two terms have one name.
    DuplicateName(String),
    /// No term has this name; the names there are.
    UnknownName {
        /// The name that was asked for.
        asked: String,
        /// The names of all terms.
        known: Vec<String>,
    },
}

impl fmt::Display for ModelError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Empty => write!(f, "a model needs at least one matrix"),
            Self::Sizes { first: (a, rows_a), other: (b, rows_b) } => {
                write!(f, "matrix {b:?} has {rows_b} rows, but {a:?} has {rows_a}")
            }
            Self::DuplicateName(name) => write!(f, "two matrices are named {name:?}"),
            Self::UnknownName { asked, known } => {
                write!(f, "no matrix is named {asked:?}; there are {}", known.join(", "))
            }
        }
    }
}

impl std::error::Error for ModelError {}

/// A finite element model in the frequency domain: terms on one shared pattern, analysed once.
#[derive(Debug)]
pub struct DynamicStiffness {
    terms: Vec<Term>,
    analysis: Analysis,
    threads: usize,
}

impl DynamicStiffness {
    /// Brings all terms onto the union of their patterns and analyses it, once for all frequencies.
    ///
    /// # Errors
    /// [`ModelError`] for no terms, differing sizes or a name given twice.
    pub fn new(mut terms: Vec<Term>) -> Result<Self, ModelError> {
        let Some(first) = terms.first() else { return Err(ModelError::Empty) };
        let sized = |term: &Term| (term.name.clone(), term.matrix.dim());
        if let Some(other) = terms.iter().find(|term| term.matrix.dim() != first.matrix.dim()) {
            return Err(ModelError::Sizes { first: sized(first), other: sized(other) });
        }
        for (i, term) in terms.iter().enumerate() {
            if terms[..i].iter().any(|earlier| earlier.name == term.name) {
                return Err(ModelError::DuplicateName(term.name.clone()));
            }
        }
        let patterns: Vec<_> = terms.iter().map(|term| term.matrix.pattern()).collect();
        let union = Pattern::union(&patterns);
        let analysis = Analysis::new(&union);
        for term in &mut terms {
            term.matrix = term.matrix.on_pattern(&union);
        }
        Ok(Self { terms, analysis, threads: 1 })
    }

    /// The same with so many threads for one factorisation where nothing else is going on, those of the caller's pool where it has as many: a subspace's.
    /// Default 1; no number depends on it.
    #[must_use]
    pub fn with_threads(self, threads: usize) -> Self {
        Self { threads, ..self }
    }

    /// Threads for one factorisation where nothing else is going on.
    pub fn threads(&self) -> usize {
        self.threads
    }

    /// Number of degrees of freedom N.
    pub fn dim(&self) -> usize {
        self.analysis.dim()
    }

    /// All terms, on one pattern.
    pub fn terms(&self) -> &[Term] {
        &self.terms
    }

    /// The symbolic analysis of that pattern.
    pub fn analysis(&self) -> &Analysis {
        &self.analysis
    }

    /// Index of the term with this name.
    ///
    /// # Errors
    /// [`ModelError::UnknownName`] with the names there are.
    pub fn find(&self, name: &str) -> Result<usize, ModelError> {
        self.terms.iter().position(|term| term.name == name).ok_or_else(|| ModelError::UnknownName {
            asked: name.to_owned(),
            known: self.terms.iter().map(|term| term.name.clone()).collect(),
        })
    }
}
