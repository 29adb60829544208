//! Reference data sets with answers computed by numpy, independent of this project.
#![allow(clippy::unwrap_used)] // A test that cannot unwrap has failed.

use std::path::{Path, PathBuf};

use serde_json::Value;
use tumble_core::estimate::{EstimateOptions, Method, Weights};
use tumble_core::{Quantizer, nominal_scale_from_means};
use tumble_io::passport::{Estimate, Passport};
use tumble_io::{CertifyOptions, certify};

/// Relative; what numpy's and our rounding leave at condition numbers up to 48 is below 1e-10.
const TOLERANCE: f64 = 1e-9;

fn reference() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/data/reference")
}

fn answers() -> Value {
    let text = std::fs::read_to_string(reference().join("answers.json")).unwrap();
    serde_json::from_str(&text).unwrap()
}

fn run(name: &str, method: Method) -> Passport {
    let estimate =
        EstimateOptions { method, weights: Weights::Equal, ..EstimateOptions::default() };
    let options = CertifyOptions { estimate, ..CertifyOptions::default() };
    certify(&reference().join(name), &options).unwrap()
}

fn close(what: &str, ours: f64, theirs: f64) {
    let error = (ours - theirs).abs() / theirs.abs();
    assert!(error <= TOLERANCE, "{what}: {ours} here, {theirs} by numpy, relative {error:.1e}");
}

fn numbers(v: &Value) -> Vec<f64> {
    v.as_array().unwrap().iter().map(|x| x.as_f64().unwrap()).collect()
}

#[test]
fn every_answer_to_nine_digits() {
    let mut compared = 0;
    let answers = answers();
    for (set, answer) in answers.as_object().unwrap() {
        for (name, method) in [("paper", Method::Paper), ("exact", Method::Exact)] {
            let Some(expected) = answer.get(name) else { continue };
            let passport = run(set, method);
            let r = &passport.runs[0];
            let ours: Vec<&Estimate> =
                [&r.estimates.bias, &r.estimates.misalignment, &r.estimates.scale_error]
                    .into_iter()
                    .map(|e| {
                        e.as_ref().unwrap_or_else(|| panic!("{set} {name}: no estimate; {:?}", r))
                    })
                    .collect();
            let what = |field: &str| format!("{set} {name} {field}");
            for (i, theirs) in numbers(&expected["estimates"]).iter().enumerate() {
                close(&what("estimate"), ours[i].value, *theirs);
                compared += 1;
            }
            if let Some(u) = expected.get("standard_uncertainty") {
                for (i, theirs) in numbers(u).iter().enumerate() {
                    close(&what("u"), ours[i].standard_uncertainty.unwrap(), *theirs);
                    compared += 1;
                }
            }
            if let Some(s) = expected.get("residual_std") {
                // The paper's adjustment has its residuals in m/s², the exact one in LSB.
                let unit = if name == "paper" { passport.nominal_scale_m_s2_per_lsb } else { 1.0 };
                close(&what("s"), r.residual_std_lsb.unwrap() * unit, s.as_f64().unwrap());
                compared += 1;
            }
            if let Some(sequential) = expected.get("sequential") {
                for (n, theirs) in sequential.as_object().unwrap() {
                    let n: usize = n.parse().unwrap();
                    let at = r.sequential.iter().find(|s| s.positions == n).unwrap();
                    let ours = [at.bias, at.misalignment, at.scale_error];
                    for (o, t) in ours.iter().zip(numbers(theirs)) {
                        close(&what(&format!("first {n} positions")), *o, t);
                        compared += 1;
                    }
                }
            }
            if let Some(c) = expected.get("condition_number_unit_columns") {
                close(&what("condition"), r.condition_number.unwrap(), c.as_f64().unwrap());
                let theirs = expected["correlation_bias_misalignment"].as_f64().unwrap();
                close(&what("correlation"), r.correlations[0].value, theirs);
                compared += 2;
            }
        }
    }
    // Seven sets with both methods and uncertainties, one without noise, sequences and conditions.
    assert!(compared >= 150, "only {compared} numbers compared");
}

#[test]
fn nominal_scale_of_all_quantizers() {
    let answers = answers();
    let n = &answers["nominal-scale"];
    let get = |k: &str| n[k].as_f64().unwrap();
    for (name, q) in [
        ("truncate", Quantizer::Truncate),
        ("round", Quantizer::Round),
        ("floor", Quantizer::Floor),
    ] {
        let ours =
            nominal_scale_from_means(get("up_mean_code"), get("down_mean_code"), q, get("gravity"))
                .unwrap();
        close(name, ours, get(name));
    }
}
