//! Work shared out to threads.

use rayon::prelude::*;
use std::sync::{Mutex, PoisonError};

/// Room to work in that no thread uses at the moment.
pub(crate) struct Idle<B>(Mutex<Vec<B>>);

impl<B> Default for Idle<B> {
    fn default() -> Self {
        Self(Mutex::default())
    }
}

impl<B> Idle<B> {
    /// Works in what is idle, or in something new.
    pub(crate) fn lend<O>(&self, new: impl FnOnce() -> B, work: impl FnOnce(&mut B) -> O) -> O {
        let idle = || self.0.lock().unwrap_or_else(PoisonError::into_inner);
        // Not in a match: the lock would last as long.
        let found = idle().pop();
        let mut lent = found.unwrap_or_else(new);
        let out = work(&mut lent);
        idle().push(lent);
        out
    }
}

/// Runs with so many threads at hand: those of the caller's pool where it has as many, else new ones.
pub(crate) fn with<O: Send>(threads: usize, run: impl FnOnce() -> O + Send) -> O {
    if threads < 2 {
        return run();
    }
    if rayon::current_num_threads() == threads {
        return rayon::scope(|_| run());
    }
    match rayon::ThreadPoolBuilder::new().num_threads(threads).build() {
        Ok(pool) => pool.install(run),
        // The system has no more threads: this one is enough.
        Err(_) => run(),
    }
}

/// Applies a function to all items, each by whichever thread is free.
pub(crate) fn each<I: Send>(threads: usize, items: Vec<I>, work: impl Fn(I) + Sync + Send) {
    if threads < 2 || items.len() < 2 {
        items.into_iter().for_each(work);
    } else {
        items.into_par_iter().with_max_len(1).for_each(work);
    }
}

/// The same with results, in the order of the items.
pub(crate) fn map<I: Send, O: Send>(
    threads: usize,
    items: Vec<I>,
    work: impl Fn(I) -> O + Sync + Send,
) -> Vec<O> {
    if threads < 2 || items.len() < 2 {
        items.into_iter().map(work).collect()
    } else {
        items.into_par_iter().with_max_len(1).map(work).collect()
    }
}
