//! Real files, where there are any.

#[path = "../../../formats/tests/outside/mod.rs"]
mod outside;

#[allow(unused_imports, reason = "each test uses a part")]
pub(crate) use outside::{python_with, shared};
