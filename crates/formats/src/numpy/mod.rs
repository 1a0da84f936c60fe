//! NumPy's arrays (.npy), archives of them (.npz) and SciPy's sparse matrices (`scipy.sparse.save_npz`).
//!
//! | file | matrices |
//! |---|---|
//! | .npy | one without a name |
//! | .npz of `numpy.savez` | one for each array, with its name |
//! | .npz of `scipy.sparse.save_npz` (csr, csc, coo, bsr, dia) | one without a name |
//!
//! [`ArchiveReader`] and [`ArchiveWriter`] take an archive for what it is: texts and arrays of numbers by their names.
//!
//! # Limits
//! Read are real and complex floats of 4 and 8 bytes a part, whole numbers and booleans, of both byte orders and both
//! orders of rows and columns. Whole numbers beyond 2⁵³ are rounded. What else an array may be (texts, half precision, structures, Python
//! objects) is refused by its name. Of a dense array the zeros are not stored; entries that a sparse matrix has twice are summed, as SciPy does.
//!
//! # Source
//! NumPy Enhancement Proposal 1, "A simple file format for NumPy arrays", versions 1.0 to 3.0; `numpy.lib.format`;
//! SciPy, `scipy.sparse.save_npz` and the documentation of its sparse formats.

mod archive;
mod array;
mod dense;
mod header;
mod sparse;

use std::collections::BTreeMap;
use std::io::{self, Read};

use crate::inflated::{Allowance, at_most};
use crate::{FormatError, NamedMatrix};
pub use archive::{ArchiveReader, ArchiveWriter};
use array::Array;
use header::Header;
pub use sparse::write as write_sparse;

const NPY: &[u8] = b"\x93NUMPY";
/// A local file header, and the end of an archive without files.
const ZIP: [&[u8]; 2] = [b"PK\x03\x04", b"PK\x05\x06"];

/// Whether the file begins as an array or an archive does.
pub(crate) fn looks_like(bytes: &[u8]) -> bool {
    bytes.starts_with(NPY) || ZIP.iter().any(|start| bytes.starts_with(start))
}

/// Reads an array or an archive of arrays.
///
/// # Errors
/// An archive that cannot be opened or has no arrays; a sparse matrix whose arrays contradict each other. An array that
/// cannot be read or is no matrix is refused alone.
///
/// # Limits
/// Memory is bounded by the numbers that are there, not by what headers say. Of an archive an array is inflated as far
/// as its header declares. What is kept of dense arrays (entries that are not zero, 16 bytes each, and no array counts
/// more than it declares) may take 16 × the size of the file + 1 MB, the vectors of a sparse matrix 128 × + 1 MB: what is
/// beyond is refused, and is read where it is saved uncompressed.
pub fn read(bytes: &[u8]) -> Result<Vec<NamedMatrix>, FormatError> {
    let mut allowance = Allowance::of(bytes.len());
    if bytes.starts_with(NPY) {
        let header = Header::parse(bytes, "")?;
        let mut elements = &bytes[header.end..];
        if header.length() != Some(elements.len()) {
            return Err(header.wrong_length(header.declared("")?, &elements.len().to_string(), ""));
        }
        let matrix = dense::matrix(&header, &mut elements, &mut allowance, "")?;
        return Ok(vec![NamedMatrix::plain("", Ok(matrix))]);
    }
    let mut files = Files::open(bytes, allowance)?;
    if sparse::is_one(&files.names) {
        let matrix = sparse::matrix(&mut files)?;
        return Ok(vec![NamedMatrix::plain("", Ok(matrix))]);
    }
    let names: Vec<String> = files.names.keys().cloned().collect();
    Ok(names
        .into_iter()
        .map(|name| {
            let matrix =
                files.with(&name, |header, input, allowance| dense::matrix(&header, input, allowance, &name));
            NamedMatrix::plain(name, matrix)
        })
        .collect())
}

/// The arrays of an archive.
struct Files<'a> {
    archive: zip::ZipArchive<io::Cursor<&'a [u8]>>,
    /// The name of each array, without its ending, and where it is.
    names: BTreeMap<String, usize>,
    allowance: Allowance,
}

impl<'a> Files<'a> {
    fn open(bytes: &'a [u8], allowance: Allowance) -> Result<Self, FormatError> {
        let archive = zip::ZipArchive::new(io::Cursor::new(bytes))
            .map_err(|error| FormatError::whole("an archive of arrays (.npz)", error.to_string()))?;
        let names: BTreeMap<_, _> = (0..archive.len())
            .filter_map(|k| Some((archive.name_for_index(k)?.ok()?.strip_suffix(".npy")?.to_owned(), k)))
            .collect();
        if names.is_empty() {
            let found = match archive.name_for_index(0) {
                Some(Ok(first)) => format!("a zip archive of {} others, the first {first:?}", archive.len()),
                _ => "an empty zip archive".into(),
            };
            return Err(FormatError::whole("an archive of arrays (.npz)", found));
        }
        Ok(Self { archive, names, allowance })
    }

    /// An array by its name.
    fn array(&mut self, name: &str) -> Result<Array, FormatError> {
        self.with(name, |header, input, allowance| Array::read(header, input, allowance, name))
    }

    /// Calls something with the header of an array and what follows it.
    fn with<T>(
        &mut self,
        name: &str,
        call: impl FnOnce(Header, &mut dyn Read, &mut Allowance) -> Result<T, FormatError>,
    ) -> Result<T, FormatError> {
        let missing = || FormatError::whole(format!("an array {name:?}"), "none");
        let broken = |found: String| FormatError::whole(format!("an array {name:?} in the archive"), found);
        let index = *self.names.get(name).ok_or_else(missing)?;
        let mut file = self.archive.by_index(index).map_err(|error| broken(error.to_string()))?;
        let start = at_most(&mut file, header::LONGEST).map_err(|error| broken(error.to_string()))?;
        self.allowance.inflate(start.len() as u64)?;
        let header = Header::parse(&start, name)?;
        let mut input = start[header.end..].chain(file);
        call(header, &mut input, &mut self.allowance)
    }
}
