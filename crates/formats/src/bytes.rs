//! Numbers in binary files: what the binary formats have in common.

use crate::FormatError;
use crate::uff::Endian;

/// A place in bytes, from which numbers are taken one by one.
#[derive(Debug, Clone)]
pub(crate) struct Cursor<'a> {
    bytes: &'a [u8],
    /// Where `bytes` begins in the file, for errors.
    offset: usize,
    at: usize,
    pub(crate) endian: Endian,
}

impl<'a> Cursor<'a> {
    pub(crate) fn new(bytes: &'a [u8], offset: usize, endian: Endian) -> Self {
        Self { bytes, offset, at: 0, endian }
    }

    /// Where the next byte is in the file.
    pub(crate) fn place(&self) -> usize {
        self.offset + self.at
    }

    pub(crate) fn left(&self) -> usize {
        self.bytes.len() - self.at
    }

    /// The next so many bytes.
    pub(crate) fn take(&mut self, count: u64, name: &str) -> Result<&'a [u8], FormatError> {
        let taken = usize::try_from(count)
            .ok()
            .and_then(|count| self.bytes[self.at..].get(..count))
            .ok_or_else(|| {
                let found = format!("{} to the end", self.left());
                FormatError::byte(self.place(), format!("{count} bytes: {name}"), found)
            })?;
        self.at += taken.len();
        Ok(taken)
    }

    /// A part with a cursor of its own.
    pub(crate) fn part(&mut self, count: u64, name: &str) -> Result<Cursor<'a>, FormatError> {
        let offset = self.place();
        Ok(Cursor::new(self.take(count, name)?, offset, self.endian))
    }

    /// The next N bytes, lowest first.
    fn lowest_first<const N: usize>(&mut self, name: &str) -> Result<[u8; N], FormatError> {
        let mut bytes = [0; N];
        bytes.copy_from_slice(self.take(N as u64, name)?);
        if self.endian == Endian::Big {
            bytes.reverse();
        }
        Ok(bytes)
    }

    pub(crate) fn u32(&mut self, name: &str) -> Result<u32, FormatError> {
        self.lowest_first(name).map(u32::from_le_bytes)
    }

    pub(crate) fn i32(&mut self, name: &str) -> Result<i32, FormatError> {
        self.lowest_first(name).map(i32::from_le_bytes)
    }

    pub(crate) fn i64(&mut self, name: &str) -> Result<i64, FormatError> {
        self.lowest_first(name).map(i64::from_le_bytes)
    }
}

/// How a number is stored.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Storage {
    Signed(usize),
    Unsigned(usize),
    Float(usize),
}

impl Storage {
    /// Bytes of a number: 1, 2, 4 or 8, of a float 4 or 8.
    pub(crate) fn size(self) -> usize {
        match self {
            Self::Signed(size) | Self::Unsigned(size) | Self::Float(size) => size,
        }
    }

    /// A number from its bytes; whole numbers beyond 2⁵³ are rounded.
    pub(crate) fn value(self, bytes: &[u8], endian: Endian) -> f64 {
        match (self, self.whole(bytes, endian)) {
            (Self::Float(4), bits) => f64::from(f32::from_bits(bits as u32)),
            (Self::Float(_), bits) => f64::from_bits(bits as u64),
            (_, whole) => whole as f64,
        }
    }

    /// A whole number from its bytes; of a float its bits.
    pub(crate) fn whole(self, bytes: &[u8], endian: Endian) -> i128 {
        let shifted = |bits: u64, byte: &u8| bits << 8 | u64::from(*byte);
        let bits = match endian {
            Endian::Little => bytes.iter().rev().fold(0, shifted),
            Endian::Big => bytes.iter().fold(0, shifted),
        };
        let unused = 64 - 8 * self.size() as u32;
        match self {
            Self::Signed(_) => i128::from((bits << unused) as i64 >> unused),
            _ => i128::from(bits),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_of_every_storage_and_order() {
        for (storage, bytes, value) in [
            (Storage::Signed(1), &[0xFE][..], -2.0),
            (Storage::Unsigned(1), &[0xFE], 254.0),
            (Storage::Signed(2), &[0xFE, 0xFF], -2.0),
            (Storage::Unsigned(4), &[0, 0, 0, 0x80], 2_147_483_648.0),
            (Storage::Signed(8), &[0xFE, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF], -2.0),
            (Storage::Unsigned(8), &[0xFF; 8], 18_446_744_073_709_551_616.0),
            (Storage::Float(4), &1.5_f32.to_le_bytes(), 1.5),
            (Storage::Float(8), &(-0.1_f64).to_le_bytes(), -0.1),
        ] {
            let reversed: Vec<u8> = bytes.iter().rev().copied().collect();
            assert_eq!(storage.value(bytes, Endian::Little), value, "{storage:?}");
            assert_eq!(storage.value(&reversed, Endian::Big), value, "{storage:?}");
        }
    }

    #[test]
    fn the_end_is_told_with_its_place() {
        let mut cursor = Cursor::new(&[1, 0, 0, 0, 7], 100, Endian::Little);
        assert_eq!(cursor.i32("a number"), Ok(1));
        let error = cursor.u32("a marker").unwrap_err().to_string();
        assert_eq!(error, "input, byte 104: expected 4 bytes: a marker, found 1 to the end");
        assert!(cursor.take(u64::MAX, "all").is_err());
    }
}
