//! Least squares that grows row by row.

use super::double::Double;
use super::{Matrix, SingularValues, singular_values};

/// Condition number (unit columns) beyond which a column counts as a combination of the others.
///
/// Angles are typed with two to four decimals of a degree; an arc of a hundredth of a degree already has a
/// condition number of 1e8. At 1e10 six of sixteen digits are left (NIST’s Filip, 5e9, gives seven); identical angles are
/// past 1e15.
pub const RANK_CONDITION_LIMIT: f64 = 1e10;

/// Unknowns and right-hand side that fit the work space on the stack.
const ON_STACK: usize = 12;

/// The equations leave some unknowns undetermined.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RankDeficient {
    /// Condition number with unit columns; infinite for exact dependence.
    pub condition: f64,
    /// Largest condition number that is solved.
    pub limit: f64,
}

/// The triangular factor `R` of a least-squares problem `X b ≈ y`, with `Qᵀy` and the residual sum of squares.
///
/// Rows come one at a time (Givens rotations), so estimates after every row cost no refit, memory stays at
/// `p²`, and two halves of the data merge. The normal equations are never formed: their condition number is
/// the square of the problem's. The rotations carry twice the digits of `f64`, for the same reason.
///
/// ```
/// use tumble_core::linalg::Triangular;
/// let mut line = Triangular::new(2);
/// for (x, y) in [(0.0, 1.0), (1.0, 3.0), (2.0, 5.0)] {
///     line.push(&[1.0, x], y);
/// }
/// let b = line.solve()?;
/// assert!((b[0] - 1.0).abs() < 1e-14 && (b[1] - 2.0).abs() < 1e-14);
///
/// // Two equal abscissas determine no slope: refused, not guessed.
/// let mut one_place = Triangular::new(2);
/// one_place.push(&[1.0, 4.0], 1.0);
/// one_place.push(&[1.0, 4.0], 2.0);
/// assert!(one_place.solve().is_err());
/// # Ok::<(), tumble_core::linalg::RankDeficient>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Triangular {
    columns: usize,
    /// Upper triangle, row-major, with `Qᵀy` as the last column.
    r: Vec<Double>,
    residual_sum_of_squares: Double,
    rows: usize,
}

impl Triangular {
    /// No rows yet.
    #[must_use]
    pub fn new(columns: usize) -> Self {
        Self {
            columns,
            r: vec![Double::default(); columns * (columns + 1)],
            residual_sum_of_squares: Double::default(),
            rows: 0,
        }
    }

    /// Adds the equation `row · b = y`. For weighted least squares both sides are divided by the standard
    /// uncertainty of `y`.
    pub fn push(&mut self, row: &[f64], y: f64) {
        debug_assert_eq!(row.len(), self.columns, "a row has one number a column");
        // Few columns, many rows: the work space stays on the stack.
        let mut space = [Double::default(); ON_STACK];
        let width = self.columns + 1;
        match space.get_mut(..width) {
            Some(rest) => {
                rest.iter_mut().zip(row.iter().chain([&y])).for_each(|(to, v)| *to = (*v).into());
                self.rotate_in(rest);
            }
            None => {
                let mut rest: Vec<Double> = row.iter().chain([&y]).map(|v| (*v).into()).collect();
                self.rotate_in(&mut rest);
            }
        }
        self.rows += 1;
    }

    /// Rotates a row into the triangle and adds what is left of it to the residual sum of squares.
    fn rotate_in(&mut self, rest: &mut [Double]) {
        let p = self.columns;
        for i in 0..p {
            if rest[i].hi == 0.0 {
                continue;
            }
            let pivot = self.r[i * (p + 1) + i];
            let length = (pivot * pivot + rest[i] * rest[i]).sqrt();
            let (c, s) = (pivot / length, rest[i] / length);
            for j in i..=p {
                let (u, v) = (self.r[i * (p + 1) + j], rest[j]);
                self.r[i * (p + 1) + j] = c * u + s * v;
                rest[j] = c * v - s * u;
            }
        }
        self.residual_sum_of_squares = self.residual_sum_of_squares + rest[p] * rest[p];
    }

    /// Element of the triangle, or of `Qᵀy` in the last column.
    fn at(&self, i: usize, j: usize) -> Double {
        self.r[i * (self.columns + 1) + j]
    }

    /// Adds all equations of another problem in the same unknowns.
    pub fn merge(&mut self, other: &Self) {
        debug_assert_eq!(self.columns, other.columns, "merged problems have the same unknowns");
        for i in 0..other.columns {
            let mut row: Vec<Double> = (0..=other.columns).map(|j| other.at(i, j)).collect();
            self.rotate_in(&mut row);
        }
        self.residual_sum_of_squares = self.residual_sum_of_squares + other.residual_sum_of_squares;
        self.rows += other.rows;
    }

    /// Number of equations.
    #[must_use]
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// Sum of squared residuals at the solution.
    #[must_use]
    pub fn residual_sum_of_squares(&self) -> f64 {
        self.residual_sum_of_squares.hi
    }

    /// Lengths of the columns of `X`.
    fn column_lengths(&self) -> Vec<f64> {
        (0..self.columns)
            .map(|j| (0..=j).map(|i| self.at(i, j).hi.powi(2)).sum::<f64>().sqrt())
            .collect()
    }

    /// Singular values and right vectors of `X` with its columns scaled to unit length.
    ///
    /// Unscaled condition numbers depend on the choice of units and raise false alarms; these do not.
    /// A column of zeros stays zero.
    #[must_use]
    pub fn scaled_singular_values(&self) -> SingularValues {
        let lengths = self.column_lengths();
        let mut scaled = Matrix::zeros(self.columns, self.columns);
        for i in 0..self.columns {
            for j in i..self.columns {
                if lengths[j] > 0.0 {
                    scaled[(i, j)] = self.at(i, j).hi / lengths[j];
                }
            }
        }
        singular_values(&scaled)
    }

    /// Condition number with unit columns.
    #[must_use]
    pub fn condition(&self) -> f64 {
        self.scaled_singular_values().condition()
    }

    fn require_full_rank(&self) -> Result<(), RankDeficient> {
        let condition = self.condition();
        if condition <= RANK_CONDITION_LIMIT {
            Ok(())
        } else {
            Err(RankDeficient { condition, limit: RANK_CONDITION_LIMIT })
        }
    }

    /// The least-squares solution.
    ///
    /// **Errors** [`RankDeficient`] where the condition number exceeds [`RANK_CONDITION_LIMIT`].
    pub fn solve(&self) -> Result<Vec<f64>, RankDeficient> {
        self.require_full_rank()?;
        Ok(self.back_substituted())
    }

    /// The solution of a problem that is known to have full rank.
    pub(crate) fn back_substituted(&self) -> Vec<f64> {
        let p = self.columns;
        let mut b = vec![Double::default(); p];
        for i in (0..p).rev() {
            let known = (i + 1..p).fold(Double::default(), |sum, j| sum + self.at(i, j) * b[j]);
            b[i] = (self.at(i, p) - known) / self.at(i, i);
        }
        b.into_iter().map(|v| v.hi).collect()
    }

    /// `(XᵀX)⁻¹`: the covariance of the solution for unit variance of `y`.
    pub fn unit_covariance(&self) -> Result<Matrix, RankDeficient> {
        self.require_full_rank()?;
        Ok(self.unit_covariance_unchecked())
    }

    /// `(XᵀX)⁻¹` of a problem that is known to have full rank.
    pub(crate) fn unit_covariance_unchecked(&self) -> Matrix {
        let p = self.columns;
        let mut inverse = Matrix::zeros(p, p);
        for j in 0..p {
            for i in (0..=j).rev() {
                let unit = if i == j { 1.0 } else { 0.0 };
                let known: f64 = (i + 1..=j).map(|k| self.at(i, k).hi * inverse[(k, j)]).sum();
                inverse[(i, j)] = (unit - known) / self.at(i, i).hi;
            }
        }
        inverse.times(&inverse.transposed())
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn two_halves_merge_to_the_whole(
            rows in prop::collection::vec((prop::array::uniform3(-2.0..2.0f64), -5.0..5.0f64), 8..40),
            cut in 0..8usize,
        ) {
            let fit = |part: &[([f64; 3], f64)]| {
                let mut t = Triangular::new(3);
                part.iter().for_each(|(x, y)| t.push(x, *y));
                t
            };
            let whole = fit(&rows);
            let mut merged = fit(&rows[cut..]);
            merged.merge(&fit(&rows[..cut]));
            prop_assume!(whole.condition() < 1e4);
            for (a, b) in whole.solve().unwrap().iter().zip(merged.solve().unwrap()) {
                prop_assert!((a - b).abs() < 1e-9, "{a} {b}");
            }
            let (a, b) = (whole.residual_sum_of_squares(), merged.residual_sum_of_squares());
            prop_assert!((a - b).abs() <= 1e-10 * (1.0 + a));
        }
    }
}
