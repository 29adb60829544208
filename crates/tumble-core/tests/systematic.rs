//! What systematic errors do to the parameters: derivatives against re-fits of perturbed data, and the figures of the
//! method's section 10.
#![allow(clippy::unwrap_used, clippy::print_stdout)] // A test that cannot unwrap has failed; figures are for people.

#[path = "systematic/bench.rs"]
mod bench;
#[path = "systematic/figures.rs"]
mod figures;
#[path = "systematic/refits.rs"]
mod refits;
