//! Cases drawn at random, tried side by side.

use crate::in_pool;
use crate::wrong_models::Failure;
use rayon::prelude::*;
use std::str::FromStr;

/// Threads, each with a case of its own.
const THREADS: usize = 2;

/// What came of some cases.
#[derive(Debug)]
pub struct Cases<T> {
    /// Those that could be made.
    pub tried: Vec<T>,
    /// Why others could not.
    failed: Vec<String>,
}

impl<T: Send> Cases<T> {
    /// Tries each of them, and says of each what came of it when it is done.
    ///
    /// # Errors
    /// [`Failure`] where there are no threads to be had.
    #[allow(clippy::print_stderr)] // the progress of a benchmark
    pub fn try_all(
        indices: &[u64],
        tried: impl Fn(u64) -> Result<T, Failure> + Sync,
        described: impl Fn(&T) -> String + Sync,
    ) -> Result<Self, Failure> {
        let one = |&index: &u64| {
            let done = tried(index);
            eprintln!("{}", done.as_ref().map_or_else(ToString::to_string, &described));
            done
        };
        let all: Vec<Result<T, Failure>> =
            in_pool(THREADS, || indices.par_iter().with_max_len(1).map(one).collect())?;
        let failed = all.iter().filter_map(|one| one.as_ref().err()).map(ToString::to_string).collect();
        Ok(Self { failed, tried: all.into_iter().flatten().collect() })
    }

    /// To be said when the table of the others is there: a fault of the benchmark is not a result.
    ///
    /// # Errors
    /// [`Failure`] where a case could not be made.
    pub fn all_made(&self) -> Result<(), Failure> {
        match self.failed.len() {
            0 => Ok(()),
            count => Err(format!("{count} cases could not be made: {}", self.failed.join("; ")).into()),
        }
    }
}

/// `[CASES] [SEED] [--case K]` of the command line, and a flag where a benchmark has one: the numbers of the cases (so many, or the case K alone), the seed, and
/// whether the flag is there.
///
/// # Errors
/// [`Failure`] for other words.
pub fn arguments(default: [u64; 2], flag: Option<&str>) -> Result<(Vec<u64>, u64, bool), Failure> {
    let mut positions = default;
    let (mut place, mut case, mut is_there) = (0, None, false);
    let mut words = std::env::args().skip(1);
    while let Some(word) = words.next() {
        if word == "--case" {
            case = Some(number(&words.next().ok_or("--case: expected a value")?)?);
        } else if flag == Some(word.as_str()) {
            is_there = true;
        } else if place < positions.len() {
            positions[place] = number(&word)?;
            place += 1;
        } else {
            let flag = flag.map_or(String::new(), |flag| format!(", {flag}"));
            return Err(format!("expected CASES, SEED{flag} or --case, found {word:?}").into());
        }
    }
    let [cases, seed] = positions;
    Ok((case.map_or_else(|| (0..cases).collect(), |index| vec![index]), seed, is_there))
}

/// A number on the command line.
///
/// # Errors
/// [`Failure`] where the text is not a number.
pub fn number<T: FromStr>(text: &str) -> Result<T, Failure> {
    text.parse().map_err(|_| format!("expected a number, found {text:?}").into())
}
