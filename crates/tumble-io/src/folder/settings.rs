//! The tables `[output]`, `[bench]` and `[spec]`: every number checked, every refusal with its key.

use tumble_core::{
    Angle, Bench, Code, ConverterEnds, DEFAULT_VERTICAL_LEAN_ARCMIN, Gravity, GravitySource,
    Output, Quantizer, Targets,
};

use super::EXPERIMENT_FILE;
use crate::error::{Place, Problem, ReadError};
use crate::experiment_file::{BenchTable, ExperimentFile, OutputTable, QuantizerName};

pub(super) fn value(key: &str, given: impl ToString, expected: &str) -> ReadError {
    ReadError {
        place: Place::file(EXPERIMENT_FILE),
        problem: Problem::Value {
            key: key.to_owned(),
            given: given.to_string(),
            expected: expected.to_owned(),
        },
    }
}

pub(super) fn missing(key: &'static str, example: &'static str) -> ReadError {
    ReadError { place: Place::file(EXPERIMENT_FILE), problem: Problem::MissingKey { key, example } }
}

/// A number that must be finite and at least (or more than) zero.
pub(super) fn not_negative(
    key: &str,
    given: Option<f64>,
    expected: &str,
) -> Result<Option<f64>, ReadError> {
    match given {
        Some(v) if !(v.is_finite() && v >= 0.0) => Err(value(key, v, expected)),
        other => Ok(other),
    }
}

fn positive(key: &str, given: Option<f64>, expected: &str) -> Result<Option<f64>, ReadError> {
    match given {
        Some(v) if !(v.is_finite() && v > 0.0) => Err(value(key, v, expected)),
        other => Ok(other),
    }
}

pub(super) fn output(table: &OutputTable) -> Result<Output, ReadError> {
    let quantizer = match table.quantizer {
        QuantizerName::Truncate => Quantizer::Truncate,
        QuantizerName::Floor => Quantizer::Floor,
        QuantizerName::Round => Quantizer::Round,
        QuantizerName::None => Quantizer::None,
    };
    let unit = match (quantizer, &table.unit) {
        (Quantizer::None, Some(unit)) => unit.clone(),
        (Quantizer::None, None) => {
            return Err(missing("[output] unit", "unit = \"V\" (the unit of the column `output`)"));
        }
        (_, None) => "LSB".into(),
        (_, Some(unit)) if unit == "LSB" => "LSB".into(),
        (_, Some(unit)) => {
            return Err(value(
                "[output] unit",
                unit,
                "it only with quantizer = \"none\"; codes are in LSB",
            ));
        }
    };
    if let (Some(lo), Some(hi)) = (table.min_code, table.max_code)
        && lo >= hi
    {
        return Err(value("[output] max_code", hi, "more than min_code"));
    }
    let nominal = "m/s² per LSB, a positive number (g per LSB times 9.80665)";
    Ok(Output {
        quantizer,
        unit,
        nominal_scale_m_s2_per_lsb: positive(
            "[output] nominal_scale",
            table.nominal_scale,
            nominal,
        )?,
        rate_hz: positive("[output] rate_hz", table.rate_hz, "samples per second")?,
        ends: ConverterEnds {
            min_code: table.min_code.map(Code),
            max_code: table.max_code.map(Code),
        },
    })
}

pub(super) fn bench(table: &BenchTable) -> Result<Bench, ReadError> {
    let gravity_range = "local gravity in m/s², between 9.7 and 9.9";
    let gravity = match (table.gravity, table.latitude_deg, table.height_m) {
        (Some(g), None, None) => {
            if !(9.7..=9.9).contains(&g) {
                return Err(value("[bench] gravity", g, gravity_range));
            }
            let u = not_negative(
                "[bench] gravity_uncertainty",
                table.gravity_uncertainty,
                "a standard uncertainty in m/s²",
            )?;
            Gravity {
                value_m_s2: g,
                standard_uncertainty_m_s2: u.unwrap_or(0.0),
                source: if u.is_some() {
                    GravitySource::Stated
                } else {
                    GravitySource::StatedWithoutUncertainty
                },
            }
        }
        (None, Some(latitude), height) => {
            let height = height.ok_or_else(|| missing("[bench] height_m", "height_m = 150.0"))?;
            if !(-90.0..=90.0).contains(&latitude) {
                return Err(value("[bench] latitude_deg", latitude, "degrees between −90 and 90"));
            }
            if !(-500.0..=9000.0).contains(&height) {
                return Err(value("[bench] height_m", height, "metres between −500 and 9000"));
            }
            Gravity::normal(latitude, height)
        }
        (None, None, _) => {
            return Err(missing(
                "[bench] gravity",
                "gravity = 9.81 (m/s², local), or latitude_deg and height_m",
            ));
        }
        (Some(_), _, _) => {
            return Err(value(
                "[bench] gravity",
                "given twice",
                "gravity, or latitude_deg and height_m, not both",
            ));
        }
    };
    let range = match table.angle_range_deg {
        Some([lo, hi]) if lo < hi => Some((Angle::from_deg(lo), Angle::from_deg(hi))),
        Some([lo, hi]) => {
            return Err(value(
                "[bench] angle_range_deg",
                format!("[{lo}, {hi}]"),
                "[lowest, highest] in degrees",
            ));
        }
        None => None,
    };
    if let Some(sign) = table.angle_sign.filter(|s| s.abs() != 1.0) {
        return Err(value("[bench] angle_sign", sign, "1 or -1"));
    }
    if let Some(zero) = table.angle_zero_deg.filter(|z| !z.is_finite()) {
        return Err(value("[bench] angle_zero_deg", zero, "degrees"));
    }
    let arcmin = "minutes of arc, standard, not negative";
    Ok(Bench {
        gravity,
        angle_uncertainty: not_negative(
            "[bench] angle_uncertainty_arcmin",
            table.angle_uncertainty_arcmin,
            arcmin,
        )?
        .map(Angle::from_arcmin),
        range,
        vertical_lean: Angle::from_arcmin(
            not_negative("[bench] updown_lean_arcmin", table.updown_lean_arcmin, arcmin)?
                .unwrap_or(DEFAULT_VERTICAL_LEAN_ARCMIN),
        ),
    })
}

pub(super) fn targets(file: &ExperimentFile) -> Result<Targets, ReadError> {
    let default = Targets::default();
    let expected = "a positive expanded uncertainty";
    let spec = &file.spec;
    let or = |key, given, default| {
        Ok::<_, ReadError>(positive(key, given, expected)?.unwrap_or(default))
    };
    Ok(Targets {
        bias_m_s2: or("[spec] target_bias_m_s2", spec.target_bias_m_s2, default.bias_m_s2)?,
        misalignment_rad: or(
            "[spec] target_misalignment_rad",
            spec.target_misalignment_rad,
            default.misalignment_rad,
        )?,
        scale_error: or("[spec] target_scale_error", spec.target_scale_error, default.scale_error)?,
    })
}
