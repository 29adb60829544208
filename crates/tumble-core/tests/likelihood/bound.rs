//! What nobody can beat: the Cramér–Rao bound of the quantized two-level model, and the unquantized reference.

use tumble_core::linalg::Triangular;
use tumble_core::stats::IntervalProbability;
use tumble_core::{Code, Quantizer};

use crate::bench::Truth;

/// Fisher information of one coded sample about its level, `Σ P′²/P`, LSB⁻².
pub fn information_of_a_sample(level: f64, sigma: f64, quantizer: Quantizer) -> f64 {
    let reach = (8.0 * sigma + 2.0).ceil();
    let (first, last) = ((level - reach).floor() as i32, (level + reach).ceil() as i32);
    (first..=last)
        .map(|n| {
            let (lo, hi) = quantizer.interval_lsb(Code(n));
            let p = IntervalProbability::of((lo - level) / sigma, (hi - level) / sigma);
            p.ln.exp() * ((p.lower_ratio - p.upper_ratio) / sigma).powi(2)
        })
        .sum()
}

/// Levels of the run's positions and the true scatter's variances.
fn levels(truth: &Truth) -> Vec<(f64, f64)> {
    truth
        .angles_deg
        .iter()
        .map(|deg| {
            let angle = deg.to_radians();
            let level =
                truth.full_scale() * (angle + truth.misalignment_rad).sin() + truth.bias_lsb;
            (level, truth.scatter_variance(angle))
        })
        .collect()
}

/// Smallest standard deviations of unbiased estimates, the scatter being known.
///
/// Each dwell's information about its level is `1/(1/(n i) + v)`: exact without scatter, and where a dwell's likelihood is
/// Gaussian.
pub fn cramer_rao(truth: &Truth) -> [f64; 3] {
    let variances: Vec<f64> = levels(truth)
        .iter()
        .map(|(level, v)| {
            let i = information_of_a_sample(*level, truth.sigma, truth.quantizer);
            1.0 / (truth.samples as f64 * i) + v
        })
        .collect();
    deviations(truth, &variances)
}

/// Standard deviations of weighted least squares of the unquantized dwell means, weights known.
pub fn unquantized_deviations(truth: &Truth) -> [f64; 3] {
    let variances: Vec<f64> =
        levels(truth).iter().map(|(_, v)| truth.sigma.powi(2) / truth.samples as f64 + v).collect();
    deviations(truth, &variances)
}

/// Its errors on one run.
pub fn unquantized_errors(truth: &Truth, analogue_lsb: &[f64]) -> [f64; 3] {
    let mut t = Triangular::new(3);
    let at = levels(truth);
    for ((deg, y), (level, v)) in truth.angles_deg.iter().zip(analogue_lsb).zip(&at) {
        let sd = (truth.sigma.powi(2) / truth.samples as f64 + v).sqrt();
        let (sin, cos) = deg.to_radians().sin_cos();
        t.push(&[1.0 / sd, sin / sd, cos / sd], (y - level) / sd);
    }
    let b = t.solve().unwrap();
    to_parameters(truth, [b[0], b[1], b[2]])
}

/// First order about the truth: `Δa = k* α`, `R = √(β²+γ²)`, `Δφ = atan2(γ, β)`, `k* = g/R`.
fn to_parameters(truth: &Truth, shift: [f64; 3]) -> [f64; 3] {
    let (k, r) = (truth.scale(), truth.full_scale());
    let (sin, cos) = truth.misalignment_rad.sin_cos();
    let relative = (cos * shift[1] + sin * shift[2]) / r;
    [
        k * (shift[0] - truth.bias_lsb * relative),
        (cos * shift[2] - sin * shift[1]) / r,
        -(1.0 + truth.scale_error) * relative,
    ]
}

fn deviations(truth: &Truth, variances: &[f64]) -> [f64; 3] {
    let mut t = Triangular::new(3);
    for (deg, v) in truth.angles_deg.iter().zip(variances) {
        let (sin, cos) = deg.to_radians().sin_cos();
        t.push(&[1.0, sin, cos].map(|x| x / v.sqrt()), 0.0);
    }
    let c = t.unit_covariance().unwrap();
    core::array::from_fn(|i| {
        // Column by column of the linear map above.
        let g: [f64; 3] = core::array::from_fn(|j| {
            let mut unit = [0.0; 3];
            unit[j] = 1.0;
            to_parameters(truth, unit)[i]
        });
        let variance: f64 = (0..3)
            .flat_map(|a| (0..3).map(move |b| (a, b)))
            .map(|(a, b)| g[a] * c[(a, b)] * g[b])
            .sum();
        variance.sqrt()
    })
}

#[test]
fn the_information_of_coded_samples_is_that_of_the_literature() {
    // Much noise: 1/(σ² + 1/12) up to exponentially small terms (Sheppard).
    for level in [3.0, 3.3, 3.5] {
        let i = information_of_a_sample(level, 1.5, Quantizer::Floor);
        assert!((i * (2.25 + 1.0 / 12.0) - 1.0).abs() < 0.002, "{level}: {i}");
    }
    // At an edge a coin: φ(0)²/(σ² · ¼) = 2/(π σ²).
    let i = information_of_a_sample(4.0, 0.05, Quantizer::Floor);
    assert!((i * 0.05f64.powi(2) - 2.0 / std::f64::consts::PI).abs() < 1e-6);
}
