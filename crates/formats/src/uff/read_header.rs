//! The eleven records before the data of a dataset 58.

use crate::FormatError;

use super::columns::{Field, fields, fixed_or_free};
use super::data_type::DataType;
use super::function_header::{Axis, Dof, FunctionHeader, Spacing};
use super::function_type::FunctionType;
use super::lines::Lines;
use super::quantity::Quantity;

/// Number of lines before the data.
pub(super) const HEADER_RECORDS: usize = 11;

/// Reads records 1–11 and leaves `lines` at the first byte of the data.
pub(super) fn function_header(lines: &mut Lines<'_>) -> Result<FunctionHeader, FormatError> {
    let id = [id_line(lines)?, id_line(lines)?, id_line(lines)?, id_line(lines)?, id_line(lines)?];
    let (text, line) = next_text(lines, "record 6 (identification of the degrees of freedom)")?;
    let identification = identification(&text, line)?;
    let (text, line) = next_text(lines, "record 7 (form of the data)")?;
    let form = data_form(&text, line)?;
    Ok(FunctionHeader {
        id,
        data_type: form.data_type,
        points: form.points,
        spacing: form.spacing,
        z_value: form.z_value,
        abscissa: axis(lines, "record 8 (abscissa)")?,
        ordinate: axis(lines, "record 9 (ordinate)")?,
        denominator: axis(lines, "record 10 (ordinate denominator)")?,
        z_axis: axis(lines, "record 11 (third axis)")?,
        ..identification
    })
}

fn next_text(lines: &mut Lines<'_>, what: &str) -> Result<(String, usize), FormatError> {
    let line = lines.next();
    let line = line.ok_or_else(|| FormatError::line(lines.next_number(), what, "the end of the dataset"))?;
    Ok((line.text(), line.number))
}

/// Records 1–5: FORMAT(80A1).
fn id_line(lines: &mut Lines<'_>) -> Result<String, FormatError> {
    let (text, line) = next_text(lines, "five ID lines")?;
    let [id] = fields(&text, line, [80]);
    Ok(id.text())
}

/// Record 6: FORMAT(2(I5,I10),2(1X,10A1,I10,I4)).
fn identification(text: &str, line: usize) -> Result<FunctionHeader, FormatError> {
    const WIDTHS: [usize; 10] = [5, 10, 5, 10, 11, 10, 4, 11, 10, 4];
    fixed_or_free(text, line, WIDTHS, |[kind, id, version, load_case, a, b, c, d, e, f]| {
        Ok(FunctionHeader {
            function_type: FunctionType::from_number(kind.required("a function type")?),
            function_id: id.integer("a function identification number")?,
            version: version.integer("a version number")?,
            load_case: load_case.integer("a load case number")?,
            response: dof([a, b, c])?,
            reference: dof([d, e, f])?,
            ..FunctionHeader::default()
        })
    })
}

fn dof([entity, node, direction]: [Field<'_>; 3]) -> Result<Dof, FormatError> {
    Ok(Dof {
        entity: entity.text(),
        node: node.integer("a node label")?,
        direction: direction.integer("a direction")?,
    })
}

/// What record 7 says.
struct DataForm {
    data_type: DataType,
    points: usize,
    spacing: Spacing,
    z_value: f64,
}

/// Record 7: FORMAT(3I10,3E13.5).
fn data_form(text: &str, line: usize) -> Result<DataForm, FormatError> {
    const WIDTHS: [usize; 6] = [10, 10, 10, 13, 13, 13];
    fixed_or_free(text, line, WIDTHS, |[data_type, points, spacing, minimum, increment, z_value]| {
        let data_type_error = "an ordinate data type: 2, 4, 5 or 6";
        let minimum = minimum.real("a finite abscissa minimum")?;
        let increment = increment.real("a finite abscissa increment")?;
        Ok(DataForm {
            data_type: DataType::from_number(data_type.required(data_type_error)?)
                .ok_or_else(|| data_type.error(data_type_error))?,
            points: points.required("a number of points")?,
            spacing: match spacing.required("an abscissa spacing: 0 or 1")? {
                0 => Spacing::Uneven,
                1 => Spacing::Even { minimum, increment },
                _ => return Err(spacing.error("an abscissa spacing: 0 or 1")),
            },
            z_value: z_value.real("a finite third coordinate")?,
        })
    })
}

/// Records 8–11: FORMAT(I10,3I5,2(1X,20A1)).
fn axis(lines: &mut Lines<'_>, what: &str) -> Result<Axis, FormatError> {
    let (text, line) = next_text(lines, what)?;
    let [quantity, length, force, temperature, label, unit] = fields(&text, line, [10, 5, 5, 5, 21, 21]);
    Ok(Axis {
        quantity: Quantity::from_number(quantity.required("a specific data type")?),
        length_exponent: length.integer("a length exponent")?,
        force_exponent: force.integer("a force exponent")?,
        temperature_exponent: temperature.integer("a temperature exponent")?,
        label: label.text(),
        unit: unit.text(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Position;

    fn record_6(text: &str) -> Result<FunctionHeader, FormatError> {
        identification(text, 8)
    }

    #[test]
    fn glued_fields_of_record_6() {
        let header =
            record_6("    49999999999    1         0 abcdefghij9999999999  -3 NONE      1234567890   6")
                .expect("a header");
        assert_eq!(header.function_type, FunctionType::FrequencyResponse);
        assert_eq!(header.function_id, 9_999_999_999);
        assert_eq!(header.version, 1);
        let response = Dof { entity: "abcdefghij".into(), node: 9_999_999_999, direction: -3 };
        assert_eq!(header.response, response);
        assert_eq!(header.reference, Dof { entity: String::new(), node: 1_234_567_890, direction: 6 });
    }

    #[test]
    fn a_record_6_off_its_columns_is_read_by_words() {
        let header = record_6("4 1 0 0 NONE 34 3 NONE 1 -3").expect("a header");
        assert_eq!((header.response.label(), header.reference.label()), ("34+Z".into(), "1-Z".into()));
    }

    #[test]
    fn a_short_record_6_is_filled_with_zeros() {
        let header = record_6("    1").expect("a header");
        assert_eq!((header.function_type, header.response), (FunctionType::TimeResponse, Dof::default()));
    }

    #[test]
    fn an_unreadable_field_is_named_with_its_place() {
        let error = record_6("    4         x    0").expect_err("x is no number");
        assert_eq!(error.position, Position::Line { line: 8, column: Some(6) });
        let error = data_form("         3         6", 9).map(|_| ()).expect_err("there is no type 3");
        assert_eq!(error.position, Position::Line { line: 9, column: Some(1) });
        assert!(data_form("         5        -6         1", 9).is_err());
        assert!(data_form("         5         6         2", 9).is_err());
        assert!(data_form("         5         6         1          NaN", 9).is_err());
    }
}
