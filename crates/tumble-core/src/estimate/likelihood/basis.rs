//! The plan's columns made orthonormal, so that narrow arcs cost no digits in the normal equations.

use crate::linalg::{Matrix, Symmetric3, dot3};

/// `X = Q R` for three columns.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Basis {
    /// Rows of `Q`.
    pub rows: Vec<[f64; 3]>,
    /// `R⁻¹`: from shifts in the basis to shifts of the unknowns.
    inverse: [[f64; 3]; 3],
}

impl Basis {
    /// By Gram and Schmidt, twice (once is not enough for condition numbers past 1e8). The columns are known to be
    /// independent.
    pub fn of(rows: &[[f64; 3]]) -> Self {
        let mut q: Vec<[f64; 3]> = rows.to_vec();
        let mut r = [[0.0; 3]; 3];
        for j in 0..3 {
            for _ in 0..2 {
                for i in 0..j {
                    let along: f64 = q.iter().map(|row| row[i] * row[j]).sum();
                    q.iter_mut().for_each(|row| row[j] -= along * row[i]);
                    r[i][j] += along;
                }
            }
            let length = q.iter().map(|row| row[j] * row[j]).sum::<f64>().sqrt();
            q.iter_mut().for_each(|row| row[j] /= length);
            r[j][j] = length;
        }
        let d = [1.0 / r[0][0], 1.0 / r[1][1], 1.0 / r[2][2]];
        let e01 = -r[0][1] * d[0] * d[1];
        let e12 = -r[1][2] * d[1] * d[2];
        let e02 = -(r[0][1] * e12 + r[0][2] * d[2]) * d[0];
        Self { rows: q, inverse: [[d[0], e01, e02], [0.0, d[1], e12], [0.0, 0.0, d[2]]] }
    }

    /// A shift of the unknowns.
    pub fn unknowns(&self, shift: [f64; 3]) -> [f64; 3] {
        self.inverse.map(|row| dot3(row, shift))
    }

    /// Covariance of the unknowns.
    pub fn covariance(&self, c: &Symmetric3) -> Matrix {
        Matrix::from_rows(c.0).propagated(&Matrix::from_rows(self.inverse))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_basis_is_orthonormal_and_leads_back() {
        let rows: Vec<[f64; 3]> = (0..40)
            .map(|i| (10.0 + 0.02 * f64::from(i)).to_radians().sin_cos())
            .map(|(s, c)| [1.0, s, c])
            .collect();
        let basis = Basis::of(&rows);
        for i in 0..3 {
            for j in 0..3 {
                let product: f64 = basis.rows.iter().map(|q| q[i] * q[j]).sum();
                assert!((product - f64::from(u8::from(i == j))).abs() < 1e-12, "{i} {j} {product}");
            }
        }
        let back = basis.unknowns([1.0, 1e-3, 1e-6]);
        for (row, q) in rows.iter().zip(&basis.rows) {
            assert!((dot3(*row, back) - dot3(*q, [1.0, 1e-3, 1e-6])).abs() < 1e-8);
        }
    }
}
