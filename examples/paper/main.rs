//! The paper's headline, "from 0.9 to 0.2 LSB", from its own bench simulated: `cargo run --release --example paper`.
//!
//! Error levels by method section 12: root mean square of the positions' means, before compensation, and after it
//! with the passport of the other runs. Twenty seeds a row, mean ± standard deviation over the seeds.
#![allow(clippy::print_stdout)]

use tumble_core::Angle;
use tumble_core::assess::assess;
use tumble_core::estimate::EstimateOptions;
use tumble_core::simulate::{Preset, Truth, experiment};
use tumble_core::stats::{mean, sample_std};

const SEEDS: u64 = 20;

fn row(name: &str, truth: &Truth) -> Result<String, Box<dyn std::error::Error>> {
    let (mut before, mut after) = (Vec::new(), Vec::new());
    for seed in 1..=SEEDS {
        let simulated = experiment(&Truth { seed, ..truth.clone() });
        let level = assess(&simulated, &EstimateOptions::default())?.error_level;
        let level = level.ok_or("no error level")?;
        before.push(level.before_lsb);
        after.push(level.after_held_out_lsb.ok_or("no held-out level")?);
    }
    let figure = |values: &[f64]| {
        let (m, s) = mean(values).zip(sample_std(values)).unwrap_or_default();
        format!("{m:7.2} ± {s:4.2}")
    };
    Ok(format!("{name:<48} {} -> {}", figure(&before), figure(&after)))
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let three = Preset::Paper3.truth();
    let in_m_s2 = |p: Preset| Truth { bias_m_s2: p.printed_errors().0, ..p.truth() };
    println!("{:<48} {:>14}    {:>14}", "error level, LSB (20 seeds)", "before", "after");
    println!("{}", row("sensor 3, bias -0.82 LSB, 0.55' (the headline)", &three)?);
    println!("{}", row("sensor 3, bias read as -0.82 m/s2", &in_m_s2(Preset::Paper3))?);
    println!("{}", row("sensor 1, bias 0.08 LSB", &Preset::Paper1.truth())?);
    println!("{}", row("sensor 2, bias 0.37 LSB", &Preset::Paper2.truth())?);
    let coarse = Truth { setting_scatter: Angle::from_arcmin(3.0), ..three };
    println!("{}", row("sensor 3 with 3' of setting scatter", &coarse)?);
    Ok(())
}
