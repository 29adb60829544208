//! Several runs, one value: mean of the runs, Student interval, prediction of the next power-up.

use super::RunAssessment;
use crate::Gravity;
use crate::estimate::{Estimate, Parameter};
use crate::stats::{mean, sample_std, student_factor};

/// A closed interval.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Interval {
    /// Lower end.
    pub low: f64,
    /// Upper end.
    pub high: f64,
}

impl Interval {
    /// `centre ± half_width`.
    #[must_use]
    pub fn around(centre: f64, half_width: f64) -> Self {
        Self { low: centre - half_width, high: centre + half_width }
    }

    /// What both have in common; `None` when that is nothing.
    #[must_use]
    pub fn intersection(self, other: Self) -> Option<Self> {
        let both = Self { low: self.low.max(other.low), high: self.high.min(other.high) };
        (both.low <= both.high).then_some(both)
    }
}

/// One parameter from all runs that determine it.
#[derive(Debug, Clone, PartialEq)]
pub struct PooledParameter {
    /// Which.
    pub parameter: Parameter,
    /// Set for misalignments when there are several mountings.
    pub mounting: Option<String>,
    /// Runs that went in.
    pub runs: usize,
    /// Mean of the runs.
    pub value: f64,
    /// Standard uncertainty from scatter: `s/√k` of the runs, and what of a run's own repeats in all of them; with
    /// one run, that run's own.
    pub u_statistical: f64,
    /// Standard uncertainty from what scatter does not show (gravity).
    pub u_budget: f64,
    /// Both together.
    pub standard_uncertainty: f64,
    /// Effective degrees of freedom (Welch–Satterthwaite).
    pub degrees_of_freedom: f64,
    /// Coverage factor at the level asked for.
    pub coverage_factor: f64,
    /// `k u`.
    pub expanded_uncertainty: f64,
    /// `value ± k u`.
    pub interval: Interval,
    /// For the estimate of the next power-up: `t(k−1) s √(1 + 1/k)`; needs two runs.
    pub prediction_interval: Option<Interval>,
    /// Standard deviation between runs (n − 1).
    pub between_run_sd: Option<f64>,
    /// What the runs' own intervals have in common: a picture of agreement, never the result.
    pub intersection: Option<Interval>,
}

/// Puts the runs together.
///
/// The mean of the runs with a Student interval keeps its level whatever the spread between power-ups, as long
/// as the runs are alike in precision. The intersection of the runs' intervals does not (79 % instead of 95 %
/// for five runs without any spread): it is kept as a picture.
///
/// Runs share bias and scale; runs of one mounting share the misalignment, others do not.
///
/// **Source** method section 9.
#[must_use]
pub fn pool(runs: &[RunAssessment], gravity: &Gravity, level: f64) -> Vec<PooledParameter> {
    let full: Vec<(&RunAssessment, &Estimate)> = runs
        .iter()
        .filter_map(|r| r.estimate.as_ref().map(|e| (r, e)))
        .filter(|(_, e)| e.covariance.is_some())
        .collect();
    let repeated = super::repeated_share(runs).unwrap_or(0.0);
    let mut mountings: Vec<&str> = Vec::new();
    for (r, _) in &full {
        if !mountings.contains(&r.mounting.as_str()) {
            mountings.push(&r.mounting);
        }
    }
    let mut out = Vec::new();
    for parameter in Parameter::ALL {
        let groups: Vec<Option<&str>> = match (parameter, mountings.len()) {
            (Parameter::Misalignment, 2..) => mountings.iter().map(|m| Some(*m)).collect(),
            _ => vec![None],
        };
        for group in groups {
            let members: Vec<&Estimate> = full
                .iter()
                .filter(|(r, _)| group.is_none_or(|m| r.mounting == m))
                .map(|(_, e)| *e)
                .collect();
            let pooled = pool_one(parameter, &members, repeated, gravity, level);
            out.extend(pooled.map(|p| PooledParameter { mounting: group.map(str::to_owned), ..p }));
        }
    }
    out
}

fn pool_one(
    parameter: Parameter,
    estimates: &[&Estimate],
    repeated_share: f64,
    gravity: &Gravity,
    level: f64,
) -> Option<PooledParameter> {
    let values: Vec<f64> = estimates.iter().filter_map(|e| e.values[parameter.index()]).collect();
    let own = |e: &Estimate| e.interval(parameter, level).map(|[low, high]| Interval { low, high });
    let value = mean(&values)?;
    let k = values.len();
    let between_run_sd = sample_std(&values);
    let (u_statistical, dof) = match between_run_sd {
        Some(s) => {
            // What repeats is as uncertain as in one run, whatever the number of runs.
            let own: Vec<f64> = estimates
                .iter()
                .filter_map(|e| e.standard_uncertainty(parameter))
                .map(|u| u * u)
                .collect();
            let common = (repeated_share * mean(&own).unwrap_or(0.0)).sqrt();
            let spread = s / (k as f64).sqrt();
            let u = spread.hypot(common);
            (u, welch_satterthwaite(u, spread, (k - 1) as f64))
        }
        None => {
            let only = estimates.first()?;
            (only.standard_uncertainty(parameter)?, only.effective_dof[parameter.index()])
        }
    };
    let u_budget =
        gravity_sensitivity(parameter, value, gravity) * gravity.standard_uncertainty_m_s2;
    let standard_uncertainty = u_statistical.hypot(u_budget);
    let degrees_of_freedom = welch_satterthwaite(standard_uncertainty, u_statistical, dof);
    let coverage_factor = student_factor(level, degrees_of_freedom)?;
    let expanded_uncertainty = coverage_factor * standard_uncertainty;
    let prediction_interval = between_run_sd.and_then(|s| {
        let t = student_factor(level, (k - 1) as f64)?;
        Some(Interval::around(value, t * s * (1.0 + 1.0 / k as f64).sqrt()))
    });
    let mut own_intervals = estimates.iter().filter_map(|e| own(e));
    let first = own_intervals.next();
    let intersection =
        own_intervals.fold(first, |common, i| common.and_then(|c| c.intersection(i)));
    Some(PooledParameter {
        parameter,
        mounting: None,
        runs: k,
        value,
        u_statistical,
        u_budget,
        standard_uncertainty,
        degrees_of_freedom,
        coverage_factor,
        expanded_uncertainty,
        interval: Interval::around(value, expanded_uncertainty),
        prediction_interval,
        between_run_sd,
        intersection,
    })
}

/// A bias in LSB: over the nominal scale.
#[must_use]
pub fn in_lsb(bias_m_s2: f64, nominal_scale_m_s2_per_lsb: f64) -> f64 {
    bias_m_s2 / nominal_scale_m_s2_per_lsb
}

/// The scale factor `k* = k0 (1 + δk)` from the scale error, with the same shape.
#[must_use]
pub fn scale_factor(scale_error: &PooledParameter, nominal_scale: f64) -> PooledParameter {
    let at = |v: f64| nominal_scale * (1.0 + v);
    let both = |i: Interval| Interval { low: at(i.low), high: at(i.high) };
    PooledParameter {
        value: at(scale_error.value),
        u_statistical: nominal_scale * scale_error.u_statistical,
        u_budget: nominal_scale * scale_error.u_budget,
        standard_uncertainty: nominal_scale * scale_error.standard_uncertainty,
        expanded_uncertainty: nominal_scale * scale_error.expanded_uncertainty,
        interval: both(scale_error.interval),
        prediction_interval: scale_error.prediction_interval.map(both),
        between_run_sd: scale_error.between_run_sd.map(|s| nominal_scale * s),
        intersection: scale_error.intersection.map(both),
        ..scale_error.clone()
    }
}

/// `|∂θ/∂g|`: bias and scale factor are proportional to `g`, the misalignment does not know it.
pub(super) fn gravity_sensitivity(parameter: Parameter, value: f64, gravity: &Gravity) -> f64 {
    match parameter {
        Parameter::Bias => (value / gravity.value_m_s2).abs(),
        Parameter::Misalignment => 0.0,
        Parameter::ScaleError => ((1.0 + value) / gravity.value_m_s2).abs(),
    }
}

/// `u_c⁴ / (u_stat⁴/ν)`, JCGM 100 equation G.2b with a budget of infinite degrees of freedom.
fn welch_satterthwaite(combined: f64, statistical: f64, dof: f64) -> f64 {
    if statistical > 0.0 { dof * (combined / statistical).powi(4) } else { f64::INFINITY }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn intervals_intersect_or_not() {
        let a = Interval { low: 0.0, high: 2.0 };
        assert_eq!(
            a.intersection(Interval { low: 1.0, high: 3.0 }),
            Some(Interval { low: 1.0, high: 2.0 })
        );
        assert_eq!(a.intersection(Interval { low: 2.5, high: 3.0 }), None);
    }

    #[test]
    fn effective_degrees_of_freedom() {
        assert_eq!(welch_satterthwaite(1.0, 1.0, 4.0), 4.0);
        assert!(welch_satterthwaite(0.5, 0.0, 4.0).is_infinite());
        // GUM G.4.2 style: half of the variance from four degrees of freedom.
        assert!((welch_satterthwaite(2f64.sqrt(), 1.0, 4.0) - 16.0).abs() < 1e-12);
    }
}
