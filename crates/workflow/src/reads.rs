//! Which files a command has read, so that it writes to none of them.

use crate::error::{InputError, Place};
use std::fs::{self, Metadata};
use std::io::{ErrorKind, Read};
use std::path::{Path, PathBuf};

/// The files that were read so far. Who reads a file hands this over, and who writes one asks it.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Reads(Vec<ReadFile>);

/// A file that was read.
#[derive(Debug, Clone, PartialEq, Eq)]
struct ReadFile {
    /// Its path as it was given.
    path: PathBuf,
    /// Its path without links.
    real: PathBuf,
    identity: Option<Identity>,
}

/// Device and number of a file: the same for all names that it has.
type Identity = (u64, u64);

impl Reads {
    /// The bytes of a plain file, or a description of what was found. A path of another kind (a directory, a pipe that never ends) is not opened.
    pub(crate) fn read(&mut self, path: &Path) -> Result<Vec<u8>, String> {
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
        let mut file = fs::File::open(path).map_err(failure)?;
        let metadata = file.metadata().map_err(failure)?;
        let mut bytes = Vec::with_capacity(usize::try_from(metadata.len()).unwrap_or(0));
        file.read_to_end(&mut bytes).map_err(failure)?;
        let real = path.canonicalize().map_err(failure)?;
        // Measurements often share one file.
        if self.0.last().is_none_or(|last| last.real != real) {
            self.0.push(ReadFile { path: path.to_path_buf(), real, identity: identity(&metadata) });
        }
        Ok(bytes)
    }

    /// Those of another command too.
    pub(crate) fn extend(&mut self, other: Self) {
        self.0.extend(other.0);
    }

    /// Refuses a file that was read, by whatever name: another path, a link.
    ///
    /// # Errors
    /// The path, and that of the file that was read.
    pub fn spare(&self, target: &Path) -> Result<(), InputError> {
        if self.0.is_empty() {
            return Ok(());
        }
        // What does not exist may still be a file that was read and is gone since.
        let parent = target.parent().filter(|parent| !parent.as_os_str().is_empty());
        let absent = || -> Option<PathBuf> {
            let parent = parent.unwrap_or(Path::new(".")).canonicalize().ok()?;
            Some(parent.join(target.file_name()?))
        };
        let real = target.canonicalize().ok().or_else(absent);
        let there = fs::metadata(target).ok().and_then(|metadata| identity(&metadata));
        let same = |read: &&ReadFile| {
            Some(&read.real) == real.as_ref() || (there.is_some() && read.identity == there)
        };
        match self.0.iter().find(same) {
            None => Ok(()),
            Some(read) => {
                let expected = "a file or folder of its own for what is written";
                let found = if read.path == target {
                    "a file that this command reads".to_owned()
                } else {
                    format!("a file that this command reads ({})", read.path.display())
                };
                Err(InputError::at(&Place::file(target), expected, found))
            }
        }
    }
}

#[cfg(unix)]
#[allow(clippy::unnecessary_wraps, reason = "other systems give no identity")]
fn identity(metadata: &Metadata) -> Option<Identity> {
    use std::os::unix::fs::MetadataExt;
    Some((metadata.dev(), metadata.ino()))
}

#[cfg(not(unix))]
fn identity(_: &Metadata) -> Option<Identity> {
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_that_was_read_is_known_by_each_of_its_names() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        fs::write(at("a"), "1").unwrap();
        fs::create_dir(at("sub")).unwrap();
        let mut reads = Reads::default();
        assert_eq!(reads.read(&at("a")).unwrap(), b"1");
        fs::write(at("b"), "1").unwrap();
        reads.spare(&at("b")).unwrap();
        reads.spare(&at("new")).unwrap();
        for name in ["a", "sub/../a"] {
            let error = reads.spare(&at(name)).unwrap_err().to_string();
            assert!(error.contains("a file that this command reads"), "{error}");
        }
        #[cfg(unix)]
        {
            std::os::unix::fs::symlink("a", at("link")).unwrap();
            fs::hard_link(at("a"), at("hard")).unwrap();
            for name in ["link", "hard"] {
                let error = reads.spare(&at(name)).unwrap_err().to_string();
                assert!(error.contains(&format!("{name}: ")) && error.contains("/a)"), "{error}");
            }
        }
        // It was the input, even if it is gone.
        fs::remove_file(at("a")).unwrap();
        assert!(reads.spare(&at("a")).is_err());
    }
}
