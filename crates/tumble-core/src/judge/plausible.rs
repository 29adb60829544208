//! Plausibility: values that an accelerometer on a table can have.
//!
//! Only the physically impossible rejects; the unusual warns. Limits of a sensor's type come with the
//! catalogue, not from here.

use super::unit::unit_is_not_the_scales;
use crate::estimate::{Estimate, Method, Parameter};
use crate::{Finding, FindingKind, Output, Run};

/// Scale error beyond which the nominal scale belongs to another sensor, range or unit. Data sheets state ±4 to
/// ±8 %; half or twice is another range.
const SCALE_ERROR_LIMIT: f64 = 0.5;
/// Scale error that is unusual.
const SCALE_ERROR_UNUSUAL: f64 = 0.1;
/// Misalignment that no seat has (20°).
const MISALIGNMENT_LIMIT_RAD: f64 = 0.35;
/// Misalignment that is unusual (6°).
const MISALIGNMENT_UNUSUAL_RAD: f64 = 0.1;
/// Bias that is unusual: 100 mg, past the zero-g limits of data sheets (25 to 250 mg).
const BIAS_UNUSUAL_M_S2: f64 = 1.0;
/// Scale over nominal scale that means g for m/s²: 9.8, with room for a sensor's own scale error.
const UNITS_RATIO: std::ops::Range<f64> = 8.5..11.5;

/// What a run's estimates look like beside what is possible.
#[must_use]
pub fn plausible(
    run: &str,
    estimate: &Estimate,
    method: Method,
    gravity_m_s2: f64,
    level: f64,
    (output, nominal_scale): (&Output, f64),
) -> Vec<Finding> {
    let [bias, misalignment, scale_error] = estimate.values;
    let factor = |p: Parameter| estimate.coverage_factor(p, level).unwrap_or(0.0);
    // An uncertain estimate is undetermined before it is implausible.
    let surely_beyond = |p: Parameter, value: f64, limit: f64| {
        let planned = estimate.plan_uncertainty.map_or(0.0, |u| u[p.index()]);
        let u = estimate.standard_uncertainty(p).unwrap_or(0.0).max(planned);
        value.abs() - factor(p) * u > limit
    };
    let finding = |kind, observed: String, limit: String, remedy: &str| Finding {
        kind,
        place: run.to_owned(),
        observed,
        limit,
        remedy: remedy.to_owned(),
    };
    if is_reversed(estimate, method) {
        return vec![finding(
            FindingKind::SignReversed,
            "codes fall where the angle rises".into(),
            "codes rise with the angle".into(),
            "set angle_sign = -1 in [bench] (the dial counts the other way), or turn the sensor round",
        )];
    }
    let mut findings = Vec::new();
    if let Some(dk) = scale_error {
        let ratio = 1.0 + dk;
        if UNITS_RATIO.contains(&ratio) || UNITS_RATIO.contains(&(1.0 / ratio)) {
            findings.push(finding(
                FindingKind::UnitsMixedUp,
                format!("scale {ratio:.3} times the nominal one"),
                "9.8 or 1/9.8 is g taken for m/s²".into(),
                "give nominal_scale in m/s² per LSB (multiply g per LSB by 9.80665)",
            ));
        } else if surely_beyond(Parameter::ScaleError, dk, SCALE_ERROR_LIMIT)
            || (dk.abs() > SCALE_ERROR_LIMIT
                && well_known_scale(estimate, factor(Parameter::ScaleError)))
        {
            let other_unit =
                unit_is_not_the_scales(run, ratio, nominal_scale, gravity_m_s2, output);
            findings.push(other_unit.unwrap_or_else(|| finding(
                FindingKind::ScaleImplausible,
                format!("scale error {:+.1} %", dk * 100.0),
                format!("±{:.0} %", SCALE_ERROR_LIMIT * 100.0),
                "check nominal_scale (m/s² per LSB), the sensor's range, and that the angle column holds angles in degrees",
            )));
        } else if surely_beyond(Parameter::ScaleError, dk, SCALE_ERROR_UNUSUAL) {
            findings.push(finding(
                FindingKind::Unusual,
                format!("scale error {:+.1} %", dk * 100.0),
                format!("±{:.0} %", SCALE_ERROR_UNUSUAL * 100.0),
                "check nominal_scale against the data sheet",
            ));
        }
    }
    if let Some(dphi) = misalignment {
        if surely_beyond(Parameter::Misalignment, dphi, MISALIGNMENT_LIMIT_RAD) {
            findings.push(finding(
                FindingKind::MisalignmentImpossible,
                format!("misalignment {:+.1}°", dphi.to_degrees()),
                format!("±{:.0}°", MISALIGNMENT_LIMIT_RAD.to_degrees()),
                "is the angle column a counter, or the dial's zero elsewhere? Give angles in degrees, or set angle_zero_deg",
            ));
        } else if surely_beyond(Parameter::Misalignment, dphi, MISALIGNMENT_UNUSUAL_RAD) {
            findings.push(finding(
                FindingKind::Unusual,
                format!("misalignment {:+.2}°", dphi.to_degrees()),
                format!("±{:.1}°", MISALIGNMENT_UNUSUAL_RAD.to_degrees()),
                "level the table, or set angle_zero_deg",
            ));
        }
    }
    if let Some(b) = bias {
        if surely_beyond(Parameter::Bias, b, gravity_m_s2) {
            findings.push(finding(
                FindingKind::BiasImpossible,
                format!("bias {b:+.3} m/s²"),
                format!("±{gravity_m_s2:.2} m/s²"),
                "check the converter's coding (signed or unsigned codes, an offset) and the angle column",
            ));
        } else if surely_beyond(Parameter::Bias, b, BIAS_UNUSUAL_M_S2) {
            findings.push(finding(
                FindingKind::Unusual,
                format!("bias {b:+.3} m/s²"),
                format!("±{BIAS_UNUSUAL_M_S2} m/s²"),
                "check the data sheet's zero-g limits and the converter's reference",
            ));
        }
    }
    findings
}

/// Where some runs are reversed and others are not, the dial counts as it should: each reversed run is told what it
/// needs itself.
pub fn some_runs_reversed(findings: &mut [Finding], runs: &[Run]) {
    let reversed: Vec<&str> = findings
        .iter()
        .filter(|f| f.kind == FindingKind::SignReversed)
        .map(|f| f.place.as_str())
        .collect();
    let against = |name: &str| reversed.contains(&name);
    if reversed.is_empty() || runs.iter().all(|r| against(&r.name)) {
        return;
    }
    let direction = |run: &Run| {
        run.positions.iter().find_map(|p| p.record.dial.as_ref()).map(|d| d.direction.signum())
    };
    let of_others = runs.iter().find(|r| !against(&r.name)).and_then(direction);
    let remedies: Vec<(String, String)> = runs
        .iter()
        .filter(|r| against(&r.name))
        .map(|r| {
            let is_turned = direction(r).zip(of_others).is_some_and(|(a, b)| a != b);
            let remedy = if is_turned {
                "the other runs are not reversed: take orientation = \"reversed\" out of its [[run]], or correct the sign of the angles in its file"
            } else {
                "the other runs are not reversed: if the body was turned by 180°, set orientation = \"reversed\" in its [[run]]; if its angles are typed with the other sign, correct them in its file"
            };
            (r.name.clone(), remedy.to_owned())
        })
        .collect();
    for f in findings.iter_mut().filter(|f| f.kind == FindingKind::SignReversed) {
        if let Some((_, remedy)) = remedies.iter().find(|(name, _)| *name == f.place) {
            f.remedy.clone_from(remedy);
        }
    }
}

/// Whether the scale factor itself is known to a tenth, however absurd the nominal one is: a scale given upside
/// down (LSB per m/s²) makes every relative uncertainty look small or large.
fn well_known_scale(estimate: &Estimate, factor: f64) -> bool {
    let (u, dk) = (estimate.standard_uncertainty(Parameter::ScaleError), estimate.values[2]);
    u.zip(dk).is_some_and(|(u, dk)| factor * u < 0.1 * (1.0 + dk).abs())
}

/// The exact form shows a reversed axis as a misalignment beyond 90°, the paper's as a negative scale.
fn is_reversed(estimate: &Estimate, method: Method) -> bool {
    let [_, misalignment, scale_error] = estimate.values;
    match method {
        Method::Exact | Method::Likelihood => {
            misalignment.is_some_and(|m| m.abs() > core::f64::consts::FRAC_PI_2)
        }
        Method::Paper => scale_error.is_some_and(|s| s < -1.0),
    }
}
