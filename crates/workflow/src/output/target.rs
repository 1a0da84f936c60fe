//! Where the bytes of a file go: into a file that takes the place of another, or through an existing device or pipe.

use std::fs::{self, OpenOptions, Permissions};
use std::io::{ErrorKind, Write};
use std::path::{Path, PathBuf};

/// What stands for standard output.
const STANDARD_OUTPUT: [&str; 3] = ["-", "/dev/stdout", "/dev/fd/1"];

/// More links than systems follow.
const MAX_LINKS: usize = 40;

/// Where bytes go.
#[derive(Debug)]
pub(super) enum Target {
    /// A plain file that is there or not, at the end of all links; the permissions are those of the one that is there.
    File { path: PathBuf, permissions: Option<Permissions> },
    /// A device, a pipe, a socket: it stays, and is written to.
    Through(PathBuf),
    /// Standard output.
    StandardOutput,
}

/// Whether a path means standard output.
pub fn is_standard_output(path: &Path) -> bool {
    STANDARD_OUTPUT.iter().any(|name| path == Path::new(name))
}

/// Whether what is written to a path has no files beside it: standard output, a device, a pipe.
pub fn is_stream(path: &Path) -> bool {
    matches!(Target::of(path), Ok(Target::StandardOutput | Target::Through(_)))
}

impl Target {
    /// What is at a path, or what is wrong with it (expected, found).
    pub(super) fn of(path: &Path) -> Result<Self, (&'static str, String)> {
        if is_standard_output(path) {
            return Ok(Self::StandardOutput);
        }
        let failed = |error: std::io::Error| ("to write here", error.to_string());
        let mut path = path.to_path_buf();
        for _ in 0..MAX_LINKS {
            let metadata = match fs::symlink_metadata(&path) {
                Ok(metadata) => metadata,
                Err(error) if error.kind() == ErrorKind::NotFound => {
                    return Ok(Self::File { path, permissions: None });
                }
                Err(error) => return Err(failed(error)),
            };
            if metadata.is_symlink() {
                let parent = folder_of(&path);
                // A link of the system to what this process has open: its name leads nowhere, or to a file that others have open too.
                if parent.canonicalize().is_ok_and(|parent| parent.starts_with("/proc")) {
                    return Ok(Self::Through(path));
                }
                path = parent.join(fs::read_link(&path).map_err(failed)?);
                if is_standard_output(&path) {
                    return Ok(Self::StandardOutput);
                }
                continue;
            }
            if metadata.is_dir() {
                return Err(("a file", "a folder".into()));
            }
            if !metadata.is_file() {
                return Ok(Self::Through(path));
            }
            let permissions = metadata.permissions();
            // To replace it would need the folder's permission only.
            if permissions.readonly() {
                return Err(("a file that may be written", "a read-only one".into()));
            }
            return Ok(Self::File { path, permissions: Some(permissions) });
        }
        Err(("a file", "too many links".into()))
    }
}

/// The folder of a path; `.` for a bare name.
pub(super) fn folder_of(path: &Path) -> &Path {
    path.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// Writes through an existing device or pipe.
pub(super) fn write_through(path: &Path, bytes: &[u8]) -> std::io::Result<()> {
    // Neither made nor cut; behind what others have written where it is a file.
    let mut file = OpenOptions::new().append(true).open(path)?;
    file.write_all(bytes)?;
    file.flush()
}

/// Writes to standard output; a reader that has gone away is no failure.
pub(super) fn write_standard_output(bytes: &[u8]) -> std::io::Result<()> {
    let mut out = std::io::stdout().lock();
    match out.write_all(bytes).and_then(|()| out.flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => Err(error),
        _ => Ok(()),
    }
}
