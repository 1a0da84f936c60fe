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

    /// The files with another mesh, measured at other frequencies: the case, without the truth and the README.
    ///
    /// `measured` are receptances, `[frequency][sensor]`. Where the case names degrees of freedom, they are those of the mesh.
    ///
    /// # Errors
    /// [`Error`] where a file cannot be written as its format wants it.
    ///
    /// # Panics
    /// Where the measurement is not an FRF.
    pub fn files_of(
        &self,
        model: &Model,
        frequency_hz: &[f64],
        measured: &[Vec<c64>],
    ) -> Result<Vec<File>, Error> {
        let Measurement::Frf(path, quantity) = self.measurement else {
            panic!("the measurement of {} is made of records", self.name)
        };
        let own = (self.model)()?;
        let mut case = self.case.to_owned();
        let named = |model: &Model| {
            let sensors = (0..model.experiment.sensors.len()).map(|m| model.measured_dof(m));
            model.driven_at().into_iter().chain(sensors).map(|dof| format!("\"{dof}\"")).collect::<Vec<_>>()
        };
        for (there, here) in named(&own).into_iter().zip(named(model)).filter(|_| self.names_dofs) {
            case = case.replace(&there, &here);
        }
        let mut files = vec![File::new("case.toml", case)];
        files.extend(self.model_files(model)?);
        files.push(self.frfs(path, quantity, model, frequency_hz, measured)?);
        Ok(files)
    }

    /// Matrices, names of the rows and loads.
    fn model_files(&self, model: &Model) -> Result<Vec<File>, Error> {
        let mut files = Vec::new();
        for (term, path) in model.stiffness.terms().iter().zip(self.matrices) {
            files.push(File::new(path, matrix(term, path)?));
        }
        if self.names_dofs {
            files.push(File::new("dofs.csv", dofs(&model.dofs)?));
        }
        if model.driven_at().is_none() {
            files.push(File::new("force.csv", force(&model.experiment.load)?));
        }
        Ok(files)
    }

    fn files(&self) -> Result<Vec<File>, Error> {
        let model = (self.model)()?;
        let mut files = vec![File::new("README.md", self.readme), File::new("case.toml", self.case)];
        files.extend(self.model_files(&model)?);
        let mut frequency_hz = model.frequency_hz();
        match self.measurement {
            Measurement::Frf(path, quantity) => {
                let measured = frequency_hz.iter().map(|&f| model.measured_at(f));
                let measured = measured.collect::<Result<Vec<_>, Error>>()?;
                files.push(self.frfs(path, quantity, &model, &frequency_hz, &measured)?);
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
        measured: &[Vec<c64>],
    ) -> Result<File, Error> {
        let frf = |sensor: usize| Frf {
            title: self.summary,
            quantity,
            response: model.measured_dof(sensor),
            reference: model.driven_at(),
            frequency_hz,
            values: frequency_hz
                .iter()
                .zip(measured)
                .map(|(f, x)| quantity.from_receptance(*f, x[sensor]))
                .collect(),
        };
        if path.ends_with(".csv") {
            return Ok(File::new(path, csv_frf(&frf(0))?));
        }
        let frfs: Vec<_> = (0..model.experiment.sensors.len()).map(frf).collect();
        Ok(File::new(path, uff_frfs(&frfs)?))
    }
}
