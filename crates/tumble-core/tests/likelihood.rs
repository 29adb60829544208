//! Statistical claims of the two-level likelihood, checked by simulation with a known truth. Seeds are fixed.
//!
//! `TUMBLE_LONG=1` runs the numbers that the documents print; `TUMBLE_STUDY=folder` writes the table of coverages.
#![allow(clippy::unwrap_used, clippy::print_stdout)] // A test that cannot unwrap has failed; figures are for people.

#[path = "likelihood/bench.rs"]
mod bench;
#[path = "likelihood/bound.rs"]
mod bound;
#[path = "likelihood/coverage.rs"]
mod coverage;
#[path = "likelihood/efficiency.rs"]
mod efficiency;
#[path = "likelihood/gain.rs"]
mod gain;
#[path = "likelihood/range.rs"]
mod range;
#[path = "likelihood/study.rs"]
mod study;
#[path = "likelihood/terms.rs"]
mod terms;
