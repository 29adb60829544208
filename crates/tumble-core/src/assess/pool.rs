//! Several runs, one value: pooled parameters with their intervals, predictions of the next power-up.

use super::units::{self, BIAS, FIRST_SEAT, Layout, Member, SCALE};
use super::{RunAssessment, SharedPair};
use crate::combine::{Basis, Combined, Unit, combine, heterogeneity, prediction};
use crate::estimate::Parameter;
use crate::linalg::Matrix;
use crate::stats::{mean, student_factor};
use crate::systematic::Quantity;

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

/// How far runs differ in one parameter, beyond their own uncertainties.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BetweenRuns {
    /// `ω`, restricted maximum likelihood over all parameters together; `None` where no two runs share the parameter.
    pub omega: Option<f64>,
    /// `ω` after Mandel and Paule, of this parameter alone.
    pub omega_mandel_paule: f64,
    /// Interval of `ω` from the profile of Cochran's Q; no upper end where the runs set none.
    pub omega_interval: (f64, Option<f64>),
    /// Cochran's Q.
    pub cochran_q: f64,
    /// Its degrees of freedom.
    pub dof: f64,
    /// Probability of a Q that large were there no spread; by F where the runs' own uncertainties are estimates.
    pub p_value: f64,
    /// Share of the spread that is not the runs' own uncertainty.
    pub i_squared: f64,
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
    /// Generalized least squares; the mean for runs of equal precision.
    pub value: f64,
    /// Standard uncertainty from scatter: Hartung and Knapp's (`s/√k` for runs of equal precision), and what of a run's
    /// own repeats in all of them; with one run, that run's own.
    pub u_statistical: f64,
    /// Degrees of freedom of `u_statistical`.
    pub dof_statistical: f64,
    /// Standard uncertainty from what scatter does not show; zero until the budget is put in.
    pub u_budget: f64,
    /// The largest part of it.
    pub dominant: Option<Quantity>,
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
    /// For the **estimate** of the next power-up, measured like these runs; needs two runs. `t(k−1) s √(1 + 1/k)` for
    /// runs of equal precision.
    pub prediction_interval: Option<Interval>,
    /// For the **true value** in the next power-up; needs two runs. See [`crate::combine::prediction`].
    pub prediction_true_interval: Option<Interval>,
    /// Standard deviation between runs (n − 1).
    pub between_run_sd: Option<f64>,
    /// Spread beyond the runs' own uncertainties; needs two runs.
    pub between_runs: Option<BetweenRuns>,
    /// What the runs' own intervals have in common: a picture of agreement, never the result.
    pub intersection: Option<Interval>,
    /// How far the value moves with (bias, misalignment, scale error) of each run, in the order of all runs; zero for runs that
    /// did not go in.
    pub run_weights: Vec<[f64; 3]>,
    /// How far the value moves with the scale error of the shared up/down pair; zero without one.
    pub pair_weight: f64,
}

/// The runs together.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct PooledRuns {
    /// A parameter each, a misalignment for every mounting.
    pub parameters: Vec<PooledParameter>,
    /// `ε`: zero and level of the table, positive where the true angle is larger than the dial's; where runs of one mounting were
    /// taken in both orientations. The misalignment of such mountings is `δ`, what turns with the body.
    pub table_zero: Option<PooledParameter>,
    /// Covariance, from scatter, of (bias, first misalignment, scale error).
    pub covariance: Option<Matrix>,
    /// Whether the whole `C_r` could be used; without their correlations otherwise.
    pub correlated: bool,
}

/// Puts the runs together: [`pool_runs`] without a shared pair, the parameters alone.
#[must_use]
pub fn pool(runs: &[RunAssessment], level: f64) -> Vec<PooledParameter> {
    pool_runs(runs, None, level).parameters
}

/// Puts the runs, and an up/down pair that they share, together in one adjustment.
///
/// The Student interval of the pooled value keeps its level whatever the spread between power-ups. The intersection of the
/// runs' intervals does not (77 % instead of 95 % for five runs without any spread): it is kept as a picture.
///
/// Runs share bias and scale; runs of one mounting share the misalignment, others do not.
///
/// **Model** [`crate::combine::combine`] with `Δφ_r = δ + ε` in normal and `δ − ε` in reversed orientation where a mounting
/// has both; their sum as one where it has not.
///
/// **Source** method sections 7 and 9.
#[must_use]
pub fn pool_runs(runs: &[RunAssessment], pair: Option<&SharedPair>, level: f64) -> PooledRuns {
    let layout = units::layout(runs);
    if layout.members.is_empty() {
        return PooledRuns::default();
    }
    let units = layout.units(pair);
    let (combined, correlated) = match combine(&units, layout.columns) {
        Ok(c) => (c, true),
        // A covariance that is none but for its variances: better weights without correlations than no result.
        Err(_) => match combine(&without_correlations(units), layout.columns) {
            Ok(c) => (c, false),
            Err(_) => return PooledRuns::default(),
        },
    };
    let pooling = Pooling {
        runs: runs.len(),
        layout: &layout,
        combined: &combined,
        repeated: super::repeated_share(runs).unwrap_or(0.0),
        level,
    };
    let seats = || FIRST_SEAT..FIRST_SEAT + layout.seats.len();
    let mut parameters: Vec<PooledParameter> =
        pooling.parameter(Parameter::Bias, BIAS).into_iter().collect();
    parameters.extend(seats().filter_map(|c| pooling.parameter(Parameter::Misalignment, c)));
    parameters.extend(pooling.parameter(Parameter::ScaleError, SCALE));
    let columns = [BIAS, FIRST_SEAT, SCALE];
    let mut covariance = Matrix::zeros(3, 3);
    for i in 0..3 {
        for j in 0..3 {
            covariance[(i, j)] = combined.covariance[(columns[i], columns[j])];
        }
    }
    PooledRuns {
        parameters,
        table_zero: layout.table_zero.and_then(|c| pooling.parameter(Parameter::Misalignment, c)),
        covariance: Some(covariance),
        correlated,
    }
}

fn without_correlations(mut units: Vec<Unit>) -> Vec<Unit> {
    for unit in &mut units {
        for i in 0..3 {
            for j in (0..3).filter(|j| *j != i) {
                unit.covariance.0[i][j] = 0.0;
            }
        }
    }
    units
}

/// What every pooled parameter is made from.
struct Pooling<'a> {
    runs: usize,
    layout: &'a Layout<'a>,
    combined: &'a Combined,
    repeated: f64,
    level: f64,
}

/// The runs of one parameter: values without the table's zero where that is apart, variances, degrees of freedom.
struct Values<'a> {
    members: Vec<&'a Member<'a>>,
    values: Vec<f64>,
    shifts: Vec<f64>,
    variances: Vec<f64>,
    groups: Vec<usize>,
}

impl Pooling<'_> {
    fn parameter(&self, parameter: Parameter, column: usize) -> Option<PooledParameter> {
        let contrast = self.combined.columns.get(column)?;
        let i = parameter.index();
        let is_zero = self.layout.table_zero == Some(column);
        let v = self.values(parameter, column);
        let k = v.members.len();
        // What repeats is as uncertain as in one run, whatever the number of runs; a single run has it already.
        let repeats = if k > 1 && contrast.basis == Basis::Scatter { self.repeated } else { 0.0 };
        let common = repeats * mean(&v.variances)?;
        let spread = contrast.standard_uncertainty;
        let u_statistical = spread.hypot(common.sqrt());
        let dof_statistical =
            welch_satterthwaite(u_statistical, spread, contrast.degrees_of_freedom);
        let coverage_factor = student_factor(self.level, dof_statistical)?;
        let expanded_uncertainty = coverage_factor * u_statistical;
        let omega2 = self.combined.omega_squared[i];
        let predicted =
            prediction(contrast, omega2.unwrap_or(0.0), mean(&v.variances)?, self.level)
                .filter(|_| !is_zero);
        let around = |half: f64| Interval::around(contrast.value, half);
        // The mean's part of what repeats is in the next run's estimate too, and drops out of their difference.
        let next_true = |half: f64| {
            let t = student_factor(self.level, contrast.degrees_of_freedom).unwrap_or(0.0);
            half.hypot(t * common.sqrt())
        };
        let mut run_weights = vec![[0.0; 3]; self.runs];
        for (m, a) in self.layout.members.iter().zip(&contrast.weights) {
            run_weights[m.index] = *a;
        }
        Some(PooledParameter {
            parameter,
            mounting: units::seat_name(self.layout, parameter, column),
            runs: k,
            value: contrast.value,
            u_statistical,
            dof_statistical,
            u_budget: 0.0,
            dominant: None,
            standard_uncertainty: u_statistical,
            degrees_of_freedom: dof_statistical,
            coverage_factor,
            expanded_uncertainty,
            interval: around(expanded_uncertainty),
            prediction_interval: predicted.map(|p| around(p.next_estimate)),
            prediction_true_interval: predicted.map(|p| around(next_true(p.next_true))),
            between_run_sd: within_groups_sd(&v.values, &v.groups).filter(|_| !is_zero),
            between_runs: self.between_runs(parameter, &v).filter(|_| !is_zero),
            intersection: self.intersection(parameter, &v).filter(|_| !is_zero),
            run_weights,
            pair_weight: match contrast.weights.get(self.layout.members.len()) {
                Some(pair) => pair[2],
                None => 0.0,
            },
        })
    }

    fn values(&self, parameter: Parameter, column: usize) -> Values<'_> {
        let of_seat = |m: &&Member<'_>| match parameter {
            Parameter::Misalignment if self.layout.table_zero == Some(column) => m.zero_sign != 0.0,
            Parameter::Misalignment => m.seat == column,
            _ => true,
        };
        let members: Vec<&Member<'_>> = self.layout.members.iter().filter(of_seat).collect();
        let zero = self.layout.table_zero.map_or(0.0, |c| self.combined.columns[c].value);
        let i = parameter.index();
        let shift = |m: &Member<'_>| match parameter {
            Parameter::Misalignment => m.zero_sign * zero,
            _ => 0.0,
        };
        let shifts: Vec<f64> = members.iter().map(|m| shift(m)).collect();
        Values {
            values: members.iter().zip(&shifts).map(|(m, s)| m.values[i] - s).collect(),
            shifts,
            variances: members.iter().map(|m| m.covariance.0[i][i]).collect(),
            // Each orientation has a mean of its own.
            groups: members
                .iter()
                .map(|m| match parameter {
                    Parameter::Misalignment => usize::from(m.zero_sign < 0.0),
                    _ => 0,
                })
                .collect(),
            members,
        }
    }

    fn between_runs(&self, parameter: Parameter, v: &Values<'_>) -> Option<BetweenRuns> {
        let within_dof = v.members.iter().map(|m| units::size_dof(m.estimate)).sum();
        let h = heterogeneity(&v.values, &v.variances, &v.groups, within_dof, self.level)?;
        let (low, high) = h.interval;
        Some(BetweenRuns {
            omega: self.combined.omega_squared[parameter.index()].map(f64::sqrt),
            omega_mandel_paule: h.mandel_paule.sqrt(),
            omega_interval: (low.sqrt(), Some(high.sqrt()).filter(|h| h.is_finite())),
            cochran_q: h.cochran_q,
            dof: h.dof,
            p_value: h.p_value,
            i_squared: h.i_squared,
        })
    }

    fn intersection(&self, parameter: Parameter, v: &Values<'_>) -> Option<Interval> {
        let mut own = v.members.iter().zip(&v.shifts).filter_map(|(m, shift)| {
            let [low, high] = m.estimate.interval(parameter, self.level)?;
            Some(Interval { low: low - shift, high: high - shift })
        });
        let first = own.next();
        own.fold(first, |common, i| common.and_then(|c| c.intersection(i)))
    }
}

/// Standard deviation around the groups' means.
fn within_groups_sd(values: &[f64], groups: &[usize]) -> Option<f64> {
    let (mut sum, mut dof) = (0.0, 0usize);
    for group in 0..=groups.iter().copied().max()? {
        let own: Vec<f64> =
            values.iter().zip(groups).filter(|(_, g)| **g == group).map(|(v, _)| *v).collect();
        let Some(m) = mean(&own) else { continue };
        sum += own.iter().map(|v| (v - m) * (v - m)).sum::<f64>();
        dof += own.len() - 1;
    }
    (dof > 0).then(|| (sum / dof as f64).sqrt())
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
        prediction_true_interval: scale_error.prediction_true_interval.map(both),
        between_run_sd: scale_error.between_run_sd.map(|s| nominal_scale * s),
        between_runs: scale_error.between_runs.map(|b| BetweenRuns {
            omega: b.omega.map(|w| nominal_scale * w),
            omega_mandel_paule: nominal_scale * b.omega_mandel_paule,
            omega_interval: (
                nominal_scale * b.omega_interval.0,
                b.omega_interval.1.map(|w| nominal_scale * w),
            ),
            ..b
        }),
        intersection: scale_error.intersection.map(both),
        run_weights: scale_error.run_weights.iter().map(|a| a.map(|w| nominal_scale * w)).collect(),
        pair_weight: nominal_scale * scale_error.pair_weight,
        ..scale_error.clone()
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
