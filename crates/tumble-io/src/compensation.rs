//! From a passport to coefficients at work.

use tumble_core::assess::CompensationTerms;
use tumble_core::estimate::Term;
use tumble_core::linalg::Matrix;
use tumble_core::{
    Code, Compensation, Compensator, ConverterEnds, Nonlinearity, Quantizer, QuantizerOffset,
};

use crate::passport::{self, Passport};

/// Whether coefficients may be used before reproducibility is shown.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Proof {
    /// Only accepted passports.
    Required,
    /// Also passports that are indeterminate for want of runs.
    Waived,
}

/// Coefficients are far smaller, whatever the unit: the squares of what follows from them are finite.
const LARGEST: f64 = 1e60;

/// A passport that gives no coefficients.
#[derive(Debug, Clone, PartialEq)]
pub enum CompensationRefused {
    /// The calibration was rejected.
    Rejected {
        /// Why.
        reasons: Vec<String>,
    },
    /// The calibration is indeterminate, and not for want of runs alone.
    Indeterminate {
        /// What is missing.
        missing: Vec<String>,
    },
    /// Reproducibility is not shown; `--unproven` uses the coefficients all the same.
    Unproven,
    /// The passport's worked number does not follow from its coefficients: it was edited or damaged.
    Inconsistent {
        /// What the passport says, m/s².
        stated_m_s2: f64,
        /// What its coefficients give, m/s².
        computed_m_s2: f64,
    },
    /// A number that no calibration gives: it was edited or damaged.
    Impossible {
        /// The field.
        field: &'static str,
    },
    /// A word that this version does not know.
    Unknown {
        /// The field.
        field: &'static str,
        /// The word.
        seen: String,
    },
}

impl std::fmt::Display for CompensationRefused {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let first =
            |list: &[String]| list.first().map(|s| crate::error::visible(s)).unwrap_or_default();
        match self {
            Self::Rejected { reasons } => {
                write!(
                    f,
                    "the calibration was rejected and has no coefficients; follow its first reason and certify again: {}",
                    first(reasons)
                )
            }
            Self::Indeterminate { missing } => {
                write!(
                    f,
                    "the calibration is indeterminate and has no coefficients; supply what is missing and certify again: {}",
                    first(missing)
                )
            }
            Self::Unproven => write!(
                f,
                "reproducibility is not shown (too few runs): the bias may differ after the next power-up; \
                 measure more runs, or accept that with --unproven"
            ),
            Self::Inconsistent { stated_m_s2, computed_m_s2 } => write!(
                f,
                "its coefficients give {computed_m_s2} m/s² where its own example says {stated_m_s2} m/s²: \
                 edited or damaged; certify the experiment again"
            ),
            Self::Impossible { field } => write!(
                f,
                "{field} is not possible: edited or damaged; certify the experiment again"
            ),
            Self::Unknown { field, seen } => write!(
                f,
                "{field} `{}` is not known to this version; use the version of tumble that wrote the passport",
                crate::error::visible(seen)
            ),
        }
    }
}

impl std::error::Error for CompensationRefused {}

/// A field that is nothing that a calibration gives, where there is one.
fn impossible(c: &passport::Compensation) -> Option<&'static str> {
    let [[a, b], [b2, d]] = c.covariance;
    // Rounding of what was written, no more; a variance that came out as zero is fine.
    let symmetric = (b - b2).abs() <= 1e-9 * (a * d).abs().sqrt();
    let covariance = a >= 0.0 && d >= 0.0 && b * b <= a * d * (1.0 + 1e-9) && symmetric;
    let plausible = |v: f64| v.abs() < LARGEST;
    match () {
        () if !(plausible(c.scale_factor) && c.scale_factor > 0.0) => {
            Some("compensation.scale_factor")
        }
        () if !plausible(c.bias) => Some("compensation.bias"),
        () if !covariance || !plausible(a) || !plausible(d) => Some("compensation.covariance"),
        () if c.reading_std_lsb.is_some_and(|s| s < 0.0 || !plausible(s)) => {
            Some("compensation.reading_std_lsb")
        }
        () => None,
    }
}

/// Whether a number is none that a calibration gives.
fn too_large(v: f64) -> bool {
    !v.is_finite() || v.abs() >= LARGEST
}

/// Further terms as the runtime takes them.
fn nonlinearity(terms: &passport::CompensationTerms) -> Result<Nonlinearity, CompensationRefused> {
    let impossible = |field| Err(CompensationRefused::Impossible { field });
    let size = 2 + terms.coefficients.len();
    let mut coefficients: Vec<(Term, f64)> = Vec::new();
    for c in &terms.coefficients {
        let Some(term) = Term::from_name(&c.name) else {
            return Err(CompensationRefused::Unknown {
                field: "compensation.terms",
                seen: c.name.clone(),
            });
        };
        if too_large(c.value) || coefficients.iter().any(|(t, _)| *t == term) {
            return impossible("compensation.terms.coefficients");
        }
        coefficients.push((term, c.value));
    }
    let needs_temperature = coefficients.iter().any(|(t, _)| t.needs_temperature());
    let reference = terms.reference_temperature_degc;
    if reference.is_some_and(too_large) || (needs_temperature && reference.is_none()) {
        return impossible("compensation.terms.reference_temperature_degc");
    }
    let rows = &terms.covariance;
    if rows.len() != size || rows.iter().any(|r| r.len() != size) {
        return impossible("compensation.terms.covariance");
    }
    let mut covariance = Matrix::zeros(size, size);
    for (i, row) in rows.iter().enumerate() {
        for (j, value) in row.iter().enumerate() {
            if too_large(*value) || (i == j && *value < 0.0) {
                return impossible("compensation.terms.covariance");
            }
            covariance[(i, j)] = *value;
        }
    }
    Ok(CompensationTerms {
        coefficients,
        reference_temperature_degc: reference,
        covariance,
        peak_m_s2: terms.terms_peak_m_s2,
    }
    .nonlinearity())
}

/// Coefficients of a passport.
///
/// **Errors** [`CompensationRefused`] where the verdict does not allow it.
pub fn compensator(passport: &Passport, proof: Proof) -> Result<Compensator, CompensationRefused> {
    let unknown = |field, seen: &str| CompensationRefused::Unknown { field, seen: seen.to_owned() };
    let c = match (passport.verdict.as_str(), &passport.compensation) {
        ("accepted", Some(c)) => c,
        ("indeterminate", Some(c)) if proof == Proof::Waived => c,
        ("indeterminate", Some(_)) => return Err(CompensationRefused::Unproven),
        ("indeterminate", None) => {
            return Err(CompensationRefused::Indeterminate { missing: passport.missing.clone() });
        }
        ("rejected", _) => {
            return Err(CompensationRefused::Rejected { reasons: passport.reasons.clone() });
        }
        ("accepted", None) => return Err(unknown("compensation", "absent")),
        (other, _) => return Err(unknown("verdict", other)),
    };
    let quantizer_offset = match c.quantizer_offset.as_str() {
        "half_sign" => QuantizerOffset::HalfSign,
        "half" => QuantizerOffset::Half,
        "none" => QuantizerOffset::None,
        other => return Err(unknown("quantizer_offset", other)),
    };
    let quantizer = match passport.output.quantizer.as_str() {
        "truncate" => Quantizer::Truncate,
        "floor" => Quantizer::Floor,
        "round" => Quantizer::Round,
        "none" => Quantizer::None,
        other => return Err(unknown("quantizer", other)),
    };
    if let Some(field) = impossible(c) {
        return Err(CompensationRefused::Impossible { field });
    }
    let nonlinearity = c.terms.as_ref().map_or(Ok(Nonlinearity::default()), nonlinearity)?;
    let compensator = Compensator {
        coefficients: Compensation {
            scale_factor_m_s2_per_lsb: c.scale_factor,
            bias_m_s2: c.bias,
            quantizer_offset,
            covariance: c.covariance,
            nonlinearity,
        },
        quantizer,
        ends: ConverterEnds {
            min_code: passport.output.min_code.map(Code),
            max_code: passport.output.max_code.map(Code),
        },
        valid_range_lsb: (c.valid_range_lsb[0], c.valid_range_lsb[1]),
        reading_std_lsb: c.reading_std_lsb,
    };
    let stated_m_s2 = c.example.acceleration_m_s2;
    let computed_m_s2 = compensator.coefficients.acceleration_m_s2(c.example.code);
    // Rounding of another platform, no more.
    if (computed_m_s2 - stated_m_s2).abs() <= 1e-9 * (1.0 + stated_m_s2.abs()) {
        Ok(compensator)
    } else {
        Err(CompensationRefused::Inconsistent { stated_m_s2, computed_m_s2 })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_that_no_calibration_gives_are_refused() {
        let c = passport::Compensation {
            scale_factor: 0.0077,
            bias: 0.01,
            quantizer_offset: "half_sign".into(),
            valid_range_lsb: [-1000.0, 1000.0],
            covariance: [[4e-12, 1e-9], [1e-9, 9e-6]],
            reading_std_lsb: Some(1.2),
            terms: None,
            example: passport::Example { code: 0, acceleration_m_s2: 0.0 },
        };
        assert_eq!(impossible(&c), None);
        for (field, wrong) in [
            ("scale_factor", passport::Compensation { scale_factor: 1e308, ..c.clone() }),
            ("scale_factor", passport::Compensation { scale_factor: -0.01, ..c.clone() }),
            ("bias", passport::Compensation { bias: 1e300, ..c.clone() }),
            (
                "covariance",
                passport::Compensation { covariance: [[-1.0, 0.0], [0.0, 1.0]], ..c.clone() },
            ),
            (
                "covariance",
                passport::Compensation { covariance: [[1.0, 2.0], [2.0, 1.0]], ..c.clone() },
            ),
            (
                "reading_std_lsb",
                passport::Compensation { reading_std_lsb: Some(-1.0), ..c.clone() },
            ),
        ] {
            assert_eq!(impossible(&wrong), Some(format!("compensation.{field}").as_str()));
        }
    }
}
