//! Names of degrees of freedom: node and direction with sign, as in `12+Z` or `7-RX`.

use std::fmt;
use std::str::FromStr;

/// The axis of a translation or a rotation.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Axis {
    /// Translation along x.
    X,
    /// Translation along y.
    Y,
    /// Translation along z.
    Z,
    /// Rotation about x.
    Rx,
    /// Rotation about y.
    Ry,
    /// Rotation about z.
    Rz,
}

impl Axis {
    /// All of them, in the order of UFF's direction numbers 1 to 6.
    pub const ALL: [Self; 6] = [Self::X, Self::Y, Self::Z, Self::Rx, Self::Ry, Self::Rz];

    /// `X`, `Y`, `Z`, `RX`, `RY` or `RZ`.
    pub fn name(self) -> &'static str {
        ["X", "Y", "Z", "RX", "RY", "RZ"][self as usize]
    }
}

impl fmt::Display for Axis {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// A degree of freedom with the sense in which it is counted positive.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct DofName {
    /// Node label.
    pub node: u64,
    /// Axis.
    pub axis: Axis,
    /// Whether motion or force against the axis counts as positive.
    pub reversed: bool,
}

impl DofName {
    /// +1 or −1.
    pub fn sign(self) -> f64 {
        if self.reversed { -1.0 } else { 1.0 }
    }

    /// From UFF's node and direction number ±1 … ±6; `None` for 0 (scalar) and numbers beyond.
    pub fn from_uff(node: u64, direction: i32) -> Option<Self> {
        let index = usize::try_from(direction.unsigned_abs()).ok()?.checked_sub(1)?;
        Some(Self { node, axis: *Axis::ALL.get(index)?, reversed: direction < 0 })
    }

    /// UFF's direction number ±1 … ±6.
    pub fn uff_direction(self) -> i32 {
        let number = self.axis as i32 + 1;
        if self.reversed { -number } else { number }
    }
}

impl fmt::Display for DofName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}{}{}", self.node, if self.reversed { '-' } else { '+' }, self.axis)
    }
}

/// A text that is not node, sign, direction.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct NotADofName(pub String);

impl fmt::Display for NotADofName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "expected a node, a sign and a direction such as 12+Z or 7-RX, found {:?}", self.0)
    }
}

impl std::error::Error for NotADofName {}

impl FromStr for DofName {
    type Err = NotADofName;

    fn from_str(text: &str) -> Result<Self, NotADofName> {
        let refuse = || NotADofName(text.to_owned());
        let at = text.find(['+', '-']).ok_or_else(refuse)?;
        let (node, direction) = (&text[..at], &text[at + 1..]);
        let axis = Axis::ALL.into_iter().find(|axis| axis.name().eq_ignore_ascii_case(direction));
        if !node.bytes().all(|b| b.is_ascii_digit()) {
            return Err(refuse());
        }
        Ok(Self {
            node: node.parse().map_err(|_| refuse())?,
            axis: axis.ok_or_else(refuse)?,
            reversed: text.as_bytes()[at] == b'-',
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_read_back_as_written() {
        for text in ["12+Z", "7-RX", "1+Y", "900000+RZ"] {
            let name: DofName = text.parse().unwrap();
            assert_eq!(name.to_string(), text);
            assert_eq!(DofName::from_uff(name.node, name.uff_direction()), Some(name));
        }
        assert_eq!("3-rx".parse::<DofName>().unwrap().to_string(), "3-RX");
    }

    #[test]
    fn other_texts_are_refused() {
        for text in ["", "12", "+Z", "12+", "12+W", "x+Z", "12Z", "+12+Z", "99999999999999999999+X"] {
            assert!(text.parse::<DofName>().is_err(), "{text}");
        }
        assert_eq!(DofName::from_uff(1, 0), None);
        assert_eq!(DofName::from_uff(1, 7), None);
        assert_eq!(DofName::from_uff(1, i32::MIN), None);
    }
}
