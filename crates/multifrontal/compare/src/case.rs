//! The matrices: dynamic stiffness of clamped structures between two of their natural frequencies.

use frfit_fem::brick::{Face, Layer};
use frfit_fem::{Brick, Plate, Support};
use frfit_linalg::sparse::{Pattern, SymmetricMatrix};
use frfit_linalg::{Scalar, c64, modes};
use std::error::Error;
use std::sync::Arc;

/// Loss factor of the complex matrices: K(1 + iη) − ω²M.
const LOSS_FACTOR: f64 = 0.05;

/// Right-hand sides of the block solve.
pub const RIGHT_HAND_SIDES: usize = 8;

/// A real or complex number as a solver needs to know it.
pub trait Number: Scalar + multifrontal::Scalar {
    /// Its name on the command line and in tables.
    const NAME: &'static str;
    /// Operations of one complex one count as four real ones.
    const FLOPS: f64;
    /// The entries of K(1 + iη) − ω²M, or without η.
    fn entry(stiffness: f64, mass_term: f64) -> Self;
    /// From two numbers, or the first of them.
    fn of_parts(re: f64, im: f64) -> Self;
    /// As a complex number.
    fn complex(self) -> c64;
    /// The values, if they are real.
    fn real(values: &[Self]) -> Option<&[f64]>;
    /// The numbers of a solution that was found in real numbers, if this is one.
    fn of_real(values: Vec<f64>) -> Vec<Self>;
}

impl Number for f64 {
    const NAME: &'static str = "real";
    const FLOPS: f64 = 1.0;

    fn entry(stiffness: f64, mass_term: f64) -> Self {
        stiffness - mass_term
    }
    fn of_parts(re: f64, _: f64) -> Self {
        re
    }
    fn complex(self) -> c64 {
        c64::new(self, 0.0)
    }
    fn real(values: &[Self]) -> Option<&[f64]> {
        Some(values)
    }
    fn of_real(values: Vec<f64>) -> Vec<Self> {
        values
    }
}

impl Number for c64 {
    const NAME: &'static str = "complex";
    const FLOPS: f64 = 4.0;

    fn entry(stiffness: f64, mass_term: f64) -> Self {
        c64::new(stiffness - mass_term, LOSS_FACTOR * stiffness)
    }
    fn of_parts(re: f64, im: f64) -> Self {
        c64::new(re, im)
    }
    fn complex(self) -> c64 {
        self
    }
    fn real(_: &[Self]) -> Option<&[f64]> {
        None
    }
    fn of_real(values: Vec<f64>) -> Vec<Self> {
        values.into_iter().map(|value| c64::new(value, 0.0)).collect()
    }
}

/// A system of equations.
pub struct Case<T> {
    /// Lower triangle by columns.
    pub pattern: Arc<Pattern>,
    /// One value for each of its positions.
    pub values: Vec<T>,
    /// Right-hand sides by columns.
    pub rhs: Vec<T>,
}

/// Stiffness and mass of a structure, and ω² in the widest gap between its modes 20 to 30.
pub struct Structure {
    stiffness: SymmetricMatrix,
    mass: SymmetricMatrix,
    omega_squared: f64,
}

/// How to make a structure, and a coarser one that has nearly its natural frequencies.
pub struct Recipe {
    /// Its name on the command line and in tables.
    pub name: &'static str,
    matrices: fn(fine: bool) -> Result<(SymmetricMatrix, SymmetricMatrix), frfit_fem::Error>,
}

/// All matrices, smallest factors first.
pub const RECIPES: [Recipe; 6] = [
    Recipe { name: "block-3k", matrices: |_| block([10, 9, 9]) },
    Recipe { name: "block-12k", matrices: |fine| block(if fine { [16, 15, 15] } else { [10, 9, 9] }) },
    Recipe { name: "plate-50k", matrices: |fine| plate(if fine { 131 } else { 41 }) },
    Recipe { name: "sandwich-50k", matrices: |fine| sandwich(if fine { [160, 20] } else { [64, 8] }) },
    Recipe { name: "block-50k", matrices: |fine| block(if fine { [25; 3] } else { [10, 9, 9] }) },
    Recipe { name: "block-150k", matrices: |fine| block(if fine { [36; 3] } else { [10, 9, 9] }) },
];

impl Recipe {
    /// The structure; modes are those of the coarse one, whose factor costs little. How many modes are below ω is what
    /// the negative pivots of the real matrix count.
    ///
    /// # Errors
    /// Where there are no modes.
    pub fn make(&self) -> Result<Structure, Box<dyn Error>> {
        let (stiffness, mass) = (self.matrices)(false)?;
        let lowest = modes::lowest(&stiffness, &mass, 30)?.omega_squared;
        let gaps = lowest[19..].windows(2).map(|pair| (pair[1] / pair[0], 0.5 * (pair[0] + pair[1])));
        let widest = gaps.max_by(|a, b| a.0.total_cmp(&b.0)).ok_or("fewer than 21 modes")?;
        let (stiffness, mass) = (self.matrices)(true)?;
        Ok(Structure { stiffness, mass, omega_squared: widest.1 })
    }
}

impl Structure {
    /// Its dynamic stiffness and pseudo-random right-hand sides.
    pub fn case<T: Number>(&self) -> Case<T> {
        let pattern = Pattern::union(&[self.stiffness.pattern(), self.mass.pattern()]);
        let on = |matrix: &SymmetricMatrix| {
            let mut values = vec![0.0; pattern.stored()];
            matrix.on_pattern(&pattern).accumulate_real_into(1.0, &mut values);
            values
        };
        let (stiffness, mass) = (on(&self.stiffness), on(&self.mass));
        let values =
            stiffness.iter().zip(&mass).map(|(&k, &m)| T::entry(k, self.omega_squared * m)).collect();
        let mut state = 1;
        let rhs = (0..RIGHT_HAND_SIDES * pattern.dim())
            .map(|_| T::of_parts(uniform(&mut state), uniform(&mut state)))
            .collect();
        Case { pattern, values, rhs }
    }
}

impl<T: Number> Case<T> {
    /// Number of equations.
    pub fn dim(&self) -> usize {
        self.pattern.dim()
    }

    /// ‖b − Ax‖∞ / (‖A‖∞ ‖x‖∞ + ‖b‖∞), the largest of the right-hand sides that were solved for.
    ///
    /// # Source
    /// J. L. Rigal, J. Gaches, J. ACM 14 (1967) 543–548.
    pub fn backward_error(&self, x: &[T]) -> f64 {
        let each = x.chunks_exact(self.dim()).zip(self.rhs.chunks_exact(self.dim()));
        each.map(|(x, b)| self.error_of(x, b)).fold(0.0, larger)
    }

    fn error_of(&self, x: &[T], rhs: &[T]) -> f64 {
        let largest = |values: &[c64]| values.iter().map(|value| value.norm()).fold(0.0, larger);
        let x: Vec<c64> = x.iter().map(|x| x.complex()).collect();
        let rhs: Vec<c64> = rhs.iter().map(|b| b.complex()).collect();
        let mut residual = rhs.clone();
        let mut rows = vec![0.0; self.dim()];
        for ((row, col), value) in self.pattern.positions().zip(&self.values) {
            let value = value.complex();
            residual[row] -= value * x[col];
            rows[row] += value.norm();
            if row != col {
                residual[col] -= value * x[row];
                rows[col] += value.norm();
            }
        }
        largest(&residual) / (rows.into_iter().fold(0.0, larger) * largest(&x) + largest(&rhs))
    }
}

/// The larger of two, and NaN where there is one: `f64::max` would drop it.
fn larger(a: f64, b: f64) -> f64 {
    if b > a || b.is_nan() { b } else { a }
}

/// A steel cube of 1 m, clamped at one face.
fn block([nx, ny, nz]: [usize; 3]) -> Result<(SymmetricMatrix, SymmetricMatrix), frfit_fem::Error> {
    let layers = vec![Layer { elements: nz, ..Layer::default() }];
    let brick = Brick { elements: [nx, ny], layers, clamped: vec![Face::XMin], ..Brick::default() };
    let cube = brick.assemble()?;
    Ok((sum(&cube.stiffness, &[2.1e11]), sum(&cube.mass, &[7800.0])))
}

/// Aluminium skins on a core of rubber, clamped at one end; lengths as in the project's examples.
fn sandwich([nx, ny]: [usize; 2]) -> Result<(SymmetricMatrix, SymmetricMatrix), frfit_fem::Error> {
    let skin = Layer { thickness: 0.0015, ..Layer::default() };
    let core = Layer { thickness: 0.002, elements: 2, poisson: 0.45, material: 1 };
    let brick = Brick {
        length: 0.24,
        width: 0.03,
        elements: [nx, ny],
        layers: vec![skin, core, skin],
        clamped: vec![Face::XMin],
        ..Brick::default()
    };
    let beam = brick.assemble()?;
    Ok((sum(&beam.stiffness, &[7e10, 1e7]), sum(&beam.mass, &[2700.0, 1100.0])))
}

/// A clamped aluminium plate.
fn plate(n: usize) -> Result<(SymmetricMatrix, SymmetricMatrix), frfit_fem::Error> {
    let plate = Plate {
        sides: [0.4; 2],
        thickness: 0.002,
        elements: [n; 2],
        edges: [Support::Clamped; 4],
        ..Plate::default()
    };
    let plate = plate.assemble()?;
    Ok((sum(&plate.stiffness, &[7e10]), sum(&plate.mass, &[2700.0])))
}

/// Σ factor · matrix over the materials.
fn sum(matrices: &[SymmetricMatrix], factors: &[f64]) -> SymmetricMatrix {
    let pattern = Pattern::union(&matrices.iter().map(SymmetricMatrix::pattern).collect::<Vec<_>>());
    let mut values = vec![0.0; pattern.stored()];
    for (matrix, &factor) in matrices.iter().zip(factors) {
        matrix.on_pattern(&pattern).accumulate_real_into(factor, &mut values);
    }
    SymmetricMatrix::new(pattern, frfit_linalg::sparse::Values::Real(values))
}

/// Pseudo-random in [−1, 1): xorshift64.
///
/// G. Marsaglia, J. Stat. Softw. 8 (2003) 14.
fn uniform(state: &mut u64) -> f64 {
    *state ^= *state << 13;
    *state ^= *state >> 7;
    *state ^= *state << 17;
    // The upper 53 bits, as many as a double holds.
    (*state >> 11) as f64 / (1u64 << 52) as f64 - 1.0
}
