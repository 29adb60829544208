//! What is known of an input quantity.

use rand_core::Rng;
use rand_distr::{ChiSquared, Distribution as _, StandardNormal};
use rand_pcg::Pcg64Mcg;

/// Distribution of an input about its estimate.
///
/// **Source** JCGM 101, table 1; JCGM 100, 4.3 and 4.4.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Distribution {
    /// Known exactly.
    Exact,
    /// Gaussian.
    Normal {
        /// Standard uncertainty.
        u: f64,
    },
    /// Student's, scaled: what a mean of few readings is known by.
    Student {
        /// Scale: `s/√n`. JCGM 100 takes it as the standard uncertainty and keeps the degrees of freedom beside it.
        u: f64,
        /// Degrees of freedom.
        dof: f64,
    },
    /// Equal probability within limits.
    Rectangular {
        /// Half of the width.
        half_width: f64,
    },
    /// Falling linearly to zero at the limits.
    Triangular {
        /// Half of the width.
        half_width: f64,
    },
    /// Arcsine: a sinusoid at an unknown phase.
    UShaped {
        /// Amplitude.
        half_width: f64,
    },
}

impl Distribution {
    /// Resolution of an indication: rectangular over one step.
    #[must_use]
    pub fn of_resolution(step: f64) -> Self {
        Self::Rectangular { half_width: 0.5 * step }
    }

    /// Standard uncertainty: `a/√3`, `a/√6`, `a/√2` of a half width.
    #[must_use]
    pub fn standard_uncertainty(self) -> f64 {
        match self {
            Self::Exact => 0.0,
            Self::Normal { u } | Self::Student { u, .. } => u,
            Self::Rectangular { half_width } => half_width / 3f64.sqrt(),
            Self::Triangular { half_width } => half_width / 6f64.sqrt(),
            Self::UShaped { half_width } => half_width / 2f64.sqrt(),
        }
    }

    /// Degrees of freedom; infinite for what is known beforehand.
    #[must_use]
    pub fn degrees_of_freedom(self) -> f64 {
        match self {
            Self::Student { dof, .. } => dof,
            _ => f64::INFINITY,
        }
    }

    /// Name in a budget.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Exact => "exact",
            Self::Normal { .. } => "normal",
            Self::Student { .. } => "student",
            Self::Rectangular { .. } => "rectangular",
            Self::Triangular { .. } => "triangular",
            Self::UShaped { .. } => "u-shaped",
        }
    }

    /// A draw of the deviation from the estimate. `normal` is a standard normal draw of its own, correlated with others
    /// where the inputs are; `widened` what Student's distribution divides it by.
    #[inline]
    pub(super) fn draw(self, rng: &mut Pcg64Mcg, normal: Option<f64>, widened: f64) -> f64 {
        match self {
            Self::Exact => 0.0,
            Self::Normal { u } => u * normal.unwrap_or_else(|| StandardNormal.sample(rng)),
            Self::Student { u, .. } => {
                u * normal.unwrap_or_else(|| StandardNormal.sample(rng)) / widened
            }
            Self::Rectangular { half_width } => half_width * (2.0 * unit(rng) - 1.0),
            Self::Triangular { half_width } => half_width * (unit(rng) - unit(rng)),
            Self::UShaped { half_width } => half_width * (core::f64::consts::TAU * unit(rng)).cos(),
        }
    }
}

/// Uniform in [0, 1).
#[inline]
fn unit(rng: &mut Pcg64Mcg) -> f64 {
    (rng.next_u64() >> 11) as f64 * (1.0 / (1u64 << 53) as f64)
}

/// `√(χ²(ν)/ν)`; one for infinite degrees of freedom.
pub(super) fn widening(rng: &mut Pcg64Mcg, dof: f64) -> f64 {
    match ChiSquared::new(dof) {
        Ok(d) if dof.is_finite() => (d.sample(rng) / dof).sqrt(),
        _ => 1.0,
    }
}
