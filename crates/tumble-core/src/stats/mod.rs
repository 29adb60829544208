//! Distributions, as far as calibration needs them.
//!
//! F and χ² come from `statrs` (checked against mpmath to 1e-12). Its normal distribution is good to ten digits only,
//! so that one comes from `libm::erfc`; its Student distribution fails at many degrees of freedom, so that one is ours.

mod normal;
mod student;

pub use normal::{IntervalProbability, erfcx};

use statrs::distribution::{ContinuousCDF, FisherSnedecor};

/// `P(X ≤ z)` for a standard normal variable.
#[must_use]
pub fn normal_cdf(z: f64) -> f64 {
    0.5 * libm::erfc(-z * core::f64::consts::FRAC_1_SQRT_2)
}

/// The two-sided Student factor: `P(|T| ≤ t) = level` for `dof` degrees of freedom.
///
/// Infinite `dof` gives the normal factor. `None` outside `0 < level < 1` or `dof > 0`.
///
/// ```
/// use tumble_core::stats::student_factor;
/// assert!((student_factor(0.95, 57.0).unwrap() - 2.002_465_459).abs() < 1e-8);
/// assert!((student_factor(0.95, f64::INFINITY).unwrap() - 1.959_963_985).abs() < 1e-8);
/// assert_eq!(student_factor(0.95, 0.0), None);
/// ```
#[must_use]
pub fn student_factor(level: f64, dof: f64) -> Option<f64> {
    if !(level > 0.0 && level < 1.0 && dof > 0.0) {
        return None;
    }
    let t = student::two_sided_quantile(level, dof);
    t.is_finite().then_some(t)
}

/// Quantile of the standard normal distribution.
#[must_use]
pub fn normal_quantile(p: f64) -> f64 {
    use statrs::distribution::Normal;
    Normal::standard().inverse_cdf(p)
}

/// Two-sided p-value of a Student statistic.
#[must_use]
pub fn student_p_value(t: f64, dof: f64) -> Option<f64> {
    (t.is_finite() && dof > 0.0).then(|| student::two_sided_tail(t, dof))
}

/// Upper tail of Fisher's F: `P(F ≥ f)`.
#[must_use]
pub fn fisher_p_value(f: f64, numerator_dof: f64, denominator_dof: f64) -> Option<f64> {
    let d = FisherSnedecor::new(numerator_dof, denominator_dof).ok()?;
    f.is_finite().then(|| d.sf(f.max(0.0)))
}

/// Upper tail of χ²: `P(X ≥ x)`.
#[must_use]
pub fn chi_squared_p_value(x: f64, dof: f64) -> Option<f64> {
    use statrs::distribution::ChiSquared;
    let d = ChiSquared::new(dof).ok()?;
    x.is_finite().then(|| d.sf(x.max(0.0)))
}

/// Quantile of χ².
#[must_use]
pub fn chi_squared_quantile(p: f64, dof: f64) -> Option<f64> {
    use statrs::distribution::ChiSquared;
    let d = ChiSquared::new(dof).ok()?;
    (p > 0.0 && p < 1.0).then(|| d.inverse_cdf(p)).filter(|q| q.is_finite())
}

/// Mean of a slice; `None` when it is empty.
#[must_use]
pub fn mean(values: &[f64]) -> Option<f64> {
    (!values.is_empty()).then(|| values.iter().sum::<f64>() / values.len() as f64)
}

/// Sample standard deviation (n − 1); `None` below two values.
#[must_use]
pub fn sample_std(values: &[f64]) -> Option<f64> {
    let m = mean(values)?;
    let ss: f64 = values.iter().map(|v| (v - m) * (v - m)).sum();
    (values.len() > 1).then(|| (ss / (values.len() - 1) as f64).sqrt())
}

/// Root mean square; `None` when it is empty.
#[must_use]
pub fn root_mean_square(values: impl IntoIterator<Item = f64>) -> Option<f64> {
    let (mut n, mut ss) = (0usize, 0.0);
    for v in values {
        n += 1;
        ss += v * v;
    }
    (n > 0).then(|| (ss / n as f64).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn normal_tail_keeps_its_digits() {
        // mpmath, 30 digits.
        assert!((normal_cdf(-6.0) / 9.865_876_450_377e-10 - 1.0).abs() < 1e-12);
        assert!((normal_cdf(1.0) - 0.841_344_746_068_542_9).abs() < 1e-15);
    }

    #[test]
    fn coverage_factors_of_ea_4_02() {
        // EA-4/02, table of k for 95.45 %.
        for (dof, k) in
            [(1.0, 13.97), (2.0, 4.53), (3.0, 3.31), (5.0, 2.65), (10.0, 2.28), (50.0, 2.05)]
        {
            assert!((student_factor(0.9545, dof).unwrap() - k).abs() < 0.006, "{dof}");
        }
    }

    #[test]
    fn spread_of_a_sample() {
        assert_eq!(sample_std(&[1.0]), None);
        assert_eq!(sample_std(&[1.0, 3.0]), Some(2f64.sqrt()));
        assert_eq!(root_mean_square([3.0, 4.0]), Some(12.5f64.sqrt()));
    }
}
