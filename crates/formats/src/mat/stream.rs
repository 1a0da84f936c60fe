//! Data elements, read one after the other from a file or from what a variable inflates to.

use std::io::Read;

use crate::FormatError;
use crate::bytes::Storage;
use crate::inflated::{Allowance, at_most, fill};
use crate::uff::Endian;

/// Bytes that are read at a time.
const CHUNK: usize = 1 << 16;

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

/// The tag of an element, and where its data end.
#[derive(Debug, Clone, Copy)]
pub(super) struct Tag {
    pub(super) kind: Kind,
    pub(super) length: u64,
    /// With what fills it up.
    padded: u64,
}

impl Tag {
    /// How many whole numbers the data hold, and how they are stored; none where they are no numbers.
    fn numbers(self) -> (u64, Storage) {
        match self.kind {
            Kind::Numbers(storage) => (self.length / storage.size() as u64, storage),
            _ => (0, Storage::Unsigned(1)),
        }
    }

    /// How many numbers the data hold.
    pub(super) fn count(self) -> u64 {
        self.numbers().0
    }
}

/// Bytes as they come, and how many of them belong to what is being read.
pub(super) struct Stream<'a> {
    input: &'a mut dyn Read,
    at: u64,
    end: u64,
    endian: Endian,
    pub(super) allowance: &'a mut Allowance,
}

impl<'a> Stream<'a> {
    /// What is at place `at` up to `end`.
    pub(super) fn new(
        input: &'a mut dyn Read,
        [at, end]: [u64; 2],
        endian: Endian,
        allowance: &'a mut Allowance,
    ) -> Self {
        Self { input, at, end, endian, allowance }
    }

    /// Where the next byte is in the file.
    pub(super) fn place(&self) -> usize {
        usize::try_from(self.at).unwrap_or(usize::MAX)
    }

    pub(super) fn left(&self) -> u64 {
        self.end - self.at
    }

    fn check(&self, count: u64, name: &str) -> Result<(), FormatError> {
        if count <= self.left() {
            return Ok(());
        }
        let found = format!("{} to the end", self.left());
        Err(FormatError::byte(self.place(), format!("{count} bytes: {name}"), found))
    }

    /// Fills the buffer with the next bytes.
    fn take(&mut self, buffer: &mut [u8], name: &str) -> Result<(), FormatError> {
        self.check(buffer.len() as u64, name)?;
        let place = self.place();
        let got = fill(self.input, buffer).map_err(|error| broken(place, &error))?;
        self.at += got as u64;
        if got < buffer.len() {
            let found = format!("{got} to the end");
            return Err(FormatError::byte(place, format!("{} bytes: {name}", buffer.len()), found));
        }
        Ok(())
    }

    fn u32(&mut self, name: &str) -> Result<u32, FormatError> {
        let mut bytes = [0; 4];
        self.take(&mut bytes, name)?;
        Ok(match self.endian {
            Endian::Little => u32::from_le_bytes(bytes),
            Endian::Big => u32::from_be_bytes(bytes),
        })
    }

    /// Passes so many bytes by.
    fn skip(&mut self, count: u64) -> Result<(), FormatError> {
        let place = self.place();
        let skipped = std::io::copy(&mut (&mut *self.input).take(count), &mut std::io::sink());
        let skipped = skipped.map_err(|error| broken(place, &error))?;
        self.at += skipped;
        match skipped == count {
            true => Ok(()),
            false => {
                let found = format!("{skipped} to the end");
                Err(FormatError::byte(place, format!("{count} bytes"), found))
            }
        }
    }

    /// The tag of the next element, whose data are to be read next. `name` is what it is, for errors.
    pub(super) fn tag(&mut self, name: &str) -> Result<Tag, FormatError> {
        let first = self.u32(name)?;
        if first >> 16 > 0 {
            // Four bytes or less stand in the tag itself.
            self.check(4, name)?;
            let length = u64::from(first >> 16);
            if length > 4 {
                let expected = format!("{length} bytes: {name}");
                return Err(FormatError::byte(self.place(), expected, "4 to the end"));
            }
            return Ok(Tag { kind: Kind::of(first & 0xFFFF), length, padded: 4 });
        }
        let (kind, length) = (Kind::of(first), u64::from(self.u32(name)?));
        self.check(length, name)?;
        // The last element may end without.
        let fill = if kind == Kind::Compressed { 0 } else { (8 - length % 8) % 8 };
        Ok(Tag { kind, length, padded: (length + fill).min(self.left()) })
    }

    /// Reads the data of an element, for which the stream ends where they do; what `read` leaves is passed by.
    pub(super) fn inside<T>(
        &mut self,
        tag: Tag,
        read: impl FnOnce(&mut Self) -> Result<T, FormatError>,
    ) -> Result<T, FormatError> {
        let (end, next) = (self.end, self.at + tag.padded);
        self.end = self.at + tag.length;
        let read = read(self);
        self.end = end;
        let read = read?;
        self.skip(next - self.at)?;
        Ok(read)
    }

    /// Calls something with each number of the data of an element of numbers.
    pub(super) fn each_number(
        &mut self,
        tag: Tag,
        mut call: impl FnMut(u64, &[u8], &mut Allowance) -> Result<(), FormatError>,
    ) -> Result<(), FormatError> {
        let (count, storage) = tag.numbers();
        let size = storage.size() as u64;
        self.inside(tag, |stream| {
            // A whole number of them, since their sizes are powers of two.
            let mut chunk = [0; CHUNK];
            let mut k = 0;
            while k < count {
                let bytes = &mut chunk[..((count - k) * size).min(CHUNK as u64) as usize];
                stream.take(bytes, "numbers")?;
                for number in bytes.chunks_exact(storage.size()) {
                    call(k, number, stream.allowance)?;
                    k += 1;
                }
            }
            Ok(())
        })
    }

    /// What makes a number of the bytes of one.
    pub(super) fn reader(&self, tag: Tag) -> impl Fn(&[u8]) -> f64 + use<> {
        let (storage, endian) = (tag.numbers().1, self.endian);
        move |bytes| storage.value(bytes, endian)
    }

    /// All numbers of an element, each made of its bytes.
    fn all<T>(
        &mut self,
        tag: Tag,
        make: impl Fn(&[u8], Storage, Endian) -> T,
    ) -> Result<Vec<T>, FormatError> {
        self.allowance.sparse(tag.length)?;
        let (endian, storage, mut numbers) = (self.endian, tag.numbers().1, Vec::new());
        self.each_number(tag, |_, bytes, _| {
            numbers.push(make(bytes, storage, endian));
            Ok(())
        })?;
        Ok(numbers)
    }

    /// Numbers that all are kept, rounded to doubles.
    pub(super) fn values(&mut self, tag: Tag) -> Result<Vec<f64>, FormatError> {
        self.all(tag, |bytes, storage, endian| storage.value(bytes, endian))
    }

    /// Numbers that all are kept, where all are whole and not negative.
    pub(super) fn wholes(&mut self, name: &str) -> Result<Option<Vec<u64>>, FormatError> {
        let tag = self.tag(name)?;
        let whole = |bytes: &[u8], storage, endian| match storage {
            Storage::Float(_) => None,
            _ => u64::try_from(storage.whole(bytes, endian)).ok(),
        };
        Ok(self.all(tag, whole)?.into_iter().collect())
    }

    /// The bytes of an element.
    pub(super) fn bytes(&mut self, name: &str) -> Result<Vec<u8>, FormatError> {
        let tag = self.tag(name)?;
        self.allowance.plain(tag.length)?;
        self.inside(tag, |stream| {
            let place = stream.place();
            let bytes = at_most(stream.input, tag.length).map_err(|error| broken(place, &error))?;
            stream.at += bytes.len() as u64;
            match bytes.len() as u64 == tag.length {
                true => Ok(bytes),
                false => {
                    let found = format!("{} to the end", bytes.len());
                    Err(FormatError::byte(place, format!("{} bytes: {name}", tag.length), found))
                }
            }
        })
    }

    /// An element's bytes as characters.
    pub(super) fn text(&mut self, name: &str) -> Result<String, FormatError> {
        Ok(String::from_utf8_lossy(&self.bytes(name)?).trim_end_matches('\0').to_owned())
    }

    /// Passes by the rest, and makes sure that only the padding to eight bytes follows.
    pub(super) fn ends(&mut self) -> Result<(), FormatError> {
        self.skip(self.left())?;
        let mut behind = [0; 8];
        let more = fill(self.input, &mut behind).map_err(|error| broken(self.place(), &error))?;
        if more == behind.len() {
            let expected = format!("a compressed variable of {} bytes, as its tag says", self.end);
            return Err(FormatError::byte(self.place(), expected, "more"));
        }
        Ok(())
    }
}

fn broken(place: usize, error: &std::io::Error) -> FormatError {
    FormatError::byte(place, "a compressed variable", error.to_string())
}
