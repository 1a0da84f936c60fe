//! Transforms of the records, and their products summed over the impacts.

use crate::c64;
use rustfft::{Fft, FftPlanner};
use std::sync::Arc;

/// Σ over the impacts of the products of X(ω) = Σₖ xₖ e^{−iωkΔ}, at k/T for k from 0 to N/2.
pub(super) struct Spectra {
    transform: Arc<dyn Fft<f64>>,
    /// Σ|F|²
    pub(super) force: Vec<f64>,
    /// Σ|X|², one a response.
    pub(super) responses: Vec<Vec<f64>>,
    /// Σ F̄X, one a response.
    pub(super) cross: Vec<Vec<c64>>,
}

impl Spectra {
    /// Nothing yet, for records of so many samples, at least one.
    pub(super) fn new(samples: usize, responses: usize) -> Self {
        let transform = FftPlanner::new().plan_fft_forward(samples.max(1));
        let lines = transform.len() / 2 + 1;
        Self {
            transform,
            force: vec![0.0; lines],
            responses: vec![vec![0.0; lines]; responses],
            cross: vec![vec![c64::new(0.0, 0.0); lines]; responses],
        }
    }

    /// Adds an impact: force, then responses, each of as many samples as were said.
    pub(super) fn add(&mut self, records: &[Vec<f64>]) {
        let mut transforms = records.iter().map(|record| self.of(record));
        let Some(force) = transforms.next() else { return };
        let transforms: Vec<Vec<c64>> = transforms.collect();
        for (sum, f) in self.force.iter_mut().zip(&force) {
            *sum += f.norm_sqr();
        }
        for (k, response) in transforms.into_iter().enumerate() {
            for (line, (x, f)) in response.iter().zip(&force).enumerate() {
                self.responses[k][line] += x.norm_sqr();
                self.cross[k][line] += f.conj() * x;
            }
        }
    }

    fn of(&self, record: &[f64]) -> Vec<c64> {
        let mut transform: Vec<c64> = record.iter().map(|&sample| c64::new(sample, 0.0)).collect();
        self.transform.process(&mut transform);
        transform.truncate(transform.len() / 2 + 1);
        transform
    }

    /// The lines above 0 Hz and below the Nyquist frequency at which all channels have something.
    ///
    /// At 0 Hz the offsets were removed, at the Nyquist frequency no phase can be known.
    pub(super) fn lines(&self) -> impl Iterator<Item = usize> {
        let last = self.transform.len().saturating_sub(1) / 2;
        let there = |k: &usize| self.force[*k] > 0.0 && self.responses.iter().all(|sum| sum[*k] > 0.0);
        (1..=last).filter(there)
    }
}
