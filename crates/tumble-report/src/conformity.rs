//! The decision on the unit in words and numbers, for the terminal and the page.

use tumble_io::passport::{Conformity, ParameterConformity, Passport};

use crate::numbers::{NONE, fixed, significant, value_with_uncertainty};
use crate::standing::Standing;
use crate::units::{Parameter, Unit, Units};
use crate::words::{parameter, shortened};

/// Quantities that were judged, where their values may be shown.
pub(crate) fn judged(p: &Passport) -> &[ParameterConformity] {
    if Standing::of(p).has_coefficients() { &p.conformity.parameters } else { &[] }
}

/// `conditional pass`.
pub(crate) fn status(name: &str) -> String {
    shortened(&name.replace('_', " "), 24)
}

/// `guarded acceptance, guard band 1 U (95 %)`.
pub(crate) fn rule(c: &Conformity) -> String {
    let name = match c.rule.as_deref() {
        Some("simple") => "simple acceptance".to_owned(),
        Some("guarded") => "guarded acceptance".to_owned(),
        Some("non-binary") => "non-binary rule".to_owned(),
        other => shortened(other.unwrap_or("rule not stated"), 24),
    };
    match c.guard_band.filter(|r| *r != 0.0) {
        Some(r) => {
            let level = c.level.map_or_else(String::new, |l| format!(" ({})", percent(l)));
            format!("{name}, guard band {} U{level}", trimmed(&significant(r, 3)))
        }
        None => format!("{name}, no guard band"),
    }
}

/// A probability in per cent, three digits; small ones as a power of ten.
pub(crate) fn percent(p: f64) -> String {
    if p > 0.0 && p < 1e-6 {
        return significant(p, 1);
    }
    format!("{} %", trimmed(&significant(100.0 * p, 3)))
}

/// A probability near 1: never rounded up to certainty.
pub(crate) fn nearly_certain(p: f64) -> String {
    if p < 1.0 && p > 0.9999 { "> 99.99 %".into() } else { format!("{} %", fixed(100.0 * p, 2)) }
}

fn trimmed(text: &str) -> &str {
    if text.contains('.') && !text.contains('e') {
        text.trim_end_matches('0').trim_end_matches('.')
    } else {
        text
    }
}

/// A quantity against its limits, in a unit of display.
pub(crate) struct Line {
    pub name: String,
    /// Fits the first column of the terminal.
    pub short_name: &'static str,
    pub unit: String,
    /// `value ± U`.
    pub value: String,
    pub limits: String,
    pub acceptance: String,
    pub status: String,
    pub conforms: String,
    /// Of this decision; absent where nothing was decided.
    pub risk: Option<String>,
    /// Consumer's, of the rule.
    pub worst_case: String,
    pub ratio: String,
}

impl Line {
    pub fn of(q: &ParameterConformity, units: &Units) -> Self {
        let (short_name, unit) = match q.parameter.as_str() {
            "bias" => ("bias", units.parameter(Parameter::Bias).clone()),
            "misalignment" => ("misalignment", units.parameter(Parameter::Misalignment).clone()),
            "scale_error" => ("scale error", units.parameter(Parameter::ScaleError).clone()),
            "scale_factor" => ("scale factor", units.scale_factor.clone()),
            // Of a later version: as it stands, in its own unit.
            _ => ("other", Unit { factor: 1.0, name: shortened(&q.unit, 16) }),
        };
        let name = shortened(parameter(&q.parameter), 24);
        Self {
            name: match &q.mounting {
                Some(m) => format!("{name} ({})", shortened(m, 16)),
                None => name,
            },
            short_name,
            value: value_with_uncertainty(unit.of(q.value), unit.of(q.expanded_uncertainty)),
            limits: between(q.limits, &unit, 7),
            acceptance: q
                .acceptance_limits
                .map_or_else(|| "no room between guard bands".into(), |a| between(a, &unit, 5)),
            unit: unit.name,
            status: status(&q.status),
            conforms: nearly_certain(q.probability_of_conformity),
            risk: q.risk.map(percent),
            worst_case: q.worst_case_risk.consumer.map_or_else(|| NONE.into(), percent),
            ratio: q.test_uncertainty_ratio.map_or_else(|| NONE.into(), |r| significant(r, 2)),
        }
    }
}

/// `-0.25 to 0.25`, `at most 0.25`, `at least -0.25`.
fn between(ends: [Option<f64>; 2], unit: &Unit, digits: i32) -> String {
    let shown = |v: f64| trimmed(&significant(unit.of(v), digits)).to_owned();
    match ends {
        [Some(low), Some(high)] => format!("{} to {}", shown(low), shown(high)),
        [None, Some(high)] => format!("at most {}", shown(high)),
        [Some(low), None] => format!("at least {}", shown(low)),
        [None, None] => NONE.into(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn probabilities_never_round_to_certainty() {
        assert_eq!(nearly_certain(0.788_700_45), "78.87 %");
        assert_eq!(nearly_certain(0.999_999), "> 99.99 %");
        assert_eq!(nearly_certain(1.0), "100.00 %");
        assert_eq!(percent(0.025), "2.5 %");
        assert_eq!(percent(9.87e-10), "1e-9");
        assert_eq!(percent(0.0), "0 %");
    }

    #[test]
    fn limits_in_words() {
        let unit = Unit { factor: 1e6, name: "ppm".into() };
        assert_eq!(between([Some(-0.001), Some(0.0025)], &unit, 7), "-1000 to 2500");
        assert_eq!(between([None, Some(0.001)], &unit, 7), "at most 1000");
        assert_eq!(between([Some(-0.001), None], &unit, 7), "at least -1000");
    }
}
