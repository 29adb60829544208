//! The design table of method section 7, computed independently with numpy: to 1 %.
#![allow(clippy::unwrap_used)] // A test that cannot unwrap has failed.

use tumble_core::estimate::predict;
use tumble_core::simulate::parse_plan;
use tumble_core::{Angle, Seat};

/// One percent, the tolerance that the method names; the table is printed to two or three digits.
const TOLERANCE: f64 = 0.01;

fn table(plan: &str) -> Vec<(Angle, Seat)> {
    parse_plan(plan).unwrap().into_iter().map(|d| (Angle::from_deg(d), Seat::Table)).collect()
}

fn with_upright(plan: &str) -> Vec<(Angle, Seat)> {
    let upright = [(Angle::from_deg(90.0), Seat::Up), (Angle::from_deg(-90.0), Seat::Down)];
    upright.into_iter().chain(table(plan)).collect()
}

fn twenty_each() -> Vec<(Angle, Seat)> {
    [-65.0, 0.0, 65.0].into_iter().flat_map(|d| [(Angle::from_deg(d), Seat::Table); 20]).collect()
}

#[test]
fn uncertainties_of_six_plans() {
    let k0 = 0.007_69;
    // plan, u(Δa) LSB, u(Δφ) mrad, u(δk) 1e-3, condition, correlation
    let rows: [(&str, Vec<_>, [f64; 5]); 6] = [
        ("paper", table("paper"), [0.616, 0.505, 0.0690, 48.0, -0.999]),
        ("0…59", table("0:59:60"), [0.616, 0.441, 0.2560, 51.0, -0.996]),
        ("±60", table("-60:60:60"), [0.139, 0.130, 0.0369, 11.0, -0.982]),
        ("±65", table("-65:65:60"), [0.116, 0.112, 0.0347, 9.0, -0.975]),
        ("20 each", twenty_each(), [0.064, 0.074, 0.0274, 5.0, -0.914]),
        ("up/down", with_upright("paper"), [0.138, 0.115, 0.0585, 11.0, -0.983]),
    ];
    for (name, plan, expected) in rows {
        let p = predict(&plan, 0.2 * k0, 9.81).unwrap();
        let ours =
            [p.u_bias_m_s2 / k0, p.u_misalignment_rad * 1e3, p.u_scale_error * 1e3, p.condition];
        for (ours, theirs) in ours.iter().zip(expected).take(3) {
            assert!((ours / theirs - 1.0).abs() < TOLERANCE, "{name}: {ours} against {theirs}");
        }
        // Printed as whole numbers.
        assert!(
            (ours[3] - expected[3]).abs() <= 0.5 + TOLERANCE * expected[3],
            "{name}: {}",
            ours[3]
        );
        assert!((p.correlation_bias_misalignment - expected[4]).abs() < 5.1e-4, "{name}");
    }
}

/// Method section 8, end: what K2 costs, 60 positions and 0.2 LSB of scatter.
#[test]
fn what_k2_costs_the_bias() {
    use tumble_core::estimate::{Term, TermSet, predict_with_terms};
    use tumble_core::{Angle, Seat};
    let k0 = 0.007_69;
    let equal = |range: f64| -> Vec<f64> {
        (0..60).map(|i| -range + 2.0 * range * f64::from(i) / 59.0).collect()
    };
    let table = |angles: Vec<f64>| -> Vec<(Angle, Seat)> {
        angles.into_iter().map(|a| (Angle::from_deg(a), Seat::Table)).collect()
    };
    let paper = table((-30..30).map(f64::from).collect());
    let mut with_pair = table(equal(65.0));
    with_pair.extend([(Angle::from_deg(90.0), Seat::Up), (Angle::from_deg(-90.0), Seat::Down)]);
    let k2 = TermSet::EMPTY.with(Term::K2);
    for (name, plan, terms, bias_lsb) in [
        ("-30 to 29°", &paper, TermSet::EMPTY, 0.62),
        ("-30 to 29°, K2", &paper, k2, 35.0),
        ("±60°, K2", &table(equal(60.0)), k2, 2.0),
        ("±65°, K2", &table(equal(65.0)), k2, 1.44),
        ("±65°, up and down, K2", &with_pair, k2, 0.44),
    ] {
        let u = predict_with_terms(plan, terms, 0.2 * k0, 9.81).unwrap().u_bias_m_s2 / k0;
        println!("{name}: {u:.3} LSB");
        assert!((u / bias_lsb - 1.0).abs() < 0.02, "{name}: {u:.3} LSB against {bias_lsb}");
    }
}
