//! The tables `[output]`, `[bench]` and `[spec]`: every number checked, every refusal with its key.

use tumble_core::{
    Angle, Bench, Code, ConverterEnds, DEFAULT_VERTICAL_LEAN_ARCMIN, Gravity, GravitySource,
    Output, Quantizer, Targets,
};

use super::EXPERIMENT_FILE;
use crate::csv::{
    AngleUnit, CodeFormat, DecimalSign, Delimiter, Dialect, Discard, KNOWN, Mapping, Missing,
    TimeUnit,
};
use crate::error::{Place, Problem, ReadError};
use crate::experiment_file::{
    BenchTable, CsvTable, DiscardValue, ExperimentFile, OutputTable, QuantizerName,
};

pub(crate) fn value(key: &str, given: impl ToString, expected: &str) -> ReadError {
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
fn not_negative(key: &str, given: Option<f64>, expected: &str) -> Result<Option<f64>, ReadError> {
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

/// Nominal scale factors of anything: 32 bits over 0.1 g have 5e-10 m/s², a reading in kV some 1e5.
const SCALES: std::ops::RangeInclusive<f64> = 1e-15..=1e15;

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
    let scale = positive("[output] nominal_scale", table.nominal_scale, nominal)?;
    if let Some(k) = scale.filter(|k| !SCALES.contains(k)) {
        return Err(value("[output] nominal_scale", k, nominal));
    }
    Ok(Output {
        quantizer,
        unit,
        nominal_scale_m_s2_per_lsb: scale,
        rate_hz: positive("[output] rate_hz", table.rate_hz, "samples per second")?,
        ends: ConverterEnds {
            min_code: table.min_code.map(Code),
            max_code: table.max_code.map(Code),
        },
    })
}

pub(crate) fn bench(table: &BenchTable) -> Result<Bench, ReadError> {
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
        systematics: tumble_core::systematic::Systematics::default(),
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

/// How the run files are written: `[csv]`, and the unit of the dial.
pub(super) fn dialect(csv: &CsvTable, bench: &BenchTable) -> Result<Dialect, ReadError> {
    let decimal = match csv.decimal.as_deref() {
        None => None,
        Some(".") => Some(DecimalSign::Point),
        Some(",") => Some(DecimalSign::CommaOrPoint),
        Some(other) => return Err(value("[csv] decimal", other, "\".\" or \",\"")),
    };
    let delimiter = match csv.delimiter.as_deref() {
        None => None,
        Some(name) => Some(Delimiter::named(name).ok_or_else(|| {
            value("[csv] delimiter", name, "\",\", \";\", \"|\", \"tab\" or \"blanks\"")
        })?),
    };
    let missing = match csv.missing.as_deref() {
        None | Some("refuse") => Missing::Refuse,
        Some("skip") => Missing::Skip,
        Some(other) => return Err(value("[csv] missing", other, "\"refuse\" or \"skip\"")),
    };
    let hexadecimal = match csv.code_format.as_deref() {
        None | Some("decimal") => false,
        Some("hex") => true,
        Some(other) => return Err(value("[csv] code_format", other, "\"decimal\" or \"hex\"")),
    };
    if let Some(bits) = csv.code_bits.filter(|b| !(2..=32).contains(b)) {
        return Err(value("[csv] code_bits", bits, "the bits of a word, 2 to 32"));
    }
    let time_unit = match csv.time_unit.as_deref() {
        None => None,
        Some(name) => Some(TimeUnit::named(name).ok_or_else(|| {
            value("[csv] time_unit", name, "\"s\", \"ms\", \"us\", \"ns\" or \"date\"")
        })?),
    };
    let angle_unit = match bench.angle_unit.as_deref() {
        None => None,
        Some(name) => Some(AngleUnit::named(name).ok_or_else(|| {
            value("[bench] angle_unit", name, "\"deg\", \"dms\", \"gon\" or \"rad\"")
        })?),
    };
    if let (Some(header), Some(data)) = (csv.header_line, csv.data_line)
        && data <= header
    {
        return Err(value("[csv] data_line", data, "a line after header_line"));
    }
    Ok(Dialect {
        header_line: csv.header_line,
        data_line: csv.data_line,
        delimiter,
        decimal,
        comment: csv.comment.clone().unwrap_or_default().into_bytes(),
        missing,
        codes: CodeFormat {
            hexadecimal,
            bits: csv.code_bits,
            offset: csv.code_offset.unwrap_or(0),
        },
        time_unit,
        angle_unit,
    })
}

/// Columns for all files, with a run's own put over them. Unknown ones are refused with the nearest known one.
pub(super) fn mapping(all: &Mapping, own: &Mapping) -> Result<Mapping, ReadError> {
    let mut together = all.clone();
    together.extend(own.clone());
    match together.keys().find(|k| !KNOWN.contains(&k.as_str())) {
        Some(unknown) => Err(ReadError {
            place: Place::file(EXPERIMENT_FILE),
            problem: Problem::unknown_key(unknown, KNOWN.iter().map(|k| (*k).to_owned()).collect()),
        }),
        None => Ok(together),
    }
}

/// What is thrown away of each dwell.
pub(super) fn discard(given: Option<&DiscardValue>) -> Result<Discard, ReadError> {
    let expected = "seconds, or \"detect\"";
    match given {
        None => Ok(Discard::Seconds(0.0)),
        Some(DiscardValue::Word(word)) if word == "detect" => Ok(Discard::Detected),
        Some(DiscardValue::Word(word)) => Err(value("discard_s", word, expected)),
        Some(DiscardValue::Seconds(s)) => {
            not_negative("discard_s", Some(*s), expected)?;
            Ok(Discard::Seconds(*s))
        }
    }
}
