//! Whether intervals cover what they say where the bench itself is wrong. `TUMBLE_LONG=1` runs the numbers that
//! docs/budget.md prints.
#![allow(clippy::unwrap_used, clippy::print_stdout)] // A test that cannot unwrap has failed; figures are for people.

use rand_core::SeedableRng;
use rand_distr::{Distribution, StandardNormal};
use tumble_core::estimate::{Estimate, EstimateOptions, Method, Parameter, Setting, estimate};
use tumble_core::stats::student_factor;
use tumble_core::systematic::{Inputs, Quantity, Shape, SystematicEffect, Systematics, effects};
use tumble_core::{
    Angle, Bench, ConverterEnds, Experiment, Gravity, GravitySource, Output, Position, Quantizer,
    Readings, Record, Run, Seat, Sensor, Targets,
};

const K0: f64 = 0.007_69;
const G: f64 = 9.81;
const TRUTH: [f64; 3] = [0.03, 0.004, 0.01];
const SETTING_ARCMIN: f64 = 3.0;
/// 29 ppm: WGS 84 normal gravity below 500 m.
const U_GRAVITY: f64 = 2.9e-4;

/// What one bench really is.
#[derive(Debug, Clone, Copy)]
struct Drawn {
    gravity: f64,
    dial_scale: f64,
    sine: f64,
    cosine: f64,
    tilt: f64,
    lean: f64,
}

fn angles() -> Vec<f64> {
    (0..60).map(|i| -65.0 + 130.0 * f64::from(i) / 59.0).collect()
}

fn bench() -> Bench {
    Bench {
        gravity: Gravity {
            value_m_s2: G,
            standard_uncertainty_m_s2: U_GRAVITY,
            source: GravitySource::Stated,
        },
        angle_uncertainty: Some(Angle::from_arcmin(SETTING_ARCMIN)),
        range: None,
        vertical_lean: Angle::from_rad(0.0),
        // Dial, tilt and lean by default; the sensor's curve is a straight line and said to be one.
        systematics: Systematics {
            k2_per_m_s2: Some(0.0),
            k3_per_m2_s4: Some(0.0),
            ..Systematics::default()
        },
    }
}

fn run(drawn: &Drawn, normal: &mut impl FnMut() -> f64) -> Vec<Position> {
    let scatter = Angle::from_arcmin(SETTING_ARCMIN).rad();
    let k = K0 * (1.0 + TRUTH[2]);
    angles()
        .iter()
        .map(|deg| {
            let angle = Angle::from_deg(*deg);
            let phi = angle.rad();
            let dial =
                drawn.dial_scale * phi + drawn.sine * phi.sin() + drawn.cosine * (phi.cos() - 1.0);
            let star = phi + dial + TRUTH[1] + scatter * normal();
            let a = drawn.gravity
                * (drawn.lean.cos() * drawn.tilt.cos() * star.sin()
                    + drawn.lean.sin() * drawn.tilt.sin());
            let mean = (a + TRUTH[0]) / k + 0.03 * normal();
            Position {
                angle,
                seat: Seat::Table,
                readings: Readings::Averaged { mean, samples: 1500, std: Some(1.2) },
                temperature_degc: None,
                place: String::new(),
                record: Record::default(),
            }
        })
        .collect()
}

fn experiment(positions: Vec<Position>) -> Experiment {
    Experiment {
        sensor: Sensor {
            model: String::new(),
            serial: String::new(),
            axis: String::new(),
            kind: None,
        },
        output: Output {
            quantizer: Quantizer::None,
            unit: "LSB".into(),
            nominal_scale_m_s2_per_lsb: Some(K0),
            rate_hz: None,
            ends: ConverterEnds::default(),
        },
        bench: bench(),
        vertical: None,
        runs: vec![Run {
            name: "run".into(),
            mounting: "A".into(),
            positions,
            date: None,
            orientation: tumble_core::Orientation::Normal,
        }],
        specification: tumble_core::decision::Specification::default(),
        targets: Targets::default(),
    }
}

/// Draws a bench from the very lines of the budget.
fn draw(inputs: &Inputs, normal: &mut impl FnMut() -> f64) -> Drawn {
    let mut of = |q: Quantity| {
        let line = inputs.of_quantity(q).unwrap();
        line.shape.draw(line.standard_uncertainty, [normal(), 0.0])
    };
    let gravity = G + of(Quantity::Gravity);
    let dial_scale = of(Quantity::DialScale);
    let (sine, cosine) = (of(Quantity::EccentricitySine), of(Quantity::EccentricityCosine));
    let Shape::Product { u_rad } = inputs.of_quantity(Quantity::TiltTimesLean).unwrap().shape
    else {
        panic!("tilt times lean is a product");
    };
    let (tilt, lean) = (u_rad[0] * normal(), u_rad[1] * normal());
    Drawn { gravity, dial_scale, sine, cosine, tilt, lean }
}

#[derive(Debug, Default)]
struct Coverage {
    combined: [u32; 3],
    statistical: [u32; 3],
    squares: [f64; 3],
    claimed: [f64; 3],
}

impl Coverage {
    /// Judges the mean of runs on one bench: Welch–Satterthwaite, systematic effects with infinite degrees of freedom.
    fn judge(&mut self, runs: &[(Estimate, Vec<SystematicEffect>)]) {
        let k = runs.len() as f64;
        for p in Parameter::ALL {
            let i = p.index();
            let value = runs.iter().map(|(e, _)| e.values[i].unwrap()).sum::<f64>() / k;
            let own: Vec<f64> = runs
                .iter()
                .map(|(e, _)| (e.standard_uncertainty(p).unwrap() / k).powi(2))
                .collect();
            let statistical: f64 = own.iter().sum();
            let dof = statistical.powi(2)
                / own.iter().zip(runs).map(|(v, (e, _))| v * v / e.effective_dof[i]).sum::<f64>();
            let systematic: f64 = (0..runs[0].1.len())
                .map(|line| {
                    // Common to the runs: sensitivities add up, not contributions.
                    let c = runs.iter().map(|(_, all)| all[line].sensitivity[i]).sum::<f64>() / k;
                    (c * runs[0].1[line].standard_uncertainty).powi(2)
                })
                .sum();
            let combined = statistical + systematic;
            let effective = dof * (combined / statistical).powi(2);
            let error = (value - TRUTH[i]).abs();
            let covers = |variance: f64, dof: f64| {
                u32::from(error <= student_factor(0.95, dof).unwrap() * variance.sqrt())
            };
            self.combined[i] += covers(combined, effective);
            self.statistical[i] += covers(statistical, dof);
            self.squares[i] += error * error;
            self.claimed[i] += combined;
        }
    }
}

fn coverage(benches: u32, runs: usize, seed: u64) -> Coverage {
    let mut rng = rand_pcg::Pcg64::seed_from_u64(seed);
    let mut normal = || -> f64 { StandardNormal.sample(&mut rng) };
    let bench = bench();
    let setting = Setting {
        bench: &bench,
        quantizer: Quantizer::None,
        ends: ConverterEnds::default(),
        nominal_scale_m_s2_per_lsb: K0,
    };
    let options = EstimateOptions { method: Method::Exact, ..EstimateOptions::default() };
    let nothing =
        Drawn { gravity: G, dial_scale: 0.0, sine: 0.0, cosine: 0.0, tilt: 0.0, lean: 0.0 };
    let inputs = Inputs::of(&experiment(run(&nothing, &mut normal)), K0);
    let mut out = Coverage::default();
    for _ in 0..benches {
        let drawn = draw(&inputs, &mut normal);
        let fitted: Vec<(Estimate, Vec<SystematicEffect>)> = (0..runs)
            .map(|_| {
                let positions = run(&drawn, &mut normal);
                let refs: Vec<&Position> = positions.iter().collect();
                let e = estimate(&refs, &setting, &options).unwrap();
                let all = effects(&e, &refs, &setting, &inputs, &[]).unwrap();
                (e, all)
            })
            .collect();
        out.judge(&fitted);
    }
    out
}

/// Dial scale, eccentricity, tilt, lean and gravity drawn from what the budget says of them.
fn the_combined_interval_covers(runs: usize, seed: u64) {
    let long = std::env::var_os("TUMBLE_LONG").is_some();
    let n = if long { 5000 } else { 1000 };
    // 95 ± 1 % in the long tier; four standard errors of a fraction in the short one.
    let tolerance = if long { 0.01 } else { 4.0 * (0.95 * 0.05 / f64::from(n)).sqrt() };
    let c = coverage(n, runs, seed);
    let share = |k: u32| f64::from(k) / f64::from(n);
    for p in Parameter::ALL {
        let i = p.index();
        println!(
            "{runs} run(s), {n} benches, {}: combined {:.1} %, statistical alone {:.1} %, claimed/actual {:.3}",
            p.words(),
            100.0 * share(c.combined[i]),
            100.0 * share(c.statistical[i]),
            (c.claimed[i] / c.squares[i]).sqrt()
        );
        let off = share(c.combined[i]) - 0.95;
        assert!(off.abs() < tolerance, "{} covers {:.4}", p.name(), share(c.combined[i]));
    }
    // The scale error and the bias of a single run hardly know what scatter alone says of them.
    assert!(share(c.statistical[2]) < 0.9, "{:?}", c.statistical);
}

#[test]
fn one_run() {
    the_combined_interval_covers(1, 1);
}

#[test]
fn three_runs_pooled_by_their_mean() {
    the_combined_interval_covers(3, 2);
}
