//! Times at which a filter before the readings shapes the curve.

use super::Variance;

/// A filter still shows up to so many times the time at which the curve begins to fall.
const BEYOND: f64 = 4.0;
/// The variance must fall to this part of its first summit behind it; else it is a walk, not a filter.
const FALLS: f64 = 0.5;

/// The variances that a low-pass filter before the readings does not shape, and the time up to which one does.
///
/// Q, N, B, K and R make no summit: where the curve rises from the shortest time on and then falls to half, readings come
/// faster than the sensor's (or the logger's) filter lets them change.
#[must_use]
pub fn unfiltered(variances: &[Variance]) -> (&[Variance], Option<f64>) {
    let rises = |w: &[Variance]| w[1].variance > w[0].variance;
    let summit = variances.windows(2).take_while(|w| rises(w)).count();
    let Some(top) = variances.get(summit).filter(|_| summit > 0) else { return (variances, None) };
    if !variances[summit..].iter().any(|v| v.variance < FALLS * top.variance) {
        return (variances, None);
    }
    let until = BEYOND * top.tau_s;
    let first = variances.partition_point(|v| v.tau_s < until);
    (&variances[first..], Some(until))
}
