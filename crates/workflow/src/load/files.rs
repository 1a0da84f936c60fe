//! The files of a case: read once, recorded with their checksums.

use super::frf::{Choice, Frf};
use super::uff::{self, Index};
use crate::case::Located;
use crate::error::{InputError, Place};
use crate::output::sha256;
use crate::reads::Reads;
use crate::reduced::read_reduced;
use frfit::model::{DynamicStiffness, Experiment};
use frfit::subspace::KeptSubspace;
use frfit_formats::{FileKind, FormatError, csv, detect};
use serde_json::{Value, json};
use std::cell::OnceCell;
use std::collections::HashSet;
use std::path::{Path, PathBuf};
use std::rc::Rc;

/// A file that a result depends on.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct InputFile {
    /// The path as it was given.
    pub path: PathBuf,
    /// SHA-256 of its bytes, in hexadecimal.
    pub sha256: String,
    /// Number of its bytes.
    pub bytes: usize,
}

impl InputFile {
    /// All of them, as summaries list them.
    pub(crate) fn json(all: &[Self]) -> Vec<Value> {
        let one = |input: &Self| json!({"file": input.path.display().to_string(), "bytes": input.bytes, "sha256": input.sha256});
        all.iter().map(one).collect()
    }

    /// The path and the checksum of the bytes.
    pub(crate) fn of(path: &Path, bytes: &[u8]) -> Self {
        Self { path: path.to_path_buf(), sha256: sha256(bytes), bytes: bytes.len() }
    }
}

/// A file that was read, and the key that names it.
#[derive(Debug, Clone)]
pub(super) struct NamedFile {
    /// Its path from where the program runs.
    pub(super) path: PathBuf,
    /// Contents.
    pub(super) bytes: Rc<Vec<u8>>,
    /// Of a UFF file what is where in it, from its first FRF on.
    index: Rc<OnceCell<Index>>,
    /// The key of the case.
    pub(super) named_by: Place,
}

impl NamedFile {
    /// The FRF of a choice.
    pub(super) fn frf(&self, choice: &Choice) -> Result<Frf, FormatError> {
        if choice.columns.is_some() || detect(&self.bytes) != Some(FileKind::Uff) {
            return read_frf(&self.bytes, choice);
        }
        let index = match self.index.get() {
            Some(index) => index,
            None => {
                let index = Index::of(&self.bytes)?;
                self.index.get_or_init(|| index)
            }
        };
        index.read(&self.bytes, choice)
    }

    /// The same without its contents.
    pub(super) fn closed(self) -> Self {
        Self::closed_at(&self.path, self.named_by)
    }

    /// A place without contents.
    pub(super) fn closed_at(path: &Path, named_by: Place) -> Self {
        Self { path: path.to_path_buf(), bytes: Default::default(), index: Default::default(), named_by }
    }

    /// What is wrong in the file, with its name and the key that names it.
    pub(super) fn refuse(&self, error: FormatError) -> InputError {
        InputError::in_file(&self.path, error).named_by(&self.named_by)
    }
}

/// Path, contents, and what is where in them.
type Last = (PathBuf, Rc<Vec<u8>>, Rc<OnceCell<Index>>);

/// All files read so far.
#[derive(Debug)]
pub(super) struct Files {
    folder: PathBuf,
    pub(super) inputs: Vec<InputFile>,
    /// Of all of them where they are.
    pub(super) reads: Reads,
    known: HashSet<PathBuf>,
    /// Measurements often share one large file, one after the other.
    last: Option<Last>,
}

impl Files {
    /// Reads a case file; paths in it are relative to it.
    pub(super) fn of_case(case_file: &Path) -> Result<(Self, Vec<u8>), InputError> {
        let mut reads = Reads::default();
        let bytes = reads
            .read(case_file)
            .map_err(|found| InputError::at(&Place::file(case_file), "a case file", found))?;
        let folder = case_file.parent().unwrap_or(Path::new("")).to_path_buf();
        let mut files = Self { reads, ..Self::in_folder(folder) };
        files.record(case_file, &bytes);
        Ok((files, bytes))
    }

    fn in_folder(folder: PathBuf) -> Self {
        let (inputs, reads) = (Vec::new(), Reads::default());
        Self { folder, inputs, reads, known: HashSet::new(), last: None }
    }

    /// None yet, of the same case.
    pub(super) fn of_the_same_case(&self) -> Self {
        Self::in_folder(self.folder.clone())
    }

    /// The case's folder.
    pub(super) fn folder(&self) -> &Path {
        &self.folder
    }

    /// Files that were read for another case too.
    pub(super) fn extend(&mut self, inputs: &[InputFile], reads: &Reads) {
        let new = inputs.iter().filter(|input| self.known.insert(input.path.clone()));
        self.inputs.extend(new.cloned());
        self.reads.extend(reads.clone());
    }

    /// Where a file is that a key of the case names.
    pub(super) fn beside(&self, name: &Located<String>) -> Result<PathBuf, InputError> {
        match name.value.is_empty() {
            true => Err(InputError::at(&name.place, "the path of a file", "an empty text")),
            false => Ok(self.folder.join(&name.value)),
        }
    }

    /// Reads a file that a key of the case names.
    pub(super) fn read(&mut self, name: &Located<String>) -> Result<NamedFile, InputError> {
        let path = self.beside(name)?;
        let (bytes, index) = match &self.last {
            Some((last, bytes, index)) if *last == path => (Rc::clone(bytes), Rc::clone(index)),
            _ => {
                let expected = format!("a file at {}", path.display());
                let bytes = self.reads.read(&path);
                (Rc::new(bytes.map_err(|found| InputError::at(&name.place, expected, found))?), Rc::default())
            }
        };
        self.last = Some((path.clone(), Rc::clone(&bytes), Rc::clone(&index)));
        self.record(Path::new(&name.value), &bytes);
        Ok(NamedFile { path, bytes, index, named_by: name.place.clone() })
    }

    /// Reads a file that an option of the command line names, from where the program runs.
    pub(super) fn read_option(&mut self, path: &Path, option: &str) -> Result<NamedFile, InputError> {
        let place = Place::option(option);
        let expected = || format!("a file at {}", path.display());
        let bytes = self.reads.read(path).map_err(|found| InputError::at(&place, expected(), found))?;
        self.record(path, &bytes);
        let index = Rc::default();
        Ok(NamedFile { path: path.to_path_buf(), bytes: Rc::new(bytes), index, named_by: place })
    }

    /// The reduced model in a file that `--reduced` names.
    pub(super) fn read_reduced(
        &mut self,
        path: &Path,
        model: &DynamicStiffness,
        experiment: &Experiment,
    ) -> Result<KeptSubspace, InputError> {
        let file = self.read_option(path, "--reduced")?;
        read_reduced(path, &file.bytes, model, experiment)
    }

    fn record(&mut self, path: &Path, bytes: &[u8]) {
        if self.known.insert(path.to_path_buf()) {
            self.inputs.push(InputFile::of(path, bytes));
        }
    }
}

/// The bytes of a plain file, which is one of those that were read from now on.
///
/// # Errors
/// The path names no file, a folder, or a file that may not be read.
pub fn load_bytes(path: &Path, reads: &mut Reads) -> Result<Vec<u8>, InputError> {
    reads.read(path).map_err(|found| InputError::at(&Place::file(path), "a file", found))
}

/// Reads an FRF from a UFF file or a table.
///
/// # Errors
/// What the readers refuse; in a UFF file: no FRF, none or several that the choice fits, one that was cut short,
/// real values, frequencies that are not ascending, units that contradict each other.
pub fn read_frf(bytes: &[u8], choice: &Choice) -> Result<Frf, FormatError> {
    let found = match detect(bytes) {
        Some(FileKind::Uff) => {
            if let Some(names) = &choice.columns {
                let expected = "no names of columns, which a UFF file has not";
                return Err(FormatError::whole(expected, names.join(", ")));
            }
            return uff::read(bytes, choice);
        }
        Some(FileKind::Csv) => return table(bytes, choice),
        Some(other) => other.to_string(),
        None if bytes.is_empty() => "an empty file".into(),
        None => "neither (no -1 in line 1, no names of columns)".into(),
    };
    Err(FormatError::whole("an FRF: a UFF file or a table (CSV)", found))
}

/// A table has one FRF, and says neither what nor where it is, only in a comment line how it was windowed.
fn table(bytes: &[u8], choice: &Choice) -> Result<Frf, FormatError> {
    if let Some(record) = choice.record.filter(|&record| record != 1) {
        return Err(FormatError::whole("no record number, or 1: a table has one FRF", record.to_string()));
    }
    let read = match &choice.columns {
        Some(names) => csv::read_frf_named(bytes, &names.iter().map(String::as_str).collect::<Vec<_>>())?,
        None => csv::read_frf(bytes)?,
    };
    let csv::FrfTable { frequency_hz, response, coherence, std, decay_per_s } = read;
    let (quantity, measured_at, driven_at) = (None, None, None);
    Ok(Frf { frequency_hz, response, coherence, std, quantity, measured_at, driven_at, decay_per_s })
}
