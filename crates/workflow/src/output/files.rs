//! Files that are written whole or not at all, and never over a file that was read.

use super::file::File;
use super::manifest::manifest;
use super::staging::Staging;
use super::target::{Target, folder_of, is_standard_output, write_standard_output, write_through};
use crate::error::{InputError, Place};
use crate::reads::Reads;
use std::collections::BTreeMap;
use std::fmt;
use std::path::{Path, PathBuf};

/// A file that could not be written.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct WriteError(InputError);

impl fmt::Display for WriteError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fmt(f)
    }
}

impl std::error::Error for WriteError {}

impl WriteError {
    fn at(path: &Path, expected: &str, found: impl Into<String>) -> Self {
        Self(InputError::at(&Place::file(path), expected, found))
    }

    fn system(path: &Path, error: &std::io::Error) -> Self {
        Self::at(path, "to write here", error.to_string())
    }
}

/// Refuses, before anything is computed, a folder of results that would not be written in the end: one that is a file, or has one of the names as a file that was read.
///
/// # Errors
/// [`WriteError`] with the path.
pub fn check_folder(folder: &Path, names: &[&str], reads: &Reads) -> Result<(), WriteError> {
    if is_standard_output(folder) {
        return Err(WriteError::at(folder, "a folder (./- for one of this name)", "standard output"));
    }
    if folder.exists() && !folder.is_dir() {
        return Err(WriteError::at(folder, "a folder, or nothing yet", "a file"));
    }
    names.iter().try_for_each(|name| check_file(&folder.join(name), reads))
}

/// Refuses, before anything is computed, a file that would not be written in the end.
///
/// # Errors
/// [`WriteError`] with the path.
pub fn check_file(path: &Path, reads: &Reads) -> Result<(), WriteError> {
    reads.spare(path).map_err(WriteError)?;
    Target::of(path).map(drop).map_err(|(expected, found)| WriteError::at(path, expected, found))
}

/// Writes one file. `-` is standard output; a device or a pipe is written through; of a link the file at its end is replaced, and keeps its permissions.
///
/// # Errors
/// [`WriteError`] with the path: also a read-only file, or one that was read.
pub fn write_one(path: &Path, bytes: Vec<u8>, reads: &Reads) -> Result<(), WriteError> {
    write(vec![(path.to_path_buf(), bytes)], reads)
}

/// Writes all files into a folder, which is made where it does not exist.
///
/// Nothing that is there is touched before every new file is complete on disk; then each is renamed into place.
///
/// # Errors
/// [`WriteError`] with the path.
pub fn write_all(folder: &Path, files: Vec<File>, reads: &Reads) -> Result<(), WriteError> {
    if is_standard_output(folder) {
        return check_folder(folder, &[], reads);
    }
    write(files.into_iter().map(|file| (folder.join(file.path), file.bytes)).collect(), reads)
}

/// As [`write_all`], but where a file is there with other contents nothing is written: somebody has edited it.
///
/// # Errors
/// [`WriteError`] with the path of the first such file.
pub fn write_unedited(folder: &Path, files: Vec<File>, reads: &Reads) -> Result<(), WriteError> {
    let is_edited =
        |file: &&File| std::fs::read(folder.join(&file.path)).is_ok_and(|there| there != file.bytes);
    match files.iter().find(is_edited) {
        Some(file) => {
            let expected = "another folder, or this file deleted: an edited file is not overwritten";
            Err(WriteError::at(&folder.join(&file.path), expected, "a file with other contents".to_owned()))
        }
        None => write_all(folder, files, reads),
    }
}

/// As [`write_all`], with the list of the files of a result, `<result>-manifest.json`, by which a reader knows a run that was killed between two of them.
///
/// A page that can be made of the others is not in the list.
///
/// # Errors
/// [`WriteError`] with the path.
pub fn write_result(
    folder: &Path,
    result: &str,
    mut files: Vec<File>,
    page: Option<File>,
    reads: &Reads,
) -> Result<(), WriteError> {
    files.insert(0, manifest(result, &files));
    files.extend(page);
    write_all(folder, files, reads)
}

/// One writer at a time in a folder, where the system can lock one.
fn locked(folder: &Path) -> Option<std::fs::File> {
    let folder = std::fs::File::open(folder).ok()?;
    folder.lock().ok()?;
    Some(folder)
}

fn write(files: Vec<(PathBuf, Vec<u8>)>, reads: &Reads) -> Result<(), WriteError> {
    let mut stagings: BTreeMap<PathBuf, Staging> = BTreeMap::new();
    let (mut complete, mut through) = (Vec::new(), Vec::new());
    for (path, bytes) in files {
        let failed = |error: std::io::Error| WriteError::system(&path, &error);
        check_file(&path, reads)?;
        match Target::of(&path).map_err(|(expected, found)| WriteError::at(&path, expected, found))? {
            Target::File { path: target, permissions } => {
                std::fs::create_dir_all(folder_of(&target)).map_err(failed)?;
                let folder = folder_of(&target).canonicalize().map_err(failed)?;
                if !stagings.contains_key(&folder) {
                    stagings.insert(folder.clone(), Staging::within(&folder).map_err(failed)?);
                }
                let Some(staging) = stagings.get_mut(&folder) else { continue };
                let new = staging.write(&bytes).map_err(failed)?;
                if let Some(permissions) = permissions {
                    std::fs::set_permissions(&new, permissions).map_err(failed)?;
                }
                complete.push((new, target));
            }
            Target::Through(at) => through.push((Some(at), path, bytes)),
            Target::StandardOutput => through.push((None, path, bytes)),
        }
    }
    let _lock = match complete.len() {
        0 | 1 => None,
        _ => stagings.keys().next().and_then(|folder| locked(folder)),
    };
    for (new, target) in complete {
        std::fs::rename(new, &target).map_err(|error| WriteError::system(&target, &error))?;
    }
    for (at, path, bytes) in through {
        let done = match at {
            Some(at) => write_through(&at, &bytes),
            None => write_standard_output(&bytes),
        };
        done.map_err(|error| WriteError::system(&path, &error))?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    fn write(folder: &Path, files: &[(&str, &str)]) -> Result<(), WriteError> {
        let files = files.iter().map(|&(path, text)| File::new(path, text)).collect();
        write_all(folder, files, &Reads::default())
    }

    #[test]
    fn nothing_is_touched_when_one_file_cannot_be_written() {
        let folder = tempfile::tempdir().unwrap();
        write(folder.path(), &[("a.csv", "old"), ("sub/b.csv", "old")]).unwrap();
        // A file stands where a folder should be.
        let error = write(folder.path(), &[("a.csv", "new"), ("a.csv/inside", "new")]).unwrap_err();
        assert!(error.to_string().contains("a.csv"), "{error}");
        // A folder stands where a file should be.
        let error = write(folder.path(), &[("a.csv", "new"), ("sub", "new")]).unwrap_err();
        assert!(error.to_string().ends_with("sub: expected a file, found a folder"), "{error}");
        assert_eq!(fs::read_to_string(folder.path().join("a.csv")).unwrap(), "old");
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 2, "no temporary file is left");
    }

    #[test]
    fn files_replace_their_elders() {
        let folder = tempfile::tempdir().unwrap();
        let deep = folder.path().join("x/y");
        write(&deep, &[("a.csv", "old")]).unwrap();
        write(&deep, &[("a.csv", "new")]).unwrap();
        assert_eq!(fs::read_to_string(deep.join("a.csv")).unwrap(), "new");
    }

    #[test]
    fn what_killed_runs_left_is_cleared_away_and_what_is_in_use_is_not() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        for name in [".frfit-1-0.partial", ".frfit-2-0.partial", ".frfit-3-0.partial", ".frfit-notes"] {
            fs::create_dir(at(name)).unwrap();
        }
        // Killed while it wrote; killed before it locked; a user's own; one that runs.
        fs::write(at(".frfit-1-0.partial/lock"), "").unwrap();
        fs::write(at(".frfit-1-0.partial/0"), "half a fi").unwrap();
        let running = fs::File::create(at(".frfit-3-0.partial/lock")).unwrap();
        running.lock().unwrap();
        write(folder.path(), &[("a.csv", "new")]).unwrap();
        let mut left: Vec<_> = fs::read_dir(folder.path()).unwrap().map(|e| e.unwrap().file_name()).collect();
        left.sort();
        assert_eq!(left, [".frfit-3-0.partial", ".frfit-notes", "a.csv"]);
    }

    #[cfg(unix)]
    mod unix {
        use super::*;
        use std::os::unix::fs::{PermissionsExt, symlink};

        fn mode(path: &Path) -> u32 {
            fs::metadata(path).unwrap().permissions().mode() & 0o7777
        }

        #[test]
        fn permissions_are_those_of_any_new_file_or_of_the_old_one() {
            let folder = tempfile::tempdir().unwrap();
            let at = |name: &str| folder.path().join(name);
            fs::write(at("plain"), "").unwrap();
            write(folder.path(), &[("new", "1")]).unwrap();
            // Whatever the umask is.
            assert_eq!(mode(&at("new")), mode(&at("plain")));
            for bits in [0o600, 0o664, 0o755] {
                fs::set_permissions(at("new"), fs::Permissions::from_mode(bits)).unwrap();
                write(folder.path(), &[("new", "2")]).unwrap();
                assert_eq!(mode(&at("new")), bits);
            }
            fs::set_permissions(at("new"), fs::Permissions::from_mode(0o444)).unwrap();
            let error = write(folder.path(), &[("other", "3"), ("new", "3")]).unwrap_err().to_string();
            assert!(error.ends_with("expected a file that may be written, found a read-only one"), "{error}");
            assert_eq!(fs::read_to_string(at("new")).unwrap(), "2");
            assert!(!at("other").exists());
        }

        #[test]
        fn of_a_link_the_file_at_its_end_is_replaced() {
            let folder = tempfile::tempdir().unwrap();
            let at = |name: &str| folder.path().join(name);
            fs::create_dir(at("far")).unwrap();
            fs::write(at("far/file"), "old").unwrap();
            symlink("far/file", at("one")).unwrap();
            symlink("one", at("two")).unwrap();
            symlink("far/none-yet", at("open")).unwrap();
            symlink("round", at("round")).unwrap();
            write(folder.path(), &[("two", "new"), ("open", "made")]).unwrap();
            assert!(fs::symlink_metadata(at("two")).unwrap().is_symlink());
            assert!(fs::symlink_metadata(at("open")).unwrap().is_symlink());
            assert_eq!(fs::read_to_string(at("far/file")).unwrap(), "new");
            assert_eq!(fs::read_to_string(at("far/none-yet")).unwrap(), "made");
            assert!(write(folder.path(), &[("round", "new")]).is_err());
        }
    }
}
