//! Several runs, one adjustment: multivariate random effects.
//!
//! **Model** `θ̂_r = X_r μ + b_r + e_r`, `b_r ~ N(0, Ω)`, `e_r ~ N(0, C_r)`; `Ω` diagonal over bias, misalignment and scale
//! error. An entry that a unit does not have is left out of it.
//!
//! **Source** method section 9; `docs/decisions/0012-runs-together.md` for what was weighed.

mod contrast;
mod dense;
mod predict;
mod reml;
mod univariate;

pub use contrast::{Basis, Contrast};
pub use predict::{Prediction, prediction};
pub use univariate::{Heterogeneity, heterogeneity};

use crate::linalg::{Matrix, Symmetric3};
use reml::{Fitted, Scaled};

/// What one power-up says: a run, or an up/down pair.
#[derive(Debug, Clone, PartialEq)]
pub struct Unit {
    /// `θ̂_r` in the order bias, misalignment, scale error; `None` where the unit does not have it.
    pub values: [Option<f64>; 3],
    /// `C_r` in the same order; rows and columns of absent entries are not looked at.
    pub covariance: Symmetric3,
    /// `X_r`: for each entry the columns of `μ` that it is made of, with their coefficients.
    pub design: [Vec<(usize, f64)>; 3],
    /// Degrees of freedom of the variances of `C_r`; only used where the units' scatter says nothing.
    pub dof: [f64; 3],
}

/// Runs that cannot be put together.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CombineError {
    /// No unit, or no column.
    Empty,
    /// A covariance is not positive, or holds no numbers.
    NotPositive {
        /// Index of the unit.
        unit: usize,
    },
    /// A column is not determined by the units.
    Undetermined,
}

impl std::fmt::Display for CombineError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Empty => f.write_str("there is nothing to put together"),
            Self::NotPositive { unit } => {
                write!(f, "the covariance of run {} is not positive", unit + 1)
            }
            Self::Undetermined => f.write_str("the runs do not determine all common parameters"),
        }
    }
}

impl std::error::Error for CombineError {}

/// The units together.
#[derive(Debug, Clone, PartialEq)]
pub struct Combined {
    /// `μ̂` with its uncertainty, a column each.
    pub columns: Vec<Contrast>,
    /// Covariance of `μ̂`: the model's correlations `(Σ X'V⁻¹X)⁻¹`, the variances of [`Contrast::standard_uncertainty`].
    pub covariance: Matrix,
    /// `ω²` by REML, in the order of the entries; `None` where no two units share a column of it.
    pub omega_squared: [Option<f64>; 3],
    /// Restricted log-likelihood at the maximum, without its constant, in the units of the data.
    pub log_likelihood: f64,
}

/// Puts units together: `Ω` by REML, `μ̂` by generalized least squares, uncertainties after Hartung and Knapp.
///
/// Use it for estimates of several power-ups. It assumes that units are independent and that the relative sizes of
/// their covariances are known. The size itself comes from how the units scatter.
///
/// **Model** `V_r = C_r + Ω`, `μ̂ = Σ A_r θ̂_r`, `A_r = (Σ X'V⁻¹X)⁻¹ X_r' V_r⁻¹`. For column `p` let `a_r` be row `p` of `A_r`,
/// `z_r = a_r·(θ̂_r − X_r μ̂)`, `v_r = a_r' V_r a_r`: then `u² = q Σ v_r`, `q = Σ z_r²/v_r / E[Σ z_r²/v_r]` over the units that
/// have the parameter, with Satterthwaite's degrees of freedom. With equal `C_r` that is the mean, `s/√k` and `k − 1`. A column with
/// too few units to scatter (a mounting of one run) is estimated from its own entry alone, with the units' own variances;
/// one of several columns of an entry (mountings, the table's zero) from its own entry alone where fewer than ten units scatter.
///
/// **Errors** [`CombineError`].
///
/// **Source** Hartung and Knapp, Statist. Med. 20 (2001) 3875; Bell and McCaffrey, Survey Methodology 28 (2002) 169, for the
/// degrees of freedom.
///
/// ```
/// use tumble_core::combine::{Unit, combine};
/// use tumble_core::linalg::Symmetric3;
/// let unit = |bias: f64| Unit {
///     values: [Some(bias), None, None],
///     covariance: Symmetric3([[1e-6, 0.0, 0.0], [0.0; 3], [0.0; 3]]),
///     design: [vec![(0, 1.0)], vec![], vec![]],
///     dof: [57.0; 3],
/// };
/// let together = combine(&[unit(0.010), unit(0.012), unit(0.017)], 1).unwrap();
/// let bias = &together.columns[0];
/// assert!((bias.value - 0.013).abs() < 1e-12);
/// assert!((bias.standard_uncertainty - 0.002_081_666).abs() < 1e-9); // s/√3
/// assert!((bias.degrees_of_freedom - 2.0).abs() < 1e-9);
/// ```
pub fn combine(units: &[Unit], columns: usize) -> Result<Combined, CombineError> {
    if units.is_empty() || columns == 0 {
        return Err(CombineError::Empty);
    }
    let scaled = Scaled::of(units, columns)?;
    let fitted: Fitted = reml::fit(&scaled)?;
    let (columns, model) = contrast::contrasts(&scaled, &fitted)?;
    let mut covariance = Matrix::zeros(model.rows(), model.rows());
    for i in 0..model.rows() {
        for j in 0..model.rows() {
            let r = if i == j { 1.0 } else { model.correlation(i, j).unwrap_or(0.0) };
            covariance[(i, j)] =
                r * columns[i].standard_uncertainty * columns[j].standard_uncertainty;
        }
    }
    Ok(Combined {
        columns,
        covariance,
        omega_squared: core::array::from_fn(|j| {
            fitted.free[j].then(|| fitted.omega2[j] * scaled.sizes[j] * scaled.sizes[j])
        }),
        log_likelihood: scaled.in_units_of_the_data(fitted.solution.log_likelihood),
    })
}
