//! An array: its header, and elements by their indices.

use std::io::Read;

use num_complex::Complex64 as c64;

use super::header::{Element, Header};
use crate::FormatError;
use crate::inflated::{Allowance, at_most, fill};

/// An array whose bytes are there: a vector of a sparse matrix.
#[derive(Debug, Clone)]
pub(super) struct Array {
    pub(super) header: Header,
    data: Vec<u8>,
}

impl Array {
    /// Reads the elements behind a header, no further than it declares. `name` is that of the array, for errors.
    pub(super) fn read(
        header: Header,
        input: &mut dyn Read,
        allowance: &mut Allowance,
        name: &str,
    ) -> Result<Self, FormatError> {
        let declared = header.declared(name)?;
        match header.element {
            Element::Text { .. } => allowance.plain(declared)?,
            Element::Real(_) | Element::Complex(_) => allowance.sparse(declared)?,
        }
        allowance.inflate(declared)?;
        let broken = |error: std::io::Error| {
            FormatError::whole(format!("an array {name:?} in the archive"), error.to_string())
        };
        let data = at_most(input, declared).map_err(broken)?;
        if (data.len() as u64) < declared {
            return Err(header.wrong_length(declared, &data.len().to_string(), name));
        }
        // The end is read too: there an archive compares its checksum.
        if fill(input, &mut [0]).map_err(broken)? > 0 {
            return Err(header.wrong_length(declared, "more", name));
        }
        Ok(Self { header, data })
    }

    pub(super) fn shape(&self) -> &[u64] {
        &self.header.shape
    }

    pub(super) fn is_complex(&self) -> bool {
        matches!(self.header.element, Element::Complex(_))
    }

    /// How many elements.
    pub(super) fn count(&self) -> usize {
        self.data.len().checked_div(self.header.element.size()).unwrap_or(0)
    }

    /// The bytes of the element that is k-th in the file.
    fn bytes(&self, k: usize) -> &[u8] {
        let size = self.header.element.size();
        &self.data[k * size..][..size]
    }

    /// The element that is k-th in the file, as a number.
    pub(super) fn value(&self, k: usize) -> c64 {
        self.header.value(self.bytes(k))
    }

    /// The element that is k-th in the file, as a whole number; `None` where it is not whole.
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
        let characters = self.data.chunks_exact(size).map(|bytes| bytes.iter().copied().find(|&b| b != 0));
        (self.count() == 1).then(|| characters.map_while(|byte| byte.map(char::from)).collect())
    }

    /// The bytes of an array of a single text.
    pub(super) fn only_bytes(&self) -> Option<&[u8]> {
        let is_bytes = matches!(self.header.element, Element::Text { size: 1, .. });
        (is_bytes && self.shape().is_empty()).then_some(&self.data)
    }

    /// All elements in the order of their indices; `None` where they are no real numbers, or column after column.
    pub(super) fn reals(&self) -> Option<Vec<f64>> {
        let Element::Real(storage) = self.header.element else { return None };
        let is_ordered = !self.header.is_fortran || self.shape().len() < 2;
        let value = |bytes: &[u8]| storage.value(bytes, self.header.endian);
        is_ordered.then(|| self.data.chunks_exact(storage.size()).map(value).collect())
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
