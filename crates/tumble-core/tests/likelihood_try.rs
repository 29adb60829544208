//! trial
#![allow(warnings)]
#[path = "likelihood/bench.rs"]
mod bench;
use bench::*;
use tumble_core::estimate::*;
use tumble_core::{Position, Quantizer};

#[derive(Clone, Default)]
struct Acc {
    n: usize,
    se: [[f64; 3]; 4],
    cov: [[usize; 3]; 3],
    covt: [usize; 3],
    width: [f64; 3],
    u2: [f64; 3],
    dof: [f64; 3],
    sig: f64,
    tau: [f64; 3],
    t: f64,
    te: f64,
    fail: usize,
    split: usize,
}

fn study(name: &str, t: &Truth, n: usize, w: Weights) {
    let bench = t.bench();
    let set = setting(t, &bench);
    let k = t.nominal * (1.0 + t.scale_error);
    let work = |from: usize, to: usize| {
        let mut a = Acc::default();
        for s in from..to {
            let t = t.dithered(s as u64);
            let truth = t.parameters();
            let run = t.run(s as u64 + 1);
            let refs: Vec<&Position> = run.iter().collect();
            let c = std::time::Instant::now();
            let e = estimate(
                &refs,
                &set,
                &EstimateOptions { method: Method::Exact, weights: Weights::Equal, level: 0.95 },
            )
            .unwrap();
            a.te += c.elapsed().as_secs_f64();
            let ea = estimate(
                &refs,
                &set,
                &EstimateOptions { method: Method::Exact, weights: Weights::Angle, level: 0.95 },
            )
            .unwrap();
            let c = std::time::Instant::now();
            let l = match estimate(
                &refs,
                &set,
                &EstimateOptions { method: Method::Likelihood, weights: w, level: 0.95 },
            ) {
                Ok(l) => l,
                Err(x) => {
                    a.fail += 1;
                    if a.fail < 3 {
                        println!("FAIL seed {s} {x}");
                    }
                    continue;
                }
            };
            a.t += c.elapsed().as_secs_f64();
            a.n += 1;
            for p in Parameter::ALL {
                let i = p.index();
                a.se[0][i] += (e.values[i].unwrap() - truth[i]).powi(2);
                a.se[1][i] += (ea.values[i].unwrap() - truth[i]).powi(2);
                a.se[2][i] += (l.values[i].unwrap() - truth[i]).powi(2);
                a.se[3][i] += l.values[i].unwrap() - truth[i];
                a.u2[i] += l.standard_uncertainty(p).unwrap().powi(2);
                a.dof[i] += 1.0 / l.effective_dof[i];
                for (q, lev) in [0.68, 0.95, 0.99].iter().enumerate() {
                    let [lo, hi] = if q == 1 {
                        l.interval(p, *lev).unwrap()
                    } else {
                        let h = l.coverage_factor(p, *lev).unwrap()
                            * l.standard_uncertainty(p).unwrap();
                        [l.values[i].unwrap() - h, l.values[i].unwrap() + h]
                    };
                    if q == 1 {
                        let h = l.coverage_factor(p, *lev).unwrap()
                            * l.standard_uncertainty(p).unwrap();
                        a.covt[i] += usize::from((l.values[i].unwrap() - truth[i]).abs() <= h);
                        a.width[i] += (hi - lo) / (2.0 * h);
                    }

                    a.cov[q][i] += usize::from(lo <= truth[i] && truth[i] <= hi);
                }
            }
            let sc = l.scatter.unwrap();
            a.sig += sc.noise_lsb.value;
            a.tau[0] += sc.level_lsb.value;
            a.tau[1] += sc.angle_rad.value;
            a.tau[2] += sc.total_lsb.value;
            a.split += usize::from(matches!(sc.split, Split::Determined { .. }));
        }
        a
    };
    let (x, y) = std::thread::scope(|s| {
        let h = s.spawn(|| work(0, n / 2));
        let y = work(n / 2, n);
        (h.join().unwrap(), y)
    });
    let nn = (x.n + y.n) as f64;
    let rms = |m: usize, i: usize| ((x.se[m][i] + y.se[m][i]) / nn).sqrt();
    println!(
        "{name}: n {} fail {} | sigma {:.4} tau0 {:.4} tauphi' {:.3} total {:.4} split {:.2} | {:.3} ms (exact {:.3})",
        x.n + y.n,
        x.fail + y.fail,
        (x.sig + y.sig) / nn,
        (x.tau[0] + y.tau[0]) / nn,
        (x.tau[1] + y.tau[1]) / nn / ARCMIN,
        (x.tau[2] + y.tau[2]) / nn,
        (x.split + y.split) as f64 / nn,
        (x.t + y.t) / nn * 1e3,
        (x.te + y.te) / nn * 1e3
    );
    for i in 0..3 {
        let unit = [k, 1e-3, 1e-6][i];
        println!(
            "   {:>5} rms: equal {:.4} angle {:.4} likelihood {:.4} bias {:+.4} | u/actual {:.3} dof {:.1} | cover {:.3} {:.4} {:.4} t95 {:.4} width {:.3}",
            ["bias", "mis", "scale"][i],
            rms(0, i) / unit,
            rms(1, i) / unit,
            rms(2, i) / unit,
            (x.se[3][i] + y.se[3][i]) / nn / unit,
            ((x.u2[i] + y.u2[i]) / nn).sqrt() / rms(2, i),
            nn / (x.dof[i] + y.dof[i]),
            (x.cov[0][i] + y.cov[0][i]) as f64 / nn,
            (x.cov[1][i] + y.cov[1][i]) as f64 / nn,
            (x.cov[2][i] + y.cov[2][i]) as f64 / nn,
            (x.covt[i] + y.covt[i]) as f64 / nn,
            (x.width[i] + y.width[i]) / nn
        );
    }
}
#[test]
fn go() {
    let f = std::env::var("CASE").unwrap_or_default();
    let n: usize = std::env::var("N").ok().map_or(1000, |s| s.parse().unwrap());
    let p = |a: Vec<f64>| Truth::new(a);
    let free = |a: Vec<f64>| Truth { stated_arcmin: 0.0, ..Truth::new(a) };
    let any = Weights::Angle;
    let cases: Vec<(&str, Truth, Weights)> = vec![
        ("paper", Truth { angle: 0.55 * ARCMIN, ..p(paper()) }, any),
        ("full", Truth { angle: 0.55 * ARCMIN, ..p(equal(65.0, 60)) }, any),
        ("full-free", Truth { angle: 0.55 * ARCMIN, ..free(equal(65.0, 60)) }, any),
        ("full-level", Truth { level: 0.2, ..free(equal(65.0, 60)) }, any),
        ("full-level-misstated", Truth { level: 0.2, ..p(equal(65.0, 60)) }, any),
        ("full-mix", Truth { level: 0.2, angle: 0.55 * ARCMIN, ..free(equal(65.0, 60)) }, any),
        ("12", Truth { angle: 0.55 * ARCMIN, ..p(equal(65.0, 12)) }, any),
        ("12-free", Truth { angle: 0.55 * ARCMIN, ..free(equal(65.0, 12)) }, any),
        ("12-level", Truth { level: 0.2, ..free(equal(65.0, 12)) }, any),
        ("12-level-given", Truth { level: 0.2, ..p(equal(65.0, 12)) }, Weights::Equal),
        ("12-mix", Truth { level: 0.2, angle: 0.55 * ARCMIN, ..free(equal(65.0, 12)) }, any),
        ("7", Truth { angle: 0.55 * ARCMIN, ..p(equal(60.0, 7)) }, any),
        ("q0.1", Truth { sigma: 0.1, angle: 0.55 * ARCMIN, ..p(equal(60.0, 60)) }, any),
        ("q0.1-tau0", Truth { sigma: 0.1, samples: 300, ..free(equal(60.0, 60)) }, any),
        (
            "q0.1-tau.15",
            Truth { sigma: 0.1, samples: 300, level: 0.15, ..free(equal(60.0, 60)) },
            any,
        ),
        (
            "q0.3-tau.05",
            Truth { sigma: 0.3, samples: 300, level: 0.05, ..free(equal(60.0, 60)) },
            any,
        ),
        (
            "q0.5-tau.05",
            Truth { sigma: 0.5, samples: 300, level: 0.05, ..free(equal(60.0, 60)) },
            any,
        ),
        ("q1-tau.3", Truth { sigma: 1.0, samples: 300, level: 0.3, ..free(equal(60.0, 60)) }, any),
        ("q0.1-12", Truth { sigma: 0.1, level: 0.15, ..free(equal(60.0, 12)) }, any),
        ("q0.02", Truth { sigma: 0.02, level: 0.05, ..free(equal(60.0, 60)) }, any),
        ("q0.02-tau0", Truth { sigma: 0.02, ..free(equal(60.0, 60)) }, any),
        ("q0.02-12", Truth { sigma: 0.02, ..free(equal(60.0, 12)) }, any),
        ("3-arcmin", Truth { angle: 3.0 * ARCMIN, ..p(equal(65.0, 60)) }, any),
        ("0.5-arcmin", Truth { angle: 0.5 * ARCMIN, ..p(equal(65.0, 60)) }, any),
        ("updown", Truth { angle: 0.55 * ARCMIN, upright: Some(30.0 * ARCMIN), ..p(paper()) }, any),
        (
            "updown-full",
            Truth { angle: 0.55 * ARCMIN, upright: Some(30.0 * ARCMIN), ..p(equal(65.0, 60)) },
            any,
        ),
        (
            "10bit",
            Truth {
                nominal: 4.0 * GRAVITY / 1024.0,
                sigma: 0.24,
                angle: 0.55 * ARCMIN,
                ..p(equal(65.0, 60))
            },
            any,
        ),
        ("walk", Truth { angle: 0.55 * ARCMIN, walk: 0.01, ..p(paper()) }, any),
        ("tau0", Truth { ..free(equal(60.0, 60)) }, any),
    ];
    for (name, t, w) in &cases {
        if f.is_empty() || f.split(',').any(|c| c == *name) {
            study(name, t, n, *w);
        }
    }
}
