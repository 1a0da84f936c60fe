//! The two times whose ratio is the speed-up.

use frfit::response::Response;
use frfit::series::NeumannSeries;
use frfit_bench::clock::median_seconds;
use frfit_examples::{Error, Model};
use std::hint::black_box;

/// Orders of the series that are timed.
pub(crate) const ORDERS: [usize; 6] = [1, 5, 10, 20, 30, 50];

/// What one model costs.
pub(crate) struct Timing {
    pub(crate) kind: &'static str,
    pub(crate) dofs: usize,
    pub(crate) nonzeros: usize,
    /// Assembly, numerical factorisation and solve at a new parameter value.
    pub(crate) direct_seconds: f64,
    /// The series of each of [`ORDERS`], given the nominal factor.
    pub(crate) series_seconds: Vec<f64>,
}

impl Timing {
    /// One more term of the series: the slope between the lowest and the highest order.
    pub(crate) fn term_seconds(&self) -> f64 {
        let last = ORDERS.len() - 1;
        (self.series_seconds[last] - self.series_seconds[0]) / (ORDERS[last] - ORDERS[0]) as f64
    }

    /// Direct solve over series, for each of [`ORDERS`].
    pub(crate) fn speedups(&self) -> Vec<f64> {
        self.series_seconds.iter().map(|seconds| self.direct_seconds / seconds).collect()
    }
}

/// Times a model in the middle of its band, from its nominal parameter to the true one.
pub(crate) fn measure(kind: &'static str, model: &Model) -> Result<Timing, Error> {
    let frequency_hz = (model.band_hz[0] + model.band_hz[1]) / 2.0;
    let system = model.nominal_at(frequency_hz)?;
    let correction = model.truth.at(frequency_hz)? - system.nominal(0);
    let direct = || system.solve_at(&[correction]);
    let series =
        |order| NeumannSeries::new(&system, 0, order).map(|series| series.respond(correction, order));
    // What is timed has to succeed.
    direct()?;
    series(1)?;
    let timed_direct = || drop(black_box(direct()));
    let timed_series = ORDERS.map(|order| move || drop(black_box(series(order))));
    let mut works: Vec<&dyn Fn()> = vec![&timed_direct];
    works.extend(timed_series.iter().map(|work| work as &dyn Fn()));
    let seconds = median_seconds(&works);
    Ok(Timing {
        kind,
        dofs: model.stiffness.dim(),
        nonzeros: model.stiffness.analysis().pattern().nonzeros(),
        direct_seconds: seconds[0],
        series_seconds: seconds[1..].to_vec(),
    })
}
