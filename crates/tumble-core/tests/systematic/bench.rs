//! A bench whose every error is known, written anew and not with the library's own generator.

use rand_core::SeedableRng;
use rand_distr::{Distribution, StandardNormal};
use tumble_core::estimate::Setting;
use tumble_core::systematic::{Quantity, Systematics};
use tumble_core::{
    Angle, Bench, ConverterEnds, Gravity, GravitySource, Position, Quantizer, Readings, Record,
    Seat,
};

pub const G: f64 = 9.81;
pub const K0: f64 = 0.007_69;
/// Bias (m/s²), misalignment (rad), scale error: of ordinary size.
pub const TRUTH: [f64; 3] = [0.03, 0.004, 0.01];
pub const NOISE_LSB: f64 = 0.2;

/// Plans of method section 7: degrees, ±90° upright.
pub fn plan(name: &str) -> Vec<f64> {
    let even = |a: f64, n: u32| -> Vec<f64> {
        (0..n).map(|i| -a + 2.0 * a * f64::from(i) / f64::from(n - 1)).collect()
    };
    match name {
        "narrow" => (-30..30).map(f64::from).collect(),
        "wide" => even(65.0, 60),
        "three" => (0..60).map(|i| [-65.0, 0.0, 65.0][i % 3]).collect(),
        "narrow-upright" => [90.0, -90.0].into_iter().chain((-30..30).map(f64::from)).collect(),
        "upright" => [90.0, -90.0].into_iter().chain(even(65.0, 60)).collect(),
        _ => panic!("no plan {name}"),
    }
}

pub const PLANS: [&str; 4] = ["narrow", "wide", "three", "upright"];

/// Errors of the bench, in the units of the quantities.
#[derive(Debug, Clone, Copy, Default)]
pub struct Errors {
    pub dial_scale: f64,
    pub sine: f64,
    pub cosine: f64,
    pub zero: f64,
    pub tilt: f64,
    pub lean: f64,
    pub k2: f64,
    pub k3: f64,
    /// Bias at the end of the run beyond that at its start, m/s².
    pub drift: f64,
    /// The same of the scale, relative.
    pub scale_drift: f64,
    pub bow_lsb: f64,
    pub s_lsb: f64,
    pub gravity: f64,
}

impl Errors {
    /// One quantity alone.
    pub fn of(q: Quantity, x: f64) -> Self {
        let mut e = Self::default();
        match q {
            Quantity::DialScale => e.dial_scale = x,
            Quantity::EccentricitySine => e.sine = x,
            Quantity::EccentricityCosine => e.cosine = x,
            Quantity::DialZero => e.zero = x,
            Quantity::TiltTimesLean | Quantity::TiltAndLeanCosine => {
                (e.tilt, e.lean) = (x.sqrt(), x.sqrt())
            }
            Quantity::Quadratic => e.k2 = x,
            Quantity::Cubic => e.k3 = x,
            Quantity::BiasTempco => e.drift = x,
            Quantity::ScaleTempco => e.scale_drift = x,
            Quantity::ConverterBow => e.bow_lsb = x,
            Quantity::ConverterS => e.s_lsb = x,
            _ => panic!("no error of the bench: {}", q.name()),
        }
        e
    }
}

pub fn bench(angle_uncertainty_arcmin: f64) -> Bench {
    Bench {
        gravity: Gravity {
            value_m_s2: G,
            standard_uncertainty_m_s2: 0.0,
            source: GravitySource::Stated,
        },
        angle_uncertainty: Some(Angle::from_arcmin(angle_uncertainty_arcmin)),
        range: None,
        vertical_lean: Angle::from_arcmin(30.0),
        systematics: Systematics::default(),
    }
}

pub fn setting(bench: &Bench) -> Setting<'_> {
    Setting {
        bench,
        quantizer: Quantizer::None,
        ends: ConverterEnds::default(),
        nominal_scale_m_s2_per_lsb: K0,
    }
}

/// Readings of a run: averages that are not quantized, with the same scatter for the same seed.
pub fn run(
    plan: &[f64],
    bench: &Bench,
    e: &Errors,
    scatter_arcmin: f64,
    seed: u64,
) -> Vec<Position> {
    let mut rng = rand_pcg::Pcg64::seed_from_u64(seed);
    let mut normal = || -> f64 { StandardNormal.sample(&mut rng) };
    let scatter = Angle::from_arcmin(scatter_arcmin).rad();
    let k = K0 * (1.0 + TRUTH[2]);
    let g = G + e.gravity;
    let ideal: Vec<f64> = plan
        .iter()
        .map(|deg| {
            (G * (deg.to_radians() + if deg.abs() == 90.0 { 0.0 } else { TRUTH[1] }).sin()
                + TRUTH[0])
                / k
        })
        .collect();
    let low = ideal.iter().copied().fold(f64::INFINITY, f64::min);
    let high = ideal.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    plan.iter()
        .enumerate()
        .map(|(j, deg)| {
            let angle = Angle::from_deg(*deg);
            let seat = bench.seat(angle);
            let (phi, z) = (angle.rad(), [normal(), normal()]);
            let a = match seat {
                Seat::Table => {
                    let dial = e.dial_scale * phi
                        + e.sine * phi.sin()
                        + e.cosine * (phi.cos() - 1.0)
                        + e.zero;
                    let tilted = e.lean.cos() * e.tilt.cos();
                    let across = e.lean.sin() * e.tilt.sin();
                    g * (tilted * (phi + dial + TRUTH[1] + scatter * z[0]).sin() + across)
                }
                Seat::Up => g * (1.0 - Angle::from_arcmin(30.0).rad().powi(2) / 2.0),
                Seat::Down => -g * (1.0 - Angle::from_arcmin(30.0).rad().powi(2) / 2.0),
            };
            let order = j as f64 / (plan.len() - 1) as f64 - 0.5;
            let curved = a * (1.0 + e.scale_drift * order) + e.k2 * a * a + e.k3 * a.powi(3);
            let x = (curved + TRUTH[0] + e.drift * order) / k;
            let t = 2.0 * (x - low) / (high - low) - 1.0;
            let bent = x + e.bow_lsb * (2.0 * t * t - 1.0) + e.s_lsb * (4.0 * t.powi(3) - 3.0 * t);
            Position {
                angle,
                seat,
                readings: Readings::Averaged {
                    mean: bent + NOISE_LSB / 10.0 * z[1],
                    samples: 100,
                    std: Some(NOISE_LSB),
                },
                temperature_degc: None,
                place: String::new(),
                record: Record::default(),
            }
        })
        .collect()
}
