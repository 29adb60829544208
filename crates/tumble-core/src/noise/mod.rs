//! Noise of a sensor at rest: Allan variance and its relatives, with what they tell.
//!
//! The way: readings at a constant interval are summed up ([`Velocity`]); squared differences over averaging times give
//! the variances ([`variances`]); the slope at each time names the kind of noise ([`NoiseKind`]), which gives the degrees
//! of freedom and the band; a weighted fit with no negative coefficient gives Q, N, B, K and R.
//!
//! **Source** NIST SP 1065; IEEE Std 952 and 1554 for the names of the coefficients; metrology section 5.

mod all;
mod analysis;
mod cholesky;
mod covariance;
mod deviation;
mod differences;
mod edf;
mod filter;
mod interval;
mod kind;
mod likelihood;
mod model;
mod nonnegative;
mod octave;
mod record;
mod resampling;
mod steps;
mod stream;
mod subset;
mod velocity;
mod wide;

pub use all::all_factors;
pub use analysis::{
    BestDwell, ConverterFloor, NoiseAnalysis, NoiseCurve, NoiseOptions, NoisePoint, NoiseRemark,
    SHEET_UNITS, SheetUnit,
};
pub use covariance::AllanCovariance;
pub use deviation::{Deviation, Variance, octaves, variances};
pub use edf::{band, degrees_of_freedom, degrees_of_freedom_discrete};
pub use filter::unfiltered;
pub use kind::{KindSums, NoiseKind, kind_at};
pub use model::{Coefficient, Coefficients, NoiseFit, fit, intervals_hold};
pub use octave::allan_octaves;
pub use record::{MOST_FOR_ALL, MOST_IN_MEMORY, MOST_PIECES, NoiseError, NoiseRecord, Times};
pub use steps::{FIRST_READINGS, MOST_JITTER, QUIET_JITTER, Step, StepError, StepWatch};
pub use stream::{FULL_OVERLAP, Spacing, VarianceStream};
pub use velocity::Velocity;
