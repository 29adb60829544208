//! Singular values by one-sided Jacobi rotations: slow for large matrices, accurate for small ones.

use super::Matrix;

/// Singular values (descending) and right singular vectors (columns, in the same order).
#[derive(Debug, Clone, PartialEq)]
pub struct SingularValues {
    /// Descending.
    pub values: Vec<f64>,
    /// Column `j` belongs to `values[j]`.
    pub right: Matrix,
}

impl SingularValues {
    /// Largest over smallest; infinite where the smallest is zero.
    #[must_use]
    pub fn condition(&self) -> f64 {
        match (self.values.first(), self.values.last()) {
            (Some(a), Some(b)) => a / b,
            _ => 1.0,
        }
    }
}

/// Singular values of a matrix by one-sided Jacobi rotations.
///
/// **Source** Golub & Van Loan, *Matrix Computations*, 4th ed., section 8.6.3.
#[must_use]
pub fn singular_values(matrix: &Matrix) -> SingularValues {
    let n = matrix.columns();
    let mut a = matrix.clone();
    let mut v = Matrix::zeros(n, n);
    (0..n).for_each(|i| v[(i, i)] = 1.0);
    for _sweep in 0..60 {
        let mut rotated = false;
        for p in 0..n {
            for q in p + 1..n {
                rotated |= orthogonalize(&mut a, &mut v, p, q);
            }
        }
        if !rotated {
            break;
        }
    }
    let mut order: Vec<(f64, usize)> = (0..n)
        .map(|j| ((0..a.rows()).map(|i| a[(i, j)] * a[(i, j)]).sum::<f64>().sqrt(), j))
        .collect();
    order.sort_by(|x, y| y.0.total_cmp(&x.0));
    let mut right = Matrix::zeros(n, n);
    for (to, (_, from)) in order.iter().enumerate() {
        (0..n).for_each(|i| right[(i, to)] = v[(i, *from)]);
    }
    SingularValues { values: order.into_iter().map(|(s, _)| s).collect(), right }
}

/// Rotates two columns until they are orthogonal; tells whether there was anything to do.
fn orthogonalize(a: &mut Matrix, v: &mut Matrix, p: usize, q: usize) -> bool {
    let (mut pp, mut qq, mut pq) = (0.0, 0.0, 0.0);
    for i in 0..a.rows() {
        pp += a[(i, p)] * a[(i, p)];
        qq += a[(i, q)] * a[(i, q)];
        pq += a[(i, p)] * a[(i, q)];
    }
    if pq == 0.0 || pq.abs() <= f64::EPSILON * (pp * qq).sqrt() {
        return false;
    }
    let zeta = (qq - pp) / (2.0 * pq);
    let t = zeta.signum() / (zeta.abs() + (1.0 + zeta * zeta).sqrt());
    let c = 1.0 / (1.0 + t * t).sqrt();
    for m in [a, v] {
        for i in 0..m.rows() {
            let (x, y) = (m[(i, p)], m[(i, q)]);
            m[(i, p)] = c * (x - t * y);
            m[(i, q)] = c * (t * x + y);
        }
    }
    true
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn known_singular_values() {
        // [[3,0],[4,5]]: singular values 3√5 and √5.
        let s = singular_values(&Matrix::from_rows([[3.0, 0.0], [4.0, 5.0]]));
        assert!((s.values[0] - 45f64.sqrt()).abs() < 1e-14);
        assert!((s.values[1] - 5f64.sqrt()).abs() < 1e-14);
        assert!((s.condition() - 3.0).abs() < 1e-14);
    }

    #[test]
    fn the_null_vector_of_a_singular_matrix_is_found() {
        let s = singular_values(&Matrix::from_rows([
            [1.0, 1.0, 0.0],
            [0.0, 0.0, 1.0],
            [2.0, 2.0, 0.0],
        ]));
        assert!(s.values[2] < 1e-15);
        let null = [s.right[(0, 2)], s.right[(1, 2)], s.right[(2, 2)]];
        assert!((null[0] + null[1]).abs() < 1e-15 && null[2].abs() < 1e-15);
    }
}
