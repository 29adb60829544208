//! Limits of the sensor's type: what the catalogue's entry says a unit may show.
//!
//! They warn and never reject: a unit out of its limits with a credible calibration still gets its coefficients.
//! A value counts as outside only where its whole interval is. Nothing is said where the readings' unit, an
//! unknown converter or an unknown rate stands in between.
//!
//! Misalignment is not held against cross-axis sensitivity or package alignment: on a tilt table it holds the seat
//! and the dial's zero as well, which are larger.

use crate::assess::{Influence, PooledParameter, RunAssessment};
use crate::estimate::{Estimate, Parameter};
use crate::sensor_type::{TYPICAL_TO_LIMIT, axis_letter};
use crate::{
    Experiment, Finding, FindingKind, LimitOf, Quantizer, STANDARD_GRAVITY_M_S2, SensorMode,
    SensorType, TypeLimit,
};

/// One thousandth and one millionth of gn, m/s².
const MG_M_S2: f64 = STANDARD_GRAVITY_M_S2 * 1e-3;
const UG_M_S2: f64 = STANDARD_GRAVITY_M_S2 * 1e-6;
/// Noise within a third and three times the data sheet's density is nothing to remark: densities are typical
/// values, and the bandwidth is known within a factor only.
const NOISE_FACTOR: f64 = 3.0;
/// Equivalent noise bandwidth of a one-pole filter over its −3 dB frequency, π/2: what a filter at half the rate
/// lets through beyond an ideal one.
const ONE_POLE_ENBW: f64 = core::f64::consts::FRAC_PI_2;
/// Standard deviation of codes from which a dwell's noise can be told from quantization without the likelihood, LSB.
const DITHERED_LSB: f64 = 0.5;
/// Words shifted by up to so many bits are words of the same sensor: left-justified registers, coarser readings.
const MOST_SHIFT_BITS: f64 = 16.0;

/// A scale within so many octaves of a mode's (19 %) is that mode's, however another one would fit with shifted
/// words: twice the widest tolerance of data sheets.
const NEAR_OCTAVES: f64 = 0.25;

/// Everything that the limits are held against.
#[derive(Debug, Clone, Copy)]
pub struct Judged<'a> {
    /// What was measured; its sensor may name a type.
    pub experiment: &'a Experiment,
    /// `k0`.
    pub nominal_scale_m_s2_per_lsb: f64,
    /// The runs.
    pub runs: &'a [RunAssessment],
    /// The runs together.
    pub pooled: &'a [PooledParameter],
    /// Temperature and signal level.
    pub influence: &'a Influence,
}

/// What lies outside of the limits of the sensor's type; nothing without a type.
#[must_use]
pub fn type_limits(judged: &Judged<'_>) -> Vec<Finding> {
    let Some(kind) = &judged.experiment.sensor.kind else { return Vec::new() };
    let axis = axis_letter(&judged.experiment.sensor.axis);
    let pooled = |parameter| judged.pooled.iter().find(|p| p.parameter == parameter);
    let scale = pooled(Parameter::ScaleError).map(|p| Interval {
        value: judged.nominal_scale_m_s2_per_lsb * (1.0 + p.value),
        expanded: judged.nominal_scale_m_s2_per_lsb * expanded(p, judged.runs),
    });
    let matched = scale.and_then(|s| nearest_mode(kind, &judged.experiment.output.unit, s.value));
    let mode = matched.as_ref().map(|m| m.mode.name.as_str());
    let mut findings = Vec::new();
    if let (Some(scale), Some(matched)) = (scale, &matched) {
        findings.extend(sensitivity(kind, matched, scale, &judged.experiment.output.unit));
    }
    if let Some(bias) = pooled(Parameter::Bias) {
        let bias = Interval { value: bias.value, expanded: expanded(bias, judged.runs) };
        findings.extend(zero_g(kind, axis, mode, bias));
    }
    if let (Some(rate_hz), Some(scale)) = (judged.experiment.output.rate_hz, scale) {
        let quantizer = judged.experiment.output.quantizer;
        let of_run = |r| noise(kind, axis, mode, r, quantizer, scale.value, rate_hz);
        findings.extend(judged.runs.iter().filter_map(of_run));
    }
    if let Some(t) = &judged.influence.temperature {
        let effect = Interval { value: t.effect, expanded: t.expanded_uncertainty };
        findings.extend(temperature(kind, axis, mode, effect));
    }
    findings
}

#[derive(Debug, Clone, Copy)]
struct Interval {
    value: f64,
    expanded: f64,
}

impl Interval {
    fn surely_beyond(self, limit: f64) -> bool {
        self.value.abs() - self.expanded > limit
    }
}

/// Expanded uncertainty, not below what the plan gives at zero errors: where parameters are hardly determined the
/// estimate is far off, and its covariance means little.
fn expanded(p: &PooledParameter, runs: &[RunAssessment]) -> f64 {
    let planned = |e: &Estimate| e.plan_uncertainty.map_or(0.0, |u| u[p.parameter.index()]);
    let best = runs.iter().filter_map(|r| r.estimate.as_ref()).map(planned).reduce(f64::min);
    let planned = best.unwrap_or(0.0) / (p.runs.max(1) as f64).sqrt();
    p.coverage_factor * p.standard_uncertainty.max(planned)
}

/// The mode that a scale factor fits best.
struct Matched<'a> {
    mode: &'a SensorMode,
    nominal_m_s2_per_unit: f64,
    /// Bits by which the words are shifted against the mode.
    shift: f64,
}

/// The mode that is near as it stands, else the one that is near with the fewest bits of shift, else the nearest.
fn nearest_mode<'a>(kind: &'a SensorType, unit: &str, scale: f64) -> Option<Matched<'a>> {
    let mut candidates: Vec<(f64, Matched<'_>)> = Vec::new();
    for mode in &kind.modes {
        let Some(nominal) = mode.nominal_scale_m_s2_per(unit) else { continue };
        let octaves = (scale / nominal).log2();
        if !octaves.is_finite() {
            continue;
        }
        let shift = match unit {
            "LSB" => octaves.round().clamp(-MOST_SHIFT_BITS, MOST_SHIFT_BITS),
            _ => 0.0,
        };
        let matched = Matched { mode, nominal_m_s2_per_unit: nominal * shift.exp2(), shift };
        candidates.push(((octaves - shift).abs(), matched));
    }
    let is_near = |distance: f64| distance < NEAR_OCTAVES;
    candidates
        .into_iter()
        .min_by(|(a, m), (b, n)| {
            let near_first = is_near(*b).cmp(&is_near(*a));
            let fewest_bits = match is_near(*a) && is_near(*b) {
                true => m.shift.abs().total_cmp(&n.shift.abs()),
                false => std::cmp::Ordering::Equal,
            };
            near_first.then(fewest_bits).then(a.total_cmp(b))
        })
        .map(|(_, m)| m)
}

fn finding(place: &str, observed: String, limit: String, remedy: String) -> Finding {
    Finding {
        kind: FindingKind::OutsideTypeLimits,
        place: place.to_owned(),
        observed,
        limit,
        remedy,
    }
}

/// A product of a catalogue's number as a person writes it: without the last bits of binary arithmetic.
fn plain(v: f64) -> f64 {
    format!("{v:.9e}").parse().unwrap_or(v)
}

fn source(kind: &SensorType) -> String {
    format!("catalogue: {}, {}", kind.catalogue, kind.source)
}

fn sensitivity(
    kind: &SensorType,
    matched: &Matched<'_>,
    scale: Interval,
    unit: &str,
) -> Option<Finding> {
    let (tolerance, mark) = matched.mode.tolerance?;
    let ratio = scale.value / matched.nominal_m_s2_per_unit;
    // Data sheets limit the sensitivity, the reciprocal of the scale factor.
    let deviation =
        Interval { value: 1.0 / ratio - 1.0, expanded: scale.expanded / scale.value / ratio };
    if !deviation.surely_beyond(tolerance) {
        return None;
    }
    let mode = matched.mode;
    let mark = mark.min(mode.mark);
    let shifted = if matched.shift == 0.0 {
        String::new()
    } else {
        let way = if matched.shift > 0.0 { "right" } else { "left" };
        format!(", words shifted {way} by {:.0} bit", matched.shift.abs())
    };
    let supply = if kind.ratiometric { "its sensitivity follows the supply, " } else { "" };
    Some(finding(
        "scale factor",
        format!(
            "sensitivity {:+.2} % from nominal, ± {:.2} % ({:.6} m/s² per {unit}{shifted}), beyond ± {} % ({})",
            100.0 * deviation.value,
            100.0 * deviation.expanded,
            scale.value,
            plain(100.0 * tolerance),
            mark.words()
        ),
        format!(
            "{} {}: {} {} ± {} % ({}; {})",
            kind.model,
            mode.name,
            mode.sensitivity,
            mode.unit.name(),
            plain(100.0 * tolerance),
            mark.words(),
            source(kind)
        ),
        format!(
            "check the sensor's range or supply ({supply}a divider and the converter's reference come in as well), local gravity, and that the part is of type {}",
            kind.model
        ),
    ))
}

/// The widest of several limits: a maximum where there is one.
fn widest<'a>(limits: impl Iterator<Item = &'a TypeLimit>) -> Option<&'a TypeLimit> {
    limits.filter(|l| l.bound().is_some()).max_by(|a, b| {
        let key = |l: &TypeLimit| (l.maximum.is_some(), l.bound().unwrap_or(0.0));
        let (x, y) = (key(a), key(b));
        x.0.cmp(&y.0).then(x.1.total_cmp(&y.1))
    })
}

fn limit_text(kind: &SensorType, limit: &TypeLimit) -> String {
    let unit = limit.of.unit();
    let size = match (limit.maximum, limit.typical) {
        (Some(most), _) => format!("± {most} {unit} at most"),
        (None, Some(typical)) => format!(
            "± {} {unit}, {TYPICAL_TO_LIMIT} times the typical {typical} {unit}",
            plain(TYPICAL_TO_LIMIT * typical)
        ),
        (None, None) => String::new(),
    };
    format!("{} {}: {size} ({}; {})", kind.model, limit.of.name(), limit.mark.words(), source(kind))
}

fn zero_g(
    kind: &SensorType,
    axis: Option<char>,
    mode: Option<&str>,
    bias: Interval,
) -> Option<Finding> {
    let limit = widest(kind.limits_for(LimitOf::ZeroG, axis, mode))?;
    let bound = limit.bound()?;
    if !bias.surely_beyond(bound * MG_M_S2) {
        return None;
    }
    Some(finding(
        "bias",
        format!(
            "bias {:+.1} mg, ± {:.1} mg ({:+.4} m/s²), beyond ± {} mg ({})",
            bias.value / MG_M_S2,
            bias.expanded / MG_M_S2,
            bias.value,
            plain(bound),
            limit.mark.words()
        ),
        limit_text(kind, limit),
        format!(
            "the limit is for a part by itself at room temperature: check stress from mounting and soldering, the supply, the converter's offset and reference, and that the part is of type {}",
            kind.model
        ),
    ))
}

fn temperature(
    kind: &SensorType,
    axis: Option<char>,
    mode: Option<&str>,
    effect: Interval,
) -> Option<Finding> {
    let limit = widest(kind.limits_for(LimitOf::ZeroGTempco, axis, mode))?;
    let bound = limit.bound()?;
    if !effect.surely_beyond(bound * MG_M_S2) {
        return None;
    }
    Some(finding(
        "temperature",
        format!(
            "the bias changes by {:+.2} mg/K, ± {:.2} mg/K, beyond ± {} mg/K ({})",
            effect.value / MG_M_S2,
            effect.expanded / MG_M_S2,
            plain(bound),
            limit.mark.words()
        ),
        limit_text(kind, limit),
        "something else drifts with the temperature: the mounting, the table, the supply or the converter; let all of it warm up, or warm the sensor alone".into(),
    ))
}

/// Noise of a run as a one-sided density, µg/√Hz: lowest and highest that the data allow.
///
/// For white noise n² = 2σ²/rate. With a filter below half the rate neighbouring samples go together, and the
/// variance of a dwell's mean (`inflation`) makes up for what single samples do not show; noise above half the
/// rate folds into it.
fn density(
    run: &RunAssessment,
    quantizer: Quantizer,
    scale: f64,
    rate_hz: f64,
) -> Option<(f64, f64)> {
    let scatter = run.estimate.as_ref().and_then(|e| e.scatter);
    let (low, high) = match (scatter, run.reading_std_lsb) {
        (Some(s), _) => {
            let noise = s.noise_lsb?;
            let low = if s.noise_is_bound { 0.0 } else { noise.low };
            (low, noise.high * s.inflation.max(1.0).sqrt())
        }
        (None, Some(std)) if quantizer == Quantizer::None => (std, std),
        (None, Some(std)) if std >= DITHERED_LSB => {
            let own = (std * std - 1.0 / 12.0).sqrt();
            (own, own)
        }
        _ => return None,
    };
    let per_lsb = scale * (2.0 / rate_hz).sqrt() / UG_M_S2;
    Some((low * per_lsb, high * per_lsb))
}

fn noise(
    kind: &SensorType,
    axis: Option<char>,
    mode: Option<&str>,
    run: &RunAssessment,
    quantizer: Quantizer,
    scale: f64,
    rate_hz: f64,
) -> Option<Finding> {
    let limits: Vec<&TypeLimit> = kind
        .limits_for(LimitOf::NoiseDensity, axis, mode)
        .filter(|l| l.bound().is_some())
        .collect();
    let least = |l: &&TypeLimit| l.typical.or(l.maximum);
    let floor = limits.iter().filter_map(least).reduce(f64::min)? / NOISE_FACTOR;
    let most = |l: &&TypeLimit| l.maximum.or(l.typical);
    let ceiling =
        limits.iter().filter_map(most).reduce(f64::max)? * NOISE_FACTOR * ONE_POLE_ENBW.sqrt();
    let (low, high) = density(run, quantizer, scale, rate_hz)?;
    let mark = limits.iter().map(|l| l.mark).min()?;
    let remedy = if high < floor {
        format!(
            "no part of type {} is that quiet: check rate_hz, whether the logger averages or repeats samples, and the model",
            kind.model
        )
    } else if low > ceiling {
        "keep the table from vibrating, and filter before the converter: noise above half the rate folds down; then check supply, grounding and rate_hz".into()
    } else {
        return None;
    };
    Some(finding(
        &run.name,
        format!(
            "noise within dwells {} µg/√Hz at {rate_hz} samples/s, outside {floor:.0} to {ceiling:.0} ({})",
            range(low, high),
            mark.words()
        ),
        format!(
            "{} noise density: {floor:.0} to {ceiling:.0} µg/√Hz, a third to three times the data sheet's through a one-pole filter ({}; {})",
            kind.model,
            mark.words(),
            source(kind)
        ),
        remedy,
    ))
}

fn range(low: f64, high: f64) -> String {
    match (low, high) {
        (l, h) if l <= 0.0 => format!("below {h:.2}"),
        (l, h) if (h - l) < 0.02 * h => format!("{:.1}", 0.5 * (l + h)),
        (l, h) => format!("{l:.1} to {h:.1}"),
    }
}
