//! Many runs on both cores, and what they come to.

use tumble_core::Position;
use tumble_core::estimate::{Estimate, EstimateOptions, Method, Parameter, Weights, estimate};

use crate::bench::Truth;

/// Whether the long tier was asked for.
pub fn long() -> bool {
    std::env::var_os("TUMBLE_LONG").is_some()
}

/// Runs of a study: the default tier's number, or the long tier's.
pub fn runs(default: usize, in_long: usize) -> usize {
    if long() { in_long } else { default }
}

/// Applies a function to every seed, in parallel; results come in the order of the seeds.
pub fn each<T: Send>(count: usize, f: impl Fn(u64) -> T + Sync) -> Vec<T> {
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let part = count.div_ceil(threads);
    std::thread::scope(|scope| {
        let handles: Vec<_> = (0..threads)
            .map(|t| {
                let f = &f;
                let range = t * part..((t + 1) * part).min(count);
                scope.spawn(move || range.map(|s| f(s as u64)).collect::<Vec<T>>())
            })
            .collect();
        handles.into_iter().flat_map(|h| h.join().unwrap()).collect()
    })
}

/// One estimate of simulated positions.
pub fn fit(
    truth: &Truth,
    positions: &[Position],
    method: Method,
    weights: Weights,
    level: f64,
) -> Estimate {
    let bench = truth.bench();
    let refs: Vec<&Position> = positions.iter().collect();
    let options = EstimateOptions { method, weights, level, ..EstimateOptions::default() };
    estimate(&refs, &truth.setting(&bench), &options).unwrap()
}

/// Estimate minus truth, a parameter each.
pub fn errors(truth: &Truth, e: &Estimate) -> [f64; 3] {
    let theta = truth.parameters();
    core::array::from_fn(|i| e.values[i].unwrap() - theta[i])
}

/// Bias in LSB, misalignment in mrad, scale error in 1e-6.
pub fn in_print(truth: &Truth, errors: [f64; 3]) -> [f64; 3] {
    [errors[0] / truth.scale(), errors[1] * 1e3, errors[2] * 1e6]
}

pub fn names() -> [&'static str; 3] {
    Parameter::ALL.map(Parameter::words)
}

/// Root mean square over runs, a parameter each.
pub fn rms(all: &[[f64; 3]]) -> [f64; 3] {
    core::array::from_fn(|i| {
        (all.iter().map(|e| e[i] * e[i]).sum::<f64>() / all.len() as f64).sqrt()
    })
}

/// Ratio of two root mean squares over the same runs, with its standard error (delta method on the pairs).
pub fn paired_ratio(ours: &[[f64; 3]], theirs: &[[f64; 3]], i: usize) -> (f64, f64) {
    let n = ours.len() as f64;
    let a: f64 = ours.iter().map(|e| e[i] * e[i]).sum::<f64>() / n;
    let b: f64 = theirs.iter().map(|e| e[i] * e[i]).sum::<f64>() / n;
    let square = a / b;
    let spread: f64 = ours
        .iter()
        .zip(theirs)
        .map(|(x, y)| ((x[i] * x[i] - square * y[i] * y[i]) / b).powi(2))
        .sum::<f64>()
        / n;
    let ratio = square.sqrt();
    (ratio, (spread / n).sqrt() / (2.0 * ratio))
}

/// Standard error of a fraction.
pub fn fraction_se(p: f64, n: usize) -> f64 {
    (p * (1.0 - p) / n as f64).sqrt()
}
