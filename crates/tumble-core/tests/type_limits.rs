//! Limits of the sensor's type: each check on both sides of its limit, and the silence where nothing is known.
#![allow(clippy::unwrap_used)] // A test that cannot unwrap has failed.

use tumble_core::assess::{
    Influence, InfluenceTest, Interval, PooledParameter, RunAssessment, Verdict, assess,
};
use tumble_core::estimate::{EstimateOptions, Parameter};
use tumble_core::judge::{Judged, type_limits};
use tumble_core::simulate::{Preset, Truth, experiment};
use tumble_core::{
    Experiment, Finding, FindingKind, LimitOf, Mark, Quantizer, SensitivityUnit, SensorMode,
    SensorType, TypeLimit,
};

const GN: f64 = 9.806_65;
const MG: f64 = GN / 1000.0;

fn limit(of: LimitOf, axes: &str, typical: Option<f64>, maximum: Option<f64>) -> TypeLimit {
    TypeLimit {
        of,
        axes: Some(axes.to_owned()).filter(|a| !a.is_empty()),
        mode: None,
        typical,
        maximum,
        mark: Mark::Recalled,
        note: String::new(),
    }
}

fn mode(name: &str, sensitivity: f64, unit: SensitivityUnit, tolerance: Option<f64>) -> SensorMode {
    SensorMode {
        name: name.into(),
        range_gn: None,
        sensitivity,
        unit,
        mark: Mark::Verified,
        tolerance: tolerance.map(|t| (t, Mark::Recalled)),
    }
}

/// A made-up digital part: no limit of these tests comes from a unit that somebody measured.
fn digital() -> SensorType {
    SensorType {
        model: "PART-1".into(),
        source: "a data sheet".into(),
        catalogue: "built-in".into(),
        ratiometric: false,
        modes: vec![
            mode("low", 1000.0, SensitivityUnit::LsbPerG, Some(0.05)),
            mode("high", 300.0, SensitivityUnit::LsbPerG, Some(0.05)),
            mode("loose", 70.0, SensitivityUnit::LsbPerG, None),
        ],
        limits: vec![
            limit(LimitOf::ZeroG, "XY", Some(20.0), Some(50.0)),
            limit(LimitOf::ZeroG, "Z", Some(30.0), None),
            limit(LimitOf::ZeroGTempco, "", None, Some(0.5)),
            limit(LimitOf::NoiseDensity, "", Some(100.0), None),
        ],
    }
}

fn analogue() -> SensorType {
    SensorType {
        ratiometric: true,
        modes: vec![
            mode("5 V", 1000.0, SensitivityUnit::MillivoltPerG, Some(0.04)),
            mode("3 V", 560.0, SensitivityUnit::MillivoltPerG, None),
        ],
        ..digital()
    }
}

/// What is judged, in numbers that a test can set.
#[derive(Clone)]
struct Unit {
    kind: Option<SensorType>,
    axis: &'static str,
    unit: &'static str,
    /// m/s² per LSB, with relative expanded uncertainty.
    scale: f64,
    u_scale: f64,
    bias_mg: f64,
    u_bias_mg: f64,
    /// Standard deviation of single readings, LSB.
    noise_lsb: Option<f64>,
    quantizer: Quantizer,
    rate_hz: Option<f64>,
    tempco_mg_per_k: Option<f64>,
}

impl Default for Unit {
    fn default() -> Self {
        Self {
            kind: Some(digital()),
            axis: "X",
            unit: "LSB",
            scale: GN / 1000.0,
            u_scale: 0.001,
            bias_mg: 0.0,
            u_bias_mg: 1.0,
            noise_lsb: None,
            quantizer: Quantizer::Round,
            rate_hz: None,
            tempco_mg_per_k: None,
        }
    }
}

fn blank() -> Experiment {
    experiment(&Truth { runs: 0, dwell_s: 0.1, ..Preset::Paper3.truth() })
}

fn pooled(parameter: Parameter, value: f64, expanded: f64) -> PooledParameter {
    PooledParameter {
        dominant: None,
        parameter,
        mounting: None,
        runs: 3,
        value,
        u_statistical: expanded / 2.0,
        dof_statistical: 60.0,
        u_budget: 0.0,
        standard_uncertainty: expanded / 2.0,
        degrees_of_freedom: 60.0,
        coverage_factor: 2.0,
        expanded_uncertainty: expanded,
        interval: Interval::around(value, expanded),
        prediction_interval: None,
        prediction_true_interval: None,
        between_run_sd: None,
        between_runs: None,
        intersection: None,
        run_weights: Vec::new(),
        pair_weight: 0.0,
    }
}

fn judged(u: &Unit) -> Vec<Finding> {
    let mut e = blank();
    e.sensor.kind = u.kind.clone();
    e.sensor.axis = u.axis.into();
    e.output.unit = u.unit.into();
    e.output.quantizer = u.quantizer;
    e.output.rate_hz = u.rate_hz;
    // k0 half of k*: what is judged must be the scale factor, not the scale error.
    let k0 = u.scale / 2.0;
    let all = [
        pooled(Parameter::Bias, u.bias_mg * MG, u.u_bias_mg * MG),
        pooled(Parameter::ScaleError, 1.0, 2.0 * u.u_scale),
    ];
    let runs = [RunAssessment {
        effects: None,
        name: "run-1".into(),
        mounting: "A".into(),
        orientation: tumble_core::Orientation::Normal,
        estimate: None,
        mean_codes: Vec::new(),
        temperatures_degc: Vec::new(),
        reading_std_lsb: u.noise_lsb,
    }];
    let influence = Influence {
        temperature: u.tempco_mg_per_k.map(|t| InfluenceTest {
            effect: t * MG,
            expanded_uncertainty: 0.1 * MG,
            p_value: 1e-6,
            smallest_detectable: 0.1 * MG,
            unit: "m/s² per K",
        }),
        ..Influence::default()
    };
    type_limits(&Judged {
        experiment: &e,
        nominal_scale_m_s2_per_lsb: k0,
        runs: &runs,
        pooled: &all,
        influence: &influence,
    })
}

fn places(u: &Unit) -> Vec<String> {
    judged(u).into_iter().map(|f| f.place).collect()
}

#[test]
fn sensitivity_against_the_nearest_mode() {
    let at = |lsb_per_g: f64| Unit { scale: GN / lsb_per_g, ..Unit::default() };
    for (name, unit, outside) in [
        ("nominal", at(1000.0), false),
        ("4.8 % high", at(1048.0), false),
        ("4.8 % low", at(952.0), false),
        ("5.3 % high", at(1053.0), true),
        ("5.3 % low", at(947.0), true),
        ("5.3 % high, and not known better than 1 %", Unit { u_scale: 0.01, ..at(1053.0) }, false),
        ("the other mode", at(300.0), false),
        ("the other mode, 6 % low", at(282.0), true),
        ("a mode without a tolerance", at(66.0), false),
        ("four bits to the left", at(16_000.0), false),
        ("two bits to the right", at(250.0), false),
        ("four bits to the left and 6 % high", at(16_960.0), true),
        ("no type", Unit { kind: None, ..at(1053.0) }, false),
        ("in volts: another converter", Unit { unit: "V", ..at(1053.0) }, false),
        ("converted to g", Unit { unit: "g", scale: GN, ..Unit::default() }, false),
        ("converted to g, 7 % off", Unit { unit: "g", scale: GN * 1.07, ..Unit::default() }, true),
        ("converted to m/s²", Unit { unit: "m/s²", scale: 1.0, ..Unit::default() }, false),
    ] {
        let expected: &[&str] = if outside { &["scale factor"] } else { &[] };
        assert_eq!(places(&unit), expected, "{name}");
    }
}

#[test]
fn an_analogue_part_is_judged_in_volts_only() {
    let at = |unit, scale| Unit { kind: Some(analogue()), unit, scale, ..Unit::default() };
    for (name, unit, outside) in [
        ("nominal", at("V", GN), false),
        ("5 % off", at("V", GN / 1.05), true),
        ("5 % off, in mV", at("mV", GN / 1050.0), true),
        ("at 3 V, no tolerance", at("V", GN / 0.58), false),
        ("through an unknown converter", at("LSB", 0.007_69), false),
        // Twice the sensitivity is no shifted word here: the nearest mode has it outside.
        ("twice", at("V", GN / 2.0), true),
    ] {
        let expected: &[&str] = if outside { &["scale factor"] } else { &[] };
        assert_eq!(places(&unit), expected, "{name}");
    }
    let f = &judged(&at("V", GN / 1.05))[0];
    assert!(f.remedy.contains("follows the supply"), "{}", f.remedy);
}

#[test]
fn zero_g_by_axis_with_its_uncertainty() {
    let at = |bias_mg, axis| Unit { bias_mg, axis, ..Unit::default() };
    for (name, unit, outside) in [
        ("inside", at(48.0, "X"), false),
        ("negative inside", at(-48.0, "Y"), false),
        ("touching", at(50.5, "X"), false),
        ("outside", at(51.5, "X"), true),
        ("negative outside", at(-51.5, "-y axis"), true),
        ("outside, hardly known", Unit { u_bias_mg: 5.0, ..at(51.5, "X") }, false),
        ("three times the typical of Z", at(88.0, "Z"), false),
        ("beyond three times the typical of Z", at(92.0, "Z"), true),
        // Where the axis is unknown a maximum goes before what is typical.
        ("unknown axis", at(51.5, "roll"), true),
        ("through an unknown converter", Unit { kind: Some(analogue()), ..at(60.0, "X") }, true),
    ] {
        let expected: &[&str] = if outside { &["bias"] } else { &[] };
        assert_eq!(places(&unit), expected, "{name}");
    }
}

#[test]
fn noise_far_from_the_density_on_either_side() {
    // 100 µg/√Hz: floor 33.3, ceiling 376 µg/√Hz. At 1 mg per LSB and 50 samples/s a density of 1 µg/√Hz is 5 µg.
    let at = |density: f64| Unit {
        noise_lsb: Some(density * 5e-3),
        quantizer: Quantizer::None,
        rate_hz: Some(50.0),
        ..Unit::default()
    };
    for (name, unit, outside) in [
        ("the data sheet's", at(100.0), false),
        ("a third", at(35.0), false),
        ("less than a third", at(32.0), true),
        ("three times through a one-pole filter", at(370.0), false),
        ("more", at(380.0), true),
        ("no rate", Unit { rate_hz: None, ..at(380.0) }, false),
        (
            "codes that do not dither say nothing",
            Unit { quantizer: Quantizer::Round, ..at(10.0) },
            false,
        ),
        ("codes that dither do", Unit { quantizer: Quantizer::Round, ..at(400.0) }, true),
    ] {
        let expected: &[&str] = if outside { &["run-1"] } else { &[] };
        assert_eq!(places(&unit), expected, "{name}");
    }
}

#[test]
fn temperature_against_the_tempco() {
    let at = |t| Unit { tempco_mg_per_k: Some(t), ..Unit::default() };
    for (unit, outside) in [(at(0.45), false), (at(0.55), false), (at(-0.65), true)] {
        let expected: &[&str] = if outside { &["temperature"] } else { &[] };
        assert_eq!(places(&unit), expected);
    }
}

#[test]
fn every_finding_names_model_limit_unit_mark_source_and_cure() {
    let unit = Unit {
        scale: GN / 1053.0,
        bias_mg: 80.0,
        noise_lsb: Some(50.0),
        quantizer: Quantizer::None,
        rate_hz: Some(50.0),
        tempco_mg_per_k: Some(2.0),
        ..Unit::default()
    };
    let findings = judged(&unit);
    assert_eq!(findings.len(), 4);
    for (f, unit) in findings.iter().zip(["LSB/g", "mg", "µg/√Hz", "mg/K"]) {
        assert_eq!(f.kind, FindingKind::OutsideTypeLimits);
        for words in ["PART-1", "not verified", "a data sheet", "built-in", unit] {
            assert!(f.limit.contains(words), "{words}: {f:?}");
        }
        assert!(f.observed.contains("recalled, not verified"), "{f:?}");
        assert!(f.remedy.len() > 40 && !f.observed.is_empty(), "{f:?}");
        // Findings of Tumble itself stay below 500 characters.
        assert!(f.limit.chars().count() < 300, "{f:?}");
    }
    let mut verified = digital();
    verified.limits.iter_mut().for_each(|l| l.mark = Mark::Verified);
    let f = &judged(&Unit { kind: Some(verified), bias_mg: 80.0, ..Unit::default() })[0];
    assert!(f.limit.contains("verified") && !f.limit.contains("not verified"), "{}", f.limit);
}

/// An experiment of the paper's bench whose sensor is of a type.
fn measured(truth: Truth, kind: SensorType) -> Experiment {
    let mut e = experiment(&truth);
    e.sensor.kind = Some(kind);
    e
}

#[test]
fn limits_warn_and_never_reject() {
    // 1.2 LSB of 0.00769 m/s² at 50 samples/s are 188 µg/√Hz.
    let truth = Truth {
        dwell_s: 2.0,
        runs: 2,
        bias_m_s2: 0.9,
        angles_deg: (-6..=6).map(|i| f64::from(i) * 10.0).collect(),
        ..Preset::Paper3.truth()
    };
    let a = assess(&measured(truth.clone(), analogue()), &EstimateOptions::default()).unwrap();
    let found: Vec<&Finding> =
        a.findings.iter().filter(|f| f.kind == FindingKind::OutsideTypeLimits).collect();
    assert_eq!(found.iter().map(|f| f.place.as_str()).collect::<Vec<_>>(), ["bias"]);
    assert_eq!(a.verdict, Verdict::Accepted, "{:#?}", a.findings);
    // The likelihood tells noise from quantization: a part of 10 µg/√Hz has not so much of it, one of a
    // thousand not so little.
    for density in [10.0, 1000.0] {
        let mut kind = analogue();
        kind.limits = vec![limit(LimitOf::NoiseDensity, "", Some(density), None)];
        let quiet = Truth { bias_m_s2: 0.0, ..truth.clone() };
        let a = assess(&measured(quiet, kind), &EstimateOptions::default()).unwrap();
        let found: Vec<&str> = a
            .findings
            .iter()
            .filter(|f| f.kind == FindingKind::OutsideTypeLimits)
            .map(|f| f.place.as_str())
            .collect();
        assert_eq!(found, ["run-1", "run-2"], "{density}");
        assert_eq!(a.verdict, Verdict::Accepted);
    }
}

#[test]
fn a_rejected_or_undetermined_experiment_is_not_held_against_limits() {
    let reversed = Truth {
        dwell_s: 2.0,
        runs: 2,
        angles_deg: (-6..=6).map(|i| f64::from(i) * 10.0).collect(),
        ..Preset::Paper3.truth()
    };
    let mut kind = analogue();
    kind.limits = vec![limit(LimitOf::ZeroG, "", None, Some(0.01))];
    let mut e = measured(reversed.clone(), kind.clone());
    for run in &mut e.runs {
        for p in &mut run.positions {
            p.angle = tumble_core::Angle::from_rad(-p.angle.rad());
        }
    }
    let outside = |e: &Experiment| {
        let a = assess(e, &EstimateOptions::default()).unwrap();
        a.findings.iter().any(|f| f.kind == FindingKind::OutsideTypeLimits)
    };
    assert!(!outside(&e), "reversed");
    // ±5°: the bias is not known to many mg, whatever the covariance says.
    kind.limits = vec![limit(LimitOf::ZeroG, "", None, Some(5.0))];
    for seed in 0..5 {
        let narrow = Truth {
            angles_deg: (-5..=5).map(f64::from).collect(),
            runs: 1,
            seed,
            ..reversed.clone()
        };
        assert!(!outside(&measured(narrow, kind.clone())), "narrow, seed {seed}");
    }
}
