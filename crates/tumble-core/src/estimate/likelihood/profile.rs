//! Intervals from the profile likelihood, where a dwell's information is a box and no parabola.

use super::integrate::Dwell;
use crate::linalg::{Symmetric3, dot3};

/// Newton steps for one constrained maximum; four to eight are usual.
const MAX_STEPS: usize = 60;
/// Log-likelihood that the last step may still be worth.
const WORTH: f64 = 1e-6;
/// Steps toward one end of an interval.
const MAX_TRIALS: usize = 40;
/// Relative accuracy of the root of twice the drop at an end.
const END_WITHIN: f64 = 0.005;

/// The dwells' marginal likelihood for a given scatter; concave in the parameters.
pub(super) struct Profile<'a> {
    dwells: &'a [Dwell],
    scatter: &'a [f64],
}

/// A point of the likelihood with its derivatives.
struct Point {
    value: f64,
    slope: [f64; 3],
    /// Minus the second derivative.
    information: Symmetric3,
}

impl<'a> Profile<'a> {
    pub fn new(dwells: &'a [Dwell], scatter: &'a [f64]) -> Self {
        Self { dwells, scatter }
    }

    fn at(&self, shift: [f64; 3]) -> Point {
        let mut out = Point { value: 0.0, slope: [0.0; 3], information: Symmetric3::default() };
        for (d, v) in self.dwells.iter().zip(self.scatter) {
            let m = d.evidence.marginal(d.origin + dot3(d.row, shift), *v);
            out.value += m.value;
            (0..3).for_each(|i| out.slope[i] += m.slope * d.row[i]);
            out.information.add_outer(d.row, -m.curvature);
        }
        out
    }

    /// Maximum from a start, along directions that leave `fixed · shift` as it is.
    ///
    /// Newton steps, halved until they climb: on a concave function that cannot diverge. Where the likelihood is a
    /// plateau its information vanishes; a little of the start's own stands in.
    fn maximum(
        &self,
        start: [f64; 3],
        fixed: Option<[f64; 3]>,
        little: f64,
    ) -> Option<([f64; 3], f64)> {
        let mut shift = start;
        let mut here = self.at(shift);
        for _ in 0..MAX_STEPS {
            let mut information = here.information;
            (0..3).for_each(|i| information.0[i][i] += little);
            let (inverse, _) = information.inverse()?;
            let free = inverse.times(here.slope);
            let step = match fixed {
                Some(g) => {
                    let along = inverse.times(g);
                    let much = dot3(g, free) / dot3(g, along);
                    core::array::from_fn(|i| free[i] - much * along[i])
                }
                None => free,
            };
            let worth = dot3(here.slope, step);
            if worth < WORTH {
                break;
            }
            let mut part = 1.0;
            let next = loop {
                let trial = core::array::from_fn(|i| shift[i] + part * step[i]);
                let there = self.at(trial);
                if there.value >= here.value + 1e-4 * part * worth {
                    break Some((trial, there));
                }
                part *= 0.5;
                if part < 1e-6 {
                    break None;
                }
            };
            let Some((trial, there)) = next else { break };
            (shift, here) = (trial, there);
        }
        here.value.is_finite().then_some((shift, here.value))
    }

    /// Where twice the drop of the profile likelihood along `direction · shift` equals `reach²`, below and above.
    ///
    /// `covariance` is that of the shift, for a start. The ends are relative to `centre`, in units of the parameter.
    pub fn ends(
        &self,
        centre: [f64; 3],
        direction: [f64; 3],
        covariance: &Symmetric3,
        reach: f64,
    ) -> Option<[f64; 2]> {
        let along = covariance.times(direction);
        let variance = dot3(direction, along);
        let sd = variance.sqrt();
        let little = 1e-3 / (0..3).map(|i| covariance.0[i][i]).fold(0.0, f64::max);
        let (top, best) = self.maximum(centre, None, little)?;
        let from = dot3(direction, top) - dot3(direction, centre);
        let end = |side: f64| -> Option<f64> {
            let mut warm = top;
            let mut depth = |a: f64| -> Option<f64> {
                // Move onto the plane, then climb in it.
                let off = dot3(direction, top) + a - dot3(direction, warm);
                let start = core::array::from_fn(|i| warm[i] + along[i] * off / variance);
                let (at, value) = self.maximum(start, Some(direction), little)?;
                warm = at;
                Some((2.0 * (best - value).max(0.0)).sqrt())
            };
            let (mut low, mut low_depth) = (0.0, 0.0);
            let mut a = side * reach * sd;
            let mut high: Option<(f64, f64)> = None;
            for _ in 0..MAX_TRIALS {
                let d = depth(a)?;
                if (d - reach).abs() < END_WITHIN * reach {
                    return Some(a);
                }
                if d < reach {
                    (low, low_depth) = (a, d);
                } else {
                    high = Some((a, d));
                }
                a = match high {
                    Some((h, depth)) => {
                        // Secant, kept off the ends of the bracket.
                        let share = ((reach - low_depth) / (depth - low_depth)).clamp(0.1, 0.9);
                        low + share * (h - low)
                    }
                    None => 1.5 * a,
                };
                if let Some((h, _)) = high
                    && (h - low).abs() < 1e-6 * h.abs()
                {
                    return Some(a);
                }
            }
            None
        };
        Some([from + end(-1.0)?, from + end(1.0)?])
    }
}
