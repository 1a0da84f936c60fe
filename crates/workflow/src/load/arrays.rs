//! From what a program holds in memory to a case: the same checks and conversions as for one read from files.

use super::band::band;
use super::files::NamedFile;
use super::identify::{
    Check, can_be_found, factor_of, fit_for_band, is_single, known_have_std, middle_of, one_is_calibrated,
    shared,
};
use super::lines::unused;
use super::measurement::{Curve, Decay, Measurement, common_decay};
use super::several::enough;
use super::{Case, Frf, IdentifyCase, SensorInfo};
use crate::case::{Exclusion, Located, VariesEntry as Varies, checked_band};
use crate::error::{InputError, Place};
use crate::units::{FactorUnit, UnitSystem};
use frfit::c64;
use frfit::identify::{
    ChannelUnknowns, Dependence, Method, ModelErrors, Options, OptionsError, Reduction, Selection, Unknown,
    Variation,
};
use frfit::laws::LawKind;
use frfit::material::Law;
use frfit::model::{DynamicStiffness, Experiment, ModelError, Parameter, Role, Sensor};
use frfit::quantity::Quantity;
use frfit::roots::{Bounds, BoundsError};
use frfit_formats::FormatError;
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
    /// Of more lines than this those that tell most; `None`: all.
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
    let (options, unknowns) = unknowns_of(&model, wanted)?;
    known_have_std(&model, &unknowns, |_| argument("storage_std"))?;
    if let Some(first) = unknown.iter().position(|unknown| unknown.any()) {
        let key = if unknown[first].scale { "scale" } else { "delay_s" };
        let place = argument(&format!("measurement {}", first + 1)).below(key);
        match &unknowns[..] {
            [only] if is_single(&unknowns) => can_be_found(&unknown, &place, &only.varies, &options)?,
            all if all.iter().all(|one| one.varies == Variation::PerFrequency) => {
                one_is_calibrated(&unknown, &place)?
            }
            _ => {}
        }
    }
    let place = argument("band_hz");
    let band_hz = wanted.band_hz.unwrap_or([0.0, f64::MAX]);
    checked_band(band_hz, &place)?;
    let data = band(&measurements, decay_per_s, band_hz, &place)?;
    let out: Vec<Exclusion> = wanted.exclude_hz.iter().map(|&band| exclude(band)).collect();
    let most = wanted.max_lines.map(|value| Located { value, place: argument("max_lines") });
    let left_out = unused(&data, &out, most.as_ref(), &argument("exclude_hz"))?;
    covers(&model, &data.frequency_hz)?;
    let first_and_last = [data.frequency_hz.first(), data.frequency_hz.last()].map(|f| f.copied());
    let check = match &unknowns[..] {
        _ if !wanted.check => Check::Never,
        _ if is_single(&unknowns) => Check::First,
        _ => {
            let used = left_out.iter().filter(|&&out| !out).count();
            enough(&argument("unknowns"), &unknowns, &unknown, (used, measurements.len()))?;
            Check::IfUnexplained
        }
    };
    let unit = |one: &Unknown| match &one.dependence {
        Dependence::Factor(terms) => {
            let role = terms.first().map_or(Role::Stiffness, |&term| model.terms()[term].role);
            FactorUnit::of(role, None, &one.nominal, &data.frequency_hz, UnitSystem::Si)
        }
        Dependence::Powers(_) => FactorUnit::Other,
    };
    let identify = IdentifyCase {
        units: unknowns.iter().map(unit).collect(),
        reference: vec![None; unknowns.len()],
        unknowns,
        options,
        band_hz: wanted.band_hz.unwrap_or(first_and_last.map(|f| f.unwrap_or(0.0))),
        frequency_hz: data.frequency_hz,
        measured: data.measured,
        left_out,
        channels: unknown,
        noise: data.noise,
        check,
    };
    let respond_hz = identify.frequency_hz.clone();
    let sensors = measurements.into_iter().map(|measurement| measurement.info).collect();
    Ok(case(model, experiment, sensors, Some(identify), respond_hz))
}

/// A case whose response at its nominal factors is asked for.
///
/// # Errors
/// A load or a sensor outside the model, a frequency that is none or that a factor's table does not reach.
pub fn response_of_arrays(
    model: Arc<DynamicStiffness>,
    load: Vec<c64>,
    sensors: Vec<Sensor>,
    quantity: Quantity,
    frequency_hz: Vec<f64>,
) -> Result<Case, InputError> {
    for (k, sensor) in sensors.iter().enumerate() {
        inside(&argument(&format!("sensor {}", k + 1)), sensor.row, model.dim())?;
    }
    let experiment = experiment(&model, load, sensors)?;
    if let Some(f) = frequency_hz.iter().find(|f| !(f.is_finite() && **f >= 0.0)) {
        let expected = "finite frequencies in Hz that are not negative";
        return Err(InputError::at(&argument("frequency_hz"), expected, f.to_string()));
    }
    covers(&model, &frequency_hz)?;
    let label = |sensor: &Sensor| SensorInfo { label: row(sensor.row), quantity, file: None };
    let labels = experiment.sensors.iter().map(label).collect();
    Ok(case(model, experiment, labels, None, frequency_hz))
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
        units: UnitSystem::Si,
        title,
        model,
        experiment,
        coarser_mesh: None,
        sensors,
        row_names,
        inputs,
        reads: Default::default(),
        identify,
        sensitivities: None,
        respond_hz,
    }
}

/// An argument, in the words of an error.
fn argument(name: &str) -> Place {
    Place::option(name)
}

fn row(row: usize) -> String {
    format!("row {}", row + 1)
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

fn exclude([low, high]: [f64; 2]) -> Exclusion {
    if low == high { Exclusion::Line(low) } else { Exclusion::Band([low, high]) }
}

fn measurement(measured: MeasuredFrf, k: usize, dim: usize) -> Result<Measurement, InputError> {
    let name = format!("measurement {}", k + 1);
    let place = argument(&name);
    inside(&place, measured.sensor.row, dim)?;
    measured.check(&name)?;
    let (scale, delay_s) = (measured.scale.unwrap_or(1.0), measured.delay_s.unwrap_or(0.0));
    let info =
        SensorInfo { label: row(measured.sensor.row), quantity: measured.quantity, file: None::<PathBuf> };
    let file = NamedFile::closed_at(Path::new(&name), argument("measurements"));
    let MeasuredFrf { sensor, frf, averages, .. } = measured;
    let decay = Some(Decay { per_s: frf.decay_per_s.unwrap_or(0.0), place: place.below("decay_per_s") });
    Ok(Measurement { sensor, info, curve: Some(Curve { frf, scale, delay_s, averages, file }), decay })
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

/// The unknowns, and how to find them.
fn unknowns_of(model: &DynamicStiffness, wanted: &Wanted) -> Result<(Options, Vec<Unknown>), ArraysError> {
    if let [only] = &wanted.unknowns[..]
        && only.powers.is_empty()
        && variation(only)? != Variation::Constant
    {
        let (mut options, varies) = (options(wanted, only)?, variation(only)?);
        let place = argument(if only.varies.is_some() { "varies" } else { "law" });
        fit_for_band(&mut options, &varies, only.real, &place)?;
        let mut parameter = parameter(model, &only.matrices)?;
        if wanted.start_at_bounds {
            parameter.nominal = middle_of(&only.bounds, &argument("nominal"))?;
        }
        let unknown = factor_of(&parameter, model, &varies);
        let name = only.name.clone().unwrap_or_else(|| unknown.name.clone());
        return Ok((options, vec![Unknown { name, real: only.real, bounds: only.bounds, ..unknown }]));
    }
    for (name, given) in [
        ("method", wanted.method.is_some()),
        ("order", wanted.order.is_some()),
        ("selection", wanted.selection.is_some()),
        ("reduction", wanted.reduction.is_some()),
        ("start", wanted.start_at_bounds),
    ] {
        if given {
            let expected =
                "None with several unknowns, or one that does not vary: there is one way to find them";
            return Err(InputError::at(&argument(name), expected, "one").into());
        }
    }
    let options = Options::default()
        .with_model_errors(wanted.model_errors)
        .with_reject_outliers(wanted.reject_outliers.unwrap_or(true));
    let unknowns = wanted.unknowns.iter().map(|one| one_of_several(model, one));
    Ok((options, unknowns.collect::<Result<_, _>>()?))
}

/// One of several unknowns, or one that does not vary.
fn one_of_several(model: &DynamicStiffness, wanted: &WantedUnknown) -> Result<Unknown, ArraysError> {
    let (dependence, nominal) = match wanted.powers.as_slice() {
        [] => {
            let parameter = parameter(model, &wanted.matrices)?;
            (
                Dependence::Factor(parameter.members.iter().map(|member| member.term).collect()),
                parameter.nominal,
            )
        }
        powers => {
            let names: Vec<String> = powers.iter().map(|(name, _)| name.clone()).collect();
            let parameter = Parameter::factor_of(model, &words(&names)).map_err(ArraysError::Model)?;
            let terms = parameter.members.iter().map(|member| member.term);
            let nominal = wanted.nominal.filter(|nominal| nominal.is_finite() && *nominal != 0.0);
            let place = argument("unknowns").below("nominal");
            let found = wanted.nominal.map_or("none".to_owned(), |nominal| nominal.to_string());
            let nominal = nominal.ok_or_else(|| InputError::at(&place, "a dimension other than 0", found))?;
            let powers = terms.zip(powers.iter().map(|(_, power)| *power)).collect();
            (Dependence::Powers(powers), Law::Constant(c64::new(nominal, 0.0)))
        }
    };
    Ok(Unknown {
        name: wanted.name.clone().unwrap_or_else(|| wanted.matrices.join(", ")),
        dependence,
        nominal,
        varies: variation(wanted)?,
        real: wanted.real,
        bounds: wanted.bounds,
    })
}

fn words(names: &[String]) -> Vec<&str> {
    names.iter().map(String::as_str).collect()
}

/// The factor that matrices share.
fn parameter(model: &DynamicStiffness, names: &[String]) -> Result<Parameter, ArraysError> {
    let parameter = Parameter::factor_of(model, &words(names)).map_err(ArraysError::Model)?;
    let place = argument("matrix");
    for (k, name) in names.iter().enumerate() {
        if names[..k].contains(name) {
            return Err(InputError::at(&place, "each matrix once", format!("{name:?} a second time")).into());
        }
        shared(model, &parameter, k, names, &place)?;
    }
    Ok(parameter)
}

/// What `varies` and the laws say together.
fn variation(wanted: &WantedUnknown) -> Result<Variation, InputError> {
    let asked = wanted.varies.as_deref().map(|word| match word {
        "constant" => Ok(Variation::Constant),
        _ => Varies::of_word(word)
            .map(Variation::from)
            .map_err(|expected| InputError::at(&argument("varies"), expected, format!("{word:?}"))),
    });
    let asked = asked.transpose()?;
    if wanted.laws.is_empty() {
        let usual = if wanted.powers.is_empty() { Variation::PerFrequency } else { Variation::Constant };
        return Ok(asked.unwrap_or(usual));
    }
    let place = argument("law");
    if let (Some(Variation::PerFrequency | Variation::Smooth | Variation::Constant), Some(word)) =
        (asked, &wanted.varies)
    {
        return Err(InputError::at(&place, "varies = \"law\" beside it", format!("varies = {word:?}")));
    }
    let twice = |(k, family): &(usize, &LawKind)| wanted.laws[..*k].contains(family);
    if let Some((_, family)) = wanted.laws.iter().enumerate().find(twice) {
        let found = format!("{:?} a second time", family.to_string());
        return Err(InputError::at(&place, "each law once", found));
    }
    Ok(Variation::Law(wanted.laws.clone()))
}

fn options(wanted: &Wanted, only: &WantedUnknown) -> Result<Options, ArraysError> {
    let defaults = Options::default();
    let refuse = |name: &str, word: &str, expected: &str| {
        InputError::at(&argument(name), expected, format!("{word:?}"))
    };
    let method = match &wanted.method {
        Some(word) => word.parse::<Method>().map_err(|error| refuse("method", word, error.expected))?,
        None => defaults.method,
    };
    let usual = if method == Method::Rational { Selection::Joint } else { Selection::Smallest };
    let selection = match &wanted.selection {
        Some(word) => word.parse::<Selection>().map_err(|error| refuse("selection", word, error.expected))?,
        None => usual,
    };
    let reduction = match &wanted.reduction {
        Some(word) => word.parse::<Reduction>().map_err(|error| refuse("reduction", word, error.expected))?,
        None => defaults.reduction,
    };
    let options = defaults
        .with_model_errors(wanted.model_errors)
        .with_method(method)
        .with_selection(selection)
        .with_reduction(reduction)
        .with_order(wanted.order.unwrap_or(defaults.order))
        .with_reject_outliers(wanted.reject_outliers.unwrap_or(defaults.reject_outliers))
        .with_whole_box(wanted.start_at_bounds);
    only.bounds.validate().map_err(ArraysError::Bounds)?;
    options.validate().map_err(ArraysError::Options)?;
    Ok(options)
}
