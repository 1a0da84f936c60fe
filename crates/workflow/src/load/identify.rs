//! What is unknown, how to find it, and the measurement to find it from.

use super::Overrides;
use super::band::band;
use super::factor::law;
use super::files::Files;
use super::lines::unused;
use super::measurement::Measurement;
use crate::case::{Calibration, CaseFile, IdentifyEntry, Located, MatrixEntry, checked_band};
use crate::error::{InputError, Place};
use crate::nearest::nearest;
use crate::units::FactorUnit;
use frfit::c64;
use frfit::identify::{
    ChannelUnknowns, Method, Options, OptionsError, Reduction, Selection, Unknown, Variation,
};
use frfit::material::Law;
use frfit::model::{DynamicStiffness, FactorStd, Parameter, Role};
use frfit::roots::{Bounds, BoundsError};

/// An identification, everything checked.
#[derive(Debug)]
pub struct IdentifyCase {
    /// What is unknown; at least one.
    pub unknowns: Vec<Unknown>,
    /// What each is a number of.
    pub units: Vec<FactorUnit>,
    /// What a simulated measurement was made with, for each.
    pub reference: Vec<Option<Law>>,
    /// How to find them.
    pub options: Options,
    /// First and last frequency of the band as it was asked for.
    pub band_hz: [f64; 2],
    /// The measured frequencies in it, ascending; at least one.
    pub frequency_hz: Vec<f64>,
    /// Measured receptance in m/N, `[frequency][sensor]`.
    pub measured: Vec<Vec<c64>>,
    /// Which of the frequencies are left out: their rows have the status `out_of_band`.
    pub left_out: Vec<bool>,
    /// What of each sensor's channel is to be found: its receptances are those of scale one and no delay.
    pub channels: Vec<ChannelUnknowns>,
    /// How well the receptances were measured.
    pub noise: MeasuredNoise,
    /// When to look for what is wrong with the data.
    pub check: Check,
}

/// When to look for what is wrong with the data.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Check {
    /// Before anything is identified.
    First,
    /// Where the band is not explained: several unknowns need a reduced model each to look for faults.
    IfUnexplained,
    /// Not at all.
    Never,
}

impl IdentifyCase {
    /// Names of the matrices that the j-th unknown enters.
    pub fn matrices<'m>(&self, model: &'m DynamicStiffness, j: usize) -> Vec<&'m str> {
        self.unknowns[j].dependence.terms().map(|term| model.terms()[term].name.as_str()).collect()
    }

    /// What columns of the j-th unknown begin with: its name and a point, or nothing where it is the only one.
    pub fn prefix(&self, j: usize) -> String {
        if self.unknowns.len() == 1 { String::new() } else { format!("{}.", self.unknowns[j].name) }
    }

    /// The word of the case file for how the j-th unknown varies.
    pub fn varies(&self, j: usize) -> &'static str {
        match self.unknowns[j].varies {
            Variation::Smooth => "smooth",
            Variation::Constant => "constant",
            Variation::Law(_) => "law",
            _ => "frequency",
        }
    }

    /// Whether numbers of the j-th unknown hold for the whole band: a constant or a law.
    pub fn holds_for_band(&self, j: usize) -> bool {
        matches!(self.unknowns[j].varies, Variation::Constant | Variation::Law(_))
    }

    /// Whether a factor that varies is the only unknown: it is found with all its solutions.
    pub fn is_single(&self) -> bool {
        is_single(&self.unknowns)
    }

    /// Whether laws are fitted to a single unknown.
    pub fn is_law(&self) -> bool {
        matches!(self.unknowns[..], [Unknown { varies: Variation::Law(_), .. }])
    }

    /// Lines that are used.
    pub fn used(&self) -> usize {
        self.left_out.iter().filter(|&&out| !out).count()
    }
}

/// See [`IdentifyCase::is_single`].
pub(super) fn is_single(unknowns: &[Unknown]) -> bool {
    matches!(unknowns, [only] if only.varies != Variation::Constant && only.parameter().is_some())
}

/// Standard deviations √E|δx|² of the measured receptances, `[frequency][sensor]`, as far as files and case tell.
#[derive(Debug, Clone, PartialEq)]
pub enum MeasuredNoise {
    /// Not for all sensors.
    Unknown,
    /// From the coherence of all of them as if it were of one average: the number of averages is not told of all.
    Relative(Vec<Vec<f64>>),
    /// Of all of them: given, or from the coherence and the number of averages.
    Known(Vec<Vec<f64>>),
}

/// Puts the identification of a case together.
pub(super) fn identify(
    case: &CaseFile,
    overrides: &Overrides,
    model: &DynamicStiffness,
    measurements: &[Measurement],
    files: &mut Files,
) -> Result<IdentifyCase, InputError> {
    let Some(entry) = &case.identify else {
        return Err(InputError::at(&Place::file(&case.file), "a table [identify]", "none"));
    };
    known_names(case, &entry.matrices)?;
    let mut options = options(entry, overrides)?;
    options.model_errors = case.model_error;
    let varies = entry.varies.as_ref().map(|varies| varies.value.clone()).unwrap_or_default();
    let varies = Variation::from(varies);
    if let Some(Located { place, .. }) = &entry.varies {
        fit_for_band(&mut options, &varies, entry.real, place)?;
    }
    let bounds = bounds(entry)?;
    let mut parameter = shared_factor(&entry.matrices, model, &entry.place)?;
    if let Some(place) = &entry.start {
        parameter.nominal = middle_of(&bounds, place)?;
    }
    let (band_hz, place) = band_of(entry.band_hz.as_ref(), &entry.place, overrides)?;
    let reference = entry.reference.as_ref().map(|reference| law(reference, files)).transpose()?;
    let channels = unknown(case, &varies, &options)?;
    let data = band(measurements, model.decay_per_s(), band_hz, &place)?;
    let most = entry.max_lines.as_ref();
    let left_out = unused(&data, &entry.exclude, most, &entry.place.below("exclude_hz"))?;
    let unit = factor_unit(case, &entry.matrices, &parameter.nominal, &data.frequency_hz);
    let unknowns = vec![Unknown { bounds, real: entry.real, ..factor_of(&parameter, model, &varies) }];
    known_have_std(model, &unknowns, place_of_std(case))?;
    Ok(IdentifyCase {
        unknowns,
        units: vec![unit],
        reference: vec![reference],
        options,
        band_hz,
        frequency_hz: data.frequency_hz,
        measured: data.measured,
        left_out,
        channels,
        noise: data.noise,
        check: if entry.check { Check::First } else { Check::Never },
    })
}

/// The common factor of a parameter's matrices as an unknown.
pub(super) fn factor_of(parameter: &Parameter, model: &DynamicStiffness, varies: &Variation) -> Unknown {
    let members = parameter.members.iter();
    let names: Vec<&str> = members.map(|member| model.terms()[member.term].name.as_str()).collect();
    Unknown { name: names.join(", "), varies: varies.clone(), ..Unknown::of_parameter(parameter) }
}

/// What the case says of the factor beforehand.
fn bounds(entry: &IdentifyEntry) -> Result<Bounds, InputError> {
    let of = |bound: &Option<Located<[f64; 2]>>| bound.as_ref().map(|bound| bound.value);
    let bounds = Bounds { storage: of(&entry.storage), loss_factor: of(&entry.loss_factor) };
    bounds.validate().map_err(|BoundsError { name, found: [low, high], .. }| {
        let bound = if name == "storage" { &entry.storage } else { &entry.loss_factor };
        let place = bound.as_ref().map_or(entry.place.below("bounds"), |bound| bound.place.clone());
        InputError::at(&place, BoundsError::EXPECTED, format!("[{low}, {high}]"))
    })?;
    Ok(bounds)
}

/// What the factor of some matrices is a number of.
pub(super) fn factor_unit(
    case: &CaseFile,
    named: &[Located<String>],
    nominal: &Law,
    frequency_hz: &[f64],
) -> FactorUnit {
    let own = |entry: &&MatrixEntry| named.iter().any(|name| name.value == entry.name.value);
    let mut entries = case.matrices.iter().filter(own);
    let role = entries.clone().next().map_or(Role::Stiffness, |entry| entry.role);
    let is_modulus = entries.find_map(|entry| entry.factor_is_modulus);
    FactorUnit::of(role, is_modulus, nominal, frequency_hz, case.units)
}

/// Refuses a standard deviation of a factor that is unknown: bounds limit it. `place` is where that of a matrix stands.
pub(super) fn known_have_std(
    model: &DynamicStiffness,
    unknowns: &[Unknown],
    place: impl Fn(&str) -> Place,
) -> Result<(), InputError> {
    let has_std = |&term: &usize| model.factor_std(term) != FactorStd::default();
    match unknowns.iter().flat_map(|one| one.dependence.terms()).find(has_std) {
        None => Ok(()),
        Some(term) => {
            let name = &model.terms()[term].name;
            let found = format!("one of {name:?}, which is unknown");
            Err(InputError::at(&place(name), "a standard deviation of a known factor", found))
        }
    }
}

/// Where the standard deviation of a matrix stands in a case.
pub(super) fn place_of_std<'c>(case: &'c CaseFile) -> impl Fn(&str) -> Place + 'c {
    |name| {
        let entry = case.matrices.iter().find(|entry| entry.name.value == name);
        let std = entry.and_then(|entry| entry.factor_std.as_ref());
        std.map_or_else(|| Place::file(&case.file), |std| std.place.clone())
    }
}

/// The names, each of them a matrix's, each once.
pub(super) fn known_names(case: &CaseFile, named: &[Located<String>]) -> Result<Vec<String>, InputError> {
    let known = || case.matrices.iter().map(|matrix| matrix.name.value.as_str());
    let mut names: Vec<String> = Vec::with_capacity(named.len());
    for Located { value, place } in named {
        if !known().any(|name| name == value) {
            let all = known().map(|name| format!("{name:?}")).collect::<Vec<_>>().join(", ");
            let hint =
                nearest(value, known()).map_or(String::new(), |name| format!("; did you mean {name:?}?"));
            return Err(InputError::at(
                place,
                format!("a matrix of the case ({all})"),
                format!("{value:?}{hint}"),
            ));
        }
        if names.contains(value) {
            return Err(InputError::at(place, "each matrix once", format!("{value:?} a second time")));
        }
        names.push(value.clone());
    }
    Ok(names)
}

pub(super) fn shared_factor(
    named: &[Located<String>],
    model: &DynamicStiffness,
    place: &Place,
) -> Result<Parameter, InputError> {
    let words: Vec<&str> = named.iter().map(|name| name.value.as_str()).collect();
    let parameter = Parameter::factor_of(model, &words)
        .map_err(|error| InputError::at(place, "names of matrices", error.to_string()))?;
    for (k, name) in named.iter().enumerate() {
        shared(model, &parameter, k, &words, &name.place)?;
    }
    Ok(parameter)
}

/// Refuses a name (the k-th) whose matrix has another factor than the parameter.
pub(super) fn shared(
    model: &DynamicStiffness,
    parameter: &Parameter,
    k: usize,
    names: &[impl AsRef<str>],
    place: &Place,
) -> Result<(), InputError> {
    if model.terms()[parameter.members[k].term].factor == parameter.nominal {
        return Ok(());
    }
    let expected = format!("matrices with one factor, that of {:?}", names[0].as_ref());
    Err(InputError::at(place, expected, format!("{:?} with another", names[k].as_ref())))
}

/// `start = "bounds"`: where the bounds are, without any other word of the user. The factor is looked for in all of them.
pub(super) fn middle_of(bounds: &Bounds, place: &Place) -> Result<Law, InputError> {
    let [low, high] = match bounds.storage {
        Some([low, high]) if low > 0.0 => [low, high],
        Some([low, high]) => {
            let expected = "bounds.storage above zero, to begin in the middle of";
            return Err(InputError::at(place, expected, format!("[{low}, {high}]")));
        }
        None => {
            return Err(InputError::at(place, "the key bounds.storage, to begin in the middle of", "none"));
        }
    };
    let loss_factor = bounds.loss_factor.map_or(0.0, |[low, high]| SMALL_LOSS.clamp(low, high));
    Ok(Law::complex_modulus((low * high).sqrt(), loss_factor))
}

/// The loss factor that an estimate begins with, where the bounds allow it: between metals and rubber.
const SMALL_LOSS: f64 = 0.01;

/// The case's options, those of the command line in their place.
fn options(entry: &IdentifyEntry, overrides: &Overrides) -> Result<Options, InputError> {
    let mut options = Options::default();
    options.method = entry.method.unwrap_or(options.method);
    options.reduction = entry.reduction.unwrap_or(options.reduction);
    options.reject_outliers = entry.reject_outliers.unwrap_or(options.reject_outliers);
    options.whole_box = entry.start.is_some();
    if let Some(order) = &entry.order {
        let negative = |_| InputError::at(&order.place, ORDERS, order.value.to_string());
        options.order = usize::try_from(order.value).map_err(negative)?;
    }
    options.order = overrides.order.unwrap_or(options.order);
    let refuse = |option: &str, found: &str, expected: &str| {
        InputError::at(&Place::option(option), expected, format!("{found:?}"))
    };
    if let Some(word) = &overrides.method {
        options.method = word.parse::<Method>().map_err(|error| refuse("--method", word, error.expected))?;
    }
    if let Some(word) = &overrides.reduction {
        options.reduction =
            word.parse::<Reduction>().map_err(|error| refuse("--reduction", word, error.expected))?;
    }
    // Only the rational method has several roots to select from jointly.
    let usual = if options.method == Method::Rational { Selection::Joint } else { Selection::Smallest };
    options.selection = entry.selection.as_ref().map_or(usual, |selection| selection.value);
    if let Some(word) = &overrides.selection {
        let selection = word.parse::<Selection>();
        options.selection = selection.map_err(|error| refuse("--selection", word, error.expected))?;
    } else if overrides.method.is_some() && options.method != Method::Rational {
        // A method from the command line brings its own selection.
        options.selection = usual;
    }
    options.validate().map_err(|error| invalid(&error, entry, overrides))?;
    Ok(options)
}

const ORDERS: &str = "1 to 200";

/// Laws and smooth moduli are fitted on the subspace of a joint selection, and laws are laws of a complex modulus.
pub(super) fn fit_for_band(
    options: &mut Options,
    varies: &Variation,
    is_real: bool,
    place: &Place,
) -> Result<(), InputError> {
    match varies {
        Variation::Smooth => options.reduction = reduction_of_band(options, "smooth", place)?,
        Variation::Law(_) => {
            options.reduction = reduction_of_band(options, "law", place)?;
            if is_real {
                let found = "\"law\" with real = true";
                return Err(InputError::at(place, "\"frequency\" or \"smooth\" for a real factor", found));
            }
        }
        _ => {}
    }
    Ok(())
}

fn reduction_of_band(options: &Options, word: &str, varies: &Place) -> Result<Reduction, InputError> {
    let refuse = |expected: &str, found: String| Err(InputError::at(varies, expected, found));
    if options.selection != Selection::Joint {
        let found = format!("{word:?} with selection {:?}", options.selection.name());
        return refuse("\"frequency\", or selection = \"joint\"", found);
    }
    if options.reduction == Reduction::Full {
        return refuse(
            "\"frequency\", or the reduction \"subspace\"",
            format!("{word:?} with reduction \"full\""),
        );
    }
    Ok(Reduction::Subspace)
}

/// The key or the option that an invalid option comes from.
fn invalid(error: &OptionsError, entry: &IdentifyEntry, overrides: &Overrides) -> InputError {
    let of_key = |name: &str| entry.place.below(name);
    match error {
        OptionsError::Order(order) => {
            let written = entry.order.as_ref().map_or(of_key("order"), |order| order.place.clone());
            let place = overrides.order.map_or(written, |_| Place::option("--order"));
            InputError::at(&place, ORDERS, order.to_string())
        }
        OptionsError::Selection(method) => {
            let written = entry.selection.as_ref().map_or(of_key("selection"), |s| s.place.clone());
            let place = overrides.selection.as_ref().map_or(written, |_| Place::option("--selection"));
            InputError::at(&place, format!("\"smallest\" with method {:?}", method.name()), "\"joint\"")
        }
        OptionsError::ErrorSize(name, size) => {
            InputError::at(&of_key(name), "a number above 0 up to 0.5", size.to_string())
        }
        OptionsError::Error(limit) => {
            InputError::at(&of_key("error"), "a positive number", limit.to_string())
        }
        other => InputError::at(&entry.place, "other options", other.to_string()),
    }
}

/// What of each sensor's channel is unknown, where that can be found.
fn unknown(
    case: &CaseFile,
    varies: &Variation,
    options: &Options,
) -> Result<Vec<ChannelUnknowns>, InputError> {
    let (unknown, first) = channels_of(case);
    if let Some(first) = first {
        can_be_found(&unknown, &first, varies, options)?;
    }
    Ok(unknown)
}

/// What of each sensor's channel is unknown, and where the case first says so.
pub(super) fn channels_of(case: &CaseFile) -> (Vec<ChannelUnknowns>, Option<Place>) {
    let looked_for = |entry: &Option<Located<Calibration>>| {
        entry.as_ref().filter(|entry| entry.value == Calibration::Unknown).map(|entry| entry.place.clone())
    };
    let mut unknown = Vec::with_capacity(case.measurements.len());
    let mut places = Vec::new();
    for measurement in &case.measurements {
        let [scale, delay] = [&measurement.scale, &measurement.delay_s].map(looked_for);
        unknown.push(ChannelUnknowns { scale: scale.is_some(), delay: delay.is_some() });
        places.extend(scale.into_iter().chain(delay));
    }
    (unknown, places.into_iter().next())
}

/// Refuses unknown scales and delays (the first of them at `first`) where they cannot be found.
pub(super) fn can_be_found(
    unknown: &[ChannelUnknowns],
    first: &Place,
    varies: &Variation,
    options: &Options,
) -> Result<(), InputError> {
    let refuse = |expected: &str, found: &str| Err(InputError::at(first, expected, found));
    if options.selection != Selection::Joint {
        let found = format!("\"unknown\" with selection {:?}", options.selection.name());
        return refuse("a number, or selection = \"joint\"", &found);
    }
    if options.reduction == Reduction::Full {
        return refuse("a number, or the reduction \"subspace\"", "\"unknown\" with reduction \"full\"");
    }
    if *varies == Variation::Smooth {
        return refuse(
            "a number, or varies = \"frequency\" or \"law\"",
            "\"unknown\" with varies \"smooth\"",
        );
    }
    if *varies == Variation::PerFrequency { one_is_calibrated(unknown, first) } else { Ok(()) }
}

/// Refuses unknown scales or delays of all sensors (the first of them at `first`), beside factors that each frequency has of its own.
pub(super) fn one_is_calibrated(unknown: &[ChannelUnknowns], first: &Place) -> Result<(), InputError> {
    if unknown.iter().all(|unknown| unknown.any()) {
        let expected = "a number here, another [[measurement]] whose scale and delay are known, or varies = \"law\" \
                        (a factor of its own at each frequency explains one sensor whatever its scale and delay)";
        return Err(InputError::at(first, expected, "\"unknown\" for all sensors"));
    }
    Ok(())
}

/// The band, and the key or the option that it comes from.
pub(super) fn band_of(
    written: Option<&Located<[f64; 2]>>,
    table: &Place,
    overrides: &Overrides,
) -> Result<([f64; 2], Place), InputError> {
    if let Some(band_hz) = overrides.band_hz {
        let place = Place::option("--band");
        checked_band(band_hz, &place)?;
        return Ok((band_hz, place));
    }
    match written {
        Some(band) => Ok((band.value, band.place.clone())),
        None => Err(InputError::at(table, "the key \"band_hz\"", "none")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_orders_named_are_those_allowed() {
        assert_eq!(ORDERS, format!("1 to {}", frfit::identify::MAX_ORDER));
    }
}
