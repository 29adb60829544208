//! cov
#![allow(missing_docs, clippy::all, clippy::unwrap_used, clippy::print_stdout)]
use rand_core::SeedableRng;
use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64Mcg;
use tumble_core::noise::*;
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

fn chol(c: &Vec<Vec<f64>>, floor: f64) -> (Vec<Vec<f64>>, f64) {
    let n = c.len(); let mut l = vec![vec![0.0; n]; n]; let mut least = 1.0f64;
    for j in 0..n {
        let mut d = c[j][j]; for k in 0..j { d -= l[j][k] * l[j][k]; }
        least = least.min(d / c[j][j]);
        l[j][j] = d.max(floor * c[j][j]).sqrt();
        for i in j + 1..n { let mut s = c[i][j]; for k in 0..j { s -= l[i][k] * l[j][k]; } l[i][j] = s / l[j][j]; }
    }
    (l, least)
}
fn main() {
    for truth in [[0.0, 1e-3, 0.0, 0.0, 0.0], [0.0, 1e-3, 0.0, 0.0, 3e-5], [0.0, 1e-3, 0.0, 1e-4, 3e-5], [0.0, 1e-3, 6e-4, 0.0, 3e-5], [4e-5, 1e-3, 4e-4, 1e-4, 3e-5],[0.0, 1e-3, 6e-4, 0.0, 0.0], [0.0, 1e-3, 0.0, 3e-4, 0.0]] {
    let n = 1 << 14;
    let all: Vec<Vec<Variance>> = (0..1000u64).map(|k| variances(&Velocity::of(&record(n, 0.02, truth, 777 + k), 0.02).unwrap(), Deviation::Allan, &octaves(n))).collect();
    let c = Coefficients { q2: truth[0].powi(2), n2: truth[1].powi(2), b2: truth[2].powi(2), k2: truth[3].powi(2), r2: truth[4].powi(2) };
    let cov = AllanCovariance::of(&all[0], 0.02).at(&c);
    let p = all[0].len();
    let m: Vec<Vec<f64>> = (0..p).map(|i| (0..p).map(|j| cov[(i, j)]).collect()).collect();
    let (l, least) = chol(&m, 1e-12);
    let (l3, _) = chol(&m, 1e-3);
    let white = |l: &Vec<Vec<f64>>, v: &Vec<Variance>| -> Vec<f64> { let mut o: Vec<f64> = v.iter().map(|v| v.variance - c.variance(v.tau_s)).collect();
        for i in 0..p { for k in 0..i { let x = o[k]; o[i] -= l[i][k] * x; } o[i] /= l[i][i]; } o };
    println!("{truth:?} least {least:.2e}");
    for l in [&l, &l3] { let w: Vec<Vec<f64>> = all.iter().map(|v| white(l, v)).collect();
      for i in 0..p { print!("{:.2} ", w.iter().map(|w| w[i] * w[i]).sum::<f64>() / w.len() as f64); } println!(); }
    }
}
