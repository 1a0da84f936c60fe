//! Response and derivatives over a band.

use super::{Change, Variable};
use crate::c64;
use crate::for_each::{ForEach, map};
use crate::material::OutsideTable;
use crate::model::{DynamicStiffness, Experiment, Parameter, Role};
use crate::response::Work;
use crate::subspace::{ChangeOptions, ChangePoint, Changed, Subspace, Trained};
use frfit_linalg::solve::Breakdown;

/// The model at every frequency with ∂D/∂ln p of every variable.
///
/// # Errors
/// [`OutsideTable`] where a table does not reach a frequency.
pub fn change_points<'m>(
    model: &'m DynamicStiffness,
    variables: &[Variable],
    frequency_hz: &[f64],
) -> Result<Vec<ChangePoint<'m>>, OutsideTable> {
    // An antiresonance is no place for a relative error: it is taken relative to the response or its change with the first stiffness, whichever is larger.
    let stiffness = model.terms().iter().enumerate().find(|(_, term)| term.role == Role::Stiffness);
    let reference: Vec<Parameter> =
        stiffness.and_then(|(_, term)| Parameter::factor_of(model, &[&term.name]).ok()).into_iter().collect();
    let point = |&f: &f64| {
        let changes = variables.iter().map(|v| v.derivative(model, f)).collect::<Result<_, _>>()?;
        Ok(ChangePoint { at: model.at(f, &reference)?, changes })
    };
    frequency_hz.iter().map(point).collect()
}

/// Frequencies of a band that a subspace is trained at; then as many of those where it is not good enough yet, the worst.
const FREQUENCIES_PER_TRAINING: usize = 256;

fn evaluated(
    subspace: &Subspace<'_>,
    points: &[ChangePoint<'_>],
    for_each: ForEach<'_>,
) -> Vec<Option<Changed>> {
    map(for_each, points.len(), |i| subspace.projection().changes(&points[i]).ok())
}

/// The subspace of a band, good for the response and its derivatives, and its results at every frequency.
#[derive(Debug)]
pub struct SensitivityBand<'m> {
    pub(super) subspace: Subspace<'m>,
    pub(super) variables: &'m [Variable],
    pub(super) frequency_hz: Vec<f64>,
    pub(super) at: Vec<Option<Changed>>,
    trained: Trained,
}

impl<'m> SensitivityBand<'m> {
    /// Trains a subspace for the load and the sensors, at the nominal values, and evaluates it.
    ///
    /// # Errors
    /// [`Breakdown`] where neither the shifted stiffness nor D at the last frequency can be factorised, or a solve fails.
    ///
    /// # Panics
    /// Where there is no point, or one has not one change for each variable.
    pub fn new(
        experiment: &'m Experiment,
        variables: &'m [Variable],
        points: &[ChangePoint<'m>],
        options: &ChangeOptions,
        for_each: ForEach<'_>,
    ) -> Result<Self, Breakdown> {
        let highest = points.iter().max_by(|a, b| a.at.frequency_hz.total_cmp(&b.at.frequency_hz));
        let subspace = Subspace::new(experiment, &highest.expect("a band has a frequency").at)?;
        Self::of_subspace(subspace, variables, points, options, for_each)
    }

    /// The same on a subspace of this load and these sensors that was trained before, and is trained further where it has to be.
    ///
    /// # Errors
    /// [`Breakdown`] where a solve fails.
    ///
    /// # Panics
    /// As [`SensitivityBand::new`].
    pub fn of_subspace(
        mut subspace: Subspace<'m>,
        variables: &'m [Variable],
        points: &[ChangePoint<'m>],
        options: &ChangeOptions,
        for_each: ForEach<'_>,
    ) -> Result<Self, Breakdown> {
        assert!(points.iter().all(|point| point.changes.len() == variables.len()));
        let step = points.len().div_ceil(FREQUENCIES_PER_TRAINING);
        let drawn: Vec<ChangePoint<'m>> = points.iter().step_by(step).cloned().collect();
        subspace.train_changes(&drawn, options, for_each)?;
        let mut at = evaluated(&subspace, points, for_each);
        // What is asked for is one.
        let excess = |changed: &Changed| {
            let everywhere = changed.everywhere.iter().copied().fold(0.0, f64::max);
            let at_sensors = changed.relative_truncation() / options.tolerance;
            options.everywhere.map_or(at_sensors, |tolerance| at_sensors.max(everywhere / tolerance))
        };
        let mut missed: Vec<(f64, usize)> =
            at.iter().enumerate().filter_map(|(i, at)| Some((excess(at.as_ref()?), i))).collect();
        missed.retain(|(excess, _)| *excess > 1.0);
        if step > 1 && !missed.is_empty() {
            missed.sort_by(|a, b| b.0.total_cmp(&a.0));
            let missed: Vec<ChangePoint<'m>> =
                missed.iter().take(FREQUENCIES_PER_TRAINING).map(|&(_, i)| points[i].clone()).collect();
            subspace.train_changes(&missed, options, for_each)?;
            at = evaluated(&subspace, points, for_each);
        }
        let error = at.iter().flatten().map(Changed::relative_truncation).fold(0.0, f64::max);
        let trained = Trained { error, converged: error <= options.tolerance };
        for (p, variable) in variables.iter().enumerate() {
            let Change::Scale(sensor) = variable.change else { continue };
            for changed in at.iter_mut().flatten() {
                // What a channel shows is its scale times the response.
                changed.slopes[p][sensor] = changed.response[sensor];
                changed.slope_truncation[p][sensor] = changed.error[sensor];
            }
        }
        let frequency_hz = points.iter().map(|point| point.at.frequency_hz).collect();
        Ok(Self { subspace, variables, frequency_hz, at, trained })
    }

    /// What is differentiated by.
    pub fn variables(&self) -> &[Variable] {
        self.variables
    }

    /// The frequencies.
    pub fn frequency_hz(&self) -> &[f64] {
        &self.frequency_hz
    }

    /// Response and derivatives at every frequency; `None` where the system is singular, as an undamped one at a resonance.
    pub fn at(&self) -> &[Option<Changed>] {
        &self.at
    }

    /// Number of basis vectors.
    pub fn size(&self) -> usize {
        self.subspace.size()
    }

    /// Real factorisations and solves.
    pub fn work(&self) -> Work {
        self.subspace.work()
    }

    /// How the training ended: the largest estimated error of a derivative at a sensor, relative to it or to the response, whichever is larger.
    pub fn trained(&self) -> Trained {
        self.trained
    }

    /// ∂ln x_m/∂ln p and its estimated error, the frequency given by its index; `None` where there is no derivative.
    pub fn logarithmic(&self, frequency: usize, variable: usize, sensor: usize) -> Option<(c64, f64)> {
        let changed = self.at[frequency].as_ref()?;
        let (x, slope) = (changed.response[sensor], changed.slopes[variable][sensor]);
        let value = slope / x;
        let error = (changed.slope_error(variable, sensor) + value.norm() * changed.error[sensor]) / x.norm();
        (value.is_finite() && error.is_finite()).then_some((value, error))
    }
}
