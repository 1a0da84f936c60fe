//! What a run leaves behind: tables, summary and figures, written whole or not at all.

mod assumptions;
mod candidates;
mod columns;
mod error_map;
mod file;
mod files;
mod frf;
mod identifiability;
mod identified;
mod laws;
mod manifest;
mod measured;
mod reference;
mod response;
mod staging;
mod summary;
mod target;
mod words;

pub use crate::case::snippet;
pub use assumptions::contradicted;
pub use candidates::candidates_csv;
pub(crate) use candidates::{Solution, solutions};
pub use error_map::error_map_csv;
pub use file::File;
pub use files::{WriteError, check_file, check_folder, write_all, write_one, write_result, write_unedited};
pub use frf::{respond_uff, updated_uff};
pub use identifiability::{coordinate, not_identifiable};
pub use identified::identified_csv;
pub use laws::{Misfit, law_json, laws_json, laws_text, smooth_json};
pub(crate) use manifest::{IDENTIFIED, hexadecimal, read_result, sha256};
pub use measured::{impact_reasons, measured_csv, measured_summary, measured_text, measured_uff};
pub use reference::reference_csv;
pub use response::{respond_csv, response_csv};
pub use summary::summary_json;
pub use target::{is_standard_output, is_stream};
pub use words::Words;
