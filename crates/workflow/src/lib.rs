//! From a case file to identified parameters, tables and figures.
//!
//! | module | contents |
//! |---|---|
//! | [`batch`] | many runs by one plan, and one table of them
//! | [`case`] | the case file as it is written, every key and type checked |
//! | [`load`](mod@load) | its files read: model, load, sensors, measured receptance |
//! | [`records`] | the records of a hammer test read from files |
//! | [`memory`] | whether a model fits, before it is factorised |
//! | [`run`] | the computations, frequency by frequency, on all cores |
//! | [`check`](mod@check) | what is wrong with a case's data, in words |
//! | [`sensitivities`](mod@sensitivities) | what the response depends on, what the sensors identify, where the next one should go |
//! | [`figures`] | what a run looks like, as the paper draws it |
//! | [`report`](mod@report) | all of it as one HTML page |
//! | [`output`] | tables, summary, and writing them whole or not at all |
//! | [`fit`] | laws fitted to a table of moduli |
//! | [`job`] | whole jobs: from the path of a case to files in a folder |
//! | [`inspect`](mod@inspect) | what is in a file |
//! | [`convert`](mod@convert) | from one format of a matrix or an FRF to another |
//! | [`export`](mod@export) | the identified modulus as the table that the next solver reads |
//! | [`error`] | what the user has to put right, and where |
//! | [`Reads`] | which files were read, so that nothing is written over them |
//! | [`terminal`] | text of files without what steers a terminal |

pub mod batch;
pub mod case;
pub mod check;
pub mod convert;
pub mod error;
pub mod export;
pub mod figures;
pub mod fit;
pub mod inspect;
pub mod job;
mod job_error;
pub mod load;
pub mod memory;
pub mod modes;
mod nearest;
pub mod output;
mod reads;
pub mod records;
mod reduced;
pub mod report;
pub mod run;
pub mod sensitivities;
pub mod terminal;
pub mod units;

pub use reads::Reads;
