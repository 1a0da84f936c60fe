//! Pictures of good and of nasty data.

mod drawing;
mod nasty;
