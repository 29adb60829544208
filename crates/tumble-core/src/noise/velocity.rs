//! Readings summed up: what the deviations are differences of.

/// Running sum of readings at a constant interval, `x_0 = 0`, `x_{i+1} = x_i + τ0 (y_i − ȳ)`: velocity, in m/s for
/// readings in m/s². The clock literature calls it phase.
///
/// The mean is taken out first: second and higher differences do not know it, and sums keep their digits.
#[derive(Debug, Clone, PartialEq)]
pub struct Velocity {
    points: Vec<f64>,
    interval_s: f64,
}

impl Velocity {
    /// From readings at an interval `τ0`; `None` below two readings, or where something is not finite or `τ0` is not
    /// positive.
    #[must_use]
    pub fn of(readings: &[f64], interval_s: f64) -> Option<Self> {
        let usable = readings.len() > 1 && interval_s.is_finite() && interval_s > 0.0;
        let mean = crate::stats::mean(readings).filter(|m| usable && m.is_finite())?;
        let mut points = Vec::with_capacity(readings.len() + 1);
        let mut sum = 0.0;
        points.push(0.0);
        for y in readings {
            sum += y - mean;
            points.push(sum * interval_s);
        }
        sum.is_finite().then_some(Self { points, interval_s })
    }

    /// The points `x_0 … x_N`, one more than readings.
    #[must_use]
    pub fn points(&self) -> &[f64] {
        &self.points
    }

    /// Number of readings.
    #[must_use]
    pub fn readings(&self) -> usize {
        self.points.len() - 1
    }

    /// `τ0`, s.
    #[must_use]
    pub fn interval_s(&self) -> f64 {
        self.interval_s
    }
}

/// A value to count readings from, so that their running sum stays small: one of the first of them, and none that stands
/// far off (loggers begin with zeros). Of whole readings it is whole, and sums stay exact.
pub(super) fn origin(readings: &[f64]) -> Option<f64> {
    const LOOKED_AT: usize = 31;
    let mut first = readings[..readings.len().min(LOOKED_AT)].to_vec();
    first.sort_by(f64::total_cmp);
    first.get(first.len() / 2).copied()
}
