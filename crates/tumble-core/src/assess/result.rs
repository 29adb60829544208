//! Coefficients for use, and the budget of what scatter does not show.

use super::terms::compensation_terms;
use super::{CompensationTerms, PooledRuns, RunAssessment, Terms};
use crate::estimate::Parameter;
use crate::linalg::Matrix;
use crate::{Quantizer, QuantizerOffset};

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
/// **Uncertainty** `whole` is the covariance of (bias, first misalignment, scale error) with the budget in it. What is of
/// scatter in it has the correlations of the joint adjustment: of the runs' own covariances, thinned by the spread between runs.
/// With few runs the sample correlation of the run values says nothing (two runs always give ±1).
#[must_use]
pub fn compensation_result(
    together: &PooledRuns,
    whole: &Matrix,
    runs: &[RunAssessment],
    (quantizer, nominal_scale_m_s2_per_lsb): (Quantizer, f64),
    terms: &Terms,
) -> Option<CompensationResult> {
    let find = |parameter| {
        let mut all = together.parameters.iter().filter(|p| p.parameter == parameter);
        Some((all.next()?, all.next().is_none()))
    };
    let (bias, _) = find(Parameter::Bias)?;
    let (_, one_mounting) = find(Parameter::Misalignment)?;
    let (scale, _) = find(Parameter::ScaleError)?;
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
    let terms = compensation_terms(terms, &together.parameters, runs, k, range, temperatures);
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
            || whole.propagated(&to_use),
            |t| {
                let c = &t.covariance;
                Matrix::from_rows([[c[(0, 0)], c[(0, 1)]], [c[(1, 0)], c[(1, 1)]]])
            },
        ),
        parameter_covariance: one_mounting.then(|| whole.clone()),
        reading_std_lsb: crate::stats::mean(&variances).map(f64::sqrt),
        terms,
        example: (code as i32, acceleration),
    })
}
