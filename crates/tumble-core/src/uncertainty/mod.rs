//! Uncertainty of measurement: propagation (JCGM 100, 102) and Monte Carlo (JCGM 101), for any model.
//!
//! A [`Model`] is one formula; [`Measurement`] joins it with what is known of its inputs.

mod distribution;
mod measurement;
mod monte_carlo;
mod quantiles;
mod scalar;

pub use distribution::Distribution;
pub use measurement::{Input, Measurement, Model, Output, Propagation};
pub use monte_carlo::{MonteCarlo, MonteCarloOptions, MonteCarloOutput, Validation};
pub use scalar::{Jet, Scalar};
