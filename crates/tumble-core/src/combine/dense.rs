//! The inverse of a positive definite matrix of any size: the normal equations of the runs.

use crate::linalg::Matrix;

/// Inverse and logarithm of the determinant; `None` where the matrix is not positive definite.
pub(super) fn inverse(a: &Matrix) -> Option<(Matrix, f64)> {
    let n = a.rows();
    // Scaled to a unit diagonal: columns may differ by powers of ten.
    let mut scale = Vec::with_capacity(n);
    for i in 0..n {
        scale.push(positive(a[(i, i)])?.sqrt());
    }
    let mut l = Matrix::zeros(n, n);
    let mut ln_det = 0.0;
    for i in 0..n {
        for j in 0..=i {
            let done: f64 = (0..j).map(|k| l[(i, k)] * l[(j, k)]).sum();
            let rest = a[(i, j)] / (scale[i] * scale[j]) - done;
            if i == j {
                // A unit diagonal that is used up by the columns before it leaves rounding only.
                if rest < 1e-14 {
                    return None;
                }
                l[(i, i)] = positive(rest)?.sqrt();
                ln_det += 2.0 * (l[(i, i)] * scale[i]).ln();
            } else {
                l[(i, j)] = rest / l[(j, j)];
            }
        }
    }
    // L⁻¹, then L⁻ᵀ L⁻¹.
    let mut m = Matrix::zeros(n, n);
    for j in 0..n {
        for i in j..n {
            let unit = if i == j { 1.0 } else { 0.0 };
            let done: f64 = (j..i).map(|k| l[(i, k)] * m[(k, j)]).sum();
            m[(i, j)] = (unit - done) / l[(i, i)];
        }
    }
    let mut out = Matrix::zeros(n, n);
    for i in 0..n {
        for j in 0..=i {
            let v: f64 = (i..n).map(|k| m[(k, i)] * m[(k, j)]).sum();
            out[(i, j)] = v / (scale[i] * scale[j]);
            out[(j, i)] = out[(i, j)];
        }
    }
    Some((out, ln_det))
}

fn positive(x: f64) -> Option<f64> {
    (x > 0.0 && x.is_finite()).then_some(x)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_inverse_is_one_and_singular_matrices_have_none() {
        let a = Matrix::from_rows([[4.0, 2.0, 1e-6], [2.0, 3.0, 0.0], [1e-6, 0.0, 1e-10]]);
        let (b, ln_det) = inverse(&a).unwrap();
        let one = a.times(&b);
        for i in 0..3 {
            for j in 0..3 {
                let unit = if i == j { 1.0 } else { 0.0 };
                assert!((one[(i, j)] - unit).abs() < 1e-9, "{one:?}");
            }
        }
        let det: f64 = 4.0 * 3.0 * 1e-10 - 2.0 * 2.0 * 1e-10 - 1e-6 * 3.0 * 1e-6;
        assert!((ln_det - det.ln()).abs() < 1e-9);
        assert!(inverse(&Matrix::from_rows([[1.0, 1.0], [1.0, 1.0]])).is_none());
        assert!(inverse(&Matrix::from_rows([[f64::NAN]])).is_none());
    }
}
