//! How to find what is unknown.

use super::overrides::Overrides;
use crate::case::{IdentifyEntry, Located, checked_band};
use crate::error::{InputError, Place};
use frfit::identify::{
    Method, ModelErrors, Options, OptionsError, Reduction, Selection, Unknown, UnknownChoice, Variation,
};
use std::str::FromStr;

/// An entry with what the command line says in its place.
pub(super) fn overridden(entry: &IdentifyEntry, overrides: &Overrides) -> Result<IdentifyEntry, InputError> {
    let mut entry = entry.clone();
    let place = Place::option;
    if let Some(value) = overrides.band_hz {
        checked_band(value, &place("--band"))?;
        entry.band_hz = Some(Located { value, place: place("--band") });
    }
    if let Some(method) = chosen::<Method>(overrides.method.as_deref(), place("--method"))? {
        // A method from the command line brings its own selection.
        entry.selection = entry.selection.filter(|_| method.value == Method::Rational);
        entry.method = Some(method.value);
        only_of_single(&mut entry, method.place);
    }
    if let Some(order) = overrides.order {
        let value = i64::try_from(order).unwrap_or(i64::MAX);
        entry.order = Some(Located { value, place: place("--order") });
        only_of_single(&mut entry, place("--order"));
    }
    if let Some(selection) = chosen::<Selection>(overrides.selection.as_deref(), place("--selection"))? {
        only_of_single(&mut entry, selection.place.clone());
        entry.selection = Some(selection);
    }
    if let Some(reduction) = chosen::<Reduction>(overrides.reduction.as_deref(), place("--reduction"))? {
        entry.reduction = Some(reduction.value);
        only_of_single(&mut entry, reduction.place);
    }
    if overrides.reduced.is_some() {
        let place = place("--reduced");
        if entry.reduction == Some(Reduction::Full) {
            return Err(InputError::at(&place, "the reduction \"auto\" or \"subspace\"", "\"full\""));
        }
        entry.reduction = Some(Reduction::Subspace);
    }
    Ok(entry)
}

fn only_of_single(entry: &mut IdentifyEntry, place: Place) {
    entry.of_single.get_or_insert(place);
}

/// What a word of an option or an argument says.
pub(super) fn chosen<T: FromStr<Err = UnknownChoice>>(
    word: Option<&str>,
    place: Place,
) -> Result<Option<Located<T>>, InputError> {
    let Some(word) = word else { return Ok(None) };
    match word.parse::<T>() {
        Ok(value) => Ok(Some(Located { value, place })),
        Err(unknown) => Err(InputError::at(&place, unknown.expected, format!("{word:?}"))),
    }
}

/// The options of an entry, not validated.
pub(super) fn options(entry: &IdentifyEntry, model_errors: ModelErrors) -> Options {
    let usual = Options::default();
    let method = entry.method.unwrap_or(usual.method);
    // Only the rational method has several roots to select from jointly.
    let selection = if method == Method::Rational { Selection::Joint } else { Selection::Smallest };
    // A negative number of terms cannot be.
    let order = entry.order.as_ref().map(|order| usize::try_from(order.value).unwrap_or(0));
    usual
        .with_model_errors(model_errors)
        .with_method(method)
        .with_order(order.unwrap_or(usual.order))
        .with_selection(entry.selection.as_ref().map_or(selection, |selection| selection.value))
        .with_reduction(entry.reduction.unwrap_or(usual.reduction))
        .with_reject_outliers(entry.reject_outliers.unwrap_or(usual.reject_outliers))
        .with_whole_box(entry.start.is_some())
}

const ORDERS: &str = "1 to 200";

/// The key or the option that an invalid option comes from.
pub(super) fn invalid(error: &OptionsError, entry: &IdentifyEntry) -> InputError {
    match (error, &entry.order, &entry.selection) {
        (OptionsError::Order(_), Some(order), _) => {
            InputError::at(&order.place, ORDERS, order.value.to_string())
        }
        (OptionsError::Selection(method), _, Some(selection)) => {
            let expected = format!("\"smallest\" with method {:?}", method.name());
            InputError::at(&selection.place, expected, format!("{:?}", selection.value.name()))
        }
        _ => InputError::at(&entry.place, "other options", error.to_string()),
    }
}

/// Laws and smooth moduli (`place` is where a case says that it looks for one) are fitted on the subspace of a joint selection.
pub(super) fn reduction_of_band(
    options: &Options,
    only: &Unknown,
    place: &Place,
) -> Result<Reduction, InputError> {
    let word = match only.varies {
        Variation::Smooth => "smooth",
        Variation::Law(_) => "law",
        _ => return Ok(options.reduction),
    };
    let refuse = |expected: &str, found: String| Err(InputError::at(place, expected, found));
    if options.selection != Selection::Joint {
        let found = format!("{word:?} with selection {:?}", options.selection.name());
        return refuse("\"frequency\", or selection = \"joint\"", found);
    }
    if options.reduction == Reduction::Full {
        let found = format!("{word:?} with reduction \"full\"");
        return refuse("\"frequency\", or the reduction \"subspace\"", found);
    }
    Ok(Reduction::Subspace)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_orders_named_are_those_allowed() {
        assert_eq!(ORDERS, format!("1 to {}", frfit::identify::MAX_ORDER));
    }
}
