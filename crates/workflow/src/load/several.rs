//! Several unknowns, and the measurement to find them from.

use super::Overrides;
use super::band::band;
use super::dimension::{PartOf, each_has_a_value, powers_of};
use super::factor::{covers, law};
use super::files::Files;
use super::identify::{
    Check, IdentifyCase, band_of, channels_of, factor_unit, known_have_std, known_names, one_is_calibrated,
    place_of_std, shared_factor,
};
use super::lines::unused;
use super::measurement::Measurement;
use crate::case::{CaseFile, Located, SeveralEntry, UnknownEntry, UnknownVaries};
use crate::error::{InputError, Place};
use crate::units::FactorUnit;
use frfit::c64;
use frfit::identify::{ChannelUnknowns, Dependence, Options, Unknown, Variation};
use frfit::material::Law;
use frfit::model::{DynamicStiffness, Term};
use frfit::roots::Bounds;

/// Puts the identification of several unknowns together, or of one that does not vary.
pub(super) fn several(
    case: &CaseFile,
    overrides: &Overrides,
    (model, of): (&DynamicStiffness, &[PartOf]),
    measurements: &[Measurement],
    files: &mut Files,
) -> Result<IdentifyCase, InputError> {
    let Some(entry) = &case.several else {
        return Err(InputError::at(&Place::file(&case.file), "a table [[identify]]", "none"));
    };
    for (option, given) in [
        ("--method", overrides.method.is_some()),
        ("--order", overrides.order.is_some()),
        ("--selection", overrides.selection.is_some()),
        ("--reduction", overrides.reduction.is_some()),
    ] {
        if given {
            let expected = "no such option with several unknowns: there is one way to find them";
            return Err(InputError::at(&Place::option(option), expected, "one"));
        }
    }
    let (channels, first_unknown) = channels_of(case);
    if let Some(first) =
        first_unknown.filter(|_| entry.unknowns.iter().all(|one| one.varies == UnknownVaries::PerFrequency))
    {
        one_is_calibrated(&channels, &first)?;
    }
    each_has_a_value(case)?;
    let unknowns = entry.unknowns.iter().map(|one| unknowns(case, one, (model, of)));
    let unknowns = unknowns.collect::<Result<Vec<_>, _>>()?;
    refuse_twice(entry)?;
    known_have_std(model, &unknowns, place_of_std(case))?;
    let reference = entry
        .unknowns
        .iter()
        .map(|one| one.reference.as_ref().map(|reference| law(reference, files)).transpose())
        .collect::<Result<Vec<_>, _>>()?;
    let (band_hz, place) = band_of(entry.band_hz.as_ref(), &entry.place, overrides)?;
    let data = band(measurements, model.decay_per_s(), band_hz, &place)?;
    let most = entry.max_lines.as_ref();
    let out = unused(&data, &entry.exclude, most, &entry.place.below("exclude_hz"))?;
    let frequency_hz = data.frequency_hz;
    for (one, reference) in entry.unknowns.iter().zip(&reference) {
        if let (Some(written), Some(law)) = (&one.reference, reference) {
            covers(law, &written.place, &frequency_hz)?;
        }
    }
    let used = out.iter().filter(|&&out| !out).count();
    enough(&entry.place, &unknowns, &channels, (used, measurements.len()))?;
    let unit = |(one, unknowns): (&UnknownEntry, &Unknown)| match one.matrices.as_slice() {
        [] => FactorUnit::Other,
        named => factor_unit(case, named, &unknowns.nominal, &frequency_hz),
    };
    let units = entry.unknowns.iter().zip(&unknowns).map(unit).collect();
    Ok(IdentifyCase {
        unknowns,
        units,
        reference,
        options: Options::default()
            .with_reject_outliers(entry.reject_outliers.unwrap_or(true))
            .with_model_errors(case.model_error),
        band_hz,
        frequency_hz,
        measured: data.measured,
        left_out: out,
        channels,
        noise: data.noise,
        check: Check::IfUnexplained,
    })
}

fn unknowns(
    case: &CaseFile,
    entry: &UnknownEntry,
    (model, of): (&DynamicStiffness, &[PartOf]),
) -> Result<Unknown, InputError> {
    let varies = match entry.varies {
        UnknownVaries::PerFrequency => Variation::PerFrequency,
        UnknownVaries::Constant => Variation::Constant,
        UnknownVaries::ByLaw(family) => Variation::law(family),
    };
    let bounds = Bounds {
        storage: entry.storage.as_ref().map(|bound| bound.value),
        loss_factor: entry.loss_factor.as_ref().map(|bound| bound.value),
    };
    let name = entry.name.value.clone();
    if let Some(Located { value, place }) = &entry.nominal {
        let named: Vec<Located<String>> = entry.powers.iter().map(|(name, _)| name.clone()).collect();
        known_names(case, &named)?;
        let powers = powers_of(&name, of, &entry.powers);
        if powers.is_empty() {
            let expected = "powers, or a matrix that is given at values of this dimension";
            return Err(InputError::at(&entry.place, expected, "none"));
        }
        if *value == 0.0 {
            return Err(InputError::at(place, "a dimension other than 0", "0"));
        }
        let nominal = Law::Constant(c64::new(*value, 0.0));
        return Ok(Unknown {
            name,
            dependence: Dependence::Powers(powers),
            nominal,
            varies,
            real: entry.real,
            bounds,
        });
    }
    known_names(case, &entry.matrices)?;
    let parameter = shared_factor(&parts_of(&entry.matrices, (model, of)), model, &entry.place)?;
    let terms = parameter.members.iter().map(|member| member.term).collect();
    if entry.real && matches!(&parameter.nominal, Law::Constant(value) if value.im != 0.0) {
        let expected = "a matrix with a real factor, for real = true";
        return Err(InputError::at(&entry.place, expected, "a loss factor"));
    }
    Ok(Unknown {
        name,
        dependence: Dependence::Factor(terms),
        nominal: parameter.nominal,
        varies,
        real: entry.real,
        bounds,
    })
}

/// The names of the terms that some matrices have become.
fn parts_of(
    matrices: &[Located<String>],
    (model, of): (&DynamicStiffness, &[PartOf]),
) -> Vec<Located<String>> {
    let terms = |name: &Located<String>| {
        let own = model.terms().iter().zip(of).filter(|(_, part)| part.matrix == name.value);
        let named =
            |(term, _): (&Term, &PartOf)| Located { value: term.name.clone(), place: name.place.clone() };
        own.map(named).collect::<Vec<_>>()
    };
    matrices.iter().flat_map(terms).collect()
}

/// The factor of a matrix is one unknown.
fn refuse_twice(entry: &SeveralEntry) -> Result<(), InputError> {
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

/// Refuses fewer measured than unknown numbers.
pub(super) fn enough(
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
