//! The model at one frequency on the subspace: small, dense, and a [`Response`] like the full one.

use super::Projection;
use crate::c64;
use crate::model::{Combination, ModelAt};
use crate::response::{Response, Work};
use frfit_linalg::dense::{Ldlt, Matrix, NoConvergence};
use frfit_linalg::solve::Breakdown;

/// VᵀD(ω, c)V with its load and sensors.
#[derive(Debug)]
pub struct ReducedModel<'a> {
    frequency_hz: f64,
    nominal: Matrix,
    /// `[parameter][q − 1]`: VᵀA_{j,q}V.
    coefficients: Vec<Vec<Matrix>>,
    values: Vec<c64>,
    load: &'a [c64],
    sensors: &'a [Vec<f64>],
    factor: Ldlt,
}

pub(super) const SINGULAR: Breakdown = Breakdown::Singular { condition_at_least: f64::INFINITY };

impl Projection {
    /// The model at one frequency.
    ///
    /// # Errors
    /// [`Breakdown`] where a value is not finite.
    pub fn at(&self, at: &ModelAt<'_>) -> Result<ReducedModel<'_>, Breakdown> {
        ReducedModel::new(self, at)
    }
}

impl<'a> ReducedModel<'a> {
    fn new(small: &'a Projection, at: &ModelAt<'_>) -> Result<Self, Breakdown> {
        let reduced = |of: &Combination| small.combine(&small.parts.weights(of, at.frequency_hz));
        let nominal = reduced(&at.nominal);
        let factor = Ldlt::new(&nominal).map_err(|NoConvergence| Breakdown::NotFinite)?;
        Ok(Self {
            frequency_hz: at.frequency_hz,
            nominal,
            coefficients: at
                .parameters
                .iter()
                .map(|p| p.coefficients.iter().map(reduced).collect())
                .collect(),
            values: at.parameters.iter().map(|p| p.nominal).collect(),
            load: &small.load,
            sensors: &small.sensors,
            factor,
        })
    }

    /// VᵀD(c)V.
    pub fn matrix(&self, corrections: &[c64]) -> Matrix {
        let mut matrix = self.nominal.clone();
        for (coefficients, &c) in self.coefficients.iter().zip(corrections) {
            let mut power = c64::new(1.0, 0.0);
            for coefficient in coefficients {
                power *= c;
                matrix.add_scaled(power, coefficient);
            }
        }
        matrix
    }
}

impl Response for ReducedModel<'_> {
    fn frequency_hz(&self) -> f64 {
        self.frequency_hz
    }

    fn dim(&self) -> usize {
        self.load.len()
    }

    fn sensors(&self) -> usize {
        self.sensors.len()
    }

    fn nominal(&self, parameter: usize) -> c64 {
        self.values[parameter]
    }

    fn degree(&self, parameter: usize) -> usize {
        self.coefficients[parameter].len()
    }

    fn load(&self) -> &[c64] {
        self.load
    }

    fn solve_nominal(&self, x: &mut [c64]) -> Result<(), Breakdown> {
        self.factor.solve(x).map_err(|NoConvergence| SINGULAR)
    }

    fn solve_nominal_block(&self, block: &mut [c64]) -> Result<(), Breakdown> {
        self.solve_nominal(block)
    }

    fn multiply_add(&self, parameter: usize, power: usize, factor: c64, x: &[c64], out: &mut [c64]) {
        let matrix = match power.checked_sub(1) {
            None => &self.nominal,
            Some(q) => &self.coefficients[parameter][q],
        };
        matrix.multiply_add(factor, x, out);
    }

    fn observe(&self, x: &[c64]) -> Vec<c64> {
        self.sensors.iter().map(|l| l.iter().zip(x).map(|(l, x)| x * l).sum()).collect()
    }

    fn solve_at(&self, corrections: &[c64]) -> Result<Vec<c64>, Breakdown> {
        let mut x = self.load.to_vec();
        let factor = Ldlt::new(&self.matrix(corrections)).map_err(|NoConvergence| Breakdown::NotFinite)?;
        factor.solve(&mut x).map_err(|NoConvergence| SINGULAR)?;
        Ok(self.observe(&x))
    }

    /// None of it is of size N: what the subspace cost is [`super::Subspace::work`].
    fn work(&self) -> Work {
        Work::default()
    }
}
