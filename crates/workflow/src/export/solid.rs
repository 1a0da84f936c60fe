//! What the decks of all solvers have in common: an isotropic solid in the units of its model, and what is said of it.

use super::modulus::Modulus;
use super::options::ExportOptions;
use crate::error::{InputError, Place};
use crate::units::UnitSystem;
use frfit::c64;

/// An isotropic solid with a modulus over frequency, in the units of its model.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Solid {
    /// Hz and E′ + iE″.
    pub(super) points: Vec<(f64, c64)>,
    pub(super) poisson: f64,
    pub(super) density: Option<f64>,
}

impl Solid {
    /// Of a modulus in SI units.
    ///
    /// # Errors
    /// Poisson's ratio that is missing or not above −1 and below ½; a density that is not above zero.
    pub(super) fn new(
        modulus: &Modulus,
        options: &ExportOptions,
        units: UnitSystem,
    ) -> Result<Self, InputError> {
        let place = Place::option("--poisson");
        let expected = "Poisson's ratio, above -1 and below 0.5: the material needs it, and it does not follow from one modulus";
        let poisson = options.poisson.ok_or_else(|| InputError::at(&place, expected, "none"))?;
        if !(poisson > -1.0 && poisson < 0.5) {
            return Err(InputError::at(&place, expected, poisson.to_string()));
        }
        if let Some(density) = options.density.filter(|&density| !(density > 0.0 && density.is_finite())) {
            let place = Place::option("--density");
            return Err(InputError::at(&place, "a density above 0 kg/m^3", density.to_string()));
        }
        let point = |row: &frfit_formats::csv::ModulusRow| {
            let storage = units.modulus(row.storage);
            (row.frequency_hz, c64::new(storage, storage * row.loss_factor))
        };
        Ok(Self {
            points: modulus.rows.iter().map(point).collect(),
            poisson,
            density: options.density.map(|density| units.density(density)),
        })
    }
}

/// What every deck says at its head.
pub(super) fn heading(modulus: &Modulus, options: &ExportOptions, units: UnitSystem, source: &str) -> String {
    let [first, last] = modulus.band_hz();
    let mut text = format!(
        "frfit {}: complex modulus E = E'(1 + i eta) of {source}, time convention exp(+i omega t)\n\
         units {}: E in {}, density in {}, frequency in Hz\n\
         {} frequencies, {first} to {last} Hz",
        env!("CARGO_PKG_VERSION"),
        units.name(),
        units.modulus_unit(),
        units.density_unit(),
        modulus.rows.len()
    );
    text += &match (&modulus.law, modulus.left_out_words(), options.all) {
        (Some(law), _, _) => format!(", values of the law {law} ({})", modulus.law_unit()),
        (None, Some(words), _) => format!("; left out: {words}"),
        (None, None, true) => ", whatever their status".into(),
        (None, None, false) => String::new(),
    };
    text +=
        "\nPoisson's ratio is real and constant: bulk and shear modulus have the same complex factor as E\n";
    text
}

/// A number of few digits near this one: a reference that is written exactly, and to which values are relative.
pub(super) fn reference(value: f64) -> f64 {
    format!("{value:.5e}").parse().unwrap_or(value)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn references_have_six_digits() {
        assert_eq!(reference(1.234_567_89e6), 1.234_57e6);
        assert_eq!(reference(0.1), 0.1);
    }
}
