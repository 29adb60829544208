//! Data hygiene: planted faults are named with their place, honest data are left in peace. Seeds are fixed;
//! TUMBLE_LONG=1 runs more.
#![allow(clippy::unwrap_used, clippy::print_stdout)] // A test that cannot unwrap has failed; figures are for people.

#[path = "hygiene/angles.rs"]
mod angles;
#[path = "hygiene/bench.rs"]
mod bench;
#[path = "hygiene/codes.rs"]
mod codes;
#[path = "hygiene/detection.rs"]
mod detection;
#[path = "hygiene/honest.rs"]
mod honest;
#[path = "hygiene/record.rs"]
mod record;
