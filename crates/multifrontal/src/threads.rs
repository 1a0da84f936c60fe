//! Work shared out to threads.

use rayon::prelude::*;
use std::cell::Cell;
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

/// How long an idle thread looks out for work before it may sleep.
const IDLE_TIME: Duration = Duration::from_millis(1);

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

thread_local! {
    /// Whether this thread is in the middle of a piece of our work, or looks out for one already.
    static AT_WORK: Cell<bool> = const { Cell::new(false) };
}

/// Says of this thread that it is at work.
fn at_work<O>(work: impl FnOnce() -> O) -> O {
    struct Restore(bool);
    impl Drop for Restore {
        fn drop(&mut self) {
            AT_WORK.set(self.0);
        }
    }
    let _restore = Restore(AT_WORK.replace(true));
    work()
}

/// Works while the pool's idle threads look out for pieces of it: asleep they would take longer to wake than many
/// a piece takes, and the next call often follows at once.
///
/// Only threads that are in no other piece of our work look out, so that no work waits for one of them; and none for
/// longer than [`IDLE_TIME`] in vain.
pub(crate) fn awake<O>(threads: usize, work: impl FnOnce() -> O) -> O {
    if threads < 2 {
        return work();
    }
    let own = rayon::current_thread_index();
    rayon::spawn_broadcast(move |thread| {
        if Some(thread.index()) != own && !AT_WORK.get() {
            at_work(look_out);
        }
    });
    at_work(work)
}

/// Does whatever piece of work there is until there has been none for a while.
fn look_out() {
    let mut last = Instant::now();
    while last.elapsed() < IDLE_TIME {
        match rayon::yield_now() {
            Some(rayon::Yield::Executed) => last = Instant::now(),
            _ => std::hint::spin_loop(),
        }
    }
}

/// Runs with so many threads at hand: those of the caller's pool where it has as many, else new ones.
pub(crate) fn with<O: Send>(threads: usize, run: impl FnOnce() -> O + Send) -> O {
    if threads < 2 {
        return run();
    }
    let run = || awake(threads, run);
    if rayon::current_num_threads() == threads {
        return rayon::scope(|_| run());
    }
    match rayon::ThreadPoolBuilder::new().num_threads(threads).build() {
        Ok(pool) => pool.install(run),
        // The system has no more threads: this one is enough.
        Err(_) => run(),
    }
}

/// Two pieces of work, at the same time where there are threads for it.
pub(crate) fn both<A: Send, B: Send>(
    threads: usize,
    a: impl FnOnce() -> A + Send,
    b: impl FnOnce() -> B + Send,
) -> (A, B) {
    if threads < 2 { (a(), b()) } else { rayon::join(|| at_work(a), || at_work(b)) }
}

/// Applies a function to all items, each by whichever thread is free.
pub(crate) fn each<I: Send>(threads: usize, items: Vec<I>, work: impl Fn(I) + Sync + Send) {
    if threads < 2 || items.len() < 2 {
        items.into_iter().for_each(work);
    } else {
        items.into_par_iter().with_max_len(1).for_each(|item| at_work(|| work(item)));
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
        items.into_par_iter().with_max_len(1).map(|item| at_work(|| work(item))).collect()
    }
}
