//! Coverage of the pooled value and of the two predictions on Gaussian run estimates.

use rand_core::SeedableRng;
use rand_distr::{Distribution, StandardNormal};
use tumble_core::combine::{Unit, combine, prediction};
use tumble_core::linalg::Symmetric3;
use tumble_core::stats::student_factor;

/// Covariance of a run of the paper's plan over its standard uncertainties: bias and misalignment are nearly one.
const CORRELATION: [[f64; 3]; 3] =
    [[1.0, -0.9991, -0.07], [-0.9991, 1.0, 0.075], [-0.07, 0.075, 1.0]];

#[derive(Debug, Clone, Copy, Default)]
pub struct Covered {
    pub pooled: f64,
    pub estimate: f64,
    pub truth: f64,
}

/// `CORRELATION = L Lᵀ`.
fn lower() -> [[f64; 3]; 3] {
    let c = CORRELATION;
    let mut l = [[0.0f64; 3]; 3];
    for i in 0..3 {
        for j in 0..=i {
            let rest = c[i][j] - (0..j).map(|k| l[i][k] * l[j][k]).sum::<f64>();
            l[i][j] = if i == j { rest.sqrt() } else { rest / l[j][j] };
        }
    }
    l
}

/// Runs with within-run uncertainty `sizes[r]` (of all three), bias spread `spread`, shared misalignment and scale.
pub fn covered(n: usize, sizes: &[f64], spread: f64, seed: u64) -> Covered {
    let mut rng = rand_pcg::Pcg64::seed_from_u64(seed);
    let mut normal = || -> f64 { StandardNormal.sample(&mut rng) };
    let l = lower();
    let mut count = [0usize; 3];
    for trial in 0..n {
        let mut draw = |size: f64| {
            let z = [normal(), normal(), normal()];
            let b = spread * normal();
            let e: [f64; 3] =
                core::array::from_fn(|i| size * (0..=i).map(|k| l[i][k] * z[k]).sum::<f64>());
            (b, [b + e[0], e[1], e[2]])
        };
        let units: Vec<Unit> = sizes
            .iter()
            .map(|size| Unit {
                values: draw(*size).1.map(Some),
                covariance: Symmetric3(CORRELATION.map(|row| row.map(|c| c * size * size))),
                design: [vec![(0, 1.0)], vec![(1, 1.0)], vec![(2, 1.0)]],
                dof: [f64::INFINITY; 3],
            })
            .collect();
        let c = combine(&units, 3).unwrap();
        let bias = &c.columns[0];
        let t = student_factor(0.95, bias.degrees_of_freedom).unwrap();
        let within = sizes.iter().map(|s| s * s).sum::<f64>() / sizes.len() as f64;
        let p = prediction(bias, c.omega_squared[0].unwrap(), within, 0.95).unwrap();
        // The next run is like one of those before, in turn.
        let (b, next) = draw(sizes[trial % sizes.len()]);
        count[0] += usize::from(bias.value.abs() <= t * bias.standard_uncertainty);
        count[1] += usize::from((next[0] - bias.value).abs() <= p.next_estimate);
        count[2] += usize::from((b - bias.value).abs() <= p.next_true);
    }
    let f = |i: usize| count[i] as f64 / n as f64;
    Covered { pooled: f(0), estimate: f(1), truth: f(2) }
}

/// Every cell of the table in `docs/runs.md`; 5 000 experiments each, 50 000 in the long tier.
fn table(big: f64, check: impl Fn(usize, f64, Covered)) {
    let n = if super::long() { 50_000 } else { 5_000 };
    for k in [3, 5, 10] {
        let sizes: Vec<f64> = (0..k).map(|i| if i % 2 == 1 { big } else { 1.0 }).collect();
        for spread in [0.0, 1.0, 3.0, 10.0] {
            let c = covered(n, &sizes, spread, 40 + k as u64);
            println!(
                "k {k} spread {spread}: pooled {:.4}, next estimate {:.4}, next true {:.4}",
                c.pooled, c.estimate, c.truth
            );
            check(k, spread, c);
        }
    }
}

fn near(value: f64, tolerance: f64) -> bool {
    (value - 0.95).abs() <= tolerance
}

#[test]
fn runs_of_equal_precision_cover_what_they_say() {
    table(1.0, |k, spread, c| {
        assert!(near(c.pooled, 0.01) && near(c.estimate, 0.01), "{k} {spread} {c:?}");
        let next_true = if spread > 5.0 { near(c.truth, 0.01) } else { c.truth >= 0.92 };
        assert!(next_true, "{k} {spread} {c:?}");
    });
}

/// Variances 1:9 in turn. With three runs and a spread between the two precisions no rule knows the right weights; the
/// mixture of next runs is not Gaussian.
#[test]
fn runs_of_unequal_precision_come_near() {
    table(3.0, |k, spread, c| {
        let pooled = if k == 3 { 0.02 } else { 0.01 };
        assert!(near(c.pooled, pooled) && near(c.estimate, 0.015), "{k} {spread} {c:?}");
        let next_true = if spread > 5.0 { near(c.truth, 0.01) } else { c.truth >= 0.92 };
        assert!(next_true, "{k} {spread} {c:?}");
    });
}
