//! The matrices of one element, and which of its mass matrices to use.

/// The matrices of one element with N dofs, node after node, for E = 1 and ρ = 1.
#[derive(Debug, Clone, PartialEq)]
pub struct Element<const N: usize> {
    /// Stiffness, N × N.
    pub stiffness: [[f64; N]; N],
    /// Consistent mass ∫ Nᵀ N dV, N × N.
    pub mass: [[f64; N]; N],
    /// Diagonal of the lumped mass: translations only, rotations carry none.
    pub lumped: [f64; N],
}

/// Which mass matrix.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Mass {
    /// Of the same shape functions as the stiffness; natural frequencies come from above in conforming elements.
    #[default]
    Consistent,
    /// Diagonal; singular where there are rotations.
    Lumped,
    /// The mean of both: for [`crate::Bar`] their leading errors cancel in natural frequencies, which are then of
    /// order h⁴; receptances stay of order h².
    ///
    /// # Source
    /// Goudreau & Taylor, Comput. Methods Appl. Mech. Eng. 2 (1973) 69–97.
    Mean,
}

impl<const N: usize> Element<N> {
    /// The mass matrix of this kind.
    pub fn mass_matrix(&self, kind: Mass) -> [[f64; N]; N] {
        let (consistent, lumped) = match kind {
            Mass::Consistent => (1.0, 0.0),
            Mass::Lumped => (0.0, 1.0),
            Mass::Mean => (0.5, 0.5),
        };
        let mut matrix = self.mass.map(|row| row.map(|entry| consistent * entry));
        for (i, entry) in self.lumped.iter().enumerate() {
            matrix[i][i] += lumped * entry;
        }
        matrix
    }
}
