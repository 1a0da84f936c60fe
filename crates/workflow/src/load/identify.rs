//! What is unknown, how to find it, and the measurement to find it from.

use super::band::{MeasuredNoise, band, unmeasured};
use super::corrections::Corrections;
use super::dimension::{PartOf, each_has_a_value};
use super::factor::{covers, law};
use super::files::Files;
use super::lines::unused;
use super::measurement::Measurement;
use super::options::{invalid, options, overridden, reduction_of_band};
use super::overrides::Overrides;
use super::unknowns::{is_single, known_have_std, unknowns};
use crate::case::{Calibration, CaseFile, IdentifyEntry, Located, MatrixEntry, RespondEntry};
use crate::error::{InputError, Place};
use crate::units::{FactorUnit, UnitSystem};
use frfit::c64;
use frfit::identify::{ChannelUnknowns, Dependence, Options, Reduction, Selection, Unknown, Variation};
use frfit::material::Law;
use frfit::model::{DynamicStiffness, Role};

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
    /// How many measured frequencies of the band are not among them, because a sensor has no value there.
    pub not_common: usize,
    /// Measured receptance in m/N, `[frequency][sensor]`.
    pub measured: Vec<Vec<c64>>,
    /// Which of the frequencies are left out: their rows have the status `out_of_band`.
    pub left_out: Vec<bool>,
    /// What of each sensor's channel is to be found: its receptances are those of scale one and no delay.
    pub channels: Vec<ChannelUnknowns>,
    /// How well the receptances were measured.
    pub noise: MeasuredNoise,
    /// What was found in the receptances.
    pub corrections: Corrections,
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

/// Puts the identification of a case together.
pub(super) fn identify(
    case: &CaseFile,
    overrides: &Overrides,
    (model, of): (&DynamicStiffness, &[PartOf]),
    measurements: &[Measurement],
    files: &mut Files,
) -> Result<IdentifyCase, InputError> {
    let Some(entry) = &case.identify else {
        return Err(InputError::at(&Place::file(&case.file), "a table [identify]", "none"));
    };
    let entry = &overridden(entry, overrides)?;
    for one in &entry.unknowns {
        case.has_matrices(one.matrices.iter().chain(one.powers.iter().map(|(name, _)| name)))?;
    }
    each_has_a_value(case)?;
    let unknowns = unknowns(entry, model, of)?;
    refuse_twice(entry)?;
    known_have_std(model, &unknowns, |name| place_of_std(case, name))?;
    let options = options(entry, case.model_error);
    options.validate().map_err(|error| invalid(&error, entry))?;
    let laws =
        entry.unknowns.iter().map(|one| one.reference.as_ref().map(|law_of| law(law_of, files)).transpose());
    let reference = laws.collect::<Result<Vec<_>, _>>()?;
    let is_modulus = |term: usize| {
        let own = |entry: &&MatrixEntry| entry.name.value == of[term].matrix;
        case.matrices.iter().find(own).and_then(|entry| entry.factor_is_modulus)
    };
    let given = Given {
        model,
        measurements,
        respond: case.respond.as_ref(),
        channels: channels_of(case),
        units: case.units,
        is_modulus: &is_modulus,
    };
    let found = put_together(entry, unknowns, options, given)?;
    for (one, law) in entry.unknowns.iter().zip(&reference) {
        if let (Some(written), Some(law)) = (&one.reference, law) {
            covers(law, &written.place, &found.frequency_hz)?;
        }
    }
    Ok(IdentifyCase { reference, ..found })
}

/// What it is identified from.
pub(super) struct Given<'a> {
    pub(super) model: &'a DynamicStiffness,
    pub(super) measurements: &'a [Measurement],
    /// The frequencies of a response, which serve where nothing was measured.
    pub(super) respond: Option<&'a RespondEntry>,
    /// What of each sensor's channel is unknown, and where that is first said.
    pub(super) channels: (Vec<ChannelUnknowns>, Option<Place>),
    pub(super) units: UnitSystem,
    /// Whether the factor of a term is a modulus, where that is said.
    pub(super) is_modulus: &'a dyn Fn(usize) -> Option<bool>,
}

/// An identification of these unknowns, without references.
pub(super) fn put_together(
    entry: &IdentifyEntry,
    unknowns: Vec<Unknown>,
    mut options: Options,
    given: Given<'_>,
) -> Result<IdentifyCase, InputError> {
    let Given { model, measurements, respond, channels: (channels, unknown_channel), .. } = given;
    let single = is_single(&unknowns);
    if single {
        options.reduction = reduction_of_band(&options, &unknowns[0], &entry.unknowns[0].varies.place)?;
    }
    if let Some(place) = unknown_channel {
        can_be_found(&channels, &place, &unknowns, &options)?;
    }
    let Some(Located { value: band_hz, place }) = &entry.band_hz else {
        return Err(InputError::at(&entry.place, "the key \"band_hz\"", "none"));
    };
    let data = match measurements.iter().all(|measurement| measurement.curve.is_some()) {
        true => band(measurements, model.decay_per_s(), *band_hz, place)?,
        false => unmeasured(respond, *band_hz, measurements.len()),
    };
    let left_out = unused(&data, &entry.exclude, entry.max_lines.as_ref())?;
    let used = left_out.iter().filter(|&&out| !out).count();
    if !single {
        enough(&entry.place, &unknowns, &channels, (used, measurements.len()))?;
    }
    let unit = |one: &Unknown| match &one.dependence {
        Dependence::Powers(_) => FactorUnit::Other,
        Dependence::Factor(terms) => {
            let mut terms = terms.clone();
            terms.sort_unstable();
            let role = terms.first().map_or(Role::Stiffness, |&term| model.terms()[term].role);
            let is_modulus = terms.into_iter().find_map(given.is_modulus);
            FactorUnit::of(role, is_modulus, &one.nominal, &data.frequency_hz, given.units)
        }
    };
    Ok(IdentifyCase {
        units: unknowns.iter().map(unit).collect(),
        reference: vec![None; unknowns.len()],
        unknowns,
        options,
        band_hz: *band_hz,
        frequency_hz: data.frequency_hz,
        not_common: data.not_common,
        measured: data.measured,
        left_out,
        channels,
        noise: data.noise,
        corrections: data.corrections,
        check: match (entry.check, single) {
            (false, _) => Check::Never,
            (true, true) => Check::First,
            (true, false) => Check::IfUnexplained,
        },
    })
}

/// Where the standard deviation of a matrix stands in a case.
fn place_of_std(case: &CaseFile, name: &str) -> Place {
    let entry = case.matrices.iter().find(|entry| entry.name.value == name);
    let std = entry.and_then(|entry| entry.factor_std.as_ref());
    std.map_or_else(|| Place::file(&case.file), |std| std.place.clone())
}

/// The factor of a matrix is one unknown.
fn refuse_twice(entry: &IdentifyEntry) -> Result<(), InputError> {
    let mut taken: Vec<(&str, &str)> = Vec::new();
    for one in &entry.unknowns {
        for name in &one.matrices {
            if let Some((_, other)) = taken.iter().find(|(other, _)| *other == name.value) {
                let found = format!("{:?}, which is in {other:?} too", name.value);
                return Err(InputError::at(&name.place, "each matrix's factor in one unknown", found));
            }
            taken.push((&name.value, &one.name.value));
        }
    }
    Ok(())
}

/// What of each sensor's channel is unknown, and where the case first says so.
fn channels_of(case: &CaseFile) -> (Vec<ChannelUnknowns>, Option<Place>) {
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
fn can_be_found(
    channels: &[ChannelUnknowns],
    first: &Place,
    unknowns: &[Unknown],
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
    if matches!(unknowns, [one] if one.varies == Variation::Smooth) {
        let expected = "a number, or varies = \"frequency\" or \"law\"";
        return refuse(expected, "\"unknown\" with varies \"smooth\"");
    }
    let all_free = unknowns.iter().all(|one| one.varies == Variation::PerFrequency);
    if all_free && channels.iter().all(|channel| channel.any()) {
        let expected = "a number here, another [[measurement]] whose scale and delay are known, or varies = \"law\" \
                        (a factor of its own at each frequency explains one sensor whatever its scale and delay)";
        return refuse(expected, "\"unknown\" for all sensors");
    }
    Ok(())
}

/// Refuses fewer measured than unknown numbers.
fn enough(
    place: &Place,
    unknowns: &[Unknown],
    channels: &[ChannelUnknowns],
    (frequencies, sensors): (usize, usize),
) -> Result<(), InputError> {
    let own: usize = unknowns.iter().map(Unknown::per_frequency).sum();
    let of_channels: usize = channels.iter().map(|channel| channel.count()).sum();
    let band = unknowns.iter().map(Unknown::for_band).sum::<usize>() + of_channels;
    let refuse = |what: String| InputError::at(place, "no more unknown than measured numbers", what);
    if own > 2 * sensors {
        let found = format!(
            "{own} unknown real numbers at each frequency, {} measured ones ({sensors} complex)",
            2 * sensors
        );
        return Err(refuse(found));
    }
    let (unknown, measured) = (own * frequencies + band, 2 * sensors * frequencies);
    if unknown > measured {
        let found = format!(
            "{unknown} unknown real numbers ({own} at each of {frequencies} frequencies, {band} for the band), {measured} measured ones"
        );
        return Err(refuse(found));
    }
    Ok(())
}
