//! Functions written such that neighbouring abscissae still differ.

use frfit_formats::FormatError;
use frfit_formats::uff::{File, Form, Function, Spacing, write};

/// How far an abscissa may move, in steps to its neighbour.
///
/// Single precision moves six decimal digits, all that the text of a stored abscissa has, by up to half of 2⁻¹⁰ where
/// their last place is 10⁻²: by a twentieth of the smallest step that they can show. More than that is a loss.
const MAX_DRIFT_STEPS: f64 = 0.05;

/// A function as dataset 58 or 58b.
///
/// # Errors
/// What the writer refuses, and abscissae that would move by more than a twentieth of their step.
pub(super) fn written(function: &Function, form: Form) -> Result<Vec<u8>, FormatError> {
    within_limit(attempt(function, form)?)
}

/// The same, with whichever spacing keeps the abscissae better: as minimum and increment, or each of them.
///
/// # Errors
/// As [`written`].
pub(super) fn written_evenly_or_not(function: &Function, form: Form) -> Result<Vec<u8>, FormatError> {
    let uneven = attempt(&spaced(function, Spacing::Uneven), form)?;
    let Some(spacing) = even(&function.abscissa) else { return within_limit(uneven) };
    let even = attempt(&spaced(function, spacing), form)?;
    within_limit(if even.1 <= uneven.1 { even } else { uneven })
}

fn within_limit((bytes, drift): (Vec<u8>, f64)) -> Result<Vec<u8>, FormatError> {
    match drift <= MAX_DRIFT_STEPS {
        true => Ok(bytes),
        false => Err(FormatError::whole(
            "an abscissa that the text of a UFF file can show, or binary data (--binary)",
            format!("one that would move by {drift:.2} of its step"),
        )),
    }
}

fn spaced(function: &Function, spacing: Spacing) -> Function {
    let mut function = function.clone();
    function.header.spacing = spacing;
    function
}

/// The even spacing between first and last, if there are two points.
fn even(abscissa: &[f64]) -> Option<Spacing> {
    let (&[minimum, .., last], steps) = (abscissa, abscissa.len() - 1) else { return None };
    Some(Spacing::Even { minimum, increment: (last - minimum) / steps as f64 })
}

/// The bytes, and how far their abscissae are from those of the function, in steps to their neighbours.
fn attempt(function: &Function, form: Form) -> Result<(Vec<u8>, f64), FormatError> {
    let bytes = write::function(function, form)?;
    let read = File::new(&bytes)?.function(0)?;
    Ok((bytes, drift(&function.abscissa, &read.abscissa)))
}

fn drift(abscissa: &[f64], read: &[f64]) -> f64 {
    let moved = |k: usize| {
        let at = |k: Option<usize>| k.and_then(|k| abscissa.get(k));
        let here = abscissa[k];
        let step = at(k.checked_sub(1)).into_iter().chain(at(Some(k + 1))).map(|x| (x - here).abs());
        // Of a single point there is no step: it may move by its own size.
        let step = step.reduce(f64::min).unwrap_or(here.abs());
        let by = (read.get(k).copied().unwrap_or(f64::INFINITY) - here).abs();
        if by == 0.0 { 0.0 } else { by / step }
    };
    (0..abscissa.len()).map(moved).fold(0.0, f64::max)
}
