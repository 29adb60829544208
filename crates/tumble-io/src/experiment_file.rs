//! `experiment.toml`: its keys, and nothing but its keys.

use std::collections::BTreeMap;

use serde::Deserialize;

use crate::csv::Mapping;
use crate::error::{Problem, ReadError};
use crate::toml_text;

/// The whole file.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct ExperimentFile {
    /// Version of the format; 1 where it is left out.
    pub(crate) format: Option<u32>,
    /// Number of the certificate.
    pub(crate) id: Option<String>,
    /// Day of issue.
    pub(crate) issued: Option<toml::Value>,
    pub(crate) sensor: SensorTable,
    pub(crate) output: OutputTable,
    pub(crate) bench: BenchTable,
    #[serde(default)]
    pub(crate) csv: CsvTable,
    pub(crate) scale: Option<ScaleTable>,
    #[serde(default)]
    pub(crate) run: Vec<RunTable>,
    #[serde(default)]
    pub(crate) spec: SpecTable,
}

#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct SensorTable {
    #[serde(default)]
    pub(crate) model: String,
    #[serde(default)]
    pub(crate) serial: String,
    #[serde(default)]
    pub(crate) axis: String,
    pub(crate) k2_uncertainty_ug_per_g2: Option<f64>,
    pub(crate) k3_uncertainty_ug_per_g3: Option<f64>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum QuantizerName {
    Truncate,
    Floor,
    Round,
    None,
}

#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct OutputTable {
    pub(crate) quantizer: QuantizerName,
    pub(crate) unit: Option<String>,
    pub(crate) nominal_scale: Option<f64>,
    pub(crate) rate_hz: Option<f64>,
    pub(crate) min_code: Option<i32>,
    pub(crate) max_code: Option<i32>,
    pub(crate) nonlinearity_lsb: Option<f64>,
    pub(crate) reference_uncertainty_ppm: Option<f64>,
    pub(crate) resolution: Option<f64>,
}

#[derive(Debug, Clone, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct BenchTable {
    pub(crate) gravity: Option<f64>,
    pub(crate) gravity_uncertainty: Option<f64>,
    pub(crate) latitude_deg: Option<f64>,
    pub(crate) height_m: Option<f64>,
    pub(crate) angle_uncertainty_arcmin: Option<f64>,
    pub(crate) angle_range_deg: Option<[f64; 2]>,
    pub(crate) angle_sign: Option<f64>,
    pub(crate) angle_zero_deg: Option<f64>,
    pub(crate) angle_unit: Option<String>,
    pub(crate) updown_lean_arcmin: Option<f64>,
    pub(crate) dial_scale_uncertainty_ppm: Option<f64>,
    pub(crate) eccentricity_arcmin: Option<f64>,
    pub(crate) angle_zero_uncertainty_arcmin: Option<f64>,
    pub(crate) axis_tilt_arcmin: Option<f64>,
    pub(crate) sensor_lean_arcmin: Option<f64>,
    pub(crate) temperature_spread_k: Option<f64>,
}

/// How the run files are written.
#[derive(Debug, Clone, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct CsvTable {
    pub(crate) header_line: Option<u64>,
    pub(crate) data_line: Option<u64>,
    pub(crate) delimiter: Option<String>,
    pub(crate) decimal: Option<String>,
    pub(crate) comment: Option<String>,
    pub(crate) missing: Option<String>,
    pub(crate) code_format: Option<String>,
    pub(crate) code_bits: Option<u32>,
    pub(crate) code_offset: Option<i32>,
    pub(crate) time_unit: Option<String>,
    /// For all files; a run's own go before.
    #[serde(default)]
    pub(crate) columns: Mapping,
    #[serde(default)]
    pub(crate) rows: BTreeMap<String, String>,
}

/// Start of each dwell that is thrown away: seconds, or `"detect"`.
#[derive(Debug, Clone, Deserialize)]
#[serde(untagged)]
pub(crate) enum DiscardValue {
    Seconds(f64),
    Word(String),
}

#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct ScaleTable {
    pub(crate) up: Option<String>,
    pub(crate) down: Option<String>,
    pub(crate) up_mean_code: Option<f64>,
    pub(crate) down_mean_code: Option<f64>,
    pub(crate) up_samples: Option<u64>,
    pub(crate) down_samples: Option<u64>,
    pub(crate) up_std_code: Option<f64>,
    pub(crate) down_std_code: Option<f64>,
    #[serde(default)]
    pub(crate) columns: Mapping,
    #[serde(default)]
    pub(crate) rows: BTreeMap<String, String>,
    pub(crate) discard_s: Option<DiscardValue>,
    pub(crate) run: Option<String>,
    /// Enter the joint adjustment of all runs once.
    pub(crate) joint: Option<bool>,
}

#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct RunTable {
    pub(crate) name: Option<String>,
    pub(crate) file: Option<String>,
    #[serde(default)]
    pub(crate) files: Vec<AngleFile>,
    /// Dial angles of the dwells of a continuous record.
    pub(crate) angles_deg: Option<Vec<f64>>,
    pub(crate) mounting: Option<String>,
    #[serde(default)]
    pub(crate) orientation: Orientation,
    /// Numbers of positions that are left out of the adjustment.
    #[serde(default)]
    pub(crate) leave_out: Vec<usize>,
    #[serde(default)]
    pub(crate) columns: Mapping,
    #[serde(default)]
    pub(crate) rows: BTreeMap<String, String>,
    pub(crate) discard_s: Option<DiscardValue>,
    pub(crate) date: Option<toml::Value>,
    pub(crate) operator: Option<String>,
    pub(crate) temperature_degc: Option<f64>,
    pub(crate) note: Option<String>,
}

#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct AngleFile {
    pub(crate) file: String,
    pub(crate) angle_deg: f64,
}

#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum Orientation {
    #[default]
    Normal,
    Reversed,
}

/// Limits of a quantity: `[lowest, highest]`, or `x` for ±x.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum LimitsValue {
    Around(f64),
    Between([f64; 2]),
}

impl<'de> Deserialize<'de> for LimitsValue {
    fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Visitor;

        impl<'de> serde::de::Visitor<'de> for Visitor {
            type Value = LimitsValue;

            fn expecting(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.write_str("limits as [lowest, highest], or one number x for -x to x")
            }

            fn visit_f64<E: serde::de::Error>(self, v: f64) -> Result<LimitsValue, E> {
                Ok(LimitsValue::Around(v))
            }

            fn visit_i64<E: serde::de::Error>(self, v: i64) -> Result<LimitsValue, E> {
                Ok(LimitsValue::Around(v as f64))
            }

            fn visit_seq<A: serde::de::SeqAccess<'de>>(
                self,
                seq: A,
            ) -> Result<LimitsValue, A::Error> {
                <[f64; 2]>::deserialize(serde::de::value::SeqAccessDeserializer::new(seq))
                    .map(LimitsValue::Between)
            }
        }

        deserializer.deserialize_any(Visitor)
    }
}

/// Targets (largest expanded uncertainties that still serve), and limits that the unit is held against.
#[derive(Debug, Clone, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct SpecTable {
    pub(crate) target_bias_m_s2: Option<f64>,
    pub(crate) target_misalignment_rad: Option<f64>,
    pub(crate) target_scale_error: Option<f64>,
    pub(crate) specification: Option<String>,
    pub(crate) decision_rule: Option<String>,
    pub(crate) guard_band: Option<f64>,
    pub(crate) bias_limits_m_s2: Option<LimitsValue>,
    pub(crate) bias_limits_mg: Option<LimitsValue>,
    pub(crate) misalignment_limits_rad: Option<LimitsValue>,
    pub(crate) misalignment_limits_arcmin: Option<LimitsValue>,
    pub(crate) scale_error_limits: Option<LimitsValue>,
    pub(crate) scale_error_limits_percent: Option<LimitsValue>,
    pub(crate) scale_error_limits_ppm: Option<LimitsValue>,
    pub(crate) scale_factor_limits: Option<LimitsValue>,
    pub(crate) prior_bias_m_s2: Option<[f64; 2]>,
    pub(crate) prior_misalignment_rad: Option<[f64; 2]>,
    pub(crate) prior_scale_error: Option<[f64; 2]>,
    pub(crate) prior_scale_factor: Option<[f64; 2]>,
}

/// Parses `experiment.toml`.
pub(crate) fn parse(text: &str, shown_as: &str) -> Result<ExperimentFile, ReadError> {
    toml_text::from_toml(text, shown_as)
}

/// An error about experiment.toml with the line that it is about, where that can be found in the text.
pub(crate) fn located(mut e: ReadError, text: &str, shown_as: &str) -> ReadError {
    if e.place.file == shown_as && e.place.line.is_none() {
        e.place.line = match &e.problem {
            Problem::Value { key, .. } => line_of_key(text, key),
            Problem::OutsideFolder { path } | Problem::NoFile { path, .. } => {
                line_with(text, &format!("\"{path}\""))
            }
            Problem::RunName { name, .. } => line_with(text, &format!("\"{name}\"")),
            Problem::UnknownKey { key, .. } => line_with(text, key),
            _ => None,
        };
    }
    e
}

/// The only line with a text, comments apart.
fn line_with(text: &str, wanted: &str) -> Option<u64> {
    let mut found = (1..)
        .zip(text.lines())
        .filter(|(_, line)| line.contains(wanted) && !line.trim_start().starts_with('#'));
    let (number, _) = found.next()?;
    found.next().is_none().then_some(number)
}

/// The only line that sets a key such as `[bench] gravity` in its table.
fn line_of_key(text: &str, key: &str) -> Option<u64> {
    let (table, name) = match key.rsplit_once(' ') {
        Some((table, name)) => (Some(table.trim_matches(['[', ']'])), name),
        None => (None, key),
    };
    let mut open = "";
    let mut found = None;
    for (number, line) in (1..).zip(text.lines().map(str::trim)) {
        if let Some(rest) = line.strip_prefix('[') {
            open = rest.trim_start_matches('[').split(']').next().unwrap_or_default().trim();
            continue;
        }
        let sets = line.strip_prefix(name).is_some_and(|rest| rest.trim_start().starts_with('='));
        if sets && table.is_none_or(|t| t == open) {
            if found.is_some() {
                return None;
            }
            found = Some(number);
        }
    }
    found
}

/// A date of TOML or a text, as text.
pub(crate) fn date_text(value: &toml::Value) -> String {
    match value {
        toml::Value::String(s) => s.clone(),
        other => other.to_string(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const HEAD: &str = "[sensor]\nmodel = \"A\"\n[output]\nquantizer = \"floor\"\n[bench]\n";

    #[test]
    fn unknown_keys_are_refused_with_the_nearest_known_one() {
        let error = parse(&format!("{HEAD}gravty = 9.81\n"), "experiment.toml").unwrap_err();
        let text = error.to_string();
        assert!(text.contains("line 6") && text.contains("`gravity`"), "{text}");
    }

    #[test]
    fn impossible_values_name_their_line() {
        let text = "[output]\nunit = \"V\"\n# gravity = 1\n[bench]\ngravity = 981\n[[run]]\nfile = \"../a\"\n";
        assert_eq!(line_of_key(text, "[bench] gravity"), Some(5));
        assert_eq!(line_of_key(text, "[output] gravity"), None);
        assert_eq!(line_of_key(text, "unit"), Some(2));
        assert_eq!(line_with(text, "\"../a\""), Some(7));
        assert_eq!(line_with(text, "["), None);
    }

    #[test]
    fn wrong_types_name_their_line() {
        let error = parse(&format!("{HEAD}gravity = \"9.81\"\n"), "experiment.toml").unwrap_err();
        assert!(error.to_string().contains("line 6"), "{error}");
        let error = parse("[sensor\n", "experiment.toml").unwrap_err();
        assert!(error.to_string().contains("line 1"), "{error}");
    }

    #[test]
    fn every_slip_has_a_remedy_of_its_own() {
        for (line, remedy) in [
            ("gravity = 9,81", "write gravity = 9.81"),
            ("gravity = \"9,81\"", "write gravity = 9.81"),
            ("gravity = -9,81   # m/s²", "write gravity = -9.81"),
            ("gravity = \"9.81\"", "write gravity = 9.81"),
            ("gravity = 9.81 m/s2", "no unit"),
            ("gravity 9.81", "one key and one value a line"),
            ("gravity = = 9.81", "one key and one value a line"),
            ("gravity =", "a line is KEY = VALUE"),
            ("gravity = 9.81\ngravity = 9.8", "remove one of the two"),
            ("[[run]\nfile = \"a.csv\"", "close the bracket"),
            ("[[run]]\nfile = \"data\\a.csv\"", "write file = \"data/a.csv\""),
            ("[[run]]\nfile = \"C:\\Users\\a.csv\"", "write file = \"C:/Users/a.csv\""),
            ("[[run]]\nfile = run-1.csv", "write file = \"run-1.csv\""),
            ("[[run]]\nfile = 7", "write file = \"7\""),
            ("[[run]]\norientation = \"upside\"", "write one of these"),
            ("[[run]]\nfiles = [{file = \"a.csv\"}]", "add angle_deg"),
        ] {
            let error = parse(&format!("{HEAD}{line}\n"), "experiment.toml").unwrap_err();
            let text = error.to_string();
            assert!(text.contains(remedy) && text.contains("line "), "{line}: {text}");
        }
    }
}
