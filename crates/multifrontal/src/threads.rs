//! Work shared out to threads.

use std::sync::{Mutex, PoisonError};

/// Applies a function to all items, each by whichever thread is free; results in the order of the items.
pub(crate) fn share<I: Sync, O: Send>(threads: usize, items: &[I], work: impl Fn(&I) -> O + Sync) -> Vec<O> {
    if threads < 2 || items.len() < 2 {
        return items.iter().map(work).collect();
    }
    let queue = Mutex::new(items.iter().enumerate());
    let take = || queue.lock().unwrap_or_else(PoisonError::into_inner).next();
    let run = || std::iter::from_fn(take).map(|(k, item)| (k, work(item))).collect::<Vec<_>>();
    let mut all = std::thread::scope(|scope| {
        let others: Vec<_> = (1..threads).map(|_| scope.spawn(run)).collect();
        let mut all = run();
        for other in others {
            // A panic of a thread is a panic of the caller.
            all.extend(other.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)));
        }
        all
    });
    all.sort_by_key(|&(k, _)| k);
    all.into_iter().map(|(_, output)| output).collect()
}
