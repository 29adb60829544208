//! Symmetric 3 × 3 matrices on the stack, for the inner loops of the adjustment.

/// A symmetric 3 × 3 matrix.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Symmetric3(pub [[f64; 3]; 3]);

impl Symmetric3 {
    /// Adds `weight · x xᵀ`.
    #[inline]
    pub fn add_outer(&mut self, x: [f64; 3], weight: f64) {
        for i in 0..3 {
            for j in 0..3 {
                self.0[i][j] += weight * x[i] * x[j];
            }
        }
    }

    /// `A x`.
    #[must_use]
    #[inline]
    pub fn times(&self, x: [f64; 3]) -> [f64; 3] {
        self.0.map(|row| dot3(row, x))
    }

    /// `xᵀ A x`.
    #[must_use]
    #[inline]
    pub fn quadratic(&self, x: [f64; 3]) -> f64 {
        dot3(x, self.times(x))
    }

    /// Inverse and logarithm of the determinant of a positive definite matrix; `None` for any other.
    ///
    /// By Cholesky factors; meant for matrices whose columns are nearly orthogonal.
    #[must_use]
    pub fn inverse(&self) -> Option<(Self, f64)> {
        let a = &self.0;
        let l00 = positive_root(a[0][0])?;
        let (l10, l20) = (a[1][0] / l00, a[2][0] / l00);
        let l11 = positive_root(a[1][1] - l10 * l10)?;
        let l21 = (a[2][1] - l20 * l10) / l11;
        let l22 = positive_root(a[2][2] - l20 * l20 - l21 * l21)?;
        // Rows of L⁻¹.
        let (m00, m11, m22) = (1.0 / l00, 1.0 / l11, 1.0 / l22);
        let m10 = -l10 * m00 * m11;
        let m21 = -l21 * m11 * m22;
        let m20 = -(l20 * m00 + l21 * m10) * m22;
        let mut out = Self::default();
        out.add_outer([m00, 0.0, 0.0], 1.0);
        out.add_outer([m10, m11, 0.0], 1.0);
        out.add_outer([m20, m21, m22], 1.0);
        Some((out, 2.0 * (l00.ln() + l11.ln() + l22.ln())))
    }
}

/// Scalar product.
#[must_use]
#[inline]
pub fn dot3(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn positive_root(x: f64) -> Option<f64> {
    (x > 0.0 && x.is_finite()).then(|| x.sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_inverse_is_one() {
        let mut a = Symmetric3::default();
        a.add_outer([1.0, 2.0, -1.0], 2.0);
        a.add_outer([0.5, -1.0, 3.0], 1.0);
        a.add_outer([2.0, 0.1, 0.2], 0.7);
        let (inverse, ln_det) = a.inverse().unwrap();
        for i in 0..3 {
            let mut unit = [0.0; 3];
            unit[i] = 1.0;
            let back = a.times(inverse.times(unit));
            back.iter().zip(unit).for_each(|(x, y)| assert!((x - y).abs() < 1e-12));
        }
        // det = w1 w2 w3 · det[rows]² of three outer products.
        let det: f64 = 1.0 * (-0.2 - 0.3) - 2.0 * (0.1 - 6.0) - (0.05 + 2.0);
        assert!((ln_det - (2.0 * 0.7 * det * det).ln()).abs() < 1e-12);
        assert_eq!(Symmetric3::default().inverse(), None);
    }
}
