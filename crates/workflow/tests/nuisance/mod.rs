//! What disturbs real tests, planted and found: mains hum, masses of sensors, suspension, scales and delays of channels, windows.

mod attached;
mod check;
mod left_out;
mod planted;
mod scale;
mod window;
