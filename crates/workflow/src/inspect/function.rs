//! A function of a UFF file in one line.

use super::text::count;
use crate::terminal::short;
use frfit_formats::uff::FunctionSummary;
use serde_json::{Value, json};

/// `record` is the number of an FRF among those of its file; `None` of another function.
pub(super) fn words(record: Option<usize>, function: &FunctionSummary) -> String {
    let kind = match record {
        Some(number) => format!("FRF {number}"),
        None => function.function_type.to_owned(),
    };
    let FunctionSummary { response, reference, quantities, units, .. } = function;
    let quantity = match (record.is_some(), quantities) {
        (true, [_, ordinate, denominator]) => format!("{ordinate} / {denominator}"),
        (false, [_, ordinate, _]) => (*ordinate).to_owned(),
    };
    let unit = if units[0].is_empty() { format!("({})", quantities[0]) } else { units[0].clone() };
    let range = match function.range {
        Some([first, last]) => format!("{} to {} {unit}", short(first), short(last)),
        None => "range not readable".into(),
    };
    let spacing = if function.even { "even" } else { "uneven" };
    let points = count(function.points, "point");
    format!(
        "{kind}: {response} / {reference}, {quantity}, {points}, {range}, {spacing}, {}",
        function.data_type
    )
}

pub(super) fn json(record: Option<usize>, function: &FunctionSummary) -> Value {
    let [abscissa, ordinate, denominator] = function.quantities;
    let [abscissa_unit, ordinate_unit, denominator_unit] = &function.units;
    let mut object = json!({
        "id": function.id,
        "function_type": function.function_type,
        "response": function.response,
        "reference": function.reference,
        "points": function.points,
        "range": function.range,
        "even": function.even,
        "data_type": function.data_type,
        "quantities": {"abscissa": abscissa, "ordinate": ordinate, "denominator": denominator},
        "units": {"abscissa": abscissa_unit, "ordinate": ordinate_unit, "denominator": denominator_unit},
    });
    if let Some(number) = record {
        object["record"] = json!(number);
    }
    object
}
