//! The results of an identification as one HTML page, from memory or from the folder that has them.

use crate::error::{InputError, Place};
use crate::load::load_bytes;
use crate::output::{File, IDENTIFIED, read_result};
use crate::reads::Reads;
use frfit_formats::FormatError;
use std::path::Path;

/// The page for results that are about to be written into `out`.
///
/// # Errors
/// [`InputError`], as [`report_of_folder`]: what was just made would then be at fault.
pub(crate) fn report_of(files: &[File], out: &Path) -> Result<File, InputError> {
    let file =
        |name: &str| files.iter().find(|file| file.path == Path::new(name)).map(|file| file.bytes.clone());
    page(&file, out)
}

/// The page for the results in a folder, as `frfit identify` writes it beside them.
///
/// # Errors
/// [`InputError`]: a folder or a file in it that cannot be read, is missing, or is not what this version writes; files that are not all of one run.
pub fn report_of_folder(folder: &Path, reads: &mut Reads) -> Result<File, InputError> {
    if !folder.is_dir() {
        let expected = "a folder with the results of frfit identify";
        let found = if folder.exists() { "a file" } else { "nothing of that name" };
        return Err(InputError::at(&Place::file(folder), expected, found));
    }
    let mut files = read_result(folder, IDENTIFIED, reads)?;
    for name in frfit_report::FILES {
        if files.contains_key(name) {
            continue;
        }
        let path = folder.join(name);
        if path.exists() {
            files.insert(name.to_owned(), load_bytes(&path, reads)?);
        }
    }
    page(&|name| files.get(name).cloned(), folder)
}

fn page(file: &dyn Fn(&str) -> Option<Vec<u8>>, folder: &Path) -> Result<File, InputError> {
    let html = frfit_report::html(file).map_err(|error: FormatError| {
        let path = error.file.as_ref().map_or(folder.to_path_buf(), |name| folder.join(name));
        InputError::in_file(&path, error)
    })?;
    Ok(File::new(frfit_report::NAME, html))
}
