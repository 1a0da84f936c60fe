//! Amounts with a unit of their own, as `"12 g"` and `"3 N/mm"`.

use super::{FOOT, INCH, POUND_FORCE, UnitSystem};
use crate::nearest::nearest;
use frfit::model::Role;

/// What is attached to a structure: a number in units of the case, or one that has units of its own.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Amount {
    /// In units of the model.
    OfModel(f64),
    /// In SI units.
    Si {
        /// kg, N/m or N·s/m; of a rotation N·m/rad or N·m·s/rad.
        value: f64,
        /// Whether it is one for a rotation.
        rotational: bool,
    },
}

impl Amount {
    /// The number.
    pub fn value(self) -> f64 {
        match self {
            Self::OfModel(value) | Self::Si { value, .. } => value,
        }
    }

    /// What stands on the diagonal of a matrix that acts on metres.
    pub(crate) fn entry(self, units: UnitSystem, role: Role) -> f64 {
        match self {
            Self::OfModel(value) => value * units.matrix(role),
            Self::Si { value, rotational: false } => value,
            Self::Si { value, rotational: true } => value * units.rotation() * units.rotation(),
        }
    }
}

/// What an amount is to be.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum AmountOf {
    /// A point mass.
    Mass,
    /// A spring to ground.
    Stiffness,
    /// A damper to ground.
    Damping,
}

impl AmountOf {
    /// Powers of kg, m and s at a translation, and at a rotation, where there is such.
    fn powers(self) -> [Option<[i32; 3]>; 2] {
        match self {
            Self::Mass => [Some([1, 0, 0]), None],
            Self::Stiffness => [Some([1, 0, -2]), Some([1, 2, -2])],
            Self::Damping => [Some([1, 0, -1]), Some([1, 2, -1])],
        }
    }

    /// An example, for errors.
    pub(crate) fn example(self) -> &'static str {
        match self {
            Self::Mass => "12 g",
            Self::Stiffness => "3 N/mm",
            Self::Damping => "0.2 N s/m",
        }
    }
}

/// Symbols, what each is in SI units, and its powers of kg, m and s. Case counts.
const SYMBOLS: [(&str, f64, [i32; 3]); 26] = [
    ("kg", 1.0, [1, 0, 0]),
    ("g", 1e-3, [1, 0, 0]),
    ("mg", 1e-6, [1, 0, 0]),
    ("t", 1e3, [1, 0, 0]),
    ("lb", 0.453_592_37, [1, 0, 0]),
    ("lbm", 0.453_592_37, [1, 0, 0]),
    ("oz", 0.453_592_37 / 16.0, [1, 0, 0]),
    ("slug", POUND_FORCE / FOOT, [1, 0, 0]),
    ("m", 1.0, [0, 1, 0]),
    ("cm", 1e-2, [0, 1, 0]),
    ("mm", 1e-3, [0, 1, 0]),
    ("um", 1e-6, [0, 1, 0]),
    ("µm", 1e-6, [0, 1, 0]),
    ("in", INCH, [0, 1, 0]),
    ("ft", FOOT, [0, 1, 0]),
    ("s", 1.0, [0, 0, 1]),
    ("ms", 1e-3, [0, 0, 1]),
    ("N", 1.0, [1, 1, -2]),
    ("mN", 1e-3, [1, 1, -2]),
    ("kN", 1e3, [1, 1, -2]),
    ("MN", 1e6, [1, 1, -2]),
    ("dyn", 1e-5, [1, 1, -2]),
    ("lbf", POUND_FORCE, [1, 1, -2]),
    ("kgf", 9.806_65, [1, 1, -2]),
    ("rad", 1.0, [0, 0, 0]),
    ("1", 1.0, [0, 0, 0]),
];

/// An amount of a kind from its text: a number, then symbols with `*`, `·` or spaces between factors, `/` before divisors, and `^` before a power.
///
/// # Errors
/// What is wrong with it, as it is found.
pub(crate) fn amount(text: &str, of: AmountOf) -> Result<Amount, String> {
    let text = text.trim();
    let number = |end: usize| text[..end].parse::<f64>().ok().filter(|value| value.is_finite());
    // "1e-3 t": the longest beginning that is a number. "3 N" has one too, without a reduction at its end.
    let ends = (1..=text.len()).rev().filter(|&end| text.is_char_boundary(end));
    let (value, end) = ends
        .filter_map(|end| Some((number(end)?, end)))
        .next()
        .ok_or_else(|| "no number at its beginning".to_owned())?;
    let unit = text[end..].trim();
    if unit.is_empty() {
        return Err("no unit after the number".into());
    }
    let (factor, powers) = factor_and_powers(unit)?;
    let [translation, rotation] = of.powers();
    match Some(powers) {
        own if own == translation => Ok(Amount::Si { value: value * factor, rotational: false }),
        own if own == rotation => Ok(Amount::Si { value: value * factor, rotational: true }),
        _ => Err(format!("the unit {unit:?}, which is of another quantity")),
    }
}

/// What a unit is in SI units, and its powers of kg, m and s.
fn factor_and_powers(unit: &str) -> Result<(f64, [i32; 3]), String> {
    let words = |part: &'_ str| -> Vec<String> {
        let all = part.split(|c: char| c == '*' || c == '·' || c.is_whitespace());
        all.filter(|word| !word.is_empty()).map(str::to_owned).collect()
    };
    let parts: Vec<Vec<String>> = unit.split('/').map(words).collect();
    // N/m s could be N/(m s) or (N/m) s: what readers disagree about is refused.
    match parts.as_slice() {
        [_, _, _, ..] => return Err(format!("two strokes in the unit {unit:?}")),
        [_, below] if below.len() != 1 => {
            return Err(format!("not one symbol after the stroke in the unit {unit:?}"));
        }
        _ => {}
    }
    let (mut factor, mut powers) = (1.0, [0; 3]);
    for (part, sense) in parts.iter().zip([1, -1]) {
        for word in part {
            let (symbol, power) = split_power(word)?;
            let Some((_, size, own)) = SYMBOLS.iter().find(|(name, ..)| *name == symbol) else {
                let hint = nearest(symbol, SYMBOLS.iter().map(|(name, ..)| *name));
                let hint = hint.map_or(String::new(), |name| format!("; did you mean {name:?}?"));
                return Err(format!("the unknown unit {symbol:?}{hint}"));
            };
            factor *= size.powi(sense * power);
            powers.iter_mut().zip(own).for_each(|(sum, own)| *sum += sense * power * own);
        }
    }
    Ok((factor, powers))
}

/// `s^2` and `s²`: the symbol and its power.
fn split_power(word: &str) -> Result<(&str, i32), String> {
    if let Some(symbol) = word.strip_suffix('²') {
        return Ok((symbol, 2));
    }
    match word.split_once('^') {
        None => Ok((word, 1)),
        Some((symbol, power)) => match power.parse::<i32>() {
            Ok(power) if (-4..=4).contains(&power) => Ok((symbol, power)),
            _ => Err(format!("the power {power:?} of {symbol:?}")),
        },
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn si(text: &str, of: AmountOf) -> (f64, bool) {
        match amount(text, of) {
            Ok(Amount::Si { value, rotational }) => (value, rotational),
            other => panic!("{text}: {other:?}"),
        }
    }

    #[test]
    fn amounts_are_read_in_their_own_units() {
        for (text, of, value, rotational) in [
            ("12 g", AmountOf::Mass, 0.012, false),
            ("12g", AmountOf::Mass, 0.012, false),
            ("1.2e-5 t", AmountOf::Mass, 0.012, false),
            ("0.5 lb", AmountOf::Mass, 0.226_796_185, false),
            ("1 lbf s^2/in", AmountOf::Mass, 175.126_835_246, false),
            ("3 N/mm", AmountOf::Stiffness, 3000.0, false),
            ("2 lbf/in", AmountOf::Stiffness, 350.253_670_5, false),
            ("5 kN*mm/rad", AmountOf::Stiffness, 5.0, true),
            ("5 N·m", AmountOf::Stiffness, 5.0, true),
            ("0.2 N s / m", AmountOf::Damping, 0.2, false),
            ("0.2 N*ms/mm", AmountOf::Damping, 0.2, false),
            ("7 N mm s", AmountOf::Damping, 0.007, true),
        ] {
            let (found, turns) = si(text, of);
            assert!((found / value - 1.0).abs() < 1e-9 && turns == rotational, "{text}: {found} {turns}");
        }
    }

    #[test]
    fn what_is_no_such_amount_is_said() {
        for (text, of, message) in [
            ("g", AmountOf::Mass, "no number at its beginning"),
            ("", AmountOf::Mass, "no number at its beginning"),
            ("12", AmountOf::Mass, "no unit after the number"),
            ("12 N", AmountOf::Mass, "the unit \"N\", which is of another quantity"),
            ("12 gram", AmountOf::Mass, "the unknown unit \"gram\""),
            ("3 n/mm", AmountOf::Stiffness, "the unknown unit \"n\"; did you mean \"N\"?"),
            ("3 N/m/s", AmountOf::Stiffness, "two strokes in the unit \"N/m/s\""),
            ("3 N/m*s", AmountOf::Damping, "not one symbol after the stroke in the unit \"N/m*s\""),
            ("3 N/", AmountOf::Damping, "not one symbol after the stroke in the unit \"N/\""),
            ("3 N^x", AmountOf::Mass, "the power \"x\" of \"N\""),
            ("3 g m²", AmountOf::Mass, "the unit \"g m²\", which is of another quantity"),
        ] {
            let found = amount(text, of).unwrap_err();
            assert!(found.starts_with(message), "{text}: {found}");
        }
    }
}
