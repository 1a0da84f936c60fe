//! The trained reduced model of a case in a file, for other runs with the same matrices, load and sensors.
//!
//! The file is an archive of NumPy's arrays (`numpy.load` opens it): the arrays of [`KeptSubspace`], and a text that says what they belong to.

mod fingerprint;

use crate::error::{InputError, Place};
use fingerprint::Fingerprint;
use frfit::model::{DynamicStiffness, Experiment};
use frfit::subspace::{KeptArray, KeptSubspace};
use frfit_formats::FormatError;
use frfit_formats::numpy::{ArchiveReader, ArchiveWriter};
use serde_json::{Value, json};
use std::borrow::Cow;
use std::path::Path;

/// The array that says what the others belong to.
const ABOUT: &str = "frfit";

/// Of a layout that another version reads wrongly.
const VERSION: u64 = 1;

/// A reduced model as a file.
///
/// # Errors
/// More than memory holds.
pub(crate) fn reduced_file(
    kept: &KeptSubspace,
    model: &DynamicStiffness,
    experiment: &Experiment,
) -> Result<Vec<u8>, FormatError> {
    let about = json!({
        "layout": VERSION,
        "frfit": env!("CARGO_PKG_VERSION"),
        "of": Fingerprint::of(model, experiment).json(),
    });
    let mut archive = ArchiveWriter::default();
    archive.text(ABOUT, &about.to_string())?;
    for KeptArray { name, shape, values } in kept.arrays() {
        archive.real(name, &shape, &values)?;
    }
    archive.finish()
}

/// The reduced model in a file, which has to be that of these matrices, load and sensors.
///
/// # Errors
/// A file of another kind, or a damaged one; one of another model, and in what it differs.
pub(crate) fn read_reduced(
    file: &Path,
    bytes: &[u8],
    model: &DynamicStiffness,
    experiment: &Experiment,
) -> Result<KeptSubspace, InputError> {
    let in_file = |error| InputError::in_file(file, error);
    let refuse = |expected: String, found: String| InputError::at(&Place::file(file), expected, found);
    // The beginning of an archive: whatever else it is, nobody took it for one.
    if !bytes.starts_with(b"PK") {
        return Err(refuse("a file of frfit train".into(), "a file of another kind".into()));
    }
    let mut archive = ArchiveReader::open(bytes).map_err(in_file)?;
    let about = archive.text(ABOUT).map_err(in_file)?;
    let about: Value = serde_json::from_str(&about).unwrap_or_default();
    if about["layout"] != VERSION {
        let expected = format!("a reduced model in layout {VERSION} (train it again)");
        return Err(refuse(expected, format!("layout {}", about["layout"])));
    }
    let of_case = "the reduced model of this case's matrices, load and sensors (train it again)".to_owned();
    if let Some(other) = Fingerprint::of(model, experiment).differs_from(&about["of"]) {
        return Err(refuse(of_case, format!("that of {other}")));
    }
    let array = |name: &'static str| -> Result<KeptArray<'static>, InputError> {
        let (shape, values) = archive.real(name).map_err(in_file)?;
        Ok(KeptArray { name, shape, values: Cow::Owned(values) })
    };
    let arrays = KeptSubspace::ARRAYS.into_iter().map(array).collect::<Result<Vec<_>, _>>()?;
    KeptSubspace::new(model, arrays).map_err(|error| refuse(of_case, error.to_string()))
}
