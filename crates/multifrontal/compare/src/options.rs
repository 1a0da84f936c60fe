//! What is asked for on the command line.

use crate::case::RECIPES;
use crate::solver::{SOLVERS, Solver};
use std::path::PathBuf;

/// Words for the command line.
pub const USAGE: &str = "\
cargo xtask bench solvers [--matrices A,B] [--numbers complex,real] [--solvers A,B] [--threads 1,2] [--rounds N] [--csv FILE]
FRFIT_MKL names the folder of libmkl_rt.so and libiomp5.so (python3 -m venv V && V/bin/pip install mkl; FRFIT_MKL=V/lib)";

/// All of it.
pub struct Options {
    /// Names of matrices.
    pub matrices: Vec<String>,
    /// Names of numbers.
    pub numbers: Vec<String>,
    /// Solvers with their names.
    pub solvers: Vec<(&'static str, Solver)>,
    /// Numbers of threads.
    pub threads: Vec<usize>,
    /// Rounds behind a median.
    pub rounds: usize,
    /// Where to write the figures.
    pub csv: Option<PathBuf>,
}

impl Options {
    /// From the words after the program's name.
    ///
    /// # Errors
    /// A word that means nothing, with those that would.
    pub fn parse(mut words: impl Iterator<Item = String>) -> Result<Self, String> {
        let all =
            |names: &mut dyn Iterator<Item = &'static str>| names.map(str::to_owned).collect::<Vec<_>>();
        let mut options = Self {
            matrices: all(&mut RECIPES.iter().map(|recipe| recipe.name)),
            numbers: all(&mut ["complex", "real"].into_iter()),
            solvers: SOLVERS.to_vec(),
            threads: vec![1, 2],
            rounds: 5,
            csv: None,
        };
        while let Some(word) = words.next() {
            let value = words.next().ok_or_else(|| format!("{word} of what?\n{USAGE}"))?;
            let chosen = |known: &[String]| -> Result<Vec<String>, String> {
                let names: Vec<String> = value.split(',').map(str::to_owned).collect();
                let unknown = names.iter().find(|name| !known.contains(name));
                match unknown {
                    Some(name) => Err(format!("{word}: no {name:?}; there are {}", known.join(", "))),
                    None => Ok(names),
                }
            };
            let count = |text: &str| match text.parse::<usize>() {
                Ok(count) if count > 0 => Ok(count),
                _ => Err(format!("{word}: {text:?} is not a number above zero")),
            };
            match word.as_str() {
                "--matrices" => options.matrices = chosen(&options.matrices)?,
                "--numbers" => options.numbers = chosen(&options.numbers)?,
                "--solvers" => {
                    let names = chosen(&all(&mut SOLVERS.iter().map(|(name, _)| *name)))?;
                    options.solvers.retain(|(name, _)| names.iter().any(|chosen| chosen == name));
                }
                "--threads" => options.threads = value.split(',').map(count).collect::<Result<_, _>>()?,
                "--rounds" => options.rounds = count(&value)?,
                "--csv" => options.csv = Some(value.into()),
                _ => return Err(format!("{word:?} is no option\n{USAGE}")),
            }
        }
        Ok(options)
    }
}
