//! frfit from Python: thin wrappers that hold Rust structs. What they mean is documented in `python/frfit`.

mod background;
mod batch;
mod case;
mod columns;
mod errors;
mod identify;
mod law;
mod matrix;
mod model;
mod modes;
mod pool;
mod report;
mod respond;
mod series;
mod signal;
mod uff;
mod verbs;

use pyo3::prelude::*;

/// The compiled part of the package `frfit`.
#[pymodule]
fn _frfit(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add_class::<law::Law>()?;
    module.add_class::<model::Model>()?;
    module.add_class::<series::Series>()?;
    module.add_class::<uff::UffFile>()?;
    module.add_function(wrap_pyfunction!(batch::train, module)?)?;
    module.add_function(wrap_pyfunction!(batch::batch, module)?)?;
    module.add_function(wrap_pyfunction!(batch::batch_status, module)?)?;
    module.add_function(wrap_pyfunction!(batch::batch_table, module)?)?;
    module.add_function(wrap_pyfunction!(identify::check_measurement, module)?)?;
    module.add_function(wrap_pyfunction!(matrix::readable, module)?)?;
    module.add_function(wrap_pyfunction!(model::restored_model, module)?)?;
    module.add_function(wrap_pyfunction!(series::restored_series, module)?)?;
    module.add_function(wrap_pyfunction!(matrix::read_matrix, module)?)?;
    module.add_function(wrap_pyfunction!(matrix::powers_of, module)?)?;
    module.add_function(wrap_pyfunction!(identify::identify, module)?)?;
    module.add_function(wrap_pyfunction!(case::run_case, module)?)?;
    module.add_function(wrap_pyfunction!(modes::modes, module)?)?;
    module.add_function(wrap_pyfunction!(report::report, module)?)?;
    module.add_function(wrap_pyfunction!(respond::respond, module)?)?;
    module.add_function(wrap_pyfunction!(series::series, module)?)?;
    module.add_function(wrap_pyfunction!(signal::frf, module)?)?;
    module.add_function(wrap_pyfunction!(modes::modes_of_arrays, module)?)?;
    module.add_function(wrap_pyfunction!(modes::modes_of_model, module)?)?;
    module.add_function(wrap_pyfunction!(verbs::check, module)?)?;
    module.add_function(wrap_pyfunction!(verbs::check_of_arrays, module)?)?;
    module.add_function(wrap_pyfunction!(verbs::sensitivities_of_model, module)?)?;
    module.add_function(wrap_pyfunction!(verbs::sensitivities, module)?)?;
    module.add_function(wrap_pyfunction!(verbs::fit, module)?)?;
    module.add_function(wrap_pyfunction!(verbs::export, module)?)?;
    module.add_function(wrap_pyfunction!(verbs::inspect, module)?)?;
    module.add_function(wrap_pyfunction!(verbs::natural_frequencies, module)?)?;
    module.add_function(wrap_pyfunction!(verbs::convert, module)?)?;
    module.add_function(wrap_pyfunction!(verbs::examples, module)?)?;
    module.add_function(wrap_pyfunction!(verbs::example, module)?)?;
    module.add_function(wrap_pyfunction!(verbs::respond_case, module)?)?;
    module.add_function(wrap_pyfunction!(verbs::frf_of_files, module)?)?;
    module.add_function(wrap_pyfunction!(uff::write_uff, module)?)
}
