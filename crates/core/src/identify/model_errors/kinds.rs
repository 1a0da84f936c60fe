//! Kinds of errors that a search may have.

/// Errors that are searched beside those of stiffness, shapes and factors.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Kinds {
    pub(super) damping: Damping,
    pub(super) masses: bool,
}

/// Errors of damping that are searched.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Damping {
    None,
    /// What all modes have in common.
    Common,
    /// Of each mode too.
    Own,
}

impl Kinds {
    pub(super) const STIFFNESS: Self = Self { damping: Damping::None, masses: false };
    pub(super) const MASSES: Self = Self { masses: true, ..Self::STIFFNESS };
    pub(super) const ALL: Self = Self { damping: Damping::Own, masses: true };

    pub(super) fn with_masses(self) -> Self {
        Self { masses: true, ..self }
    }

    pub(super) fn with_common_damping(self) -> Self {
        Self { damping: Damping::Common, ..self }
    }

    pub(super) fn with_own_damping(self) -> Self {
        Self { damping: Damping::Own, ..self }
    }
}
