//! The examples there are, and their files.

use crate::file::{Frf, csv_frf, dofs, force, matrix, truth, uff_frfs};
use crate::{
    Error, File, Model, clamped_plate, density, hammer_bar, hammer_records, rubber_bar, rubber_bar_end,
    sandwich,
};
use frfit::c64;
use frfit::material::Law;
use frfit::quantity::Quantity;

/// An example, as a list shows it.
#[derive(Debug)]
pub struct Example {
    /// The name by which it is generated.
    pub name: &'static str,
    /// What it is, in a line of at most 80 characters: it is also the title of its measurement.
    pub summary: &'static str,
    case: &'static str,
    readme: &'static str,
    model: fn() -> Result<Model, Error>,
    /// File of each term's matrix.
    matrices: &'static [&'static str],
    measurement: Measurement,
    /// Whether its case names degrees of freedom instead of rows.
    names_dofs: bool,
}

/// What was measured, as a file.
#[derive(Debug)]
enum Measurement {
    /// FRFs of the model itself, and their quantity.
    Frf(&'static str, Quantity),
    /// Records of a hammer test, of which `frfit frf` makes the FRF.
    Records(&'static str, fn() -> Result<Vec<u8>, Error>),
}

static EXAMPLES: [Example; 6] = [
    Example {
        name: "rubber-bar",
        summary: "free-free rubber bar, the same force on every node: its modulus over frequency",
        case: include_str!("../cases/rubber-bar/case.toml"),
        readme: include_str!("../cases/rubber-bar/README.md"),
        model: || rubber_bar(100),
        matrices: &["K.mtx", "M.mtx"],
        measurement: Measurement::Frf("frf.uff", Quantity::Receptance),
        names_dofs: false,
    },
    Example {
        name: "rubber-bar-end",
        summary: "free-free rubber bar struck at one end: one sensor cannot tell its modulus",
        case: include_str!("../cases/rubber-bar-end/case.toml"),
        readme: include_str!("../cases/rubber-bar-end/README.md"),
        model: || rubber_bar_end(100),
        matrices: &["K.mtx", "M.mtx"],
        measurement: Measurement::Frf("frf.uff", Quantity::Accelerance),
        names_dofs: false,
    },
    Example {
        name: "clamped-plate",
        summary: "clamped steel plate, lightly damped: where the series converges and where not",
        case: include_str!("../cases/clamped-plate/case.toml"),
        readme: include_str!("../cases/clamped-plate/README.md"),
        model: || clamped_plate(20),
        matrices: &["K.rsa", "M.mtx"],
        measurement: Measurement::Frf("frf.uff", Quantity::Accelerance),
        names_dofs: true,
    },
    Example {
        name: "density",
        summary: "aluminium cantilever of unknown density: a real factor of the mass matrix",
        case: include_str!("../cases/density/case.toml"),
        readme: include_str!("../cases/density/README.md"),
        model: || density(40),
        matrices: &["K.mtx", "M.mtx"],
        measurement: Measurement::Frf("frf.csv", Quantity::Mobility),
        names_dofs: false,
    },
    Example {
        name: "hammer-bar",
        summary: "free-free polyurethane bar, records of a hammer test: from the hit to the modulus",
        case: include_str!("../cases/hammer-bar/case.toml"),
        readme: include_str!("../cases/hammer-bar/README.md"),
        model: || hammer_bar(400),
        matrices: &["K.mtx", "M.mtx"],
        measurement: Measurement::Records("records.lvm", || hammer_records(1, 0.0)),
        names_dofs: false,
    },
    Example {
        name: "sandwich",
        summary: "aluminium skins on a rubber core, clamped at one end: the modulus of the core",
        case: include_str!("../cases/sandwich/case.toml"),
        readme: include_str!("../cases/sandwich/README.md"),
        model: || sandwich(30, 1, 1),
        matrices: &["K_skins.mtx", "K_core.mtx", "M_skins.mtx", "M_core.mtx"],
        measurement: Measurement::Frf("frf.uff", Quantity::Accelerance),
        names_dofs: true,
    },
];

/// The examples there are.
pub fn list() -> &'static [Example] {
    &EXAMPLES
}

/// The files of an example, the same bytes each time: `README.md`, `case.toml`, and all that the case names.
///
/// The measurement is computed by direct solves of the same model with the true parameter, without noise; that of
/// `hammer-bar` are records from an exact solution ([`Example::records`]).
///
/// # Errors
/// [`Error::UnknownExample`] for a name that is not in [`list`].
pub fn generate(name: &str) -> Result<Vec<File>, Error> {
    let unknown = || Error::UnknownExample {
        asked: name.to_owned(),
        known: EXAMPLES.iter().map(|example| example.name).collect(),
    };
    EXAMPLES.iter().find(|example| example.name == name).ok_or_else(unknown)?.files()
}

impl Example {
    /// The file with records of which `frfit frf` has to make the measurement first, `frf.uff`; `None` where that is there.
    pub fn records(&self) -> Option<&'static str> {
        match self.measurement {
            Measurement::Frf(..) => None,
            Measurement::Records(path, _) => Some(path),
        }
    }

    fn files(&self) -> Result<Vec<File>, Error> {
        let model = (self.model)()?;
        let mut files = vec![File::new("README.md", self.readme), File::new("case.toml", self.case)];
        for (term, path) in model.stiffness.terms().iter().zip(self.matrices) {
            files.push(File::new(path, matrix(term, path)?));
        }
        if self.names_dofs {
            files.push(File::new("dofs.csv", dofs(&model.dofs)?));
        }
        if model.driven_at().is_none() {
            files.push(File::new("force.csv", force(&model.experiment.load)?));
        }
        let mut frequency_hz = model.frequency_hz();
        match self.measurement {
            Measurement::Frf(path, quantity) => {
                files.push(self.frfs(path, quantity, &model, &frequency_hz)?);
            }
            Measurement::Records(path, records) => {
                files.push(File::new(path, records()?));
                // A table of a factor has to reach every line that the case may ask for.
                if let Law::Table(table) = &model.truth {
                    frequency_hz = table.frequency_hz().to_vec();
                }
            }
        }
        files.push(File::new("truth.csv", truth(&model, &frequency_hz)?));
        Ok(files)
    }

    /// All sensors in one UFF file; in CSV, which holds one, the first.
    fn frfs(
        &self,
        path: &str,
        quantity: Quantity,
        model: &Model,
        frequency_hz: &[f64],
    ) -> Result<File, Error> {
        let at = |&f: &f64| Ok((f, model.measured_at(f)?));
        let measured = frequency_hz.iter().map(at).collect::<Result<Vec<(f64, Vec<c64>)>, Error>>()?;
        let frf = |sensor: usize| Frf {
            title: self.summary,
            quantity,
            response: model.measured_dof(sensor),
            reference: model.driven_at(),
            frequency_hz,
            values: measured.iter().map(|(f, x)| quantity.from_receptance(*f, x[sensor])).collect(),
        };
        if path.ends_with(".csv") {
            return Ok(File::new(path, csv_frf(&frf(0))?));
        }
        let frfs: Vec<_> = (0..model.experiment.sensors.len()).map(frf).collect();
        Ok(File::new(path, uff_frfs(&frfs)?))
    }
}
