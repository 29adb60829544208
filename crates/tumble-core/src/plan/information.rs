//! Information matrices of few parameters, in normal form: every design weighs them by the thousand.
//!
//! Rows come in units of the targets, so that conditions stay moderate; where the normal form would lose its digits
//! (a condition of columns beyond 1e6) the terms are told apart by nobody's data, and the plan is refused.

/// Most columns: five terms that angles tell apart, and two that test them.
pub(super) const MOST: usize = 7;

/// One position's row over its standard deviation, times the terms' units.
pub(super) type Row = [f64; MOST];
/// A symmetric matrix.
pub(super) type Square = [[f64; MOST]; MOST];

/// Least share of a diagonal element that elimination must leave: rounding is 1e-16, a condition of 1e6 leaves 1e-12.
const PIVOT: f64 = 1e-12;

/// `Σ w x xᵀ`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Information {
    pub columns: usize,
    m: Square,
}

impl Information {
    pub fn new(columns: usize) -> Self {
        Self { columns, m: [[0.0; MOST]; MOST] }
    }

    pub fn add(&mut self, row: &Row, weight: f64) {
        for i in 0..self.columns {
            for j in 0..self.columns {
                self.m[i][j] += weight * row[i] * row[j];
            }
        }
    }

    pub fn with(mut self, row: &Row, weight: f64) -> Self {
        self.add(row, weight);
        self
    }

    /// Makes a diagonal element larger by a share of itself.
    pub fn add_diagonal(&mut self, i: usize, share: f64) {
        self.m[i][i] += share * self.m[i][i];
    }

    /// Inverse and logarithm of the determinant; `None` where columns are not told apart.
    pub fn inverse(&self) -> Option<(Square, f64)> {
        let p = self.columns;
        // Cholesky, then the inverse of the triangle, then its product.
        let mut l = [[0.0; MOST]; MOST];
        let mut log_determinant = 0.0;
        for j in 0..p {
            let pivot = self.m[j][j] - (0..j).map(|k| l[j][k] * l[j][k]).sum::<f64>();
            if pivot.is_nan() || pivot <= PIVOT * self.m[j][j] {
                return None;
            }
            l[j][j] = pivot.sqrt();
            log_determinant += pivot.ln();
            for i in j + 1..p {
                let s = self.m[i][j] - (0..j).map(|k| l[i][k] * l[j][k]).sum::<f64>();
                l[i][j] = s / l[j][j];
            }
        }
        let mut inv = [[0.0; MOST]; MOST];
        for j in 0..p {
            inv[j][j] = 1.0 / l[j][j];
            for i in j + 1..p {
                let s: f64 = (j..i).map(|k| l[i][k] * inv[k][j]).sum();
                inv[i][j] = -s / l[i][i];
            }
        }
        let mut out = [[0.0; MOST]; MOST];
        for i in 0..p {
            for j in 0..=i {
                out[i][j] = (i..p).map(|k| inv[k][i] * inv[k][j]).sum();
                out[j][i] = out[i][j];
            }
        }
        Some((out, log_determinant))
    }
}

/// `A x`.
pub(super) fn times(a: &Square, x: &Row, columns: usize) -> Row {
    let mut out = [0.0; MOST];
    for i in 0..columns {
        out[i] = (0..columns).map(|j| a[i][j] * x[j]).sum();
    }
    out
}

/// `xᵀ y`.
pub(super) fn dot(x: &Row, y: &Row, columns: usize) -> f64 {
    (0..columns).map(|i| x[i] * y[i]).sum()
}
