//! The page that is made of results.

mod made;
mod page;
mod several;
#[path = "../../core/tests/tier/mod.rs"]
mod tier;
