//! The threads that do the work.
//!
//! rayon's own pool is one for the life of a process. A child that a process forks (`multiprocessing` does on Linux)
//! inherits its memory and none of its threads, and would wait for them for ever. So each call works in a pool that
//! belongs to its process.

use crate::errors::no_thread;
use frfit_workflow::run::STACK_BYTES;
use pyo3::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};
use std::sync::{Mutex, PoisonError};

/// A pool that no call uses, and the process that its threads are in.
///
/// Locked by none but those who hold the GIL, which a thread that forks holds too: no child inherits it locked.
static IDLE: Mutex<Option<(u32, ThreadPool)>> = Mutex::new(None);

/// A pool of this process that no other call uses: calls at the same time do not wait in each other's work.
///
/// # Errors
/// The system gives no threads.
pub(crate) fn take(_: Python<'_>) -> PyResult<ThreadPool> {
    let idle = IDLE.lock().unwrap_or_else(PoisonError::into_inner).take();
    match idle {
        Some((process, pool)) if process == std::process::id() => return Ok(pool),
        // Its threads are in the parent: what would stop them would wait for them.
        Some(inherited) => std::mem::forget(inherited),
        None => {}
    }
    let name = |thread| format!("frfit {thread}");
    let pool = ThreadPoolBuilder::new().thread_name(name).stack_size(STACK_BYTES).build();
    pool.map_err(|error| no_thread(&error))
}

/// Keeps a pool for the next call.
pub(crate) fn give_back(_: Python<'_>, pool: ThreadPool) {
    let mut idle = IDLE.lock().unwrap_or_else(PoisonError::into_inner);
    *idle = Some((std::process::id(), pool));
}
