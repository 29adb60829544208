//! Figures of method section 10, with equal weights as there.

use super::bench::{Errors, G, K0, TRUTH, bench, plan, run, setting};
use tumble_core::estimate::{EstimateOptions, Method, Weights, estimate};
use tumble_core::systematic::{Linearized, Quantity, Sites, pattern};
use tumble_core::{ARCMIN_RAD, Bench, Position, STANDARD_GRAVITY_M_S2};

/// Shift of (bias, misalignment, relative change of k*) per unit, and rms of the residuals that it leaves, m/s².
fn effect(plan_name: &str, q: Quantity) -> ([f64; 3], f64) {
    let b: Bench = bench(0.0);
    let positions = run(&plan(plan_name), &b, &Errors::default(), 1e-3, 1);
    let refs: Vec<&Position> = positions.iter().collect();
    let options = EstimateOptions {
        method: Method::Exact,
        weights: Weights::Equal,
        level: 0.95,
        ..EstimateOptions::default()
    };
    let at = estimate(&refs, &setting(&b), &options).unwrap();
    let sites = Sites::of(&at, &refs, &setting(&b), 1.0).unwrap();
    let lsb = pattern(q, &sites).unwrap();
    let linearized = Linearized::new(&at, &[]).unwrap();
    let left = linearized.left_over(&lsb);
    let rms = (left.iter().map(|r| r * r).sum::<f64>() / left.len() as f64).sqrt();
    let [bias, misalignment, scale] = linearized.shift(&lsb).parameters;
    ([bias, misalignment, scale / (1.0 + TRUTH[2])], rms * K0)
}

/// Three minutes of eccentricity at its worst phase. Left over: rms; where the method prints 0.2 mm/s² for the narrow plan
/// it is the largest residual (0.21), and the rms is 0.088 (numpy 2.4.6, worst of 181 phases; 0.78 for the wide plan).
#[test]
fn eccentricity() {
    let e = 3.0 * ARCMIN_RAD;
    for (name, ppm, bias, rms) in
        [("wide", 568.0, 4.4e-3, 0.78e-3), ("narrow", 803.0, 7.6e-3, 0.088e-3)]
    {
        let (sine, left_sine) = effect(name, Quantity::EccentricitySine);
        let (cosine, left_cosine) = effect(name, Quantity::EccentricityCosine);
        let scale = sine[2].hypot(cosine[2]) * e * 1e6;
        let shift = sine[0].hypot(cosine[0]) * e;
        let left = left_sine.max(left_cosine) * e;
        println!(
            "{name}: {scale:.0} ppm, {:.2} mm/s², leaves {:.2} mm/s²",
            shift * 1e3,
            left * 1e3
        );
        assert!((scale / ppm - 1.0).abs() < 0.002, "{name}: {scale}");
        assert!((shift / bias - 1.0).abs() < 0.005, "{name}: {shift}");
        assert!((left / rms - 1.0).abs() < 0.04, "{name}: {left}");
    }
}

/// A degree of tilt and a degree of lean: the readings' scale falls by 305 ppm, so k* rises by it.
#[test]
fn tilt_and_lean() {
    let degree = 1f64.to_radians();
    let (bias, _) = effect("wide", Quantity::TiltTimesLean);
    let (scale, _) = effect("wide", Quantity::TiltAndLeanCosine);
    let product = bias[0] * degree * degree;
    let cosine = scale[2] * degree * degree;
    println!("bias {:.3} mm/s² = {:.2} LSB, scale {cosine:.3e}", product * 1e3, product / K0);
    assert!((product - 3.0e-3).abs() < 0.05e-3);
    assert!((cosine - 3.05e-4).abs() < 0.01e-4);
    assert!((product - G * degree * degree).abs() < 1e-9);
}

/// 100 µg/g² of K2 left out: by 0.13–0.24 LSB, the method says; 0.24 is the narrow plan, the others lie at 0.18–0.19.
#[test]
fn curvature_left_out() {
    let k2 = 100e-6 / STANDARD_GRAVITY_M_S2;
    let plans = [("narrow", 0.241), ("wide", 0.193), ("three", 0.182), ("narrow-upright", 0.176)];
    for (name, expected) in plans {
        let (shift, rms) = effect(name, Quantity::Quadratic);
        let (lsb, left) = (shift[0] * k2 / K0, rms * k2 / K0);
        println!("{name}: K2 shifts the bias by {lsb:.3} LSB and leaves {left:.4} LSB");
        assert!(left < 0.01 && (lsb - expected).abs() < 0.001, "{name}: {lsb}, {left}");
    }
}
