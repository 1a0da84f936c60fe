//! Work shared out to threads.

use rayon::prelude::*;
use std::cell::Cell;
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

/// Which threads work. The numbers do not depend on it.
///
/// Small analyses, factorisations and solutions stay on the calling thread, whatever is asked for: another thread would
/// cost more than it brings.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum Threads {
    /// The calling thread alone.
    #[default]
    One,
    /// Those of the rayon pool in which the call is made: the pool of `rayon::ThreadPool::install`, or else rayon's
    /// global one. No pool is built here.
    Pool,
    /// As [`Threads::Pool`]; its idle threads look for work that long before they sleep.
    ///
    /// They take processor time meanwhile. It pays where one call follows the other and nothing else waits for these
    /// processors: to wake a thread takes longer than many a piece of work. A millisecond is enough.
    Spinning(Duration),
}

/// How many threads share a piece of work, and how long the idle ones of them stay awake.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Team {
    pub(crate) size: usize,
    spin: Duration,
}

impl Threads {
    /// The calling thread alone where the work is not worth more.
    pub(crate) fn if_worth(self, is_worth: bool) -> Self {
        if is_worth { self } else { Self::One }
    }

    /// Runs in the pool, with whoever is there.
    pub(crate) fn run<O: Send>(self, run: impl FnOnce(Team) -> O + Send) -> O {
        let spin = match self {
            Self::One => return run(Team::ONE),
            Self::Pool => Duration::ZERO,
            Self::Spinning(spin) => spin,
        };
        let team = Team { size: rayon::current_num_threads(), spin };
        if team.size < 2 {
            return run(Team::ONE);
        }
        // On a thread of the pool, wherever the call comes from.
        rayon::scope(|_| team.awake(|| run(team)))
    }
}

impl Team {
    /// The calling thread.
    const ONE: Self = Self { size: 1, spin: Duration::ZERO };

    /// Works while the pool's idle threads look out for pieces of it, where that is asked for: asleep they would take
    /// longer to wake than many a piece takes, and the next call often follows at once.
    ///
    /// Only threads that are in no other piece of our work look out, so that no work waits for one of them.
    pub(crate) fn awake<O>(self, work: impl FnOnce() -> O) -> O {
        if self.size < 2 || self.spin.is_zero() {
            return work();
        }
        let own = rayon::current_thread_index();
        rayon::spawn_broadcast(move |thread| {
            if Some(thread.index()) != own && !AT_WORK.get() {
                at_work(|| look_out(self.spin));
            }
        });
        at_work(work)
    }
}

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

/// Does whatever piece of work there is until there has been none for a while.
fn look_out(spin: Duration) {
    let mut last = Instant::now();
    while last.elapsed() < spin {
        match rayon::yield_now() {
            Some(rayon::Yield::Executed) => last = Instant::now(),
            _ => std::hint::spin_loop(),
        }
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
