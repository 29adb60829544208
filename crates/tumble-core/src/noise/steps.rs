//! Times of readings: the rate, what is missing, how regular they are.

/// Readings from whose times the step is found before anything is judged.
pub const FIRST_READINGS: usize = 4096;
/// A step longer or shorter than this part of the typical one, beyond it, is not regular.
const REGULAR: f64 = 0.5;
/// Part of the steps that may be too short: more are bursts, and their times are not those of the readings.
const MOST_SHORT: f64 = 1e-3;
/// Standard deviation of the regular steps over their mean up to which the rate is taken as constant.
pub const MOST_JITTER: f64 = 0.2;
/// The same up to which nothing is said.
pub const QUIET_JITTER: f64 = 0.01;

/// What a time says beside the one before it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Step {
    /// The first time, or one step after the last.
    Regular,
    /// Readings are missing in between.
    Gap {
        /// How many.
        missing: u64,
    },
    /// Less than half a step.
    Short,
    /// Not after the last.
    Back,
}

/// Why times give no rate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum StepError {
    /// No two times differ.
    NoStep,
    /// Steps too short.
    Bursts {
        /// How many of them.
        short: u64,
        /// Of how many.
        steps: u64,
    },
    /// Steps too irregular.
    Jitter {
        /// Standard deviation over mean.
        jitter: f64,
    },
}

impl core::fmt::Display for StepError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::NoStep => f.write_str("the times do not grow; give --rate HZ instead"),
            Self::Bursts { short, steps } => write!(
                f,
                "{short} of {steps} steps of time are shorter than half of the usual one: the times are those of a logger \
                 that works in bursts; give the sensor's own rate with --rate HZ (the times are then not used)"
            ),
            Self::Jitter { jitter } => write!(
                f,
                "the steps of time scatter by {:.0} % ({:.0} % are allowed): this is no constant rate; give the sensor's own \
                 rate with --rate HZ if the times are the logger's (they are then not used)",
                100.0 * jitter,
                100.0 * MOST_JITTER
            ),
        }
    }
}

impl core::error::Error for StepError {}

/// Watches the times of a record.
///
/// A step more than half longer than the typical one is a gap; its missing readings are counted by rounding. The rate is
/// that of the regular steps.
#[derive(Debug, Clone, PartialEq)]
pub struct StepWatch {
    typical_s: f64,
    last: Option<f64>,
    regular: u64,
    sum: f64,
    square: f64,
    short: u64,
    missing: u64,
    gaps: u64,
}

impl StepWatch {
    /// From the first times of a record: the typical step is the median of those that grow.
    ///
    /// **Errors** [`StepError::NoStep`].
    pub fn of(first: &[f64]) -> Result<Self, StepError> {
        let mut steps: Vec<f64> =
            first.windows(2).map(|w| w[1] - w[0]).filter(|s| *s > 0.0).collect();
        steps.sort_by(f64::total_cmp);
        let typical_s = *steps.get(steps.len() / 2).ok_or(StepError::NoStep)?;
        if !typical_s.is_finite() {
            return Err(StepError::NoStep);
        }
        Ok(Self {
            typical_s,
            last: None,
            regular: 0,
            sum: 0.0,
            square: 0.0,
            short: 0,
            missing: 0,
            gaps: 0,
        })
    }

    /// The next time, s.
    pub fn push(&mut self, time_s: f64) -> Step {
        let Some(last) = self.last.replace(time_s) else { return Step::Regular };
        let step = (time_s - last) / self.typical_s;
        if step < 0.0 {
            Step::Back
        } else if step < 1.0 - REGULAR {
            self.short += 1;
            Step::Short
        } else if step > 1.0 + REGULAR {
            let missing = (step.round() as u64).saturating_sub(1).max(1);
            self.missing += missing;
            self.gaps += 1;
            Step::Gap { missing }
        } else {
            self.regular += 1;
            self.sum += step - 1.0;
            self.square += (step - 1.0).powi(2);
            Step::Regular
        }
    }

    /// The typical step, s.
    #[must_use]
    pub fn typical_s(&self) -> f64 {
        self.typical_s
    }

    /// Mean of the regular steps, s.
    ///
    /// **Errors** [`StepError`] where they are no rate.
    pub fn interval_s(&self) -> Result<f64, StepError> {
        let steps = self.regular + self.short;
        if self.regular == 0 {
            return Err(StepError::NoStep);
        }
        if self.short as f64 > MOST_SHORT * steps as f64 {
            return Err(StepError::Bursts { short: self.short, steps });
        }
        let jitter = self.jitter();
        if jitter > MOST_JITTER {
            return Err(StepError::Jitter { jitter });
        }
        Ok(self.typical_s * (1.0 + self.sum / self.regular as f64))
    }

    /// Standard deviation of the regular steps over the typical one.
    #[must_use]
    pub fn jitter(&self) -> f64 {
        let n = self.regular.max(1) as f64;
        (self.square / n - (self.sum / n).powi(2)).max(0.0).sqrt()
    }

    /// Readings that are missing.
    #[must_use]
    pub fn missing(&self) -> u64 {
        self.missing
    }

    /// Places where they are missing.
    #[must_use]
    pub fn gaps(&self) -> u64 {
        self.gaps
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gaps_are_counted_and_the_rate_is_that_of_the_rest() {
        let times = [0.0, 0.01, 0.02, 0.0305, 0.04, 0.08, 0.09];
        let mut watch = StepWatch::of(&times).unwrap();
        let steps: Vec<Step> = times.iter().map(|t| watch.push(*t)).collect();
        assert_eq!(steps[5], Step::Gap { missing: 3 });
        assert_eq!((watch.missing(), watch.gaps()), (3, 1));
        assert!((watch.interval_s().unwrap() - 0.01).abs() < 1e-12);
        assert_eq!(watch.push(0.05), Step::Back);
    }

    #[test]
    fn bursts_and_irregular_times_are_no_rate() {
        let bursts: Vec<f64> =
            (0..400).map(|i| f64::from(i / 4) + 1e-3 * f64::from(i % 4)).collect();
        let mut watch = StepWatch::of(&bursts).unwrap();
        let gaps = bursts.iter().filter(|t| matches!(watch.push(**t), Step::Gap { .. })).count();
        assert!(gaps == 99, "a pause after each burst: {gaps}");
        let uneven: Vec<f64> =
            (0..400).map(|i| f64::from(i) + if i % 2 == 0 { 0.0 } else { 0.3 }).collect();
        let mut watch = StepWatch::of(&uneven).unwrap();
        for t in &uneven {
            watch.push(*t);
        }
        assert!(watch.interval_s().is_err(), "{watch:?}");
        assert_eq!(StepWatch::of(&[1.0, 1.0]), Err(StepError::NoStep));
    }
}
