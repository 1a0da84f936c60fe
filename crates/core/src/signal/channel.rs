//! Which channel of a recording.

use std::fmt;

/// A channel of a recording.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Channel {
    /// The hammer.
    Force,
    /// A sensor, from 0.
    Response(usize),
}

impl fmt::Display for Channel {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Force => write!(f, "force"),
            Self::Response(k) => write!(f, "response {}", k + 1),
        }
    }
}
