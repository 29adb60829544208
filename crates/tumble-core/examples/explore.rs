//! explore
#![allow(missing_docs, clippy::all, clippy::unwrap_used, clippy::print_stdout)]
use rand_core::SeedableRng;
use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64Mcg;
use tumble_core::noise::{Deviation, Velocity, explore, octaves, variances};
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
fn main() {
    let a: Vec<String> = std::env::args().collect();
    let n: usize = 1 << a[1].parse::<usize>().unwrap();
    let records: u64 = a[2].parse().unwrap();
    let base: u64 = a[3].parse().unwrap();
    let rounds: usize = a[4].parse().unwrap();
    let only = a.get(5).map(|s| s.as_str()).unwrap_or("");
    let cases: [(&str, [f64; 5]); 10] = [
        ("N", [0.0, 1e-3, 0.0, 0.0, 0.0]),
        ("QN", [4e-5, 1e-3, 0.0, 0.0, 0.0]),
        ("NK", [0.0, 1e-3, 0.0, 3e-4, 0.0]),
        ("NR", [0.0, 1e-3, 0.0, 0.0, 3e-5]),
        ("NB", [0.0, 1e-3, 6e-4, 0.0, 0.0]),
        ("QNBK", [4e-5, 1e-3, 4e-4, 1e-4, 0.0]),
        ("NBK", [0.0, 1e-3, 6e-4, 1e-4, 0.0]),
        ("NKR", [0.0, 1e-3, 0.0, 1e-4, 3e-5]),
        ("NBR", [0.0, 1e-3, 6e-4, 0.0, 3e-5]),
        ("QNBKR", [4e-5, 1e-3, 4e-4, 1e-4, 3e-5]),
    ];
    for (name, truth) in cases {
        if !only.is_empty() && !only.split(',').any(|o| o == name) { continue; }
        let start = std::time::Instant::now();
        let parts: Vec<Vec<[[f64; 2]; 5]>> = std::thread::scope(|s| {
            let h: Vec<_> = (0..2u64).map(|t| s.spawn(move || {
                (0..records).filter(|k| k % 2 == t).map(|k| {
                    let y = record(n, 0.02, truth, base + k);
                    let v = variances(&Velocity::of(&y, 0.02).unwrap(), Deviation::Allan, &octaves(n));
                    if rounds == 0 {
                        let f = tumble_core::noise::fit(&v, 0.02, 0.95).unwrap();
                        core::array::from_fn(|i| { let [l, h] = f.coefficients[i].interval; [if truth[i] > h { 0.0 } else { 1.0 }, if truth[i] < l { 0.0 } else { 1.0 }] })
                    } else { explore(&v, 0.02, truth).unwrap() }
                }).collect::<Vec<_>>()
            })).collect();
            h.into_iter().map(|h| h.join().unwrap()).collect()
        });
        let all: Vec<_> = parts.concat();
        print!("2^{} {name:6}", a[1]);
        for i in (0..5).filter(|i| truth[*i] > 0.0) {
            let f = |c: &dyn Fn(&[f64; 2]) -> bool| 100.0 * all.iter().filter(|r| c(&r[i])).count() as f64 / all.len() as f64;
            let none = all.iter().filter(|r| r[i][0] > 8.0).count(); if none > 0 { print!(" [{none} none]"); }
            print!(" {} {:.2} (below {:.2} above {:.2})", ["Q","N","B","K","R"][i],
                f(&|p| p[0] > 0.025 && p[1] > 0.025), f(&|p| p[0] <= 0.025), f(&|p| p[1] <= 0.025));
        }
        if std::env::var_os("SHOW").is_some() { for r in all.iter().take(30) { println!("{:?}", r[4]); } }
        println!("  {:.1} s", start.elapsed().as_secs_f64());
    }
}
