//! An archive as a store of texts and arrays of real numbers, read and written.

use std::io::{Cursor, Write};

use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipWriter};

use super::{Files, header};
use crate::FormatError;
use crate::inflated::Allowance;

/// An archive (.npz) that is read by the names of its arrays.
pub struct ArchiveReader<'a>(Files<'a>);

impl<'a> ArchiveReader<'a> {
    /// Reads what there is, not the arrays themselves.
    ///
    /// # Errors
    /// An archive that cannot be opened or has no arrays.
    pub fn open(bytes: &'a [u8]) -> Result<Self, FormatError> {
        Files::open(bytes, Allowance::of(bytes.len())).map(Self)
    }

    /// The only text of an array of bytes, in UTF-8.
    ///
    /// # Errors
    /// No array of this name, or one that is no such text.
    pub fn text(&mut self, name: &str) -> Result<String, FormatError> {
        let array = self.0.array(name)?;
        let text = array.only_bytes().and_then(|bytes| String::from_utf8(bytes.to_vec()).ok());
        text.ok_or_else(|| {
            FormatError::whole(format!("an array {name:?} of a single text"), array.header.described())
        })
    }

    /// Sizes, of which the last index runs fastest, and real numbers of an array.
    ///
    /// # Errors
    /// No array of this name, one that cannot be read, or one of other elements than real numbers.
    pub fn real(&mut self, name: &str) -> Result<(Vec<usize>, Vec<f64>), FormatError> {
        let array = self.0.array(name)?;
        let values = array.reals().ok_or_else(|| {
            FormatError::whole(format!("an array {name:?} of real numbers, row after row"), "another one")
        })?;
        Ok((array.shape().iter().map(|&size| size as usize).collect(), values))
    }
}

/// An archive (.npz) that is written, uncompressed.
pub struct ArchiveWriter(ZipWriter<Cursor<Vec<u8>>>);

impl Default for ArchiveWriter {
    fn default() -> Self {
        Self(ZipWriter::new(Cursor::new(Vec::new())))
    }
}

impl ArchiveWriter {
    /// A text in UTF-8, as an array of one element of as many bytes.
    ///
    /// # Errors
    /// A name that the archive has already; more than memory holds.
    pub fn text(&mut self, name: &str, text: &str) -> Result<(), FormatError> {
        self.member(name, &format!("|S{}", text.len()), &[], &mut std::iter::once(text.as_bytes().to_vec()))
    }

    /// Real numbers, of which the last index runs fastest.
    ///
    /// # Errors
    /// As [`ArchiveWriter::text`].
    ///
    /// # Panics
    /// Where there are not as many numbers as the shape says.
    pub fn real(&mut self, name: &str, shape: &[usize], values: &[f64]) -> Result<(), FormatError> {
        assert_eq!(shape.iter().product::<usize>(), values.len(), "one number for each element");
        let mut pieces =
            values.chunks(1 << 13).map(|piece| piece.iter().flat_map(|v| v.to_le_bytes()).collect());
        self.member(name, "<f8", shape, &mut pieces)
    }

    /// A vector of whole numbers.
    pub(super) fn whole(&mut self, name: &str, values: &[i32]) -> Result<(), FormatError> {
        let mut pieces =
            values.chunks(1 << 13).map(|piece| piece.iter().flat_map(|v| v.to_le_bytes()).collect());
        self.member(name, "<i4", &[values.len()], &mut pieces)
    }

    /// A vector of complex numbers.
    pub(super) fn complex(&mut self, name: &str, re: &[f64], im: &[f64]) -> Result<(), FormatError> {
        let both = |(re, im): (&[f64], &[f64])| {
            re.iter().zip(im).flat_map(|(re, im)| [re.to_le_bytes(), im.to_le_bytes()].concat()).collect()
        };
        let mut pieces = re.chunks(1 << 13).zip(im.chunks(1 << 13)).map(both);
        self.member(name, "<c16", &[re.len()], &mut pieces)
    }

    /// The file.
    ///
    /// # Errors
    /// More than memory holds.
    pub fn finish(self) -> Result<Vec<u8>, FormatError> {
        self.0.finish().map(Cursor::into_inner).map_err(|error| refuse("", &error.to_string()))
    }

    fn member(
        &mut self,
        name: &str,
        descr: &str,
        shape: &[usize],
        pieces: &mut dyn Iterator<Item = Vec<u8>>,
    ) -> Result<(), FormatError> {
        // Sizes beyond 4 GB, and no time of day: the same contents are the same file.
        let options =
            SimpleFileOptions::default().compression_method(CompressionMethod::Stored).large_file(true);
        let failed = |error: String| refuse(name, &error);
        self.0.start_file(format!("{name}.npy"), options).map_err(|error| failed(error.to_string()))?;
        let mut put = |bytes: &[u8]| self.0.write_all(bytes).map_err(|error| failed(error.to_string()));
        put(&header::of_array(descr, shape))?;
        for piece in pieces {
            put(&piece)?;
        }
        Ok(())
    }
}

fn refuse(name: &str, found: &str) -> FormatError {
    FormatError::whole(format!("an array {name:?} that can be put into an archive"), found)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn written() -> Vec<u8> {
        let mut archive = ArchiveWriter::default();
        archive.text("about", "E′ of a plate").unwrap();
        archive.real("empty", &[0, 3], &[]).unwrap();
        archive.real("numbers", &[2, 3], &[1.0, -2.5, f64::INFINITY, 0.1, 1e300, -0.0]).unwrap();
        assert!(archive.real("numbers", &[1], &[1.0]).is_err());
        archive.finish().unwrap()
    }

    #[test]
    fn what_is_written_is_read() {
        let bytes = written();
        assert_eq!(bytes, written());
        let mut archive = ArchiveReader::open(&bytes).unwrap();
        assert_eq!(archive.text("about").unwrap(), "E′ of a plate");
        assert_eq!(archive.real("empty").unwrap(), (vec![0, 3], vec![]));
        let (shape, values) = archive.real("numbers").unwrap();
        assert_eq!((shape, values[2], values[3].to_bits()), (vec![2, 3], f64::INFINITY, 0.1f64.to_bits()));
        assert_eq!(values[5].to_bits(), (-0.0f64).to_bits());
        assert!(archive.real("about").is_err() && archive.text("numbers").is_err());
        assert!(archive.real("other").unwrap_err().to_string().contains("expected an array \"other\""));
    }

    /// A flipped bit anywhere in the numbers is seen by the archive's checksum.
    #[test]
    fn a_damaged_array_is_refused() {
        let mut bytes = written();
        let at = bytes.windows(8).position(|window| window == 0.1f64.to_le_bytes()).unwrap();
        bytes[at] ^= 1;
        let refused = ArchiveReader::open(&bytes).unwrap().real("numbers").unwrap_err();
        assert!(refused.to_string().contains("numbers"), "{refused}");
    }
}
