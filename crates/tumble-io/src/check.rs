//! `tumble check`: what was read, without judgement. The shape that `--json` prints.

use std::path::Path;

use serde::Serialize;
use tumble_core::judge::data_hygiene;
use tumble_core::{DwellFacts, Experiment, FindingKind, Position, Run, dwell_facts, first_look};

use crate::error::ReadError;
use crate::folder::read_experiment;
use crate::passport::quantizer_name;
use crate::source::Watch;

/// What was read of an experiment.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Check {
    /// Model, serial and axis.
    pub sensor: [String; 3],
    /// How the converter rounds.
    pub quantizer: String,
    /// Unit of the readings.
    pub unit: String,
    /// Rate as stated, Hz.
    pub stated_rate_hz: Option<f64>,
    /// The converter's ends.
    pub ends: [Option<i32>; 2],
    /// Local gravity, m/s².
    pub gravity_m_s2: f64,
    /// Its standard uncertainty.
    pub gravity_uncertainty_m_s2: f64,
    /// Runs in the order of experiment.toml; the up/down pair comes last.
    pub runs: Vec<CheckedRun>,
    /// What was noticed while reading: id, place, text.
    pub remarks: Vec<String>,
}

/// One run.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct CheckedRun {
    /// Name.
    pub name: String,
    /// Mounting.
    pub mounting: String,
    /// Dwells in measured order.
    pub dwells: Vec<CheckedDwell>,
    /// Reading of 0 g and of 1 g by a plain line through the dwells, in the unit of the readings.
    pub offset: Option<f64>,
    /// Reading of 1 g.
    pub amplitude: Option<f64>,
}

/// One dwell.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct CheckedDwell {
    /// File.
    pub file: String,
    /// First line.
    pub line: Option<u64>,
    /// Table angle after sign, zero and orientation, degrees.
    pub angle_deg: f64,
    /// Samples that count.
    pub samples: u64,
    /// From first to last sample, s.
    pub duration_s: Option<f64>,
    /// Samples per second, as recorded.
    pub rate_hz: Option<f64>,
    /// Samples missing between those recorded.
    pub missing: u64,
    /// Rows without a reading.
    pub without_reading: u64,
    /// Samples left out at start and end.
    pub left_out: [u64; 2],
    /// Mean reading.
    pub mean: Option<f64>,
    /// Standard deviation of single readings.
    pub std: Option<f64>,
    /// Lowest and highest code.
    pub extent: Option<[i32; 2]>,
    /// Mean temperature, °C.
    pub temperature_degc: Option<f64>,
    /// Mean minus the plain line through the run's dwells.
    pub off: Option<f64>,
    /// In a word: `ok`, or what is to be looked at (`2 levels`, `drifts`, `outliers`, `angle?`, `off line`, `zeros`,
    /// `at end`, `clock`, `gaps`, `one code`).
    pub state: &'static str,
}

/// Reads an experiment folder and says what is in it.
pub fn check(folder: &Path, watch: &dyn Watch) -> Result<Check, ReadError> {
    let read = read_experiment(folder, watch)?;
    let e = &read.experiment;
    let mut runs: Vec<CheckedRun> = e.runs.iter().map(|r| run(e, r)).collect();
    if let Some(pair) = &e.vertical {
        let upright = Run {
            name: "up/down".into(),
            mounting: pair.run.clone().unwrap_or_default(),
            orientation: tumble_core::Orientation::Normal,
            positions: vec![pair.up.clone(), pair.down.clone()],
            date: None,
        };
        runs.push(run(e, &upright));
    }
    Ok(Check {
        sensor: [e.sensor.model.clone(), e.sensor.serial.clone(), e.sensor.axis.clone()],
        quantizer: quantizer_name(e.output.quantizer).into(),
        unit: e.output.unit.clone(),
        stated_rate_hz: e.output.rate_hz,
        ends: [e.output.ends.min_code.map(|c| c.0), e.output.ends.max_code.map(|c| c.0)],
        gravity_m_s2: e.bench.gravity.value_m_s2,
        gravity_uncertainty_m_s2: e.bench.gravity.standard_uncertainty_m_s2,
        runs,
        remarks: read
            .findings
            .iter()
            .map(|f| format!("{} {}: {}", f.kind.id(), f.headline(), f.observed))
            .collect(),
    })
}

fn run(e: &Experiment, run: &Run) -> CheckedRun {
    let positions: Vec<&Position> = run.positions.iter().collect();
    let look = first_look(&positions, e.output.quantizer);
    let hygiene = data_hygiene(&run.name, &positions, &e.output, &e.bench, &[]);
    let dwells = positions
        .iter()
        .enumerate()
        .map(|(i, p)| {
            let off = look.as_ref().and_then(|l| l.residuals.get(i).copied());
            let noticed = hygiene.noticed.iter().find(|n| n.0 == i).map(|n| n.1);
            dwell(e, p, off, noticed)
        })
        .collect();
    CheckedRun {
        name: run.name.clone(),
        mounting: run.orientation.seating(&run.mounting),
        dwells,
        offset: look.as_ref().map(|l| l.offset),
        amplitude: look.as_ref().map(|l| l.amplitude),
    }
}

fn dwell(
    e: &Experiment,
    p: &Position,
    off: Option<f64>,
    noticed: Option<FindingKind>,
) -> CheckedDwell {
    let facts = dwell_facts(p, &e.output.ends, e.output.rate_hz);
    CheckedDwell {
        file: p.record.file.clone(),
        line: p.record.line,
        angle_deg: p.angle.deg(),
        samples: facts.samples,
        duration_s: facts.duration_s,
        rate_hz: facts.rate_hz,
        missing: facts.missing,
        without_reading: p.record.without_reading,
        left_out: p.record.left_out,
        mean: facts.mean,
        std: facts.std,
        extent: facts.extent.map(|(lo, hi)| [lo, hi]),
        temperature_degc: facts.temperature_degc,
        off,
        state: state(p, &facts, noticed),
    }
}

/// The gravest thing that was noticed of a dwell, in a word.
fn state(p: &Position, facts: &DwellFacts, noticed: Option<FindingKind>) -> &'static str {
    let backwards = p.record.timing.as_ref().is_some_and(|t| t.backwards > 0);
    match (noticed, facts) {
        (Some(FindingKind::ZeroRows), _) => "zeros",
        (Some(FindingKind::MistypedAngle), _) => "angle?",
        (Some(FindingKind::DwellTwoLevels), _) => "2 levels",
        (Some(FindingKind::DwellDrifts), _) => "drifts",
        (Some(FindingKind::OutlyingSamples), _) => "outliers",
        (Some(FindingKind::DwellDoesNotFit), _) => "off line",
        (_, f) if f.at_ends > 0 => "at end",
        _ if backwards => "clock",
        (_, f) if f.missing > 0 => "gaps",
        _ if p.readings.only_code().is_some() => "one code",
        _ => "ok",
    }
}
