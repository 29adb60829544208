//! Runs together: other programs' answers, coverage by simulation, mountings, reversal, a shared pair. Seeds are fixed;
//! `TUMBLE_LONG=1` runs more, and the studies through the real estimator.
#![allow(clippy::unwrap_used, clippy::print_stdout)] // A test that cannot unwrap has failed; figures are for people.

#[path = "combine/answers.rs"]
mod answers;
#[path = "combine/bench.rs"]
mod bench;
#[path = "combine/coverage.rs"]
mod coverage;
#[path = "combine/oracle.rs"]
mod oracle;
#[path = "combine/pair.rs"]
mod pair;
#[path = "combine/reversal.rs"]
mod reversal;
#[path = "combine/sizes.rs"]
mod sizes;
#[path = "combine/study.rs"]
mod study;

fn long() -> bool {
    std::env::var_os("TUMBLE_LONG").is_some()
}
