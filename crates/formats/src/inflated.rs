//! What the members of a compressed file may take.
//!
//! Deflate turns a byte into up to 1032. So the size of a compressed file says little about what it holds, and a few
//! kilobytes can claim gigabytes. Three limits keep that from filling the memory; all of them hold for the file as a
//! whole, so that many members, or members that share their bytes, gain nothing:
//!
//! - A member is inflated as far as its own header declares, and no byte further.
//! - What a dense array keeps (its entries that are not zero), texts and headers: [`PLAIN`] × the size of the file + 1 MB.
//! - The vectors of a sparse matrix, of which every number is needed: [`SPARSE`] × the size of the file + 1 MB.

use std::io::{ErrorKind, Read};

use crate::FormatError;

/// Bytes kept for each byte of the file. Zeros of dense arrays are not kept.
const PLAIN: u64 = 16;

/// The same of a sparse matrix. Those of regular meshes, as `save_npz` writes them, reach 83.
const SPARSE: u64 = 128;

/// What deflate makes of a byte at most (RFC 1951: 258 bytes of two bits).
const DEFLATE: u64 = 1032;

/// What a small file may take whatever its size.
const FLOOR: u64 = 1 << 20;

/// What an entry of a matrix takes: its key and its value.
const ENTRY: u64 = 16;

const REMEDY: &str = "save it uncompressed: numpy.savez, save_npz(..., compressed=False), MATLAB's -v6";

/// The rest of the limits of a file.
#[derive(Debug, Clone)]
pub(crate) struct Allowance {
    file: u64,
    plain: u64,
    sparse: u64,
    inflated: u64,
}

impl Allowance {
    /// The limits of a file of so many bytes.
    pub(crate) fn of(file_bytes: usize) -> Self {
        let file = file_bytes as u64;
        let limit = |ratio: u64| ratio.saturating_mul(file).saturating_add(FLOOR);
        Self { file, plain: limit(PLAIN), sparse: limit(SPARSE), inflated: limit(DEFLATE) }
    }

    /// Takes what a dense array keeps, or a text.
    pub(crate) fn plain(&mut self, bytes: u64) -> Result<(), FormatError> {
        self.plain = self.plain.checked_sub(bytes).ok_or_else(|| self.refuse(PLAIN, bytes - self.plain))?;
        Ok(())
    }

    /// Takes an entry that a dense array keeps: all of them no more than the array declares, of which `left` is not yet taken.
    pub(crate) fn entry(&mut self, left: &mut u64) -> Result<(), FormatError> {
        let bytes = ENTRY.min(*left);
        *left -= bytes;
        self.plain(bytes)
    }

    /// Takes the bytes of a vector of a sparse matrix.
    pub(crate) fn sparse(&mut self, bytes: u64) -> Result<(), FormatError> {
        self.sparse =
            self.sparse.checked_sub(bytes).ok_or_else(|| self.refuse(SPARSE, bytes - self.sparse))?;
        Ok(())
    }

    /// Takes bytes that are to be inflated, whether they are kept or not: members that share their bytes have more of them than deflate can make.
    pub(crate) fn inflate(&mut self, bytes: u64) -> Result<(), FormatError> {
        self.inflated =
            self.inflated.checked_sub(bytes).ok_or_else(|| self.refuse(DEFLATE, bytes - self.inflated))?;
        Ok(())
    }

    fn refuse(&self, ratio: u64, beyond: u64) -> FormatError {
        let limit = ratio.saturating_mul(self.file).saturating_add(FLOOR);
        let expected = format!(
            "contents of at most {limit} bytes ({ratio} x the {} of the file + 1 MB; {REMEDY})",
            self.file
        );
        FormatError::whole(expected, format!("at least {} bytes", limit.saturating_add(beyond)))
    }
}

/// Reads so many bytes, or as many as there are: memory grows with what arrives, not with what was declared.
pub(crate) fn at_most(input: &mut dyn Read, bytes: u64) -> std::io::Result<Vec<u8>> {
    const FIRST: usize = 1 << 16;
    let most = usize::try_from(bytes).unwrap_or(usize::MAX);
    let (mut read, mut len) = (Vec::new(), 0);
    while len < most {
        // Doubled, and not beyond what was declared.
        let more = len.max(FIRST).min(most - len);
        read.reserve_exact(more);
        read.resize(len + more, 0);
        let got = fill(input, &mut read[len..])?;
        len += got;
        if got < more {
            break;
        }
    }
    read.truncate(len);
    Ok(read)
}

/// Fills the buffer as far as there is input; returns how far.
pub(crate) fn fill(input: &mut dyn Read, buffer: &mut [u8]) -> std::io::Result<usize> {
    let mut len = 0;
    while len < buffer.len() {
        match input.read(&mut buffer[len..]) {
            Ok(0) => break,
            Ok(got) => len += got,
            Err(error) if error.kind() == ErrorKind::Interrupted => {}
            Err(error) => return Err(error),
        }
    }
    Ok(len)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_limit_is_that_of_the_whole_file() {
        let mut allowance = Allowance::of(1000);
        let limit = 16 * 1000 + FLOOR;
        assert_eq!(allowance.plain(limit - 1), Ok(()));
        let error = allowance.plain(3).unwrap_err();
        assert!(error.expected.starts_with("contents of at most 1064576 bytes (16 x the 1000"), "{error}");
        assert_eq!(error.found, "at least 1064578 bytes");
        assert_eq!(allowance.plain(1), Ok(()));
        assert_eq!(allowance.sparse(128 * 1000 + FLOOR), Ok(()));
        assert!(allowance.sparse(1).is_err());
        assert_eq!(allowance.inflate(1032 * 1000 + FLOOR), Ok(()));
        assert!(allowance.inflate(u64::MAX).is_err());
    }

    #[test]
    fn an_array_is_charged_for_its_entries_and_no_more_than_it_declares() {
        let mut allowance = Allowance::of(0);
        let mut left = 2 * ENTRY + 1;
        (0..1000).for_each(|_| allowance.entry(&mut left).unwrap());
        assert_eq!((left, allowance.plain), (0, FLOOR - 2 * ENTRY - 1));
        let mut left = u64::MAX;
        let taken = (0..FLOOR).take_while(|_| allowance.entry(&mut left).is_ok()).count();
        assert_eq!(taken as u64, FLOOR / ENTRY - 3);
    }

    #[test]
    fn no_more_is_read_than_was_asked_for_and_no_memory_taken_for_what_is_not_there() {
        let some = vec![7_u8; 100_000];
        assert_eq!(at_most(&mut &some[..], 10).unwrap(), [7; 10]);
        assert_eq!(at_most(&mut &some[..], 70_000).unwrap().capacity(), 70_000);
        let all = at_most(&mut &some[..], 1 << 50).unwrap();
        assert!(all == some && all.capacity() <= 1 << 18);
    }
}
