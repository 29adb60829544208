//! What a plan is asked for, and what it is written as.
#![allow(clippy::unwrap_used)] // A test that cannot unwrap has failed.

use tumble_core::plan::{Criterion, Possible, Term, plan};
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
[plan]
hours = 1.5
step_deg = 0.5
updown = true
terms = ["k2"]
criterion = "A"
eccentricity_arcmin = 0.5
dial_scale_uncertainty_ppm = 100.0
axis_tilt_arcmin = 5.0
sensor_lean_arcmin = 6.0
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
    assert!((p.systematics.dial_scale - 1e-4).abs() < 1e-18);
    assert!((p.systematics.upright_lean.arcmin() - 12.0).abs() < 1e-9);
    // 22.5 µg/√Hz of the catalogue over √2.
    assert!((p.noise.white_m_s2_rts / (22.5e-6 * 9.80665 / 2f64.sqrt()) - 1.0).abs() < 1e-12);
    assert_eq!(p.converter.map(|c| (c.lsb_m_s2, c.rate_hz)), Some((3.8e-5, 100.0)));
    assert!(!r.assumed.iter().any(|a| a.contains("tilt") || a.contains("gravity")), "{r:?}");

    let flags = PlanSettings {
        hours: Some(3.0),
        targets: [None, Some(1e-3), None, None, None, None],
        ..PlanSettings::default()
    };
    let over = plan_request(Some(&path), flags, None).unwrap().problem;
    assert_eq!(over.total_s, Some(10_800.0));
    assert_eq!(over.targets[..2], [None, Some(1e-3)]);
}

#[test]
fn without_a_file_everything_is_assumed_and_said() {
    let flags = PlanSettings { sensor: Some("adxl203".into()), ..PlanSettings::default() };
    let r = plan_request(None, flags, None).unwrap();
    assert_eq!(r.sensor, "ADXL203");
    for word in ["gravity", "arcmin", "noise of 110", "nonlinearity", "power-ups"] {
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
        ("terms = [\"k2\"]", "terms = [\"k4\"]", "k2, k3 or temperature"),
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
