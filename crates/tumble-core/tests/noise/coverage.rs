//! Records with known Q, N, B, K, R: found within the stated intervals.

use rand_core::SeedableRng;
use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64Mcg;
use tumble_core::noise::{Deviation, Velocity, fit, octaves, variances};

/// Readings with Q, N, K, R (B by a sum of Gauss–Markov processes, an octave each).
fn record(n: usize, dt: f64, truth: [f64; 5], seed: u64) -> Vec<f64> {
    let mut rng = Pcg64Mcg::seed_from_u64(seed);
    let mut normal = || -> f64 { StandardNormal.sample(&mut rng) };
    let [q, noise, b, k, r] = truth;
    let mut walk = 0.0;
    let mut last = q * normal();
    // 1/f by first-order processes with corner frequencies an octave apart: one-sided S = B²/(π f).
    let poles: Vec<f64> = (0..22).map(|j| 0.4 / dt / 2f64.powi(j)).collect();
    let mut states: Vec<f64> = poles.iter().map(|_| normal()).collect();
    let each = b * (core::f64::consts::LN_2 / core::f64::consts::PI).sqrt();
    (0..n)
        .map(|i| {
            walk += k * dt.sqrt() * normal();
            let now = q * normal();
            let mut y = noise / dt.sqrt() * normal() + walk + (now - last) / dt + r * i as f64 * dt;
            last = now;
            if b > 0.0 {
                for (s, f) in states.iter_mut().zip(&poles) {
                    let keep = (-core::f64::consts::TAU * f * dt).exp();
                    *s = keep * *s + (1.0 - keep * keep).sqrt() * normal();
                    y += each * *s;
                }
            }
            y
        })
        .collect()
}

#[test]
fn coefficients_lie_in_their_intervals() {
    let long = std::env::var_os("TUMBLE_LONG").is_some();
    let (n, dt) = (1 << 14, 0.02);
    let names = ["Q", "N", "B", "K", "R"];
    for (name, truth) in [
        ("N", [0.0, 1e-3, 0.0, 0.0, 0.0]),
        ("Q N", [4e-5, 1e-3, 0.0, 0.0, 0.0]),
        ("N K", [0.0, 1e-3, 0.0, 3e-4, 0.0]),
        ("N R", [0.0, 1e-3, 0.0, 0.0, 3e-5]),
        ("N B", [0.0, 1e-3, 6e-4, 0.0, 0.0]),
        ("Q N B K", [4e-5, 1e-3, 4e-4, 1e-4, 0.0]),
    ] {
        let runs = if long { 2000 } else { 100 };
        let mut inside = [0u32; 5];
        let mut zero = [0u32; 5];
        for seed in 0..runs {
            let v = Velocity::of(&record(n, dt, truth, seed + 1), dt).unwrap();
            let found = variances(&v, Deviation::Allan, &octaves(n));
            let f = fit(&found, dt, 0.95).unwrap();
            for i in 0..5 {
                let c = f.coefficients[i];
                inside[i] += u32::from(c.interval[0] <= truth[i] && truth[i] <= c.interval[1]);
                zero[i] += u32::from(c.value == 0.0);
            }
        }
        let share = |k: u32| 100.0 * f64::from(k) / runs as f64;
        let text: Vec<String> = (0..5)
            .map(|i| {
                format!("{} {:.1} % (zero {:.0} %)", names[i], share(inside[i]), share(zero[i]))
            })
            .collect();
        println!("{name}: {}", text.join(", "));
    }
}
