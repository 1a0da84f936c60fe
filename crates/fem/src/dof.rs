//! Names of the degrees of freedom.

use std::fmt;

/// What moves at a node: a translation along an axis, a right-handed rotation about it, the twist of a plate, or its transverse shear.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Direction {
    /// Translation along x, in m.
    X,
    /// Translation along y, in m.
    Y,
    /// Translation along z, in m.
    Z,
    /// Rotation about x, in rad.
    RX,
    /// Rotation about y, in rad.
    RY,
    /// Rotation about z, in rad.
    RZ,
    /// ∂²w/∂x∂y of a plate's deflection w, in 1/m: neither a displacement nor a rotation, and without a name in a table of dofs.
    Twist,
    /// Transverse shear strain γ_xz = ∂w/∂x + RY of a thick plate: without a name in a table of dofs, as the twist.
    ShearX,
    /// Transverse shear strain γ_yz = ∂w/∂y − RX of a thick plate.
    ShearY,
}

impl Direction {
    /// The name as it stands in a table of dofs.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::X => "X",
            Self::Y => "Y",
            Self::Z => "Z",
            Self::RX => "RX",
            Self::RY => "RY",
            Self::RZ => "RZ",
            Self::Twist => "TWIST",
            Self::ShearX => "SHEARX",
            Self::ShearY => "SHEARY",
        }
    }
}

impl fmt::Display for Direction {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.as_str())
    }
}

/// The degree of freedom of one row of the matrices.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Dof {
    /// Label of the node, counted from 1.
    pub node: usize,
    /// What moves there.
    pub direction: Direction,
}
