//! The classes of wrong models, and what is different in truth.

use super::structure::Kind;
use frfit::c64;
use std::fmt;
use std::str::FromStr;

/// In which way the model is wrong.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Class {
    /// In no way: the truth is the same mesh.
    Right,
    /// The truth has a finer mesh.
    CoarseMesh,
    /// What is known beside the unknown, skins or springs, is 0.5–3 % off.
    Neighbour,
    /// All mass is 0.5–3 % off.
    Mass,
    /// A sensor has a mass of 0.2–1 % of the structure's.
    PointMass,
    /// A clamped edge gives, or a free structure is suspended on springs.
    SupportSpring,
    /// The truth is of bricks, the model a plate or beam without shear.
    OtherElement,
}

impl Class {
    /// All of them: case k of a seed is of class k modulo their number.
    pub const ALL: [Self; 7] = [
        Self::Right,
        Self::CoarseMesh,
        Self::Neighbour,
        Self::Mass,
        Self::PointMass,
        Self::SupportSpring,
        Self::OtherElement,
    ];

    /// The word that arguments and tables use.
    pub fn name(self) -> &'static str {
        match self {
            Self::Right => "right",
            Self::CoarseMesh => "coarse mesh",
            Self::Neighbour => "neighbour",
            Self::Mass => "mass",
            Self::PointMass => "point mass",
            Self::SupportSpring => "support spring",
            Self::OtherElement => "other element",
        }
    }

    /// The structures that can be wrong in this way.
    pub fn kinds(self) -> &'static [Kind] {
        match self {
            Self::Neighbour => &[Kind::Sandwich, Kind::SprungBeam],
            Self::OtherElement => &[Kind::Plate, Kind::Beam, Kind::SprungBeam],
            _ => &Kind::ALL,
        }
    }

    /// The structure of a case: one after the other, so that few cases have all of them.
    pub fn kind_of(self, index: u64) -> Kind {
        let (kinds, round) = (self.kinds(), index as usize / Self::ALL.len());
        // Not all classes begin with the same.
        kinds[(round + self as usize) % kinds.len()]
    }
}

impl fmt::Display for Class {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

impl FromStr for Class {
    type Err = String;

    /// With a blank or a hyphen between its words.
    fn from_str(text: &str) -> Result<Self, String> {
        let known = Self::ALL.into_iter().find(|class| class.name() == text.replace('-', " "));
        let names = Self::ALL.map(Self::name).join(", ");
        known.ok_or_else(|| format!("class: expected one of {names}, found {text:?}"))
    }
}

/// What is different in truth. The default: nothing.
#[derive(Debug, Clone)]
pub struct Change {
    /// Elements in plan for one of the model, along x and y each.
    pub plan: usize,
    /// Elements through a layer of bricks.
    pub layers: usize,
    /// Factor of what is known beside the unknown.
    pub known: f64,
    /// Factor of all mass.
    pub mass: f64,
    /// Masses in kg, and where.
    pub masses: Vec<([f64; 3], f64)>,
    /// Springs to the ground in N/m, and where.
    pub suspension: Vec<([f64; 3], c64)>,
    /// How stiff the springs are that clamped edges are in truth, over the structure on its length.
    pub clamp: Option<f64>,
    /// Bricks in place of plate or beam.
    pub bricks: bool,
}

impl Default for Change {
    fn default() -> Self {
        Self {
            plan: 1,
            layers: 1,
            known: 1.0,
            mass: 1.0,
            masses: Vec::new(),
            suspension: Vec::new(),
            clamp: None,
            bricks: false,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn classes_are_found_by_their_names() {
        for class in Class::ALL {
            assert_eq!(class.name().replace(' ', "-").parse(), Ok(class));
            assert_eq!(class.name().parse(), Ok(class));
        }
        assert!("wrong".parse::<Class>().is_err());
    }
}
