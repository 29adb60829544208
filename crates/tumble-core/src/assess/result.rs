//! Coefficients for use, and the budget of what scatter does not show.

use super::pool::gravity_sensitivity;
use super::terms::compensation_terms;
use super::{CompensationTerms, PooledParameter, RunAssessment, Terms};
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
        let scatter_dof = match p.between_run_sd {
            Some(_) => (p.runs - 1) as f64,
            None => p.degrees_of_freedom,
        };
        lines.push(BudgetLine {
            parameter: p.parameter,
            mounting: p.mounting.clone(),
            quantity: if p.runs > 1 { "spread of the runs" } else { "scatter of the positions" },
            standard_uncertainty: p.u_statistical,
            unit: p.parameter.unit(),
            distribution: "student",
            degrees_of_freedom: scatter_dof,
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
    /// Further terms; absent without any.
    pub terms: Option<CompensationTerms>,
    /// A worked number: code and what it means, at the reference temperature.
    pub example: (i32, f64),
}

/// Coefficients from the pooled values; `None` where one is missing.
///
/// **Uncertainty** variances are those of the pooled values. Correlations are those of the runs' own covariances,
/// thinned by the spread between runs: with few runs the sample correlation of the run values says nothing (two
/// runs always give ±1).
#[must_use]
pub fn compensation_result(
    pooled: &[PooledParameter],
    runs: &[RunAssessment],
    quantizer: Quantizer,
    nominal_scale_m_s2_per_lsb: f64,
    terms: &Terms,
) -> Option<CompensationResult> {
    let find = |parameter| {
        let mut all = pooled.iter().filter(|p| p.parameter == parameter);
        Some((all.next()?, all.next().is_none()))
    };
    let (bias, _) = find(Parameter::Bias)?;
    let (misalignment, one_mounting) = find(Parameter::Misalignment)?;
    let (scale, _) = find(Parameter::ScaleError)?;
    let u = [bias, misalignment, scale].map(|p| p.standard_uncertainty);
    let correlation = correlations(pooled, runs);
    let mut covariance = Matrix::zeros(3, 3);
    for i in 0..3 {
        for j in 0..3 {
            covariance[(i, j)] = u[i] * u[j] * correlation[(i, j)];
        }
    }
    let k = nominal_scale_m_s2_per_lsb;
    let to_use = Matrix::from_rows([[0.0, 0.0, k], [1.0, 0.0, 0.0]]);
    let scale_factor_m_s2_per_lsb = k * (1.0 + scale.value);
    let means = || runs.iter().flat_map(|r| r.mean_codes.iter().copied().flatten());
    let valid_range_lsb = (means().reduce(f64::min)?, means().reduce(f64::max)?);
    let offset = quantizer.offset();
    let code = (0.5 * valid_range_lsb.1.abs().max(valid_range_lsb.0.abs())).round();
    let linear = |n: f64| scale_factor_m_s2_per_lsb * (n + offset.lsb(n)) - bias.value;
    let range = (linear(valid_range_lsb.0), linear(valid_range_lsb.1));
    let recorded = runs.iter().flat_map(|r| r.temperatures_degc.iter().flatten().copied());
    let temperatures = recorded.fold(None, |r: Option<(f64, f64)>, t| {
        Some(r.map_or((t, t), |(low, high)| (low.min(t), high.max(t))))
    });
    let terms = compensation_terms(terms, pooled, runs, k, range, temperatures);
    let nonlinearity = terms.as_ref().map(CompensationTerms::nonlinearity).unwrap_or_default();
    let acceleration = nonlinearity.undo_m_s2(linear(code), 0.0);
    let variances: Vec<f64> =
        runs.iter().filter_map(|r| r.reading_std_lsb).map(|s| s * s).collect();
    Some(CompensationResult {
        scale_factor_m_s2_per_lsb,
        u_scale_factor: k * scale.standard_uncertainty,
        bias_m_s2: bias.value,
        quantizer_offset: offset,
        valid_range_lsb,
        // Consistent with that of the terms, where there are any.
        covariance: terms.as_ref().map_or_else(
            || covariance.propagated(&to_use),
            |t| {
                let c = &t.covariance;
                Matrix::from_rows([[c[(0, 0)], c[(0, 1)]], [c[(1, 0)], c[(1, 1)]]])
            },
        ),
        parameter_covariance: one_mounting.then_some(covariance),
        reading_std_lsb: crate::stats::mean(&variances).map(f64::sqrt),
        terms,
        example: (code as i32, acceleration),
    })
}

/// Correlations of the pooled parameters: mean of the runs' covariances, plus the spread between runs on the
/// diagonal.
fn correlations(pooled: &[PooledParameter], runs: &[RunAssessment]) -> Matrix {
    let own: Vec<&Matrix> = runs
        .iter()
        .filter_map(|r| r.estimate.as_ref().and_then(|e| e.covariance.as_ref()))
        .collect();
    let n = own.len().max(1) as f64;
    let mut c = Matrix::zeros(3, 3);
    for i in 0..3 {
        for j in 0..3 {
            c[(i, j)] = own.iter().map(|m| m[(i, j)]).sum::<f64>() / n;
        }
    }
    for p in pooled {
        let i = p.parameter.index();
        let spread = p.between_run_sd.map_or(0.0, |s| s * s);
        c[(i, i)] = c[(i, i)].max(spread);
    }
    let mut r = Matrix::zeros(3, 3);
    for i in 0..3 {
        for j in 0..3 {
            r[(i, j)] = if i == j { 1.0 } else { c.correlation(i, j).unwrap_or(0.0) };
        }
    }
    r
}
