//! Dataset 164: the units of everything else in the file.

use crate::FormatError;

use super::columns::fields;
use super::data_lines;
use super::lines::Lines;

/// Units of a file. A value in SI units is the value in the file divided by the factor of its quantity.
#[derive(Debug, Clone, PartialEq)]
pub struct Units {
    /// 1: m, N; 2: ft, lbf; 3: m, kgf; 4: ft, pdl; 5: mm, mN; 6: cm, cN; 7: in, lbf; 8: mm, kgf; 9: as the
    /// factors say.
    pub code: i32,
    /// Name of the units (20 characters).
    pub description: String,
    /// 1: absolute, 2: relative temperatures; 0 where the file does not say.
    pub temperature_mode: i32,
    /// Factor of lengths.
    pub length: f64,
    /// Factor of forces.
    pub force: f64,
    /// Factor of temperatures.
    pub temperature: f64,
    /// Offset of temperatures.
    pub temperature_offset: f64,
}

impl Default for Units {
    /// SI: metre and newton, absolute temperature in kelvin.
    fn default() -> Self {
        Self {
            code: 1,
            description: "SI: m, N".to_owned(),
            temperature_mode: 1,
            length: 1.0,
            force: 1.0,
            temperature: 1.0,
            temperature_offset: 0.0,
        }
    }
}

/// FORMAT(I10,20A1,I10), then FORMAT(3D25.17) with four numbers on two lines.
pub(super) fn read(mut lines: Lines<'_>) -> Result<Units, FormatError> {
    let line = lines.next();
    let missing =
        || FormatError::line(lines.next_number(), "the code of the units", "the end of the dataset");
    let line = line.ok_or_else(missing)?;
    let text = line.text();
    let [code, description, mode] = fields(&text, line.number, [10, 20, 10]);
    let next_line = lines.next_number();
    let factors = data_lines::numbers(lines, &[25], 4)?;
    let &[length, force, temperature, temperature_offset] = factors.as_slice() else {
        return Err(FormatError::line(next_line, "four unit factors", format!("{}", factors.len())));
    };
    Ok(Units {
        code: code.required("a code of units")?,
        description: description.text(),
        temperature_mode: mode.integer("a temperature mode")?,
        length,
        force,
        temperature,
        temperature_offset,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exponents_with_d_and_a_missing_mode() {
        let text =
            "         9USER_DEFINED\r\n  1.00000000000000000D+03  2.0D+00  1.0D+00\r\n -2.7315D+02\r\n";
        let units = read(Lines::new(text.as_bytes(), 3)).expect("units");
        assert_eq!((units.code, units.description.as_str(), units.temperature_mode), (9, "USER_DEFINED", 0));
        assert_eq!((units.length, units.force, units.temperature_offset), (1000.0, 2.0, -273.15));
        assert!(read(Lines::new(b"         9\n 1.0 1.0 1.0\n", 3)).is_err());
    }
}
