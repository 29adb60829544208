//! The same coverage through the real estimator: covariances are estimates, runs of one plan share them.

use tumble_core::assess::pool;
use tumble_core::estimate::{EstimateOptions, Method, Parameter, Weights};
use tumble_core::simulate::{Truth, parse_plan};
use tumble_core::{Angle, Orientation};

use super::bench::{covers, find, fraction_se, quiet_table, runs};

/// Twelve positions a run: nine degrees of freedom for the covariance.
#[test]
fn estimated_covariances_keep_the_coverage() {
    let n = if super::long() { 5000 } else { 400 };
    let methods: &[Method] =
        if super::long() { &[Method::Exact, Method::Likelihood] } else { &[Method::Exact] };
    for method in methods {
        for (k, spread) in [(3, 0.0), (3, 1.0), (5, 0.0), (5, 1.0), (5, 3.0), (5, 10.0), (10, 1.0)]
        {
            let options = EstimateOptions {
                method: *method,
                weights: Weights::Equal,
                level: 0.95,
                ..EstimateOptions::default()
            };
            // u(Δa) of this plan and scatter, m/s².
            let u = 0.000_5;
            let mut covered = [0usize; 5];
            let mut tried = 0;
            for seed in 0..n {
                let truth = Truth {
                    runs: k + 1,
                    turn_on_m_s2: spread * u,
                    angles_deg: parse_plan("-60:60:12").unwrap(),
                    misalignment: Angle::from_rad(0.002),
                    seed: 800_000 + seed as u64,
                    ..quiet_table()
                };
                let mut all = runs(&truth, Orientation::Normal, &options);
                let Some(next) = all.pop().and_then(|r| r.estimate).and_then(|e| e.full()) else {
                    continue;
                };
                let pooled = pool(&all, 0.95);
                let bias = find(&pooled, Parameter::Bias);
                let truths = [truth.bias_m_s2, truth.misalignment.rad(), truth.scale_error];
                tried += 1;
                for p in Parameter::ALL {
                    covered[p.index()] += usize::from(covers(find(&pooled, p), truths[p.index()]));
                }
                let inside = |i: tumble_core::assess::Interval, v: f64| i.low <= v && v <= i.high;
                covered[3] += usize::from(inside(bias.prediction_interval.unwrap(), next[0]));
                let next_bias = tumble_core::simulate::simulate_run(&truth, k).bias_m_s2;
                covered[4] +=
                    usize::from(inside(bias.prediction_true_interval.unwrap(), next_bias));
            }
            let f = covered.map(|c| c as f64 / f64::from(tried));
            println!(
                "{method:?} k {k} spread {spread}: bias {:.4} misalignment {:.4} scale {:.4}, next estimate {:.4}, next true {:.4}",
                f[0], f[1], f[2], f[3], f[4]
            );
            let chance = 4.0 * fraction_se(0.95, n);
            assert!(f[..4].iter().all(|c| (c - 0.95).abs() < 0.01f64.max(chance)), "{f:?}");
            assert!(f[4] > 0.92 - chance, "{f:?}");
        }
    }
}
