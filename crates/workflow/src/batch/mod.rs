//! Many runs by one plan: missing runs are done, finished ones are kept, and all of them become one table.
//!
//! | file | contents |
//! |---|---|
//! | `plan` | the table of runs |
//! | `key` | the checksum of a run's inputs, by which its results are found |
//! | `store` | the folder of results: each run whole or absent |
//! | `run` | doing what is missing |
//! | `collect` | one table of all runs |
//! | `slurm` | shares of a plan for the tasks of an array of jobs |

mod collect;
mod key;
mod plan;
mod run;
mod slurm;
mod store;

pub use collect::{Collected, Detail, collect};
pub use plan::Plan;
pub use run::{BatchOptions, BatchRun, Retry, run_batch};
pub use slurm::{Shard, ShardError, sbatch_script};
pub use store::{BatchStatus, batch_status};
