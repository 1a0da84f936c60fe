//! What is unknown, checked against the model.

use super::dimension::{PartOf, powers_of};
use crate::case::{IdentifyEntry, Located, UnknownEntry};
use crate::error::{InputError, Place};
use frfit::c64;
use frfit::identify::{Dependence, Unknown, Variation};
use frfit::material::Law;
use frfit::model::{DynamicStiffness, FactorStd, Parameter, Term};
use frfit::roots::{Bounds, BoundsError};

/// Whether the only unknown is one that varies and is found with all its solutions: it has a method, an order and the like of its own.
pub(super) fn is_single(unknowns: &[Unknown]) -> bool {
    matches!(unknowns, [only] if only.varies != Variation::Constant && only.parameter().is_some())
}

/// All unknowns of an entry whose matrices are those of the model; `of` says which of these each term is part of.
pub(super) fn unknowns(
    entry: &IdentifyEntry,
    model: &DynamicStiffness,
    of: &[PartOf],
) -> Result<Vec<Unknown>, InputError> {
    let each = entry.unknowns.iter().map(|one| unknown(one, model, of));
    let mut unknowns = each.collect::<Result<Vec<_>, _>>()?;
    let single = is_single(&unknowns);
    if let (false, Some(place)) = (single, &entry.of_single) {
        let expected = "nothing here: several unknowns, constants and negative powers have one method only";
        return Err(InputError::at(place, expected, "a choice"));
    }
    let has_smooth = unknowns.iter().any(|one| one.varies == Variation::Smooth);
    for (written, one) in entry.unknowns.iter().zip(&unknowns) {
        let place = &written.varies.place;
        can_vary(one, place, single)?;
        if has_smooth && one.varies == Variation::PerFrequency {
            let expected = "\"smooth\", \"constant\" or \"law\" beside a smooth unknown (the data cannot show \
                            which of the two varies from line to line)";
            return Err(InputError::at(place, expected, "\"frequency\""));
        }
        for bound in written.storage.iter().chain(&written.loss_factor) {
            let [low, high] = bound.value;
            // A single unknown may have a reference value, with which each line is compared.
            if !(low < high || single && low == high) {
                let expected = if single { BoundsError::EXPECTED } else { "[low, high] with low < high" };
                return Err(InputError::at(&bound.place, expected, format!("[{low}, {high}]")));
            }
        }
        let is_lossy = matches!(&one.nominal, Law::Constant(value) if value.im != 0.0);
        if one.real && is_lossy && !single {
            let expected = "a matrix with a real factor, for real = true";
            return Err(InputError::at(&written.place, expected, "a loss factor"));
        }
    }
    if let (Some(place), [only]) = (&entry.start, &mut unknowns[..]) {
        only.nominal = middle_of(only, place)?;
    }
    Ok(unknowns)
}

fn unknown(entry: &UnknownEntry, model: &DynamicStiffness, of: &[PartOf]) -> Result<Unknown, InputError> {
    let (dependence, nominal) = match &entry.nominal {
        None => factor(entry, model, of)?,
        Some(Located { value, place }) => {
            let powers = powers_of(&entry.name.value, of, &entry.powers);
            if powers.is_empty() {
                let expected = "powers, or a matrix that is given at values of this dimension";
                return Err(InputError::at(&entry.place, expected, "none"));
            }
            if *value == 0.0 {
                return Err(InputError::at(place, "a dimension other than 0", "0"));
            }
            (Dependence::Powers(powers), Law::Constant(c64::new(*value, 0.0)))
        }
    };
    let of = |bound: &Option<Located<[f64; 2]>>| bound.as_ref().map(|bound| bound.value);
    Ok(Unknown {
        name: entry.name.value.clone(),
        dependence,
        nominal,
        varies: entry.varies.value.clone(),
        real: entry.real,
        bounds: Bounds { storage: of(&entry.storage), loss_factor: of(&entry.loss_factor) },
    })
}

/// The factor that matrices share: the terms that they have become, and its nominal value.
fn factor(
    entry: &UnknownEntry,
    model: &DynamicStiffness,
    of: &[PartOf],
) -> Result<(Dependence, Law), InputError> {
    for (k, Located { value, place }) in entry.matrices.iter().enumerate() {
        if entry.matrices[..k].iter().any(|earlier| earlier.value == *value) {
            return Err(InputError::at(place, "each matrix once", format!("{value:?} a second time")));
        }
    }
    let terms = |name: &'_ Located<String>| {
        let own = model.terms().iter().zip(of).filter(|(_, part)| part.matrix == name.value);
        own.map(|(term, _): (&Term, _)| (term.name.as_str(), name.place.clone())).collect::<Vec<_>>()
    };
    let named: Vec<(&str, Place)> = entry.matrices.iter().flat_map(terms).collect();
    let words: Vec<&str> = named.iter().map(|(name, _)| *name).collect();
    let parameter = Parameter::factor_of(model, &words)
        .map_err(|error| InputError::at(&entry.place, "names of matrices", error.to_string()))?;
    for (member, (name, place)) in parameter.members.iter().zip(&named) {
        if model.terms()[member.term].factor != parameter.nominal {
            let expected = format!("matrices with one factor, that of {:?}", words[0]);
            return Err(InputError::at(place, expected, format!("{name:?} with another")));
        }
    }
    let terms = parameter.members.iter().map(|member| member.term).collect();
    Ok((Dependence::Factor(terms), parameter.nominal))
}

/// Refuses how an unknown varies where there is no way to find it; `place` is where it says so.
fn can_vary(one: &Unknown, place: &Place, single: bool) -> Result<(), InputError> {
    let (expected, found) = match (&one.varies, &one.dependence) {
        (Variation::Law(_), _) if one.real => (
            "\"frequency\", \"smooth\" or \"constant\" for a real unknown",
            "\"law\" with real = true".into(),
        ),
        (Variation::Law(kinds), _) if kinds.len() > 1 && !single => (
            "one law, by the key law, with several unknowns or a negative power",
            format!("{} laws", kinds.len()),
        ),
        (Variation::Smooth, Dependence::Powers(_)) => {
            ("\"frequency\", \"constant\" or \"law\" for a dimension", "\"smooth\"".into())
        }
        _ => return Ok(()),
    };
    Err(InputError::at(place, expected, found))
}

/// `start = "bounds"`: where the bounds are, without any other word of the user. The factor is searched in all of them.
fn middle_of(one: &Unknown, place: &Place) -> Result<Law, InputError> {
    let refuse = |expected: &str, found: String| Err(InputError::at(place, expected, found));
    if let Dependence::Powers(_) = one.dependence {
        return refuse("no such key with a dimension, which begins at its nominal value", "one".into());
    }
    let [low, high] = match one.bounds.storage {
        Some([low, high]) if low > 0.0 => [low, high],
        Some([low, high]) => {
            return refuse(
                "bounds.storage above zero, to begin in the middle of",
                format!("[{low}, {high}]"),
            );
        }
        None => return refuse("the key bounds.storage, to begin in the middle of", "none".into()),
    };
    let loss_factor = one.bounds.loss_factor.map_or(0.0, |[low, high]| SMALL_LOSS.clamp(low, high));
    Ok(Law::complex_modulus((low * high).sqrt(), loss_factor))
}

/// The loss factor that an estimate begins with, where the bounds allow it: between metals and rubber.
const SMALL_LOSS: f64 = 0.01;

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
