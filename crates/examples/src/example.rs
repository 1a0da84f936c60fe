//! The examples there are, and their files.

use crate::file::{Frf, csv_frf, dofs, force, matrix, truth, uff_frfs};
use crate::{Error, File, Model, clamped_plate, density, rubber_bar, rubber_bar_end, sandwich};
use frfit::c64;
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
    /// File of the measurement and the quantity in it.
    frf: (&'static str, Quantity),
    /// Whether its case names degrees of freedom instead of rows.
    names_dofs: bool,
}

static EXAMPLES: [Example; 5] = [
    Example {
        name: "rubber-bar",
        summary: "free-free rubber bar, the same force on every node: its modulus over frequency",
        case: include_str!("../cases/rubber-bar/case.toml"),
        readme: include_str!("../cases/rubber-bar/README.md"),
        model: || rubber_bar(100),
        matrices: &["K.mtx", "M.mtx"],
        frf: ("frf.uff", Quantity::Receptance),
        names_dofs: false,
    },
    Example {
        name: "rubber-bar-end",
        summary: "free-free rubber bar struck at one end: one sensor cannot tell its modulus",
        case: include_str!("../cases/rubber-bar-end/case.toml"),
        readme: include_str!("../cases/rubber-bar-end/README.md"),
        model: || rubber_bar_end(100),
        matrices: &["K.mtx", "M.mtx"],
        frf: ("frf.uff", Quantity::Accelerance),
        names_dofs: false,
    },
    Example {
        name: "clamped-plate",
        summary: "clamped steel plate, lightly damped: where the series converges and where not",
        case: include_str!("../cases/clamped-plate/case.toml"),
        readme: include_str!("../cases/clamped-plate/README.md"),
        model: || clamped_plate(20),
        matrices: &["K.rsa", "M.mtx"],
        frf: ("frf.uff", Quantity::Accelerance),
        names_dofs: true,
    },
    Example {
        name: "density",
        summary: "aluminium cantilever of unknown density: a real factor of the mass matrix",
        case: include_str!("../cases/density/case.toml"),
        readme: include_str!("../cases/density/README.md"),
        model: || density(40),
        matrices: &["K.mtx", "M.mtx"],
        frf: ("frf.csv", Quantity::Mobility),
        names_dofs: false,
    },
    Example {
        name: "sandwich",
        summary: "aluminium skins on a rubber core, clamped at one end: the modulus of the core",
        case: include_str!("../cases/sandwich/case.toml"),
        readme: include_str!("../cases/sandwich/README.md"),
        model: || sandwich(30, 1, 1),
        matrices: &["K_skins.mtx", "K_core.mtx", "M_skins.mtx", "M_core.mtx"],
        frf: ("frf.uff", Quantity::Accelerance),
        names_dofs: true,
    },
];

/// The examples there are.
pub fn list() -> &'static [Example] {
    &EXAMPLES
}

/// The files of an example, the same bytes each time: `README.md`, `case.toml`, and all that the case names.
///
/// The measurement is computed by direct solves of the same model with the true parameter, without noise.
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
        let frequency_hz = model.frequency_hz();
        files.push(self.measurement(&model, &frequency_hz)?);
        files.push(File::new("truth.csv", truth(&model, &frequency_hz)?));
        Ok(files)
    }

    /// All sensors in one UFF file; in CSV, which holds one, the first.
    fn measurement(&self, model: &Model, frequency_hz: &[f64]) -> Result<File, Error> {
        let (path, quantity) = self.frf;
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
