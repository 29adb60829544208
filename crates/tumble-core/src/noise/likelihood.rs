//! The most likely coefficients, of a normal distribution whose covariance is the model's.

use super::cholesky::Cholesky;
use super::covariance::AllanCovariance;
use super::model::columns;
use super::subset::{COUNT, least_of};
use super::{Coefficients, Variance};
use crate::linalg::Matrix;

const STEPS: usize = 30;
const SETTLED: f64 = 1e-4;
const HALVINGS: usize = 12;

/// `ln |C| + rᵀ C⁻¹ r`.
fn unlikeliness(variances: &[Variance], family: &AllanCovariance, at: &[f64; COUNT]) -> Option<f64> {
    let model = Coefficients::from_order(*at);
    let whiten = Cholesky::of(&family.at(&model))?;
    let r: Vec<f64> = variances.iter().map(|v| v.variance - model.variance(v.tau_s)).collect();
    let w = whiten.solve_lower(&r);
    Some(whiten.log_determinant() + w.iter().map(|w| w * w).sum::<f64>())
}

/// From a start on; one coefficient may be held.
pub(super) fn most_likely(
    variances: &[Variance],
    family: &AllanCovariance,
    start: [f64; COUNT],
    held: Option<usize>,
) -> Option<[f64; COUNT]> {
    let n = variances.len();
    let mut at = start;
    let mut value = unlikeliness(variances, family, &at)?;
    for _ in 0..STEPS {
        let model = Coefficients::from_order(at);
        let whiten = Cholesky::of(&family.at(&model))?;
        let r: Vec<f64> = variances.iter().map(|v| v.variance - model.variance(v.tau_s)).collect();
        let wr = whiten.solve_lower(&r);
        let mu: [Vec<f64>; COUNT] = core::array::from_fn(|j| {
            let c: Vec<f64> = variances.iter().map(|v| columns(v.tau_s)[j]).collect();
            whiten.solve_lower(&c)
        });
        let size: [f64; COUNT] =
            core::array::from_fn(|j| 1.0 / mu[j].iter().map(|m| m * m).sum::<f64>().sqrt());
        // Whitened derivatives of the covariance, exact: it is quadratic.
        let slopes: Vec<Matrix> = (0..COUNT)
            .map(|j| {
                let (mut up, mut down) = (at, at);
                up[j] += size[j];
                down[j] -= size[j];
                let (up, down) =
                    (family.at(&Coefficients::from_order(up)), family.at(&Coefficients::from_order(down)));
                let mut d = Matrix::zeros(n, n);
                for a in 0..n {
                    for b in 0..n {
                        d[(a, b)] = 0.5 * (up[(a, b)] - down[(a, b)]);
                    }
                }
                whiten.both_sides(&d)
            })
            .collect();
        let mut gradient = [0.0; COUNT];
        let mut bend = [[0.0; COUNT]; COUNT];
        for j in 0..COUNT {
            for a in 0..n {
                gradient[j] += slopes[j][(a, a)] - 2.0 * size[j] * mu[j][a] * wr[a];
                for b in 0..n {
                    gradient[j] -= wr[a] * slopes[j][(a, b)] * wr[b];
                }
            }
            for k in 0..COUNT {
                for a in 0..n {
                    bend[j][k] += 2.0 * size[j] * size[k] * mu[j][a] * mu[k][a];
                    for b in 0..n {
                        bend[j][k] += slopes[j][(a, b)] * slopes[k][(a, b)];
                    }
                }
            }
        }
        // x = θ/size: least of ½ xᵀ H x − (H x0 − g)ᵀ x.
        let x0: [f64; COUNT] = core::array::from_fn(|j| at[j] / size[j]);
        let right = core::array::from_fn(|j| {
            (0..COUNT)
                .filter(|k| Some(*k) != held)
                .map(|k| bend[j][k] * x0[k])
                .sum::<f64>()
                - gradient[j]
        });
        let mut x = least_of(&bend, &right, held);
        if let Some(h) = held {
            x[h] = x0[h];
        }
        let mut part = 1.0;
        let mut moved = None;
        for _ in 0..HALVINGS {
            let next: [f64; COUNT] =
                core::array::from_fn(|j| (at[j] + part * (x[j] * size[j] - at[j])).max(0.0));
            if let Some(v) = unlikeliness(variances, family, &next).filter(|v| *v < value) {
                moved = Some((next, v));
                break;
            }
            part *= 0.5;
        }
        let Some((next, v)) = moved else { break };
        let gain = value - v;
        (at, value) = (next, v);
        if gain < SETTLED {
            break;
        }
    }
    Some(at)
}
