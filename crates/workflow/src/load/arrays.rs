//! From what a program holds in memory to a case: the same checks and conversions as for one read from files.

use super::dimension::{PartOf, polynomial};
use super::files::NamedFile;
use super::frf::Frf;
use super::identify::{Given, IdentifyCase, put_together};
use super::loaded::Case;
use super::measurement::{Curve, Decay, Measurement, SensorInfo, common_decay, measurement_argument};
use super::options::{chosen, options};
use super::sensitivities::SensitivitiesCase;
use super::unknowns::{known_have_std, unknowns};
use crate::case::{
    Exclusion, IdentifyEntry, Located, RandomWindow, UnknownEntry, are_powers, check_values, checked_band,
    expected_powers, variation,
};
use crate::error::{InputError, Place};
use crate::units::UnitSystem;
use frfit::c64;
use frfit::identify::{ChannelUnknowns, ModelErrors, OptionsError, Variation};
use frfit::laws::LawKind;
use frfit::model::{DynamicStiffness, Experiment, ModelError, Parameter, Sensor, Term};
use frfit::quantity::Quantity;
use frfit::roots::{Bounds, BoundsError};
use frfit_formats::FormatError;
use frfit_linalg::sparse::SymmetricMatrix;
use std::collections::BTreeMap;
use std::fmt;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A measured FRF in memory, and where it was measured.
#[derive(Debug, Clone, PartialEq)]
pub struct MeasuredFrf {
    /// Row of the model, from 0, and the sense that counts as positive.
    pub sensor: Sensor,
    /// What was measured.
    pub quantity: Quantity,
    /// Its values.
    pub frf: Frf,
    /// What its values are to be multiplied by; `None` where that is to be found.
    pub scale: Option<f64>,
    /// By how much it is late, s; `None` where that is to be found.
    pub delay_s: Option<f64>,
    /// Over how many records its coherence was averaged, where that is known.
    pub averages: Option<usize>,
    /// The window of random excitation; `None`: as the values show it.
    pub window: Option<RandomWindow>,
    /// The length of the records under it, s; `None`: 1 over the spacing of the lines.
    pub record_s: Option<f64>,
}

impl MeasuredFrf {
    /// Refuses what no model could be held against; `name` is what errors call it.
    ///
    /// # Errors
    /// Frequencies that are not ascending, values that are not finite or not as many, a scale of zero.
    pub fn check(&self, name: &str) -> Result<(), InputError> {
        let place = argument(name);
        check_frf(&self.frf).map_err(|error| InputError::at(&place, error.expected, error.found))?;
        let scale = self.scale.unwrap_or(1.0);
        if !(scale.is_finite() && scale != 0.0) {
            let expected = "a finite number that is not zero";
            return Err(InputError::at(&place.below("scale"), expected, scale.to_string()));
        }
        let delay_s = self.delay_s.unwrap_or(0.0);
        if !delay_s.is_finite() {
            return Err(InputError::at(&place.below("delay_s"), "a finite number", delay_s.to_string()));
        }
        let decay_per_s = self.frf.decay_per_s.unwrap_or(0.0);
        if !(decay_per_s.is_finite() && decay_per_s >= 0.0) {
            let expected = "a finite number of 1/s that is not negative";
            return Err(InputError::at(&place.below("decay_per_s"), expected, decay_per_s.to_string()));
        }
        if let Some(record_s) = self.record_s.filter(|record_s| !(record_s.is_finite() && *record_s > 0.0)) {
            let expected = "a number of seconds above 0";
            return Err(InputError::at(&place.below("record_s"), expected, record_s.to_string()));
        }
        if self.averages == Some(0) {
            return Err(InputError::at(&place.below("averages"), "1 or more", "0"));
        }
        Ok(())
    }
}

/// What is unknown: the keys of one `[[identify]]`.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct WantedUnknown {
    /// Its name; `None`: that of its matrices.
    pub name: Option<String>,
    /// Names of the matrices that share the unknown factor; none of a dimension.
    pub matrices: Vec<String>,
    /// Matrices that a dimension multiplies, each with its power.
    pub powers: Vec<(String, i32)>,
    /// Value of a dimension to begin with.
    pub nominal: Option<f64>,
    /// `frequency`, `smooth`, `constant` or `law`; `None`: `law` where there are laws, otherwise the default.
    pub varies: Option<String>,
    /// Laws to fit to the whole band; none beside `law`: all.
    pub laws: Vec<LawKind>,
    /// Bounds on the updated value.
    pub bounds: Bounds,
    /// Whether it is real.
    pub real: bool,
}

/// What to identify, and how: the keys of `[identify]`.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Wanted {
    /// What is unknown.
    pub unknowns: Vec<WantedUnknown>,
    /// First and last frequency; `None`: all that were measured.
    pub band_hz: Option<[f64; 2]>,
    /// Bands that are left out; one of no width is the line next to it.
    pub exclude_hz: Vec<[f64; 2]>,
    /// Of more lines than this, those that show the unknowns best; `None`: all.
    pub max_lines: Option<i64>,
    /// `rational`, `series` or `nelder-mead`; `None`: the default.
    pub method: Option<String>,
    /// `joint` or `smallest`; `None`: what the method usually has.
    pub selection: Option<String>,
    /// `auto`, `full` or `subspace`; `None`: the default.
    pub reduction: Option<String>,
    /// Order of the series, or upper bound of it; `None`: the default.
    pub order: Option<usize>,
    /// Whether the nominal is no more than the middle of the bounds.
    pub start_at_bounds: bool,
    /// Whether a sensor that contradicts all others is left out; `None`: the default.
    pub reject_outliers: Option<bool>,
    /// What is known of the errors of the model.
    pub model_errors: ModelErrors,
    /// Whether to look for what is wrong with the data first; of several unknowns where the band is not explained.
    pub check: bool,
}

/// Why what is in memory makes no case.
#[derive(Debug, Clone, PartialEq)]
pub enum ArraysError {
    /// Something that is not as it has to be.
    Input(InputError),
    /// No matrix of this name.
    Model(ModelError),
    /// No option can be like this.
    Options(OptionsError),
    /// No bounds can be like this.
    Bounds(BoundsError),
}

impl fmt::Display for ArraysError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Input(error) => write!(f, "{error}"),
            Self::Model(error) => write!(f, "{error}"),
            Self::Options(error) => write!(f, "{error}"),
            Self::Bounds(error) => write!(f, "{error}"),
        }
    }
}

impl std::error::Error for ArraysError {}

impl From<InputError> for ArraysError {
    fn from(error: InputError) -> Self {
        Self::Input(error)
    }
}

/// A case to identify from.
///
/// # Errors
/// [`ArraysError`]: what a case file with the same content would be refused for.
pub fn case_of_arrays(
    model: Arc<DynamicStiffness>,
    load: Vec<c64>,
    measured: Vec<MeasuredFrf>,
    wanted: &Wanted,
) -> Result<Case, ArraysError> {
    if measured.is_empty() {
        return Err(InputError::at(&argument("measurements"), "at least one measurement", "none").into());
    }
    let looked_for =
        |frf: &MeasuredFrf| ChannelUnknowns { scale: frf.scale.is_none(), delay: frf.delay_s.is_none() };
    let unknown: Vec<ChannelUnknowns> = measured.iter().map(looked_for).collect();
    let numbered = measured.into_iter().enumerate();
    let measurements = numbered
        .map(|(k, frf)| measurement(frf, k, model.dim()))
        .collect::<Result<Vec<Measurement>, InputError>>()?;
    let decay_per_s = common_decay(&measurements)?;
    let model = match decay_per_s == model.decay_per_s() {
        true => model,
        false => Arc::new(Arc::unwrap_or_clone(model).with_decay_per_s(decay_per_s)),
    };
    let sensors = measurements.iter().map(|measurement| measurement.sensor).collect();
    let experiment = experiment(&model, load, sensors)?;
    let entry = entry_of(&model, wanted)?;
    let of = |term: &Term| PartOf { matrix: term.name.clone(), dimension: None };
    let of: Vec<PartOf> = model.terms().iter().map(of).collect();
    let unknowns = unknowns(&entry, &model, &of)?;
    known_have_std(&model, &unknowns, |_| argument("storage_std"))?;
    let options = options(&entry, wanted.model_errors);
    options.validate().map_err(ArraysError::Options)?;
    let place_of = |first: usize| {
        let key = if unknown[first].scale { "scale" } else { "delay_s" };
        argument(&measurement_argument(first)).below(key)
    };
    let first = unknown.iter().position(|unknown| unknown.any()).map(place_of);
    let given = Given {
        model: &model,
        measurements: &measurements,
        respond: None,
        channels: (unknown, first),
        units: UnitSystem::Si,
        is_modulus: &|_| None,
    };
    let mut identify = put_together(&entry, unknowns, options, given)?;
    covers(&model, &identify.frequency_hz)?;
    if let (None, [first, .., last] | [first @ last]) = (wanted.band_hz, &identify.frequency_hz[..]) {
        identify.band_hz = [*first, *last];
    }
    let respond_hz = identify.frequency_hz.clone();
    let sensors = measurements.into_iter().map(|measurement| measurement.info).collect();
    Ok(case(model, experiment, sensors, Some(identify), respond_hz))
}

/// A case whose response at its nominal factors is asked for.
///
/// # Errors
/// A load or a sensor outside the model, a frequency that is not valid or that a factor's table does not reach.
pub fn response_of_arrays(
    model: Arc<DynamicStiffness>,
    load: Vec<c64>,
    sensors: Vec<Sensor>,
    quantity: Quantity,
    frequency_hz: Vec<f64>,
) -> Result<Case, InputError> {
    for (k, sensor) in sensors.iter().enumerate() {
        inside(&argument(&format!("sensors[{k}]")), sensor.row, model.dim())?;
    }
    let experiment = experiment(&model, load, sensors)?;
    if let Some(f) = frequency_hz.iter().find(|f| !(f.is_finite() && **f >= 0.0)) {
        let expected = "finite frequencies in Hz that are not negative";
        return Err(InputError::at(&argument("frequency_hz"), expected, f.to_string()));
    }
    covers(&model, &frequency_hz)?;
    let label =
        |sensor: &Sensor| SensorInfo { label: row(sensor.row), quantity, file: None, elsewhere: None };
    let labels = experiment.sensors.iter().map(label).collect();
    Ok(case(model, experiment, labels, None, frequency_hz))
}

/// A case whose sensitivities are asked for: each term's factor is a parameter.
///
/// # Errors
/// As [`response_of_arrays`].
pub fn sensitivities_of_arrays(
    model: Arc<DynamicStiffness>,
    load: Vec<c64>,
    sensors: Vec<Sensor>,
    frequency_hz: Vec<f64>,
) -> Result<Case, InputError> {
    let matrices = model.terms().iter().enumerate().map(|(k, term)| (term.name.clone(), vec![k])).collect();
    let unknown_scale = vec![false; sensors.len()];
    let wanted = SensitivitiesCase { std: None, matrices, dimensions: Vec::new(), unknown_scale };
    let case = response_of_arrays(model, load, sensors, Quantity::Receptance, frequency_hz)?;
    if let Some(f) = case.respond_hz.iter().find(|f| **f <= 0.0) {
        return Err(InputError::at(&argument("frequency_hz"), "frequencies above 0 Hz", f.to_string()));
    }
    Ok(Case { sensitivities: Some(wanted), ..case })
}

fn case(
    model: Arc<DynamicStiffness>,
    experiment: Experiment,
    sensors: Vec<SensorInfo>,
    identify: Option<IdentifyCase>,
    respond_hz: Vec<f64>,
) -> Case {
    let (title, row_names, inputs) = (String::new(), BTreeMap::new(), Vec::new());
    Case {
        reduced: None,
        units: UnitSystem::Si,
        title,
        model,
        experiment,
        coarser_mesh: None,
        sensors,
        row_names,
        first_number: 0,
        inputs,
        reads: Default::default(),
        identify,
        sensitivities: None,
        modes: None,
        respond_hz,
    }
}

/// K_q of K(p) = Σ_q p^q K_q, as `at` of a matrix in a case file, from the matrix at several values p of a dimension.
///
/// # Errors
/// [`InputError`]: values or powers that are too few, too many or twice, matrices of different size, or one that does not fit the others.
pub fn powers_of_arrays(
    samples: &[(f64, SymmetricMatrix)],
    powers: Option<Vec<i32>>,
) -> Result<Vec<(i32, SymmetricMatrix)>, InputError> {
    let place = argument("matrices");
    if let Some(powers) = powers.as_ref().filter(|powers| !are_powers(powers)) {
        return Err(InputError::at(&argument("powers"), expected_powers(), format!("{powers:?}")));
    }
    let values: Vec<f64> = samples.iter().map(|(value, _)| *value).collect();
    check_values(&values, &place, powers.as_deref())?;
    let dim = samples[0].1.dim();
    if let Some((value, other)) = samples.iter().find(|(_, matrix)| matrix.dim() != dim) {
        let expected = format!("matrices of {dim} rows, as at {}", values[0]);
        return Err(InputError::at(&place, expected, format!("{} at {value}", other.dim())));
    }
    let powers = powers.map(|value| Located { value, place: argument("powers") });
    polynomial(samples, powers.as_ref(), &Located { value: "the dimension".to_owned(), place })
}

/// An argument, in the words of an error.
fn argument(name: &str) -> Place {
    Place::option(name)
}

/// A row by its index.
fn row(row: usize) -> String {
    format!("row {row}")
}

fn inside(place: &Place, row: usize, dim: usize) -> Result<(), InputError> {
    match row < dim {
        true => Ok(()),
        false => Err(InputError::at(&place.below("row"), format!("0 to {}", dim - 1), row.to_string())),
    }
}

fn experiment(
    model: &DynamicStiffness,
    load: Vec<c64>,
    sensors: Vec<Sensor>,
) -> Result<Experiment, InputError> {
    let place = argument("load");
    if load.len() != model.dim() {
        let expected = format!("{} values, one for each row", model.dim());
        return Err(InputError::at(&place, expected, load.len().to_string()));
    }
    if let Some(value) = load.iter().find(|value| !value.is_finite()) {
        return Err(InputError::at(&place, "finite values", value.to_string()));
    }
    if load.iter().all(|value| value.norm() == 0.0) {
        return Err(InputError::at(&place, "a load that is not zero in every row", "zeros only"));
    }
    Ok(Experiment { load, sensors })
}

fn measurement(measured: MeasuredFrf, k: usize, dim: usize) -> Result<Measurement, InputError> {
    let name = measurement_argument(k);
    let place = argument(&name);
    inside(&place, measured.sensor.row, dim)?;
    measured.check(&name)?;
    let (scale, delay_s) = (measured.scale.unwrap_or(1.0), measured.delay_s.unwrap_or(0.0));
    let info = SensorInfo {
        label: row(measured.sensor.row),
        quantity: measured.quantity,
        file: None::<PathBuf>,
        elsewhere: None,
    };
    let file = NamedFile::closed_at(Path::new(&name), argument("measurements"));
    let MeasuredFrf { sensor, frf, averages, window, record_s, .. } = measured;
    let decay = Some(Decay { per_s: frf.decay_per_s.unwrap_or(0.0), place: place.below("decay_per_s") });
    let window = window.map(|value| Located { value, place: place.below("window") });
    let curve = Curve { frf, scale, delay_s, averages, window, record_s, file };
    Ok(Measurement { sensor, info, curve: Some(curve), decay })
}

/// What the readers of files make sure of.
fn check_frf(frf: &Frf) -> Result<(), FormatError> {
    let refuse = |expected: &str, found: String| Err(FormatError::whole(expected, found));
    let points = frf.frequency_hz.len();
    if points == 0 {
        return refuse("at least one frequency", "none".into());
    }
    let lengths = [
        ("response", Some(frf.response.len())),
        ("coherence", frf.coherence.as_ref().map(Vec::len)),
        ("std", frf.std.as_ref().map(Vec::len)),
    ];
    for (name, length) in lengths {
        if let Some(length) = length.filter(|&length| length != points) {
            return refuse(
                &format!("one value of {name} for each of {points} frequencies"),
                length.to_string(),
            );
        }
    }
    let mut last = -1.0;
    for &f in &frf.frequency_hz {
        // Written so that NaN fails too.
        if !(f.is_finite() && f >= 0.0 && f > last) {
            return refuse("frequencies in Hz, finite, not negative, strictly ascending", f.to_string());
        }
        last = f;
    }
    if let Some(value) = frf.response.iter().find(|value| !value.is_finite()) {
        return refuse("finite responses", value.to_string());
    }
    let coherence = frf.coherence.iter().flatten();
    if let Some(value) = coherence.clone().find(|value| !(0.0..=1.0).contains(*value)) {
        return refuse("coherences from 0 to 1", value.to_string());
    }
    let deviation = |value: &&f64| !(value.is_finite() && **value >= 0.0);
    match frf.std.iter().flatten().find(deviation) {
        Some(value) => refuse("standard deviations that are finite and not negative", value.to_string()),
        None => Ok(()),
    }
}

/// Refuses a factor without a finite value at one of the frequencies.
fn covers(model: &DynamicStiffness, frequency_hz: &[f64]) -> Result<(), InputError> {
    for term in model.terms() {
        let place = argument(&format!("matrix {:?}", term.name)).below("factor");
        super::factor::covers(&term.factor, &place, frequency_hz)?;
    }
    Ok(())
}

/// What a case file would say.
fn entry_of(model: &DynamicStiffness, wanted: &Wanted) -> Result<IdentifyEntry, ArraysError> {
    let band_hz = wanted.band_hz.unwrap_or([0.0, f64::MAX]);
    checked_band(band_hz, &argument("band_hz"))?;
    let exclude = |&[low, high]: &[f64; 2]| match low == high {
        true => Exclusion::Line(low),
        false => Exclusion::Band([low, high]),
    };
    let of_single = [
        ("method", wanted.method.is_some()),
        ("order", wanted.order.is_some()),
        ("selection", wanted.selection.is_some()),
        ("reduction", wanted.reduction.is_some()),
        ("start", wanted.start_at_bounds),
    ];
    let of_single = of_single.into_iter().find(|(_, given)| *given);
    let order = wanted.order.map(|order| i64::try_from(order).unwrap_or(i64::MAX));
    Ok(IdentifyEntry {
        place: argument("unknowns"),
        unknowns: wanted.unknowns.iter().map(|one| unknown_of(model, one)).collect::<Result<_, _>>()?,
        band_hz: Some(Located { value: band_hz, place: argument("band_hz") }),
        exclude: Located {
            value: wanted.exclude_hz.iter().map(exclude).collect(),
            place: argument("exclude_hz"),
        },
        max_lines: wanted.max_lines.map(|value| Located { value, place: argument("max_lines") }),
        reject_outliers: wanted.reject_outliers,
        check: wanted.check,
        method: chosen(wanted.method.as_deref(), argument("method"))?.map(|method| method.value),
        order: order.map(|value| Located { value, place: argument("order") }),
        selection: chosen(wanted.selection.as_deref(), argument("selection"))?,
        reduction: chosen(wanted.reduction.as_deref(), argument("reduction"))?.map(|word| word.value),
        start: wanted.start_at_bounds.then(|| argument("start")),
        of_single: of_single.map(|(name, _)| argument(name)),
    })
}

fn unknown_of(model: &DynamicStiffness, wanted: &WantedUnknown) -> Result<UnknownEntry, ArraysError> {
    let named = |name: &String| Located { value: name.clone(), place: argument("matrix") };
    let powers: Vec<_> = wanted.powers.iter().map(|(name, power)| (named(name), *power)).collect();
    let is_dimension = !powers.is_empty();
    let names: Vec<&str> = match is_dimension {
        true => powers.iter().map(|(name, _)| name.value.as_str()).collect(),
        false => wanted.matrices.iter().map(String::as_str).collect(),
    };
    Parameter::factor_of(model, &names).map_err(ArraysError::Model)?;
    wanted.bounds.validate().map_err(ArraysError::Bounds)?;
    let place = argument("unknowns").below("nominal");
    let nominal = match wanted.nominal.filter(|nominal| nominal.is_finite()) {
        _ if !is_dimension => None,
        Some(value) => Some(Located { value, place }),
        None => {
            let found = wanted.nominal.map_or("none".to_owned(), |nominal| nominal.to_string());
            return Err(InputError::at(&place, "a dimension other than 0", found).into());
        }
    };
    let bound = |name: &str, bound: Option<[f64; 2]>| {
        bound.map(|value| Located { value, place: argument("bounds").below(name) })
    };
    let name = wanted.name.clone().unwrap_or_else(|| wanted.matrices.join(", "));
    Ok(UnknownEntry {
        place: argument("unknowns"),
        name: Located { value: name, place: argument("name") },
        matrices: wanted.matrices.iter().filter(|_| !is_dimension).map(named).collect(),
        powers,
        varies: varies(wanted)?,
        real: wanted.real,
        nominal,
        storage: bound("storage", wanted.bounds.storage),
        loss_factor: bound("loss_factor", wanted.bounds.loss_factor),
        reference: None,
    })
}

/// What `varies` and the laws say together.
fn varies(wanted: &WantedUnknown) -> Result<Located<Variation>, InputError> {
    let usual = if wanted.powers.is_empty() { Variation::PerFrequency } else { Variation::Constant };
    let (place, law) = (argument("varies"), argument("law"));
    let asked = match &wanted.varies {
        None => None,
        Some(word) => {
            Some(variation(word).map_err(|expected| InputError::at(&place, expected, format!("{word:?}")))?)
        }
    };
    if wanted.laws.is_empty() {
        return Ok(Located { value: asked.unwrap_or(usual), place });
    }
    if let (Some(Variation::PerFrequency | Variation::Smooth | Variation::Constant), Some(word)) =
        (asked, &wanted.varies)
    {
        return Err(InputError::at(&law, "varies = \"law\" beside it", format!("varies = {word:?}")));
    }
    let twice = |(k, kind): &(usize, &LawKind)| wanted.laws[..*k].contains(kind);
    if let Some((_, kind)) = wanted.laws.iter().enumerate().find(twice) {
        return Err(InputError::at(&law, "each law once", format!("{:?} a second time", kind.to_string())));
    }
    let place = if wanted.varies.is_some() { place } else { law };
    Ok(Located { value: Variation::Law(wanted.laws.clone()), place })
}
