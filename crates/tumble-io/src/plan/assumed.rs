//! From settings to the core's problem: what nobody stated is assumed as `certify` assumes it, and said.

use std::path::Path;

use tumble_core::plan::{
    Criterion, PlanConverter, PlanNoise, PlanProblem, PlanTimes, Possible, Term,
};
use tumble_core::systematic::{Inputs, Quantity, Systematics};
use tumble_core::{
    Angle, Bench, ConverterEnds, DEFAULT_VERTICAL_LEAN_ARCMIN, Gravity, GravitySource, LimitOf,
    Output, Quantizer, STANDARD_GRAVITY_M_S2, Sensor, SensorType,
};

use super::{PlanRequest, PlanSettings};
use crate::catalogue::Catalogue;
use crate::error::ReadError;
use crate::folder::value;

/// Gravity where nobody stated it: a plan hardly depends on it, its uncertainty is what counts.
pub(super) const ASSUMED_GRAVITY_M_S2: f64 = 9.81;
/// Noise where nobody stated it and no catalogue knows it, µg/√Hz: of a good MEMS sensor.
const ASSUMED_NOISE_UG_RTHZ: f64 = 100.0;
/// Scatter of setting an angle where nobody stated it: "a few minutes of arc" (method section 1).
const ASSUMED_SCATTER_ARCMIN: f64 = 3.0;
/// The paper's table.
const ASSUMED_RANGE_DEG: f64 = 65.0;
const ASSUMED_STEP_DEG: f64 = 1.0;
/// The paper's rate.
const ASSUMED_RATE_HZ: f64 = 50.0;

/// The sentences about what nobody stated.
#[derive(Default)]
struct Assumed(Vec<String>);

impl Assumed {
    /// A stated value, or a default with a sentence.
    fn or<T>(&mut self, stated: Option<T>, default: T, sentence: impl FnOnce() -> String) -> T {
        stated.unwrap_or_else(|| {
            self.0.push(sentence());
            default
        })
    }
}

pub(super) fn resolve(
    s: PlanSettings,
    gravity: Option<Gravity>,
    catalogue: &Catalogue,
    path: Option<&Path>,
) -> Result<PlanRequest, ReadError> {
    let mut assumed = Assumed::default();
    if let Some(rate_hz) = s.rate_hz.filter(|r| !(r.is_finite() && *r > 0.0)) {
        return Err(value("rate_hz", rate_hz, "samples per second, more than zero"));
    }
    let entry = match &s.sensor {
        None => None,
        Some(name) => sensor_type(catalogue, name, path)?,
    };
    let [low, high] = assumed.or(s.range_deg, [-ASSUMED_RANGE_DEG, ASSUMED_RANGE_DEG], || {
        format!("a table of -{ASSUMED_RANGE_DEG} to {ASSUMED_RANGE_DEG} deg (--range)")
    });
    let range = (Angle::from_deg(low), Angle::from_deg(high));
    let gravity = gravity_of(&s, gravity, &mut assumed);
    let base = PlanProblem::with_range(Angle::from_deg(ASSUMED_RANGE_DEG));
    let times = times(&s, &base.times, &mut assumed);
    let scatter_arcmin = assumed.or(s.scatter_arcmin, ASSUMED_SCATTER_ARCMIN, || {
        format!("angles set to {ASSUMED_SCATTER_ARCMIN} arcmin, standard (--scatter)")
    });
    let step_deg = assumed.or(s.step_deg, ASSUMED_STEP_DEG, || {
        format!("a dial in steps of {ASSUMED_STEP_DEG} deg (--step)")
    });
    let converter = converter(&s, entry, &mut assumed);
    let noise = noise(&s, entry, converter, &mut assumed);
    if s.turn_on_m_s2.is_none() {
        assumed.0.push("a bias that power-ups do not change (--turn-on)".into());
    }
    let lean = lean_arcmin(&s, &mut assumed);
    let further_terms = terms(s.terms.as_deref().unwrap_or_default())?;
    let systematics = systematics(&s, entry, gravity, range, &further_terms, &mut assumed);
    let problem = PlanProblem {
        range,
        step: Angle::from_deg(step_deg),
        setting_scatter: Angle::from_arcmin(scatter_arcmin),
        level_scatter_m_s2: s.level_scatter_m_s2.unwrap_or(0.0),
        gravity,
        noise,
        converter,
        turn_on_m_s2: s.turn_on_m_s2,
        systematics,
        upright_lean: Angle::from_arcmin(lean),
        times,
        total_s: s.hours.map(|h| h * 3600.0),
        upright: possible(s.updown),
        remounting: possible(s.remounting),
        further_terms,
        targets: s.targets,
        criterion: criterion(s.criterion.as_deref())?,
        runs: s.runs,
        dwell_s: s.dwell_s,
        spares: s.spares.unwrap_or(base.spares),
        level: s.level.unwrap_or(base.level),
    };
    let sensor = entry.map(|e| e.model.clone()).or(s.sensor).unwrap_or_default();
    Ok(PlanRequest { problem, sensor, assumed: assumed.0 })
}

/// A file's model is free text; a flag means the catalogue.
fn sensor_type<'a>(
    catalogue: &'a Catalogue,
    name: &str,
    path: Option<&Path>,
) -> Result<Option<&'a SensorType>, ReadError> {
    match catalogue.find(name) {
        Some(entry) => Ok(Some(&entry.sensor_type)),
        None if path.is_some() => Ok(None),
        None => Err(unknown(catalogue, name)),
    }
}

/// Lean of upright dwells; a sentence only where there are any.
fn lean_arcmin(s: &PlanSettings, assumed: &mut Assumed) -> f64 {
    let lean = s.updown_lean_arcmin.unwrap_or(DEFAULT_VERTICAL_LEAN_ARCMIN);
    if s.updown == Some(true) && s.updown_lean_arcmin.is_none() {
        assumed.0.push(format!("upright dwells that lean by {lean} arcmin, standard (--lean)"));
    }
    lean
}

fn possible(stated: Option<bool>) -> Possible {
    if stated == Some(true) { Possible::Yes } else { Possible::No }
}

fn gravity_of(s: &PlanSettings, file: Option<Gravity>, assumed: &mut Assumed) -> Gravity {
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
            let sentence = "gravity by formula at your place, 29 ppm ([bench] latitude_deg)";
            assumed.0.push(sentence.into());
            Gravity { value_m_s2: ASSUMED_GRAVITY_M_S2, ..formula }
        }
    }
}

fn times(s: &PlanSettings, base: &PlanTimes, assumed: &mut Assumed) -> PlanTimes {
    let mut or = |given: Option<f64>, default: f64, what: &str| {
        assumed.or(given, default, || format!("{default} s {what}"))
    };
    PlanTimes {
        setting_s: or(s.setting_s, base.setting_s, "to set an angle (--set-time)"),
        settle_s: or(s.settle_s, base.settle_s, "to settle (--settle)"),
        restart_s: or(s.restart_s, base.restart_s, "to power up (--restart)"),
        upright_s: s.upright_s.unwrap_or(base.upright_s),
    }
}

/// Noise by figures, by what `tumble noise` found, by the catalogue, in this order.
fn noise(
    s: &PlanSettings,
    entry: Option<&SensorType>,
    converter: Option<PlanConverter>,
    assumed: &mut Assumed,
) -> PlanNoise {
    let ug = 1e-6 * STANDARD_GRAVITY_M_S2;
    let known = s.known_noise;
    let white = s
        .white_m_s2_rts
        .or(s.noise_ug_rthz.map(|density| PlanNoise::white_of_density(density * ug)))
        .or(known.map(|k| without_rounding(k, converter)))
        .unwrap_or_else(|| {
            let (density, sentence) = density(entry);
            assumed.0.push(sentence);
            PlanNoise::white_of_density(density * ug)
        });
    let slow = [s.bias_instability_ug, s.random_walk_m_s2_rts, s.drift_m_s2_h];
    if known.is_none() && slow.iter().all(Option::is_none) {
        let sentence = "no drift during a run (--bias-instability, --random-walk, --drift)";
        assumed.0.push(sentence.into());
    }
    PlanNoise {
        white_m_s2_rts: white,
        flicker_m_s2: s
            .bias_instability_ug
            .map(|b| b * ug)
            .or(known.map(|k| k.flicker_m_s2))
            .unwrap_or(0.0),
        walk_m_s2_rts: s.random_walk_m_s2_rts.or(known.map(|k| k.walk_m_s2_per_rts)).unwrap_or(0.0),
        ramp_m_s3: s.drift_m_s2_h.map(|d| d / 3600.0).or(known.map(|k| k.ramp_m_s3)).unwrap_or(0.0),
    }
}

/// N of the sensor alone: where codes were recorded, the rounding that the converter adds to every reading is in it, and
/// the plan reckons with that by itself.
fn without_rounding(known: crate::noise::KnownNoise, converter: Option<PlanConverter>) -> f64 {
    let rounding = known.rounding_m_s2_rts.filter(|_| converter.is_some()).unwrap_or(0.0);
    PlanNoise::white_without_rounding(known.white_m_s2_rts, rounding)
}

/// Density of the catalogue's first mode (of several axes the largest) or a usual one, µg/√Hz, with a sentence.
fn density(entry: Option<&SensorType>) -> (f64, String) {
    let listed = entry.and_then(|e| {
        let mode = e.modes.first().map(|m| m.name.as_str());
        e.limits_for(LimitOf::NoiseDensity, None, mode)
            .filter_map(|l| Some((l.typical.or(l.maximum)?, l.mark)))
            .max_by(|a, b| a.0.total_cmp(&b.0))
    });
    match listed {
        Some((v, mark)) => {
            (v, format!("noise of {v} ug/rtHz from the catalogue, {} (--noise)", mark.words()))
        }
        None => {
            let v = ASSUMED_NOISE_UG_RTHZ;
            (v, format!("noise of {v} ug/rtHz (--noise, --noise-file)"))
        }
    }
}

fn converter(
    s: &PlanSettings,
    entry: Option<&SensorType>,
    assumed: &mut Assumed,
) -> Option<PlanConverter> {
    let known = s.known_noise;
    let digital = || entry?.modes.first()?.nominal_scale_m_s2_per_lsb();
    let lsb_m_s2 = s.lsb_m_s2.or_else(|| known?.lsb_m_s2).or_else(digital);
    let Some(lsb_m_s2) = lsb_m_s2 else {
        assumed.0.push("a converter whose steps do not matter (--lsb)".into());
        return None;
    };
    let rate_hz = s.rate_hz.or(known.map(|k| k.rate_hz));
    let rate_hz = assumed
        .or(rate_hz, ASSUMED_RATE_HZ, || format!("{ASSUMED_RATE_HZ} samples per second (--rate)"));
    Some(PlanConverter { lsb_m_s2, rate_hz })
}

/// A line of the budget with what people call it, the flag that states it, and whether that was done.
type Stating = (Quantity, &'static str, &'static str, fn(&Systematics) -> bool);
const STATING: [Stating; 5] = [
    (Quantity::DialScale, "scale of the dial", "--dial-scale", |s| s.dial_scale.is_some()),
    (Quantity::EccentricitySine, "eccentricity of the dial", "--eccentricity", |s| {
        s.eccentricity.is_some()
    }),
    (Quantity::TiltTimesLean, "level", "--tilt", |s| {
        s.axis_tilt.is_some() && s.sensor_lean.is_some()
    }),
    (Quantity::Quadratic, "K2", "--k2", |s| s.k2_per_m_s2.is_some()),
    (Quantity::Cubic, "K3", "--k3", |s| s.k3_per_m2_s4.is_some()),
];

/// What the budget will hold, with its defaults: `docs/budget.md`.
fn systematics(
    s: &PlanSettings,
    entry: Option<&SensorType>,
    gravity: Gravity,
    range: (Angle, Angle),
    fitted: &[Term],
    assumed: &mut Assumed,
) -> Inputs {
    let sensor = Sensor {
        model: String::new(),
        serial: String::new(),
        axis: s.axis.clone().unwrap_or_default(),
        kind: entry.cloned(),
    };
    let output = Output {
        quantizer: Quantizer::Round,
        unit: "LSB".into(),
        nominal_scale_m_s2_per_lsb: s.lsb_m_s2,
        rate_hz: s.rate_hz,
        ends: ConverterEnds::default(),
    };
    let bench = Bench {
        gravity,
        angle_uncertainty: s.scatter_arcmin.map(Angle::from_arcmin),
        range: Some(range),
        vertical_lean: Angle::from_rad(0.0),
        systematics: s.systematics,
    };
    let first = || entry?.modes.first()?.nominal_scale_m_s2_per_lsb();
    let k0 = s.lsb_m_s2.or_else(first).unwrap_or(1.0);
    let inputs = Inputs::before_any_run(&sensor, &output, &bench, Angle::from_rad(0.0), k0);
    let is_fitted = |q| fitted.iter().any(|t| t.replaces() == Some(q));
    for (quantity, name, flag, is_stated) in STATING {
        let Some(line) = inputs.of_quantity(quantity) else { continue };
        if line.standard_uncertainty > 0.0 && !is_stated(&s.systematics) && !is_fitted(quantity) {
            let why = line.source.trim_start_matches("default: ");
            assumed.0.push(format!("{name}: {why} ({flag})"));
        }
    }
    if fitted.iter().any(|t| t.needs_temperature()) && s.systematics.temperature_spread_k.is_none()
    {
        let k = inputs.temperature_spread_k;
        assumed.0.push(format!("a rise of {k} K during a run (--temperature-rise)"));
    }
    inputs
}

fn terms(names: &[String]) -> Result<Vec<Term>, ReadError> {
    let further = || Term::ALL.into_iter().filter(|t| t.further().is_some());
    names
        .iter()
        .map(|name| {
            let name = name.trim();
            further().find(|t| t.name().eq_ignore_ascii_case(name)).ok_or_else(|| {
                let all: Vec<&str> = further().map(Term::name).collect();
                value("terms", name, &all.join(", "))
            })
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
