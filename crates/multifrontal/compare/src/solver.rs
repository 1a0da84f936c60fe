//! The solvers by name, and what they need.

use crate::case::{Case, Number};
use crate::faer_solvers::{self, Symmetric};
use crate::ldlt;
use crate::mkl::{self, Mkl, trim_memory};
use crate::mumps::Mumps;
use crate::rivrs::{self, Order};
use crate::round::Round;
use frfit_bench::memory;
use memmap2::MmapMut;
use std::path::{Path, PathBuf};
use std::thread::sleep;
use std::time::Duration;

/// A solver.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Solver {
    /// MKL PARDISO: all others are compared with it.
    Pardiso,
    /// MUMPS.
    Mumps,
    /// multifrontal.
    Ldlt,
    /// rivrs-sparse.
    Rivrs(Order),
    /// One of faer's symmetric ones.
    Faer(Symmetric),
    /// faer's LU.
    FaerLu,
}

/// In the order in which they run.
pub const SOLVERS: [(&str, Solver); 9] = [
    ("multifrontal", Solver::Ldlt),
    ("pardiso", Solver::Pardiso),
    ("mumps", Solver::Mumps),
    ("rivrs", Solver::Rivrs(Order::MatchMetis)),
    ("rivrs-metis", Solver::Rivrs(Order::Metis)),
    ("faer-ldlt", Solver::Faer(Symmetric::Ldlt)),
    ("faer-lblt", Solver::Faer(Symmetric::Lblt)),
    ("faer-ldlt-amd", Solver::Faer(Symmetric::LdltMinimumDegree)),
    ("faer-lu", Solver::FaerLu),
];

/// faer's LU takes 5 GB and more for a solid of 50k equations, more than most machines have for one of 150k.
const LU_LIMIT: usize = 60_000;

/// Minimum degree takes four times the operations of dissection on a solid of 50k equations, and the more the larger it is.
const MINIMUM_DEGREE_LIMIT: usize = 60_000;

/// What solvers need that may not be there.
pub struct Installed {
    /// MKL, or why it is not there.
    pub mkl: Result<Mkl, String>,
    /// MUMPS, or why it is not there.
    pub mumps: Result<Mumps, String>,
}

impl Installed {
    /// MKL from the folder in FRFIT_MKL; MUMPS as compiled in `folder`.
    pub fn find(folder: &Path) -> Self {
        let place = std::env::var_os("FRFIT_MKL").map(PathBuf::from);
        let missing = "FRFIT_MKL does not name the folder of libmkl_rt.so and libiomp5.so \
            (python3 -m venv V && V/bin/pip install mkl; FRFIT_MKL=V/lib)";
        let mkl = place.as_deref().ok_or(missing.to_owned()).and_then(Mkl::load);
        let mumps = Mumps::compile(folder, place.as_deref().filter(|_| mkl.is_ok()));
        Self { mkl, mumps }
    }
}

impl Solver {
    /// Whether it takes these numbers, and as many equations in reasonable time and memory.
    pub fn takes<T: Number>(self, case: &Case<T>) -> bool {
        let real = T::real(&case.values).is_some();
        match self {
            Self::Ldlt | Self::Pardiso | Self::Mumps => true,
            Self::Faer(Symmetric::LdltMinimumDegree) => real && case.dim() < MINIMUM_DEGREE_LIMIT,
            Self::Rivrs(_) | Self::Faer(_) => real,
            Self::FaerLu => !real && case.dim() < LU_LIMIT,
        }
    }

    /// Whether what it needs is there.
    pub fn installed(self, installed: &Installed) -> bool {
        match self {
            Self::Pardiso => installed.mkl.is_ok(),
            Self::Mumps => installed.mumps.is_ok(),
            _ => true,
        }
    }

    /// One round, with the growth of resident memory, after so many bytes were [`warm`].
    ///
    /// # Errors
    /// What the solver says, or that it is not there.
    pub fn round<T: Number>(
        self,
        installed: &Installed,
        case: &Case<T>,
        threads: usize,
        room: usize,
    ) -> Result<Round<T>, String> {
        trim_memory();
        warm(room);
        memory::forget_peak();
        let before = memory::resident();
        let mut round = match self {
            Self::Pardiso => mkl::pardiso(installed.mkl.as_ref().map_err(String::clone)?, case, threads),
            Self::Mumps => installed.mumps.as_ref().map_err(String::clone)?.round(case, threads),
            Self::Ldlt => ldlt::round(case, threads),
            Self::Rivrs(order) => rivrs::round(order, case, threads),
            Self::Faer(kind) => faer_solvers::symmetric(kind, case, threads),
            Self::FaerLu => faer_solvers::lu(case, threads),
        }?;
        let growth =
            memory::peak().zip(before).map(|(peak, before)| peak.saturating_sub(before) as f64 / 1e6);
        round.peak = round.peak.or(growth);
        if threads > 1 {
            // OpenMP's threads spin for 200 ms after their work, in the next solver's time.
            sleep(Duration::from_millis(300));
        }
        Ok(round)
    }
}

/// Writes so many bytes and gives them back. The host of a virtual machine takes away what nobody has used for a second or two,
/// and whoever comes next waits for it: half of a second for 300 MB, that would be the first solver's in each round.
fn warm(bytes: usize) {
    if let Ok(mut memory) = MmapMut::map_anon(bytes.max(1)) {
        #[cfg(target_os = "linux")]
        let _ = memory.advise(memmap2::Advice::HugePage);
        memory.fill(1);
    }
}
