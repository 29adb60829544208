//! Runs together, from files: the body reversed, and a pair that all runs share.
#![allow(clippy::unwrap_used)] // A test that cannot unwrap has failed.

use std::fmt::Write as _;
use std::fs;

use tumble_io::passport::Passport;
use tumble_io::{CertifyOptions, certify, read_experiment};

const G: f64 = 9.81;
const SCALE: f64 = 0.0077;
/// `ε` of the table, `δ` of the body, rad.
const EPSILON: f64 = 2e-3;
const DELTA: f64 = -1e-3;

const HEAD: &str = "[sensor]\nmodel = \"A\"\nk2_uncertainty_ug_per_g2 = 0\nk3_uncertainty_ug_per_g3 = 0\n[output]\nquantizer = \"none\"\nunit = \"LSB\"\nnominal_scale = 0.0077\n[bench]\ndial_scale_uncertainty_ppm = 0\neccentricity_arcmin = 0\naxis_tilt_arcmin = 0\nsensor_lean_arcmin = 0\ngravity = 9.81\n\
gravity_uncertainty = 0.0001\nangle_uncertainty_arcmin = 0.1\n";

/// A number between −1 and 1 that looks like noise; the same for the same index.
fn noise(i: usize) -> f64 {
    let x = (i as u64 + 1).wrapping_mul(0x9E37_79B9_7F4A_7C15);
    ((x ^ (x >> 29)).wrapping_mul(0xBF58_476D_1CE4_E5B9) >> 40) as f64 / f64::from(1 << 23) - 1.0
}

/// A run as the operator writes it: dial angles, whatever the orientation. Method section 7: the true angle is
/// `φ + ε + δ`, and `−φ − ε + δ` with the body turned.
fn run_file(turned: f64, bias: f64, stream: usize) -> String {
    let mut out = String::from("angle_deg,mean_output,samples\n");
    for i in 0..25 {
        let dial: f64 = -60.0 + 5.0 * i as f64;
        let angle = turned * (dial.to_radians() + EPSILON) + DELTA;
        let reading = (G * angle.sin() + bias) / SCALE + 0.1 * noise(100 * stream + i);
        writeln!(out, "{dial},{reading},100").unwrap();
    }
    out
}

fn folder(toml: &str) -> tempfile::TempDir {
    let dir = tempfile::tempdir().unwrap();
    for (i, turned) in [1.0, 1.0, -1.0, -1.0].into_iter().enumerate() {
        let bias = 0.05 + 0.003 * noise(7 + i);
        let text = run_file(turned, bias, i).replace("mean_output", "mean_code");
        fs::write(dir.path().join(format!("r{}.csv", i + 1)), text).unwrap();
    }
    fs::write(dir.path().join("experiment.toml"), toml).unwrap();
    dir
}

fn runs(reversed_mounting: &str) -> String {
    let mut toml = String::new();
    for i in 1..=4 {
        let more = if i > 2 {
            format!("mounting = \"{reversed_mounting}\"\norientation = \"reversed\"\n")
        } else {
            "mounting = \"A\"\n".to_owned()
        };
        write!(toml, "[[run]]\nfile = \"r{i}.csv\"\n{more}").unwrap();
    }
    toml
}

fn passport(toml: &str) -> Passport {
    certify(folder(toml).path(), &CertifyOptions::default()).unwrap()
}

#[test]
fn the_sign_of_reversal_is_that_of_the_reader() {
    let p = passport(&format!("{HEAD}{}", runs("A")));
    let r = p.result.as_ref().unwrap_or_else(|| panic!("{:#?}", p.findings));
    let zero = r.table_zero.as_ref().unwrap();
    let misalignment = r.misalignment.as_ref().unwrap();
    for (name, e, truth) in [("zero", zero, EPSILON), ("misalignment", misalignment, DELTA)] {
        let u = e.expanded_uncertainty.unwrap();
        assert!((e.value - truth).abs() < u && u < 5e-4, "{name}: {} ± {u}", e.value);
    }
    assert!(p.findings.iter().any(|f| f.id == "T0213"));
    let mountings: Vec<&str> = p.runs.iter().map(|r| r.mounting.as_str()).collect();
    assert_eq!(mountings, ["A", "A", "A reversed", "A reversed"]);
    // Both predictions, and the one for the true value is the narrower.
    let width = |i: Option<[f64; 2]>| i.map(|[lo, hi]| hi - lo).unwrap();
    assert!(width(r.bias.prediction_true_interval) < width(r.bias.prediction_interval));
}

#[test]
fn other_mountings_keep_their_sums() {
    let p = passport(&format!("{HEAD}{}", runs("B")));
    let r = p.result.as_ref().unwrap_or_else(|| panic!("{:#?}", p.findings));
    assert!(r.table_zero.is_none() && r.misalignment.is_none());
    let found: Vec<(&str, f64)> =
        r.mountings.iter().map(|m| (m.name.as_str(), m.misalignment.value)).collect();
    assert!(found[0].0 == "A" && (found[0].1 - DELTA - EPSILON).abs() < 3e-4, "{found:?}");
    assert!(found[1].0 == "B reversed" && (found[1].1 - DELTA + EPSILON).abs() < 3e-4, "{found:?}");
    assert!(p.findings.iter().any(|f| f.id == "T0214"));
}

#[test]
fn a_joint_pair_enters_once_and_not_beside_a_run() {
    let (up, down) = ((G + 0.049) / SCALE, (-G + 0.049) / SCALE);
    let pair = format!(
        "[scale]\nup_mean_code = {up}\nup_samples = 3000\nup_std_code = 1.0\ndown_mean_code = {down}\n\
         down_samples = 3000\ndown_std_code = 1.0\n"
    );
    let joint = passport(&format!("{HEAD}{pair}joint = true\n{}", runs("A")));
    let shared = joint.result.as_ref().unwrap().shared_pair.as_ref().unwrap();
    // The readings are those of an upright axis; the mean lean is taken out.
    let lean: f64 = (30.0f64 / 60.0).to_radians();
    assert!((shared.lean_correction + lean * lean / 2.0).abs() < 1e-9, "{shared:?}");
    assert!((shared.scale_error - shared.lean_correction).abs() < 1e-12, "{shared:?}");
    assert!(!joint.findings.iter().any(|f| f.id == "T0308"));
    let apart = passport(&format!("{HEAD}{pair}{}", runs("A")));
    assert!(apart.result.as_ref().unwrap().shared_pair.is_none());
    assert!(apart.findings.iter().any(|f| f.id == "T0308"));
    let both = folder(&format!("{HEAD}{pair}joint = true\nrun = \"r1\"\n{}", runs("A")));
    let error = read_experiment(both.path(), &()).unwrap_err().to_string();
    assert!(error.contains("joint") && error.contains("not both"), "{error}");
}
