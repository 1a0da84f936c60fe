//! A zoo of wrong models: cases drawn at random, whose truth is another model than the one that is identified.
//!
//! | module | contents |
//! |---|---|
//! | [`dice`] | random numbers, for each case its own |
//! | [`structure`] | plates, beams, sandwiches and beams on springs, with their materials |
//! | [`fault`] | in which ways a model is wrong |
//! | [`realised`] | the matrices of a structure, and of its truth |
//! | [`natural`] | natural frequencies, by which one sees how wrong a model is |
//! | [`case`] | a case, measured with noise and identified |
//! | [`score`] | errors and error bars beside the truth |
//! | [`report`] | tables |

pub mod case;
pub mod dice;
pub mod fault;
pub mod natural;
#[cfg(test)]
mod pairs;
pub mod realised;
pub mod report;
pub mod score;
pub mod structure;
pub mod way;

/// Why a case could not be made: a fault of the benchmark, never a result.
pub type Failure = Box<dyn std::error::Error + Send + Sync>;

use case::{Case, Setting};
use fault::Unknowns;
use frfit::identify::Options;
use report::{Run, Tried};
use way::Way;

/// Draws a case of a seed and identifies it in some ways.
///
/// # Errors
/// [`Failure`], with the number of the case.
pub fn tried(
    seed: u64,
    index: u64,
    ways: &[Way],
    setting: Setting,
    options: &Options,
) -> Result<Tried, Failure> {
    let run = || {
        let case = Case::draw(seed, index, setting, Unknowns::of(ways))?;
        let identified = |&way: &Way| {
            let (found, seconds) = case.identify(way, options)?;
            Ok(Run::new(way, &found, score::judged(&case, &found)?, seconds))
        };
        Ok(Tried::new(&case, ways.iter().map(identified).collect::<Result<_, Failure>>()?))
    };
    run().map_err(|why: Failure| format!("case {index}: {why}").into())
}
