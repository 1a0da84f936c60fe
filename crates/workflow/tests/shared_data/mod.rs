//! Real files, where there are any.

#[path = "../../../formats/tests/outside/mod.rs"]
mod outside;

pub(crate) use outside::shared;
