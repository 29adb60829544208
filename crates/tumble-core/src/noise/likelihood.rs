//! The most likely coefficients, the variances taken as normal with the model's covariance.
//!
//! Weighted least squares finds a coefficient by what it adds to the variances. A weak random walk beside a strong ramp
//! adds nothing that is seen, yet most of the scatter of the ramp is its own: only the covariance shows it.

use super::cholesky::{Cholesky, dot};
use super::covariance::AllanCovariance;
use super::model::columns;
use super::nonnegative::{COUNT, least};
use super::{Coefficients, Variance};
use crate::linalg::Matrix;

/// Steps of a fit; six are usual.
const STEPS: usize = 30;
/// Growth of twice the logarithm of the likelihood that is none.
const SETTLED: f64 = 1e-3;
/// Halvings of a step that does not help.
const HALVINGS: usize = 8;

/// Fisher's scoring about a model.
pub(super) struct Scoring {
    at: [f64; COUNT],
    held: [bool; COUNT],
    whiten: Cholesky,
    /// Means of the variances.
    model: Vec<f64>,
    /// Units of the steps.
    size: [f64; COUNT],
    /// Derivatives of the means, whitened, in those units.
    means: [Vec<f64>; COUNT],
    /// Derivatives of the covariance, whitened from both sides, and their traces.
    slopes: [Vec<f64>; COUNT],
    traces: [f64; COUNT],
    /// Twice the information; its diagonal is one.
    bend: [[f64; COUNT]; COUNT],
}

impl Scoring {
    /// About a model, some coefficients held where they are.
    pub fn about(
        variances: &[Variance],
        family: &AllanCovariance,
        at: [f64; COUNT],
        held: [bool; COUNT],
    ) -> Option<Self> {
        let n = variances.len();
        let of = Coefficients::from_order(at);
        let whiten = Cholesky::of(&family.at(&of))?;
        let rows: Vec<[f64; COUNT]> = variances.iter().map(|v| columns(v.tau_s)).collect();
        let mut means: [Vec<f64>; COUNT] = core::array::from_fn(|j| {
            whiten.solve_lower(&rows.iter().map(|r| r[j]).collect::<Vec<_>>())
        });
        let size: [f64; COUNT] = core::array::from_fn(|j| 1.0 / dot(&means[j], &means[j]).sqrt());
        // Exact: the covariance is quadratic in the coefficients.
        let slope = |j: usize| {
            let (mut up, mut down) = (at, at);
            up[j] += size[j];
            down[j] -= size[j];
            let [up, down] = [up, down].map(|c| family.at(&Coefficients::from_order(c)));
            let mut d = Matrix::zeros(n, n);
            for a in 0..n {
                for b in 0..n {
                    d[(a, b)] = 0.5 * (up[(a, b)] - down[(a, b)]) / size[j];
                }
            }
            whiten.both_sides(&d)
        };
        let mut slopes: [Vec<f64>; COUNT] = core::array::from_fn(slope);
        let information =
            |i: usize, j: usize| 2.0 * dot(&means[i], &means[j]) + dot(&slopes[i], &slopes[j]);
        let raw: [[f64; COUNT]; COUNT] =
            core::array::from_fn(|i| core::array::from_fn(|j| information(i, j)));
        let size: [f64; COUNT] = core::array::from_fn(|j| 1.0 / raw[j][j].sqrt());
        let bend =
            core::array::from_fn(|i| core::array::from_fn(|j| raw[i][j] * size[i] * size[j]));
        for j in 0..COUNT {
            means[j].iter_mut().for_each(|m| *m *= size[j]);
            slopes[j].iter_mut().for_each(|s| *s *= size[j]);
        }
        let traces = core::array::from_fn(|j| (0..n).map(|a| slopes[j][a * n + a]).sum());
        let model = variances.iter().map(|v| of.variance(v.tau_s)).collect();
        Some(Self { at, held, whiten, model, size, means, slopes, traces, bend })
    }

    /// One step towards what is most likely for measured variances, no coefficient negative.
    pub fn step(&self, measured: &[f64]) -> [f64; COUNT] {
        let r: Vec<f64> = measured.iter().zip(&self.model).map(|(y, m)| y - m).collect();
        let z = self.whiten.solve_lower(&r);
        let n = z.len();
        let mut right: [f64; COUNT] = core::array::from_fn(|j| {
            let mut down = -self.traces[j];
            for a in 0..n {
                let row = dot(&self.slopes[j][a * n..(a + 1) * n], &z);
                down += z[a] * (row + 2.0 * self.means[j][a]);
            }
            down
        });
        let start: [f64; COUNT] = core::array::from_fn(|j| self.at[j] / self.size[j]);
        for j in 0..COUNT {
            let others = (0..COUNT).filter(|k| !self.held[*k]);
            right[j] += others.map(|k| self.bend[j][k] * start[k]).sum::<f64>();
        }
        let guess =
            (0..COUNT).filter(|j| !self.held[*j] && self.at[*j] > 0.0).map(|j| 1 << j).sum();
        let x = least(&self.bend, &right, self.held, guess).x;
        core::array::from_fn(|j| if self.held[j] { self.at[j] } else { x[j] * self.size[j] })
    }
}

/// Coefficients and what they are worth.
#[derive(Debug, Clone, Copy)]
pub(super) struct Likely {
    pub at: [f64; COUNT],
    /// `ln |C| + rᵀ C⁻¹ r`.
    value: f64,
}

fn judged(variances: &[Variance], family: &AllanCovariance, at: [f64; COUNT]) -> Option<Likely> {
    let model = Coefficients::from_order(at);
    let whiten = Cholesky::of(&family.at(&model))?;
    let r: Vec<f64> = variances.iter().map(|v| v.variance - model.variance(v.tau_s)).collect();
    let z = whiten.solve_lower(&r);
    let value = whiten.log_determinant() + dot(&z, &z);
    value.is_finite().then_some(Likely { at, value })
}

/// The most likely coefficients from a start on, some held.
pub(super) fn most_likely(
    variances: &[Variance],
    family: &AllanCovariance,
    start: [f64; COUNT],
    held: [bool; COUNT],
) -> Option<Likely> {
    let measured: Vec<f64> = variances.iter().map(|v| v.variance).collect();
    let mut best = judged(variances, family, start)?;
    for _ in 0..STEPS {
        let whole = Scoring::about(variances, family, best.at, held)?.step(&measured);
        let better = (0..HALVINGS).find_map(|k| {
            let part = 0.5f64.powi(k as i32);
            let next =
                core::array::from_fn(|j| (best.at[j] + part * (whole[j] - best.at[j])).max(0.0));
            judged(variances, family, next).filter(|next| next.value < best.value)
        });
        let Some(next) = better else { break };
        let gain = best.value - next.value;
        best = next;
        if gain < SETTLED {
            break;
        }
    }
    Some(best)
}

/// The same without the coefficients that twice the logarithm of the likelihood can spare for less than `worth` each.
pub(super) fn simplest(
    variances: &[Variance],
    family: &AllanCovariance,
    start: [f64; COUNT],
    mut held: [bool; COUNT],
    worth: f64,
) -> Option<[f64; COUNT]> {
    let mut now = most_likely(variances, family, start, held)?;
    while now.at.iter().filter(|c| **c > 0.0).count() > 1 {
        let spared = (0..COUNT).filter(|j| !held[*j] && now.at[*j] > 0.0).filter_map(|j| {
            let (mut start, mut held) = (now.at, held);
            start[j] = 0.0;
            held[j] = true;
            most_likely(variances, family, start, held).map(|likely| (j, likely))
        });
        let spared = spared.min_by(|a, b| a.1.value.total_cmp(&b.1.value));
        let Some((j, without)) = spared.filter(|(_, l)| l.value < now.value + worth) else { break };
        held[j] = true;
        now = without;
    }
    Some(now.at)
}
