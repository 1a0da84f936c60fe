//! What is identified of a plate, and what that predicts.

use super::Plate;
use super::case::{LOSS_FACTOR, NAMES, SHEAR, Setting};
use crate::wrong_models::Failure;
use frfit::c64;
use frfit::identify::{Explained, FactorError, NumberOf, Status};
use frfit::model::FactorPart;
use frfit_workflow::job::{IdentifyJob, identify_case};
use frfit_workflow::load::{MeasuredNoise, Overrides};
use frfit_workflow::modes::{ModesOptions, modes_case};
use frfit_workflow::run::RunOptions;
use std::time::Instant;

/// The four constants of a plate, as identified.
#[derive(Debug)]
pub struct Found {
    /// Storage in Pa with its standard deviation, in the order of [`NAMES`].
    pub constants: [(f64, f64); 4],
    /// Their loss factors.
    pub loss_factors: [f64; 4],
    /// Correlation of the four storage parts.
    correlation: [[f64; 4]; 4],
    /// Relative standard deviation of the errors of natural frequencies.
    pub frequency_std: f64,
    /// Moduli of transverse shear in Pa with the errors that were found.
    pub shear: [f64; 2],
    /// Mass at the sensor in kg that the model does not have.
    pub sensor_mass: f64,
    /// How many constants are `ok`.
    pub ok: usize,
    /// How well the band is explained.
    pub verdict: Option<Explained>,
    /// Wall-clock seconds of the identification.
    pub seconds: f64,
    /// Case, answer and files.
    job: IdentifyJob,
}

/// A natural frequency that the identified constants predict, and the measured one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PredictedMode {
    /// Of the model with the identified constants.
    pub model_hz: f64,
    /// Of the measurement.
    pub measured_hz: f64,
    /// Relative standard deviation of the difference: of the constants, of the errors of modes, and of the measured one.
    pub std: f64,
}

impl PredictedMode {
    /// Model over measurement, less one.
    pub fn difference(&self) -> f64 {
        self.model_hz / self.measured_hz - 1.0
    }
}

impl Plate {
    /// Identifies the four constants.
    ///
    /// # Errors
    /// [`Failure`] where the case cannot be made or read, or has no standard deviations.
    pub fn identify(&self, setting: &Setting) -> Result<Found, Failure> {
        let folder = tempfile::tempdir()?;
        let case = self.case(setting, folder.path())?;
        let out = folder.path().join("out");
        let start = Instant::now();
        let job = identify_case(&case, &Overrides::default(), RunOptions::default(), &out, &|_, _| {})?;
        let seconds = start.elapsed().as_secs_f64();
        let found = &job.run.found;
        let mut constants = [(0.0, 0.0); 4];
        let mut loss_factors = [0.0; 4];
        for (k, of) in found.constants.iter().enumerate() {
            let [storage, loss_factor] = of.numbers.as_slice() else { return Err("a real constant".into()) };
            constants[k] = (storage.value, storage.std.ok_or("a constant without standard deviation")?);
            loss_factors[k] = loss_factor.value;
        }
        let identifiability = &found.identifiability;
        let place = |k: usize| {
            let is_storage = |of: &frfit::identify::BandCoordinate| {
                of.of == NumberOf::Unknown(k) && of.number == "storage"
            };
            identifiability.coordinates.iter().position(is_storage)
        };
        let correlated = |a: usize, b: usize| {
            let [a, b] = [place(a)?, place(b)?];
            identifiability.correlation.get(a)?.get(b).copied()
        };
        let alone = |a: usize, b: usize| f64::from(a == b);
        let correlation =
            std::array::from_fn(|a| std::array::from_fn(|b| correlated(a, b).unwrap_or_else(|| alone(a, b))));
        Ok(Found {
            constants,
            loss_factors,
            correlation,
            frequency_std: found.model_errors.as_ref().map_or(0.0, |errors| errors.frequency_std),
            shear: std::array::from_fn(|k| setting.shear[k] * (1.0 + factor_error(&job, SHEAR[k].0))),
            sensor_mass: found
                .model_errors
                .as_ref()
                .map_or(0.0, |errors| errors.masses.iter().map(|m| m.mass).sum()),
            ok: found.constants.iter().filter(|of| of.status == Status::Ok).count(),
            verdict: found.fit.map(|fit| fit.verdict),
            seconds,
            job,
        })
    }

    /// Natural frequencies of the plate with the constants, the moduli of shear and the mass at the sensor that were found, beside those of all five impacts in a band.
    ///
    /// # Errors
    /// [`Failure`] as [`Self::identify`].
    pub fn predicted(&self, found: &Found, setting: &Setting) -> Result<Vec<PredictedMode>, Failure> {
        self.with_storage(found.constants.map(|(storage, _)| storage), found, setting)
    }

    /// The same with the published moduli in place of those that were found.
    ///
    /// # Errors
    /// [`Failure`] as [`Self::identify`].
    pub fn of_published(&self, found: &Found, setting: &Setting) -> Result<Vec<PredictedMode>, Failure> {
        let ratio = |k: usize| self.published[k].0 / found.moduli()[k].0;
        let ratios = [ratio(0), ratio(1), (ratio(0) * ratio(1)).sqrt(), ratio(2)];
        self.with_storage(std::array::from_fn(|k| ratios[k] * found.constants[k].0), found, setting)
    }

    fn with_storage(
        &self,
        storage: [f64; 4],
        found: &Found,
        setting: &Setting,
    ) -> Result<Vec<PredictedMode>, Failure> {
        let folder = tempfile::tempdir()?;
        let nominal = std::array::from_fn(|k| [storage[k], found.loss_factors[k].max(0.1 * LOSS_FACTOR)]);
        let found_setting =
            Setting { nominal, shear: found.shear, sensor_mass: found.sensor_mass, ..setting.clone() };
        let case = self.case(&found_setting, folder.path())?;
        let job = modes_case(&case, &Overrides::default(), &ModesOptions::default(), None)?;
        let terms = job.case.model.terms();
        let place = |name: &str| terms.iter().position(|term| term.name == name).ok_or("no such matrix");
        let places = [place(NAMES[0])?, place(NAMES[1])?, place(NAMES[2])?, place(NAMES[3])?];
        let Some(measured) = &job.run.measured else { return Err("no measurement".into()) };
        let of_pair = |pair: &frfit::modal::Pair| {
            let model = &job.run.model.modes[pair.model];
            let measured = &measured.modes.modes[pair.measured];
            let shares = places.map(|term| model.energy_shares[term]);
            let measured_std = measured.frequency_std_hz.unwrap_or(0.0) / measured.frequency_hz();
            PredictedMode {
                model_hz: model.frequency_hz(),
                measured_hz: measured.frequency_hz(),
                std: found.frequency_std.hypot(found.of_constants(&shares)).hypot(measured_std),
            }
        };
        Ok(measured.pairing.pairs.iter().map(of_pair).collect())
    }
}

/// The error of the storage part of a known factor, zero where none was searched.
fn factor_error(job: &IdentifyJob, matrix: &str) -> f64 {
    let terms = job.case.model.terms();
    let of_matrix =
        |error: &&FactorError| terms[error.term].name == matrix && error.part == FactorPart::Storage;
    let errors = job.run.found.model_errors.iter().flat_map(|errors| &errors.factors);
    errors.into_iter().find(of_matrix).map_or(0.0, |error| error.error)
}

impl Found {
    /// E_L, E_R and G_LR in Pa, each with its standard deviation: D₁₁ = E_L/(1 − ν_LR ν_RL), ν_LR ν_RL = D₁₂²/D₁₁D₂₂.
    pub fn moduli(&self) -> [(f64, f64); 3] {
        let [d11, d22, d12, d66] = self.constants;
        let share = 1.0 - d12.0 * d12.0 / (d11.0 * d22.0);
        [(d11.0 * share, d11.1 * share), (d22.0 * share, d22.1 * share), d66]
    }

    /// Relative standard deviation of a natural frequency by those of the constants: δf/f = ½ Σ_k w_k δD_k/D_k, with the shares w_k of the strain energy.
    fn of_constants(&self, shares: &[f64; 4]) -> f64 {
        let of = |k: usize| 0.5 * shares[k] * self.constants[k].1 / self.constants[k].0;
        let pairs = (0..4).flat_map(|a| (0..4).map(move |b| (a, b)));
        pairs.map(|(a, b)| of(a) * of(b) * self.correlation[a][b]).sum::<f64>().max(0.0).sqrt()
    }

    /// Of the responses that other impacts have measured, the share within the 95 % of what the model predicts: |δ|² ≤ −ln 0.05 (σ² + σ₀² + σ_r²), of the noise
    /// of either set of impacts and of what neither noise nor errors of the model explain.
    ///
    /// Impacts differ in how they excite each mode, which the model follows: so their own noise counts too.
    pub fn covers(&self, other: &Self) -> Option<f64> {
        let (Some(own), Some(measured)) = (&self.job.case.identify, &other.job.case.identify) else {
            return None;
        };
        let (MeasuredNoise::Known(of_own), MeasuredNoise::Known(of_other)) = (&own.noise, &measured.noise)
        else {
            return None;
        };
        if own.frequency_hz != measured.frequency_hz {
            return None;
        }
        let run = &self.job.run;
        let rest = run.found.model_errors.as_ref().map_or(0.0, |errors| errors.response_std);
        let is_covered = |i: usize| {
            let line = &run.found.lines[i];
            let predicted = *line.updated_response.first()?;
            let calibrated = |value: c64| run.measured_by(0, line.frequency_hz, value);
            let of_noise = calibrated(c64::from(of_own[i][0].hypot(of_other[i][0]))).norm_sqr();
            let variance = of_noise + (rest * predicted.norm()).powi(2);
            let difference = calibrated(measured.measured[i][0]) - predicted;
            Some(difference.norm_sqr() <= -0.05_f64.ln() * variance)
        };
        let covered: Vec<bool> = (0..own.frequency_hz.len()).filter_map(is_covered).collect();
        let share = covered.iter().filter(|&&is| is).count() as f64 / covered.len() as f64;
        Some(share).filter(|share| share.is_finite())
    }
}
