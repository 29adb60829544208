//! Propagation and Monte Carlo against examples that others published.
//!
//! Inputs and answers are those of `gum_calibration` in the measured data (GUM H.1, H.2, H.3, H.5, GUM-S1 9.2, NIST TN
//! 1900 E13, ISO/TS 28037 …); tolerances are half of the last printed digit.
#![allow(clippy::unwrap_used, clippy::print_stdout)] // A test that cannot unwrap has failed; figures are for people.

#[path = "uncertainty/gum.rs"]
mod gum;
#[path = "uncertainty/lines.rs"]
mod lines;
#[path = "uncertainty/monte_carlo.rs"]
mod monte_carlo;

/// Agrees to so many printed units of the last digit's half.
#[track_caller]
fn printed(got: f64, published: f64, last_digit: f64) {
    println!("{got} ({published})");
    assert!((got - published).abs() <= 0.501 * last_digit, "{got} is not {published}");
}
