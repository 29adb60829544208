//! Least squares on the linear sets of NIST's Statistical Reference Datasets (certified values).
//!
//! The data are made by others and stay outside this repository, in `../shared/data`; without them this is skipped
//! aloud.
#![allow(clippy::unwrap_used, clippy::print_stdout)] // A test that cannot unwrap has failed; figures are for people.

use std::path::{Path, PathBuf};

use tumble_core::linalg::Triangular;

fn folder() -> Option<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data/nist_strd");
    if folder.exists() {
        return Some(folder);
    }
    println!("SKIPPED: {} is not here", folder.display());
    None
}

/// Numbers of a block of lines, counted from one.
fn numbers(text: &str, from: usize) -> Vec<Vec<f64>> {
    text.lines()
        .skip(from - 1)
        .map(|l| l.split_whitespace().map_while(|w| w.parse().ok()).collect::<Vec<f64>>())
        .filter(|row| !row.is_empty())
        .collect()
}

/// First line of data, from the file's own header: `Data (lines 61 to 142)`.
fn first_data_line(text: &str) -> usize {
    let line =
        text.lines().find(|l| l.trim_start().starts_with("Data ") && l.contains("lines")).unwrap();
    line.split("lines").nth(1).unwrap().split_whitespace().next().unwrap().parse().unwrap()
}

/// Certified estimates and standard deviations: lines `B1  value  sd`.
fn certified(text: &str) -> Vec<(f64, f64)> {
    text.lines()
        .filter_map(|l| {
            let mut words = l.split_whitespace();
            let name = words.next()?;
            let is_coefficient = name.strip_prefix('B')?.parse::<u32>().is_ok();
            let value: f64 = words.next()?.parse().ok()?;
            let sd: f64 = words.next()?.parse().ok()?;
            is_coefficient.then_some((value, sd))
        })
        .collect()
}

/// Row of the design: powers of x, or the predictors themselves.
fn row(set: &str, coefficients: usize, predictors: &[f64]) -> Vec<f64> {
    match set {
        "NoInt1" | "NoInt2" => predictors.to_vec(),
        "Longley" => std::iter::once(1.0).chain(predictors.iter().copied()).collect(),
        _ => (0..coefficients).map(|k| predictors[0].powi(k as i32)).collect(),
    }
}

/// Correct digits, at most 15.
fn digits(ours: f64, certified: f64) -> f64 {
    let error = if certified == 0.0 { ours.abs() } else { ((ours - certified) / certified).abs() };
    if error == 0.0 { 15.0 } else { (-error.log10()).min(15.0) }
}

#[test]
fn certified_digits() {
    let Some(folder) = folder() else { return };
    // Fewest correct digits of a coefficient that a Householder QR of good make reaches (measured beside this
    // project: Longley 10.8, Filip 7.6, Wampler5 6.7); the easy sets by their condition.
    let sets = [
        ("Norris", 12.0),
        ("Pontius", 11.0),
        ("NoInt1", 14.0),
        ("NoInt2", 14.0),
        ("Longley", 10.8),
        ("Filip", 7.6),
        ("Wampler1", 8.9),
        ("Wampler2", 11.0),
        ("Wampler3", 8.9),
        ("Wampler4", 7.4),
        ("Wampler5", 6.6),
    ];
    for (set, least) in sets {
        let text = std::fs::read_to_string(folder.join(format!("{set}.dat"))).unwrap();
        let certified = certified(&text);
        let p = certified.len();
        let mut triangle = Triangular::new(p);
        let data = numbers(&text, first_data_line(&text));
        data.iter().for_each(|d| triangle.push(&row(set, p, &d[1..]), d[0]));
        assert!(data.len() > p, "{set}: {} rows", data.len());
        let b = triangle.solve().unwrap();
        let s2 = triangle.residual_sum_of_squares() / (data.len() - p) as f64;
        let covariance = triangle.unit_covariance().unwrap();
        let fewest =
            |pairs: Vec<(f64, f64)>| pairs.iter().map(|(a, c)| digits(*a, *c)).fold(15.0, f64::min);
        let estimates = fewest(b.iter().zip(&certified).map(|(b, c)| (*b, c.0)).collect());
        let deviations = fewest(
            certified
                .iter()
                .enumerate()
                .map(|(i, c)| ((covariance[(i, i)] * s2).sqrt(), c.1))
                .collect(),
        );
        println!("{set:9} estimates {estimates:4.1} digits, standard deviations {deviations:4.1}");
        assert!(estimates >= least, "{set}: {estimates:.1} digits, {least} wanted");
    }
}
