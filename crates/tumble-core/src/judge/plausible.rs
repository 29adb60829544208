//! Plausibility: values that an accelerometer on a table can have.
//!
//! Only the physically impossible rejects; the unusual warns. Limits of a sensor's type come with the
//! catalogue, not from here.

use super::unit::unit_is_not_the_scales;
use crate::estimate::{Estimate, Method, Parameter};
use crate::{Finding, FindingKind, Output};

/// Scale error beyond which the nominal scale belongs to another sensor, range or unit. Data sheets state ±4 to
/// ±8 %; half or twice is another range.
pub(crate) const SCALE_ERROR_LIMIT: f64 = 0.5;
/// Scale error that is unusual.
pub(crate) const SCALE_ERROR_UNUSUAL: f64 = 0.1;
/// Misalignment that no seat has (20°).
pub(crate) const MISALIGNMENT_LIMIT_RAD: f64 = 0.35;
/// Misalignment that is unusual (6°).
pub(crate) const MISALIGNMENT_UNUSUAL_RAD: f64 = 0.1;
/// Bias that is unusual: 100 mg, past the zero-g limits of data sheets (25 to 250 mg).
pub(crate) const BIAS_UNUSUAL_M_S2: f64 = 1.0;
/// Scale over nominal scale that means g for m/s²: 9.8, with room for a sensor's own scale error.
pub(crate) const UNITS_RATIO: std::ops::Range<f64> = 8.5..11.5;

/// What a run's estimates look like beside what is possible. `output` comes with the nominal scale in use.
#[must_use]
pub fn plausible(
    run: &str,
    estimate: &Estimate,
    method: Method,
    gravity_m_s2: f64,
    level: f64,
    output: (&Output, f64),
) -> Vec<Finding> {
    let look = Look { run, estimate, gravity_m_s2, level };
    if is_reversed(estimate, method) {
        return vec![look.finding(
            FindingKind::SignReversed,
            "codes fall where the angle rises".into(),
            "codes rise with the angle".into(),
            "set angle_sign = -1 in [bench] (the dial counts the other way), or turn the sensor round",
        )];
    }
    let [bias, misalignment, scale_error] = estimate.values;
    [
        scale_error.and_then(|dk| look.at_scale_error(dk, output)),
        misalignment.and_then(|dphi| look.at_misalignment(dphi)),
        bias.and_then(|b| look.at_bias(b, output.0)),
    ]
    .into_iter()
    .flatten()
    .collect()
}

/// One run's estimate, and what it is held against.
struct Look<'a> {
    run: &'a str,
    estimate: &'a Estimate,
    gravity_m_s2: f64,
    level: f64,
}

impl Look<'_> {
    fn finding(&self, kind: FindingKind, observed: String, limit: String, remedy: &str) -> Finding {
        Finding { kind, place: self.run.to_owned(), observed, limit, remedy: remedy.to_owned() }
    }

    fn factor(&self, p: Parameter) -> f64 {
        self.estimate.coverage_factor(p, self.level).unwrap_or(0.0)
    }

    /// An uncertain estimate is undetermined before it is implausible.
    fn surely_beyond(&self, p: Parameter, value: f64, limit: f64) -> bool {
        let planned = self.estimate.plan_uncertainty.map_or(0.0, |u| u[p.index()]);
        let u = self.estimate.standard_uncertainty(p).unwrap_or(0.0).max(planned);
        value.abs() - self.factor(p) * u > limit
    }

    fn at_scale_error(&self, dk: f64, (output, nominal_scale): (&Output, f64)) -> Option<Finding> {
        let ratio = 1.0 + dk;
        let parameter = Parameter::ScaleError;
        if UNITS_RATIO.contains(&ratio) || UNITS_RATIO.contains(&(1.0 / ratio)) {
            return Some(self.finding(
                FindingKind::UnitsMixedUp,
                format!("scale {ratio:.3} times the nominal one"),
                "9.8 or 1/9.8 is g taken for m/s²".into(),
                "give nominal_scale in m/s² per LSB (multiply g per LSB by 9.80665)",
            ));
        }
        let beyond = self.surely_beyond(parameter, dk, SCALE_ERROR_LIMIT)
            || (dk.abs() > SCALE_ERROR_LIMIT
                && well_known_scale(self.estimate, self.factor(parameter)));
        if beyond {
            let other_unit =
                unit_is_not_the_scales(self.run, ratio, nominal_scale, self.gravity_m_s2, output);
            return other_unit.or_else(|| Some(self.finding(
                FindingKind::ScaleImplausible,
                format!("scale error {:+.1} %", dk * 100.0),
                format!("±{:.0} %", SCALE_ERROR_LIMIT * 100.0),
                "check nominal_scale (m/s² per LSB), the sensor's range, and that the angle column holds angles in degrees",
            )));
        }
        self.surely_beyond(parameter, dk, SCALE_ERROR_UNUSUAL).then(|| {
            self.finding(
                FindingKind::Unusual,
                format!("scale error {:+.1} %", dk * 100.0),
                format!("±{:.0} %", SCALE_ERROR_UNUSUAL * 100.0),
                "check nominal_scale against the data sheet",
            )
        })
    }

    fn at_misalignment(&self, dphi: f64) -> Option<Finding> {
        if self.surely_beyond(Parameter::Misalignment, dphi, MISALIGNMENT_LIMIT_RAD) {
            return Some(self.finding(
                FindingKind::MisalignmentImpossible,
                format!("misalignment {:+.1}°", dphi.to_degrees()),
                format!("±{:.0}°", MISALIGNMENT_LIMIT_RAD.to_degrees()),
                "is the angle column a counter, or the dial's zero elsewhere? Give angles in degrees, or set angle_zero_deg",
            ));
        }
        self.surely_beyond(Parameter::Misalignment, dphi, MISALIGNMENT_UNUSUAL_RAD).then(|| {
            self.finding(
                FindingKind::Unusual,
                format!("misalignment {:+.2}°", dphi.to_degrees()),
                format!("±{:.1}°", MISALIGNMENT_UNUSUAL_RAD.to_degrees()),
                "level the table, or set angle_zero_deg",
            )
        })
    }

    fn at_bias(&self, b: f64, output: &Output) -> Option<Finding> {
        // Volts at 0 g are where the maker put them (half the supply), and no acceleration.
        let electrical = matches!(output.unit.as_str(), "V" | "mV");
        if !electrical && self.surely_beyond(Parameter::Bias, b, self.gravity_m_s2) {
            return Some(self.finding(
                FindingKind::BiasImpossible,
                format!("bias {b:+.3} m/s²"),
                format!("±{:.2} m/s²", self.gravity_m_s2),
                "check the converter's coding (signed or unsigned codes, an offset) and the angle column; codes that count from the middle of the converter's range (offset binary) want code_offset in [csv], for instance code_offset = 2048",
            ));
        }
        self.surely_beyond(Parameter::Bias, b, BIAS_UNUSUAL_M_S2).then(|| {
            self.finding(
                FindingKind::Unusual,
                format!("bias {b:+.3} m/s²"),
                format!("±{BIAS_UNUSUAL_M_S2} m/s²"),
                if electrical {
                    "volts at 0 g count as bias here (half the supply, often): hold them against the data sheet's zero-g level"
                } else {
                    "check the data sheet's zero-g limits and the converter's reference"
                },
            )
        })
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
