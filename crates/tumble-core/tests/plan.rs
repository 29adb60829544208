//! Plans: distance to the best possible, against the paper's, predictions against simulation.
#![allow(clippy::unwrap_used)] // A test that cannot unwrap has failed.
#![allow(clippy::print_stdout)] // Figures that a reader of the test wants to see.

#[path = "plan/benches.rs"]
mod benches;
#[path = "plan/certified.rs"]
mod certified;
#[path = "plan/quality.rs"]
mod quality;
#[path = "plan/simulated.rs"]
mod simulated;
