//! What disturbs real tests, planted and found: mains hum, masses of sensors, suspension, scales and delays of channels, windows.

mod attached;
mod check;
mod left_out;
mod one_by_one;
mod planted;
mod scale;
mod window;
