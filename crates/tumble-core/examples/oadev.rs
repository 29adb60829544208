//! Time of the overlapping Allan deviation at octaves, one core, beside a summing pass and a prefix sum.
//!
//! `cargo run --release -p tumble-core --example oadev -- 10000000`; `benches/noise` runs it beside a peer.
#![allow(clippy::print_stdout)] // It is there to print.

use std::hint::black_box;
use std::time::Instant;

use tumble_core::noise::{Deviation, VarianceStream, Velocity, allan_octaves, octaves, variances};

fn main() {
    let n: usize = std::env::args().nth(1).and_then(|a| a.parse().ok()).unwrap_or(10_000_000);
    let mut state = 1_234_567_890u64;
    let readings: Vec<f64> = (0..n)
        .map(|_| {
            state = 16_807 * state % 2_147_483_647;
            state as f64 / 2_147_483_647.0
        })
        .collect();
    for round in 0..3 {
        let start = Instant::now();
        black_box(black_box(&readings).iter().sum::<f64>());
        let sum = start.elapsed();
        let start = Instant::now();
        let velocity = Velocity::of(black_box(&readings), 1.0);
        let prefix = start.elapsed();
        let Some(velocity) = velocity else { return };
        let found = black_box(variances(&velocity, Deviation::Allan, &octaves(n)));
        let whole = start.elapsed();
        let start = Instant::now();
        let direct = black_box(allan_octaves(black_box(&readings), 1.0));
        let at_octaves = start.elapsed();
        for (a, b) in direct.iter().zip(&found) {
            assert!(
                (a.variance / b.variance - 1.0).abs() < 1e-9 && a.terms == b.terms,
                "{a:?} {b:?}"
            );
        }
        let start = Instant::now();
        let mut stream = VarianceStream::new(Deviation::Allan, 1.0);
        readings.chunks(1 << 16).for_each(|c| stream.push(c));
        let streamed = black_box(stream.finish());
        let bounded = start.elapsed();
        let seconds = [sum, prefix, whole, at_octaves, bounded].map(|d| d.as_secs_f64());
        println!(
            "round {round}: sum {:.4}, prefix {:.4}, velocity {:.4}, octaves {:.4}, stream {:.4} s, {} octaves, first {:.10e}, last {:.10e}",
            seconds[0],
            seconds[1],
            seconds[2],
            seconds[3],
            seconds[4],
            direct.len(),
            direct.first().map_or(0.0, |v| v.variance.sqrt()),
            direct.last().map_or(0.0, |v| v.variance.sqrt()),
        );
        black_box(&streamed);
    }
}
