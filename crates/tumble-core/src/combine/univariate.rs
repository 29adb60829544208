//! One parameter alone: Cochran's Q, the spread between runs by moments, and its interval.

use crate::stats::{chi_squared_p_value, fisher_p_value};

/// How far runs differ in one parameter, beyond their own uncertainties.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Heterogeneity {
    /// `Q = Σ w (y − ȳ)²`, `w = 1/v`.
    pub cochran_q: f64,
    /// `k` minus the number of groups.
    pub dof: f64,
    /// Probability of a `Q` that large were there no spread.
    pub p_value: f64,
    /// `ω²` after Mandel and Paule: `Q(ω²) = k − 1`.
    pub mandel_paule: f64,
    /// `ω²` after DerSimonian and Laird.
    pub dersimonian_laird: f64,
    /// Interval of `ω²` from the profile of `Q`; the upper end is infinite where no spread is too large.
    pub interval: (f64, f64),
    /// `I² = max(0, 1 − (k − 1)/Q)`: share of the spread that is not the runs' own uncertainty.
    pub i_squared: f64,
}

/// Compares the values of one parameter; runs of one group share a mean.
///
/// `within_dof` are the degrees of freedom of the variances together. Finite ones make `Q/(k − 1)` an F variable: exact
/// for equal precision, and right to first order else. `None` below two runs in any group.
///
/// **Source** Cochran, Biometrics 10 (1954) 101; Paule and Mandel, J. Res. NBS 87 (1982) 377; DerSimonian and Laird,
/// Control. Clin. Trials 7 (1986) 177; Viechtbauer, Statist. Med. 26 (2007) 37, for the interval.
///
/// ```
/// use tumble_core::combine::heterogeneity;
/// // Equal variances: ω² is s² − v by every method.
/// let h = heterogeneity(&[1.0, 2.0, 6.0], &[1.0; 3], &[0; 3], f64::INFINITY, 0.95).unwrap();
/// assert!((h.cochran_q - 14.0).abs() < 1e-12 && (h.mandel_paule - 6.0).abs() < 1e-9);
/// assert!((h.dersimonian_laird - 6.0).abs() < 1e-12 && (h.i_squared - 12.0 / 14.0).abs() < 1e-12);
/// assert!(heterogeneity(&[1.0], &[1.0], &[0], f64::INFINITY, 0.95).is_none());
/// ```
#[must_use]
pub fn heterogeneity(
    values: &[f64],
    variances: &[f64],
    groups: &[usize],
    within_dof: f64,
    level: f64,
) -> Option<Heterogeneity> {
    let largest = groups.iter().max()?;
    let mut seen = vec![0usize; largest + 1];
    groups.iter().for_each(|g| seen[*g] += 1);
    let dof = values.len().checked_sub(seen.iter().filter(|n| **n > 0).count())? as f64;
    let sound = variances.iter().all(|v| *v > 0.0 && v.is_finite());
    if dof < 1.0 || !sound || values.len() != variances.len() || values.len() != groups.len() {
        return None;
    }
    let q = |omega2: f64| weighted_misfit(values, variances, groups, seen.len(), omega2);
    let cochran_q = q(0.0);
    let tail = |x: f64| {
        if within_dof.is_finite() {
            fisher_p_value(x / dof, dof, within_dof)
        } else {
            chi_squared_p_value(x, dof)
        }
    };
    let half = (1.0 - level) / 2.0;
    // Q falls with ω²; the p-value rises.
    let at_p = |wanted: f64| root(|w| tail(q(w)).unwrap_or(1.0) - wanted, values, variances);
    Some(Heterogeneity {
        cochran_q,
        dof,
        p_value: tail(cochran_q)?,
        mandel_paule: root(|w| dof - q(w), values, variances),
        dersimonian_laird: ((cochran_q - dof) / moment(variances, groups, seen.len())).max(0.0),
        interval: (at_p(half), at_p(1.0 - half)),
        i_squared: if cochran_q > 0.0 { (1.0 - dof / cochran_q).max(0.0) } else { 0.0 },
    })
}

fn weighted_misfit(y: &[f64], v: &[f64], groups: &[usize], count: usize, omega2: f64) -> f64 {
    let mut sums = vec![(0.0, 0.0); count];
    for ((y, v), g) in y.iter().zip(v).zip(groups) {
        let w = 1.0 / (v + omega2);
        sums[*g].0 += w;
        sums[*g].1 += w * y;
    }
    let part =
        |((y, v), g): ((&f64, &f64), &usize)| (y - sums[*g].1 / sums[*g].0).powi(2) / (v + omega2);
    y.iter().zip(v).zip(groups).map(part).sum()
}

/// `Σ w − Σ w²/Σ w`, over the groups.
fn moment(variances: &[f64], groups: &[usize], count: usize) -> f64 {
    let mut sums = vec![(0.0, 0.0); count];
    for (v, g) in variances.iter().zip(groups) {
        sums[*g].0 += 1.0 / v;
        sums[*g].1 += 1.0 / (v * v);
    }
    sums.iter().filter(|(w, _)| *w > 0.0).map(|(w, w2)| w - w2 / w).sum()
}

/// Where a rising function of `ω² ≥ 0` crosses zero: zero when it starts above, infinite when it never does.
fn root(f: impl Fn(f64) -> f64, values: &[f64], variances: &[f64]) -> f64 {
    if f(0.0) >= 0.0 {
        return 0.0;
    }
    let spread = crate::stats::sample_std(values).map_or(0.0, |s| s * s);
    let mut high = variances.iter().copied().fold(spread, f64::max);
    let mut doublings = 0;
    while f(high) < 0.0 {
        high *= 4.0;
        doublings += 1;
        if doublings > 200 {
            return f64::INFINITY;
        }
    }
    let mut low = 0.0;
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            break;
        }
        if f(middle) < 0.0 { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}
