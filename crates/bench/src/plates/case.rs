//! A plate as a user has it: matrices, the FRF of its impacts, and a case file.

use super::Plate;
use crate::data::data;
use crate::wrong_models::Failure;
use flate2::read::GzDecoder;
use frfit::c64;
use frfit::material::Law;
use frfit::model::{Role, Term};
use frfit::signal::Options;
use frfit_fem::{Direction, OrthotropicPlate, inset_lines};
use frfit_workflow::job::frf_of_records;
use frfit_workflow::records::ChannelOptions;
use std::fmt::Write;
use std::fs::{self, File};
use std::io::Read;
use std::path::{Path, PathBuf};

/// Names of the constants, in the order of the plate's matrices.
pub const NAMES: [&str; 4] = ["D11", "D22", "D12", "D66"];

/// Nominal values in Pa: those of spruce in a handbook, for all plates.
pub const NOMINAL: [f64; 4] = [1.05e10, 9e8, 3e8, 7e8];

/// Nominal loss factor of all of them.
pub const LOSS_FACTOR: f64 = 0.015;

/// Bounds in Pa, which hold for all plates.
pub const BOUNDS: [[f64; 2]; 4] = [[4e9, 2.5e10], [3e8, 3e9], [3e7, 1.5e9], [2e8, 2e9]];

/// Moduli of transverse shear in Pa, along and across the grain, of a thick plate: those of spruce in a handbook, of which the second is that of rolling shear. They are taken for known to
/// a quarter.
///
/// # Source
/// F. H. Neuhaus, Holz als Roh- und Werkstoff 52 (1994) 41–46: 0.74 and 0.042 GPa at a moisture of 12 %.
pub const SHEAR: [(&str, f64); 2] = [("G_LT", 7.4e8), ("G_RT", 4.2e7)];

/// Standard deviation of [`SHEAR`]: trees differ by a quarter.
const SHEAR_STD: &str = "25 %";

/// From either edge to where the plates are hit and measured, in m.
const INSET: f64 = 0.02;

/// Sampling of the records in Hz.
const SAMPLING_HZ: f64 = 48_000.0;

/// What a case of a plate takes of what there is.
#[derive(Debug, Clone, PartialEq)]
pub struct Setting {
    /// Elements along and across the grain between the points that are hit and measured.
    pub elements: [usize; 2],
    /// Whether the model has transverse shear.
    pub thick: bool,
    /// First and last frequency in Hz.
    pub band_hz: [f64; 2],
    /// The most frequencies to identify at.
    pub max_lines: usize,
    /// Which of the five impacts, from 1.
    pub impacts: Vec<usize>,
    /// Nominal values of the constants: storage in Pa, and loss factor.
    pub nominal: [[f64; 2]; 4],
    /// Moduli of transverse shear in Pa, in the order of [`SHEAR`].
    pub shear: [f64; 2],
    /// Mass of the accelerometer in kg.
    pub sensor_mass: f64,
    /// In which unit the acceleration is said to be.
    pub unit: &'static str,
    /// A line about the measurement.
    pub measurement: &'static str,
}

impl Default for Setting {
    /// All impacts from 35 Hz to 700 Hz on a fine mesh, in g, of either sense and unknown scale.
    fn default() -> Self {
        Self {
            elements: [14, 6],
            thick: false,
            band_hz: [35.0, 700.0],
            max_lines: 400,
            impacts: (1..=5).collect(),
            nominal: NOMINAL.map(|storage| [storage, LOSS_FACTOR]),
            shear: SHEAR.map(|(_, storage)| storage),
            sensor_mass: 0.0,
            unit: "g",
            measurement: "scale = \"unknown\"",
        }
    }
}

impl Plate {
    /// Writes the case with all its files into a folder; its path.
    ///
    /// # Errors
    /// [`Failure`] where there are no records, or a file cannot be written.
    pub fn case(&self, setting: &Setting, folder: &Path) -> Result<PathBuf, Failure> {
        let path = |name: &str| folder.join(name);
        let [length, width, thickness] = self.size;
        let lines = [0, 1].map(|axis| inset_lines(self.size[axis], INSET, setting.elements[axis]));
        let plate =
            OrthotropicPlate { lines, thickness, thick: setting.thick, ..OrthotropicPlate::default() };
        let assembled = plate.assemble()?;
        let mut case = String::from("title = \"Spruce\"\n");
        let density = self.mass / (length * width * thickness);
        let modulus = |storage: f64, loss_factor: f64, std: &str| {
            format!("{{ storage = {storage:e}, loss_factor = {loss_factor:e}{std} }}")
        };
        let bending =
            NAMES.into_iter().zip(setting.nominal.map(|[storage, loss]| modulus(storage, loss, "")));
        let std = format!(", storage_std = \"{SHEAR_STD}\", loss_factor_std = \"50 %\"");
        let shear = SHEAR.into_iter().zip(setting.shear);
        let shear = shear.map(|((name, _), storage)| (name, modulus(storage, LOSS_FACTOR, &std)));
        let stiffness = bending.chain(shear).zip(&assembled.stiffness);
        let stiffness = stiffness.map(|((name, factor), matrix)| (name, Role::Stiffness, matrix, factor));
        let mass = ("mass", Role::Mass, &assembled.mass[0], format!("{density:e}"));
        for (name, role, matrix, factor) in stiffness.chain([mass]) {
            let nominal = Law::Constant(c64::new(1.0, 0.0));
            let term = Term { name: name.to_owned(), role, matrix: matrix.clone(), factor: nominal };
            fs::write(path(name), frfit_examples::matrix(&term, name)?)?;
            let role = if role == Role::Mass { "mass" } else { "stiffness" };
            write!(
                case,
                "[[matrix]]\nname = \"{name}\"\nrole = \"{role}\"\nfile = \"{name}\"\nfactor = {factor}\n"
            )?;
        }
        let row = |position: [f64; 2]| {
            let node = assembled.nearest([position[0], position[1], 0.0]);
            let row = node.and_then(|node| assembled.row(node, Direction::Z));
            row.map(|row| row + 1).ok_or("a plate without nodes")
        };
        let (hit, sensor) = (row([INSET; 2])?, row([length - INSET, width - INSET])?);
        write!(
            case,
            "[load]\nrow = {hit}\n[[measurement]]\nfile = \"frf.uff\"\nrow = {sensor}\nquantity = \"accelerance\"\n{}\n",
            setting.measurement
        )?;
        if setting.sensor_mass > 0.0 {
            write!(case, "[[attached]]\nrow = {sensor}\nmass_kg = {:e}\n", setting.sensor_mass)?;
        }
        for (k, (name, [low, high])) in NAMES.iter().zip(BOUNDS).enumerate() {
            write!(
                case,
                "[[identify]]\nmatrix = \"{name}\"\nvaries = \"constant\"\nbounds = {{ storage = [{low:e}, {high:e}], loss_factor = [0.0, 0.1] }}\n"
            )?;
            if k == 0 {
                let [first, last] = setting.band_hz;
                write!(case, "band_hz = [{first:?}, {last:?}]\nmax_lines = {}\n", setting.max_lines)?;
            }
        }
        fs::write(path("case.toml"), case)?;
        let records = setting.impacts.iter().map(|&k| self.record(k, setting.unit, folder));
        let records = records.collect::<Result<Vec<_>, _>>()?;
        let channels = ChannelOptions::default();
        frf_of_records(&records, &channels, &Options::default(), &path("frf.uff"), None)?;
        Ok(path("case.toml"))
    }

    /// The record of an impact as a table with its units.
    fn record(&self, impact: usize, unit: &str, folder: &Path) -> Result<PathBuf, Failure> {
        let file = data().join(format!("spruce/plate_{}_hit_{impact}.csv.gz", self.name));
        let packed = File::open(&file).map_err(|_| crate::data::absent(&file))?;
        let mut text = String::new();
        GzDecoder::new(packed).read_to_string(&mut text)?;
        let mut table = format!("time_s,Force (N),Acceleration ({unit})\n");
        for (k, line) in text.lines().skip(1).enumerate() {
            writeln!(table, "{:.9},{line}", k as f64 / SAMPLING_HZ)?;
        }
        let file = folder.join(format!("{impact}.csv"));
        fs::write(&file, table)?;
        Ok(file)
    }
}
