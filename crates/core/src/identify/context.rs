//! What the caller lends to a search, and what it hears on the way.

use crate::for_each::ForEach;

/// What is going on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Stage {
    /// The subspace is trained.
    Subspace,
    /// Solutions are searched.
    Solutions,
    /// One of them is chosen at each frequency.
    Selection,
    /// Laws, or a smooth curve, are fitted.
    Law,
}

/// What the caller lends: threads, and an ear for (stage, how many frequencies are done, of how many).
#[derive(Clone, Copy)]
pub struct Context<'a> {
    /// Does independent pieces of work.
    pub for_each: ForEach<'a>,
    /// Called from any thread.
    pub progress: &'a (dyn Fn(Stage, usize, usize) + Sync),
}
