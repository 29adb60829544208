//! Square root of a covariance.

use crate::linalg::Matrix;

/// `C = L Lᵀ`.
pub(super) struct Cholesky {
    lower: Matrix,
}

impl Cholesky {
    pub fn of(c: &Matrix) -> Option<Self> {
        let n = c.rows();
        let mut l = Matrix::zeros(n, n);
        for j in 0..n {
            let mut d = c[(j, j)];
            for k in 0..j {
                d -= l[(j, k)] * l[(j, k)];
            }
            // Thinned sums leave a covariance that is not quite one: held at a thousandth of the diagonal.
            let d = d.max(1e-3 * c[(j, j)]);
            if !(d > 0.0 && d.is_finite()) {
                return None;
            }
            l[(j, j)] = d.sqrt();
            for i in j + 1..n {
                let mut s = c[(i, j)];
                for k in 0..j {
                    s -= l[(i, k)] * l[(j, k)];
                }
                l[(i, j)] = s / l[(j, j)];
            }
        }
        Some(Self { lower: l })
    }

    /// `L y`.
    pub fn product(&self, y: &[f64]) -> Vec<f64> {
        (0..y.len()).map(|i| (0..=i).map(|k| self.lower[(i, k)] * y[k]).sum()).collect()
    }

    /// `ln |C|`.
    pub fn log_determinant(&self) -> f64 {
        2.0 * (0..self.lower.rows()).map(|i| self.lower[(i, i)].ln()).sum::<f64>()
    }

    /// `L⁻¹ D L⁻ᵀ` of a symmetric matrix, row by row.
    pub fn both_sides(&self, d: &Matrix) -> Vec<f64> {
        let n = d.rows();
        let row = |i: usize| (0..n).map(|j| d[(i, j)]).collect::<Vec<_>>();
        // Rows of D L⁻ᵀ; its columns are those of the transposed.
        let half: Vec<Vec<f64>> = (0..n).map(|i| self.solve_lower(&row(i))).collect();
        let mut out = vec![0.0; n * n];
        for j in 0..n {
            let column: Vec<f64> = half.iter().map(|h| h[j]).collect();
            for (i, x) in self.solve_lower(&column).into_iter().enumerate() {
                out[i * n + j] = x;
            }
        }
        out
    }

    /// `L⁻¹ y`.
    pub fn solve_lower(&self, y: &[f64]) -> Vec<f64> {
        let mut out = y.to_vec();
        for i in 0..out.len() {
            for k in 0..i {
                let known = out[k];
                out[i] -= self.lower[(i, k)] * known;
            }
            out[i] /= self.lower[(i, i)];
        }
        out
    }

    /// `L⁻ᵀ y`.
    pub fn solve_upper(&self, y: &[f64]) -> Vec<f64> {
        let mut out = y.to_vec();
        for i in (0..out.len()).rev() {
            for k in i + 1..out.len() {
                let known = out[k];
                out[i] -= self.lower[(k, i)] * known;
            }
            out[i] /= self.lower[(i, i)];
        }
        out
    }
}
