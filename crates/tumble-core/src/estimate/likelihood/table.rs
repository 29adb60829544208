//! How good the table is: noise and scatter of a run, with intervals.

use super::material::Materials;
use super::scatter::{Exploration, Summit};
use super::{Adjusted, noise};
use crate::estimate::Setting;
use crate::estimate::types::{AgainstStated, Ranged, Scatter, Split};
use crate::stats::{chi_squared_p_value, normal_quantile};

/// Twice the log-likelihood ratio beyond which a component of scatter is needed: 5 % of the mixture of zero and χ² with
/// one degree of freedom that the ratio has when the component is absent (at its bound).
const NEEDED: f64 = 2.705_543;

/// The surface in terms of `τ0²` (LSB²) and `τφ²` (rad²).
#[derive(Debug, Clone, PartialEq)]
pub(super) struct ScatterPoints {
    /// `(τ0², τφ², weight)`.
    points: Vec<(f64, f64, f64)>,
    /// At the maximum of the restricted likelihood.
    best: (f64, f64),
    /// Twice the logarithm of the likelihood ratio against angles alone, and against levels alone.
    against: Option<(f64, f64)>,
    /// The same against angles that scatter as stated.
    twice_against_stated: Option<f64>,
}

impl ScatterPoints {
    /// Reads an exploration.
    pub fn of(
        exploration: &Exploration,
        highest: &Summit,
        as_stated: Option<f64>,
        components: impl Fn(f64, f64) -> (f64, f64),
    ) -> Self {
        let top = exploration.nodes.iter().map(|n| n.ln_weight).fold(f64::NEG_INFINITY, f64::max);
        let points = exploration
            .nodes
            .iter()
            .map(|n| {
                let (level, angle) = components(n.total, n.share);
                (level, angle, (n.ln_weight - top).exp())
            })
            .collect();
        let against = match exploration.summits.as_slice() {
            [levels, .., angles] => {
                let twice = |s: &Summit| 2.0 * (highest.ln_integral - s.ln_integral);
                Some((twice(angles), twice(levels)))
            }
            _ => None,
        };
        Self {
            points,
            best: components(highest.total, highest.share),
            against,
            twice_against_stated: as_stated.map(|l| 2.0 * (highest.ln_integral - l)),
        }
    }

    /// The total scatter at 0° against a stated angle uncertainty, by likelihood ratio (two components against none).
    pub fn against_stated(
        &self,
        setting: &Setting<'_>,
        unknowns: [f64; 3],
    ) -> Option<AgainstStated> {
        let stated = setting.bench.angle_uncertainty?.rad();
        let full_scale = unknowns[1].hypot(unknowns[2]);
        let (level, angle) = self.best;
        Some(AgainstStated {
            ratio: (level / (full_scale * full_scale) + angle).sqrt() / stated,
            p_value: chi_squared_p_value(self.twice_against_stated?.max(0.0), 2.0)?,
        })
    }

    /// A function of both components: its value at the maximum and the interval that holds a level of the weight.
    fn ranged(&self, level: f64, f: impl Fn(f64, f64) -> f64) -> Ranged {
        let mut all: Vec<(f64, f64)> =
            self.points.iter().map(|(a, b, w)| (f(*a, *b), *w)).collect();
        all.sort_by(|x, y| x.0.total_cmp(&y.0));
        let sum: f64 = all.iter().map(|p| p.1).sum();
        let quantile = |p: f64| {
            let mut below = 0.0;
            let mut last = all.first().map_or((0.0, 0.0), |x| (x.0, 0.0));
            for (value, w) in &all {
                // The weight of a node is spread to both sides of it.
                let here = (below + 0.5 * w) / sum;
                if here >= p {
                    let share = if here > last.1 { (p - last.1) / (here - last.1) } else { 1.0 };
                    return last.0 + share * (value - last.0);
                }
                last = (*value, here);
                below += w;
            }
            last.0
        };
        let tail = 0.5 * (1.0 - level);
        let value = f(self.best.0, self.best.1);
        // With little to tell, the maximum may stand at its bound, outside of the central part.
        Ranged { value, low: quantile(tail).min(value), high: quantile(1.0 - tail).max(value) }
    }

    /// Correlation of the two components over the surface.
    fn correlation(&self) -> Option<f64> {
        let sum: f64 = self.points.iter().map(|p| p.2).sum();
        let mean = |f: &dyn Fn(&(f64, f64, f64)) -> f64| {
            self.points.iter().map(|p| p.2 * f(p)).sum::<f64>() / sum
        };
        let (a, b) = (mean(&|p| p.0), mean(&|p| p.1));
        let (aa, bb) = (mean(&|p| (p.0 - a).powi(2)), mean(&|p| (p.1 - b).powi(2)));
        let ab = mean(&|p| (p.0 - a) * (p.1 - b));
        let scale = (aa * bb).sqrt();
        (scale > 0.0).then(|| (ab / scale).clamp(-1.0, 1.0))
    }
}

/// Noise and scatter of an adjusted run at a level of confidence.
pub(super) fn scatter(
    a: &Adjusted,
    materials: &Materials,
    unknowns: [f64; 3],
    level: f64,
) -> Scatter {
    let full_scale = unknowns[1].hypot(unknowns[2]);
    let points = &a.summary;
    let reach = normal_quantile(0.5 + 0.5 * level) * a.noise.ln_sd;
    let sigma = a.noise.sigma;
    let noise_is_bound = a.noise.ln_sd.is_infinite();
    // One sample a dwell: all of the noise is scatter, and nothing is known of it alone.
    let noise_lsb = (materials.noise_dof > 0.0).then(|| match noise_is_bound {
        true => {
            Ranged { value: sigma, low: 0.0, high: noise::upper_bound(materials, level).max(sigma) }
        }
        false => Ranged { value: sigma, low: sigma * (-reach).exp(), high: sigma * reach.exp() },
    });
    let split = match points.against {
        None => Split::NotAsked,
        Some((angles_alone, levels_alone)) if angles_alone.max(levels_alone) > NEEDED => {
            Split::Determined { level: angles_alone > NEEDED, angle: levels_alone > NEEDED }
        }
        Some(_) => Split::Undetermined,
    };
    Scatter {
        noise_lsb,
        noise_is_bound,
        level_lsb: points.ranged(level, |t0, _| t0.sqrt()),
        angle_rad: points.ranged(level, |_, tp| tp.sqrt()),
        total_lsb: points.ranged(level, |t0, tp| (t0 + tp * full_scale * full_scale).sqrt()),
        total_rad: points.ranged(level, |t0, tp| (t0 / (full_scale * full_scale) + tp).sqrt()),
        correlation: points.correlation(),
        split,
        inflation: materials.inflation,
    }
}
