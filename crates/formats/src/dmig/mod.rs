//! Nastran direct matrix input at points, DMIG: in a punch file (`.pch`) or in bulk data.
//!
//! ```text
//! DMIG    KAAX           0       6       2       0                       2
//! DMIG*   KAAX                           1               3
//! *                      1               3  1.500000000D+06
//! *                      2               3 -1.500000000D+06
//! ```
//!
//! A matrix has a header (0 in the third field, then IFO, TIN, TOUT, POLAR, a blank and NCOL) and cards for its
//! columns: grid and component of the column, a blank, then for each entry grid, component, and one or two numbers. Small
//! fields (8 columns), large fields (16 columns, the name with a star) and fields set apart by commas are read,
//! each line by its own kind; a point that is no grid has component 0 or blank. Real and complex matrices (TIN 1 to 4;
//! with POLAR amplitude and phase in degrees), square (IFO 1), symmetric by one triangle (IFO 6) and rectangular (2, 9).
//! All other cards are passed over, up to ENDDATA.
//!
//! Rows and columns of a square or symmetric matrix are all labels that occur in either, sorted. A rectangular one has the
//! rows that occur; columns are those that occur, or with IFO 9 and NCOL the numbers 1 to NCOL.
//!
//! # Limits
//! A tab in a card of fixed fields is refused: which column it stands for depends on who reads it.
//!
//! # Source
//! MSC Nastran Quick Reference Guide, bulk data entry DMIG, and "Format of Bulk Data Entries".

mod card;
mod header;
mod read;

pub(crate) use card::looks_like;
pub use read::read;
