//! What the model answers at the frequencies that are looked at, for any values of its unknowns.

use super::moduli::{Moduli, Parametrization};
use crate::c64;
use crate::for_each::{ForEach, map};
use crate::identify::Problem;
use crate::material::OutsideTable;
use crate::model::{Experiment, ModelAt};
use crate::subspace::{Drive, ModalSums, Point, PoleResidue, Subspace, TrainOptions};

/// Error of the responses over the box: a tenth of what an FRF is measured to.
const RESPONSE_TOL: f64 = 1e-3;

/// Sizes of the unknowns over the box at which the basis is made good.
const BOX_SIZES: usize = 5;

/// How responses are summed.
enum Sums {
    /// Of one factor: over the poles in it at every frequency, as exact as the reduced model.
    Poles { each: Vec<PoleResidue>, nominal: Vec<c64> },
    /// Of several unknowns, or a geometric one: over the modes at some of their values.
    Modes(ModalSums),
}

/// The model at the frequencies that are looked at.
pub(super) struct Responses<'a> {
    pub(super) parametrization: Parametrization,
    pub(super) frequency_hz: Vec<f64>,
    problem: &'a Problem<'a>,
    sums: Sums,
    /// The values that were known before: of several unknowns those whose modes are summed.
    pub(super) about: Moduli,
    /// Residues `[column][frequency][pole]`, once for all frequencies of modes: the sensors', then those of other places.
    columns: Vec<Vec<Vec<c64>>>,
    pub(super) subspace: &'a Subspace<'a>,
    /// Which of its sensors are looked at.
    pub(super) sensors: Vec<usize>,
    /// Rows of the full model.
    pub(super) rows: usize,
}

/// Moduli over the whole box.
pub(super) fn over_the_box(parametrization: &Parametrization) -> Vec<Moduli> {
    let [low, high] = parametrization.common();
    let step = (high - low) / (BOX_SIZES - 1) as f64;
    (0..BOX_SIZES).map(|k| parametrization.all_by(low + k as f64 * step, 0.0, 0.0)).collect()
}

/// A subspace trained at some moduli; `None` where no real stand-in for D can be factorised.
pub(super) fn trained<'a>(
    problem: &Problem<'a>,
    experiment: &'a Experiment,
    frequency_hz: &[f64],
    parametrization: &Parametrization,
    moduli: &[Moduli],
    for_each: ForEach<'_>,
) -> Result<Option<Subspace<'a>>, OutsideTable> {
    let mut points: Vec<Point<'a>> = Vec::with_capacity(frequency_hz.len() * moduli.len());
    for (i, &f) in frequency_hz.iter().enumerate() {
        for moduli in moduli {
            let at = problem.at(f, &parametrization.values(moduli, i))?;
            points.push(Point { correction: c64::default(), at });
        }
    }
    let Some(&top) = frequency_hz.last() else { return Ok(None) };
    let nominal =
        problem.at(top, &parametrization.values(&parametrization.nominal(), frequency_hz.len() - 1))?;
    let Ok(mut subspace) = Subspace::new(experiment, &nominal) else { return Ok(None) };
    let training = TrainOptions { tolerance: RESPONSE_TOL, ..TrainOptions::default() };
    Ok(subspace.train(&points, &training, for_each).is_ok().then_some(subspace))
}

impl<'a> Responses<'a> {
    /// The poles, or the modes at `about`, of a subspace. `sensors` are those of its sensors that are looked at, each a column. `None` where
    /// the reduced model has no poles or modes.
    pub(super) fn new(
        problem: &'a Problem<'a>,
        subspace: &'a Subspace<'a>,
        sensors: Vec<usize>,
        (parametrization, about): (Parametrization, &Moduli),
        frequency_hz: &[f64],
        for_each: ForEach<'_>,
    ) -> Option<Self> {
        let small = subspace.projection();
        let sums = match problem.unknowns() {
            [only] if only.parameter().is_some_and(|p| p.members.iter().all(|member| member.power == 1)) => {
                let at = problem.about(0, frequency_hz).ok()?;
                let each = map(for_each, at.len(), |i| small.pole_residue(&at[i]).ok().flatten());
                let nominal = at.iter().map(|at| at.parameters[0].nominal).collect();
                Sums::Poles { each: each.into_iter().collect::<Option<_>>()?, nominal }
            }
            _ => {
                let middle = frequency_hz.len() / 2;
                let at =
                    problem.at(*frequency_hz.get(middle)?, &parametrization.values(about, middle)).ok()?;
                Sums::Modes(small.modal_sums(&at).ok()?)
            }
        };
        let mut responses = Self {
            parametrization,
            frequency_hz: frequency_hz.to_vec(),
            problem,
            sums,
            about: about.clone(),
            columns: Vec::new(),
            rows: subspace.model().dim(),
            subspace,
            sensors,
        };
        for k in 0..responses.sensors.len() {
            let sensor = responses.sensors[k];
            responses.add(sensor, Drive::Load, c64::new(1.0, 0.0));
        }
        Some(responses)
    }

    /// Whether they are sums over modes at some values of the unknowns, which are good only near these.
    pub(super) fn is_modal(&self) -> bool {
        matches!(self.sums, Sums::Modes(_))
    }

    /// Adds a column: `by` times the response at one of the subspace's sensors to a drive. Returns its number.
    pub(super) fn add(&mut self, sensor: usize, drive: Drive, by: c64) -> usize {
        let times = |residues: Vec<c64>| residues.into_iter().map(|rho| rho * by).collect();
        self.columns.push(match &self.sums {
            Sums::Poles { each, .. } => {
                each.iter().map(|poles| times(poles.residues(sensor, drive))).collect()
            }
            Sums::Modes(modes) => vec![times(modes.residues(sensor, drive))],
        });
        self.columns.len() - 1
    }

    /// The model at the i-th frequency.
    pub(super) fn at(&self, moduli: &Moduli, i: usize) -> Result<ModelAt<'a>, OutsideTable> {
        self.problem.at(self.frequency_hz[i], &self.parametrization.values(moduli, i))
    }

    /// E − Ē of the only unknown at the i-th frequency.
    fn correction(&self, nominal: &[c64], moduli: &Moduli, i: usize) -> c64 {
        self.parametrization.values(moduli, i)[0] - nominal[i]
    }

    /// What every residue is multiplied with at the i-th frequency.
    fn inverse(&self, moduli: &Moduli, i: usize) -> Vec<c64> {
        match &self.sums {
            Sums::Poles { each, nominal } => {
                let c = self.correction(nominal, moduli, i);
                each[i].lambda().iter().map(|lambda| (1.0 + c * lambda).inv()).collect()
            }
            Sums::Modes(modes) => match self.at(moduli, i) {
                Ok(at) => modes.inverse(&at),
                Err(OutsideTable { .. }) => Vec::new(),
            },
        }
    }

    /// ln x of some columns at the i-th frequency.
    pub(super) fn ln(&self, moduli: &Moduli, i: usize, columns: &[usize]) -> Vec<c64> {
        let inverse = self.inverse(moduli, i);
        let sum = |&column: &usize| {
            let of = &self.columns[column];
            of[i.min(of.len() - 1)].iter().zip(&inverse).map(|(rho, d)| rho * d).sum::<c64>().ln()
        };
        columns.iter().map(sum).collect()
    }

    /// ln x of some columns at the i-th frequency, and its slopes by the values of all unknowns, `[unknown][column]`.
    pub(super) fn ln_with_slopes(
        &self,
        moduli: &Moduli,
        i: usize,
        columns: &[usize],
    ) -> (Vec<c64>, Vec<Vec<c64>>) {
        let (inverse, slopes) = match &self.sums {
            Sums::Poles { each, .. } => {
                let inverse = self.inverse(moduli, i);
                let slope = each[i].lambda().iter().zip(&inverse).map(|(l, d)| -l * d * d).collect();
                (inverse, vec![slope])
            }
            Sums::Modes(modes) => match self.at(moduli, i) {
                Ok(at) => {
                    let inverse = modes.inverse(&at);
                    let slopes = modes.slopes(&at, &inverse);
                    (inverse, slopes)
                }
                Err(OutsideTable { .. }) => (Vec::new(), Vec::new()),
            },
        };
        let sum = |column: usize, of: &[c64]| -> c64 {
            let residues = &self.columns[column];
            residues[i.min(residues.len() - 1)].iter().zip(of).map(|(rho, d)| rho * d).sum()
        };
        let x: Vec<c64> = columns.iter().map(|&column| sum(column, &inverse)).collect();
        let of_unknown = |slope: &Vec<c64>| -> Vec<c64> {
            columns.iter().zip(&x).map(|(&column, x)| sum(column, slope) / x).collect()
        };
        let slopes = slopes.iter().map(of_unknown).collect();
        (x.iter().map(|x| x.ln()).collect(), slopes)
    }

    /// x at every row of the model at some of the frequencies, `[frequency][row]`.
    pub(super) fn everywhere(&self, drive: Drive, moduli: &Moduli, at: &[usize]) -> Vec<Vec<c64>> {
        let coordinates = at.iter().map(|&i| match &self.sums {
            Sums::Poles { each, nominal } => each[i].coordinates(drive, self.correction(nominal, moduli, i)),
            Sums::Modes(modes) => modes.coordinates(drive, &self.inverse(moduli, i)),
        });
        self.subspace.everywhere(&coordinates.collect::<Vec<_>>())
    }
}
