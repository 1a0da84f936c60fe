//! The header of an array: a Python dictionary of `descr`, `fortran_order` and `shape`.

use num_complex::Complex64 as c64;

use crate::FormatError;
use crate::bytes::Storage;
use crate::text::quoted;
use crate::uff::Endian;

/// More than any header of an array of numbers takes.
pub(super) const LONGEST: u64 = 0x1_0000;

/// Magic, version and length of the header in version 1.
const START: usize = 10;

/// What the elements of an array are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Element {
    /// A number.
    Real(Storage),
    /// Two numbers.
    Complex(Storage),
    /// Characters of one byte or, after Unicode, of four.
    Text { characters: usize, size: usize },
}

impl Element {
    /// Bytes of an element.
    pub(super) fn size(self) -> usize {
        match self {
            Self::Real(storage) => storage.size(),
            Self::Complex(storage) => 2 * storage.size(),
            Self::Text { characters, size } => characters.saturating_mul(size),
        }
    }
}

#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Header {
    pub(super) element: Element,
    pub(super) endian: Endian,
    pub(super) is_fortran: bool,
    pub(super) shape: Vec<u64>,
    /// Where the elements begin.
    pub(super) end: usize,
}

impl Header {
    /// `name` is that of the array, for errors.
    pub(super) fn parse(bytes: &[u8], name: &str) -> Result<Self, FormatError> {
        let refuse = |expected: &str, found: String| {
            Err(FormatError::byte(0, format!("{expected}{}", of(name)), found))
        };
        let start = match bytes {
            [0x93, b'N', b'U', b'M', b'P', b'Y', 1, _, low, high, ..] => {
                Some((10, usize::from(*low) | usize::from(*high) << 8))
            }
            [0x93, b'N', b'U', b'M', b'P', b'Y', 2 | 3, _, a, b, c, d, ..] => {
                Some((12, u32::from_le_bytes([*a, *b, *c, *d]) as usize))
            }
            _ => None,
        };
        let Some((start, length)) = start else {
            return refuse("an array of NumPy, version 1 to 3", quoted(&bytes[..bytes.len().min(8)]));
        };
        let end = length.saturating_add(start);
        let Some(Ok(text)) = bytes.get(start..end).map(std::str::from_utf8) else {
            return refuse("a header of a text", format!("{length} bytes that are no text, or too few"));
        };
        let after = |key: &str| text.split_once(key).map(|(_, rest)| rest.trim_start());
        let Some(descr) = after("'descr':") else {
            return refuse("a header with 'descr'", quoted(text.as_bytes()));
        };
        let Some((endian, element)) =
            descr.strip_prefix('\'').and_then(|d| d.split_once('\'')).and_then(|d| element(d.0))
        else {
            let found = format!("descr {}", quoted(descr.split(", '").next().unwrap_or(descr).as_bytes()));
            return refuse("an array of real or complex numbers of 4 or 8 bytes, or of whole numbers", found);
        };
        let is_fortran = match after("'fortran_order':") {
            Some(rest) if rest.starts_with("True") => true,
            Some(rest) if rest.starts_with("False") => false,
            _ => return refuse("a header with 'fortran_order'", quoted(text.as_bytes())),
        };
        let shape = after("'shape':").and_then(|rest| rest.strip_prefix('(')?.split_once(')'));
        let sizes = shape.and_then(|(inside, _)| {
            let sizes = inside.split(',').map(str::trim).filter(|size| !size.is_empty());
            sizes.map(|size| size.trim_end_matches('L').parse().ok()).collect::<Option<Vec<u64>>>()
        });
        match sizes {
            Some(shape) => Ok(Self { element, endian, is_fortran, shape, end }),
            None => refuse("a header with 'shape'", quoted(text.as_bytes())),
        }
    }

    /// Bytes of all elements; `None` where no memory holds as many.
    pub(super) fn length(&self) -> Option<usize> {
        let count = self.shape.iter().try_fold(1_u64, |product, size| product.checked_mul(*size))?;
        usize::try_from(count).ok()?.checked_mul(self.element.size())
    }

    /// The same, refused where no memory holds as many.
    pub(super) fn declared(&self, name: &str) -> Result<u64, FormatError> {
        let fits = || format!("an array that fits into memory{}", of(name));
        let length = self.length().ok_or_else(|| FormatError::byte(self.end, fits(), self.described()))?;
        Ok(length as u64)
    }

    /// An array with other bytes than its shape takes.
    pub(super) fn wrong_length(&self, declared: u64, found: &str, name: &str) -> FormatError {
        let expected = format!("{declared} bytes for {}{}", self.described(), of(name));
        FormatError::byte(self.end, expected, format!("{found} bytes"))
    }

    /// An element as a number.
    pub(super) fn value(&self, bytes: &[u8]) -> c64 {
        match self.element {
            Element::Real(storage) => c64::new(storage.value(bytes, self.endian), 0.0),
            Element::Complex(storage) => {
                let (re, im) = bytes.split_at(storage.size());
                c64::new(storage.value(re, self.endian), storage.value(im, self.endian))
            }
            Element::Text { .. } => c64::new(f64::NAN, 0.0),
        }
    }
}

/// Magic, version 1.0 and header of an array whose last index runs fastest, to a multiple of 64 bytes.
pub(super) fn of_array(descr: &str, shape: &[usize]) -> Vec<u8> {
    let sizes: String = shape.iter().map(|size| format!("{size}, ")).collect();
    let text = format!("{{'descr': '{descr}', 'fortran_order': False, 'shape': ({}), }}", sizes.trim_end());
    let length = (START + text.len() + 1).next_multiple_of(64) - START;
    let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
    bytes.extend(u16::try_from(length).unwrap_or(u16::MAX).to_le_bytes());
    bytes.extend(text.bytes());
    bytes.resize(START + length - 1, b' ');
    bytes.push(b'\n');
    bytes
}

/// Which array of an archive, for errors.
fn of(name: &str) -> String {
    if name.is_empty() { String::new() } else { format!(" (array {name:?})") }
}

/// Byte order and element of a type such as `<f8`.
fn element(descr: &str) -> Option<(Endian, Element)> {
    let endian = match descr.as_bytes().first()? {
        b'>' => Endian::Big,
        b'<' | b'|' | b'=' => Endian::Little,
        _ => return None,
    };
    let size: usize = descr.get(2..)?.parse().ok()?;
    let element = match (descr.as_bytes()[1], size) {
        (b'f', 4 | 8) => Element::Real(Storage::Float(size)),
        (b'c', 8 | 16) => Element::Complex(Storage::Float(size / 2)),
        (b'i', 1 | 2 | 4 | 8) => Element::Real(Storage::Signed(size)),
        (b'u', 1 | 2 | 4 | 8) | (b'b', 1) => Element::Real(Storage::Unsigned(size)),
        (b'S', _) => Element::Text { characters: size, size: 1 },
        (b'U', _) => Element::Text { characters: size, size: 4 },
        _ => return None,
    };
    Some((endian, element))
}
