//! From a case file to results.

mod beam;
mod case;
mod convert;
mod dense;
mod export;
mod hammer;
mod inspect;
mod labels;
#[path = "../../core/tests/noise/mod.rs"]
mod noise;
mod nuisance;
#[path = "../../formats/tests/outside/mod.rs"]
mod outside;
#[path = "../../figures/tests/picture/mod.rs"]
mod picture;
mod sensitivities;
mod shared_data;
mod thickness;
#[path = "../../core/tests/tier/mod.rs"]
mod tier;
mod units;
