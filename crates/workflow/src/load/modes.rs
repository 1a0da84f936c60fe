//! What the modal view takes of a case beside its model: a band, what was measured in it, and identified factors.

use super::band::{Band, MeasuredNoise, band, respond_hz};
use super::corrections::Corrections;
use super::dimension::PartOf;
use super::files::{Files, NamedFile};
use super::identify::IdentifyCase;
use super::measurement::Measurement;
use super::overrides::Overrides;
use super::table_of_unknown::table_of_unknown;
use crate::case::CaseFile;
use crate::error::{InputError, Place};
use frfit::c64;
use frfit::identify::Status;
use frfit::material::{Law, Table};
use frfit::model::{DynamicStiffness, Role, Term};
use frfit_formats::FormatError;
use frfit_formats::csv::{Table as CsvTable, read_modulus_rows};
use std::path::Path;

/// The part of a case that the modal view is about.
#[derive(Debug, Clone, PartialEq)]
pub struct ModesCase {
    /// First and last frequency.
    pub band_hz: [f64; 2],
    /// The terms of the model whose factors are unknown; all of the stiffness where the case has no unknown.
    pub unknown_terms: Vec<usize>,
    /// Whether the case has an unknown factor of a stiffness.
    pub has_unknown: bool,
    /// What was measured in it; `None` where a measurement has no file.
    pub measured: Option<MeasuredBand>,
    /// The file of the identified factors that the model has; `None`: those of the case.
    pub identified: Option<String>,
}

/// Measured receptances of a band.
#[derive(Debug, Clone, PartialEq)]
pub struct MeasuredBand {
    /// Ascending, above 0 Hz.
    pub frequency_hz: Vec<f64>,
    /// `[frequency][sensor]`, m/N.
    pub receptance: Vec<Vec<c64>>,
    /// How well they were measured.
    pub noise: MeasuredNoise,
    /// What was found in them.
    pub corrections: Corrections,
}

impl ModesCase {
    /// Of a model alone, no part of which is unknown.
    pub(crate) fn of_model(band_hz: [f64; 2], model: &DynamicStiffness) -> Self {
        let (unknown_terms, has_unknown) = unknown_or_all(model, |_| false);
        Self { band_hz, unknown_terms, has_unknown, measured: None, identified: None }
    }

    /// The same of a case that was loaded to be identified: all of its lines, also those that are left out.
    pub(crate) fn of_identification(identify: &IdentifyCase, model: &DynamicStiffness) -> Self {
        let is_unknown =
            |term: usize| identify.unknowns.iter().any(|one| one.dependence.terms().any(|own| own == term));
        let (unknown_terms, has_unknown) = unknown_or_all(model, is_unknown);
        let measured = above_zero(MeasuredBand {
            frequency_hz: identify.frequency_hz.clone(),
            receptance: identify.measured.clone(),
            noise: identify.noise.clone(),
            corrections: identify.corrections.clone(),
        });
        Self {
            band_hz: identify.band_hz,
            unknown_terms,
            has_unknown,
            measured: Some(measured),
            identified: None,
        }
    }
}

/// The band: of the command line, of `[identify]`, of `[respond]`, or all of the first measurement.
pub(super) fn modes(
    case: &CaseFile,
    overrides: &Overrides,
    (model, of): (&DynamicStiffness, &[PartOf]),
    measurements: &[Measurement],
) -> Result<ModesCase, InputError> {
    let identified = case.identify.as_ref().and_then(|entry| entry.band_hz.as_ref());
    let responded = case.respond.as_ref().map(|entry| &entry.band_hz);
    let (given, place) = match (overrides.band_hz, identified.or(responded)) {
        (None, Some(located)) => (Some(located.value), located.place.clone()),
        (given, _) => (given, Place::option("--band")),
    };
    let has_values = !measurements.is_empty() && measurements.iter().all(|one| one.curve.is_some());
    let measured = match has_values {
        true => {
            let all = band(measurements, model.decay_per_s(), given.unwrap_or([0.0, f64::MAX]), &place)?;
            let Band { frequency_hz, measured: receptance, noise, corrections, .. } = all;
            Some(above_zero(MeasuredBand { frequency_hz, receptance, noise, corrections }))
        }
        false => None,
    };
    let asked = Overrides { band_hz: given, ..overrides.clone() };
    let lines = match &measured {
        Some(measured) => measured.frequency_hz.clone(),
        None => respond_hz(case, &asked, measurements)?,
    };
    let band_hz = given.or_else(|| Some([*lines.first()?, *lines.last()?]));
    let Some(band_hz) = band_hz else {
        let expected = "a band: --band, band_hz in [identify] or [respond], or measurements with files";
        return Err(InputError::at(&Place::file(&case.file), expected, "none"));
    };
    if band_hz[1] <= 0.0 {
        let found = format!("[{}, {}]", band_hz[0], band_hz[1]);
        return Err(InputError::at(&place, "a band that reaches above 0 Hz", found));
    }
    let identified = overrides.identified.as_ref().map(|file| file.display().to_string());
    let (unknown_terms, has_unknown) = unknown_terms(case, model, of);
    Ok(ModesCase { band_hz, unknown_terms, has_unknown, measured, identified })
}

/// The terms of unknown stiffness, or of all; and whether any is unknown.
fn unknown_terms(case: &CaseFile, model: &DynamicStiffness, of: &[PartOf]) -> (Vec<usize>, bool) {
    let named: Vec<&str> =
        case.unknowns().flat_map(|one| one.matrices.iter().map(|name| name.value.as_str())).collect();
    unknown_or_all(model, |term| of.get(term).is_some_and(|part| named.contains(&part.matrix.as_str())))
}

fn unknown_or_all(model: &DynamicStiffness, is_unknown: impl Fn(usize) -> bool) -> (Vec<usize>, bool) {
    let is_stiffness = |&term: &usize| model.terms()[term].role == Role::Stiffness;
    let stiffness = (0..model.terms().len()).filter(is_stiffness);
    let unknown: Vec<usize> = stiffness.clone().filter(|&term| is_unknown(term)).collect();
    if unknown.is_empty() { (stiffness.collect(), false) } else { (unknown, true) }
}

/// A structure that nothing holds has no response at rest.
fn above_zero(band: MeasuredBand) -> MeasuredBand {
    let MeasuredBand { frequency_hz, receptance, noise, corrections } = band;
    let first = frequency_hz.partition_point(|&f| f <= 0.0);
    let noise = match noise {
        MeasuredNoise::Known(std) => MeasuredNoise::Known(std[first..].to_vec()),
        MeasuredNoise::Relative(std) => MeasuredNoise::Relative(std[first..].to_vec()),
        MeasuredNoise::Unknown => MeasuredNoise::Unknown,
    };
    MeasuredBand {
        frequency_hz: frequency_hz[first..].to_vec(),
        receptance: receptance[first..].to_vec(),
        noise,
        corrections,
    }
}

/// The unknown of a table that has the name of one of the case; `None` if table and case have a single unknown, which has no name there.
fn column<'a>(name: &'a str, unknowns: usize, file: &NamedFile) -> Result<Option<&'a str>, InputError> {
    let table = CsvTable::read(&file.bytes).map_err(|error| file.refuse(error))?;
    let others: Vec<&str> = table.names().filter_map(|column| column.strip_suffix(".storage")).collect();
    if others.contains(&name) {
        return Ok(Some(name));
    }
    if others.is_empty() && unknowns == 1 {
        return Ok(None);
    }
    let found = match others.is_empty() {
        true => "those of one unknown without a name".to_owned(),
        false => {
            format!("those of {}", others.iter().map(|one| format!("{one:?}")).collect::<Vec<_>>().join(", "))
        }
    };
    let expected = format!("columns of the unknown {name:?}, as {:?}", format!("{name}.storage"));
    Err(file.refuse(FormatError::whole(expected, found)))
}

/// Gives the terms of unknown factors those that were identified: the rows of a table of results that are ok.
pub(super) fn with_identified(
    case: &CaseFile,
    path: &Path,
    (terms, of): (&mut [Term], &[PartOf]),
    files: &mut Files,
) -> Result<(), InputError> {
    const OPTION: &str = "--identified";
    let file = files.read_option(path, OPTION)?;
    let unknowns: Vec<_> = case.unknowns().collect();
    if unknowns.is_empty() {
        let expected = "a case with [identify], which says whose factors these are";
        return Err(InputError::at(&Place::option(OPTION), expected, "none"));
    }
    for one in &unknowns {
        if one.matrices.is_empty() {
            let expected =
                "no geometric parameter among the unknowns (give the case its identified value as nominal)";
            return Err(InputError::at(&Place::option(OPTION), expected, format!("{:?}", one.name.value)));
        }
        let column = column(&one.name.value, unknowns.len(), &file)?;
        let bytes = table_of_unknown(file.bytes.to_vec(), column, path)?;
        let rows = read_modulus_rows(&bytes).map_err(|error| file.refuse(error))?;
        let is_ok = |status: &str| status.is_empty() || status == Status::Ok.name();
        let used = rows.answered.iter().filter(|row| is_ok(&row.status) && row.frequency_hz > 0.0);
        let (frequency_hz, modulus): (Vec<f64>, Vec<c64>) =
            used.map(|row| (row.frequency_hz, row.storage * c64::new(1.0, row.loss_factor))).unzip();
        let table = Table::new(frequency_hz, modulus)
            .map_err(|_| file.refuse(FormatError::whole("a row that is ok, above 0 Hz", "none")))?;
        let named = |term: usize| {
            of.get(term).is_some_and(|part| one.matrices.iter().any(|m| m.value == part.matrix))
        };
        for (_, term) in terms.iter_mut().enumerate().filter(|(index, _)| named(*index)) {
            term.factor = Law::Table(table.clone());
        }
    }
    Ok(())
}
