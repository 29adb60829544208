//! Square root of a covariance.

use crate::linalg::Matrix;

/// `C = L Lᵀ`.
pub(super) struct Cholesky {
    size: usize,
    /// Row by row.
    lower: Vec<f64>,
}

impl Cholesky {
    pub fn of(c: &Matrix) -> Option<Self> {
        let size = c.rows();
        let mut lower = vec![0.0; size * size];
        for i in 0..size {
            let (above, own) = lower.split_at_mut(i * size);
            for j in 0..i {
                let row = &above[j * size..];
                own[j] = (c[(i, j)] - dot(&own[..j], &row[..j])) / row[j];
            }
            // Thinned sums leave a covariance that is not quite one: held at a thousandth of the diagonal.
            let d = (c[(i, i)] - dot(&own[..i], &own[..i])).max(1e-3 * c[(i, i)]);
            if !(d > 0.0 && d.is_finite()) {
                return None;
            }
            own[i] = d.sqrt();
        }
        Some(Self { size, lower })
    }

    fn row(&self, i: usize) -> &[f64] {
        &self.lower[i * self.size..(i + 1) * self.size]
    }

    /// `L y`.
    pub fn product(&self, y: &[f64]) -> Vec<f64> {
        (0..self.size).map(|i| dot(&self.row(i)[..=i], &y[..=i])).collect()
    }

    /// `ln |C|`.
    pub fn log_determinant(&self) -> f64 {
        2.0 * (0..self.size).map(|i| self.row(i)[i].ln()).sum::<f64>()
    }

    /// `L⁻¹ D L⁻ᵀ` of a symmetric matrix, row by row.
    pub fn both_sides(&self, d: &Matrix) -> Vec<f64> {
        let n = self.size;
        // Rows of D L⁻ᵀ; what is left is to do the same with its columns.
        let rows: Vec<Vec<f64>> = (0..n)
            .map(|i| self.solve_lower(&(0..n).map(|j| d[(i, j)]).collect::<Vec<_>>()))
            .collect();
        let mut out = vec![0.0; n * n];
        for j in 0..n {
            let column: Vec<f64> = rows.iter().map(|row| row[j]).collect();
            for (i, x) in self.solve_lower(&column).into_iter().enumerate() {
                out[i * n + j] = x;
            }
        }
        out
    }

    /// `L⁻¹ y`.
    pub fn solve_lower(&self, y: &[f64]) -> Vec<f64> {
        let mut out = y.to_vec();
        for i in 0..self.size {
            let row = self.row(i);
            out[i] = (out[i] - dot(&row[..i], &out[..i])) / row[i];
        }
        out
    }
}

/// Sum of products.
pub(super) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
