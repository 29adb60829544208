//! What a plan will know before anyone turns the table.

use super::paper;
use super::terms::{Term, TermSet};
use crate::linalg::{RankDeficient, Triangular};
use crate::{Angle, Seat};

/// Standard uncertainties that a plan reaches, and how well it tells the parameters apart.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Prediction {
    /// Bias, m/s².
    pub u_bias_m_s2: f64,
    /// Misalignment, rad.
    pub u_misalignment_rad: f64,
    /// Scale error, relative.
    pub u_scale_error: f64,
    /// Condition number with unit columns.
    pub condition: f64,
    /// Correlation of bias and misalignment.
    pub correlation_bias_misalignment: f64,
}

/// Predicts the standard uncertainties of a plan with the same scatter at every position.
///
/// **Assumes** small errors, uncorrelated positions, and no lean of upright dwells.
///
/// **Source** method section 7.
///
/// ```
/// use tumble_core::{Angle, Seat};
/// use tumble_core::estimate::predict;
/// let paper: Vec<_> = (-30..30).map(|d| (Angle::from_deg(f64::from(d)), Seat::Table)).collect();
/// let p = predict(&paper, 0.2 * 0.00769, 9.81)?;
/// assert!((p.u_bias_m_s2 / 0.00769 - 0.616).abs() < 0.001);   // LSB
///
/// // One angle says nothing about three parameters.
/// assert!(predict(&[(Angle::from_deg(10.0), Seat::Table); 5], 1e-3, 9.81).is_err());
/// # Ok::<(), tumble_core::linalg::RankDeficient>(())
/// ```
pub fn predict(
    plan: &[(Angle, Seat)],
    scatter_m_s2: f64,
    gravity_m_s2: f64,
) -> Result<Prediction, RankDeficient> {
    let mut triangle = Triangular::new(3);
    for (angle, seat) in plan {
        let row = paper::row(angle.rad(), *seat, gravity_m_s2);
        triangle.push(&row.map(|v| v / scatter_m_s2), 0.0);
    }
    let c = triangle.unit_covariance()?;
    Ok(Prediction {
        u_bias_m_s2: c[(0, 0)].sqrt(),
        u_misalignment_rad: c[(1, 1)].sqrt(),
        u_scale_error: c[(2, 2)].sqrt(),
        condition: triangle.condition(),
        correlation_bias_misalignment: c.correlation(0, 1).unwrap_or(0.0),
    })
}

/// [`predict`] with further terms in the model. Terms on temperature need temperatures and are not predicted.
///
/// ```
/// use tumble_core::{Angle, Seat};
/// use tumble_core::estimate::{Term, TermSet, predict_with_terms};
/// let paper: Vec<_> = (-30..30).map(|d| (Angle::from_deg(f64::from(d)), Seat::Table)).collect();
/// let k2 = TermSet::EMPTY.with(Term::K2);
/// let p = predict_with_terms(&paper, k2, 0.2 * 0.00769, 9.81)?;
/// assert!((p.u_bias_m_s2 / 0.00769 - 35.0).abs() < 1.0);   // LSB: 57 times as much as without
/// # Ok::<(), tumble_core::linalg::RankDeficient>(())
/// ```
pub fn predict_with_terms(
    plan: &[(Angle, Seat)],
    terms: TermSet,
    scatter_m_s2: f64,
    gravity_m_s2: f64,
) -> Result<Prediction, RankDeficient> {
    let terms: Vec<Term> = terms.iter().filter(|t| !t.needs_temperature()).collect();
    let mut triangle = Triangular::new(3 + terms.len());
    for (angle, seat) in plan {
        let sine = seat.vertical_sign().unwrap_or_else(|| angle.rad().sin());
        let row: Vec<f64> = paper::row(angle.rad(), *seat, gravity_m_s2)
            .into_iter()
            .chain(terms.iter().map(|t| t.basis(gravity_m_s2 * sine, 0.0)))
            .map(|v| v / scatter_m_s2)
            .collect();
        triangle.push(&row, 0.0);
    }
    let c = triangle.unit_covariance()?;
    Ok(Prediction {
        u_bias_m_s2: c[(0, 0)].sqrt(),
        u_misalignment_rad: c[(1, 1)].sqrt(),
        u_scale_error: c[(2, 2)].sqrt(),
        condition: triangle.condition(),
        correlation_bias_misalignment: c.correlation(0, 1).unwrap_or(0.0),
    })
}
