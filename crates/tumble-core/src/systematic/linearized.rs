//! What a small change of the readings does to the parameters of one run.

use super::Quantity;
use crate::estimate::Estimate;
use crate::linalg::{Matrix, Triangular};

/// A column that is fitted beside the three parameters, such as K2.
#[derive(Debug, Clone, PartialEq)]
pub struct ExtraColumn {
    /// LSB per unit of the term, a value a position.
    pub lsb: Vec<f64>,
    /// The quantity whose place in the budget it takes: fitted, it is no longer a systematic error.
    pub replaces: Option<Quantity>,
}

/// Change of what is fitted.
#[derive(Debug, Clone, PartialEq)]
pub struct Shift {
    /// Of bias (m/s²), misalignment (rad), scale error (relative).
    pub parameters: [f64; 3],
    /// Of the extra columns' coefficients.
    pub terms: Vec<f64>,
}

/// A run's adjustment about its solution.
///
/// **Model** with rows `x_j` and readings over their standard deviations `s_j`: `δθ = J (XᵀX)⁻¹ Σ x_j d_j/s_j²` (`d_j` in LSB),
/// `J` from the unknowns of the rows to the parameters.
///
/// **Assumes** that weights and the scatter's size do not follow the change: true to first order.
#[derive(Debug, Clone, PartialEq)]
pub struct Linearized {
    /// Rows over their standard deviations, with the extra columns.
    rows: Vec<Vec<f64>>,
    sd_lsb: Vec<f64>,
    inverse: Matrix,
    jacobian: Matrix,
}

impl Linearized {
    /// `None` below full rank, also of the extra columns, or where a column has another length than the run.
    #[must_use]
    pub fn new(estimate: &Estimate, extra: &[ExtraColumn]) -> Option<Self> {
        let values = estimate.full()?;
        let n = estimate.weighted_rows.len();
        if extra.iter().any(|c| c.lsb.len() != n) {
            return None;
        }
        let rows: Vec<Vec<f64>> = estimate
            .weighted_rows
            .iter()
            .enumerate()
            .map(|(j, r)| {
                r.row.iter().copied().chain(extra.iter().map(|c| c.lsb[j] / r.sd_lsb)).collect()
            })
            .collect();
        let mut triangle = Triangular::new(3 + extra.len());
        rows.iter().for_each(|r| triangle.push(r, 0.0));
        let to = estimate.to_parameters;
        Some(Self {
            rows,
            sd_lsb: estimate.weighted_rows.iter().map(|r| r.sd_lsb).collect(),
            inverse: triangle.unit_covariance().ok()?,
            jacobian: to.at(to.unknowns(values)).1,
        })
    }

    /// Number of positions.
    #[must_use]
    pub fn positions(&self) -> usize {
        self.rows.len()
    }

    /// What the fit makes of readings that are all larger by `lsb`, one value a position; missing ones count as zero.
    #[must_use]
    pub fn shift(&self, lsb: &[f64]) -> Shift {
        let p = self.inverse.rows();
        let mut pull = vec![0.0; p];
        for ((row, sd), d) in self.rows.iter().zip(&self.sd_lsb).zip(lsb) {
            pull.iter_mut().zip(row).for_each(|(to, x)| *to += x * d / sd);
        }
        let unknowns: Vec<f64> =
            (0..p).map(|i| (0..p).map(|k| self.inverse[(i, k)] * pull[k]).sum()).collect();
        let parameter = |i: usize| (0..3).map(|k| self.jacobian[(i, k)] * unknowns[k]).sum();
        Shift { parameters: core::array::from_fn(parameter), terms: unknowns[3..].to_vec() }
    }

    /// Residuals that such a change leaves, LSB.
    #[must_use]
    pub fn left_over(&self, lsb: &[f64]) -> Vec<f64> {
        let mut triangle = Triangular::new(self.inverse.rows());
        let weighted = |j: usize| lsb.get(j).copied().unwrap_or(0.0) / self.sd_lsb[j];
        self.rows.iter().enumerate().for_each(|(j, r)| triangle.push(r, weighted(j)));
        let b = triangle.solve().unwrap_or_default();
        let fitted = |row: &[f64]| row.iter().zip(&b).map(|(x, v)| x * v).sum::<f64>();
        self.rows
            .iter()
            .enumerate()
            .map(|(j, r)| (weighted(j) - fitted(r)) * self.sd_lsb[j])
            .collect()
    }
}
