//! D(ω) = Σ factor · stiffness + s Σ factor · viscous + s² Σ factor · mass with s = iω + α, P-9: the time convention is e^{+iωt}.

use crate::c64;
use crate::frequency::{laplace_per_s, squared};
use crate::material::{Law, OutsideTable};
use frfit_linalg::solve::{Analysis, Engine, Multifrontal};
use frfit_linalg::sparse::{Pattern, SymmetricMatrix};
use std::fmt;

/// What a matrix multiplies: displacement, velocity or acceleration.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Role {
    /// Displacement: enters as it is.
    Stiffness,
    /// Velocity: enters with s = iω + α.
    Viscous,
    /// Acceleration: enters with s², without a window −ω².
    Mass,
}

impl Role {
    /// 1, s or s² with s = iω + α = i(ω − iα): without the decay α (1/s) of a window 1, iω or −ω².
    pub fn weight(self, frequency_hz: f64, decay_per_s: f64) -> c64 {
        let s = laplace_per_s(frequency_hz, decay_per_s);
        match self {
            Self::Stiffness => c64::new(1.0, 0.0),
            Self::Viscous => s,
            Self::Mass => squared(s),
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
    /// The matrix, divided by its factor (such as E or ρ).
    pub matrix: SymmetricMatrix,
    /// The factor, at its nominal value where it is unknown.
    pub factor: Law,
}

/// What is wrong with a set of terms.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
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
#[derive(Debug, Clone)]
pub struct DynamicStiffness {
    terms: Vec<Term>,
    analysis: Analysis,
    threads: usize,
    decay_per_s: f64,
    /// One for each term.
    factor_std: Vec<FactorStd>,
}

/// How well the factor of a term is known: standard deviations; `None` where nothing is said.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct FactorStd {
    /// Relative, of the storage part, or of a real factor.
    pub storage: Option<f64>,
    /// Absolute, of the loss factor.
    pub loss_factor: Option<f64>,
}

/// A part of a factor.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FactorPart {
    /// The storage part, or a real factor.
    Storage,
    /// The loss factor.
    LossFactor,
}

impl DynamicStiffness {
    /// Brings all terms onto the union of their patterns and analyses it, once for all frequencies.
    ///
    /// # Errors
    /// [`ModelError`] for no terms, differing sizes or a name given twice.
    pub fn new(terms: Vec<Term>) -> Result<Self, ModelError> {
        Self::with_engine(terms, &Multifrontal)
    }

    /// The same with another engine for its factors.
    ///
    /// # Errors
    /// As [`DynamicStiffness::new`]. What the engine itself has to say comes with the first factorisation.
    pub fn with_engine(mut terms: Vec<Term>, engine: &dyn Engine) -> Result<Self, ModelError> {
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
        let analysis = engine.analyse(&union);
        for term in &mut terms {
            term.matrix = term.matrix.on_pattern(&union);
        }
        let factor_std = vec![FactorStd::default(); terms.len()];
        Ok(Self { terms, analysis, threads: 1, decay_per_s: 0.0, factor_std })
    }

    /// The same with so many threads for one factorisation where nothing else is going on, those of the caller's pool where it has as many: a subspace's.
    /// Default 1; no number depends on it.
    #[must_use]
    pub fn with_threads(self, threads: usize) -> Self {
        Self { threads, ..self }
    }

    /// The same as seen through an exponential window e^{−αt} on force and response, α in 1/s (its time constant τ is 1/α). Default 0: no window.
    ///
    /// A window e^{−αt} shifts the Laplace transforms of both, so that their quotient is the response at s = iω + α, at the complex frequency ω − iα:
    /// $$ D_w(\omega) = K(\omega) + (i\omega + \alpha) C + (i\omega + \alpha)^2 M = K(\omega) + i(\omega - i\alpha) C - (\omega - i\alpha)^2 M. $$
    /// Everything that asks this model has it from here: full and reduced responses, derivatives, identification and diagnostics.
    ///
    /// Factors have their values at s too ([`Law::at_laplace`]). What is identified is given at iω: its loss factor is larger than that at s by the share (2/π)α/ω, 0.6 % at 100 Hz
    /// and 6/s.
    ///
    /// # Limits
    /// Exact in mass and viscous terms and where a factor is a law. A factor that is known at iω alone (a constant, a table, a value at each frequency, a smooth curve) is a power law in
    /// the neighbourhood of each frequency.
    #[must_use]
    pub fn with_decay_per_s(self, decay_per_s: f64) -> Self {
        Self { decay_per_s, ..self }
    }

    /// The decay α of a window on force and response, 1/s; 0 without one.
    pub fn decay_per_s(&self) -> f64 {
        self.decay_per_s
    }

    /// The same with what is known of the factor of a term: a known one has that in the error bars of every unknown (B-11). Default: nothing.
    ///
    /// # Panics
    /// Where there is no such term.
    #[must_use]
    pub fn with_factor_std(mut self, term: usize, std: FactorStd) -> Self {
        self.factor_std[term] = std;
        self
    }

    /// The same with another factor of a term; matrices and their analysis are shared.
    ///
    /// # Panics
    /// Where there is no such term.
    #[must_use]
    pub fn with_factor(mut self, term: usize, factor: Law) -> Self {
        self.terms[term].factor = factor;
        self
    }

    /// How well the factor of a term is known.
    pub fn factor_std(&self, term: usize) -> FactorStd {
        self.factor_std[term]
    }

    /// Whether the accuracy of some factor is known.
    pub(crate) fn has_factor_std(&self) -> bool {
        self.factor_std.iter().any(|std| *std != FactorStd::default())
    }

    /// What a matrix of this role is multiplied by: [`Role::weight`] with the decay of this model.
    pub fn weight(&self, role: Role, frequency_hz: f64) -> c64 {
        role.weight(frequency_hz, self.decay_per_s)
    }

    /// The factor of a term at a frequency, with the decay of this model.
    ///
    /// # Errors
    /// [`OutsideTable`] where a table does not reach this frequency.
    pub fn factor(&self, term: usize, frequency_hz: f64) -> Result<c64, OutsideTable> {
        self.terms[term].factor.at_laplace(frequency_hz, self.decay_per_s)
    }

    /// Takes factors in single precision from now on, where the engine has them: half of the memory, and solutions as accurate by more refinement
    /// ([`Analysis::in_single_precision`]).
    ///
    /// # Limits
    /// Solutions take some ten times as long. A structure on no support, far below its first resonance, is singular to single precision.
    pub fn use_single_precision(&mut self) {
        if let Some(single) = self.analysis.in_single_precision() {
            self.analysis = single;
        }
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
