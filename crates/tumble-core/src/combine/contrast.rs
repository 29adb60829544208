//! One column of `μ̂` with its uncertainty from how the units scatter.

use super::reml::{Fitted, Scaled, ScaledUnit, column, variance};
use crate::linalg::dot3;

/// Least expectation of `Σ z²/v`, in units' worth, from which the units' own scatter sets the size. A column with one
/// unit has nearly nothing.
const ENOUGH: f64 = 0.5;

/// What the size of an uncertainty rests on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Basis {
    /// How the units scatter around the column.
    Scatter,
    /// The units' own covariances: too few units to scatter.
    Own,
}

/// A common parameter.
#[derive(Debug, Clone, PartialEq)]
pub struct Contrast {
    /// `μ̂_p`.
    pub value: f64,
    /// `√(q Σ v_r)`.
    pub standard_uncertainty: f64,
    /// Satterthwaite's, of `q`.
    pub degrees_of_freedom: f64,
    /// `q`: observed scatter over the model's; one on the basis of the units' own covariances.
    pub ratio: f64,
    /// Where `q` comes from.
    pub basis: Basis,
    /// `a_r`: how far the value moves with each entry of each unit.
    pub weights: Vec<[f64; 3]>,
}

pub(super) fn contrasts(scaled: &Scaled, fitted: &Fitted) -> Vec<Contrast> {
    (0..scaled.columns).map(|p| contrast(scaled, fitted, p)).collect()
}

fn contrast(scaled: &Scaled, fitted: &Fitted, p: usize) -> Contrast {
    let s = &fitted.solution;
    let entry = scaled.entry_of[p];
    let weights: Vec<[f64; 3]> = scaled
        .units
        .iter()
        .zip(&s.precision)
        .map(|(u, w)| w.times(model_part(u, |c| s.covariance[(c, p)])))
        .collect();
    let v: Vec<f64> = scaled
        .units
        .iter()
        .zip(&weights)
        .map(|(u, a)| variance(u, fitted.omega2).quadratic(*a))
        .collect();
    // Units that have the parameter itself; the others only lean on it.
    let members: Vec<usize> = (0..v.len())
        .filter(|r| {
            let u = &scaled.units[*r];
            let has = |(c, x): (&usize, &f64)| *c == p && *x != 0.0;
            v[*r] > 0.0 && u.present[entry] && u.columns.iter().zip(&u.design[entry]).any(has)
        })
        .collect();
    // Rows of a_r' X_r over the columns.
    let pulled: Vec<Vec<(usize, f64)>> = members
        .iter()
        .map(|r| {
            let u = &scaled.units[*r];
            let part = |(i, c): (usize, &usize)| (*c, dot3(weights[*r], column(u, i)));
            u.columns.iter().enumerate().map(part).collect()
        })
        .collect();
    let (mut expected, mut squares) = (0.0, 0.0);
    for (i, r) in members.iter().enumerate() {
        for (j, t) in members.iter().enumerate() {
            let mut g = if i == j { v[*r] } else { 0.0 };
            for (c, x) in &pulled[i] {
                for (d, y) in &pulled[j] {
                    g -= x * s.covariance[(*c, *d)] * y;
                }
            }
            let g = g / (v[*r] * v[*t]).sqrt();
            squares += g * g;
            if i == j {
                expected += g;
            }
        }
    }
    let total: f64 = v.iter().sum();
    let size = scaled.sizes[entry];
    let back = |a: &[f64; 3]| core::array::from_fn(|j| a[j] * size / scaled.sizes[j]);
    let (ratio, degrees_of_freedom, basis) = if expected >= ENOUGH {
        let seen: f64 =
            members.iter().map(|r| dot3(weights[*r], s.residuals[*r]).powi(2) / v[*r]).sum();
        (seen / expected, expected * expected / squares, Basis::Scatter)
    } else {
        let own: f64 = scaled.units.iter().zip(&v).map(|(u, v)| v * v / u.dof[entry]).sum();
        (1.0, if own > 0.0 { total * total / own } else { f64::INFINITY }, Basis::Own)
    };
    Contrast {
        value: s.mu[p] * size,
        standard_uncertainty: (ratio * total).sqrt() * size,
        degrees_of_freedom,
        ratio,
        basis,
        weights: weights.iter().map(back).collect(),
    }
}

/// `X_r m` for a vector over the columns.
fn model_part(u: &ScaledUnit, m: impl Fn(usize) -> f64) -> [f64; 3] {
    core::array::from_fn(|j| u.columns.iter().zip(&u.design[j]).map(|(c, x)| x * m(*c)).sum())
}
