//! Rounding that repeats of one angle share.

use super::Linearized;
use crate::Position;
use crate::estimate::{Estimate, Setting};

/// What is left of rounding when a level is dithered by Gaussian scatter, as a share of that of a level without: the first
/// harmonic of the rounding error falls by `exp(−2π² σ²/q²)`, the others faster.
///
/// ```
/// use tumble_core::systematic::left_over;
/// assert_eq!(left_over(0.0, 1.0), 1.0);
/// assert!((left_over(0.5, 1.0) - 0.00719).abs() < 1e-5);
/// ```
#[must_use]
pub fn left_over(scatter: f64, step: f64) -> f64 {
    (-2.0 * (core::f64::consts::PI * scatter / step).powi(2)).exp()
}

/// Root of the sum of squares of what rounding by `step` at each angle that was repeated does to the parameters, per unit of
/// the rounding error of one dwell.
///
/// Where every angle stands once, rounding differs from position to position and is in their scatter already. Repeats round
/// alike, unless noise within the dwells and scatter between them carry them over the step.
pub(super) fn sensitivity(
    linearized: &Linearized,
    estimate: &Estimate,
    positions: &[&Position],
    setting: &Setting<'_>,
    step: f64,
) -> [f64; 3] {
    let is_code = setting.quantizer != crate::Quantizer::None;
    // The likelihood of codes knows what they stand for.
    if step <= 0.0 || (is_code && estimate.scatter.is_some()) {
        return [0.0; 3];
    }
    let variances: Vec<f64> =
        positions.iter().filter_map(|p| p.readings.std()).map(|s| s * s).collect();
    let noise = (crate::stats::mean(&variances).unwrap_or(0.0) - step * step / 12.0).max(0.0);
    let between = estimate.residual_std_lsb.unwrap_or(0.0);
    let share = left_over((noise + between * between).sqrt(), step);
    let mut squares = [0.0; 3];
    let mut order: Vec<usize> = (0..positions.len()).collect();
    order.sort_by(|a, b| positions[*a].angle.rad().total_cmp(&positions[*b].angle.rad()));
    let alike =
        |a: &usize, b: &usize| (positions[*a].angle.rad() - positions[*b].angle.rad()).abs() < 1e-9;
    for group in order.chunk_by(alike).filter(|g| g.len() > 1) {
        let mut lsb = vec![0.0; positions.len()];
        group.iter().for_each(|j| lsb[*j] = share);
        let shift = linearized.shift(&lsb).parameters;
        squares.iter_mut().zip(shift).for_each(|(to, s)| *to += s * s);
    }
    squares.map(f64::sqrt)
}
