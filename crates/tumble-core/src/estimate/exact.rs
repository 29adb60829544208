//! The exact linear form: right for any size of error.

use super::paper::{Fit, MOST_TERMS, ToParameters, WeightedRow, spread};
use super::types::{AgainstStated, EstimateError, Residual};
use super::{Equation, Setting, select};
use crate::Seat;
use crate::linalg::{Matrix, Triangular};
use crate::stats::chi_squared_p_value;

/// Iterations of weights and linearized upright dwells; real data need three to six.
const MAX_ITERATIONS: usize = 200;
/// Relative change at which the iteration stops.
const CONVERGED: f64 = 1e-13;
/// Relative change that still counts as converged when rounding keeps it from going lower.
const CONVERGED_ENOUGH: f64 = 1e-9;

/// Weighted least squares on `N* = α + β sinφ + γ cosφ`, upright dwells as `N* = α ± √(β²+γ²)`.
///
/// `√(β²+γ²)` is homogeneous of degree one, so at the last solution it is exactly `(β0 β + γ0 γ)/R0`: the same
/// row as a table position at `90° − Δφ`. Weights and that row are renewed until nothing changes.
pub(super) fn fit(
    eqs: &[Equation],
    setting: &Setting<'_>,
    columns: [bool; 3],
) -> Result<Fit, EstimateError> {
    let g = setting.bench.gravity.value_m_s2;
    let k0 = setting.nominal_scale_m_s2_per_lsb;
    // Columns are named by parameter; the unknowns α, γ, β belong to bias, misalignment, scale.
    let columns = [columns[0], columns[2], columns[1]];
    let p = columns.iter().filter(|c| **c).count();
    let degrees_of_freedom = eqs.len().saturating_sub(p);
    let has_lean = eqs.iter().any(|e| e.lean_uncertainty_rad > 0.0);

    let mut unknowns = [0.0, g / k0, 0.0];
    let mut scatter = 1.0;
    let mut last_change = f64::INFINITY;
    let mut iterations = 0;
    let (triangle, rows) = loop {
        let (rows, triangle) = weighted(eqs, unknowns, scatter, columns);
        let solved = match triangle.solve() {
            Ok(b) => spread(&b, columns),
            // Nothing to solve for: the identifiability test has said so already.
            Err(_) => break (triangle, rows),
        };
        let new_scatter = if degrees_of_freedom > 0 {
            scatter_scale(eqs, unknowns, solved, scatter, degrees_of_freedom, has_lean)
        } else {
            1.0
        };
        // The size of the scatter matters only through the solution: of data without noise it is rounding error.
        last_change = change(unknowns, solved);
        (unknowns, scatter) = (solved, new_scatter);
        iterations += 1;
        let renewed = !has_lean || iterations >= 3;
        if (last_change <= CONVERGED && renewed) || iterations == MAX_ITERATIONS {
            let (rows, triangle) = weighted(eqs, unknowns, scatter, columns);
            break (triangle, rows);
        }
    };
    if last_change > CONVERGED_ENOUGH && p > 0 && last_change.is_finite() {
        return Err(EstimateError::NotConverged { iterations, last_change });
    }

    let to_parameters = ToParameters::Exact { gravity_m_s2: g, nominal_scale: k0 };
    let (values, jacobian) = to_parameters.at(unknowns);
    let covariance = (p == 3 && degrees_of_freedom > 0)
        .then(|| triangle.unit_covariance().ok())
        .flatten()
        .map(|c| c.propagated(&jacobian));
    let redundant = degrees_of_freedom > 0;
    let residuals: Vec<Residual> = eqs
        .iter()
        .zip(&rows)
        .enumerate()
        .map(|(position, (e, (row, y)))| {
            let weighted_residual = y - dot(row, unknowns);
            let lsb = weighted_residual * total_variance(e, unknowns, scatter).sqrt();
            Residual {
                position,
                angle_deg: e.angle_rad.to_degrees(),
                lsb,
                standardized: (redundant && scatter > 0.0).then_some(weighted_residual),
            }
        })
        .collect();
    let weighted_rows = rows
        .iter()
        .zip(eqs)
        .map(|((row, y), e)| WeightedRow {
            row: *row,
            y: *y,
            sd_lsb: total_variance(e, unknowns, scatter).sqrt(),
            residual: y - dot(row, unknowns),
            is_bound: false,
            further: [0.0; MOST_TERMS],
        })
        .collect();
    let residual_std_lsb = redundant.then(|| {
        (residuals.iter().map(|r| r.lsb * r.lsb).sum::<f64>() / degrees_of_freedom as f64).sqrt()
    });
    let stated = eqs.iter().any(|e| e.angle_uncertainty_rad > 0.0);
    Ok(Fit {
        values,
        covariance,
        degrees_of_freedom,
        dof: [degrees_of_freedom as f64; 3],
        profile: None,
        residuals,
        residual_std_lsb,
        against_stated: (redundant && stated)
            .then(|| against_stated(scatter, degrees_of_freedom as f64))
            .flatten(),
        weighted_rows,
        to_parameters,
        scatter: None,
        sized_by_residuals: false,
    })
}

/// Variance of the residuals over what was stated, against χ².
fn against_stated(variance_ratio: f64, degrees_of_freedom: f64) -> Option<AgainstStated> {
    let upper = chi_squared_p_value(variance_ratio * degrees_of_freedom, degrees_of_freedom)?;
    Some(AgainstStated { ratio: variance_ratio.sqrt(), p_value: upper.min(1.0 - upper) })
}

/// `(α, β, γ)` of bias, misalignment and scale error.
pub(super) fn unknowns(values: [f64; 3], setting: &Setting<'_>) -> [f64; 3] {
    ToParameters::Exact {
        gravity_m_s2: setting.bench.gravity.value_m_s2,
        nominal_scale: setting.nominal_scale_m_s2_per_lsb,
    }
    .unknowns(values)
}

impl ToParameters {
    /// The unknowns that have these parameters.
    #[must_use]
    pub fn unknowns(self, values: [f64; 3]) -> [f64; 3] {
        match self {
            Self::Identity => values,
            Self::Exact { gravity_m_s2, nominal_scale } => {
                let [bias, misalignment, scale_error] = values;
                let k = nominal_scale * (1.0 + scale_error);
                let r = gravity_m_s2 / k;
                [bias / k, r * misalignment.cos(), r * misalignment.sin()]
            }
        }
    }

    /// Parameters at a solution and their Jacobian.
    ///
    /// **Model** with `R = √(β²+γ²)`: `Δa = α g/R`, `Δφ = atan2(γ, β)`, `δk = g/(R k0) − 1`.
    #[must_use]
    pub fn at(self, unknowns: [f64; 3]) -> ([f64; 3], Matrix) {
        match self {
            Self::Identity => {
                let one = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
                (unknowns, Matrix::from_rows(one))
            }
            Self::Exact { gravity_m_s2: g, nominal_scale: k0 } => {
                let [alpha, beta, gamma] = unknowns;
                let r = beta.hypot(gamma);
                let r3 = r * r * r;
                let values = [alpha * g / r, gamma.atan2(beta), g / (r * k0) - 1.0];
                let jacobian = Matrix::from_rows([
                    [g / r, -alpha * g * beta / r3, -alpha * g * gamma / r3],
                    [0.0, -gamma / (r * r), beta / (r * r)],
                    [0.0, -g * beta / (r3 * k0), -g * gamma / (r3 * k0)],
                ]);
                (values, jacobian)
            }
        }
    }
}

fn dot(row: &[f64; 3], b: [f64; 3]) -> f64 {
    row.iter().zip(b).map(|(x, v)| x * v).sum()
}

/// `R` and `Δφ` at a solution.
fn amplitude(unknowns: [f64; 3]) -> (f64, f64) {
    (unknowns[1].hypot(unknowns[2]), unknowns[2].atan2(unknowns[1]))
}

fn total_variance(e: &Equation, unknowns: [f64; 3], scatter: f64) -> f64 {
    let (r, misalignment) = amplitude(unknowns);
    let v = scatter * e.scatter_variance(r, misalignment) + e.lean_variance(r);
    // Data without any scatter (made by a formula) still need a finite weight.
    if v > 0.0 { v } else { e.scatter_variance(r, misalignment) }
}

/// Row of a position and its right-hand side, unweighted.
fn unweighted(e: &Equation, unknowns: [f64; 3]) -> ([f64; 3], f64) {
    let (r, _) = amplitude(unknowns);
    match (e.seat, e.seat.vertical_sign()) {
        (Seat::Table, _) | (_, None) => {
            let (sin, cos) = e.angle_rad.sin_cos();
            ([1.0, sin, cos], e.analogue_lsb)
        }
        (_, Some(sign)) => (
            [1.0, sign * unknowns[1] / r, sign * unknowns[2] / r],
            e.analogue_lsb + e.lean_expectation(r),
        ),
    }
}

/// All rows divided by their standard deviation, and their triangle.
fn weighted(
    eqs: &[Equation],
    unknowns: [f64; 3],
    scatter: f64,
    columns: [bool; 3],
) -> (Vec<([f64; 3], f64)>, Triangular) {
    let mut triangle = Triangular::new(columns.iter().filter(|c| **c).count());
    let rows = eqs
        .iter()
        .map(|e| {
            let (row, y) = unweighted(e, unknowns);
            let s = total_variance(e, unknowns, scatter).sqrt();
            (row.map(|v| v / s), y / s)
        })
        .inspect(|(row, y)| triangle.push(&select(row, columns), *y))
        .collect();
    (rows, triangle)
}

/// `s²`: what the stated shape of the variances must be multiplied with for `Σ r²/(s² v + lean²) = n − p`.
///
/// Without upright dwells this is the weighted residual variance. The left side falls with `s²`, so the root is
/// unique; when the lean alone explains the residuals it is zero.
fn scatter_scale(
    eqs: &[Equation],
    linearized_at: [f64; 3],
    solved: [f64; 3],
    start: f64,
    degrees_of_freedom: usize,
    has_lean: bool,
) -> f64 {
    let (r, misalignment) = amplitude(solved);
    let terms: Vec<(f64, f64, f64)> = eqs
        .iter()
        .map(|e| {
            let (row, y) = unweighted(e, linearized_at);
            let residual = y - dot(&row, solved);
            (residual * residual, e.scatter_variance(r, misalignment), e.lean_variance(r))
        })
        .collect();
    let dof = degrees_of_freedom as f64;
    if !has_lean {
        return terms.iter().map(|(rr, v, _)| rr / v).sum::<f64>() / dof;
    }
    let excess = |s: f64| terms.iter().map(|(rr, v, l)| rr / (s * v + l)).sum::<f64>() - dof;
    let mut hi = start.max(f64::MIN_POSITIVE * 1e16);
    while excess(hi) > 0.0 && hi < 1e30 {
        hi *= 4.0;
    }
    let mut lo = hi;
    while excess(lo) < 0.0 && lo > 1e-30 {
        lo /= 4.0;
    }
    for _ in 0..200 {
        let mid = 0.5 * (lo + hi);
        if mid <= lo || mid >= hi {
            break;
        }
        if excess(mid) > 0.0 { lo = mid } else { hi = mid }
    }
    0.5 * (lo + hi)
}

/// Largest change of an unknown against the amplitude.
fn change(old: [f64; 3], new: [f64; 3]) -> f64 {
    let size = amplitude(new).0.max(new[0].abs()).max(f64::MIN_POSITIVE);
    old.iter().zip(new).map(|(a, b)| (a - b).abs() / size).fold(0.0, f64::max)
}
