//! Time of one fit of the likelihood after reading, on one core: `cargo run --release -p tumble-core --example fit_time`.
//!
//! Prints CSV: what was varied, its value, positions, samples a dwell, noise (LSB), milliseconds (median of runs with
//! different seeds). `benches/likelihood_vs_peers.py` runs it beside its peers and draws the plot.
#![allow(clippy::print_stdout)]

use std::time::Instant;

use tumble_core::Position;
use tumble_core::estimate::{EstimateOptions, Method, Setting, estimate};
use tumble_core::simulate::{Preset, Truth, experiment, parse_plan};

/// Median time of a fit, ms, over runs of the same bench.
fn median_ms(truth: &Truth, method: Method, fits: u64) -> Result<f64, Box<dyn std::error::Error>> {
    let mut times = Vec::new();
    for seed in 1..=fits {
        let e = experiment(&Truth { seed, runs: 1, ..truth.clone() });
        let setting = Setting {
            bench: &e.bench,
            quantizer: e.output.quantizer,
            ends: e.output.ends,
            nominal_scale_m_s2_per_lsb: truth.nominal_scale_m_s2_per_lsb,
        };
        let positions: Vec<&Position> = e.runs.iter().flat_map(|r| r.positions.iter()).collect();
        let options = EstimateOptions { method, ..EstimateOptions::default() };
        let start = Instant::now();
        estimate(&positions, &setting, &options)?;
        times.push(start.elapsed().as_secs_f64() * 1e3);
    }
    times.sort_by(f64::total_cmp);
    Ok(times[times.len() / 2])
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let paper = Preset::Paper3.truth();
    let with_noise = |sigma: f64| Truth {
        noise_m_s2: sigma * paper.nominal_scale_m_s2_per_lsb,
        ..paper.clone()
    };
    let plan = |n: usize| parse_plan(&format!("-60:60:{n}"));
    println!("varied,value,positions,samples,sigma_lsb,ms");
    for sigma in [0.02, 0.1, 0.3, 1.25, 5.0] {
        let ms = median_ms(&with_noise(sigma), Method::Likelihood, 31)?;
        println!("noise,{sigma},60,1500,{sigma},{ms:.4}");
    }
    println!("exact,1.25,60,1500,1.25,{:.4}", median_ms(&with_noise(1.25), Method::Exact, 31)?);
    for sigma in [0.1, 1.25] {
        for positions in [12, 30, 60, 120, 240, 480, 960] {
            let truth = Truth { angles_deg: plan(positions)?, ..with_noise(sigma) };
            let ms = median_ms(&truth, Method::Likelihood, 7)?;
            println!("positions,{positions},{positions},1500,{sigma},{ms:.4}");
        }
        for samples in [150, 500, 1500, 5000, 15_000] {
            let truth = Truth { dwell_s: f64::from(samples) / paper.rate_hz, ..with_noise(sigma) };
            let ms = median_ms(&truth, Method::Likelihood, 7)?;
            println!("samples,{samples},60,{samples},{sigma},{ms:.4}");
        }
    }
    // A hundred thousand positions of few samples: memory and time stay in proportion.
    let long =
        Truth { angles_deg: plan(100_000)?, dwell_s: 20.0 / paper.rate_hz, ..with_noise(1.25) };
    println!("positions,100000,100000,20,1.25,{:.4}", median_ms(&long, Method::Likelihood, 1)?);
    Ok(())
}
