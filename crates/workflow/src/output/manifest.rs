//! The list of the files of a result, by which a reader knows whether they are all of one run.

use super::file::File;
use crate::error::{InputError, Place};
use crate::load::load_bytes;
use crate::reads::Reads;
use crate::terminal::listed;
use serde_json::{Value, json};
use sha2::{Digest, Sha256};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// What the results of an identification are called in the list of their files.
pub(crate) const IDENTIFIED: &str = "identify";

/// Of the files that are wrong so many are named.
const NAMED: usize = 3;

/// The name of the list of a result.
fn manifest_name(result: &str) -> PathBuf {
    PathBuf::from(format!("{result}-manifest.json"))
}

/// Name, size and checksum of each file of a result.
///
/// It is put in place before the first of them: a run that is killed in between leaves files that the list does not fit.
pub(super) fn manifest(result: &str, files: &[File]) -> File {
    let entry = |file: &File| {
        let name = file.path.to_string_lossy().replace('\\', "/");
        json!({"name": name, "bytes": file.bytes.len(), "sha256": sha256(&file.bytes)})
    };
    let list = json!({
        "frfit": env!("CARGO_PKG_VERSION"),
        "result": result,
        "files": files.iter().map(entry).collect::<Vec<_>>(),
    });
    File::new(manifest_name(result), format!("{list:#}\n"))
}

/// SHA-256 in hexadecimal.
pub(crate) fn sha256(bytes: &[u8]) -> String {
    hexadecimal(&Sha256::digest(bytes))
}

/// Two digits for each byte.
pub(crate) fn hexadecimal(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}

/// The files of a result in a folder as its list names them, read and compared with it; none where there is no list: earlier versions wrote none.
///
/// # Errors
/// A list that cannot be read; files that are missing, or not those of the list.
pub(crate) fn read_result(
    folder: &Path,
    result: &str,
    reads: &mut Reads,
) -> Result<BTreeMap<String, Vec<u8>>, InputError> {
    let path = folder.join(manifest_name(result));
    if !path.exists() {
        return Ok(BTreeMap::new());
    }
    let bytes = load_bytes(&path, reads)?;
    let refuse = |found: &str| {
        InputError::at(&Place::file(&path), format!("the list of files that frfit {result} writes"), found)
    };
    let list: Value = serde_json::from_slice(&bytes).map_err(|error| refuse(&error.to_string()))?;
    let entries = list["files"].as_array().ok_or_else(|| refuse("no list of files"))?;
    let (mut files, mut missing, mut other) = (BTreeMap::new(), Vec::new(), Vec::new());
    for entry in entries {
        let (Some(name), Some(size), Some(sum)) =
            (entry["name"].as_str(), entry["bytes"].as_u64(), entry["sha256"].as_str())
        else {
            return Err(refuse("a file without name, bytes or sha256"));
        };
        match reads.read(&folder.join(name)) {
            Ok(bytes) if bytes.len() as u64 == size && sha256(&bytes) == sum => {
                files.insert(name.to_owned(), bytes);
            }
            Ok(_) => other.push(name.to_owned()),
            Err(_) => missing.push(name.to_owned()),
        }
    }
    if missing.is_empty() && other.is_empty() {
        return Ok(files);
    }
    let found: Vec<String> = [("missing", &missing), ("changed, or of another run", &other)]
        .into_iter()
        .filter(|(_, names)| !names.is_empty())
        .map(|(what, names)| format!("{what}: {}", listed(names, NAMED)))
        .collect();
    let expected = format!(
        "the files of one run of frfit {result}, as {} lists them (run it again)",
        manifest_name(result).display()
    );
    Err(InputError::at(&Place::file(folder), expected, found.join("; ")))
}
