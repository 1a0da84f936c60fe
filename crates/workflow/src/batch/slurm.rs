//! Shares of a plan, for several processes and for the tasks of a Slurm array of jobs.

use std::fmt;
use std::path::Path;
use std::str::FromStr;

/// The i-th of n shares of a plan: rows i, i + n, i + 2n …
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Shard {
    /// Which, from 1.
    pub index: usize,
    /// Of how many.
    pub count: usize,
}

impl Default for Shard {
    fn default() -> Self {
        Self { index: 1, count: 1 }
    }
}

/// A share that cannot be.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ShardError(String);

impl fmt::Display for ShardError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "expected i/n with 1 ≤ i ≤ n, such as 1/4, found {:?}", self.0)
    }
}

impl std::error::Error for ShardError {}

impl FromStr for Shard {
    type Err = ShardError;

    fn from_str(text: &str) -> Result<Self, ShardError> {
        let numbers = text.split_once('/').and_then(|(i, n)| Some((i.parse().ok()?, n.parse().ok()?)));
        match numbers {
            Some((index, count)) if (1..=count).contains(&index) => Ok(Self { index, count }),
            _ => Err(ShardError(text.to_owned())),
        }
    }
}

impl Shard {
    /// That of a task of a Slurm array of jobs, by its environment; `None` outside of one.
    pub fn of_slurm(variable: impl Fn(&str) -> Option<String>) -> Option<Self> {
        let number = |name: &str| variable(name)?.parse::<usize>().ok();
        let (id, count) = (number("SLURM_ARRAY_TASK_ID")?, number("SLURM_ARRAY_TASK_COUNT")?);
        let first = number("SLURM_ARRAY_TASK_MIN").unwrap_or(0);
        let step = number("SLURM_ARRAY_TASK_STEP").unwrap_or(1).max(1);
        let index = id.checked_sub(first)? / step;
        (index < count).then_some(Self { index: index + 1, count })
    }

    /// Whether a row (from 0) is in it.
    pub(super) fn has(self, row: usize) -> bool {
        row % self.count == self.index - 1
    }
}

/// A job script for Slurm: so many tasks, each of which does its share of the plan independently.
pub fn sbatch_script(plan: &Path, out: &Path, reduced: Option<&Path>, tasks: usize) -> String {
    let quoted = |path: &Path| format!("'{}'", path.to_string_lossy().replace('\'', r"'\''"));
    let reduced = reduced.map_or(String::new(), |file| format!(" --reduced {}", quoted(file)));
    format!(
        "#!/bin/bash\n\
         #SBATCH --job-name=frfit\n\
         #SBATCH --array=0-{}\n\
         #SBATCH --cpus-per-task=1\n\
         #SBATCH --mem=4G\n\
         #SBATCH --time=01:00:00\n\
         #SBATCH --output=frfit-%A_%a.log\n\
         # Each task does its share of the plan. Submit again to do what is missing.\n\
         frfit batch {} --out {}{reduced} --jobs \"${{SLURM_CPUS_PER_TASK:-1}}\"\n",
        tasks.max(1) - 1,
        quoted(plan),
        quoted(out),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_row_is_in_one_share() {
        let shards: Vec<Shard> = (1..=4).map(|i| format!("{i}/4").parse().unwrap()).collect();
        for row in 0..23 {
            assert_eq!(shards.iter().filter(|shard| shard.has(row)).count(), 1);
        }
        for wrong in ["0/4", "5/4", "4", "1/0", "a/b", "1/4/2"] {
            assert!(wrong.parse::<Shard>().is_err(), "{wrong}");
        }
    }

    #[test]
    fn a_task_of_slurm_knows_its_share() {
        let of = |pairs: &'static [(&str, &str)]| {
            Shard::of_slurm(|name| {
                pairs.iter().find(|(own, _)| *own == name).map(|(_, value)| (*value).to_owned())
            })
        };
        assert_eq!(of(&[]), None);
        assert_eq!(
            of(&[
                ("SLURM_ARRAY_TASK_ID", "2"),
                ("SLURM_ARRAY_TASK_COUNT", "4"),
                ("SLURM_ARRAY_TASK_MIN", "0")
            ]),
            Some(Shard { index: 3, count: 4 })
        );
        assert_eq!(
            of(&[
                ("SLURM_ARRAY_TASK_ID", "7"),
                ("SLURM_ARRAY_TASK_COUNT", "4"),
                ("SLURM_ARRAY_TASK_MIN", "1"),
                ("SLURM_ARRAY_TASK_STEP", "2")
            ]),
            Some(Shard { index: 4, count: 4 })
        );
    }
}
