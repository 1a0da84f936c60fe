//! The classes of wrong models, and what is different in truth.

use super::structure::Kind;
use super::way::Way;
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
    /// The model is right, and the calibrations are not: that of the force is 0.5–3 % off, those of the sensors 0.2–2 %.
    Calibration,
}

impl Class {
    /// All of them: case k of a seed is of class k modulo their number.
    pub const ALL: [Self; 8] = [
        Self::Right,
        Self::CoarseMesh,
        Self::Neighbour,
        Self::Mass,
        Self::PointMass,
        Self::SupportSpring,
        Self::OtherElement,
        Self::Calibration,
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
            Self::Calibration => "calibration",
        }
    }

    /// The structures that can be wrong in this way; of several unknowns none where what is wrong is unknown.
    pub fn kinds(self, unknowns: Unknowns) -> &'static [Kind] {
        match (self, unknowns) {
            (Self::Neighbour, Unknowns::One) => &[Kind::Sandwich, Kind::SprungBeam],
            (Self::OtherElement, Unknowns::One) => &[Kind::Plate, Kind::Beam, Kind::SprungBeam],
            (_, Unknowns::One) => &Kind::ALL,
            (Self::Neighbour, Unknowns::Several) => &[],
            (Self::OtherElement, Unknowns::Several) => &[Kind::SprungBeam],
            (_, Unknowns::Several) => &[Kind::OrthotropicPlate, Kind::Sandwich, Kind::SprungBeam],
        }
    }

    /// The class of a case of a seed.
    pub fn of(index: u64) -> Self {
        Self::ALL[(index % Self::ALL.len() as u64) as usize]
    }

    /// The structure of a case: one after the other, so that few cases have all of them; `None` where none can be wrong in this way.
    pub fn kind_of(self, index: u64, unknowns: Unknowns) -> Option<Kind> {
        let (kinds, round) = (self.kinds(unknowns), index as usize / Self::ALL.len());
        // Not all classes begin with the same.
        kinds.get((round + self as usize) % kinds.len().max(1)).copied()
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

/// How many factors are unknown.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Unknowns {
    /// That of one material.
    One,
    /// All stiffnesses: of an orthotropic plate its four constants, of a sandwich core and skins, of a beam on springs beam and springs.
    Several,
}

impl Unknowns {
    /// Those of some ways.
    pub fn of(ways: &[Way]) -> Self {
        let is_of_one = |way: &Way| Way::OF_ONE.contains(way);
        if ways.iter().all(is_of_one) { Self::One } else { Self::Several }
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
