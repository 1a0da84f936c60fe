//! MUMPS in a process of its own: a small C program that is compiled when it is needed, and matrices in files.

use crate::case::{Case, Number, RIGHT_HAND_SIDES};
use crate::round::{Report, Round, Time, median};
use std::fs::File;
use std::io::{BufWriter, Read, Write};
use std::path::{Path, PathBuf};
use std::process::Command;

/// The two programs, and MKL to preload as their BLAS.
pub struct Mumps {
    folder: PathBuf,
    blas: Option<PathBuf>,
}

impl Mumps {
    /// Compiles the programs into a folder; with MKL's folder they take its BLAS in place of the system's.
    ///
    /// # Errors
    /// What cc says, mostly that the headers of MUMPS are missing.
    pub fn compile(folder: &Path, mkl: Option<&Path>) -> Result<Self, String> {
        let source = folder.join("mumps.c");
        std::fs::create_dir_all(folder).map_err(|error| error.to_string())?;
        std::fs::write(&source, include_str!("mumps.c")).map_err(|error| error.to_string())?;
        for (name, library, flags) in
            [("real", "-ldmumps_seq", None), ("complex", "-lzmumps_seq", Some("-DCOMPLEX"))]
        {
            let mut cc = Command::new("cc");
            cc.args(["-O2", "-I/usr/include/mumps_seq", "-o"])
                .arg(folder.join(name))
                .args(flags)
                .arg(&source);
            let outcome = cc.arg(library).output().map_err(|error| format!("cc: {error}"))?;
            if !outcome.status.success() {
                let words = String::from_utf8_lossy(&outcome.stderr);
                let first =
                    words.lines().find(|line| line.contains("error")).unwrap_or("cc failed").to_owned();
                return Err(format!("{first} (Debian: libmumps-seq-dev)"));
            }
        }
        let blas = mkl.and_then(|folder| {
            let entries = std::fs::read_dir(folder).ok()?.flatten();
            entries.map(|entry| entry.path()).find(|path| {
                path.file_name().is_some_and(|name| name.to_string_lossy().starts_with("libmkl_rt.so"))
            })
        });
        Ok(Self { folder: folder.to_owned(), blas })
    }

    /// Whose BLAS it runs on.
    pub fn blas(&self) -> &'static str {
        if self.blas.is_some() { "MKL's BLAS" } else { "the system's libblas.so.3" }
    }

    /// One round with MUMPS's defaults, symmetric, without refinement.
    ///
    /// # Errors
    /// MUMPS's, or that a file or the program failed.
    pub fn round<T: Number>(&self, case: &Case<T>, threads: usize) -> Result<Round<T>, String> {
        let (matrix, solution) = (self.folder.join("matrix"), self.folder.join("solution"));
        write(case, &matrix).map_err(|error| format!("{}: {error}", matrix.display()))?;
        let mut program = Command::new(self.folder.join(T::NAME));
        program.arg(&matrix).arg(&solution);
        for name in ["OMP_NUM_THREADS", "MKL_NUM_THREADS", "OPENBLAS_NUM_THREADS"] {
            program.env(name, threads.to_string());
        }
        if let Some(blas) = &self.blas {
            // PyPI's MKL has Intel's convention only, which differs from gfortran's where a complex number is returned: MUMPS
            // calls no such function.
            program.env("LD_PRELOAD", blas).env("MKL_INTERFACE_LAYER", "LP64").env("MKL_DYNAMIC", "FALSE");
            if threads == 1 {
                program.env("MKL_THREADING_LAYER", "SEQUENTIAL");
            } else {
                let folder = blas.parent().unwrap_or(Path::new("."));
                program.env("MKL_THREADING_LAYER", "INTEL").env("LD_LIBRARY_PATH", folder);
            }
        }
        let outcome = program.output().map_err(|error| error.to_string())?;
        let _ = std::fs::remove_file(&matrix);
        if !outcome.status.success() {
            return Err(format!("{}: {}", outcome.status, String::from_utf8_lossy(&outcome.stderr).trim()));
        }
        let figures = Figures(String::from_utf8_lossy(&outcome.stdout).into_owned());
        let mut bytes = Vec::new();
        let read = File::open(&solution).and_then(|mut file| file.read_to_end(&mut bytes));
        read.map_err(|error| format!("{}: {error}", solution.display()))?;
        let numbers: Vec<f64> = bytes
            .chunks_exact(8)
            .map(|eight| f64::from_ne_bytes(std::array::from_fn(|i| eight[i])))
            .collect();
        let parts = size_of::<T>() / size_of::<f64>();
        Ok(figures.round(numbers.chunks_exact(parts).map(|z| T::of_parts(z[0], z[parts - 1])).collect()))
    }
}

/// What the program prints.
struct Figures(String);

impl Figures {
    fn all<'a>(&'a self, name: &'a str) -> impl Iterator<Item = Vec<f64>> + 'a {
        let lines = self.0.lines().filter_map(move |line| line.strip_prefix(name)?.strip_prefix(' '));
        lines.map(|rest| rest.split(' ').filter_map(|number| number.parse().ok()).collect())
    }

    fn time(&self, name: &str) -> Time {
        let times: Vec<Time> = self
            .all(name)
            .filter_map(|numbers| Some(Time { wall: *numbers.first()?, cpu: *numbers.get(1)? }))
            .collect();
        median(&times)
    }

    fn number(&self, name: &str) -> Option<f64> {
        self.all(name).next()?.first().copied()
    }

    fn round<T: Number>(&self, solution: Vec<T>) -> Round<T> {
        let count = |name| self.number(name).unwrap_or(0.0);
        let ordering = match count("ordering") as usize {
            0 => "AMD",
            2 => "AMF",
            3 => "Scotch",
            4 => "PORD",
            5 => "METIS",
            6 => "QAMD",
            _ => "another ordering",
        };
        let mut remark = ordering.to_owned();
        for name in ["delayed", "perturbed"] {
            if count(name) > 0.0 {
                remark += &format!("; {} pivots {name}", count(name));
            }
        }
        let report = Report {
            memory: self.number("memory"),
            entries: self.number("entries").map(|entries| entries / 1e6),
            gflop: self.number("flops").map(|flops| T::FLOPS * flops / 1e9),
            negative: (T::NAME == "real").then(|| count("negative") as usize),
            remark,
        };
        let [analysis, factor, solve_1, solve_8] =
            ["analysis", "factor", "solve_1", "solve_8"].map(|name| self.time(name));
        let peak = self.number("peak").map(|kilobytes| kilobytes * 1024.0 / 1e6);
        Round { analysis, factor, solve_1, solve_8, report, peak, solution }
    }
}

fn write<T: Number>(case: &Case<T>, path: &Path) -> std::io::Result<()> {
    let mut file = BufWriter::new(File::create(path)?);
    for number in [case.dim(), case.pattern.stored(), RIGHT_HAND_SIDES] {
        file.write_all(&(number as i64).to_ne_bytes())?;
    }
    for (row, _) in case.pattern.positions() {
        file.write_all(&(row as i32 + 1).to_ne_bytes())?;
    }
    for (_, col) in case.pattern.positions() {
        file.write_all(&(col as i32 + 1).to_ne_bytes())?;
    }
    for value in case.values.iter().chain(&case.rhs) {
        let z = value.complex();
        file.write_all(&z.re.to_ne_bytes())?;
        if T::NAME == "complex" {
            file.write_all(&z.im.to_ne_bytes())?;
        }
    }
    file.flush()
}
