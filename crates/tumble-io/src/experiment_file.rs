//! `experiment.toml`: its keys, and nothing but its keys.

use std::collections::BTreeMap;

use serde::Deserialize;

use crate::csv::Mapping;
use crate::error::{Place, Problem, ReadError};

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
}

#[derive(Debug, Clone, Deserialize)]
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

/// Targets: largest expanded uncertainties that still serve.
#[derive(Debug, Clone, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct SpecTable {
    pub(crate) target_bias_m_s2: Option<f64>,
    pub(crate) target_misalignment_rad: Option<f64>,
    pub(crate) target_scale_error: Option<f64>,
}

/// Parses `experiment.toml`.
pub(crate) fn parse(text: &str, shown_as: &str) -> Result<ExperimentFile, ReadError> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    toml::from_str::<ExperimentFile>(text).map_err(|e| {
        let (line, column) = e.span().map_or((1, 1), |s| line_and_column(text, s.start));
        ReadError {
            place: Place::field(shown_as, line, column.to_string()),
            problem: problem(e.message()),
        }
    })
}

/// A date of TOML or a text, as text.
pub(crate) fn date_text(value: &toml::Value) -> String {
    match value {
        toml::Value::String(s) => s.clone(),
        other => other.to_string(),
    }
}

fn line_and_column(text: &str, at: usize) -> (u64, usize) {
    let before = text.get(..at).unwrap_or(text);
    let line = before.matches('\n').count() as u64 + 1;
    let column = before.rsplit('\n').next().map_or(0, |l| l.chars().count()) + 1;
    (line, column)
}

/// The deserializer's message about an unknown key names the key and the known ones between backticks.
fn problem(message: &str) -> Problem {
    let mut quoted = message.split('`').skip(1).step_by(2).map(str::to_owned);
    match (message, quoted.next()) {
        (m, Some(key)) if m.starts_with("unknown field") => {
            Problem::unknown_key(&key, quoted.collect())
        }
        (m, Some(key)) if m.starts_with("missing field") => Problem::Toml {
            message: format!(
                "`{key}` is missing here: write it, or see what `tumble simulate` writes"
            ),
        },
        _ => Problem::Toml { message: message.to_owned() },
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
    fn wrong_types_name_their_line() {
        let error = parse(&format!("{HEAD}gravity = \"9.81\"\n"), "experiment.toml").unwrap_err();
        assert!(error.to_string().contains("line 6"), "{error}");
        let error = parse("[sensor\n", "experiment.toml").unwrap_err();
        assert!(error.to_string().contains("line 1"), "{error}");
    }
}
