//! The science of Tumble: calibration of accelerometers against gravity.
//!
//! The way of the data: codes → [`CodeHistogram`] (a dwell) → [`Position`] → [`Run`] → [`Experiment`] →
//! [`estimate::Estimate`] (a run) → [`assess::Assessment`] (findings, verdict, result).
//!
//! No I/O, no clock, no environment, no entropy: time, operator and seeds come in as arguments.

pub mod assess;
mod blocks;
pub mod combine;
mod compensator;
pub mod decision;
pub mod estimate;
mod experiment;
mod explanation;
mod finding;
mod first_look;
mod gravity;
mod histogram;
pub mod judge;
pub mod linalg;
pub mod noise;
mod nominal;
pub mod plan;
mod quantizer;
mod readings;
mod record;
mod sensor_type;
pub mod simulate;
pub mod stats;
mod stillness;
pub mod systematic;
pub mod term;
pub mod uncertainty;
mod units;

pub use blocks::BlockSums;
pub use compensator::{Compensated, Compensator};
pub use experiment::{
    Bench, DEFAULT_VERTICAL_LEAN_ARCMIN, Experiment, Orientation, Output, PairUse, Position, Run,
    Seat, Sensor, Targets, VerticalPair,
};
pub use explanation::Explanation;
pub use finding::{Finding, FindingKind, Severity};
pub use first_look::{DwellFacts, FirstLook, dwell_facts, first_look};
pub use gravity::{Gravity, GravitySource};
pub use histogram::CodeHistogram;
pub use nominal::{
    NominalScale, NominalScaleError, NominalScaleSource, nominal_scale, nominal_scale_from_means,
};
pub use quantizer::{Compensation, ConverterEnds, Nonlinearity, Quantizer, QuantizerOffset};
pub use readings::{Readings, ValueMoments, ValueOutOfRange};
pub use record::{Dial, Record, Timing};
pub use sensor_type::{LimitOf, Mark, SensitivityUnit, SensorMode, SensorType, TypeLimit};
pub use stillness::{settled_stretch, still_stretches};
pub use units::{ARCMIN_RAD, Angle, Code, STANDARD_GRAVITY_M_S2};
