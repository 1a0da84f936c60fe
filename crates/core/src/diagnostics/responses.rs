//! What the model answers at the frequencies that are looked at, for any modulus of three numbers.

use crate::c64;
use crate::for_each::{ForEach, map};
use crate::identify::{Options, Unknown};
use crate::model::{Experiment, ModelAt};
use crate::subspace::{Drive, Point, PoleResidue, Subspace, TrainOptions};

/// Error of the responses over the box: a tenth of what an FRF is measured to.
const RESPONSE_TOL: f64 = 1e-3;

/// Storage moduli over the box at which the basis is made good, and its loss factor where the nominal has none.
const BOX_STORAGES: usize = 5;

/// An angle of loss beyond this is that of a fluid.
const MAX_LOSS_ANGLE: f64 = 1.3;

/// The unknown modulus over the band: E(ω) = |Ē(ω)| a (ω/ω₀)^β exp(iδ(ω)) with δ = min(q δ̄(ω), 1.3).
///
/// Ē is the nominal and δ̄ its angle, one where it has none: what is unknown of a law is its size, its slope over log ω, and how much it damps.
pub(super) type Law = [f64; 3];

/// What is unknown: ln a, ln q, β.
#[derive(Debug, Clone)]
pub(super) struct Parametrization {
    /// |Ē| and δ̄ at each frequency.
    nominal: Vec<(f64, f64)>,
    /// ln(ω/ω₀).
    ln_omega: Vec<f64>,
    /// ln a from … to.
    pub(super) ln_size: [f64; 2],
    /// tan δ from … to.
    loss: [f64; 2],
    pub(super) is_real: bool,
}

impl Parametrization {
    /// `None` where the nominal has no positive real part, or nothing bounds it.
    pub(super) fn about(at: &[ModelAt<'_>], unknown: &Unknown, options: &Options) -> Option<Self> {
        let nominal: Vec<c64> = at.iter().map(|at| at.parameters[0].nominal).collect();
        if nominal.iter().any(|p| p.re <= 0.0) {
            return None;
        }
        let middle = at.len() / 2;
        let [low, high] = unknown.box_about(nominal[middle], options.box_ratio())?;
        let damps = nominal.iter().all(|p| p.arg() > 1e-9);
        let angle = |p: &c64| if damps { p.arg() } else { 1.0 };
        let bounded = unknown.bounds.loss_factor.unwrap_or([0.0, f64::INFINITY]);
        Some(Self {
            nominal: nominal.iter().map(|p| (p.norm(), angle(p))).collect(),
            ln_omega: at.iter().map(|a| (a.frequency_hz / at[middle].frequency_hz).ln()).collect(),
            ln_size: [low, high].map(|s| (s / nominal[middle].re).ln()),
            // Damping takes energy: a negative loss factor is a finding, not an answer.
            loss: bounded.map(|eta| eta.max(0.0)),
            is_real: unknown.real,
        })
    }

    /// ln q of an angle in the middle of the band.
    pub(super) fn ln_loss(&self, angle: f64) -> f64 {
        (angle / self.nominal[self.nominal.len() / 2].1).ln()
    }

    /// ln q of the nominal's own damping, or of one per cent where it has none.
    pub(super) fn usual_loss(&self) -> f64 {
        let damps = self.nominal.iter().any(|&(_, angle)| angle < 1.0);
        if damps { 0.0 } else { self.ln_loss(0.01) }
    }

    /// E at the i-th frequency.
    pub(super) fn modulus(&self, [ln_size, ln_loss, slope]: Law, i: usize) -> c64 {
        let (size, angle) = self.nominal[i];
        let size = size * (ln_size + slope * self.ln_omega[i]).exp();
        if self.is_real {
            return c64::new(size, 0.0);
        }
        let angle =
            (angle * ln_loss.exp()).clamp(self.loss[0].atan(), self.loss[1].atan()).min(MAX_LOSS_ANGLE);
        c64::from_polar(size, angle)
    }
}

/// The model at the frequencies that are looked at.
pub(super) struct Responses<'a> {
    pub(super) parametrization: Parametrization,
    pub(super) frequency_hz: Vec<f64>,
    nominal: Vec<c64>,
    pub(super) pole_residues: Vec<PoleResidue>,
    /// Residues `[column][frequency][pole]`: the sensors', then those of other places.
    columns: Vec<Vec<Vec<c64>>>,
    pub(super) subspace: &'a Subspace<'a>,
    /// Which of its sensors are looked at.
    pub(super) sensors: Vec<usize>,
    /// Rows of the full model.
    pub(super) rows: usize,
}

/// A subspace trained over the box; `None` where no real stand-in for D can be factorised.
pub(super) fn trained<'a>(
    experiment: &'a Experiment,
    at: &[ModelAt<'a>],
    parametrization: &Parametrization,
    for_each: ForEach<'_>,
) -> Option<Subspace<'a>> {
    let mut subspace = Subspace::new(experiment, at.last()?).ok()?;
    let [low, high] = parametrization.ln_size;
    let step = (high - low) / (BOX_STORAGES - 1) as f64;
    let points: Vec<Point<'a>> = (0..at.len())
        .flat_map(|i| (0..BOX_STORAGES).map(move |k| (i, low + k as f64 * step)))
        .map(|(i, ln_size)| {
            let modulus = parametrization.modulus([ln_size, 0.0, 0.0], i);
            Point { correction: modulus - at[i].parameters[0].nominal, at: at[i].clone() }
        })
        .collect();
    let training = TrainOptions { tolerance: RESPONSE_TOL, ..TrainOptions::default() };
    subspace.train(&points, &training, for_each).ok()?;
    Some(subspace)
}

impl<'a> Responses<'a> {
    /// Takes a subspace apart into its poles at every frequency; `sensors` says which of its sensors are looked at, each a column. `None` where there are no poles.
    pub(super) fn new(
        subspace: &'a Subspace<'a>,
        sensors: Vec<usize>,
        parametrization: Parametrization,
        at: &[ModelAt<'_>],
        for_each: ForEach<'_>,
    ) -> Option<Self> {
        let small = subspace.projection();
        let pole_residues = map(for_each, at.len(), |i| small.pole_residue(&at[i]).ok().flatten());
        let pole_residues: Vec<PoleResidue> = pole_residues.into_iter().collect::<Option<_>>()?;
        let mut responses = Self {
            parametrization,
            frequency_hz: at.iter().map(|at| at.frequency_hz).collect(),
            nominal: at.iter().map(|at| at.parameters[0].nominal).collect(),
            pole_residues,
            columns: Vec::new(),
            rows: subspace.model().dim(),
            subspace,
            sensors,
        };
        for k in 0..responses.sensors.len() {
            let sensor = responses.sensors[k];
            responses.add(|poles| poles.residues(sensor, Drive::Load));
        }
        Some(responses)
    }

    /// Adds a column of responses, by its residues at each frequency, and returns its number.
    pub(super) fn add(&mut self, residues: impl Fn(&PoleResidue) -> Vec<c64>) -> usize {
        self.columns.push(self.pole_residues.iter().map(residues).collect());
        self.columns.len() - 1
    }

    /// c at the i-th frequency.
    pub(super) fn correction(&self, law: Law, i: usize) -> c64 {
        self.parametrization.modulus(law, i) - self.nominal[i]
    }

    /// ln x of some columns at the i-th frequency.
    pub(super) fn ln(&self, law: Law, i: usize, columns: &[usize]) -> Vec<c64> {
        let c = self.correction(law, i);
        let inverse: Vec<c64> =
            self.pole_residues[i].lambda().iter().map(|lambda| (1.0 + c * lambda).inv()).collect();
        let sum = |&column: &usize| {
            let terms = self.columns[column][i].iter().zip(&inverse).map(|(rho, d)| rho * d);
            terms.sum::<c64>().ln()
        };
        columns.iter().map(sum).collect()
    }
}
