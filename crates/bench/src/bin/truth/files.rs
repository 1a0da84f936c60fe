//! Structures from files that are not part of the project.

use frfit::c64;
use frfit::frequency::omega_rad_s;
use frfit::material::{Law, Table};
use frfit::model::{DynamicStiffness, Experiment, Parameter, Role, Sensor, Term};
use frfit_bench::Structure;
use frfit_bench::data::{absent, data, matrix};
use frfit_linalg::sparse::SymmetricMatrix;
use std::error::Error;
use std::process::Command;

/// Matrices with their roles; the first stands behind the unknown factor, that of the others is 1.
pub(crate) struct Matrices(Vec<(&'static str, Role, SymmetricMatrix)>);

/// What is read, or why it is not there.
type Read = Result<Result<Matrices, String>, Box<dyn Error>>;

impl Matrices {
    /// Unit force on the first row, sensors on the others.
    pub(crate) fn structure(
        self,
        truth: Law,
        frequency_hz: Vec<f64>,
        [driven, sensors @ ..]: [usize; 3],
        tolerance: f64,
        loss_factor: f64,
    ) -> Result<Structure, Box<dyn Error>> {
        let one = Law::Constant(c64::new(1.0, 0.0));
        let terms = self.0.into_iter().enumerate().map(|(k, (name, role, matrix))| {
            let factor = if k == 0 { truth.clone() } else { one.clone() };
            Term { name: name.to_owned(), role, matrix, factor }
        });
        let stiffness = DynamicStiffness::new(terms.collect())?;
        let truth = Parameter::factor_of(&stiffness, &[&stiffness.terms()[0].name])?;
        let sensor = |row| Sensor { row, sign: 1.0 };
        let experiment = Experiment::driven_at(stiffness.dim(), sensor(driven), sensors.map(sensor).to_vec());
        Ok(Structure {
            stiffness,
            experiment,
            truth,
            frequency_hz,
            measured: Vec::new(),
            tolerance,
            loss_factor,
        })
    }
}

/// BCSSTK09 and BCSSTM09.
pub(crate) fn plate() -> Read {
    let folder = data().join("plate");
    if !folder.is_dir() {
        return Ok(Err(absent(&folder)));
    }
    let term = |name, role, file: &str| Ok::<_, Box<dyn Error>>((name, role, matrix(&folder.join(file))?));
    let terms = [term("plate", Role::Stiffness, "bcsstk09.mtx")?, term("mass", Role::Mass, "bcsstm09.mtx")?];
    Ok(Ok(Matrices(terms.into())))
}

/// K_v, K_e and M of NLEVP's sandwich beam.
pub(crate) fn beam() -> Read {
    let file = data().join("sandwich/sandwich_beam_168.mat");
    if !file.is_file() {
        return Ok(Err(absent(&file)));
    }
    let python = std::env::var("FRFIT_PYTHON").unwrap_or_else(|_| "python3".into());
    let has_scipy = Command::new(&python).args(["-c", "import scipy"]).output();
    if !has_scipy.is_ok_and(|output| output.status.success()) {
        return Ok(Err(format!("{python} has no SciPy (set FRFIT_PYTHON to one that has)")));
    }
    let folder = tempfile::tempdir()?;
    let output =
        Command::new(&python).args(["-c", TO_MATRIX_MARKET]).arg(&file).arg(folder.path()).output()?;
    if !output.status.success() {
        return Err(String::from_utf8_lossy(&output.stderr).into());
    }
    let term = |role, name| {
        Ok::<_, Box<dyn Error>>((name, role, matrix(&folder.path().join(format!("{name}.mtx")))?))
    };
    let terms = [term(Role::Stiffness, "Kv")?, term(Role::Stiffness, "Ke")?, term(Role::Mass, "M")?];
    Ok(Ok(Matrices(terms.into())))
}

/// The triangles of the file differ by roundoff: their mean is kept.
const TO_MATRIX_MARKET: &str = r#"
import sys, scipy.io as io, scipy.sparse as sp
file, folder = sys.argv[1:]
for name, a in io.loadmat(file).items():
    if not name.startswith("__"):
        io.mmwrite(f"{folder}/{name}.mtx", sp.coo_matrix((a + a.T) / 2), symmetry="symmetric", precision=17)
"#;

/// Shear modulus of the beam's core, Zener's with a fractional derivative: (G₀ + G∞ (iωτ)^α)/(1 + (iωτ)^α).
///
/// # Source
/// R. Van Beeumen, K. Meerbergen, W. Michiels, SIAM J. Sci. Comput. 35 (2013) A327–A350; G∞ as the authors' program has it.
pub(crate) fn zener(frequency_hz: &[f64]) -> Result<Law, Box<dyn Error>> {
    let (g0, g_infinity, alpha, tau) = (3.504e5, 3.062e9, 0.675, 8.230e-9);
    let at = |&f: &f64| {
        let power = (c64::I * omega_rad_s(f) * tau).powf(alpha);
        (g0 + g_infinity * power) / (1.0 + power)
    };
    Ok(Law::Table(Table::new(frequency_hz.to_vec(), frequency_hz.iter().map(at).collect())?))
}
