//! Coefficients for use, and the budget of what scatter does not show.

use super::pool::gravity_sensitivity;
use super::{PooledParameter, PooledRuns, RunAssessment};
use crate::estimate::Parameter;
use crate::linalg::Matrix;
use crate::{Gravity, Quantizer, QuantizerOffset};

/// One line of the uncertainty budget (EA-4/02).
#[derive(Debug, Clone, PartialEq)]
pub struct BudgetLine {
    /// The parameter whose uncertainty it is.
    pub parameter: Parameter,
    /// Mounting, where the parameter has several.
    pub mounting: Option<String>,
    /// Input quantity.
    pub quantity: &'static str,
    /// Its standard uncertainty, in its own unit.
    pub standard_uncertainty: f64,
    /// Unit of the input.
    pub unit: &'static str,
    /// `normal`, `rectangular`, `student`.
    pub distribution: &'static str,
    /// Degrees of freedom; infinite for what is known beforehand.
    pub degrees_of_freedom: f64,
    /// `∂θ/∂x`.
    pub sensitivity: f64,
    /// `|∂θ/∂x| u(x)`, in the parameter's unit.
    pub contribution: f64,
    /// Share of the combined variance.
    pub share: f64,
}

/// Budget lines of all pooled parameters.
pub(super) fn budget(pooled: &[PooledParameter], gravity: &Gravity) -> Vec<BudgetLine> {
    let mut lines = Vec::new();
    for p in pooled {
        // Copies of one run scatter by nothing; then nothing has a share in it.
        let share = |u: f64| if u > 0.0 { (u / p.standard_uncertainty).powi(2) } else { 0.0 };
        lines.push(BudgetLine {
            parameter: p.parameter,
            mounting: p.mounting.clone(),
            quantity: if p.runs > 1 { "spread of the runs" } else { "scatter of the positions" },
            standard_uncertainty: p.u_statistical,
            unit: p.parameter.unit(),
            distribution: "student",
            degrees_of_freedom: p.dof_statistical,
            sensitivity: 1.0,
            contribution: p.u_statistical,
            share: share(p.u_statistical),
        });
        let sensitivity = gravity_sensitivity(p.parameter, p.value, gravity);
        if sensitivity > 0.0 {
            lines.push(BudgetLine {
                parameter: p.parameter,
                mounting: p.mounting.clone(),
                quantity: "local gravity",
                standard_uncertainty: gravity.standard_uncertainty_m_s2,
                unit: "m/s2",
                distribution: match gravity.source {
                    crate::GravitySource::Normal { .. } => "rectangular",
                    _ => "normal",
                },
                degrees_of_freedom: f64::INFINITY,
                sensitivity,
                contribution: p.u_budget,
                share: share(p.u_budget),
            });
        }
    }
    lines
}

/// What `compensate` needs, and the covariance of the result.
#[derive(Debug, Clone, PartialEq)]
pub struct CompensationResult {
    /// `k* = k0 (1 + δk)`, m/s² per LSB.
    pub scale_factor_m_s2_per_lsb: f64,
    /// `u(k*)`.
    pub u_scale_factor: f64,
    /// `Δa`, m/s².
    pub bias_m_s2: f64,
    /// `c`.
    pub quantizer_offset: QuantizerOffset,
    /// Lowest and highest mean reading that was measured, LSB.
    pub valid_range_lsb: (f64, f64),
    /// Covariance of (`k*`, `Δa`).
    pub covariance: Matrix,
    /// Covariance of (bias, misalignment, scale error); absent with several mountings.
    pub parameter_covariance: Option<Matrix>,
    /// Standard deviation of a single reading, LSB: noise and quantization within dwells.
    pub reading_std_lsb: Option<f64>,
    /// A worked number: code and what it means.
    pub example: (i32, f64),
}

/// Coefficients from the pooled values; `None` where one is missing.
///
/// **Uncertainty** variances are those of the pooled values. Correlations are those of the joint adjustment: of the runs' own
/// covariances, thinned by the spread between runs. With few runs the sample correlation of the run values says nothing
/// (two runs always give ±1).
#[must_use]
pub fn compensation_result(
    together: &PooledRuns,
    runs: &[RunAssessment],
    quantizer: Quantizer,
    nominal_scale_m_s2_per_lsb: f64,
) -> Option<CompensationResult> {
    let find = |parameter| {
        let mut all = together.parameters.iter().filter(|p| p.parameter == parameter);
        Some((all.next()?, all.next().is_none()))
    };
    let (bias, _) = find(Parameter::Bias)?;
    let (misalignment, one_mounting) = find(Parameter::Misalignment)?;
    let (scale, _) = find(Parameter::ScaleError)?;
    let u = [bias, misalignment, scale].map(|p| p.standard_uncertainty);
    let scatter = together.covariance.as_ref()?;
    let mut covariance = Matrix::zeros(3, 3);
    for i in 0..3 {
        for j in 0..3 {
            let r = if i == j { 1.0 } else { scatter.correlation(i, j).unwrap_or(0.0) };
            covariance[(i, j)] = u[i] * u[j] * r;
        }
    }
    let k = nominal_scale_m_s2_per_lsb;
    let to_use = Matrix::from_rows([[0.0, 0.0, k], [1.0, 0.0, 0.0]]);
    let scale_factor_m_s2_per_lsb = k * (1.0 + scale.value);
    let means = || runs.iter().flat_map(|r| r.mean_codes.iter().copied().flatten());
    let valid_range_lsb = (means().reduce(f64::min)?, means().reduce(f64::max)?);
    let offset = quantizer.offset();
    let code = (0.5 * valid_range_lsb.1.abs().max(valid_range_lsb.0.abs())).round();
    let acceleration = scale_factor_m_s2_per_lsb * (code + offset.lsb(code)) - bias.value;
    let variances: Vec<f64> =
        runs.iter().filter_map(|r| r.reading_std_lsb).map(|s| s * s).collect();
    Some(CompensationResult {
        scale_factor_m_s2_per_lsb,
        u_scale_factor: k * scale.standard_uncertainty,
        bias_m_s2: bias.value,
        quantizer_offset: offset,
        valid_range_lsb,
        covariance: covariance.propagated(&to_use),
        parameter_covariance: one_mounting.then_some(covariance),
        reading_std_lsb: crate::stats::mean(&variances).map(f64::sqrt),
        example: (code as i32, acceleration),
    })
}
