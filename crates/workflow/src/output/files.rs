//! A set of files, each written beside its place and renamed into it when all of them are complete.

use std::fmt;
use std::io::Write;
use std::path::{Path, PathBuf};
use tempfile::NamedTempFile;

/// A file to be written.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct File {
    /// Path relative to the output folder.
    pub path: PathBuf,
    /// Contents.
    pub bytes: Vec<u8>,
}

impl File {
    /// A file at a relative path.
    pub fn new(path: impl Into<PathBuf>, bytes: impl Into<Vec<u8>>) -> Self {
        Self { path: path.into(), bytes: bytes.into() }
    }
}

/// A file that could not be written.
#[derive(Debug)]
pub struct WriteError {
    /// The path.
    pub path: PathBuf,
    /// What the system says.
    pub error: std::io::Error,
}

impl fmt::Display for WriteError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: expected to write here, found: {}", self.path.display(), self.error)
    }
}

impl std::error::Error for WriteError {}

/// Writes all files into a folder, which is made where it does not exist.
///
/// Nothing that is there is touched before every new file is complete on disk; then each is renamed into place.
///
/// # Errors
/// [`WriteError`] with the path.
pub fn write_all(folder: &Path, files: &[File]) -> Result<(), WriteError> {
    let failed = |path: &Path| {
        let path = path.to_path_buf();
        move |error| WriteError { path, error }
    };
    let mut complete = Vec::with_capacity(files.len());
    for file in files {
        let target = folder.join(&file.path);
        let parent = target.parent().unwrap_or(folder);
        std::fs::create_dir_all(parent).map_err(failed(parent))?;
        let mut temporary = NamedTempFile::new_in(parent).map_err(failed(&target))?;
        temporary.write_all(&file.bytes).map_err(failed(&target))?;
        temporary.as_file().sync_all().map_err(failed(&target))?;
        share(&temporary).map_err(failed(&target))?;
        complete.push((temporary, target));
    }
    for (temporary, target) in complete {
        temporary.persist(&target).map_err(|error| failed(&target)(error.error))?;
    }
    Ok(())
}

/// Temporary files are made for their owner's eyes only; results are not.
#[cfg(unix)]
fn share(file: &NamedTempFile) -> std::io::Result<()> {
    use std::os::unix::fs::PermissionsExt;
    file.as_file().set_permissions(std::fs::Permissions::from_mode(0o644))
}

#[cfg(not(unix))]
fn share(_: &NamedTempFile) -> std::io::Result<()> {
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_is_touched_when_one_file_cannot_be_written() {
        let folder = tempfile::tempdir().unwrap();
        write_all(folder.path(), &[File::new("a.csv", "old"), File::new("sub/b.csv", "old")]).unwrap();
        // A folder stands where a file's parent should be a folder of its own.
        let broken = [File::new("a.csv", "new"), File::new("a.csv/inside", "new")];
        let error = write_all(folder.path(), &broken).unwrap_err();
        assert!(error.to_string().contains("a.csv"), "{error}");
        assert_eq!(std::fs::read_to_string(folder.path().join("a.csv")).unwrap(), "old");
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 2, "no temporary file is left");
    }

    #[test]
    fn files_replace_their_elders() {
        let folder = tempfile::tempdir().unwrap();
        let deep = folder.path().join("x/y");
        write_all(&deep, &[File::new("a.csv", "old")]).unwrap();
        write_all(&deep, &[File::new("a.csv", "new")]).unwrap();
        assert_eq!(std::fs::read_to_string(deep.join("a.csv")).unwrap(), "new");
    }
}
