//! `plan.toml`: what the operator, the simulation and the bench take.

use std::fmt::Write as _;
use std::path::Path;

use serde::Deserialize;

use super::PlanDocument;
use crate::error::{Place, Problem, ReadError};
use crate::source::{DOCUMENT_LIMIT, read_document};
use crate::toml_text;

/// A plan as read back.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PlanFile {
    /// Version of the format: 1.
    pub format: u32,
    /// Model of the sensor.
    #[serde(default)]
    pub sensor: String,
    /// Number of runs.
    pub runs: u32,
    /// Length of a dwell, s.
    pub dwell_s: f64,
    /// Time to settle before a dwell, s.
    #[serde(default)]
    pub settle_s: f64,
    /// Time to set an angle, s.
    #[serde(default)]
    pub setting_s: f64,
    /// Time from power-up to the first setting, s.
    #[serde(default)]
    pub restart_s: f64,
    /// Dwells up and down, off the table, at the start of each run.
    #[serde(default)]
    pub updown: bool,
    /// The body turned by 180° in every second run.
    #[serde(default)]
    pub remounting: bool,
    /// Table angles of each run, in order, degrees.
    pub angles_deg: Vec<f64>,
    /// Those that are there to test the model.
    #[serde(default)]
    pub spares_deg: Vec<f64>,
}

/// A plan as TOML.
#[must_use]
pub fn plan_toml(d: &PlanDocument) -> String {
    let mut t = String::from(
        "# Planned by tumble. Try it: tumble simulate demo --plan plan.toml\nformat = 1\n",
    );
    let quoted = toml::Value::String(d.sensor.clone()).to_string();
    // Writing into a String cannot fail.
    let _ = writeln!(t, "sensor = {quoted}\nruns = {}", d.runs);
    let _ = writeln!(t, "dwell_s = {:?}      # reading, each position", d.dwell_s);
    let _ = writeln!(t, "settle_s = {:?}     # wait before it", d.settle_s);
    let _ = writeln!(t, "setting_s = {:?}    # to turn the table", d.setting_s);
    let _ = writeln!(t, "restart_s = {:?}   # power-up and warm-up before each run", d.restart_s);
    let _ = writeln!(t, "updown = {}        # axis up, then down, before the table", d.updown);
    let _ = writeln!(
        t,
        "remounting = {}    # body turned by 180 deg in every second run",
        d.remounting
    );
    let angles = |keep: &dyn Fn(&super::PlannedPosition) -> bool| {
        let list: Vec<f64> =
            d.positions.iter().filter(|p| !p.upright && keep(p)).map(|p| p.angle_deg).collect();
        format!("{list:?}")
    };
    let _ = writeln!(t, "angles_deg = {}", angles(&|_| true));
    let _ = writeln!(t, "spares_deg = {}", angles(&|p| p.spare));
    t
}

/// Reads a `plan.toml`.
///
/// **Errors** [`ReadError`] with file and line: what does not parse, and numbers that no plan has.
pub fn read_plan_file(path: &Path) -> Result<PlanFile, ReadError> {
    let shown = path.display().to_string();
    let bytes = read_document(path, &shown, DOCUMENT_LIMIT)?;
    let text = std::str::from_utf8(&bytes).map_err(|_| ReadError {
        place: Place::file(&shown),
        problem: Problem::Format { seen: "not UTF-8 text", remedy: "save the file as UTF-8" },
    })?;
    let plan: PlanFile = toml_text::from_toml(text, &shown)?;
    let wrong = |key: &str, given: String, expected: &str| ReadError {
        place: Place::file(&shown),
        problem: Problem::Value { key: key.into(), given, expected: expected.into() },
    };
    if plan.format != 1 {
        let newer = "1: this is a file of a newer version";
        return Err(wrong("format", plan.format.to_string(), newer));
    }
    if plan.angles_deg.is_empty() || plan.angles_deg.len() > MOST_ANGLES {
        let given = format!("{} angles", plan.angles_deg.len());
        return Err(wrong("angles_deg", given, "1 to 10000 angles in degrees"));
    }
    // Tumbled by more than a turn, or off the table: no plan of ours.
    if let Some(a) = plan.angles_deg.iter().find(|a| a.is_nan() || a.abs() > 90.0) {
        return Err(wrong("angles_deg", a.to_string(), "degrees between -90 and 90"));
    }
    Ok(plan)
}

/// As many as an experiment's file may hold.
const MOST_ANGLES: usize = 10_000;
