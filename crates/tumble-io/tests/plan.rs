//! What a plan is asked for, and what it is written as.
#![allow(clippy::unwrap_used)] // A test that cannot unwrap has failed.

use tumble_core::plan::{Criterion, Possible, Term, plan};
use tumble_core::systematic::Quantity;
use tumble_io::noise::KnownNoise;
use tumble_io::{PlanDocument, PlanSettings, plan_request, plan_toml, read_plan_file};

const BENCH: &str = r#"
format = 1
[sensor]
model = "ADXL355"
[output]
quantizer = "round"
nominal_scale = 3.8e-5
rate_hz = 100.0
[bench]
gravity = 9.8102
gravity_uncertainty = 1e-4
angle_uncertainty_arcmin = 1.0
angle_range_deg = [-60.0, 45.0]
updown_lean_arcmin = 12.0
eccentricity_arcmin = 0.5
dial_scale_uncertainty_ppm = 100.0
axis_tilt_arcmin = 5.0
sensor_lean_arcmin = 6.0
temperature_spread_k = 2.0
[plan]
hours = 1.5
step_deg = 0.5
updown = true
terms = ["k2"]
criterion = "A"
[spec]
target_bias_m_s2 = 0.002
"#;

fn written(name: &str, text: &str) -> (tempfile::TempDir, std::path::PathBuf) {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join(name);
    std::fs::write(&path, text).unwrap();
    (dir, path)
}

#[test]
fn a_bench_file_says_it_all_and_flags_go_before_it() {
    let (_dir, path) = written("bench.toml", BENCH);
    let r = plan_request(Some(&path), PlanSettings::default(), None).unwrap();
    let p = &r.problem;
    assert!((p.range.0.deg() + 60.0).abs() < 1e-9 && (p.range.1.deg() - 45.0).abs() < 1e-9);
    assert!((p.setting_scatter.arcmin() - 1.0).abs() < 1e-9);
    assert!((p.gravity.value_m_s2 - 9.8102).abs() < 1e-12);
    assert_eq!((p.upright, p.criterion), (Possible::Yes, Criterion::A));
    assert_eq!(p.further_terms, [Term::K2]);
    assert_eq!(p.targets[..3], [Some(0.002), None, None]);
    assert_eq!(p.total_s, Some(5400.0));
    let line = |q| p.systematics.of_quantity(q).unwrap();
    assert!((line(Quantity::DialScale).standard_uncertainty - 1e-4).abs() < 1e-18);
    assert_eq!(line(Quantity::DialScale).source, "stated");
    assert!((p.systematics.temperature_spread_k - 2.0).abs() < 1e-12);
    // A number of the catalogue that nobody verified counts as little as in `certify`.
    assert_eq!(line(Quantity::BiasTempco).standard_uncertainty, 0.0);
    assert!((p.upright_lean.arcmin() - 12.0).abs() < 1e-9);
    // 22.5 µg/√Hz of the catalogue over √2.
    assert!((p.noise.white_m_s2_rts / (22.5e-6 * 9.80665 / 2f64.sqrt()) - 1.0).abs() < 1e-12);
    assert_eq!(p.converter.map(|c| (c.lsb_m_s2, c.rate_hz)), Some((3.8e-5, 100.0)));
    assert!(!r.assumed.iter().any(|a| a.contains("tilt") || a.contains("gravity")), "{r:?}");

    let flags = PlanSettings {
        hours: Some(3.0),
        targets: [None, Some(1e-3), None, None, None, None, None],
        ..PlanSettings::default()
    };
    let over = plan_request(Some(&path), flags, None).unwrap().problem;
    assert_eq!(over.total_s, Some(10_800.0));
    assert_eq!(over.targets[..2], [None, Some(1e-3)]);
}

/// A verified limit of a data sheet and a record at rest take the place of what is assumed.
#[test]
fn the_catalogue_and_a_record_at_rest_are_heard() {
    let known = KnownNoise {
        rate_hz: 200.0,
        quantization_m_s: 0.0,
        white_m_s2_rts: 5e-4,
        flicker_m_s2: 3e-4,
        walk_m_s2_per_rts: 2e-5,
        ramp_m_s3: 1e-7,
        lsb_m_s2: Some(6e-4),
        rounding_m_s2_rts: Some(3e-4),
        dithered: Some(true),
    };
    let flags = PlanSettings {
        sensor: Some("MPU-6050".into()),
        known_noise: Some(known),
        ..PlanSettings::default()
    };
    let r = plan_request(None, flags.clone(), None).unwrap();
    let k2 = r.problem.systematics.of_quantity(Quantity::Quadratic).unwrap();
    assert!(k2.source.starts_with("catalogue, MPU-6050"), "{}", k2.source);
    let noise = r.problem.noise;
    // The rounding that the record holds is the converter's, and is reckoned with by itself.
    assert!((noise.white_m_s2_rts / 4e-4 - 1.0).abs() < 1e-12);
    assert_eq!((noise.flicker_m_s2, noise.walk_m_s2_rts, noise.ramp_m_s3), (3e-4, 2e-5, 1e-7));
    assert_eq!(r.problem.converter.map(|c| (c.lsb_m_s2, c.rate_hz)), Some((6e-4, 200.0)));
    assert!(!r.assumed.iter().any(|a| a.contains("noise") || a.contains("drift")), "{r:?}");
    // A figure goes before the record.
    let over = PlanSettings { noise_ug_rthz: Some(400.0), ..flags };
    let noise = plan_request(None, over, None).unwrap().problem.noise;
    assert!((noise.white_m_s2_rts / (400e-6 * 9.80665 / 2f64.sqrt()) - 1.0).abs() < 1e-12);
    assert_eq!(noise.flicker_m_s2, 3e-4);
}

#[test]
fn without_a_file_everything_is_assumed_and_said() {
    let flags = PlanSettings { sensor: Some("adxl203".into()), ..PlanSettings::default() };
    let r = plan_request(None, flags, None).unwrap();
    assert_eq!(r.sensor, "ADXL203");
    for word in ["gravity", "arcmin", "noise of 110", "K2: 100", "power-ups", "--dial-scale"] {
        assert!(r.assumed.iter().any(|a| a.contains(word)), "{word}: {:?}", r.assumed);
    }
    let unknown = PlanSettings { sensor: Some("ADXL204".into()), ..PlanSettings::default() };
    let error = plan_request(None, unknown, None).unwrap_err().to_string();
    assert!(error.contains("ADXL203"), "{error}");
}

#[test]
fn slips_name_their_line() {
    for (from, to, wanted) in [
        ("step_deg", "stepdeg", "`step_deg`"),
        ("terms = [\"k2\"]", "terms = [\"k4\"]", "k2, k3, temp-bias, temp-scale"),
        ("criterion = \"A\"", "criterion = \"E\"", "minimax, A or D"),
        ("gravity = 9.8102", "gravity = 981", "m/s²"),
        ("hours = 1.5", "hours = \"long\"", "line"),
    ] {
        let (_dir, path) = written("bench.toml", &BENCH.replace(from, to));
        let error = plan_request(Some(&path), PlanSettings::default(), None).unwrap_err();
        let text = error.to_string();
        assert!(text.contains(wanted) && text.contains("bench.toml, line"), "{to}: {text}");
    }
}

#[test]
fn a_plan_is_read_back_as_it_was_written() {
    let (_dir, path) = written("bench.toml", BENCH);
    let r = plan_request(Some(&path), PlanSettings::default(), None).unwrap();
    let document = PlanDocument::new(&r, &plan(&r.problem).unwrap());
    let (_dir, path) = written("plan.toml", &plan_toml(&document));
    let back = read_plan_file(&path).unwrap();
    let table: Vec<f64> =
        document.positions.iter().filter(|p| !p.upright).map(|p| p.angle_deg).collect();
    assert_eq!(back.angles_deg, table);
    assert_eq!((back.runs, back.dwell_s, back.updown), (document.runs, document.dwell_s, true));
    assert_eq!(back.spares_deg.len(), 3);
    for (from, to) in [
        ("format = 1", "format = 2"),
        ("runs =", "rnus ="),
        ("angles_deg = [", "angles_deg = [nan, "),
    ] {
        let (_dir, path) = written("plan.toml", &plan_toml(&document).replacen(from, to, 1));
        assert!(read_plan_file(&path).is_err(), "{to}");
    }
}
