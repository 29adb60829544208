//! A bench with a known truth: what a sensor on a hand-turned table would have recorded.
//!
//! The same truth and seed give the same codes, on every machine that has IEEE 754 arithmetic and the same
//! sine to the last bit.

mod generator;
mod plan;
mod preset;
mod truth;

pub use generator::{
    SimulatedPosition, SimulatedRun, experiment, readings, run_bias_m_s2, simulate_run,
    simulate_vertical,
};
pub use plan::{PlanError, parse_plan};
pub use preset::Preset;
pub use truth::{Truth, TruthError};
