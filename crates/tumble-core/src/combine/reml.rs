//! Restricted maximum likelihood of a diagonal `Ω`, by Fisher scoring inside the cone.

use super::dense::inverse;
use super::{CombineError, Unit};
use crate::linalg::{Matrix, Symmetric3};

/// What is added to every variance, in units of the mean variance of its entry: keeps copies of one run solvable.
const RIDGE: f64 = 1e-12;
/// Most steps; monotone, so the last is the best even where they run out.
const STEPS: usize = 100;
/// Change of `ω²`, over the mean variance of its entry, that counts as none.
const CONVERGED: f64 = 1e-10;

/// A unit with its absent entries padded: variance one, no value, no column.
pub(super) struct ScaledUnit {
    pub(super) present: [bool; 3],
    pub(super) values: [f64; 3],
    pub(super) covariance: Symmetric3,
    /// Columns of `μ` that it touches.
    pub(super) columns: Vec<usize>,
    /// Coefficients: an entry's row over `columns`.
    pub(super) design: [Vec<f64>; 3],
    pub(super) dof: [f64; 3],
}

/// All units with every entry over a typical standard deviation, so that `ω²` of order one is as large as `C`.
pub(super) struct Scaled {
    pub(super) units: Vec<ScaledUnit>,
    pub(super) columns: usize,
    /// Size of an entry.
    pub(super) sizes: [f64; 3],
    /// Entry that a column belongs to.
    pub(super) entry_of: Vec<usize>,
}

impl Scaled {
    pub(super) fn of(units: &[Unit], columns: usize) -> Result<Self, CombineError> {
        let sizes = core::array::from_fn(|j| size(units, j));
        let mut entry_of = vec![usize::MAX; columns];
        let mut out = Vec::with_capacity(units.len());
        for (index, unit) in units.iter().enumerate() {
            let present = unit.values.map(|v| v.is_some());
            let mut touched: Vec<usize> = Vec::new();
            for (j, row) in unit.design.iter().enumerate().filter(|(j, _)| present[*j]) {
                for (column, _) in row {
                    *entry_of.get_mut(*column).ok_or(CombineError::Undetermined)? = j;
                    if !touched.contains(column) {
                        touched.push(*column);
                    }
                }
            }
            let mut covariance = Symmetric3::default();
            for i in 0..3 {
                for j in 0..3 {
                    covariance.0[i][j] = match (present[i] && present[j], i == j) {
                        (true, _) => unit.covariance.0[i][j] / (sizes[i] * sizes[j]),
                        (false, true) => 1.0,
                        (false, false) => 0.0,
                    };
                }
            }
            let sound = (0..3).all(|i| covariance.0[i][i] >= 0.0)
                && covariance.0.iter().flatten().all(|c| c.is_finite())
                && unit.values.iter().flatten().all(|v| v.is_finite());
            if !sound {
                return Err(CombineError::NotPositive { unit: index });
            }
            let design = core::array::from_fn(|j| {
                let of = |c: &usize| {
                    let row = unit.design[j].iter().filter(|_| present[j]);
                    row.filter(|(column, _)| column == c).map(|(_, x)| x).sum()
                };
                touched.iter().map(of).collect()
            });
            out.push(ScaledUnit {
                present,
                values: core::array::from_fn(|j| unit.values[j].unwrap_or(0.0) / sizes[j]),
                covariance,
                columns: touched,
                design,
                dof: unit.dof,
            });
        }
        if entry_of.contains(&usize::MAX) {
            return Err(CombineError::Undetermined);
        }
        Ok(Self { units: out, columns, sizes, entry_of })
    }

    /// The restricted log-likelihood of the data themselves: entries and columns back in their sizes.
    pub(super) fn in_units_of_the_data(&self, log_likelihood: f64) -> f64 {
        let entries: f64 = self
            .units
            .iter()
            .map(|u| (0..3).filter(|j| u.present[*j]).map(|j| self.sizes[j].ln()).sum::<f64>())
            .sum();
        let columns: f64 = self.entry_of.iter().map(|j| self.sizes[*j].ln()).sum();
        log_likelihood - entries + columns
    }
}

/// Typical standard deviation of an entry; with no variance at all, how far the values lie apart.
fn size(units: &[Unit], j: usize) -> f64 {
    let of = |u: &Unit| u.values[j].map(|_| u.covariance.0[j][j]);
    let variances: Vec<f64> = units.iter().filter_map(of).collect();
    let within = crate::stats::mean(&variances).filter(|v| v.is_finite()).unwrap_or(0.0).sqrt();
    let values: Vec<f64> = units.iter().filter_map(|u| u.values[j]).collect();
    let apart = crate::stats::sample_std(&values).filter(|s| s.is_finite()).unwrap_or(0.0);
    // Far below the spread, the within-run part counts for nothing and must not set the scale.
    match within.max(1e-6 * apart) {
        s if s > 0.0 => s,
        _ => 1.0,
    }
}

/// Generalized least squares at one `Ω`.
pub(super) struct Solution {
    /// `μ̂`, scaled.
    pub(super) mu: Vec<f64>,
    /// `(Σ X'V⁻¹X)⁻¹`, scaled.
    pub(super) covariance: Matrix,
    /// `V_r⁻¹`.
    pub(super) precision: Vec<Symmetric3>,
    /// `θ̂_r − X_r μ̂`.
    pub(super) residuals: Vec<[f64; 3]>,
    pub(super) log_likelihood: f64,
}

pub(super) fn solve(scaled: &Scaled, omega2: [f64; 3]) -> Result<Solution, CombineError> {
    let p = scaled.columns;
    let mut normal = Matrix::zeros(p, p);
    let mut precision = Vec::with_capacity(scaled.units.len());
    let mut ln_det_v = 0.0;
    for (index, u) in scaled.units.iter().enumerate() {
        let (w, ln_det) =
            variance(u, omega2).inverse().ok_or(CombineError::NotPositive { unit: index })?;
        ln_det_v += ln_det;
        for (a, column_a) in u.columns.iter().enumerate() {
            let half = w.times(column(u, a));
            for (b, column_b) in u.columns.iter().enumerate() {
                normal[(*column_a, *column_b)] += crate::linalg::dot3(half, column(u, b));
            }
        }
        precision.push(w);
    }
    let (covariance, ln_det_a) = inverse(&normal).ok_or(CombineError::Undetermined)?;
    let mut mu = vec![0.0; p];
    let mut residuals: Vec<[f64; 3]> = scaled.units.iter().map(|u| u.values).collect();
    // The second pass takes back what rounding left: values may be far from zero.
    for _ in 0..2 {
        let mut right = vec![0.0; p];
        for ((u, w), e) in scaled.units.iter().zip(&precision).zip(&residuals) {
            let weighted = w.times(*e);
            for (a, c) in u.columns.iter().enumerate() {
                right[*c] += crate::linalg::dot3(column(u, a), weighted);
            }
        }
        for (i, m) in mu.iter_mut().enumerate() {
            *m += (0..p).map(|j| covariance[(i, j)] * right[j]).sum::<f64>();
        }
        for (u, e) in scaled.units.iter().zip(&mut residuals) {
            for j in (0..3).filter(|j| u.present[*j]) {
                let model: f64 = u.columns.iter().zip(&u.design[j]).map(|(c, x)| x * mu[*c]).sum();
                e[j] = u.values[j] - model;
            }
        }
    }
    let misfit: f64 = precision.iter().zip(&residuals).map(|(w, e)| w.quadratic(*e)).sum();
    let log_likelihood = -0.5 * (ln_det_v + ln_det_a + misfit);
    Ok(Solution { mu, covariance, precision, residuals, log_likelihood })
}

/// Column `a` of a unit's design.
pub(super) fn column(u: &ScaledUnit, a: usize) -> [f64; 3] {
    core::array::from_fn(|j| u.design[j][a])
}

/// `V_r = C_r + Ω`.
pub(super) fn variance(u: &ScaledUnit, omega2: [f64; 3]) -> Symmetric3 {
    let mut v = u.covariance;
    for j in (0..3).filter(|j| u.present[*j]) {
        v.0[j][j] += omega2[j] + RIDGE;
    }
    v
}

/// `Ω` at the maximum, and the adjustment there.
pub(super) struct Fitted {
    pub(super) omega2: [f64; 3],
    /// Whether the units say anything about an `ω²`.
    pub(super) free: [bool; 3],
    pub(super) solution: Solution,
}

/// Score `s_j = ½ (e'W Z_j Z_j'W e − tr(P Z_j Z_j'))`, its two parts apart, and expected information.
struct Slope {
    quadratic: [f64; 3],
    trace: [f64; 3],
    information: [[f64; 3]; 3],
}

fn slope(scaled: &Scaled, s: &Solution) -> Slope {
    // Rows of V_r⁻¹ X_r, masked to entries that are there.
    let left: Vec<Vec<[f64; 3]>> = scaled
        .units
        .iter()
        .zip(&s.precision)
        .map(|(u, w)| (0..u.columns.len()).map(|a| w.times(column(u, a))).collect())
        .collect();
    let mut out = Slope { quadratic: [0.0; 3], trace: [0.0; 3], information: [[0.0; 3]; 3] };
    for (r, u) in scaled.units.iter().enumerate() {
        let weighted = s.precision[r].times(s.residuals[r]);
        for j in (0..3).filter(|j| u.present[*j]) {
            out.quadratic[j] += weighted[j] * weighted[j];
        }
        for (t, v) in scaled.units.iter().enumerate().skip(r) {
            let mut block = if r == t { s.precision[r].0 } else { [[0.0; 3]; 3] };
            for (a, left_a) in left[r].iter().enumerate() {
                for (b, left_b) in left[t].iter().enumerate() {
                    let m = s.covariance[(u.columns[a], v.columns[b])];
                    for i in 0..3 {
                        for j in 0..3 {
                            block[i][j] -= left_a[i] * m * left_b[j];
                        }
                    }
                }
            }
            let times = if r == t { 1.0 } else { 2.0 };
            for i in (0..3).filter(|i| u.present[*i]) {
                for j in (0..3).filter(|j| v.present[*j]) {
                    out.information[i][j] += 0.5 * times * block[i][j] * block[i][j];
                }
                if r == t {
                    out.trace[i] += block[i][i];
                }
            }
        }
    }
    // Blocks above the diagonal were counted for both; their transposes belong to the other order.
    let m = out.information;
    for i in 0..3 {
        for j in 0..3 {
            out.information[i][j] = 0.5 * (m[i][j] + m[j][i]);
        }
    }
    out
}

/// Finds the maximum. Every step goes up or is not taken; `ω² = 0` is allowed and stays inside the cone.
pub(super) fn fit(scaled: &Scaled) -> Result<Fitted, CombineError> {
    let mut omega2 = [0.0; 3];
    let mut solution = solve(scaled, omega2)?;
    let first = slope(scaled, &solution);
    let entries = |j: usize| scaled.units.iter().filter(|u| u.present[j]).count() as f64;
    let free: [bool; 3] = core::array::from_fn(|j| first.trace[j] > 1e-9 * entries(j).max(1.0));
    for j in (0..3).filter(|j| free[*j]) {
        // Away from zero, where the likelihood may be flat beside its maximum.
        omega2[j] = start(scaled, j);
    }
    let moved = solve(scaled, omega2)?;
    if moved.log_likelihood > solution.log_likelihood {
        solution = moved;
    } else {
        omega2 = [0.0; 3];
    }
    for _ in 0..STEPS {
        let s = slope(scaled, &solution);
        let step = scoring(&s, omega2, free);
        let Some((next, better)) = uphill(scaled, &solution, omega2, step, &s, free)? else {
            break;
        };
        let change = (0..3).map(|j| (next[j] - omega2[j]).abs() / (1.0 + omega2[j]));
        let change = change.fold(0.0, f64::max);
        omega2 = next;
        solution = better;
        if change < CONVERGED {
            break;
        }
    }
    Ok(Fitted { omega2, free, solution })
}

/// Variance of the values beyond what the units say of themselves, column by column.
fn start(scaled: &Scaled, j: usize) -> f64 {
    let members: Vec<&ScaledUnit> = scaled.units.iter().filter(|u| u.present[j]).collect();
    let values: Vec<f64> = members.iter().map(|u| u.values[j]).collect();
    let own: Vec<f64> = members.iter().map(|u| u.covariance.0[j][j]).collect();
    let spread = crate::stats::sample_std(&values).map_or(0.0, |s| s * s);
    (spread - crate::stats::mean(&own).unwrap_or(0.0)).max(0.1)
}

/// Fisher's step over the `ω²` that may move.
fn scoring(s: &Slope, omega2: [f64; 3], free: [bool; 3]) -> [f64; 3] {
    let score: [f64; 3] = core::array::from_fn(|j| 0.5 * (s.quadratic[j] - s.trace[j]));
    let mut information = Symmetric3::default();
    let active: [bool; 3] =
        core::array::from_fn(|j| free[j] && (omega2[j] > 0.0 || score[j] > 0.0));
    let mut right = [0.0; 3];
    for i in 0..3 {
        for j in 0..3 {
            information.0[i][j] = match (active[i] && active[j], i == j) {
                (true, true) => s.information[i][i] * (1.0 + 1e-10),
                (true, false) => s.information[i][j],
                (false, true) => 1.0,
                (false, false) => 0.0,
            };
        }
        right[i] = if active[i] { score[i] } else { 0.0 };
    }
    information.inverse().map_or([0.0; 3], |(inverse, _)| inverse.times(right))
}

/// The first point along the step, cut at zero, that lies higher; else the multiplicative step, which always does.
fn uphill(
    scaled: &Scaled,
    now: &Solution,
    omega2: [f64; 3],
    step: [f64; 3],
    s: &Slope,
    free: [bool; 3],
) -> Result<Option<([f64; 3], Solution)>, CombineError> {
    let mut factor = 1.0;
    for _ in 0..12 {
        let next: [f64; 3] = core::array::from_fn(|j| (omega2[j] + factor * step[j]).max(0.0));
        if next == omega2 {
            break;
        }
        let there = solve(scaled, next)?;
        if there.log_likelihood > now.log_likelihood {
            return Ok(Some((next, there)));
        }
        factor *= 0.5;
    }
    // Minorize–maximize (Zhou et al., J. Comput. Graph. Statist. 28 (2019) 350).
    let next: [f64; 3] = core::array::from_fn(|j| match free[j] && s.trace[j] > 0.0 {
        true => omega2[j] * (s.quadratic[j] / s.trace[j]).sqrt(),
        false => omega2[j],
    });
    let there = solve(scaled, next)?;
    Ok((there.log_likelihood > now.log_likelihood).then_some((next, there)))
}
