//! The combined interval of whole calibrations, over benches whose systematic errors are drawn from what the budget says.
#![allow(clippy::unwrap_used, clippy::print_stdout)] // A test that cannot unwrap has failed; figures are for people.

use rand_core::{Rng, SeedableRng};
use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64Mcg;
use tumble_core::assess::{Assessment, assess};
use tumble_core::estimate::{EstimateOptions, Method, Parameter};
use tumble_core::simulate::{Preset, Truth, experiment, parse_plan};
use tumble_core::stats::student_factor;
use tumble_core::systematic::Systematics;
use tumble_core::{Angle, GravitySource, Quantizer, Targets};

/// Standard uncertainties of the drawn benches; gravity as the field differs from its formula, ±5·10⁻⁴ m/s².
const DIAL_SCALE: f64 = 3e-4;
const ECCENTRICITY_ARCMIN: f64 = 2.0;
const TILT_ARCMIN: f64 = 40.0;
const LEAN_ARCMIN: f64 = 30.0;
const GRAVITY_HALF_WIDTH: f64 = 5e-4;
const G: f64 = 9.81;

fn stated() -> Systematics {
    Systematics {
        dial_scale: Some(DIAL_SCALE),
        eccentricity: Some(Angle::from_arcmin(ECCENTRICITY_ARCMIN)),
        axis_tilt: Some(Angle::from_arcmin(TILT_ARCMIN)),
        sensor_lean: Some(Angle::from_arcmin(LEAN_ARCMIN)),
        ..Systematics::NONE
    }
}

/// A calibration on one drawn bench: its judgement, and the true bias, misalignment and scale error.
fn calibration(base: &Truth, seed: u64, digits: u32) -> (Assessment, [f64; 3]) {
    let mut rng = Pcg64Mcg::seed_from_u64(0x5eed ^ seed.wrapping_mul(0x9e37_79b9_7f4a_7c15));
    let mut normal = || -> f64 { StandardNormal.sample(&mut rng) };
    // Two components, each normal: amplitude and phase follow.
    let component = ECCENTRICITY_ARCMIN / 2f64.sqrt();
    let (sine, cosine) = (component * normal(), component * normal());
    let mut truth = Truth {
        seed,
        dial_scale: DIAL_SCALE * normal(),
        eccentricity: Angle::from_arcmin(sine.hypot(cosine)),
        eccentricity_phase: Angle::from_rad(cosine.atan2(sine)),
        axis_tilt: Angle::from_arcmin(TILT_ARCMIN * normal()),
        sensor_lean: Angle::from_arcmin(LEAN_ARCMIN * normal()),
        ..base.clone()
    };
    let unit = (rng.next_u64() >> 11) as f64 / (1u64 << 53) as f64;
    truth.gravity_m_s2 = G + GRAVITY_HALF_WIDTH * (2.0 * unit - 1.0);
    let mut e = experiment(&truth);
    e.bench.systematics = stated();
    e.bench.gravity.value_m_s2 = G;
    e.bench.gravity.standard_uncertainty_m_s2 = GRAVITY_HALF_WIDTH / 3f64.sqrt();
    // Rectangular, as normal gravity is known.
    e.bench.gravity.source = GravitySource::Normal { latitude_deg: 50.0, height_m: 150.0 };
    e.targets = Targets { bias_m_s2: 1.0, misalignment_rad: 1.0, scale_error: 1.0 };
    let options = EstimateOptions {
        method: Method::Exact,
        monte_carlo_digits: digits,
        ..EstimateOptions::default()
    };
    let a = assess(&e, &options).unwrap();
    // What the dial is off at zero is part of the misalignment, by definition.
    let zero = Angle::from_arcmin(cosine).rad();
    (a, [truth.bias_m_s2, truth.misalignment.rad() + zero, truth.scale_error])
}

fn base(plan: &str, runs: u32, upright: bool) -> Truth {
    Truth {
        angles_deg: parse_plan(plan).unwrap(),
        dwell_s: 0.5,
        runs,
        quantizer: Quantizer::Floor,
        misalignment: Angle::from_rad(0.002),
        bias_m_s2: 0.03,
        turn_on_m_s2: if runs > 1 { 1e-3 } else { 0.0 },
        upright_in_each_run: upright,
        vertical_lean: Angle::from_arcmin(if upright { 20.0 } else { 0.0 }),
        gravity_m_s2: G,
        ..Preset::Paper2.truth()
    }
}

#[test]
fn the_combined_interval_covers_where_the_statistical_one_does_not() {
    let n: u64 = if std::env::var_os("TUMBLE_LONG").is_some() { 5000 } else { 400 };
    let options = [
        ("-65:65:60", 1, false),
        ("-65:65:60", 3, false),
        ("-60:60:13", 3, false),
        ("-65:65:30", 3, true),
    ];
    // All cases are printed before the first fault ends it.
    let mut faults = Vec::new();
    for (plan, runs, upright) in options {
        let base = base(plan, runs, upright);
        let (mut covered, mut alone) = ([0u32; 3], [0u32; 3]);
        for seed in 1..=n {
            let (a, truth) = calibration(&base, seed, 0);
            for p in Parameter::ALL {
                let pooled = a.pooled.iter().find(|x| x.parameter == p).unwrap();
                let off = (pooled.value - truth[p.index()]).abs();
                covered[p.index()] += u32::from(off <= pooled.expanded_uncertainty);
                let t = student_factor(0.95, pooled.dof_statistical).unwrap();
                alone[p.index()] += u32::from(off <= t * pooled.u_statistical);
            }
        }
        for p in Parameter::ALL {
            let share = |k: [u32; 3]| 100.0 * f64::from(k[p.index()]) / n as f64;
            let (all, scatter) = (share(covered), share(alone));
            println!(
                "{plan}, {runs} runs, upright {upright}: {}: combined {all:.1} %, statistical alone {scatter:.1} %",
                p.words()
            );
            // 95 ± 1 % for the full number; the binomial scatter of fewer comes on top.
            let se = 100.0 * (0.95 * 0.05 / n as f64).sqrt();
            let bound = if n == 5000 { 1.0 } else { 1.0 + 3.0 * se };
            if (all - 95.0).abs() > bound || scatter >= all {
                faults.push(format!("{plan}, {runs} runs: {}: {all} ({scatter})", p.words()));
            }
        }
    }
    assert!(faults.is_empty(), "{faults:#?}");
}

#[test]
fn draws_have_the_uncertainty_of_the_budget_and_are_the_same_each_time() {
    let one = calibration(&base("-65:65:60", 1, false), 7, 2).0;
    for d in &one.drawn {
        println!("{}: {} draws, {:?}, {:?}", d.parameter.words(), d.draws, d.output, d.validation);
        assert!(d.stabilized && d.draws <= 1_000_000);
        let p = one.pooled.iter().find(|p| p.parameter == d.parameter).unwrap();
        assert!((d.output.standard_uncertainty / p.standard_uncertainty - 1.0).abs() < 0.05);
    }
    assert_eq!(one.drawn.len(), 3);
    let none = calibration(&base("-65:65:60", 1, false), 7, 0).0;
    assert!(none.drawn.is_empty());
    // The same draws from the same data.
    assert_eq!(calibration(&base("-65:65:60", 1, false), 7, 2).0.drawn, one.drawn);
}
