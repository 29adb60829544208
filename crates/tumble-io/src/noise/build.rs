//! From the analysis to the document: shapes, units and sentences.

use tumble_core::noise::{
    BestDwell, Coefficient, ConverterFloor, NoiseAnalysis, NoiseCurve, NoiseFit, NoisePoint,
    NoiseRemark, QUIET_JITTER, SHEET_UNITS,
};

use super::reader::Read;
use super::{
    CoefficientEntry, ConverterEntry, CurveEntry, DwellEntry, FIT_LEVEL, FitEntry, ModelEntry,
    NoiseDocument, NoiseInput, NoiseScale, NoiseSettings, NoiseSoftware, PointEntry, SCHEMA,
    SheetEntry,
};
use crate::csv::HeaderUnit;

/// Symbols, words and the unit behind that of the readings.
const COEFFICIENTS: [(&str, &str, &str); 5] = [
    ("Q", "quantization (white velocity)", " s"),
    ("N", "velocity random walk (white)", " rts"),
    ("B", "bias instability (flicker)", ""),
    ("K", "random walk of the bias", "/rts"),
    ("R", "ramp", "/s"),
];
/// Places of the fitted curve.
const CURVE_PLACES: usize = 61;

pub(super) fn build(
    file: &str,
    settings: &NoiseSettings,
    read: &Read,
    a: &NoiseAnalysis,
) -> NoiseDocument {
    let unit = match (&settings.scale, a.whole) {
        (Some(_), _) => "m/s2",
        (None, true) => "LSB",
        (None, false) => "unit",
    };
    let times = read.times.as_ref();
    NoiseDocument {
        schema: SCHEMA.into(),
        input: NoiseInput {
            file: file.to_owned(),
            sha256: read.sha256.clone(),
            column: read.column.clone(),
            readings: a.readings,
            rate_hz: 1.0 / a.interval_s,
            rate_from: if times.is_some() { "times" } else { "rate" }.into(),
            time_column: read.time_column.clone(),
            jitter: times.map(|t| t.jitter()),
            pieces: a.pieces.clone(),
            missing: times.map_or(0, |t| t.missing()),
            rows_without_reading: read.without,
        },
        unit: unit.into(),
        scale: settings
            .scale
            .as_ref()
            .map(|s| NoiseScale { m_s2_per_unit: s.m_s2_per_unit, source: s.source.clone() }),
        mean: a.mean,
        standard_deviation: a.standard_deviation,
        extremes: a.extremes,
        level: settings.level,
        curves: a.curves.iter().map(curve).collect(),
        fit: a.fit.as_ref().map(|f| fit(f, a, unit)),
        converter: a.floor.map(|c| converter(&c, a)),
        dwell: a.dwell.map(|d| DwellEntry {
            tau_s: d.tau_s,
            deviation: d.deviation,
            least: d.least,
            least_tau_s: d.least_tau_s,
            shares: d.shares,
            still_falling: d.still_falling,
            why: why(&d, a),
        }),
        remarks: remarks(read, settings, a),
        software: NoiseSoftware {
            name: "tumble".into(),
            version: env!("CARGO_PKG_VERSION").into(),
            edf: "Greenhall and Riley 2003, averages continuous for alpha <= 0; total: SP 1065, \
                  5.11"
                .into(),
        },
    }
}

fn curve(c: &NoiseCurve) -> CurveEntry {
    let point = |p: &NoisePoint| PointEntry {
        tau_s: p.variance.tau_s,
        factor: p.variance.factor as u64,
        terms: p.variance.terms as u64,
        deviation: p.variance.variance.sqrt(),
        kind: p.kind.map(|k| k.words().to_owned()),
        kind_is_carried: p.kind_is_carried,
        edf: p.edf,
        band: p.band,
    };
    CurveEntry {
        deviation: c.deviation.name().into(),
        points: c.points.iter().map(point).collect(),
    }
}

/// An interval whose upper end may be open.
fn open([low, high]: [f64; 2]) -> (f64, Option<f64>) {
    (low, Some(high).filter(|h| h.is_finite()))
}

fn fit(f: &NoiseFit, a: &NoiseAnalysis, unit: &str) -> FitEntry {
    let coefficient = |(i, c): (usize, &Coefficient)| {
        let (symbol, name, behind) = COEFFICIENTS[i];
        let sheet = SHEET_UNITS.iter().filter(|u| u.coefficient == i && unit == "m/s2");
        CoefficientEntry {
            symbol: symbol.into(),
            name: name.into(),
            // A velocity is no product of an acceleration for people.
            unit: match (i, unit) {
                (0, "m/s2") => "m/s".into(),
                (1, "m/s2") => "m/s/rts".into(),
                (4, "m/s2") => "m/s3".into(),
                _ => format!("{unit}{behind}"),
            },
            value: c.value,
            standard_uncertainty: c.standard_uncertainty,
            interval: open(c.interval),
            sheet: sheet
                .map(|u| SheetEntry {
                    unit: u.unit.into(),
                    meaning: u.meaning.into(),
                    value: u.of(c.value),
                    interval: open(c.interval.map(|v| u.of(v))),
                })
                .collect(),
        }
    };
    let points = a.curves.first().map_or(&[][..], |c| &c.points);
    let curve = match (points.first(), points.last()) {
        (Some(first), Some(last)) => {
            f.curve(first.variance.tau_s, last.variance.tau_s, CURVE_PLACES)
        }
        _ => Vec::new(),
    };
    let place = |(tau_s, deviation, parts)| ModelEntry { tau_s, deviation, parts };
    FitEntry {
        level: FIT_LEVEL,
        coefficients: f.coefficients.iter().enumerate().map(coefficient).collect(),
        chi_squared: f.chi_squared,
        discrepancy: f.discrepancy,
        degrees_of_freedom: f.degrees_of_freedom as u64,
        p: a.fit_p,
        curve: curve.into_iter().map(place).collect(),
    }
}

fn converter(c: &ConverterFloor, a: &NoiseAnalysis) -> ConverterEntry {
    let points = a.curves.first().filter(|_| c.dithered).map_or(&[][..], |c| &c.points);
    let ends = points.first().into_iter().chain(points.last());
    ConverterEntry {
        step: c.step,
        of_a_reading: c.of_a_reading,
        n: c.n,
        noise_in_steps: c.noise_in_steps,
        dithered: c.dithered,
        line: ends.map(|p| [p.variance.tau_s, c.at(p.variance.tau_s)]).collect(),
    }
}

fn why(d: &BestDwell, a: &NoiseAnalysis) -> String {
    if a.floor.is_some_and(|c| !c.dithered) {
        return "the curve is the converter's, for noise below half a step hides in its steps; take no dwell from it".into();
    }
    let share = d.shares.and_then(|s| {
        s.into_iter().enumerate().max_by(|a, b| a.1.total_cmp(&b.1)).map(|(i, s)| (i, 100.0 * s))
    });
    let what = match share {
        Some((0, s)) => format!(" ({s:.0} % of the variance there is quantization)"),
        Some((1, s)) => format!(" ({s:.0} % of the variance there is white noise)"),
        Some((2, s)) => format!(" ({s:.0} % of the variance there is flicker)"),
        Some((3, s)) => format!(" ({s:.0} % of the variance there is random walk)"),
        Some((_, s)) => format!(" ({s:.0} % of the variance there is a ramp)"),
        None => String::new(),
    };
    if d.still_falling {
        return format!(
            "the deviation still falls at the longest time of the record{what}: longer dwells gain, and only a longer record \
             can say up to where"
        );
    }
    format!(
        "the shortest time whose deviation is within a tenth of the least{what}; longer dwells gain nothing: flicker does not \
         average out, and slow changes of the bias grow"
    )
}

/// What the readings and times are said to be, and may not be.
fn units_in_doubt(read: &Read, settings: &NoiseSettings, out: &mut Vec<String>) {
    if let Some(step_s) = read.slow_s {
        out.push(format!(
            "the times are whole numbers that step by {step_s:.0}, and were taken as seconds: if they are milliseconds, give \
             --time-unit ms"
        ));
    }
    let (Some(unit), None) = (read.unit, &settings.scale) else { return };
    let scale = match unit {
        HeaderUnit::MetresPerSecondSquared => "1",
        HeaderUnit::StandardGravity => "9.80665",
        HeaderUnit::MilliGravity => "0.00980665",
        _ => return,
    };
    out.push(format!("the header says {}: with --scale {scale} results are in m/s²", unit.text()));
}

/// `1 row`, `2 rows`.
fn counted(count: u64, one: &str, many: &str) -> String {
    format!("{count} {}", if count == 1 { one } else { many })
}

fn remarks(read: &Read, settings: &NoiseSettings, a: &NoiseAnalysis) -> Vec<String> {
    let mut out = Vec::new();
    units_in_doubt(read, settings, &mut out);
    if let Some(times) = &read.times {
        if times.gaps() > 0 {
            out.push(format!(
                "{} missing in {}: the record was cut there into {}, and no difference reaches across; nothing was filled in",
                counted(times.missing(), "reading is", "readings are"),
                counted(times.gaps(), "gap", "gaps"),
                counted(a.pieces.len() as u64, "piece", "pieces")
            ));
        }
        if times.jitter() > QUIET_JITTER {
            out.push(format!(
                "the steps of time scatter by {:.1} %; the mean step is taken as the interval",
                100.0 * times.jitter()
            ));
        }
    }
    if read.times_unused {
        out.push(
            "the column of times was not used, for --rate was given: gaps and jitter are not seen"
                .into(),
        );
    }
    if read.without > 0 {
        out.push(format!(
            "{} no reading: the record was cut there; nothing was filled in",
            counted(read.without, "row holds", "rows hold")
        ));
    }
    for remark in &a.remarks {
        out.push(match *remark {
            NoiseRemark::Stuck { from, readings, value } => format!(
                "from reading {from} on {value} stands {readings} times in a row, longer than chance allows: the converter \
                 or the logger was stuck; leave that part out"
            ),
            NoiseRemark::AtAnEnd { readings, value } => format!(
                "{readings} readings are {value}, the extreme value: if that is the converter's end, noise was cut off and all \
                 deviations are too small; use a wider range"
            ),
            NoiseRemark::Undithered => "the noise of single readings is below half a step of the converter: averages follow \
                 its steps, and the curve and its coefficients are those of the converter, not of the sensor"
                .into(),
            NoiseRemark::PoorFit { p, discrepancy } => format!(
                "Q, N, B, K and R do not describe the curve within its own scatter (p = {p:.1e}): a filter, vibration, periodic \
                 noise, or a sensor that was not at rest; weights and intervals allow for {:.1} % of every variance",
                100.0 * discrepancy
            ),
            NoiseRemark::Filtered { until_s } => format!(
                "the curve rises from the shortest time on and then falls: readings come faster than a low-pass filter before \
                 them lets them change; times below {until_s:.3} s are not in the fit"
            ),
            NoiseRemark::NoFit => "no coefficients: too few averaging times, or a variance of zero".into(),
        });
    }
    out
}
