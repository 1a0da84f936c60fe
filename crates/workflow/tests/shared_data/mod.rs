//! Real files, where there are any.

use std::path::PathBuf;

/// A file or folder of the data for tests; `None` and a word where there is none.
#[expect(clippy::print_stdout, reason = "a test that is skipped says so")]
pub(crate) fn shared(name: &str) -> Option<PathBuf> {
    let beside = concat!(env!("CARGO_MANIFEST_DIR"), "/../../../shared/data");
    let path = PathBuf::from(std::env::var("FRFIT_DATA").unwrap_or_else(|_| beside.into())).join(name);
    if !path.exists() {
        println!("skipped: no {} (set FRFIT_DATA)", path.display());
        return None;
    }
    Some(path)
}
