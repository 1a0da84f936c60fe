//! Commands that a case file may start: those of an MPI launcher that start nothing but the ranks.
//!
//! A case file comes with a model, often from somebody else. What it says is data; it must not run programs.

/// Without another command: as many ranks as the machine has cores, or as the job of a cluster has.
pub(crate) const DEFAULT: &str = "mpirun";

/// What is allowed, for messages.
pub(super) const HARMLESS: &str = "mpirun, mpiexec or srun with options such as -n 4 and --map-by core";

const LAUNCHERS: [&str; 3] = ["mpirun", "mpiexec", "srun"];

/// Options that say how many ranks there are and where they run.
const OPTIONS: [&str; 19] = [
    "-n",
    "-np",
    "-N",
    "-c",
    "-p",
    "-t",
    "-A",
    "--ntasks",
    "--nodes",
    "--ntasks-per-node",
    "--cpus-per-task",
    "--mem",
    "--partition",
    "--time",
    "--account",
    "--mpi",
    "--cpu-bind",
    "--map-by",
    "--bind-to",
];

/// Options without a value.
const FLAGS: [&str; 4] = ["--oversubscribe", "--allow-run-as-root", "--exclusive", "--overlap"];

/// Refuses a command that could start more than the ranks; what is wrong with it.
pub(super) fn is_harmless(command: &str) -> Result<(), String> {
    let mut words = command.split_whitespace();
    let launcher = words.next().unwrap_or_default();
    if !LAUNCHERS.contains(&launcher) {
        return Err(format!("{launcher:?}"));
    }
    let is_plain = |value: &str| {
        let is_usual = |one: char| one.is_ascii_alphanumeric() || ":=_,.".contains(one);
        !value.is_empty() && value.chars().all(is_usual)
    };
    while let Some(word) = words.next() {
        let (option, value) =
            word.split_once('=').map_or((word, None), |(option, value)| (option, Some(value)));
        let is_known = match value {
            None if FLAGS.contains(&option) => true,
            None => OPTIONS.contains(&option) && words.next().is_some_and(is_plain),
            Some(value) => OPTIONS.contains(&option) && is_plain(value),
        };
        if !is_known {
            return Err(format!("{word:?}"));
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranks_are_started_and_nothing_else() {
        for command in
            [DEFAULT, "mpirun -n 4", "srun --ntasks=64 --mpi=pmix", "mpiexec -np 2 --oversubscribe"]
        {
            assert_eq!(is_harmless(command), Ok(()), "{command}");
        }
        for (command, found) in [
            ("", "\"\""),
            ("sh -c true", "\"sh\""),
            ("/tmp/mpirun -n 2", "\"/tmp/mpirun\""),
            ("mpirun -n 2 sh", "\"sh\""),
            ("mpirun --app file", "\"--app\""),
            ("srun --prolog=/tmp/x", "\"--prolog=/tmp/x\""),
            ("mpirun -n", "\"-n\""),
            ("mpirun -n $(id)", "\"-n\""),
            ("mpirun --oversubscribe=sh", "\"--oversubscribe=sh\""),
        ] {
            assert_eq!(is_harmless(command), Err(found.to_owned()), "{command}");
        }
    }
}
