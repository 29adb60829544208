//! What the next power-up may bring: its estimate, and its true value.

use super::{Basis, Contrast};
use crate::stats::student_factor;

/// Half-widths of the two predictions around the pooled value.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Prediction {
    /// For the **estimate** of the next run, measured like those before.
    pub next_estimate: f64,
    /// For the **true value** in the next power-up.
    pub next_true: f64,
}

/// Predicts the next power-up; `None` where the units' scatter says nothing (one run).
///
/// **Model** With `T = q (ω² + c)` the variance of single estimates, `c` the typical variance within a run, `q` of
/// [`Contrast::ratio`] and `u` the uncertainty of the pooled value: estimate `t √(T + u²)`, true value
/// `t √(T (T + c)/(T + 2c) + u²)`. For equal precision `T = s²` and the first is `t(k−1) s √(1 + 1/k)`, exact.
///
/// The second has no exact form. `T − c`, cut at zero, is the plain one: it covers 85 % for ten runs and a spread of half the
/// uncertainty within. `T (T + c)/(T + 2c)` tends to it where the spread is large, and to half of `T` where there is
/// none: 94 % or more at any spread for two runs and more, and more than 95 % where there is hardly any spread
/// (`docs/runs.md` has the table).
#[must_use]
pub fn prediction(
    column: &Contrast,
    omega_squared: f64,
    within_variance: f64,
    level: f64,
) -> Option<Prediction> {
    if column.basis == Basis::Own {
        return None;
    }
    let t = student_factor(level, column.degrees_of_freedom)?;
    let (c, u2) = (within_variance, column.standard_uncertainty.powi(2));
    let total = column.ratio * (omega_squared + c);
    // Copies of one run scatter by nothing and say nothing of it.
    let between = if total > 0.0 { total * (total + c) / (total + 2.0 * c) } else { 0.0 };
    Some(Prediction {
        next_estimate: t * (total + u2).sqrt(),
        next_true: t * (between + u2).sqrt(),
    })
}
