//! How an end or an edge is held.

/// How an end of a bar or beam, or an edge of a plate, is held.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Support {
    /// Moves freely.
    #[default]
    Free,
    /// Cannot be displaced, turns freely. On a plate: simply supported.
    Pinned,
    /// Neither displaced nor turned.
    Clamped,
}
