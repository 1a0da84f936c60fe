//! Two methods at one frequency, each with more and more effort.

use frfit::c64;
use frfit::identify::relative_error;
use frfit::nelder_mead;
use frfit::response::Response;
use frfit::roots::{Bounds, RootOptions, candidates, least_admissible};
use frfit::series::NeumannSeries;
use frfit_bench::clock::{mean_and_deviation, seconds};
use frfit_examples::{Error, Model};

/// Times that each run is repeated, as in the paper.
pub(crate) const REPEATS: usize = 100;

/// Highest order of the series, and most iterations of the search, as in the paper.
const ORDER: usize = 30;
const ITERATIONS: usize = 35;

/// Error and CPU time of one method with one effort.
pub(crate) struct Run {
    pub(crate) error: f64,
    /// Mean over the repeats.
    pub(crate) seconds: f64,
    /// Standard deviation over the repeats.
    pub(crate) deviation: f64,
}

/// Runs with rising order and rising number of iterations.
pub(crate) struct Contest {
    pub(crate) series: Vec<Run>,
    pub(crate) nelder_mead: Vec<Run>,
}

impl Contest {
    /// Both methods on a model's measurement at a frequency.
    pub(crate) fn at(model: &Model, frequency_hz: f64) -> Result<Self, Error> {
        let measured = model.measured_at(frequency_hz)?;
        let system = model.nominal_at(frequency_hz)?;
        let run = |find: &dyn Fn() -> Result<c64, Error>| {
            let error = relative_error(&measured, &system.solve_at(&[find()?])?);
            let times: Vec<f64> = (0..REPEATS).map(|_| seconds(find)).collect();
            let (seconds, deviation) = mean_and_deviation(&times);
            Ok(Run { error, seconds, deviation })
        };
        let by_series = |order| run(&|| by_series(model, frequency_hz, measured[0], order));
        let by_search =
            |iterations| run(&|| Ok(nelder_mead::search(&system, &measured, iterations).correction));
        Ok(Self {
            series: (1..=ORDER).map(by_series).collect::<Result<_, Error>>()?,
            nelder_mead: (1..=ITERATIONS).map(by_search).collect::<Result<_, Error>>()?,
        })
    }
}

/// The paper's Section 4: one factorisation, the series, the roots, and the least root within the bounds; no
/// correction where no root is within the bounds.
fn by_series(model: &Model, frequency_hz: f64, measured: c64, order: usize) -> Result<c64, Error> {
    let system = model.nominal_at(frequency_hz)?;
    let series = NeumannSeries::new(&system, 0, order)?;
    let passive = Bounds { storage: Some([0.0, f64::MAX]), loss_factor: Some([0.0, f64::MAX]) };
    let options = RootOptions::default().with_bounds(passive);
    let roots = candidates(&series, 0, measured, system.nominal(0), order, &options);
    Ok(least_admissible(&roots).map_or(c64::default(), |root| root.correction))
}
