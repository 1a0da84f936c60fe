//! A data element: its tag and its bytes.

use crate::FormatError;
use crate::bytes::{Cursor, Storage};

/// What a tag says that the data are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    Numbers(Storage),
    Matrix,
    Compressed,
    Other(u32),
}

impl Kind {
    fn of(code: u32) -> Self {
        match code {
            1 => Self::Numbers(Storage::Signed(1)),
            2 => Self::Numbers(Storage::Unsigned(1)),
            3 => Self::Numbers(Storage::Signed(2)),
            4 => Self::Numbers(Storage::Unsigned(2)),
            5 => Self::Numbers(Storage::Signed(4)),
            6 => Self::Numbers(Storage::Unsigned(4)),
            7 => Self::Numbers(Storage::Float(4)),
            9 => Self::Numbers(Storage::Float(8)),
            12 => Self::Numbers(Storage::Signed(8)),
            13 => Self::Numbers(Storage::Unsigned(8)),
            14 => Self::Matrix,
            15 => Self::Compressed,
            other => Self::Other(other),
        }
    }
}

/// An element on its own.
#[derive(Debug, Clone)]
pub(super) struct Element<'a> {
    pub(super) kind: Kind,
    pub(super) data: Cursor<'a>,
}

impl<'a> Element<'a> {
    /// The next element and what fills it up to eight bytes. `name` is what it is, for errors.
    pub(super) fn read(cursor: &mut Cursor<'a>, name: &str) -> Result<Self, FormatError> {
        let first = cursor.u32(name)?;
        if first >> 16 > 0 {
            // Four bytes or less stand in the tag itself.
            let mut four = cursor.part(4, name)?;
            let data = four.part((first >> 16).into(), name)?;
            return Ok(Self { kind: Kind::of(first & 0xFFFF), data });
        }
        let (kind, length) = (Kind::of(first), cursor.u32(name)?);
        let data = cursor.part(length.into(), name)?;
        if kind != Kind::Compressed {
            // The last element may end without.
            let fill = (8 - length % 8) % 8;
            cursor.take(u64::from(fill).min(cursor.left() as u64), name)?;
        }
        Ok(Self { kind, data })
    }

    /// The numbers of an element of numbers; none where it is another.
    pub(super) fn numbers(mut self) -> impl Iterator<Item = (&'a [u8], Storage, crate::uff::Endian)> {
        let endian = self.data.endian;
        let storage = match self.kind {
            Kind::Numbers(storage) => storage,
            _ => Storage::Unsigned(1),
        };
        let is_numbers = matches!(self.kind, Kind::Numbers(_));
        let bytes = self.data.take(self.data.left() as u64, "numbers").unwrap_or_default();
        let bytes = if is_numbers { bytes } else { &[] };
        bytes.chunks_exact(storage.size()).map(move |number| (number, storage, endian))
    }

    /// Its numbers, rounded to doubles.
    pub(super) fn values(self) -> Vec<f64> {
        self.numbers().map(|(bytes, storage, endian)| storage.value(bytes, endian)).collect()
    }

    /// Its numbers, where all are whole and not negative.
    pub(super) fn wholes(self) -> Option<Vec<u64>> {
        let whole = |(bytes, storage, endian): (&[u8], Storage, _)| match storage {
            Storage::Float(_) => None,
            _ => u64::try_from(storage.whole(bytes, endian)).ok(),
        };
        self.numbers().map(whole).collect()
    }

    /// Its bytes as characters.
    pub(super) fn text(mut self) -> String {
        let bytes = self.data.take(self.data.left() as u64, "a text").unwrap_or_default();
        String::from_utf8_lossy(bytes).trim_end_matches('\0').to_owned()
    }
}
