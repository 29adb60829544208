//! An up/down pair that all runs share: one scale error, measured in a power-up of its own.

use super::RunAssessment;
use crate::estimate::{Setting, Weights, equations};
use crate::{Experiment, PairUse};

/// What the pair says. Its bias is its own and drops out of the difference.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SharedPair {
    /// `δk` from `(N↑ − N↓)/2`.
    pub scale_error: f64,
    /// Its standard uncertainty: readings, the positions' scatter that is the same at all angles, and lean.
    pub standard_uncertainty: f64,
    /// Shift of the scale error by the mean lean of both dwells, which is taken out.
    pub lean_correction: f64,
}

/// The pair of an experiment that asks for a joint adjustment; `None` for any other, and where the readings are no
/// dwells at ±1 g.
///
/// **Model** `R = g/k* = (N↑* − N↓*)/2 / (1 − u²(δ)/2)` and `δk = g/(R k0) − 1`: a lean costs `R δ²/2` on each end, `R u²/2` on
/// average, with variance `R² u⁴/2`, the two leans independent. So `u²(R) = (σ↑² + σ↓² + 2 τ0² + R² u⁴)/4`.
///
/// **Units** relative. **Uncertainty** readings, `τ0` where the method finds it, lean. Gravity is not in.
///
/// **Source** method section 7a.
#[must_use]
pub fn shared_pair(
    experiment: &Experiment,
    setting: &Setting<'_>,
    runs: &[RunAssessment],
) -> Option<SharedPair> {
    let pair = experiment.vertical.as_ref()?;
    let censored = |p: &crate::Position| p.readings.censored(&setting.ends) > 0;
    let joint = pair.run.is_none() && pair.alone == PairUse::JointAdjustment;
    if !joint || experiment.runs.is_empty() || censored(&pair.up) || censored(&pair.down) {
        return None;
    }
    let [up, down] = equations(&[&pair.up, &pair.down], setting, Weights::Angle)[..] else {
        return None;
    };
    let half = (up.analogue_lsb - down.analogue_lsb) / 2.0;
    let lean = up.lean_uncertainty_rad.powi(2) / 2.0;
    let full_scale = half / (1.0 - lean);
    if !(full_scale > 0.0 && full_scale.is_finite()) {
        return None;
    }
    let levels: Vec<f64> = runs
        .iter()
        .filter_map(|r| r.estimate.as_ref()?.scatter.as_ref())
        .map(|s| s.level_lsb.value.powi(2))
        .collect();
    let level = crate::stats::mean(&levels).unwrap_or(0.0);
    let variance = [up, down]
        .iter()
        .map(|e| e.dwell_variance + level + e.lean_variance(full_scale))
        .sum::<f64>()
        / 4.0;
    let k0 = setting.nominal_scale_m_s2_per_lsb;
    let g = setting.bench.gravity.value_m_s2;
    let ratio = g / (full_scale * k0);
    Some(SharedPair {
        scale_error: ratio - 1.0,
        standard_uncertainty: ratio * variance.sqrt() / full_scale,
        lean_correction: -lean * g / (half * k0),
    })
}
