//! The limits of `[spec]`: units that people have, one notation each, every refusal with its key.

use tumble_core::decision::{
    GuardMultiple, Limits, Production, Quantity, Requirement, Rule, Specification,
};
use tumble_core::estimate::Parameter;
use tumble_core::{ARCMIN_RAD, STANDARD_GRAVITY_M_S2};

use super::settings::value;
use crate::error::ReadError;
use crate::experiment_file::{LimitsValue, SpecTable};

/// Numbers of anything: beyond, somebody mistyped a power of ten.
const LARGEST: f64 = 1e6;

/// The keys of one quantity: limits with their units in SI, and what is known of the production.
struct Keys<'t> {
    quantity: Quantity,
    limits: Vec<(&'static str, Option<&'t LimitsValue>, f64)>,
    prior: (&'static str, Option<[f64; 2]>),
}

fn keys(t: &SpecTable) -> [Keys<'_>; 4] {
    [
        Keys {
            quantity: Quantity::Parameter(Parameter::Bias),
            limits: vec![
                ("bias_limits_m_s2", t.bias_limits_m_s2.as_ref(), 1.0),
                ("bias_limits_mg", t.bias_limits_mg.as_ref(), 1e-3 * STANDARD_GRAVITY_M_S2),
            ],
            prior: ("prior_bias_m_s2", t.prior_bias_m_s2),
        },
        Keys {
            quantity: Quantity::Parameter(Parameter::Misalignment),
            limits: vec![
                ("misalignment_limits_rad", t.misalignment_limits_rad.as_ref(), 1.0),
                ("misalignment_limits_arcmin", t.misalignment_limits_arcmin.as_ref(), ARCMIN_RAD),
            ],
            prior: ("prior_misalignment_rad", t.prior_misalignment_rad),
        },
        Keys {
            quantity: Quantity::Parameter(Parameter::ScaleError),
            limits: vec![
                ("scale_error_limits", t.scale_error_limits.as_ref(), 1.0),
                ("scale_error_limits_percent", t.scale_error_limits_percent.as_ref(), 1e-2),
                ("scale_error_limits_ppm", t.scale_error_limits_ppm.as_ref(), 1e-6),
            ],
            prior: ("prior_scale_error", t.prior_scale_error),
        },
        Keys {
            quantity: Quantity::ScaleFactor,
            limits: vec![("scale_factor_limits", t.scale_factor_limits.as_ref(), 1.0)],
            prior: ("prior_scale_factor", t.prior_scale_factor),
        },
    ]
}

/// What `[spec]` asks of the unit.
pub(super) fn specification(table: &SpecTable) -> Result<Specification, ReadError> {
    let mut out = Specification::new(name(table)?, rule(table)?);
    for keys in keys(table) {
        let mut given = keys.limits.iter().filter_map(|(k, v, unit)| v.map(|v| (*k, v, *unit)));
        let first = given.next();
        if let (Some((one, ..)), Some((other, ..))) = (first, given.next()) {
            return Err(spec(other, "given twice", &format!("{one} or {other}, not both")));
        }
        let (prior_key, prior) = keys.prior;
        let production = prior.map(|p| production(prior_key, p)).transpose()?;
        match first {
            Some((key, v, unit)) => {
                let limits = limits(keys.quantity, key, v, unit)?;
                out.require(keys.quantity, Requirement { limits, production });
            }
            None if production.is_some() => {
                let key = keys.limits.first().map_or("limits", |(k, ..)| *k);
                return Err(spec(
                    prior_key,
                    "given without limits",
                    &format!("{key} with it, or leave it out: risks are risks of missing limits"),
                ));
            }
            None => {}
        }
    }
    Ok(out)
}

fn spec(key: &str, given: impl ToString, expected: &str) -> ReadError {
    value(&format!("[spec] {key}"), given, expected)
}

fn name(table: &SpecTable) -> Result<Option<String>, ReadError> {
    let longest = Specification::LONGEST_NAME;
    match &table.specification {
        Some(name) if name.trim().is_empty() || name.chars().count() > longest => Err(spec(
            "specification",
            format!("a text of {} characters", name.chars().count()),
            &format!(
                "title and edition of the document that the limits come from, 1 to {longest} characters"
            ),
        )),
        other => Ok(other.as_ref().map(|n| n.trim().to_owned())),
    }
}

fn rule(table: &SpecTable) -> Result<Rule, ReadError> {
    let multiple = match table.guard_band {
        None => GuardMultiple::ONE_U,
        Some(r) => GuardMultiple::new(r).ok_or_else(|| {
            spec(
                "guard_band",
                r,
                &format!(
                    "a multiple of U above 0 and up to {}, for instance 1.0; without a guard band write decision_rule = \"simple\"",
                    GuardMultiple::LARGEST
                ),
            )
        })?,
    };
    match table.decision_rule.as_deref() {
        None | Some("guarded") => Ok(Rule::Guarded(multiple)),
        Some("non-binary") => Ok(Rule::NonBinary(multiple)),
        Some("simple") => match table.guard_band {
            None => Ok(Rule::Simple),
            Some(r) => Err(spec(
                "guard_band",
                r,
                "it with decision_rule = \"guarded\" or \"non-binary\", or leave it out: simple acceptance has none",
            )),
        },
        Some(other) => {
            Err(spec("decision_rule", other, "\"simple\", \"guarded\" or \"non-binary\""))
        }
    }
}

fn limits(quantity: Quantity, key: &str, v: &LimitsValue, unit: f64) -> Result<Limits, ReadError> {
    let expected = "[lowest, highest] with the lowest first; -inf or inf leaves a side open, a single number x stands for -x to x";
    let (given, [lower, upper]) = match *v {
        LimitsValue::Around(x) if quantity == Quantity::ScaleFactor => {
            let expected =
                "[lowest, highest] in m/s² per LSB: a scale factor does not lie around zero";
            return Err(spec(key, x, expected));
        }
        LimitsValue::Around(x) => (x.to_string(), [-x, x]),
        LimitsValue::Between(both) => (format!("[{}, {}]", both[0], both[1]), both),
    };
    // An end is a number of possible size, or open: -inf below, inf above.
    let end = |v: f64, open: f64| match v {
        v if v == open => Some(None),
        v if v.abs() <= LARGEST => Some(Some(v * unit)),
        _ => None,
    };
    let ends = end(lower, f64::NEG_INFINITY).zip(end(upper, f64::INFINITY));
    ends.and_then(|(lower, upper)| Limits::new(lower, upper))
        .ok_or_else(|| spec(key, given, expected))
}

fn production(key: &str, [mean, sd]: [f64; 2]) -> Result<Production, ReadError> {
    let possible = mean.abs() <= LARGEST && sd <= LARGEST;
    possible.then(|| Production::new(mean, sd)).flatten().ok_or_else(|| {
        spec(
            key,
            format!("[{mean}, {sd}]"),
            "[mean, standard deviation] of the production, the standard deviation above zero",
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(lines: &str) -> Result<Specification, String> {
        let table: SpecTable = toml::from_str(lines).map_err(|e| e.to_string())?;
        specification(&table).map_err(|e| e.to_string())
    }

    fn bias(lines: &str) -> (f64, f64) {
        let all = read(lines).unwrap();
        all.of(Quantity::Parameter(Parameter::Bias)).unwrap().limits.ends()
    }

    #[test]
    fn limits_in_units_that_people_have() {
        assert_eq!(bias("bias_limits_m_s2 = [-0.25, 0.2]"), (-0.25, 0.2));
        assert_eq!(bias("bias_limits_m_s2 = 1"), (-1.0, 1.0));
        assert_eq!(bias("bias_limits_m_s2 = [-inf, 0.2]"), (f64::NEG_INFINITY, 0.2));
        let (low, high) = bias("bias_limits_mg = 25");
        assert!((low + 0.245_166_25).abs() < 1e-15 && (high - 0.245_166_25).abs() < 1e-15);
        let other = read("scale_error_limits_percent = [-4, 4]\nmisalignment_limits_arcmin = 60");
        let other = other.unwrap();
        let of = |j| other.of(j).unwrap().limits.upper().unwrap();
        assert!((of(Quantity::Parameter(Parameter::ScaleError)) - 0.04).abs() < 1e-15);
        let one_degree = 1f64.to_radians();
        assert!((of(Quantity::Parameter(Parameter::Misalignment)) - one_degree).abs() < 1e-15);
        assert_eq!(read("").unwrap(), Specification::default());
    }

    #[test]
    fn rules() {
        let rule = |lines| read(lines).unwrap().rule;
        assert_eq!(rule(""), Rule::Guarded(GuardMultiple::ONE_U));
        assert_eq!(rule("guard_band = 0.83"), Rule::Guarded(GuardMultiple::ISO_14253_1));
        assert_eq!(rule("decision_rule = \"simple\""), Rule::Simple);
        let four = "decision_rule = \"non-binary\"\nguard_band = 1.5";
        assert_eq!(rule(four), Rule::NonBinary(GuardMultiple::ONE_AND_A_HALF_U));
    }

    #[test]
    fn nonsense_is_refused_with_key_and_remedy() {
        for (lines, key, remedy) in [
            ("bias_limits_m_s2 = [0.2, -0.2]", "[spec] bias_limits_m_s2", "lowest first"),
            ("bias_limits_m_s2 = [0.2, 0.2]", "[spec] bias_limits_m_s2", "lowest first"),
            ("bias_limits_m_s2 = [-inf, inf]", "bias_limits_m_s2", "lowest first"),
            ("bias_limits_m_s2 = [inf, -inf]", "bias_limits_m_s2", "lowest first"),
            ("bias_limits_m_s2 = [nan, 1]", "bias_limits_m_s2", "lowest first"),
            ("bias_limits_m_s2 = nan", "bias_limits_m_s2", "lowest first"),
            ("bias_limits_m_s2 = 0", "bias_limits_m_s2", "lowest first"),
            ("bias_limits_m_s2 = -1", "bias_limits_m_s2", "lowest first"),
            ("bias_limits_m_s2 = 1e300", "bias_limits_m_s2", "lowest first"),
            ("bias_limits_m_s2 = \"25 mg\"", "bias_limits_m_s2", "[lowest, highest]"),
            ("bias_limits_m_s2 = 1\nbias_limits_mg = 100", "[spec] bias_limits_mg", "not both"),
            ("scale_factor_limits = 0.008", "scale_factor_limits", "around zero"),
            ("decision_rule = \"guard\"", "[spec] decision_rule", "\"guarded\""),
            ("decision_rule = \"simple\"\nguard_band = 1.0", "[spec] guard_band", "leave it out"),
            ("guard_band = 0", "[spec] guard_band", "\"simple\""),
            ("guard_band = nan", "[spec] guard_band", "multiple of U"),
            ("guard_band = 11", "[spec] guard_band", "up to 10"),
            ("specification = \" \"", "[spec] specification", "title"),
            ("prior_bias_m_s2 = [0, 0.1]", "[spec] prior_bias_m_s2", "bias_limits_m_s2"),
            (
                "bias_limits_m_s2 = 1\nprior_bias_m_s2 = [0, 0]",
                "[spec] prior_bias_m_s2",
                "above zero",
            ),
            ("bias_limits_m_s2 = 1\nprior_bias_m_s2 = [nan, 1]", "prior_bias_m_s2", "above zero"),
            ("bias_limits_m_s2 = 1\nprior_bias_m_s2 = [0, inf]", "prior_bias_m_s2", "above zero"),
        ] {
            let text = read(lines).unwrap_err();
            assert!(text.contains(key) && text.contains(remedy), "{lines}: {text}");
        }
    }
}
