//! Some of many.

/// At most so many of some things, evenly spaced, the ends among them.
pub(crate) fn thinned<T>(all: &[T], most: usize) -> impl Iterator<Item = &T> {
    let count = all.len().min(most);
    (0..count).map(move |k| &all[k * (all.len() - 1) / (count - 1).max(1)])
}
