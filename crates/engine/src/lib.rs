//! Factors by MUMPS, in processes of its own: on this machine, or on the machines of an MPI job.
//!
//! | file | what is in it |
//! |---|---|
//! | `launch.rs` | the command that starts the ranks, and what can be wrong with it |
//! | `job.rs` | the process that holds the ranks, and its words |
//! | `connection.rs` | the socket to rank 0, watched with that process |
//! | `protocol.rs` | requests and outcomes, byte by byte |
//! | `factor.rs` | an engine of [`frfit_linalg`] made of them |
//!
//! The ranks run `frfit-mumps`, a program in C that is built apart (`engines/mumps` of the repository): this crate needs
//! neither MPI nor MUMPS, and has no `unsafe`.
//! A rank that dies ends its job; every request that waits then fails with the words of that job, and so does every later one.
//!
//! # Source
//! P. R. Amestoy, I. S. Duff, J. Koster, J.-Y. L'Excellent, SIAM J. Matrix Anal. Appl. 23 (2001) 15–41.

mod connection;
mod factor;
mod job;
mod launch;
mod protocol;

pub use launch::{Launch, StartError};
pub use protocol::RankUsage;

use connection::Connection;
use frfit_linalg::solve::Breakdown;
use std::sync::{Arc, Mutex, PoisonError};

/// MUMPS on the ranks of an MPI job. The job ends with the last clone, analysis and factor of it.
#[derive(Debug, Clone)]
pub struct Mumps {
    shared: Arc<Shared>,
}

#[derive(Debug)]
struct Shared {
    connection: Mutex<Connection>,
    ranks: usize,
    version: String,
}

impl Shared {
    fn with<R>(&self, work: impl FnOnce(&mut Connection) -> Result<R, Breakdown>) -> Result<R, Breakdown> {
        // A thread that panicked has broken its own request off; the connection knows whether it is still whole.
        work(&mut self.connection.lock().unwrap_or_else(PoisonError::into_inner))
    }
}

impl Mumps {
    /// Starts the ranks and waits for their greeting.
    ///
    /// # Errors
    /// [`StartError`] where the command cannot be run, ends before it has called, or speaks another version.
    pub fn start(launch: &Launch) -> Result<Self, StartError> {
        let (connection, greeting) = launch.start()?;
        let (ranks, version) = (greeting.ranks, greeting.version);
        Ok(Self { shared: Arc::new(Shared { connection: Mutex::new(connection), ranks, version }) })
    }

    /// How many ranks there are.
    pub fn ranks(&self) -> usize {
        self.shared.ranks
    }

    /// The version of MUMPS.
    pub fn version(&self) -> &str {
        &self.shared.version
    }

    /// Peak memory and CPU time of each rank so far.
    ///
    /// # Errors
    /// [`Breakdown::Engine`] where the job has ended.
    pub fn usage(&self) -> Result<Vec<RankUsage>, Breakdown> {
        self.shared.with(|connection| connection.usage(self.ranks()))
    }
}

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
