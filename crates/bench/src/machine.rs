//! On what the times were taken.

use std::fs::read_to_string;
use std::thread::available_parallelism;

/// Model of the processor and number of cores, as far as the system reports them.
pub fn machine() -> String {
    let info = read_to_string("/proc/cpuinfo").unwrap_or_default();
    let model =
        info.lines().find(|line| line.starts_with("model name")).and_then(|line| line.split_once(": "));
    let cores = available_parallelism().map_or_else(|_| "unknown".to_owned(), |cores| cores.to_string());
    format!("processor: {}; cores: {cores}", model.map_or("unknown", |(_, name)| name))
}
