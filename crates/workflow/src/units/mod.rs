//! Units of the model: where they are converted, and what results are labelled with.
//!
//! A case says in which consistent system of units its *model* is (`units = "mm-t-s"`). Measurements are in SI units, whatever the model is in.
//!
//! One of the two has to be converted. The textbook way to SI is K_SI = T K T with a factor for each degree of freedom. It needs to know which rows are
//! rotations, because T differs there, and many matrices have no names of rows. Converting only measurements and ω needs no such knowledge, but then every table,
//! figure and message would be in units of the model, and all of them would have to be converted back.
//!
//! There is a third way that has neither drawback, and it is used here. Let the model's units be L metres, M kilograms and T seconds, with the force F₀ = M L/T².
//! In those units the model is (K + iω_T C − ω_T² M_m) u = f with ω_T = ω T. Multiply it by F₀/L = M/T²:
//!
//! (M/T² K + iω M/T C − ω² M M_m) (L u) = F₀ f.
//!
//! So each matrix takes *one* number, whatever its rows stand for: M/T² for a stiffness, M/T for a viscous damping, M for a mass. ω is in rad/s. At a
//! translation L u is the displacement in metres, and F₀ f the force in newtons. At a rotation, where u is an angle, L u is the angle times L, and F₀ f the moment in
//! N·m over L. Only a load or a sensor *at* a rotation has to know that: a moment of 1 N·m enters as 1/L, and an angle in rad is the row's value times 1/L
//! ([`UnitSystem::rotation`], used by `load::dofs`, `load::force` and `load::attached`). Solids, which have no rotations, and shells and beams, which do, are so
//! treated alike, and matrices in SI stay as they are, bit for bit.
//!
//! Factors of matrices, their laws and bounds, and values of geometric parameters stay in units of the model: K is F(E) with E in the model's unit of stress, and the number
//! above is in the matrix. Times of laws are in seconds and frequencies in hertz in every system.

mod amount;
mod factor;
mod table;

pub use amount::Amount;
pub(crate) use amount::{AmountOf, amount};
pub use factor::FactorUnit;
pub(crate) use table::TableUnits;

use frfit::model::Role;
use serde_json::{Value, json};
use std::fmt;
use std::str::FromStr;

/// A consistent system of units, by length, mass (or force) and time.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum UnitSystem {
    /// m, kg, s: N, Pa.
    #[default]
    Si,
    /// mm, t, s: N, MPa. The usual one of solid models.
    MillimetreTonne,
    /// mm, kg, ms: kN, GPa.
    MillimetreKilogramMillisecond,
    /// mm, g, ms: N, MPa.
    MillimetreGramMillisecond,
    /// mm, kg, s: mN, kPa.
    MillimetreKilogram,
    /// m, t, s: kN, kPa.
    MetreTonne,
    /// cm, g, s: dyn, dyn/cm².
    CentimetreGram,
    /// in, lbf s²/in, s: lbf, psi.
    InchPound,
    /// ft, slug, s: lbf, psf.
    FootPound,
}

/// What a system is made of.
struct Made {
    /// Its name.
    name: &'static str,
    /// L in m, M in kg, T in s.
    length_m: f64,
    mass_kg: f64,
    time_s: f64,
    /// Names of the units of length, mass, time, force and stress.
    units: [&'static str; 5],
    /// Name of the unit of density.
    density: &'static str,
}

/// Inch and foot in m, and pound-force in N: exact by definition.
const INCH: f64 = 0.0254;
const FOOT: f64 = 0.3048;
const POUND_FORCE: f64 = 4.448_221_615_260_5;

impl UnitSystem {
    /// All systems, in the order in which an error lists them.
    pub const ALL: [Self; 9] = [
        Self::Si,
        Self::MillimetreTonne,
        Self::MillimetreKilogramMillisecond,
        Self::MillimetreGramMillisecond,
        Self::MillimetreKilogram,
        Self::MetreTonne,
        Self::CentimetreGram,
        Self::InchPound,
        Self::FootPound,
    ];

    /// Another name of SI.
    const ALIAS: &'static str = "m-kg-s";

    fn made(self) -> Made {
        let made = |name, [length_m, mass_kg, time_s]: [f64; 3], units, density| Made {
            name,
            length_m,
            mass_kg,
            time_s,
            units,
            density,
        };
        match self {
            Self::Si => made("SI", [1.0; 3], ["m", "kg", "s", "N", "Pa"], "kg/m^3"),
            Self::MillimetreTonne => made("mm-t-s", [1e-3, 1e3, 1.0], ["mm", "t", "s", "N", "MPa"], "t/mm^3"),
            Self::MillimetreKilogramMillisecond => {
                made("mm-kg-ms", [1e-3, 1.0, 1e-3], ["mm", "kg", "ms", "kN", "GPa"], "kg/mm^3")
            }
            Self::MillimetreGramMillisecond => {
                made("mm-g-ms", [1e-3, 1e-3, 1e-3], ["mm", "g", "ms", "N", "MPa"], "g/mm^3")
            }
            Self::MillimetreKilogram => {
                made("mm-kg-s", [1e-3, 1.0, 1.0], ["mm", "kg", "s", "mN", "kPa"], "kg/mm^3")
            }
            Self::MetreTonne => made("m-t-s", [1.0, 1e3, 1.0], ["m", "t", "s", "kN", "kPa"], "t/m^3"),
            Self::CentimetreGram => {
                made("cm-g-s", [1e-2, 1e-3, 1.0], ["cm", "g", "s", "dyn", "dyn/cm^2"], "g/cm^3")
            }
            Self::InchPound => made(
                "in-lbf-s",
                [INCH, POUND_FORCE / INCH, 1.0],
                ["in", "lbf s^2/in", "s", "lbf", "psi"],
                "lbf s^2/in^4",
            ),
            Self::FootPound => made(
                "ft-lbf-s",
                [FOOT, POUND_FORCE / FOOT, 1.0],
                ["ft", "slug", "s", "lbf", "psf"],
                "slug/ft^3",
            ),
        }
    }

    /// As a case file and the command line have it.
    pub fn name(self) -> &'static str {
        self.made().name
    }

    /// The unit of a length.
    fn length_unit(self) -> &'static str {
        self.made().units[0]
    }

    /// The unit of a mass.
    fn mass_unit(self) -> &'static str {
        self.made().units[1]
    }

    /// The unit of a time.
    fn time_unit(self) -> &'static str {
        self.made().units[2]
    }

    /// The unit of a force.
    pub fn force_unit(self) -> &'static str {
        self.made().units[3]
    }

    /// The unit of a modulus.
    pub fn modulus_unit(self) -> &'static str {
        self.made().units[4]
    }

    /// The unit of a density.
    pub fn density_unit(self) -> &'static str {
        self.made().density
    }

    /// What a matrix of a role is multiplied by to act on metres: M/T², M/T or M.
    pub fn matrix(self, role: Role) -> f64 {
        let Made { mass_kg, time_s, .. } = self.made();
        match role {
            Role::Stiffness => mass_kg / (time_s * time_s),
            Role::Viscous => mass_kg / time_s,
            Role::Mass => mass_kg,
        }
    }

    /// What a moment in N·m is multiplied by to load a rotation, and the value of its row to be an angle in rad: 1/L.
    pub fn rotation(self) -> f64 {
        1.0 / self.made().length_m
    }

    /// The unit of a modulus in Pa: M/(L T²).
    pub fn modulus_pa(self) -> f64 {
        self.matrix(Role::Stiffness) * self.rotation()
    }

    /// A modulus in pascal, in this system.
    pub fn modulus(self, pascal: f64) -> f64 {
        pascal / self.modulus_pa()
    }

    /// A density in kg/m³, in this system.
    pub fn density(self, kg_per_m3: f64) -> f64 {
        // 1/L is a whole number in mm and cm: 1100 kg/m³ are 1.1e-9 t/mm³ to the last digit.
        kg_per_m3 / (self.made().mass_kg * self.rotation().powi(3))
    }

    /// What measured FRFs are times those of the model, where the case names this system and the model is in another one. `None` where the systems have
    /// different units of time: then it is no number.
    pub(crate) fn measured_over_model(self, other: Self) -> Option<f64> {
        let same_time = self.made().time_s == other.made().time_s;
        same_time.then(|| self.matrix(Role::Stiffness) / other.matrix(Role::Stiffness))
    }

    /// For programs: the system and its units.
    pub(crate) fn json(self) -> Value {
        json!({
            "system": self.name(),
            "length": self.length_unit(),
            "mass": self.mass_unit(),
            "time": self.time_unit(),
            "force": self.force_unit(),
            "modulus": self.modulus_unit(),
            "density": self.density_unit(),
            "responses": "SI",
        })
    }
}

/// A word that is no system of units.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct UnknownSystem {
    /// The words that there are.
    pub expected: String,
    /// The text that was found, and the nearest of the known ones.
    pub found: String,
}

impl fmt::Display for UnknownSystem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "expected {}, found {}", self.expected, self.found)
    }
}

impl std::error::Error for UnknownSystem {}

impl FromStr for UnitSystem {
    type Err = UnknownSystem;

    fn from_str(text: &str) -> Result<Self, UnknownSystem> {
        if text == Self::ALIAS {
            return Ok(Self::Si);
        }
        let found = Self::ALL.into_iter().find(|system| system.name() == text);
        found.ok_or_else(|| {
            let names = || std::iter::once(Self::ALIAS).chain(Self::ALL.map(Self::name));
            let quoted: Vec<String> = names().map(|name| format!("{name:?}")).collect();
            let (last, rest) = quoted.split_last().map_or((String::new(), &[][..]), |(l, r)| (l.clone(), r));
            let hint = crate::nearest::nearest(text, names());
            let hint = hint.map_or(String::new(), |name| format!("; did you mean {name:?}?"));
            let short: String = text.chars().take(60).collect();
            UnknownSystem {
                expected: format!("{} or {last}", rest.join(", ")),
                found: format!("{short:?}{hint}"),
            }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Force, modulus and density of each system in SI units, as handbooks have them.
    const KNOWN: [(&str, f64, f64, f64); 9] = [
        ("SI", 1.0, 1.0, 1.0),
        ("mm-t-s", 1.0, 1e6, 1e12),
        ("mm-kg-ms", 1e3, 1e9, 1e9),
        ("mm-g-ms", 1.0, 1e6, 1e6),
        ("mm-kg-s", 1e-3, 1e3, 1e9),
        ("m-t-s", 1e3, 1e3, 1e3),
        ("cm-g-s", 1e-5, 0.1, 1e3),
        ("in-lbf-s", 4.448_221_615_260_5, 6_894.757_293_168, 1.068_689_517_8e7),
        ("ft-lbf-s", 4.448_221_615_260_5, 47.880_258_980, 515.378_818_4),
    ];

    #[test]
    fn systems_are_consistent() {
        for ((name, newton, pascal, density), system) in KNOWN.into_iter().zip(UnitSystem::ALL) {
            assert_eq!(name.parse::<UnitSystem>(), Ok(system));
            let near = |a: f64, b: f64| assert!((a / b - 1.0).abs() < 1e-9, "{name}: {a} for {b}");
            let force = system.matrix(Role::Stiffness) / system.rotation();
            near(force, newton);
            near(system.modulus_pa(), pascal);
            near(1.0 / system.density(1.0), density);
            near(force / (system.matrix(Role::Mass) / system.rotation()), (system.made().time_s).powi(-2));
        }
    }

    #[test]
    fn an_unknown_system_is_refused_with_the_list_and_the_nearest() {
        let error = "mm-T-s".parse::<UnitSystem>().unwrap_err();
        assert!(
            error.expected.starts_with("\"m-kg-s\", \"SI\", \"mm-t-s\"")
                && error.expected.ends_with("or \"ft-lbf-s\"")
        );
        assert_eq!(error.found, "\"mm-T-s\"; did you mean \"mm-t-s\"?");
        assert_eq!("m-kg-s".parse(), Ok(UnitSystem::Si));
    }
}
