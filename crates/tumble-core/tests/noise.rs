//! Allan variance and its relatives against NIST SP 1065, Stable32, and records whose noise is known.
#![allow(clippy::unwrap_used, clippy::print_stdout)] // A test that cannot unwrap has failed; figures are for people.

#[path = "noise/allan_reference.rs"]
mod allan_reference;
#[path = "noise/coverage.rs"]
mod coverage;
#[path = "noise/exact.rs"]
mod exact;
#[path = "noise/nbs14.rs"]
mod nbs14;
#[path = "noise/published_curves.rs"]
mod published_curves;
#[path = "noise/stable32.rs"]
mod stable32;
#[path = "noise/streams.rs"]
mod streams;
