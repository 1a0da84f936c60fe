//! Independent pieces of work, done in the order or on the threads of the caller's choice.

use std::sync::OnceLock;

/// Calls a function for 0 … n − 1, in any order, on any threads, and returns when all are done.
///
/// core starts no threads: who has a pool passes it in. [`sequential`] is the plain loop.
pub type ForEach<'a> = &'a (dyn Fn(usize, &(dyn Fn(usize) + Sync)) + Sync);

/// One after the other.
pub fn sequential(n: usize, each: &(dyn Fn(usize) + Sync)) {
    (0..n).for_each(each);
}

/// f(0) … f(n − 1), in order, whatever order they were computed in.
///
/// # Panics
/// Where `for_each` leaves one out.
pub fn map<T: Send + Sync>(for_each: ForEach<'_>, n: usize, f: impl Fn(usize) -> T + Sync) -> Vec<T> {
    let slots: Vec<OnceLock<T>> = (0..n).map(|_| OnceLock::new()).collect();
    for_each(n, &|i| drop(slots[i].set(f(i))));
    slots.into_iter().map(|slot| slot.into_inner().expect("every index was visited")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn order_is_kept_whatever_the_order_of_the_work() {
        let backwards = |n: usize, each: &(dyn Fn(usize) + Sync)| (0..n).rev().for_each(each);
        assert_eq!(map(&backwards, 4, |i| i * i), [0, 1, 4, 9]);
        assert_eq!(map(&sequential, 3, |i| i), [0, 1, 2]);
    }
}
