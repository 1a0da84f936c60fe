//! Data with planted faults: which of them `frfit check` names, and what it accuses wrongly.
//!
//! The models are those of `wrong_models`: one half right, one half wrong by a mesh, a known part, a mass, a support or another
//! element. A third of the cases has no fault, a third one, a third two.

mod plant;
mod report;

pub use plant::{Fault, Planted};
pub use report::{LEGEND, Tried, described, markdown};

use crate::wrong_models::Failure;
use crate::wrong_models::case::{Case, Setting};
use crate::wrong_models::dice::Dice;
use crate::wrong_models::fault::{Class, Unknowns};
use crate::wrong_models::realised::UNKNOWN;
use cpu_time::ThreadTime;
use frfit::c64;
use frfit::diagnostics::{Diagnosis, diagnose};
use frfit::for_each::sequential;
use frfit::identify::{Frfs, Noise, Options, Problem, Unknown};
use frfit::material::{Law, loss_factor};
use frfit::model::{DynamicStiffness, Experiment, Term};
use frfit::quantity::Quantity;

/// Nominal over true storage modulus in the middle of the band.
const NOMINAL_RATIO: [f64; 2] = [0.4, 1.6];

/// Nominal over true loss factor there: nobody knows the damping that he is about to measure.
const NOMINAL_LOSS_RATIO: [f64; 2] = [0.3, 3.0];

/// Which faults are planted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Which {
    /// None, one or two of all kinds.
    All,
    /// The load and a sensor on other rows.
    Rows,
}

/// Draws a case of a seed with its faults, and looks for them.
///
/// # Errors
/// [`Failure`], with the number of the case.
pub fn tried(seed: u64, index: u64, which: Which) -> Result<Tried, Failure> {
    let run = || {
        let planted_count = if which == Which::Rows { 2 } else { (index % 3) as usize };
        let (is_right, round) = ((index / 3).is_multiple_of(2), index / 6);
        // A calibration that is off is a fault of the data.
        let is_wrong = |class: &Class| !matches!(class, Class::Right | Class::Calibration);
        let wrong: Vec<Class> = Class::ALL.into_iter().filter(is_wrong).collect();
        let class = if is_right { Class::Right } else { wrong[round as usize % wrong.len()] };
        let place = Class::ALL.iter().position(|one| *one == class).unwrap_or(0) as u64;
        // Each case is a case of its own: no two share a structure.
        let number = |attempt: u64| Class::ALL.len() as u64 * (index + (attempt << 32)) + place;
        let draw = |attempt: u64| Case::draw(seed, number(attempt), Setting::USUAL, Unknowns::One);
        let mut case = draw(0).or_else(|_| draw(1))?;
        let mut dice = Dice::new(seed ^ 0xFA17, index);
        let ratio = dice.between(NOMINAL_RATIO[0], NOMINAL_RATIO[1]);
        let mut of_loss = Dice::new(seed ^ 0x1055, index);
        case.model =
            nominal(&case, ratio, of_loss.log_between(NOMINAL_LOSS_RATIO[0], NOMINAL_LOSS_RATIO[1]))?;
        let mut data = Data {
            frequency_hz: case.frequency_hz.clone(),
            written: case.measured.clone(),
            quantities: vec![dice.pick(&Quantity::ALL); case.experiment.sensors.len()],
            experiment: case.experiment.clone(),
        };
        for (&f, values) in data.frequency_hz.iter().zip(&mut data.written) {
            for (value, quantity) in values.iter_mut().zip(&data.quantities) {
                *value = quantity.from_receptance(f, *value);
            }
        }
        let mut planted: Vec<Planted> = Vec::new();
        while planted.len() < planted_count {
            if let Some(one) = plant::planted(&case, &mut data, (&planted, which), &mut dice)? {
                planted.push(one);
            }
        }
        let start = ThreadTime::now();
        let diagnosis = data.diagnose(&case.model)?;
        Ok(Tried::new(index, &case, planted, diagnosis, start.elapsed().as_secs_f64()))
    };
    run().map_err(|why: Failure| format!("case {index}: {why}").into())
}

/// The model of a case as its user has it: a constant modulus, whatever the material does over the band.
fn nominal(case: &Case, ratio: f64, loss_ratio: f64) -> Result<DynamicStiffness, Failure> {
    let truth = case.truth.at(case.frequency_hz[case.frequency_hz.len() / 2])?;
    let factor = Law::complex_modulus(ratio * truth.re, loss_ratio * loss_factor(truth));
    let term = |term: &Term| match term.name == UNKNOWN {
        true => Term { factor: factor.clone(), ..term.clone() },
        false => term.clone(),
    };
    Ok(DynamicStiffness::new(case.model.terms().iter().map(term).collect())?)
}

/// What was measured, as it was written and as the case takes it.
#[derive(Debug, Clone)]
pub(crate) struct Data {
    pub(crate) frequency_hz: Vec<f64>,
    /// `[frequency][sensor]`.
    pub(crate) written: Vec<Vec<c64>>,
    /// What each sensor's values are taken for.
    pub(crate) quantities: Vec<Quantity>,
    /// Where load and sensors are said to be.
    pub(crate) experiment: Experiment,
}

impl Data {
    fn diagnose(&self, model: &DynamicStiffness) -> Result<Diagnosis, Failure> {
        let receptance = |(&f, values): (&f64, &Vec<c64>)| {
            values.iter().zip(&self.quantities).map(|(&v, q)| q.to_receptance(f, v)).collect()
        };
        let receptance: Vec<Vec<c64>> = self.frequency_hz.iter().zip(&self.written).map(receptance).collect();
        let unknowns = [Unknown::factor_of(model, &[UNKNOWN])?];
        let frfs = Frfs { frequency_hz: &self.frequency_hz, receptance: &receptance, noise: Noise::Unknown };
        let problem = Problem::new(model, &self.experiment, &unknowns, &[], frfs)?;
        Ok(diagnose(&problem, &self.quantities, &Options::default(), &sequential)?)
    }
}
