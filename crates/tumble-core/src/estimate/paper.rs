//! The paper's estimator: linear in the small unknowns, ordinary least squares. Kept as the baseline.

use super::types::{AgainstStated, ProfileIntervals, Residual, Scatter};
use super::{Equation, Setting, select};
use crate::linalg::{Matrix, Triangular};
use crate::{Position, Seat};

/// Most further terms of a model.
pub(super) const MOST_TERMS: usize = super::terms::Term::ALL.len();

/// An equation of the adjustment over its standard deviation, so that the covariance of the unknowns is `(XᵀX)⁻¹`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WeightedRow {
    /// Row of the design over the standard deviation.
    pub row: [f64; 3],
    /// Right-hand side over the standard deviation.
    pub y: f64,
    /// Standard deviation that the fit gives to this position, LSB.
    pub sd_lsb: f64,
    /// What is left over, over the standard deviation.
    pub residual: f64,
    /// Whether the dwell's codes only bound its level: such a residual is zero inside of the bounds, and says nothing
    /// about how much positions scatter.
    pub is_bound: bool,
    /// Columns of the further terms that were entered, over the standard deviation; zero beyond their number.
    pub further: [f64; MOST_TERMS],
}

impl WeightedRow {
    /// Number of further columns that the rows of a run have.
    #[must_use]
    pub fn further_columns(rows: &[Self]) -> usize {
        (0..MOST_TERMS).rfind(|i| rows.iter().any(|r| r.further[*i] != 0.0)).map_or(0, |i| i + 1)
    }
}

/// A fitted run, before it is judged.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Fit {
    pub values: [f64; 3],
    pub covariance: Option<Matrix>,
    pub degrees_of_freedom: usize,
    /// Effective degrees of freedom of each parameter's uncertainty.
    pub dof: [f64; 3],
    /// Intervals that are not `value ± t u`.
    pub profile: Option<ProfileIntervals>,
    pub residuals: Vec<Residual>,
    pub residual_std_lsb: Option<f64>,
    pub against_stated: Option<AgainstStated>,
    /// Equations over their standard deviation, in measured order.
    pub weighted_rows: Vec<WeightedRow>,
    /// From the unknowns of the rows to bias, misalignment, scale error.
    pub to_parameters: ToParameters,
    /// Noise and scatter, where the estimator tells them apart.
    pub scatter: Option<Scatter>,
    /// Whether the residuals say how large each parameter's variance is, not the model of the scatter.
    pub sized_by_residuals: bool,
}

/// From the unknowns of an adjustment to the parameters.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ToParameters {
    /// They are the parameters.
    Identity,
    /// `(α, β, γ)` of the exact form.
    Exact {
        /// `g`, m/s².
        gravity_m_s2: f64,
        /// `k0`, m/s² per LSB.
        nominal_scale: f64,
    },
}

/// Row `(1, g cosφ, −g sinφ)` of equation (6). Upright dwells know no misalignment.
pub(super) fn design_row(position: &Position, gravity_m_s2: f64) -> [f64; 3] {
    row(position.angle.rad(), position.seat, gravity_m_s2)
}

pub(super) fn row(angle_rad: f64, seat: Seat, gravity_m_s2: f64) -> [f64; 3] {
    match seat.vertical_sign() {
        Some(sign) => [1.0, 0.0, -sign * gravity_m_s2],
        None => [1.0, gravity_m_s2 * angle_rad.cos(), -gravity_m_s2 * angle_rad.sin()],
    }
}

/// Ordinary least squares on equation (6).
pub(super) fn fit(eqs: &[Equation], setting: &Setting<'_>, columns: [bool; 3]) -> Fit {
    let g = setting.bench.gravity.value_m_s2;
    let k0 = setting.nominal_scale_m_s2_per_lsb;
    let rows: Vec<([f64; 3], f64)> = eqs
        .iter()
        .map(|e| {
            let row = row(e.angle_rad, e.seat, g);
            // g sinφ stands in the row already, with the opposite sign.
            (row, k0 * e.analogue_lsb + row[2])
        })
        .collect();
    let p = columns.iter().filter(|c| **c).count();
    let mut triangle = Triangular::new(p);
    rows.iter().for_each(|(r, y)| triangle.push(&select(r, columns), *y));
    let values = spread(&triangle.solve().unwrap_or_else(|_| vec![0.0; p]), columns);
    let degrees_of_freedom = eqs.len().saturating_sub(p);
    let variance = (degrees_of_freedom > 0)
        .then(|| triangle.residual_sum_of_squares() / degrees_of_freedom as f64);
    let covariance = variance
        .filter(|_| p == 3)
        .and_then(|s2| triangle.unit_covariance().ok().map(|c| c.scaled(s2)));
    let residuals = rows
        .iter()
        .zip(eqs)
        .enumerate()
        .map(|(position, ((row, y), e))| {
            let r = y - row.iter().zip(values).map(|(x, v)| x * v).sum::<f64>();
            Residual {
                position,
                angle_deg: e.angle_rad.to_degrees(),
                lsb: r / k0,
                standardized: variance.filter(|s2| *s2 > 0.0).map(|s2| r / s2.sqrt()),
            }
        })
        .collect::<Vec<_>>();
    let sd = variance.filter(|s2| *s2 > 0.0).map_or(1.0, f64::sqrt);
    let weighted_rows = rows
        .iter()
        .zip(&residuals)
        .map(|((row, y), r)| WeightedRow {
            row: row.map(|v| v / sd),
            y: y / sd,
            sd_lsb: sd / k0,
            residual: r.lsb * k0 / sd,
            is_bound: false,
            further: [0.0; MOST_TERMS],
        })
        .collect();
    Fit {
        values,
        covariance,
        degrees_of_freedom,
        dof: [degrees_of_freedom as f64; 3],
        profile: None,
        residuals,
        residual_std_lsb: variance.map(|s2| s2.sqrt() / k0),
        against_stated: None,
        weighted_rows,
        to_parameters: ToParameters::Identity,
        scatter: None,
        sized_by_residuals: false,
    }
}

/// Fitted columns back in their places, zero elsewhere.
pub(super) fn spread(fitted: &[f64], columns: [bool; 3]) -> [f64; 3] {
    let mut out = [0.0; 3];
    let places = (0..3).filter(|i| columns[*i]);
    places.zip(fitted).for_each(|(i, v)| out[i] = *v);
    out
}

impl ToParameters {
    /// `g` of the exact form, m/s²; one where the unknowns are the parameters.
    pub(super) fn gravity_m_s2(self) -> f64 {
        match self {
            Self::Identity => 1.0,
            Self::Exact { gravity_m_s2, .. } => gravity_m_s2,
        }
    }
}
