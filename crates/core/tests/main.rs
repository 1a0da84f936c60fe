//! The method against independent answers: closed forms, direct solves, exact arithmetic.

mod band;
mod band_laws;
mod calibration;
mod common;
mod dense;
mod diagnostics;
mod inertia;
mod kept_model;
mod laws;
mod mixed;
mod modal;
mod model_errors;
mod noise;
#[path = "../../formats/tests/outside/mod.rs"]
mod outside;
mod paper;
mod poles;
mod problem;
mod rational;
mod select;
mod sensitivity;
mod series;
mod several;
mod several_channels;
mod shared_data;
mod shared_model;
mod signal;
mod smooth;
mod subspace;
mod tier;
mod uncertainty;
mod window;
