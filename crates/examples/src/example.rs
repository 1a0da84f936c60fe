//! The examples there are, and their files.

use crate::file::{Frf, csv_frf, dofs, force, matrix, several_truth, truth, uff_frfs};
use crate::several::Measured;
use crate::{
    Error, File, Model, Rig, SeveralModel, added_mass, clamped_plate, density, hammer_bar, hammer_records,
    joint_stiffness, orthotropic_plate, plate_records, plate_thickness, rubber_bar, rubber_bar_end, sandwich,
    two_materials, two_meshes,
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
    unknown: Unknown,
    /// File of each term's matrix.
    matrices: &'static [&'static str],
    measurement: Measurement,
    /// Whether its case names degrees of freedom instead of rows.
    names_dofs: bool,
}

/// How much is unknown, and the model.
#[derive(Debug)]
enum Unknown {
    /// One factor.
    One(fn() -> Result<Model, Error>),
    /// Several things, or one that does not vary.
    Several(fn() -> Result<SeveralModel, Error>),
    /// One that is measured on a finer mesh, with a coarser one beside it, by their elements a side.
    Meshes(fn(usize) -> Result<SeveralModel, Error>, Meshes),
}

/// Elements a side.
#[derive(Debug)]
struct Meshes {
    measured: usize,
    model: usize,
    coarser: usize,
}

use Unknown::{One, Several};

/// What was measured, as a file.
#[derive(Debug)]
enum Measurement {
    /// FRFs of the model itself, and their quantity.
    Frf(&'static str, Quantity),
    /// A table for each sensor, with the standard deviations of its noise.
    Tables(&'static [&'static str], Quantity),
    /// Records of a hammer test, of which `frfit frf` makes the FRF.
    Records(&'static str, fn() -> Result<Vec<u8>, Error>),
}

static EXAMPLES: [Example; 12] = [
    Example {
        name: "rubber-bar",
        summary: "free-free rubber bar, the same force on every node: its modulus over frequency",
        case: include_str!("../cases/rubber-bar/case.toml"),
        readme: include_str!("../cases/rubber-bar/README.md"),
        unknown: One(|| rubber_bar(100)),
        matrices: &["K.mtx", "M.mtx"],
        measurement: Measurement::Frf("frf.uff", Quantity::Receptance),
        names_dofs: false,
    },
    Example {
        name: "rubber-bar-end",
        summary: "free-free rubber bar struck at one end: one sensor does not identify its modulus",
        case: include_str!("../cases/rubber-bar-end/case.toml"),
        readme: include_str!("../cases/rubber-bar-end/README.md"),
        unknown: One(|| rubber_bar_end(100)),
        matrices: &["K.mtx", "M.mtx"],
        measurement: Measurement::Frf("frf.uff", Quantity::Accelerance),
        names_dofs: false,
    },
    Example {
        name: "clamped-plate",
        summary: "clamped steel plate, lightly damped: where the series converges and where not",
        case: include_str!("../cases/clamped-plate/case.toml"),
        readme: include_str!("../cases/clamped-plate/README.md"),
        unknown: One(|| clamped_plate(20)),
        matrices: &["K.rsa", "M.mtx"],
        measurement: Measurement::Frf("frf.uff", Quantity::Accelerance),
        names_dofs: true,
    },
    Example {
        name: "density",
        summary: "aluminium cantilever of unknown density: a real factor of the mass matrix",
        case: include_str!("../cases/density/case.toml"),
        readme: include_str!("../cases/density/README.md"),
        unknown: One(|| density(40)),
        matrices: &["K.mtx", "M.mtx"],
        measurement: Measurement::Frf("frf.csv", Quantity::Mobility),
        names_dofs: false,
    },
    Example {
        name: "hammer-bar",
        summary: "free-free polyurethane bar, records of a hammer test: from the impact to the modulus",
        case: include_str!("../cases/hammer-bar/case.toml"),
        readme: include_str!("../cases/hammer-bar/README.md"),
        unknown: One(|| hammer_bar(400)),
        matrices: &["K.mtx", "M.mtx"],
        measurement: Measurement::Records("records.lvm", || hammer_records(1, 0.0)),
        names_dofs: false,
    },
    Example {
        name: "sandwich",
        summary: "aluminium skins on a rubber core, clamped at one end: the modulus of the core",
        case: include_str!("../cases/sandwich/case.toml"),
        readme: include_str!("../cases/sandwich/README.md"),
        unknown: One(|| sandwich(30, 1, 1)),
        matrices: &["K_skins.mtx", "K_core.mtx", "M_skins.mtx", "M_core.mtx"],
        measurement: Measurement::Frf("frf.uff", Quantity::Accelerance),
        names_dofs: true,
    },
    Example {
        name: "plate-thickness",
        summary: "plate that was rolled 10 % thinner than drawn: its thickness, from three sensors",
        case: include_str!("../cases/plate-thickness/case.toml"),
        readme: include_str!("../cases/plate-thickness/README.md"),
        unknown: Several(|| plate_thickness(10)),
        matrices: &["K.mtx", "M.mtx"],
        measurement: Measurement::Tables(&["frf-1.csv", "frf-2.csv", "frf-3.csv"], Quantity::Mobility),
        names_dofs: true,
    },
    Example {
        name: "two-materials",
        summary: "the sandwich again, its skins unknown too: two moduli at every frequency",
        case: include_str!("../cases/two-materials/case.toml"),
        readme: include_str!("../cases/two-materials/README.md"),
        unknown: Several(|| two_materials(30, 1, 1)),
        matrices: &["K_skins.mtx", "K_core.mtx", "M_skins.mtx", "M_core.mtx"],
        measurement: Measurement::Frf("frf.uff", Quantity::Accelerance),
        names_dofs: true,
    },
    Example {
        name: "joint-stiffness",
        summary: "two beams on a joint: stiffness and loss factor of the joint, one value for the band",
        case: include_str!("../cases/joint-stiffness/case.toml"),
        readme: include_str!("../cases/joint-stiffness/README.md"),
        unknown: Several(|| joint_stiffness(20)),
        matrices: &["K_beams.mtx", "K_joint.mtx", "M.mtx"],
        measurement: Measurement::Tables(&["frf-1.csv", "frf-2.csv"], Quantity::Accelerance),
        names_dofs: true,
    },
    Example {
        name: "added-mass",
        summary: "beam with a component on it: mass of the component and modulus of the beam",
        case: include_str!("../cases/added-mass/case.toml"),
        readme: include_str!("../cases/added-mass/README.md"),
        unknown: Several(|| added_mass(40)),
        matrices: &["K.mtx", "M.mtx", "M_component.mtx"],
        measurement: Measurement::Tables(&["frf-1.csv", "frf-2.csv"], Quantity::Accelerance),
        names_dofs: true,
    },
    Example {
        name: "two-meshes",
        summary: "clamped nylon plate on a coarse mesh: the mesh error, from a second, coarser mesh",
        case: include_str!("../cases/two-meshes/case.toml"),
        readme: include_str!("../cases/two-meshes/README.md"),
        unknown: Unknown::Meshes(two_meshes, Meshes { measured: 36, model: 12, coarser: 6 }),
        matrices: &["K.mtx", "M.mtx"],
        measurement: Measurement::Tables(&["frf-1.csv", "frf-2.csv", "frf-3.csv"], Quantity::Accelerance),
        names_dofs: true,
    },
    Example {
        name: "orthotropic-plate",
        summary: "free plate of spruce, records of five impacts: four constants of the wood",
        case: include_str!("../cases/orthotropic-plate/case.toml"),
        readme: include_str!("../cases/orthotropic-plate/README.md"),
        unknown: Several(|| orthotropic_plate([8, 4])),
        matrices: &["K11.mtx", "K22.mtx", "K12.mtx", "K66.mtx", "M.mtx"],
        measurement: Measurement::Records("records.lvm", || plate_records(5, 1e-3)),
        names_dofs: true,
    },
];

/// The case of a coarser mesh, and what its files are called before those of the model.
const COARSER_CASE: &str = include_str!("../cases/two-meshes/coarse.toml");
const COARSER: &str = "coarse-";

/// The examples there are.
pub fn list() -> &'static [Example] {
    &EXAMPLES
}

/// The files of an example, the same bytes each time: `README.md`, `case.toml`, and all that the case names.
///
/// The measurement is computed by direct solves of the same model with the true parameters; those in tables of their own have noise and its
/// standard deviation, and those of `hammer-bar` and `orthotropic-plate` are records ([`Example::records`]), from an exact solution and from a finer mesh.
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
            Measurement::Frf(..) | Measurement::Tables(..) => None,
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
    /// Where several things are unknown, or the measurement is not an FRF.
    pub fn files_of(
        &self,
        model: &Model,
        frequency_hz: &[f64],
        measured: &[Vec<c64>],
    ) -> Result<Vec<File>, Error> {
        let One(own) = &self.unknown else { panic!("{} has several unknowns", self.name) };
        let own = own()?;
        let mut case = self.case.to_owned();
        let named = |model: &Model| {
            let rig = model.rig();
            let sensors = (0..rig.experiment.sensors.len()).map(|m| rig.measured_dof(m));
            rig.driven_at().into_iter().chain(sensors).map(|dof| format!("\"{dof}\"")).collect::<Vec<_>>()
        };
        for (there, here) in named(&own).into_iter().zip(named(model)).filter(|_| self.names_dofs) {
            case = case.replace(&there, &here);
        }
        let mut files = vec![File::new("case.toml", case)];
        files.extend(self.model_files(model.rig())?);
        files.push(self.frf_of(model, frequency_hz, measured)?);
        Ok(files)
    }

    /// The file of what the sensors of a model like the example's measured, receptances `[frequency][sensor]`.
    ///
    /// # Errors
    /// What the writers refuse.
    ///
    /// # Panics
    /// Of an example whose measurement is made of records.
    pub fn frf_of(&self, model: &Model, frequency_hz: &[f64], measured: &[Vec<c64>]) -> Result<File, Error> {
        let Measurement::Frf(path, quantity) = &self.measurement else {
            panic!("{} has a measurement that is made of records", self.name)
        };
        self.frfs(path, *quantity, model.rig(), frequency_hz, measured)
    }

    /// Matrices, names of the rows and loads.
    fn model_files(&self, rig: Rig<'_>) -> Result<Vec<File>, Error> {
        let mut files = Vec::new();
        for (term, path) in rig.stiffness.terms().iter().zip(self.matrices) {
            files.push(File::new(path, matrix(term, path)?));
        }
        if self.names_dofs {
            files.push(File::new("dofs.csv", dofs(rig.dofs)?));
        }
        if rig.driven_at().is_none() {
            files.push(File::new("force.csv", force(&rig.experiment.load)?));
        }
        Ok(files)
    }

    fn files(&self) -> Result<Vec<File>, Error> {
        let mut files = vec![File::new("README.md", self.readme), File::new("case.toml", self.case)];
        files.extend(match &self.unknown {
            One(model) => self.files_of_one(&model()?),
            Several(model) => self.files_of_several(&model()?),
            Unknown::Meshes(model, meshes) => self.files_of_meshes(*model, meshes),
        }?);
        Ok(files)
    }

    fn files_of_one(&self, model: &Model) -> Result<Vec<File>, Error> {
        let mut files = self.model_files(model.rig())?;
        let mut frequency_hz = model.frequency_hz();
        match &self.measurement {
            Measurement::Records(path, records) => {
                files.push(File::new(path, records()?));
                // A table of a factor has to reach every line that the case may ask for.
                if let Law::Table(table) = &model.truth {
                    frequency_hz = table.frequency_hz().to_vec();
                }
            }
            _ => {
                let measured = frequency_hz.iter().map(|&f| model.measured_at(f));
                let measured = measured.collect::<Result<Vec<_>, Error>>()?;
                files.extend(self.measurement_files(model.rig(), &frequency_hz, &measured, &[])?);
            }
        }
        files.push(File::new("truth.csv", truth(model, &frequency_hz)?));
        Ok(files)
    }

    fn files_of_several(&self, model: &SeveralModel) -> Result<Vec<File>, Error> {
        let mut files = self.model_files(model.rig())?;
        let frequency_hz = model.rig().frequency_hz();
        if let Measurement::Records(path, records) = &self.measurement {
            files.push(File::new(path, records()?));
        } else {
            let Measured { receptance, std } = model.measured(&frequency_hz)?;
            files.extend(self.measurement_files(model.rig(), &frequency_hz, &receptance, &std)?);
        }
        files.push(File::new("truth.csv", several_truth(model, &frequency_hz)?));
        Ok(files)
    }

    fn files_of_meshes(
        &self,
        on_mesh: fn(usize) -> Result<SeveralModel, Error>,
        meshes: &Meshes,
    ) -> Result<Vec<File>, Error> {
        let [truth, model, coarser] = [meshes.measured, meshes.model, meshes.coarser].map(on_mesh);
        let (truth, model, coarser) = (truth?, model?, coarser?);
        let mut files = self.model_files(model.rig())?;
        files.push(File::new("coarse.toml", COARSER_CASE));
        let of_coarser = self.model_files(coarser.rig())?.into_iter();
        files.extend(of_coarser.map(|file| File { path: format!("{COARSER}{}", file.path), ..file }));
        let frequency_hz = model.rig().frequency_hz();
        let Measured { receptance, std } = truth.measured(&frequency_hz)?;
        files.extend(self.measurement_files(model.rig(), &frequency_hz, &receptance, &std)?);
        files.push(File::new("truth.csv", several_truth(&model, &frequency_hz)?));
        Ok(files)
    }

    /// What FRFs are in, `std` with those that stand in tables.
    fn measurement_files(
        &self,
        rig: Rig<'_>,
        frequency_hz: &[f64],
        measured: &[Vec<c64>],
        std: &[Vec<f64>],
    ) -> Result<Vec<File>, Error> {
        match &self.measurement {
            Measurement::Frf(path, quantity) => {
                Ok(vec![self.frfs(path, *quantity, rig, frequency_hz, measured)?])
            }
            Measurement::Tables(paths, quantity) => {
                let table = |(sensor, path): (usize, &&str)| {
                    let frf = self.frf(*quantity, rig, frequency_hz, measured, sensor);
                    let of_sensor = frequency_hz.iter().zip(std);
                    let std = of_sensor
                        .map(|(f, std)| quantity.from_receptance(*f, c64::new(std[sensor], 0.0)).norm());
                    Ok(File::new(path, csv_frf(&frf, Some(&std.collect::<Vec<_>>()))?))
                };
                paths.iter().enumerate().map(table).collect()
            }
            Measurement::Records(..) => Ok(Vec::new()),
        }
    }

    /// All sensors in one UFF file; in CSV, which holds one, the first.
    fn frfs(
        &self,
        path: &str,
        quantity: Quantity,
        rig: Rig<'_>,
        frequency_hz: &[f64],
        measured: &[Vec<c64>],
    ) -> Result<File, Error> {
        let frf = |sensor| self.frf(quantity, rig, frequency_hz, measured, sensor);
        if path.ends_with(".csv") {
            return Ok(File::new(path, csv_frf(&frf(0), None)?));
        }
        let frfs: Vec<_> = (0..rig.experiment.sensors.len()).map(frf).collect();
        Ok(File::new(path, uff_frfs(&frfs)?))
    }

    fn frf<'a>(
        &self,
        quantity: Quantity,
        rig: Rig<'_>,
        frequency_hz: &'a [f64],
        measured: &[Vec<c64>],
        sensor: usize,
    ) -> Frf<'a> {
        let of_sensor = frequency_hz.iter().zip(measured);
        Frf {
            title: self.summary,
            quantity,
            response: rig.measured_dof(sensor),
            reference: rig.driven_at(),
            frequency_hz,
            values: of_sensor.map(|(f, x)| quantity.from_receptance(*f, x[sensor])).collect(),
        }
    }
}
