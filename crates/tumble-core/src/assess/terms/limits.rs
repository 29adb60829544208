//! Sizes with which a term enters by itself.

use crate::estimate::Term;
use crate::{LimitOf, STANDARD_GRAVITY_M_S2, Sensor, SensorType};

/// K2, µg/g². The square adds 1 mg at 1 g; a dial that is eccentric by 3.4 arcmin makes the same, and dials of
/// hand-turned tables are no better than that: what is larger is looked for in the table first.
pub(crate) const DEFAULT_K2_UG_G2: f64 = 1000.0;
/// K3, µg/g³: also 1 mg at 1 g.
const DEFAULT_K3_UG_G3: f64 = 1000.0;
/// Scale factor of + minus that of −, ppm: also 1 mg at 1 g.
const DEFAULT_SCALE_SIGN_PPM: f64 = 2000.0;
/// Bias by temperature, µg/K; the worst parts of the built-in catalogue state 1.2 mg/K.
const DEFAULT_TEMP_BIAS_UG_K: f64 = 5000.0;
/// Scale by temperature, ppm/K; data sheets of MEMS parts state 100 to 500 ppm/K.
const DEFAULT_TEMP_SCALE_PPM_K: f64 = 1000.0;
/// A unit may exceed its data sheet by this factor before its value is taken for something else.
const BEYOND_TYPE: f64 = 3.0;

/// Largest magnitude of a term's coefficient with which it enters by itself, SI.
///
/// A type's nonlinearity can only make it smaller: data sheets state it over the whole range, far more than is plausible
/// within 1 g.
pub(super) fn plausible(term: Term, sensor: &Sensor) -> f64 {
    let usual = match term {
        Term::K2 => DEFAULT_K2_UG_G2,
        Term::K3 => DEFAULT_K3_UG_G3,
        Term::ScaleSign => DEFAULT_SCALE_SIGN_PPM,
        Term::TempBias => DEFAULT_TEMP_BIAS_UG_K,
        Term::TempScale => DEFAULT_TEMP_SCALE_PPM_K,
    };
    let default = usual / term.usual().1;
    let of_type = sensor.kind.as_ref().and_then(|k| of_type(term, k));
    of_type.map_or(default, |limit| limit.min(default))
}

/// From the type's data sheet, three times; SI.
fn of_type(term: Term, kind: &SensorType) -> Option<f64> {
    let largest = |of: LimitOf| {
        kind.limits.iter().filter(|l| l.of == of).filter_map(|l| l.bound()).reduce(f64::max)
    };
    let gn = STANDARD_GRAVITY_M_S2;
    // Deviation from the best straight line over the whole range F: K2 F²/2, K3 F³/4, K1′ F/4.
    let nonlinearity = || {
        let range_gn = kind.modes.iter().filter_map(|m| m.range_gn).reduce(f64::max)?;
        Some((largest(LimitOf::Nonlinearity)? / 100.0, range_gn * gn))
    };
    Some(
        BEYOND_TYPE
            * match term {
                Term::K2 => nonlinearity().map(|(share, f)| share * 2.0 / f)?,
                Term::K3 => nonlinearity().map(|(share, f)| share * 4.0 / (f * f))?,
                Term::ScaleSign => nonlinearity().map(|(share, _)| share * 4.0)?,
                Term::TempBias => largest(LimitOf::ZeroGTempco)? * 1e-3 * gn,
                Term::TempScale => largest(LimitOf::ScaleTempco)? / 100.0,
            },
    )
}
