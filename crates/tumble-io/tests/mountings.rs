//! Runs of one mounting share the misalignment; runs of different mountings do not.
#![allow(clippy::unwrap_used)] // A test that cannot unwrap has failed.

use tumble_core::simulate::{Preset, Truth, parse_plan};
use tumble_io::{CertifyOptions, Existing, SimulationOptions, certify, write_simulation};

#[test]
fn one_misalignment_a_mounting() {
    let truth = Truth {
        dwell_s: 2.0,
        runs: 4,
        angles_deg: parse_plan("-65:65:30").unwrap(),
        ..Preset::Paper3.truth()
    };
    let options = SimulationOptions {
        model: "ADXL203".into(),
        serial: "3".into(),
        gzip: false,
        averaged: false,
        stated_angle_uncertainty_arcmin: 0.55,
        scale_pair: false,
        existing: Existing::Keep,
    };
    let dir = tempfile::tempdir().unwrap();
    let folder = dir.path().join("two-seats");
    write_simulation(&truth, &options, &folder, &|| false).unwrap();
    // Scatter alone: a bench and a sensor without systematic errors.
    let file = folder.join("experiment.toml");
    let text = std::fs::read_to_string(&file).unwrap();
    let exact = text
        .replace("[sensor]\n", "[sensor]\nk2_uncertainty_ug_per_g2 = 0\nk3_uncertainty_ug_per_g3 = 0\n")
        .replace(
            "[bench]\n",
            "[bench]\ndial_scale_uncertainty_ppm = 0\neccentricity_arcmin = 0\naxis_tilt_arcmin = 0\nsensor_lean_arcmin = 0\n",
        );
    assert!(exact.len() > text.len() + 100);
    std::fs::write(&file, exact).unwrap();
    let file = folder.join("experiment.toml");
    // Runs 3 and 4: dial zero 0.2° away, as after re-mounting.
    let text = std::fs::read_to_string(&file).unwrap();
    let (head, tail) = text.split_at(text.find("[[run]]\nfile = \"run-3.csv\"").unwrap());
    std::fs::write(&file, format!("{head}{}", tail.replace("\"A\"", "\"B\""))).unwrap();
    for run in ["run-3.csv", "run-4.csv"] {
        let path = folder.join(run);
        let shifted: Vec<String> = std::fs::read_to_string(&path)
            .unwrap()
            .lines()
            .map(|l| match l.split_once(',').and_then(|(a, c)| Some((a.parse::<f64>().ok()?, c))) {
                Some((angle, code)) => format!("{},{code}", ((angle - 0.2) * 1e4).round() / 1e4),
                None => l.to_owned(),
            })
            .collect();
        std::fs::write(&path, shifted.join("\n")).unwrap();
    }
    let p = certify(&folder, &CertifyOptions::default()).unwrap();
    assert_eq!(p.verdict, "accepted", "{:?} {:?}", p.reasons, p.missing);
    let result = p.result.unwrap();
    assert!(result.misalignment.is_none() && result.covariance.is_none());
    let [a, b] = &result.mountings[..] else { panic!("{:?}", result.mountings) };
    assert_eq!((a.name.as_str(), b.name.as_str()), ("A", "B"));
    let (a, b) = (&a.misalignment, &b.misalignment);
    // True angle minus table angle: 0.2° more in B. Two runs each.
    assert!((b.value - a.value - 0.2f64.to_radians()).abs() < 1e-3, "{} {}", a.value, b.value);
    // Resolution, which repeats, has a share of 1e-9.
    assert!((a.degrees_of_freedom.unwrap() - 1.0).abs() < 1e-6);
    assert_eq!(result.bias.degrees_of_freedom.map(f64::round), Some(3.0));
}
