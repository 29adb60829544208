//! What a plan is asked for: a bench's file under flags.

use std::path::Path;

use serde::Deserialize;
use tumble_core::plan::PlanProblem;
use tumble_core::{Angle, Gravity};

use super::PlanSettings;
use super::assumed::{ASSUMED_GRAVITY_M_S2, resolve};
use crate::catalogue::{Catalogue, UserCatalogue};
use crate::error::{Place, Problem, ReadError};
use crate::experiment_file::{self, BenchTable, SensorTable, SpecTable};
use crate::folder::{ConverterKeys, EXPERIMENT_FILE, bench_of_table, systematics_of_tables, value};
use crate::source::{DOCUMENT_LIMIT, read_document};
use crate::toml_text;

/// What a plan is made from.
#[derive(Debug, Clone, PartialEq)]
pub struct PlanRequest {
    /// For the core.
    pub problem: PlanProblem,
    /// Model of the sensor, as the catalogue names it where it knows it.
    pub sensor: String,
    /// What nobody stated, in sentences.
    pub assumed: Vec<String>,
}

/// `bench.toml`.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
struct BenchFile {
    format: Option<u32>,
    sensor: Option<SensorTable>,
    output: Option<OutputPart>,
    bench: Option<BenchTable>,
    plan: Option<PlanSettings>,
    #[serde(default)]
    spec: SpecTable,
}

/// What a plan needs of `[output]`.
#[derive(Debug, Clone, Default, Deserialize)]
#[serde(deny_unknown_fields)]
struct OutputPart {
    #[serde(rename = "quantizer")]
    _quantizer: Option<String>,
    unit: Option<String>,
    nominal_scale: Option<f64>,
    rate_hz: Option<f64>,
    #[serde(rename = "min_code")]
    _min_code: Option<i32>,
    #[serde(rename = "max_code")]
    _max_code: Option<i32>,
    nonlinearity_lsb: Option<f64>,
    reference_uncertainty_ppm: Option<f64>,
}

/// Reads what a plan is asked for: from a `bench.toml` or the `experiment.toml` of a folder (`None`: from flags alone), with
/// flags over it and the catalogue under it.
///
/// **Errors** [`ReadError`] with file and line for what is not understood; an unknown sensor with the nearest known one.
pub fn plan_request(
    path: Option<&Path>,
    flags: PlanSettings,
    catalogue: Option<&UserCatalogue>,
) -> Result<PlanRequest, ReadError> {
    let file = path.map(text_of).transpose()?;
    let (stated, gravity) = match &file {
        None => (flags, None),
        Some(file) => {
            let (own, gravity) = read(file)?;
            (flags.or(own), gravity)
        }
    };
    let mut catalogue_now = Catalogue::builtin().clone();
    if let Some(user) = catalogue {
        catalogue_now = catalogue_now.with(&user.catalogue);
    }
    resolve(stated, gravity, &catalogue_now, path).map_err(|e| match &file {
        Some(file) => file.located(e),
        None => ReadError { place: Place::file("tumble plan"), ..e },
    })
}

/// A file with its name as people gave it.
struct Text {
    text: String,
    shown: String,
    is_experiment: bool,
}

impl Text {
    fn located(&self, mut e: ReadError) -> ReadError {
        if e.place.file == EXPERIMENT_FILE {
            e.place.file.clone_from(&self.shown);
        }
        experiment_file::located(e, &self.text, &self.shown)
    }
}

fn text_of(path: &Path) -> Result<Text, ReadError> {
    let file = if path.is_dir() { path.join(EXPERIMENT_FILE) } else { path.to_path_buf() };
    let shown = file.display().to_string();
    let bytes = read_document(&file, &shown, DOCUMENT_LIMIT)?;
    let text = String::from_utf8(bytes).map_err(|_| ReadError {
        place: Place::file(&shown),
        problem: Problem::Format { seen: "not UTF-8 text", remedy: "save the file as UTF-8" },
    })?;
    let is_experiment = file.file_name().is_some_and(|n| n == EXPERIMENT_FILE);
    Ok(Text { text, shown, is_experiment })
}

/// The settings of a file, and its gravity.
fn read(file: &Text) -> Result<(PlanSettings, Option<Gravity>), ReadError> {
    let parts = if file.is_experiment {
        let e = experiment_file::parse(&file.text, &file.shown)?;
        BenchFile {
            format: e.format,
            sensor: Some(e.sensor),
            output: Some(OutputPart {
                unit: e.output.unit,
                nominal_scale: e.output.nominal_scale,
                rate_hz: e.output.rate_hz,
                nonlinearity_lsb: e.output.nonlinearity_lsb,
                reference_uncertainty_ppm: e.output.reference_uncertainty_ppm,
                ..OutputPart::default()
            }),
            bench: Some(e.bench),
            plan: None,
            spec: e.spec,
        }
    } else {
        toml_text::from_toml(&file.text, &file.shown)?
    };
    settings_of(parts).map_err(|e| file.located(e))
}

fn settings_of(file: BenchFile) -> Result<(PlanSettings, Option<Gravity>), ReadError> {
    if let Some(format) = file.format.filter(|f| *f != 1) {
        return Err(value("format", format, "1: this is a file of a newer version"));
    }
    let mut s = file.plan.unwrap_or_default();
    let output = file.output.unwrap_or_default();
    let converter = ConverterKeys {
        nonlinearity_lsb: output.nonlinearity_lsb,
        reference_uncertainty_ppm: output.reference_uncertainty_ppm,
    };
    let table = file.bench.unwrap_or_default();
    s.systematics = systematics_of_tables(&table, file.sensor.as_ref(), converter)?;
    let stated = table.gravity.is_some() || table.latitude_deg.is_some();
    let assumed = (!stated).then_some(ASSUMED_GRAVITY_M_S2);
    let bench =
        bench_of_table(&BenchTable { gravity: table.gravity.or(assumed), ..table.clone() })?;
    s.range_deg = bench.range.map(|(lo, hi)| [lo.deg(), hi.deg()]);
    s.scatter_arcmin = bench.angle_uncertainty.map(Angle::arcmin);
    s.updown_lean_arcmin = table.updown_lean_arcmin;
    let gravity = Some(bench.gravity).filter(|_| stated);
    // Readings in another unit come without steps, or with steps that nobody stated.
    let codes = output.unit.as_deref().is_none_or(|u| u == "LSB");
    s.lsb_m_s2 = output.nominal_scale.filter(|_| codes);
    s.rate_hz = output.rate_hz;
    if let Some(sensor) = file.sensor {
        s.axis = Some(sensor.axis);
        s.sensor = Some(sensor.model).filter(|m| !m.is_empty());
    }
    s.targets[..3].copy_from_slice(&[
        file.spec.target_bias_m_s2,
        file.spec.target_misalignment_rad,
        file.spec.target_scale_error,
    ]);
    Ok((s, gravity))
}
