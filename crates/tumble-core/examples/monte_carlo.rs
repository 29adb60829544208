//! Time of Monte Carlo draws of a whole budget: fourteen inputs, four outputs, both coverage intervals.
//!
//! `cargo run --release -p tumble-core --example monte_carlo -- 1000000 2`: draws, threads. `benches/monte_carlo_vs_numpy.py`
//! runs it beside the same draws in numpy.
#![allow(clippy::print_stdout)] // It is there to print.

use std::time::Instant;

use tumble_core::uncertainty::{
    Distribution, Input, Measurement, Model, MonteCarloOptions, Scalar,
};

/// Bias, misalignment, scale error and scale factor: three correlated statistical parts, gravity, scale and eccentricity of the
/// dial, tilt and lean (their product and their squares), converter, K2, K3, temperature.
struct Budget;

/// Sensitivities of the 60-position plan over ±65°, SI units.
const S: [[f64; 3]; 8] = [
    [0.0, 0.0, 0.737],
    [0.0, 0.0, 0.65],
    [-5.1, 0.83, 0.0],
    [1.6e-3, 1.1e-5, 0.0],
    [2.0e-5, 0.0, 3.0e-5],
    [-71.0, 9.5, 0.0],
    [0.0, 0.0, 61.0],
    [0.5, 0.01, 1.0],
];

impl Model<14, 4> for Budget {
    #[inline]
    fn evaluate<T: Scalar>(&self, x: &[T; 14]) -> [T; 4] {
        let c = T::constant;
        let [bias, misalignment, scale, gravity, psi, eta, ..] = *x;
        let mut linear = [bias, misalignment, scale];
        for (s, x) in S.iter().zip(&x[6..]) {
            for (y, s) in linear.iter_mut().zip(s) {
                *y = *y + c(*s) * *x;
            }
        }
        let relative = gravity * c(1.0 / 9.81);
        let squares = (psi.square() + eta.square()) * c(0.5);
        let scale_error = (c(1.0) + linear[2] - squares) * relative - c(1.0);
        let bias = (linear[0] + c(9.81) * psi * eta) * relative;
        [bias, linear[1], scale_error, (c(1.0) + scale_error) * c(0.007_69)]
    }
}

fn main() {
    let mut args = std::env::args().skip(1);
    let draws: usize = args.next().and_then(|a| a.parse().ok()).unwrap_or(1_000_000);
    let threads: usize = args.next().and_then(|a| a.parse().ok()).unwrap_or(2);
    let student = |x, u| Input::new(x, Distribution::Student { u, dof: 57.0 });
    let normal = |u| Input::new(0.0, Distribution::Normal { u });
    let rectangular = |half_width| Input::new(0.0, Distribution::Rectangular { half_width });
    let measurement = Measurement {
        inputs: [
            student(-0.0063, 9e-4),
            student(0.002, 1.1e-4),
            student(0.001, 3.5e-5),
            Input::new(9.81, Distribution::Rectangular { half_width: 5e-4 }),
            normal(8.7e-3),
            normal(8.7e-3),
            normal(7.7e-4),
            normal(6.2e-4),
            normal(6.2e-4),
            Input::new(0.0, Distribution::UShaped { half_width: 0.3 }),
            rectangular(0.2),
            normal(1e-5),
            normal(1e-6),
            rectangular(1e-3),
        ],
        correlations: vec![(0, 1, -0.975), (0, 2, 0.0), (1, 2, 0.0)],
        model: Budget,
    };
    for _ in 0..3 {
        let options = MonteCarloOptions {
            fewest_draws: draws,
            most_draws: draws,
            threads,
            ..MonteCarloOptions::default()
        };
        let start = Instant::now();
        let mc = measurement.draw::<4>(0.95, &options);
        let seconds = start.elapsed().as_secs_f64();
        let y = mc.outputs[0];
        println!(
            "{} draws, {threads} threads: {seconds:.4} s; bias u {:.6} m/s2, 95 % [{:.5}, {:.5}]",
            mc.draws, y.standard_uncertainty, y.symmetric.low, y.symmetric.high
        );
    }
}
