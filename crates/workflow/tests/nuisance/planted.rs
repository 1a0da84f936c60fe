//! A structure whose measurement is made with what a test plants in it: four nodes that move in X and Z, on springs.

use frfit::c64;
use frfit::frequency::omega_rad_s;
use frfit::material::Law;
use frfit::model::{DynamicStiffness, Experiment, Role, Sensor, Term};
use frfit::response::{FullModel, Response};
use frfit_linalg::sparse::Triplets;
use frfit_workflow::job::{IdentifyJob, JobError, identify_case};
use frfit_workflow::load::Overrides;
use frfit_workflow::run::RunOptions;
use std::fmt::Write;
use std::fs;
use tempfile::TempDir;

pub(crate) const DIM: usize = 8;

/// The springs' factor, N/m.
pub(crate) const TRUTH: c64 = c64::new(2.2e5, 1.1e4);

/// Springs between rows (from 0), and one to ground.
pub(crate) fn springs() -> Triplets {
    let mut k = Triplets::new(DIM);
    k.add(0, 0, 1.0);
    for i in 0..DIM {
        for (j, stiffness) in [(i + 1, 1.0), (i + 3, 0.4)] {
            if j < DIM {
                k.add_element(&[Some(i), Some(j)], &[stiffness, -stiffness, -stiffness, stiffness]);
            }
        }
    }
    k
}

fn term(name: &str, role: Role, triplets: Triplets, factor: c64) -> Term {
    Term { name: name.into(), role, matrix: triplets.assemble(), factor: Law::Constant(factor) }
}

/// What is on the structure that is measured: (role, row from 0, value).
pub(crate) type OnIt = (Role, usize, f64);

/// The receptance in rows (from 0) of the structure with something on it, driven at its first row: `[frequency][row]`.
pub(crate) fn receptance(on_it: &[OnIt], rows: &[usize], frequency_hz: &[f64]) -> Vec<Vec<c64>> {
    let mut mass = Triplets::new(DIM);
    (0..DIM).for_each(|i| mass.add(i, i, 1.0));
    let one = c64::new(1.0, 0.0);
    let mut terms =
        vec![term("springs", Role::Stiffness, springs(), TRUTH), term("mass", Role::Mass, mass, one)];
    for (k, &(role, row, value)) in on_it.iter().enumerate() {
        let mut single = Triplets::new(DIM);
        single.add(row, row, value);
        terms.push(term(&format!("{k}"), role, single, one));
    }
    let model = DynamicStiffness::new(terms).unwrap();
    let sensor = |row: usize| Sensor { row, sign: 1.0 };
    let experiment = Experiment::driven_at(DIM, sensor(0), rows.iter().copied().map(sensor).collect());
    let at = |&f: &f64| FullModel::new(model.at(f, &[]).unwrap(), &experiment).unwrap();
    frequency_hz.iter().map(|f| at(f).respond_nominal().unwrap()).collect()
}

/// An FRF as a table, its values and their standard deviation as a part of them.
pub(crate) fn table(frequency_hz: &[f64], values: &[c64], share: Option<f64>) -> String {
    let mut text =
        String::from(if share.is_some() { "frequency_hz,re,im,std\n" } else { "frequency_hz,re,im\n" });
    for (f, x) in frequency_hz.iter().zip(values) {
        write!(text, "{f},{},{}", x.re, x.im).unwrap();
        if let Some(share) = share {
            write!(text, ",{}", share * x.norm()).unwrap();
        }
        text += "\n";
    }
    text
}

/// A case in a folder of its own: matrices, names, measurements `0.csv`, `1.csv` … and whatever tables the test adds.
pub(crate) fn folder(tables: &[String], keys: &str) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).unwrap();
    let matrix = springs().assemble();
    let mut entries = Vec::new();
    for col in 0..DIM {
        for row in col..DIM {
            let value = matrix.get(row, col).re;
            if value != 0.0 {
                entries.push(format!("{} {} {value}", row + 1, col + 1));
            }
        }
    }
    let header = "%%MatrixMarket matrix coordinate real symmetric\n";
    write("K.mtx", &format!("{header}{DIM} {DIM} {}\n{}\n", entries.len(), entries.join("\n")));
    let ones: String = (1..=DIM).map(|i| format!("{i} {i} 1\n")).collect();
    write("M.mtx", &format!("{header}{DIM} {DIM} {DIM}\n{ones}"));
    let names: String =
        (0..DIM).map(|i| format!("{},{},{}\n", i + 1, i / 2 + 1, ["X", "Z"][i % 2])).collect();
    write("dofs.csv", &format!("row,node,direction\n{names}"));
    for (k, table) in tables.iter().enumerate() {
        write(&format!("{k}.csv"), table);
    }
    let case = format!(
        "[[matrix]]\nname = \"springs\"\nrole = \"stiffness\"\nfile = \"K.mtx\"\nfactor = {{ storage = 2e5, loss_factor = 0.02 }}\n\
         [[matrix]]\nname = \"mass\"\nrole = \"mass\"\nfile = \"M.mtx\"\n[dofs]\nfile = \"dofs.csv\"\n[load]\ndof = \"1+X\"\n{keys}\n"
    );
    write("case.toml", &case);
    folder
}

/// Runs the case of a folder into its subfolder `out`.
pub(crate) fn run(folder: &TempDir) -> Result<IdentifyJob, JobError> {
    let out = folder.path().join("out");
    let case = folder.path().join("case.toml");
    identify_case(&case, &Overrides::default(), RunOptions::default(), &out, &|_, _| {})
}

/// The message of what is refused, with the folder's path left out.
pub(crate) fn refusal(folder: &TempDir) -> String {
    let message = run(folder).expect_err("a refusal").to_string();
    message.replace(&format!("{}/", folder.path().display()), "")
}

/// How far the factor is from the truth at worst, relative, over the frequencies that have an answer; and how many have one.
pub(crate) fn worst(job: &IdentifyJob) -> (f64, usize) {
    let off = job.run.found.lines.iter().filter_map(|o| Some((o.factor()? - TRUTH).norm() / TRUTH.norm()));
    let off: Vec<f64> = off.collect();
    (off.iter().copied().fold(0.0, f64::max), off.len())
}

/// e^{iωt}.
pub(crate) fn turned(frequency_hz: f64, time_s: f64) -> c64 {
    c64::from_polar(1.0, omega_rad_s(frequency_hz) * time_s)
}
