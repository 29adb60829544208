//! Allan, modified, Hadamard and total variance of a record.

use super::Velocity;
use super::differences::{
    mirrored_second_differences, second_differences, third_differences, windowed_second_differences,
};

/// Which variance.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Deviation {
    /// Allan's without overlap: every `m`-th difference.
    AllanPlain,
    /// Allan's, overlapping.
    Allan,
    /// Modified Allan: tells white from flicker phase noise (quantization from what follows it).
    Modified,
    /// Hadamard's, overlapping: does not see a linear drift.
    Hadamard,
    /// Total: Allan's of the record mirrored at its ends; steadier at the longest averaging times.
    Total,
}

impl Deviation {
    /// Name.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::AllanPlain => "adev",
            Self::Allan => "oadev",
            Self::Modified => "mdev",
            Self::Hadamard => "hdev",
            Self::Total => "totdev",
        }
    }

    /// Number of places at an averaging factor; zero where the record is too short.
    #[must_use]
    pub fn terms(self, points: usize, factor: usize) -> usize {
        let spare = |used: usize| points.saturating_sub(used);
        match self {
            Self::AllanPlain => points.div_ceil(factor.max(1)).saturating_sub(2),
            Self::Allan => spare(2 * factor),
            Self::Modified => (points + 1).saturating_sub(3 * factor),
            Self::Hadamard => spare(3 * factor),
            Self::Total => {
                if factor < points - 1 {
                    spare(2)
                } else {
                    0
                }
            }
        }
    }
}

/// A variance at one averaging factor.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Variance {
    /// `m`: readings averaged.
    pub factor: usize,
    /// `τ = m τ0`, s.
    pub tau_s: f64,
    /// Number of differences that went in.
    pub terms: usize,
    /// `σ²(τ)`, in the square of the readings' unit.
    pub variance: f64,
}

/// Variances at averaging factors; factors that the record is too short for, or zero, are left out.
///
/// **Model** with `x` the [`Velocity`] and `N` its points:
/// Allan `Σ (x_{i+2m} − 2x_{i+m} + x_i)² / (2 τ² (N − 2m))`; modified, the same differences summed over `m` places,
/// `Σ z² / (2 m² τ² (N − 3m + 1))`; Hadamard `Σ (x_{i+3m} − 3x_{i+2m} + 3x_{i+m} − x_i)² / (6 τ² (N − 3m))`; total,
/// Allan's over all inner points of `x` mirrored at its ends, `Σ / (2 τ² (N − 2))`.
///
/// **Source** W. J. Riley, NIST Special Publication 1065 (2008), sections 5.2 to 5.11.
#[must_use]
pub fn variances(velocity: &Velocity, deviation: Deviation, factors: &[usize]) -> Vec<Variance> {
    let x = velocity.points();
    let usable: Vec<usize> =
        factors.iter().copied().filter(|m| *m > 0 && deviation.terms(x.len(), *m) > 0).collect();
    let sums: Vec<f64> = match deviation {
        Deviation::Allan => second_differences(x, &usable),
        Deviation::AllanPlain => usable
            .iter()
            .map(|m| {
                let every: Vec<f64> = x.iter().copied().step_by(*m).collect();
                second_differences(&every, &[1])[0]
            })
            .collect(),
        Deviation::Modified => usable.iter().map(|m| windowed_second_differences(x, *m)).collect(),
        Deviation::Hadamard => usable.iter().map(|m| third_differences(x, *m)).collect(),
        Deviation::Total => usable.iter().map(|m| mirrored_second_differences(x, *m)).collect(),
    };
    let row = |(m, sum): (&usize, f64)| {
        let tau_s = *m as f64 * velocity.interval_s();
        let terms = deviation.terms(x.len(), *m);
        let unit = match deviation {
            Deviation::Hadamard => 6.0,
            Deviation::Modified => 2.0 * (*m as f64).powi(2),
            _ => 2.0,
        };
        Variance { factor: *m, tau_s, terms, variance: sum / (unit * tau_s * tau_s * terms as f64) }
    };
    usable.iter().zip(sums).map(row).collect()
}

/// Averaging factors in octaves up to a third of the record (a half for Allan's leaves a single difference).
#[must_use]
pub fn octaves(readings: usize) -> Vec<usize> {
    let mut out = Vec::new();
    let mut m = 1;
    while 3 * m <= readings.max(3) {
        out.push(m);
        m *= 2;
    }
    out
}
