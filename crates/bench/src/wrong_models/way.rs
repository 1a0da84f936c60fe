//! The ways in which the unknown is said to vary.

use std::fmt;
use std::str::FromStr;

/// How the unknown is said to vary.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Way {
    /// A value of its own at every frequency.
    PerFrequency,
    /// A smooth function of frequency.
    Smooth,
    /// The law that the truth is of.
    Law,
    /// All stiffnesses at once: a core has a value of its own at every frequency, the others are constant.
    Several,
    /// The same with a smooth core.
    SeveralSmooth,
}

impl Way {
    /// All of them.
    pub const ALL: [Self; 5] =
        [Self::PerFrequency, Self::Smooth, Self::Law, Self::Several, Self::SeveralSmooth];

    /// Those with one unknown.
    pub const OF_ONE: [Self; 3] = [Self::PerFrequency, Self::Smooth, Self::Law];

    /// The word that arguments and tables use.
    pub fn name(self) -> &'static str {
        match self {
            Self::PerFrequency => "per-frequency",
            Self::Smooth => "smooth",
            Self::Law => "law",
            Self::Several => "several",
            Self::SeveralSmooth => "several-smooth",
        }
    }
}

impl fmt::Display for Way {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

impl FromStr for Way {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let names = Self::ALL.map(Self::name).join(", ");
        let known = Self::ALL.into_iter().find(|way| way.name() == text);
        known.ok_or_else(|| format!("way: expected one of {names}, found {text:?}"))
    }
}
