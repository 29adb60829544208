//! How the estimate settles as positions are added (the paper's figure 1).

use super::paper::Fit;
use crate::linalg::Triangular;
use crate::stats::student_factor;

/// Longest list of sequential estimates that is kept; longer runs are thinned evenly.
const KEPT: usize = 512;

/// The estimate from the first positions alone.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SequentialEstimate {
    /// Number of positions, in measured order.
    pub positions: usize,
    /// In the order of the parameters.
    pub values: [f64; 3],
}

/// How an estimate settled.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Stabilization {
    /// Estimates after each position from the first that determines all parameters; thinned past 512.
    pub sequential: Vec<SequentialEstimate>,
    /// Smallest number of positions from which every later estimate stays within the final expanded
    /// uncertainty; absent without redundancy.
    pub settled_at: Option<usize>,
    /// Largest step between an estimate from at least half of the positions and the final one, over the
    /// standard deviation that such a step has by chance: `|θ_m − θ_n| / √(C_m − C_n)`.
    pub largest_step: Option<f64>,
}

/// Runs through the rows of a fit once more, one at a time.
pub(super) fn stabilization(fit: &Fit, level: f64) -> Stabilization {
    let n = fit.weighted_rows.len();
    let expanded = expanded_uncertainties(fit, level);
    let mut triangle = Triangular::new(3);
    fit.weighted_rows.iter().for_each(|e| triangle.push(&e.row, e.y));
    // Steps are held against what the rows' own weights say, not against the uncertainty that is printed.
    let end = (fit.covariance.is_some() && triangle.solve().is_ok()).then(|| {
        let b = triangle.back_substituted();
        let (values, jacobian) = fit.to_parameters.at([b[0], b[1], b[2]]);
        (values, triangle.unit_covariance_unchecked().propagated(&jacobian))
    });
    let mut triangle = Triangular::new(3);
    let mut out = Stabilization::default();
    let mut full_rank = false;
    let mut all: Vec<SequentialEstimate> = Vec::with_capacity(n);
    for (i, equation) in fit.weighted_rows.iter().enumerate() {
        triangle.push(&equation.row, equation.y);
        full_rank = full_rank || (i >= 2 && triangle.solve().is_ok());
        if !full_rank {
            continue;
        }
        let b = triangle.back_substituted();
        let (values, jacobian) = fit.to_parameters.at([b[0], b[1], b[2]]);
        all.push(SequentialEstimate { positions: i + 1, values });
        if let (Some((last_values, last)), true) = (&end, i + 1 < n && 2 * (i + 1) >= n && i >= 5) {
            let here = triangle.unit_covariance_unchecked().propagated(&jacobian);
            for (k, value) in values.iter().enumerate() {
                let variance = here[(k, k)] - last[(k, k)];
                let step = (value - last_values[k]).abs() / variance.max(0.0).sqrt();
                if step.is_finite() {
                    out.largest_step = Some(out.largest_step.unwrap_or(0.0).max(step));
                }
            }
        }
    }
    out.settled_at = expanded.map(|u| {
        let outside = |s: &&SequentialEstimate| {
            s.values.iter().zip(fit.values).zip(u).any(|((v, last), u)| (v - last).abs() > u)
        };
        all.iter()
            .rfind(outside)
            .map_or_else(|| all.first().map_or(n, |s| s.positions), |s| s.positions + 1)
    });
    let stride = all.len().div_ceil(KEPT).max(1);
    let last = all.len().saturating_sub(1);
    out.sequential = all
        .into_iter()
        .enumerate()
        .filter(|(i, _)| i % stride == 0 || *i == last)
        .map(|(_, s)| s)
        .collect();
    out
}

fn expanded_uncertainties(fit: &Fit, level: f64) -> Option<[f64; 3]> {
    let covariance = fit.covariance.as_ref()?;
    let mut out = [0.0; 3];
    for (i, expanded) in out.iter_mut().enumerate() {
        *expanded = student_factor(level, fit.dof[i])? * covariance[(i, i)].sqrt();
    }
    Some(out)
}
