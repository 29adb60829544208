//! Time and memory of a long record through `VarianceStream`, overlapping Allan, octaves.
//!
//! `cargo run --release -p tumble-core --example long_record -- 1000000000`
#![allow(clippy::print_stdout)] // It is there to print.

use std::hint::black_box;
use std::time::Instant;

use tumble_core::noise::{Deviation, VarianceStream};

/// Codes about 30 000 with noise of 1 LSB: eight uniform numbers of eight bits (xorshift64*).
fn fill(state: &mut u64, readings: &mut [f64]) {
    for y in readings {
        *state ^= *state >> 12;
        *state ^= *state << 25;
        *state ^= *state >> 27;
        let bytes = state.wrapping_mul(0x2545_f491_4f6c_dd1d).to_be_bytes();
        let sum: u32 = bytes.iter().map(|b| u32::from(*b)).sum();
        *y = (30_000.0 + (f64::from(sum) - 1020.0) / 209.021_689).round();
    }
}

/// Peak of the memory of this process, where the system tells.
fn peak() -> String {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|l| l.strip_prefix("VmHWM:"));
    line.map_or("not known".into(), |l| l.trim().to_owned())
}

fn main() {
    let n: u64 = std::env::args().nth(1).and_then(|a| a.parse().ok()).unwrap_or(1_000_000_000);
    let mut batch = vec![0.0; 1 << 14];
    let mut state = 88_172_645_463_325_252;
    let start = Instant::now();
    for _ in 0..n / batch.len() as u64 {
        fill(&mut state, &mut batch);
        black_box(&batch);
    }
    let made = start.elapsed();
    let start = Instant::now();
    let mut stream = VarianceStream::new(Deviation::Allan, 1.0);
    for _ in 0..n / batch.len() as u64 {
        fill(&mut state, &mut batch);
        stream.push(&batch);
    }
    let readings = stream.readings();
    let found = stream.finish();
    let whole = start.elapsed();
    println!(
        "{readings} readings, {} octaves: {:.1} s, of which the readings take {:.1} s; peak memory {}",
        found.len(),
        whole.as_secs_f64(),
        made.as_secs_f64(),
        peak()
    );
    for (v, kind) in &found {
        println!("{:>12} {:.6e} {kind:?}", v.factor, v.variance.sqrt());
    }
}
