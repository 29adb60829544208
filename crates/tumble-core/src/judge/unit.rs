//! Readings in another unit than the nominal scale's.

use crate::{Finding, FindingKind, Output, Quantizer, STANDARD_GRAVITY_M_S2};

/// Factor from which a scale of real readings is another unit's: sensors of one type differ by two to eight (their
/// ranges), units by 9.8 (T0102) or 100 and more.
pub(crate) const FACTOR: f64 = 20.0;
/// Codes per g below which no converter counts: such numbers are volts, g or m/s².
pub(crate) const CODES_PER_G: f64 = 10.0;
/// Relative width around a factor that is a unit's.
const WIDTH: f64 = 0.12;

/// Whether readings and nominal scale are in different units. `ratio` is the scale found over the nominal one.
pub(super) fn unit_is_not_the_scales(
    run: &str,
    ratio: f64,
    nominal_scale: f64,
    gravity_m_s2: f64,
    output: &Output,
) -> Option<Finding> {
    let found = ratio * nominal_scale;
    let far = ratio > FACTOR || (ratio > 0.0 && ratio * FACTOR < 1.0);
    if !far {
        return None;
    }
    let quantized = output.quantizer != Quantizer::None;
    let seen = gravity_m_s2 / found;
    let remedy = if !quantized {
        real_readings(ratio, found, output)
    } else if seen < CODES_PER_G {
        format!(
            "the readings are real numbers (volts?), not codes: set quantizer = \"none\", unit = \"V\" and nominal_scale = {found:.4} (m/s² per unit) in [output]"
        )
    } else if gravity_m_s2 / nominal_scale < CODES_PER_G
        && !near(ratio, 1e-3)
        && !near(found * nominal_scale, 1.0)
    {
        // A scale in mm/s², or one upside down, is T0103's.
        format!(
            "nominal_scale is per volt and the readings are codes: set nominal_scale = {found:.6} (m/s² per LSB), or multiply yours by the converter's volts per LSB"
        )
    } else {
        return None;
    };
    let unit = if quantized { "LSB" } else { output.unit.as_str() };
    Some(Finding {
        kind: FindingKind::UnitIsNotTheScales,
        place: run.to_owned(),
        observed: format!(
            "1 g reads {seen:.4} {unit}: {found:.6} m/s² per {unit}, {ratio:.3e} times nominal_scale"
        ),
        limit: format!("a factor of {FACTOR}"),
        remedy,
    })
}

fn near(value: f64, wanted: f64) -> bool {
    (value / wanted - 1.0).abs() < WIDTH
}

fn real_readings(ratio: f64, found: f64, output: &Output) -> String {
    let likely = if near(ratio, 1e-3) {
        "the readings are in thousandths of the unit of nominal_scale (mV with a scale per V, mg with one per g?)"
    } else if near(ratio, 1e3) {
        "nominal_scale is per thousandth of the readings' unit (per mV with readings in V?)"
    } else if near(found, STANDARD_GRAVITY_M_S2 * 1e-3) {
        "the readings look like mg (unit = \"mg\", nominal_scale = 0.00980665)"
    } else if near(found, STANDARD_GRAVITY_M_S2) {
        "the readings look like g (unit = \"g\", nominal_scale = 9.80665), or volts of a sensor with 1 V per g"
    } else if near(found, 1.0) {
        "the readings look like m/s² (unit = \"m/s²\", nominal_scale = 1)"
    } else if near(found, 1e-3) {
        "the readings look like mm/s² (unit = \"mm/s²\", nominal_scale = 0.001)"
    } else if output.unit == "LSB" {
        "a nominal scale per LSB does not go with real readings"
    } else {
        "readings and nominal_scale are in different units"
    };
    format!(
        "{likely}: state unit and nominal_scale in [output] for the unit that the column holds; these readings have {found:.4e} m/s² per unit"
    )
}
