//! What computes the factors of a model.

use super::Overrides;
use crate::case::{DEFAULT_LAUNCH, MumpsEntry, SolverEntry};
use crate::error::{InputError, Place};
use frfit_engine::{Launch, Mumps, StartError};
use frfit_linalg::solve::{Engine, Multifrontal};
use std::path::PathBuf;

/// Names the program that the ranks run.
const PROGRAM: &str = "FRFIT_MUMPS";

/// The same with what the command line says.
pub(super) fn overridden(entry: SolverEntry, overrides: &Overrides) -> Result<SolverEntry, InputError> {
    let option = Place::option("--engine");
    let mut mumps = match overrides.engine.as_deref() {
        None => entry.mumps,
        Some("multifrontal") => None,
        Some("mumps") => Some(entry.mumps.unwrap_or_else(|| MumpsEntry {
            place: option.clone(),
            launch: DEFAULT_LAUNCH.to_owned(),
            host: None,
            out_of_core: None,
        })),
        Some(other) => {
            return Err(InputError::at(&option, "\"multifrontal\" or \"mumps\"", format!("{other:?}")));
        }
    };
    if let Some(launch) = &overrides.launch {
        let place = Place::option("--launch");
        let Some(mumps) = &mut mumps else {
            return Err(InputError::at(&place, "--engine mumps beside it", "no such engine"));
        };
        launch.clone_into(&mut mumps.launch);
        mumps.place = place;
    }
    Ok(SolverEntry { mumps })
}

/// The engine, started where it is a process of its own.
///
/// # Errors
/// Ranks that do not start.
pub(super) fn engine(entry: &SolverEntry) -> Result<Box<dyn Engine>, InputError> {
    let Some(mumps) = &entry.mumps else { return Ok(Box::new(Multifrontal)) };
    let mut launch = Launch::by(&mumps.launch);
    launch.program = program();
    launch.host.clone_from(&mumps.host);
    launch.out_of_core = mumps.out_of_core.as_ref().map(PathBuf::from);
    let refuse = |error: StartError| {
        let expected = format!("ranks of MUMPS by `{} {}`", mumps.launch, launch.program.display());
        InputError::at(&mumps.place, expected, error.to_string())
    };
    Ok(Box::new(Mumps::start(&launch).map_err(refuse)?))
}

/// The program that the environment names, the one beside this program, or the one that the launcher finds.
fn program() -> PathBuf {
    let named = || std::env::var_os(PROGRAM).map(PathBuf::from);
    let beside =
        || Some(std::env::current_exe().ok()?.with_file_name("frfit-mumps")).filter(|path| path.is_file());
    named().or_else(beside).unwrap_or_else(|| "frfit-mumps".into())
}
