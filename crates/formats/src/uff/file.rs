//! A file of which only what is asked for is read.

use std::borrow::Cow;

use crate::FormatError;

use super::data;
use super::entry::Entry;
use super::file_header;
use super::function::Function;
use super::function_header::FunctionHeader;
use super::nodes;
use super::read_header::function_header;
use super::record::Record;
use super::scan::scan;
use super::summary::{FunctionSummary, Summary};
use super::trace_line;
use super::units;

const FUNCTION: u32 = 58;

/// The bytes of a file and the places of its datasets.
#[derive(Debug, Clone)]
pub struct File<'a> {
    bytes: &'a [u8],
    entries: Cow<'a, [Entry]>,
}

impl<'a> File<'a> {
    /// Finds the datasets without reading them.
    ///
    /// # Errors
    ///
    /// As [`scan`].
    pub fn new(bytes: &'a [u8]) -> Result<Self, FormatError> {
        Ok(Self { bytes, entries: Cow::Owned(scan(bytes)?) })
    }

    /// The same file with datasets that [`scan`] found in these bytes before.
    #[must_use]
    pub fn with_entries(bytes: &'a [u8], entries: &'a [Entry]) -> Self {
        Self { bytes, entries: Cow::Borrowed(entries) }
    }

    /// The datasets in the order of the file; their positions here are the indices of all methods.
    #[must_use]
    pub fn entries(&self) -> &[Entry] {
        &self.entries
    }

    /// The indices of the functions (58 and 58b).
    pub fn functions(&self) -> impl Iterator<Item = usize> {
        self.entries.iter().enumerate().filter(|(_, entry)| entry.dataset == FUNCTION).map(|(index, _)| index)
    }

    /// The header of a function; its data are not touched.
    ///
    /// # Errors
    ///
    /// The index is not that of a 58, or a field of the header cannot be read.
    pub fn function_header(&self, index: usize) -> Result<FunctionHeader, FormatError> {
        function_header(&mut self.function_entry(index)?.lines(self.bytes))
    }

    /// A function with its data. Where a file was cut short, it has fewer points than its header says
    /// ([`Function::missing_points`]).
    ///
    /// # Errors
    ///
    /// The index is not that of a 58, a field of header or data cannot be read, there are more data than the
    /// header says, or the number format of binary data is not IEEE 754.
    pub fn function(&self, index: usize) -> Result<Function, FormatError> {
        data::function(self.bytes, self.function_entry(index)?)
    }

    /// What a dataset holds.
    ///
    /// # Errors
    ///
    /// There is no such index, or the dataset of a known number holds something else than its format says.
    pub fn record(&self, index: usize) -> Result<Record, FormatError> {
        let entry = self.entry(index)?;
        let lines = entry.lines(self.bytes);
        Ok(match entry.dataset {
            15 => Record::Nodes(nodes::read_15(lines)?),
            FUNCTION => Record::Function(Box::new(data::function(self.bytes, entry)?)),
            82 => Record::TraceLine(Box::new(trace_line::read(lines)?)),
            151 => Record::FileHeader(Box::new(file_header::read(lines)?)),
            164 => Record::Units(Box::new(units::read(lines)?)),
            2411 => Record::Nodes(nodes::read_2411(lines)?),
            dataset => Record::Other { dataset, bytes: entry.bytes.clone() },
        })
    }

    /// A dataset in a few words; of a function only the header, and the ends of a stored abscissa, are read.
    ///
    /// # Errors
    ///
    /// There is no such index, or the header of a function cannot be read.
    pub fn summary(&self, index: usize) -> Result<Summary, FormatError> {
        let entry = self.entry(index)?;
        let is_function = entry.dataset == FUNCTION;
        let function = is_function.then(|| FunctionSummary::read(self.bytes, entry)).transpose()?;
        Ok(Summary { dataset: entry.dataset, binary: entry.is_binary(), line: entry.line, function })
    }

    fn entry(&self, index: usize) -> Result<&Entry, FormatError> {
        let expected = || format!("a dataset index below {}", self.entries.len());
        self.entries.get(index).ok_or_else(|| FormatError::whole(expected(), index.to_string()))
    }

    fn function_entry(&self, index: usize) -> Result<&Entry, FormatError> {
        let entry = self.entry(index)?;
        if entry.dataset == FUNCTION {
            return Ok(entry);
        }
        Err(FormatError::line(entry.line, "a function (dataset 58)", format!("dataset {}", entry.dataset)))
    }
}

/// Reads every dataset of a file, data included. Memory is at most 16 times the file.
///
/// # Errors
///
/// As [`scan`](super::scan), or a dataset of a known number holds something else than its format says.
pub fn read_all(bytes: &[u8]) -> Result<Vec<Record>, FormatError> {
    let file = File::new(bytes)?;
    (0..file.entries().len()).map(|index| file.record(index)).collect()
}
