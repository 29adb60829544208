//! Equivalent degrees of freedom of a variance, and the band that they give.

use super::{Deviation, NoiseKind};

/// Strides a place within an averaging time beyond which more overlap adds nothing to the degrees of freedom.
const ENOUGH_OVERLAP: usize = 64;

/// Equivalent degrees of freedom of a variance of `points` velocity points at a factor `m`, differences taken every
/// `stride` points (1: full overlap).
///
/// **Model** Allan, modified and Hadamard: `edf = M s(0)²/(s(0)² + 2 Σ (1 − j/M) s(j)²)` with the covariance `s` of the
/// differences at lag `j` of the `M` that are taken, from the generalized autocovariance of the kind of noise (Greenhall
/// and Riley). The averages are taken as continuous for `α ≤ 0`: at small `m` this is what simulation gives, where the
/// sum over `m` discrete points (which Stable32 uses) is up to 30 % off. Total: `b T/τ − c`.
///
/// **Source** C. A. Greenhall, W. J. Riley, *Uncertainty of stability variances based on finite differences*, PTTI
/// 2003; NIST SP 1065, sections 5.4.1 and 5.11.
#[must_use]
pub fn degrees_of_freedom(
    deviation: Deviation,
    kind: NoiseKind,
    points: usize,
    factor: usize,
    stride: usize,
) -> Option<f64> {
    match deviation {
        Deviation::Total => total(kind, points, factor),
        Deviation::AllanPlain => {
            finite_differences(2, kind, Filter::of(deviation, kind, factor), points, factor, factor)
        }
        Deviation::Allan | Deviation::Modified => {
            finite_differences(2, kind, Filter::of(deviation, kind, factor), points, factor, stride)
        }
        Deviation::Hadamard => {
            finite_differences(3, kind, Filter::of(deviation, kind, factor), points, factor, stride)
        }
    }
}

/// The same as Stable32 has it: the sum over `m` discrete points for every kind of noise.
#[must_use]
pub fn degrees_of_freedom_discrete(
    deviation: Deviation,
    kind: NoiseKind,
    points: usize,
    factor: usize,
) -> Option<f64> {
    let order = if deviation == Deviation::Hadamard { 3 } else { 2 };
    let filter = match deviation {
        Deviation::Total => return total(kind, points, factor),
        Deviation::Modified => Filter::Discrete(1.0),
        _ => Filter::Discrete(factor as f64),
    };
    let stride = if deviation == Deviation::AllanPlain { factor } else { 1 };
    finite_differences(order, kind, filter, points, factor, stride)
}

/// How averages over an averaging time are seen by the covariance of the velocity.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Filter {
    /// The velocity itself, at continuous times.
    Continuous,
    /// Averages of the velocity over `1/F` of the averaging time (`F = 1`: over all of it, the modified variance).
    Discrete(f64),
}

impl Filter {
    fn of(deviation: Deviation, kind: NoiseKind, factor: usize) -> Self {
        match deviation {
            Deviation::Modified => Self::Discrete(1.0),
            // The velocity has no variance there without a bound of the band.
            _ if kind.power() > 0 => Self::Discrete(factor as f64),
            _ => Self::Continuous,
        }
    }
}

/// Generalized autocovariance of the velocity's integral, without its factor (Greenhall's `s_w`).
fn walk(t: f64, power: i32) -> f64 {
    let t = t.abs();
    if t == 0.0 {
        return 0.0;
    }
    match power {
        2 => -t,
        1 => t * t * t.ln(),
        0 => t.powi(3),
        -1 => -t.powi(4) * t.ln(),
        -2 => -t.powi(5),
        -3 => t.powi(6) * t.ln(),
        _ => t.powi(7),
    }
}

/// Autocovariance of the filtered velocity (`s_x`).
fn filtered(t: f64, power: i32, filter: Filter) -> f64 {
    match filter {
        // The second derivative, up to a factor that cancels.
        Filter::Continuous => walk(t, power + 2),
        Filter::Discrete(f) => {
            f * f * (2.0 * walk(t, power) - walk(t - 1.0 / f, power) - walk(t + 1.0 / f, power))
        }
    }
}

/// Autocovariance of the differences (`s_z`), lag in averaging times.
fn differenced(t: f64, order: u32, power: i32, filter: Filter) -> f64 {
    let s = |t: f64| filtered(t, power, filter);
    match order {
        2 => 6.0 * s(t) - 4.0 * (s(t - 1.0) + s(t + 1.0)) + s(t - 2.0) + s(t + 2.0),
        _ => {
            20.0 * s(t) - 15.0 * (s(t - 1.0) + s(t + 1.0)) + 6.0 * (s(t - 2.0) + s(t + 2.0))
                - s(t - 3.0)
                - s(t + 3.0)
        }
    }
}

fn finite_differences(
    order: u32,
    kind: NoiseKind,
    filter: Filter,
    points: usize,
    factor: usize,
    stride: usize,
) -> Option<f64> {
    let windows =
        if filter == Filter::Discrete(1.0) && order == 2 && factor > 1 { factor } else { 1 };
    // Modified: m more points are used up by the windows.
    let used = order as usize * factor + windows;
    let places = (points + 1).checked_sub(used).filter(|p| *p > 0)?;
    let stride = stride.max(factor / ENOUGH_OVERLAP).max(1);
    let taken = places.div_ceil(stride);
    let m = taken as f64;
    let per_lag = stride as f64 / factor as f64;
    let furthest = ((f64::from(order) + 1.0) / per_lag).ceil() as usize;
    let s0 = differenced(0.0, order, kind.power(), filter);
    let sum: f64 = (1..furthest.min(taken))
        .map(|j| {
            let s = differenced(j as f64 * per_lag, order, kind.power(), filter);
            (1.0 - j as f64 / m) * s * s
        })
        .sum();
    let edf = m * s0 * s0 / (s0 * s0 + 2.0 * sum);
    edf.is_finite().then_some(edf.max(1.0))
}

/// `b T/τ − c` for the total variance; only where the reading is white or redder.
fn total(kind: NoiseKind, points: usize, factor: usize) -> Option<f64> {
    let (b, c) = match kind {
        NoiseKind::RandomWalk => (0.93, 0.36),
        NoiseKind::Flicker => (1.17, 0.22),
        _ => (1.5, 0.0),
    };
    Some((b * (points - 1) as f64 / factor as f64 - c).max(1.0))
}

/// The band of a deviation from its variance's degrees of freedom, at a level.
///
/// **Model** `σ √(edf/χ²_{(1±p)/2})`.
#[must_use]
pub fn band(deviation: f64, edf: f64, level: f64) -> Option<[f64; 2]> {
    let high = crate::stats::chi_squared_quantile(0.5 * (1.0 + level), edf)?;
    let low = crate::stats::chi_squared_quantile(0.5 * (1.0 - level), edf)?;
    Some([deviation * (edf / high).sqrt(), deviation * (edf / low).sqrt()])
}
