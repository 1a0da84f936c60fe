//! Long work beside the interpreter: the GIL is free meanwhile, Ctrl-C is heard, progress is reported.
//!
//! The work is on a thread of its own, since only the interpreter's own thread hears signals, and that has to be free to answer
//! at once however long a factorisation takes. A cancelled work ends at its next frequency; until then it may use
//! a processor, but the caller does not wait for it.

use crate::errors::{internal, no_thread};
use crate::pool;
use pyo3::prelude::*;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc::{self, Receiver, RecvTimeoutError};
use std::thread;
use std::time::Duration;

/// How often signals and progress are looked after: a twentieth of the second that Ctrl-C may take.
const BEAT: Duration = Duration::from_millis(50);

/// How long a cancelled work is given to end before it is left to itself.
const GRACE: Duration = Duration::from_millis(400);

/// What both threads see of the work.
#[derive(Default)]
pub(crate) struct Watch {
    done: AtomicUsize,
    total: AtomicUsize,
    cancelled: AtomicBool,
}

/// What a cancelled work unwinds with.
struct Cancelled;

impl Watch {
    /// Called by the work from any of its threads; does not return where it was cancelled.
    pub(crate) fn progress(&self, done: usize, total: usize) {
        self.done.store(done, Ordering::Relaxed);
        self.total.store(total, Ordering::Relaxed);
        if self.cancelled.load(Ordering::Relaxed) {
            // Core knows no cancellation: it unwinds, through rayon too, and every lock of ours outlives that.
            resume_unwind(Box::new(Cancelled));
        }
    }

    fn seen(&self) -> (usize, usize) {
        (self.done.load(Ordering::Relaxed), self.total.load(Ordering::Relaxed))
    }
}

/// Does the work on another thread and waits for it, calling `progress(done, total)` in between.
///
/// # Errors
/// What a signal handler (`KeyboardInterrupt`) or the callback raises; an internal error where the work panics.
pub(crate) fn in_background<T: Send + 'static>(
    py: Python<'_>,
    progress: Option<Bound<'_, PyAny>>,
    work: impl FnOnce(&Watch) -> T + Send + 'static,
) -> PyResult<T> {
    let watch = Arc::new(Watch::default());
    let (send, mut receive) = mpsc::channel();
    let its = Arc::clone(&watch);
    let pool = pool::take(py)?;
    let run = move || {
        let done = catch_unwind(AssertUnwindSafe(|| pool.install(|| work(&its))));
        // The receiver is gone where the work was left to itself.
        let _ = send.send((done, pool));
    };
    let builder = thread::Builder::new().name("frfit".into());
    builder.spawn(run).map_err(|error| no_thread(&error))?;
    let mut reported = (0, 0);
    loop {
        let got = wait(py, &mut receive, BEAT);
        let seen = watch.seen();
        let mut answer = py.check_signals();
        if let (Ok(()), Some(progress), true) = (&answer, &progress, seen != reported && seen.1 > 0) {
            reported = seen;
            answer = progress.call1(seen).map(drop);
        }
        if let Err(raised) = answer {
            watch.cancelled.store(true, Ordering::Relaxed);
            if got.is_err() {
                let _ = wait(py, &mut receive, GRACE);
            }
            return Err(raised);
        }
        match got {
            Ok((done, pool)) => {
                pool::give_back(py, pool);
                return done.map_err(|_| internal(py));
            }
            Err(RecvTimeoutError::Timeout) => {}
            Err(RecvTimeoutError::Disconnected) => return Err(internal(py)),
        }
    }
}

fn wait<T: Send>(py: Python<'_>, receive: &mut Receiver<T>, time: Duration) -> Result<T, RecvTimeoutError> {
    py.detach(move || receive.recv_timeout(time))
}

/// Does short work here, the GIL free meanwhile.
///
/// # Errors
/// An internal error where the work panics.
pub(crate) fn at_once<T: Send>(py: Python<'_>, work: impl FnOnce() -> T + Send) -> PyResult<T> {
    py.detach(|| catch_unwind(AssertUnwindSafe(work))).map_err(|_| internal(py))
}
