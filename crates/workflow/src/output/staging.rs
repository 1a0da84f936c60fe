//! New files beside the places where they will be, in a folder that is known as left over when whoever made it has ended.

use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};

const PREFIX: &str = ".frfit-";
const SUFFIX: &str = ".partial";

/// Held as long as the folder is in use; the system lets go of it when the process ends, however it ends.
const LOCK: &str = "lock";

/// How often another name is tried where a folder was taken away as left over before it was locked.
const TRIES: usize = 10;

/// A hidden folder of new files in a folder; removed when it is dropped.
#[derive(Debug)]
pub(super) struct Staging {
    path: PathBuf,
    _lock: File,
    count: usize,
}

impl Staging {
    /// Clears away what killed processes have left in a folder, and makes a new one in it.
    pub(super) fn within(folder: &Path) -> std::io::Result<Self> {
        clear(folder);
        static NUMBER: AtomicUsize = AtomicUsize::new(0);
        let mut last = None;
        for _ in 0..TRIES {
            let number = NUMBER.fetch_add(1, Ordering::Relaxed);
            let path = folder.join(format!("{PREFIX}{}-{number}{SUFFIX}", std::process::id()));
            match made(&path) {
                Ok(lock) => return Ok(Self { path, _lock: lock, count: 0 }),
                Err(error) => last = Some(error),
            }
        }
        Err(last.unwrap_or_else(|| std::io::ErrorKind::AlreadyExists.into()))
    }

    /// Writes a new file to the disk and returns its place. Its permissions are those of any new file.
    pub(super) fn write(&mut self, bytes: &[u8]) -> std::io::Result<PathBuf> {
        let path = self.path.join(self.count.to_string());
        self.count += 1;
        let mut file = OpenOptions::new().write(true).create_new(true).open(&path)?;
        file.write_all(bytes)?;
        file.sync_all()?;
        Ok(path)
    }
}

impl Drop for Staging {
    fn drop(&mut self) {
        // What cannot be removed is cleared away by the next run.
        let _ = remove(&self.path);
    }
}

/// Removes a folder of new files, its lock last: whoever is killed meanwhile leaves what the next run can clear.
fn remove(folder: &Path) -> std::io::Result<()> {
    for entry in fs::read_dir(folder)? {
        let entry = entry?;
        if entry.file_name() != LOCK {
            fs::remove_file(entry.path())?;
        }
    }
    fs::remove_file(folder.join(LOCK))?;
    fs::remove_dir(folder)
}

/// Makes a folder and locks it.
fn made(path: &Path) -> std::io::Result<File> {
    fs::create_dir(path)?;
    let lock = OpenOptions::new().write(true).create_new(true).open(path.join(LOCK))?;
    match lock.try_lock() {
        // Another run took it for a leftover before it was locked, and clears it away.
        Err(TryLockError::WouldBlock) => Err(std::io::ErrorKind::WouldBlock.into()),
        Ok(()) if !path.join(LOCK).exists() => Err(std::io::ErrorKind::NotFound.into()),
        // A file system without locks has no leftovers cleared away either.
        Ok(()) | Err(TryLockError::Error(_)) => Ok(lock),
    }
}

/// Removes what killed processes have left; nothing is said of what cannot be removed.
fn clear(folder: &Path) {
    let Ok(entries) = fs::read_dir(folder) else { return };
    for entry in entries.flatten() {
        let name = entry.file_name();
        let is_ours = name.to_str().is_some_and(|name| name.starts_with(PREFIX) && name.ends_with(SUFFIX));
        if !is_ours || !entry.file_type().is_ok_and(|kind| kind.is_dir()) {
            continue;
        }
        let path = entry.path();
        match OpenOptions::new().write(true).open(path.join(LOCK)) {
            Ok(lock) if lock.try_lock().is_ok() => drop(remove(&path)),
            // In use.
            Ok(_) => {}
            // Ended before it was locked, or after the lock was removed: nothing is in it.
            Err(_) => drop(fs::remove_dir(&path)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn entries(folder: &Path) -> usize {
        fs::read_dir(folder).unwrap().count()
    }

    #[test]
    fn leftovers_are_cleared_wherever_their_writer_was_killed() {
        let root = tempfile::tempdir().unwrap();
        let folder = |number: u32| root.path().join(format!("{PREFIX}{number}-0{SUFFIX}"));
        // Before the lock was made; with files under a lock; with the lock alone.
        for (number, names) in [(1, &[][..]), (2, &["0", "1", LOCK]), (3, &[LOCK])] {
            fs::create_dir(folder(number)).unwrap();
            for name in names {
                fs::write(folder(number).join(name), "x").unwrap();
            }
        }
        drop(Staging::within(root.path()).unwrap());
        assert_eq!(entries(root.path()), 0);
    }

    #[test]
    fn a_folder_in_use_is_left_alone() {
        let root = tempfile::tempdir().unwrap();
        let mut first = Staging::within(root.path()).unwrap();
        let file = first.write(b"x").unwrap();
        drop(Staging::within(root.path()).unwrap());
        assert!(file.exists());
        drop(first);
        assert_eq!(entries(root.path()), 0);
    }

    #[test]
    fn the_lock_is_removed_last() {
        let root = tempfile::tempdir().unwrap();
        let folder = root.path().join("staging");
        fs::create_dir(&folder).unwrap();
        fs::write(folder.join(LOCK), "").unwrap();
        // A folder in place of a file cannot be removed as one: the removal ends there, as a kill would end it.
        fs::create_dir(folder.join("0")).unwrap();
        assert!(remove(&folder).is_err());
        assert!(folder.join(LOCK).exists());
    }
}
