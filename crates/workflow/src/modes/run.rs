//! The computation.

use crate::load::{Case, MeasuredBand, ModesCase};
use crate::run::{in_parallel, noise_of};
use frfit::c64;
use frfit::frequency::linear_hz;
use frfit::identify::Frfs;
use frfit::material::{Law, OutsideTable};
use frfit::modal::{
    MeasuredModes, PairedShape, Pairing, PoleOptions, assurance, coordinate_assurance, measured_modes,
    paired, scale_assurance,
};
use frfit::model::{DynamicStiffness, ModelAt};
use frfit::response::Work;
use frfit::subspace::{NaturalModes, NaturalModesError, Point, Subspace, TrainOptions};
use frfit_linalg::vector::norm;
use std::time::Instant;

/// What is asked for.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ModesOptions {
    /// The largest order of the stabilisation diagram; `None`: the default of [`PoleOptions`].
    pub max_order: Option<usize>,
    /// Bytes of memory that may be used. `None`: what the system says is available.
    pub memory_bytes: Option<u64>,
}

/// What was measured, beside the model.
#[derive(Debug, Clone, PartialEq)]
pub struct MeasuredRun {
    /// The measurement.
    pub band: MeasuredBand,
    /// Its modes.
    pub modes: MeasuredModes,
    /// Which mode of the model is which of the measurement.
    pub pairing: Pairing,
    /// The model's response, `[frequency][sensor]`; empty where the model has no response.
    pub response: Vec<Vec<c64>>,
    /// FRAC of each sensor.
    pub frac: Vec<Option<f64>>,
    /// CSAC and CSF at each frequency; CSAC is `None` for a single sensor.
    pub csac: Vec<Option<f64>>,
    /// See [`Self::csac`].
    pub csf: Vec<Option<f64>>,
    /// COMAC of each sensor; empty with fewer than two pairs.
    pub comac: Vec<Option<f64>>,
}

/// What came out.
#[derive(Debug, Clone, PartialEq)]
pub struct ModesRun {
    /// First and last frequency.
    pub band_hz: [f64; 2],
    /// Modes of the model up to somewhat above the band.
    pub model: NaturalModes,
    /// What was measured; `None` where there is nothing.
    pub measured: Option<MeasuredRun>,
    /// Work of size N.
    pub work: Work,
    /// Vectors of the subspace.
    pub subspace_size: usize,
    /// Wall-clock seconds.
    pub seconds: f64,
}

impl ModesRun {
    /// The partner of a mode of the measurement.
    pub fn partner_of_measured(&self, j: usize) -> Option<frfit::modal::Pair> {
        self.measured.as_ref()?.pairing.pairs.iter().find(|pair| pair.measured == j).copied()
    }

    /// The partner of a mode of the model.
    pub fn partner_of_model(&self, i: usize) -> Option<frfit::modal::Pair> {
        self.measured.as_ref()?.pairing.pairs.iter().find(|pair| pair.model == i).copied()
    }

    /// Modes of the model below the end of the band, or with a partner.
    pub fn shown(&self) -> impl Iterator<Item = usize> + '_ {
        let is_shown = |i: &usize| {
            self.model.modes[*i].frequency_hz() <= self.band_hz[1] || self.partner_of_model(*i).is_some()
        };
        (0..self.model.modes.len()).filter(is_shown)
    }
}

/// Modes of the model are searched up to this multiple of the measured band: partners of measured modes may be there.
const BEYOND_BAND: f64 = 1.4;

/// Error of the response that is compared with the measured one, and frequencies at which it is trained.
const RESPONSE_TOL: f64 = 1e-5;
const TRAINING_FREQUENCIES: usize = 40;

/// Modes of the model at its factors, and of the measurements that are wanted of a case.
///
/// # Errors
/// [`NaturalModesError`] where the model has no modes that can be found.
pub(super) fn modes_of(
    case: &Case,
    wanted: &ModesCase,
    options: &ModesOptions,
) -> Result<ModesRun, NaturalModesError> {
    let start = Instant::now();
    let band_hz = wanted.band_hz;
    let reach = if wanted.measured.is_some() { BEYOND_BAND } else { 1.0 };
    let within = range_of_tables(case);
    let at = |f: f64| case.model.at(f.clamp(within[0], within[1]), &[]);
    // A window is on the records. The modes are those of the structure, with moduli at real frequencies.
    let without_window = DynamicStiffness::clone(&case.model).with_decay_per_s(0.0);
    let of_structure = |f: f64| without_window.at(f.clamp(within[0], within[1]), &[]);
    let highest_hz = reach * band_hz[1];
    let mut subspace = match case.subspace() {
        Some(subspace) => subspace,
        None => Subspace::new(&case.experiment, &at(highest_hz)?)?,
    };
    let model = subspace.natural_modes(&of_structure, highest_hz)?;
    let measured = match &wanted.measured {
        Some(band) if band.frequency_hz.len() > 1 => {
            let decay_per_s = case.model.decay_per_s();
            let mut pole_options = PoleOptions::default().with_decay_per_s(decay_per_s);
            pole_options.max_order = options.max_order.unwrap_or(pole_options.max_order);
            let noise = noise_of(&band.noise);
            let frfs = Frfs { frequency_hz: &band.frequency_hz, receptance: &band.receptance, noise };
            let modes = measured_modes(frfs, &pole_options, &in_parallel).unwrap_or_default();
            let response = response(&mut subspace, &at, &band.frequency_hz)?;
            Some(compared(&model, &wanted.unknown_terms, band, modes, response))
        }
        _ => None,
    };
    Ok(ModesRun {
        band_hz,
        model,
        measured,
        work: subspace.work(),
        subspace_size: subspace.size(),
        seconds: start.elapsed().as_secs_f64(),
    })
}

/// Where all tables of factors have values; beyond it they keep their last one.
fn range_of_tables(case: &Case) -> [f64; 2] {
    let tables = case.model.terms().iter().filter_map(|term| match &term.factor {
        Law::Table(table) => Some(table.frequency_hz()),
        _ => None,
    });
    tables.fold([0.0, f64::MAX], |[low, high], own| [low.max(own[0]), high.min(own[own.len() - 1])])
}

/// The model's response on the subspace, trained for it; empty where that cannot be solved.
fn response<'m>(
    subspace: &mut Subspace<'m>,
    at: &dyn Fn(f64) -> Result<ModelAt<'m>, OutsideTable>,
    frequency_hz: &[f64],
) -> Result<Vec<Vec<c64>>, OutsideTable> {
    let ends = [frequency_hz[0], frequency_hz[frequency_hz.len() - 1]];
    let points = linear_hz(ends[0], ends[1], TRAINING_FREQUENCIES).into_iter();
    let point = |f: f64| Ok(Point { at: at(f)?, correction: c64::default() });
    let points = points.map(point).collect::<Result<Vec<_>, OutsideTable>>()?;
    let options = TrainOptions::default().with_tolerance(RESPONSE_TOL);
    if subspace.train(&points, &options, &in_parallel).is_err() {
        return Ok(Vec::new());
    }
    let models = frequency_hz.iter().map(|&f| at(f)).collect::<Result<Vec<_>, _>>()?;
    let each = models.iter().map(|at| subspace.projection().respond(at));
    Ok(each.collect::<Result<Vec<_>, _>>().unwrap_or_default())
}

/// Both side by side.
fn compared(
    model: &NaturalModes,
    unknown: &[usize],
    band: &MeasuredBand,
    modes: MeasuredModes,
    response: Vec<Vec<c64>>,
) -> MeasuredRun {
    let elastic: Vec<usize> = (0..model.modes.len()).filter(|&i| !model.modes[i].is_rigid_body()).collect();
    let of_model = |&i: &usize| PairedShape {
        frequency_hz: model.modes[i].frequency_hz(),
        residues: model.modes[i].residues(),
        energy_share: unknown.iter().map(|&term| model.modes[i].energy_shares[term]).sum(),
    };
    let shapes: Vec<PairedShape> = elastic.iter().map(of_model).collect();
    let measured_shapes: Vec<PairedShape> = (modes.modes.iter())
        .map(|mode| PairedShape {
            frequency_hz: mode.frequency_hz(),
            residues: mode.residues.clone(),
            energy_share: 0.0,
        })
        .collect();
    let mut pairing = paired(&shapes, &measured_shapes);
    pairing.pairs.iter_mut().for_each(|pair| pair.model = elastic[pair.model]);
    let sensors = band.receptance.first().map_or(0, Vec::len);
    let column = |rows: &[Vec<c64>], m: usize| rows.iter().map(|row| row[m]).collect::<Vec<_>>();
    let has_response = !response.is_empty();
    let frac =
        |m: usize| assurance(&column(&band.receptance, m), &column(&response, m)).filter(|_| has_response);
    let rows = || band.receptance.iter().zip(&response);
    // Of one size in both sets.
    let unit = |residues: &[c64]| -> Vec<c64> {
        let size = norm(residues);
        residues.iter().map(|r| if size > 0.0 { r / size } else { *r }).collect()
    };
    let pairs: Vec<[Vec<c64>; 2]> = (pairing.pairs.iter())
        .map(|pair| [unit(&model.modes[pair.model].residues()), unit(&modes.modes[pair.measured].residues)])
        .collect();
    let comac = |m: usize| {
        let [x, y] = [0, 1].map(|k| pairs.iter().map(|pair| pair[k][m]).collect::<Vec<_>>());
        coordinate_assurance(&x, &y)
    };
    MeasuredRun {
        frac: (0..sensors).map(frac).collect(),
        csac: rows().map(|(x, y)| assurance(x, y).filter(|_| sensors > 1)).collect(),
        csf: rows().map(|(x, y)| scale_assurance(x, y)).collect(),
        comac: if pairs.len() > 1 && sensors > 1 { (0..sensors).map(comac).collect() } else { Vec::new() },
        band: band.clone(),
        modes,
        pairing,
        response,
    }
}
