//! From a bench's file and flags to the core's problem; what nobody stated is assumed, and said.

use std::path::Path;

use serde::Deserialize;
use tumble_core::plan::{
    Criterion, PlanConverter, PlanNoise, PlanProblem, PlanSystematics, PlanTimes, Possible, Term,
    curvature_of_limit,
};
use tumble_core::{
    Angle, DEFAULT_VERTICAL_LEAN_ARCMIN, Gravity, GravitySource, LimitOf, STANDARD_GRAVITY_M_S2,
    SensorType,
};

use super::PlanSettings;
use crate::catalogue::{Catalogue, UserCatalogue};
use crate::error::{Place, Problem, ReadError};
use crate::experiment_file::{self, BenchTable, SensorTable, SpecTable};
use crate::folder::{EXPERIMENT_FILE, bench_of_table};
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
    let mut gravity = None;
    if let Some(mut table) = file.bench {
        let stated = table.gravity.is_some() || table.latitude_deg.is_some();
        if !stated {
            table.gravity = Some(ASSUMED_GRAVITY_M_S2);
        }
        let bench = bench_of_table(&table)?;
        gravity = Some(bench.gravity).filter(|_| stated);
        s.range_deg = bench.range.map(|(lo, hi)| [lo.deg(), hi.deg()]);
        s.scatter_arcmin = bench.angle_uncertainty.map(Angle::arcmin);
        s.updown_lean_arcmin = table.updown_lean_arcmin;
    }
    if let Some(output) = file.output {
        // Readings in another unit come without steps, or with steps that nobody stated.
        let codes = output.unit.as_deref().is_none_or(|u| u == "LSB");
        s.lsb_m_s2 = output.nominal_scale.filter(|_| codes);
        s.rate_hz = output.rate_hz;
    }
    s.sensor = file.sensor.map(|t| t.model).filter(|m| !m.is_empty());
    s.targets[..3].copy_from_slice(&[
        file.spec.target_bias_m_s2,
        file.spec.target_misalignment_rad,
        file.spec.target_scale_error,
    ]);
    Ok((s, gravity))
}

/// Gravity where nobody stated it: a plan hardly depends on it, its uncertainty is what counts.
const ASSUMED_GRAVITY_M_S2: f64 = 9.81;
/// Noise where nobody stated it and no catalogue knows it, µg/√Hz: of a good MEMS sensor.
const ASSUMED_NOISE_UG_RTHZ: f64 = 100.0;
/// Scatter of setting an angle where nobody stated it: "a few minutes of arc" (method section 1).
const ASSUMED_SCATTER_ARCMIN: f64 = 3.0;
/// The paper's table.
const ASSUMED_RANGE_DEG: f64 = 65.0;
const ASSUMED_STEP_DEG: f64 = 1.0;
/// The paper's rate.
const ASSUMED_RATE_HZ: f64 = 50.0;

fn resolve(
    s: PlanSettings,
    gravity: Option<Gravity>,
    catalogue: &Catalogue,
    path: Option<&Path>,
) -> Result<PlanRequest, ReadError> {
    let mut assumed = Vec::new();
    let entry = match &s.sensor {
        None => None,
        Some(name) => match catalogue.find(name) {
            Some(entry) => Some(&entry.sensor_type),
            // A file's model is free text; a flag means the catalogue.
            None if path.is_some() => None,
            None => return Err(unknown(catalogue, name)),
        },
    };
    let [low, high] = s.range_deg.unwrap_or_else(|| {
        assumed
            .push(format!("a table of -{ASSUMED_RANGE_DEG} to {ASSUMED_RANGE_DEG} deg (--range)"));
        [-ASSUMED_RANGE_DEG, ASSUMED_RANGE_DEG]
    });
    let gravity = gravity_of(&s, gravity, &mut assumed);
    let base = PlanProblem::with_range(Angle::from_deg(ASSUMED_RANGE_DEG));
    let times = times(&s, &base.times, &mut assumed);
    let scatter_arcmin = s.scatter_arcmin.unwrap_or_else(|| {
        assumed
            .push(format!("angles set to {ASSUMED_SCATTER_ARCMIN} arcmin, standard (--scatter)"));
        ASSUMED_SCATTER_ARCMIN
    });
    let step_deg = s.step_deg.unwrap_or_else(|| {
        assumed.push(format!("a dial in steps of {ASSUMED_STEP_DEG} deg (--step)"));
        ASSUMED_STEP_DEG
    });
    let noise = noise(&s, entry, &mut assumed);
    let converter = converter(&s, entry, &mut assumed);
    if s.turn_on_m_s2.is_none() {
        assumed.push("a bias that power-ups do not change (--turn-on)".into());
    }
    let problem = PlanProblem {
        range: (Angle::from_deg(low), Angle::from_deg(high)),
        step: Angle::from_deg(step_deg),
        setting_scatter: Angle::from_arcmin(scatter_arcmin),
        level_scatter_m_s2: s.level_scatter_m_s2.unwrap_or(0.0),
        gravity,
        noise,
        converter,
        turn_on_m_s2: s.turn_on_m_s2,
        systematics: systematics(&s, entry, scatter_arcmin, [low, high], &mut assumed),
        times,
        total_s: s.hours.map(|h| h * 3600.0),
        upright: possible(s.updown),
        remounting: possible(s.remounting),
        further_terms: terms(s.terms.as_deref().unwrap_or_default())?,
        temperature_rise_k: s.temperature_rise_k.unwrap_or(0.0),
        targets: s.targets,
        criterion: criterion(s.criterion.as_deref())?,
        runs: s.runs,
        dwell_s: s.dwell_s,
        spares: s.spares.unwrap_or(base.spares),
        level: s.level.unwrap_or(base.level),
    };
    let sensor = entry.map(|e| e.model.clone()).or(s.sensor).unwrap_or_default();
    Ok(PlanRequest { problem, sensor, assumed })
}

fn possible(stated: Option<bool>) -> Possible {
    if stated == Some(true) { Possible::Yes } else { Possible::No }
}

fn gravity_of(s: &PlanSettings, file: Option<Gravity>, assumed: &mut Vec<String>) -> Gravity {
    match (s.gravity_m_s2, file) {
        (Some(g), _) => Gravity {
            value_m_s2: g,
            standard_uncertainty_m_s2: 0.0,
            source: GravitySource::StatedWithoutUncertainty,
        },
        (None, Some(g)) => g,
        (None, None) => {
            // As good as the formula for a known place below 500 m.
            let formula = Gravity::normal(50.0, 150.0);
            assumed.push("gravity by formula at your place, 29 ppm ([bench] latitude_deg)".into());
            Gravity { value_m_s2: ASSUMED_GRAVITY_M_S2, ..formula }
        }
    }
}

fn times(s: &PlanSettings, base: &PlanTimes, assumed: &mut Vec<String>) -> PlanTimes {
    let mut missing = Vec::new();
    let mut or = |given: Option<f64>, default: f64, what: &str| {
        given.unwrap_or_else(|| {
            missing.push(format!("{default} s {what}"));
            default
        })
    };
    let times = PlanTimes {
        setting_s: or(s.setting_s, base.setting_s, "to set an angle (--set-time)"),
        settle_s: or(s.settle_s, base.settle_s, "to settle (--settle)"),
        restart_s: or(s.restart_s, base.restart_s, "to power up (--restart)"),
        upright_s: s.upright_s.unwrap_or(base.upright_s),
    };
    assumed.extend(missing);
    times
}

fn noise(s: &PlanSettings, entry: Option<&SensorType>, assumed: &mut Vec<String>) -> PlanNoise {
    let ug = 1e-6 * STANDARD_GRAVITY_M_S2;
    // The first mode's, and of several axes the largest.
    let listed = entry.and_then(|e| {
        let mode = e.modes.first().map(|m| m.name.as_str());
        e.limits_for(LimitOf::NoiseDensity, None, mode)
            .filter_map(|l| Some((l.typical.or(l.maximum)?, l.mark)))
            .max_by(|a, b| a.0.total_cmp(&b.0))
    });
    let density = s.noise_ug_rthz.unwrap_or_else(|| match listed {
        Some((density, mark)) => {
            if s.white_m_s2_rts.is_none() {
                assumed.push(format!(
                    "noise of {density} ug/rtHz from the catalogue, {}",
                    mark.words()
                ));
            }
            density
        }
        None => {
            if s.white_m_s2_rts.is_none() {
                assumed.push(format!("noise of {ASSUMED_NOISE_UG_RTHZ} ug/rtHz (--noise)"));
            }
            ASSUMED_NOISE_UG_RTHZ
        }
    });
    if s.bias_instability_ug.is_none()
        && s.random_walk_m_s2_rts.is_none()
        && s.drift_m_s2_h.is_none()
    {
        assumed.push("no drift during a run (--bias-instability, --random-walk, --drift)".into());
    }
    PlanNoise {
        // One-sided density over √2 (metrology notes, section 5).
        white_m_s2_rts: s.white_m_s2_rts.unwrap_or(density * ug / 2f64.sqrt()),
        flicker_m_s2: s.bias_instability_ug.unwrap_or(0.0) * ug,
        walk_m_s2_rts: s.random_walk_m_s2_rts.unwrap_or(0.0),
        ramp_m_s3: s.drift_m_s2_h.unwrap_or(0.0) / 3600.0,
    }
}

fn converter(
    s: &PlanSettings,
    entry: Option<&SensorType>,
    assumed: &mut Vec<String>,
) -> Option<PlanConverter> {
    let digital = || entry?.modes.first()?.nominal_scale_m_s2_per_lsb();
    let Some(lsb_m_s2) = s.lsb_m_s2.or_else(digital) else {
        assumed.push("a converter whose steps do not matter (--lsb)".into());
        return None;
    };
    let rate_hz = s.rate_hz.unwrap_or_else(|| {
        assumed.push(format!("{ASSUMED_RATE_HZ} samples per second (--rate)"));
        ASSUMED_RATE_HZ
    });
    Some(PlanConverter { lsb_m_s2, rate_hz })
}

/// What `certify` takes for the errors of a table that nobody stated: docs/budget.md. The dial is read to no better than it is
/// set, at its ends and about its centre; axis and sensor are level to what a bubble and a hand give.
const ASSUMED_TILT_ARCMIN: f64 = 30.0;
/// K2 in µg/g² and K3 in µg/g³ where neither the user nor the catalogue knows better.
const ASSUMED_CURVATURE_UG: f64 = 100.0;

fn systematics(
    s: &PlanSettings,
    entry: Option<&SensorType>,
    scatter_arcmin: f64,
    range_deg: [f64; 2],
    assumed: &mut Vec<String>,
) -> PlanSystematics {
    let farthest = range_deg.iter().fold(0.0, |a: f64, b| a.max(b.abs())).max(1e-6);
    let as_set_ppm = scatter_arcmin / (60.0 * farthest) * 1e6;
    let dial_scale = s.dial_scale_uncertainty_ppm.unwrap_or(as_set_ppm) * 1e-6;
    let eccentricity = s.eccentricity_arcmin.unwrap_or(scatter_arcmin);
    if s.dial_scale_uncertainty_ppm.is_none() || s.eccentricity_arcmin.is_none() {
        assumed.push("a dial no truer than it is set (--dial-scale, --eccentricity)".into());
    }
    let tilt = s.axis_tilt_arcmin.unwrap_or(ASSUMED_TILT_ARCMIN);
    let leaning = s.sensor_lean_arcmin.unwrap_or(ASSUMED_TILT_ARCMIN);
    if s.axis_tilt_arcmin.is_none() || s.sensor_lean_arcmin.is_none() {
        assumed.push(format!("axis tilt and sensor lean of {ASSUMED_TILT_ARCMIN} arcmin (--tilt)"));
    }
    let lean = s.updown_lean_arcmin.unwrap_or(DEFAULT_VERTICAL_LEAN_ARCMIN);
    if s.updown == Some(true) && s.updown_lean_arcmin.is_none() {
        assumed.push(format!("upright dwells that lean by {lean} arcmin, standard (--lean)"));
    }
    let limit = entry.and_then(nonlinearity);
    let (ug, gn) = (ASSUMED_CURVATURE_UG * 1e-6, STANDARD_GRAVITY_M_S2);
    let (k2, k3) = limit.as_ref().map_or((ug / gn, ug / (gn * gn)), |l| (l.0, l.1));
    match limit {
        Some(l) if s.k2_per_m_s2.is_none() || s.k3_per_m2_s4.is_none() => assumed.push(l.2),
        None if s.k2_per_m_s2.is_none() || s.k3_per_m2_s4.is_none() => {
            let said = format!("K2 and K3 of {ASSUMED_CURVATURE_UG} ug/g2 and ug/g3 (--k2, --k3)");
            assumed.push(said);
        }
        _ => {}
    }
    PlanSystematics {
        dial_scale,
        eccentricity: Angle::from_arcmin(eccentricity),
        dial_zero: Angle::from_arcmin(s.angle_zero_uncertainty_arcmin.unwrap_or(0.0)),
        axis_tilt: Angle::from_arcmin(tilt),
        sensor_lean: Angle::from_arcmin(leaning),
        upright_lean: Angle::from_arcmin(lean),
        k2_per_m_s2: s.k2_per_m_s2.unwrap_or(k2),
        k3_per_m2_s4: s.k3_per_m2_s4.unwrap_or(k3),
    }
}

/// K2 and K3 of a data sheet's nonlinearity, with a sentence.
fn nonlinearity(entry: &SensorType) -> Option<(f64, f64, String)> {
    let full_scale = entry.modes.iter().filter_map(|m| m.range_gn).reduce(f64::min)?;
    let mode = entry.modes.first().map(|m| m.name.as_str());
    let (percent, mark) = entry
        .limits_for(LimitOf::Nonlinearity, None, mode)
        .filter_map(|l| Some((l.typical.or(l.maximum.map(|m| m / 3f64.sqrt()))?, l.mark)))
        .max_by(|a, b| a.0.total_cmp(&b.0))?;
    let (k2, k3) = curvature_of_limit(percent / 100.0, full_scale * STANDARD_GRAVITY_M_S2);
    let said = format!("nonlinearity of {percent:.3} % FS from the catalogue, {}", mark.words());
    Some((k2, k3, said))
}

fn terms(names: &[String]) -> Result<Vec<Term>, ReadError> {
    names
        .iter()
        .map(|name| {
            let known = || Term::ALL[3..].iter().find(|t| t.name().eq_ignore_ascii_case(name));
            known().copied().ok_or_else(|| value("[plan] terms", name, "k2, k3 or temperature"))
        })
        .collect()
}

fn criterion(name: Option<&str>) -> Result<Criterion, ReadError> {
    let Some(name) = name else { return Ok(Criterion::Minimax) };
    [Criterion::Minimax, Criterion::A, Criterion::D]
        .into_iter()
        .find(|c| c.name().eq_ignore_ascii_case(name))
        .ok_or_else(|| value("[plan] criterion", name, "minimax, A or D"))
}

fn unknown(catalogue: &Catalogue, name: &str) -> ReadError {
    let known: Vec<String> = catalogue.nearest(name).into_iter().map(str::to_owned).collect();
    let expected = match known.first() {
        Some(near) => format!("a model of the catalogue, for instance {near}"),
        None => "a model that `tumble catalogue` lists, or --noise instead".into(),
    };
    value("--sensor", name, &expected)
}

fn value(key: &str, given: impl ToString, expected: &str) -> ReadError {
    ReadError {
        place: Place::file(EXPERIMENT_FILE),
        problem: Problem::Value {
            key: key.to_owned(),
            given: given.to_string(),
            expected: expected.to_owned(),
        },
    }
}
