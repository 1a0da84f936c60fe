//! The files of a case: read once, recorded with their checksums.

use crate::case::Located;
use crate::error::{InputError, Place};
use frfit_formats::FormatError;
use sha2::{Digest, Sha256};
use std::fs;
use std::io::ErrorKind;
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
    /// The path and the checksum of the bytes.
    pub(crate) fn of(path: &Path, bytes: &[u8]) -> Self {
        let sha256 = Sha256::digest(bytes).iter().map(|byte| format!("{byte:02x}")).collect();
        Self { path: path.to_path_buf(), sha256, bytes: bytes.len() }
    }
}

/// A file that was read, and the key that names it.
#[derive(Debug, Clone)]
pub(super) struct NamedFile {
    /// Its path from where the program runs.
    pub(super) path: PathBuf,
    /// What is in it.
    pub(super) bytes: Rc<Vec<u8>>,
    /// The key of the case.
    pub(super) named_by: Place,
}

impl NamedFile {
    /// What is wrong in the file, with its name and the key that names it.
    pub(super) fn refuse(&self, error: FormatError) -> InputError {
        InputError::in_file(&self.path, error).named_by(&self.named_by)
    }
}

/// All files read so far.
#[derive(Debug)]
pub(super) struct Files {
    folder: PathBuf,
    pub(super) inputs: Vec<InputFile>,
    /// Measurements often share one large file, one after the other.
    last: Option<(PathBuf, Rc<Vec<u8>>)>,
}

impl Files {
    /// Reads a case file; paths in it are relative to it.
    pub(super) fn of_case(case_file: &Path) -> Result<(Self, Vec<u8>), InputError> {
        let bytes =
            read(case_file).map_err(|found| InputError::at(&Place::file(case_file), "a case file", found))?;
        let folder = case_file.parent().unwrap_or(Path::new("")).to_path_buf();
        let mut files = Self { folder, inputs: Vec::new(), last: None };
        files.record(case_file, &bytes);
        Ok((files, bytes))
    }

    /// Reads a file that a key of the case names.
    pub(super) fn read(&mut self, name: &Located<String>) -> Result<NamedFile, InputError> {
        if name.value.is_empty() {
            return Err(InputError::at(&name.place, "the path of a file", "an empty text"));
        }
        let path = self.folder.join(&name.value);
        let bytes = match &self.last {
            Some((last, bytes)) if *last == path => Rc::clone(bytes),
            _ => {
                let expected = format!("a file at {}", path.display());
                Rc::new(read(&path).map_err(|found| InputError::at(&name.place, expected, found))?)
            }
        };
        self.last = Some((path.clone(), Rc::clone(&bytes)));
        self.record(Path::new(&name.value), &bytes);
        Ok(NamedFile { path, bytes, named_by: name.place.clone() })
    }

    fn record(&mut self, path: &Path, bytes: &[u8]) {
        if self.inputs.iter().all(|input| input.path != path) {
            self.inputs.push(InputFile::of(path, bytes));
        }
    }
}

/// The bytes of a file, or what is there instead. What is no plain file (a directory, a pipe that never ends) is
/// not opened.
pub(super) fn read(path: &Path) -> Result<Vec<u8>, String> {
    let failure = |error: std::io::Error| match error.kind() {
        ErrorKind::NotFound => "none".to_owned(),
        kind => format!("one that cannot be read ({kind})"),
    };
    let metadata = fs::metadata(path).map_err(failure)?;
    if metadata.is_dir() {
        return Err("a folder".into());
    }
    if !metadata.is_file() {
        return Err("something that is no plain file".into());
    }
    fs::read(path).map_err(failure)
}
