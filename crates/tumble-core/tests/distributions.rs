//! Distributions against mpmath (60 digits; `tests/data/make_distributions.py`).
#![allow(clippy::unwrap_used)] // A test that cannot unwrap has failed.

use tumble_core::stats::{
    IntervalProbability, erfcx, fisher_p_value, normal_cdf, normal_quantile, student_factor,
    student_p_value,
};

/// Relative: what intervals and p-values need with a margin of nine digits.
const TOLERANCE: f64 = 1e-12;

#[test]
fn twelve_digits() {
    let table = include_str!("../../../tests/data/distributions.csv");
    let mut worst: Vec<(f64, String)> = Vec::new();
    for line in table.lines().skip(1) {
        let fields: Vec<&str> = line.split(',').collect();
        let number = |i: usize| fields[i].parse::<f64>().unwrap();
        let (x, a, b, theirs) = (number(1), number(2), number(3), number(4));
        let ours = match fields[0] {
            "normal_cdf" => normal_cdf(x),
            "normal_quantile" => normal_quantile(x),
            "student_factor" => student_factor(x, a).unwrap(),
            "student_p_value" => student_p_value(x, a).unwrap(),
            "erfcx" => erfcx(x),
            "ln_normal_interval" => IntervalProbability::of(a, b).ln,
            "fisher_p_value" => fisher_p_value(x, a, b).unwrap(),
            other => panic!("{other}"),
        };
        let error = if theirs == 0.0 { ours.abs() } else { (ours / theirs - 1.0).abs() };
        if error > TOLERANCE {
            worst.push((error, format!("{line}: {ours:e}, off by {error:.1e}")));
        }
    }
    assert!(table.lines().count() > 195);
    assert!(worst.is_empty(), "{:#?}", worst.iter().map(|w| &w.1).collect::<Vec<_>>());
}
