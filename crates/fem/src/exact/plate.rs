//! Natural frequencies of thin rectangular plates.

use std::f64::consts::PI;

/// A uniform rectangular plate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct UniformPlate {
    /// Young's modulus E in Pa.
    pub modulus: f64,
    /// Density ρ in kg/m³.
    pub density: f64,
    /// Poisson's ratio ν.
    pub poisson: f64,
    /// Thickness h in m.
    pub thickness: f64,
    /// Sides a and b in m.
    pub sides: [f64; 2],
}

impl UniformPlate {
    /// D = E h³ / 12(1 − ν²) in N m.
    pub fn rigidity(&self) -> f64 {
        self.modulus * self.thickness.powi(3) / (12.0 * (1.0 - self.poisson * self.poisson))
    }

    /// All edges simply supported, m and n half-waves along a and b (from 1), in rad/s:
    /// ω = π² (m²/a² + n²/b²) √(D/ρh).
    ///
    /// # Source
    /// Navier 1823, in A. W. Leissa, *Vibration of Plates*, NASA SP-160, 1969, chapter 4.
    pub fn simply_supported_rad_s(&self, m: usize, n: usize) -> f64 {
        let half_waves = (m as f64 / self.sides[0]).powi(2) + (n as f64 / self.sides[1]).powi(2);
        PI.powi(2) * half_waves * self.wave_factor()
    }

    /// All edges clamped, square: ω = λ √(D/ρh) / a² with λ from [`CLAMPED_SQUARE`], in rad/s.
    ///
    /// `None` where the plate is not square, or `n` (from 1) is beyond the table.
    pub fn clamped_square_rad_s(&self, n: usize) -> Option<f64> {
        let [a, b] = self.sides;
        let coefficient = CLAMPED_SQUARE.get(n.checked_sub(1)?)?;
        (a == b).then(|| coefficient * self.wave_factor() / (a * a))
    }

    /// √(D/ρh) in m²/s.
    fn wave_factor(&self) -> f64 {
        (self.rigidity() / (self.density * self.thickness)).sqrt()
    }
}

/// A uniform rectangular plate of an orthotropic material, whose axes are along the sides.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct UniformOrthotropicPlate {
    /// D₁₁, D₂₂, D₁₂ and D₆₆ in Pa, as [`crate::OrthotropicPlate`] has them.
    pub constants: [f64; 4],
    /// Density ρ in kg/m³.
    pub density: f64,
    /// Thickness h in m.
    pub thickness: f64,
    /// Sides a and b in m.
    pub sides: [f64; 2],
}

impl UniformOrthotropicPlate {
    /// All edges simply supported, m and n half-waves along a and b (from 1), in rad/s:
    /// ω² = π⁴ h²/12ρ ( D₁₁ m⁴/a⁴ + 2 (D₁₂ + 2 D₆₆) m²n²/a²b² + D₂₂ n⁴/b⁴ ).
    ///
    /// # Source
    /// R. F. S. Hearmon, *An Introduction to Applied Anisotropic Elasticity*, Oxford 1961; A. W. Leissa, *Vibration of Plates*, NASA SP-160, 1969, chapter 9.
    pub fn simply_supported_rad_s(&self, m: usize, n: usize) -> f64 {
        let [d11, d22, d12, d66] = self.constants;
        let [x, y] = [(m as f64 / self.sides[0]).powi(2), (n as f64 / self.sides[1]).powi(2)];
        let stiffness = d11 * x * x + 2.0 * (d12 + 2.0 * d66) * x * y + d22 * y * y;
        PI.powi(2) * self.thickness * (stiffness / (12.0 * self.density)).sqrt()
    }
}

/// λ = ω a² √(ρh/D) of the clamped square plate, lowest first, whatever ν.
///
/// Rayleigh–Ritz with polynomials, an upper bound converged to the digits given; the tests compute it again.
/// Leissa, J. Sound Vib. 31 (1973) 257–293, has by fewer terms 35.992, 73.413, 73.413, 108.27, 131.64, 132.24.
pub const CLAMPED_SQUARE: [f64; 6] = [35.985_2, 73.393_8, 73.393_8, 108.216_5, 131.580_8, 132.204_8];
