//! An array: its header, and elements by their indices.

use std::borrow::Cow;

use num_complex::Complex64 as c64;

use super::header::{Element, Header};
use crate::FormatError;

/// An array whose bytes are there.
#[derive(Debug, Clone)]
pub(super) struct Array<'a> {
    pub(super) header: Header,
    /// With the header before them.
    file: Cow<'a, [u8]>,
}

impl<'a> Array<'a> {
    /// `name` is that of the array, for errors.
    pub(super) fn read(file: Cow<'a, [u8]>, name: &str) -> Result<Self, FormatError> {
        let header = Header::parse(&file, name)?;
        let data = &file[header.end..];
        if header.length() != Some(data.len()) {
            let expected = match header.length() {
                Some(length) => format!("{length} bytes for {}", header.described()),
                None => format!("an array that fits into memory, not {}", header.described()),
            };
            let of = if name.is_empty() { String::new() } else { format!(" (array {name:?})") };
            return Err(FormatError::byte(header.end, expected + &of, format!("{} bytes", data.len())));
        }
        Ok(Self { header, file })
    }

    fn data(&self) -> &[u8] {
        &self.file[self.header.end..]
    }

    pub(super) fn shape(&self) -> &[u64] {
        &self.header.shape
    }

    pub(super) fn is_complex(&self) -> bool {
        matches!(self.header.element, Element::Complex(_))
    }

    pub(super) fn is_text(&self) -> bool {
        matches!(self.header.element, Element::Text { .. })
    }

    /// How many elements.
    pub(super) fn count(&self) -> usize {
        self.data().len().checked_div(self.header.element.size()).unwrap_or(0)
    }

    /// The bytes of the element that is k-th in the file.
    fn bytes(&self, k: usize) -> &[u8] {
        let size = self.header.element.size();
        &self.data()[k * size..][..size]
    }

    /// The element that is k-th in the file, as a number.
    pub(super) fn value(&self, k: usize) -> c64 {
        let (bytes, endian) = (self.bytes(k), self.header.endian);
        match self.header.element {
            Element::Real(storage) => c64::new(storage.value(bytes, endian), 0.0),
            Element::Complex(storage) => {
                let (re, im) = bytes.split_at(storage.size());
                c64::new(storage.value(re, endian), storage.value(im, endian))
            }
            Element::Text { .. } => c64::new(f64::NAN, 0.0),
        }
    }

    /// The element that is k-th in the file, as a whole number; `None` where it is none.
    pub(super) fn whole(&self, k: usize) -> Option<i64> {
        use crate::bytes::Storage::{Signed, Unsigned};
        match self.header.element {
            Element::Real(storage @ (Signed(_) | Unsigned(_))) => {
                i64::try_from(storage.whole(self.bytes(k), self.header.endian)).ok()
            }
            _ => None,
        }
    }

    /// The only text of an array of texts.
    pub(super) fn text(&self) -> Option<String> {
        let Element::Text { size, .. } = self.header.element else { return None };
        let characters = self.data().chunks_exact(size).map(|bytes| bytes.iter().copied().find(|&b| b != 0));
        (self.count() == 1).then(|| characters.map_while(|byte| byte.map(char::from)).collect())
    }

    /// Where in the file the element of these indices is.
    pub(super) fn at(&self, indices: &[usize]) -> usize {
        let step = |k: usize, (index, size): (&usize, &u64)| k * *size as usize + index;
        let pairs = indices.iter().zip(self.shape());
        if self.header.is_fortran { pairs.rev().fold(0, step) } else { pairs.fold(0, step) }
    }
}

impl Header {
    /// The shape in words.
    pub(super) fn described(&self) -> String {
        match self.shape.as_slice() {
            [] => "a single element".into(),
            [length] => format!("a vector of {length}"),
            shape => {
                let sizes: Vec<_> = shape.iter().map(u64::to_string).collect();
                format!("an array of {}", sizes.join(" x "))
            }
        }
    }
}
