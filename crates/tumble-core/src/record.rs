//! What the record of a dwell shows beside its readings: rows, times, the angle as it was typed.
//!
//! None of it enters the estimation; judgement of the data's hygiene lives on it.

use std::collections::BTreeMap;

/// Where a dwell stands in its file, and what was noticed while it was read.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Record {
    /// File, as experiment.toml names it.
    pub file: String,
    /// Line of the first row, counted from one.
    pub line: Option<u64>,
    /// Rows, also those that were left out.
    pub rows: u64,
    /// Rows left out because their reading was empty or not a number.
    pub without_reading: u64,
    /// Samples left out at the start and at the end as settling or motion.
    pub left_out: [u64; 2],
    /// How often the last code closes the dwell: 1 where the one before it differs.
    pub closing_repeats: u64,
    /// Rows at the end of the record in which every number is zero, with the line of the first of them.
    pub zero_rows: Option<(u64, u64)>,
    /// Times of the samples, where they were recorded.
    pub timing: Option<Timing>,
    /// The dial as it was read.
    pub dial: Option<Dial>,
}

/// A reading of the dial.
#[derive(Debug, Clone, PartialEq)]
pub struct Dial {
    /// As it was typed.
    pub typed: String,
    /// Its value, in the dial's own unit.
    pub value: f64,
    /// Degrees per unit of the dial: 1, or 0.9 for gon.
    pub unit_deg: f64,
    /// Change of the table angle per change of the dial: +1, or −1 where sign or orientation turn it round.
    pub direction: f64,
}

/// Times of a dwell's samples, in constant room; merges in time order.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Timing {
    /// First time, s.
    pub first_s: Option<f64>,
    /// Last time, s.
    pub last_s: Option<f64>,
    /// Samples with a time.
    pub samples: u64,
    /// Steps back in time.
    pub backwards: u64,
    /// Line of the first step back.
    pub backwards_line: Option<u64>,
    /// Steps of zero length: the same time twice.
    pub repeated: u64,
    /// Line of the first of them.
    pub repeated_line: Option<u64>,
    /// Longest step, s.
    pub longest_step_s: f64,
    /// Line after the longest step.
    pub longest_step_line: Option<u64>,
    /// Steps by length, sixteen classes an octave: class → (steps, their sum in s).
    steps: BTreeMap<u16, (u64, f64)>,
}

/// A step is a gap from this many typical steps on.
const GAP_STEPS: f64 = 1.5;
/// Steps outside of this, in typical ones, are jitter.
const JITTER: (f64, f64) = (0.8, 1.2);
/// Steps from which a gap is clear: of an even clock, and of one that jitters.
const CLEAR_GAP: (f64, f64) = (1.8, 5.0);

impl Timing {
    /// Adds the time of the next sample, s, with the line that it stands in.
    pub fn record(&mut self, time_s: f64, line: u64) {
        self.samples += 1;
        self.first_s.get_or_insert(time_s);
        if let Some(last) = self.last_s.replace(time_s) {
            let step = time_s - last;
            if step < 0.0 {
                self.backwards += 1;
                self.backwards_line.get_or_insert(line);
            } else if step == 0.0 {
                self.repeated += 1;
                self.repeated_line.get_or_insert(line);
            } else {
                let class = self.steps.entry((step.to_bits() >> 48) as u16).or_insert((0, 0.0));
                class.0 += 1;
                class.1 += step;
                if step > self.longest_step_s {
                    self.longest_step_s = step;
                    self.longest_step_line = Some(line);
                }
            }
        }
    }

    /// The typical step, s: the median of the forward steps, to a sixteenth of an octave.
    #[must_use]
    pub fn typical_step_s(&self) -> Option<f64> {
        let total: u64 = self.steps.values().map(|s| s.0).sum();
        let mut seen = 0;
        for (count, sum) in self.steps.values() {
            seen += count;
            if seen * 2 >= total {
                return Some(sum / *count as f64);
            }
        }
        None
    }

    /// Samples that are missing between those recorded: a step of three typical ones misses two.
    #[must_use]
    pub fn missing(&self) -> u64 {
        let Some(typical) = self.typical_step_s() else { return 0 };
        self.steps
            .values()
            .filter(|(count, sum)| sum / *count as f64 > GAP_STEPS * typical)
            .map(|(count, sum)| ((sum / typical).round() as u64).saturating_sub(*count))
            .fold(0, u64::saturating_add)
    }

    /// Samples that the clock shows as lost: [`Self::missing`], but for what jitter and bursts make of it.
    ///
    /// A clock that loses samples steps by whole multiples of its typical step; one that jitters has steps of any
    /// length, and only a step of five typical ones is a gap. Where a stated rate, or more missing than recorded, says
    /// that nothing is lost (samples that arrive in bursts), nothing is.
    #[must_use]
    pub fn lost(&self, stated_rate_hz: Option<f64>) -> u64 {
        let (Some(typical), Some(span)) = (self.typical_step_s(), self.span_s()) else { return 0 };
        let steps = |from: f64, to: f64| -> (u64, f64) {
            self.steps
                .values()
                .map(|(count, sum)| (*count, *sum, sum / *count as f64 / typical))
                .filter(|(_, _, ratio)| (from..to).contains(ratio))
                .fold((0, 0.0), |(n, s), (count, sum, _)| (n + count, s + sum))
        };
        let jitters = steps(0.0, JITTER.0).0 + steps(JITTER.1, CLEAR_GAP.0).0
            > steps(CLEAR_GAP.0, f64::INFINITY).0;
        let gap = if jitters { CLEAR_GAP.1 } else { CLEAR_GAP.0 };
        let (count, sum) = steps(gap, f64::INFINITY);
        let lost = ((sum / typical).round() as u64).saturating_sub(count);
        let expected = stated_rate_hz.map(|rate| ((span * rate).round() as u64).saturating_add(1));
        let room = expected.map_or(u64::MAX, |n| n.saturating_sub(self.samples));
        // A rate that is stated twice too low would hide every gap.
        let believed =
            expected.is_some_and(|n| n.saturating_mul(10) > self.samples.saturating_mul(9));
        match (lost > self.samples, believed) {
            (true, _) => 0,
            (false, true) => lost.min(room),
            (false, false) => lost,
        }
    }

    /// Samples per second over the whole dwell: forward steps divided by the time that they took.
    #[must_use]
    pub fn rate_hz(&self) -> Option<f64> {
        let (count, sum) =
            self.steps.values().fold((0, 0.0), |(n, t), (count, sum)| (n + count, t + sum));
        (sum > 0.0).then(|| count as f64 / sum)
    }

    /// Time from the first sample to the last, s.
    #[must_use]
    pub fn span_s(&self) -> Option<f64> {
        self.first_s.zip(self.last_s).map(|(a, b)| b - a)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn timing(times: &[f64]) -> Timing {
        let mut t = Timing::default();
        for (i, time) in times.iter().enumerate() {
            t.record(*time, i as u64 + 2);
        }
        t
    }

    #[test]
    fn an_even_clock_has_no_gaps() {
        let t = timing(&(0..1500).map(|i| f64::from(i) * 0.02).collect::<Vec<_>>());
        assert!((t.rate_hz().unwrap() - 50.0).abs() < 1e-9);
        assert!((t.typical_step_s().unwrap() - 0.02).abs() < 1e-9);
        assert_eq!((t.missing(), t.backwards, t.repeated), (0, 0, 0));
        assert!((t.span_s().unwrap() - 29.98).abs() < 1e-9);
    }

    #[test]
    fn gaps_repeats_and_steps_back_are_counted_with_their_lines() {
        let t = timing(&[0.0, 0.1, 0.2, 0.3, 0.6, 0.7, 0.7, 0.8, 0.75, 0.85]);
        assert_eq!(t.missing(), 2);
        assert_eq!((t.repeated, t.repeated_line), (1, Some(8)));
        assert_eq!((t.backwards, t.backwards_line), (1, Some(10)));
        assert_eq!(t.longest_step_line, Some(6));
    }

    #[test]
    fn jitter_and_bursts_lose_nothing() {
        // A jittering clock: steps of 0.4 … 1.7 typical ones.
        let mut time = 0.0;
        let jitter: Vec<f64> = (0..1500u64)
            .map(|i| {
                time += 0.02 * (0.4 + 1.3 * (i * 7919 % 101) as f64 / 101.0);
                time
            })
            .collect();
        assert_eq!(timing(&jitter).lost(None), 0);
        // Ten at a time.
        let bursts: Vec<f64> =
            (0..1500).map(|i| f64::from(i / 10) * 0.2 + f64::from(i % 10) * 0.0001).collect();
        assert_eq!(timing(&bursts).lost(None), 0);
        assert_eq!(timing(&bursts).lost(Some(50.0)), 0);
        // Seven are gone.
        let gaps: Vec<f64> =
            (0..1500).filter(|i| !(100..107).contains(i)).map(|i| f64::from(i) * 0.02).collect();
        assert_eq!(timing(&gaps).lost(None), 7);
        assert_eq!(timing(&gaps).lost(Some(50.0)), 7);
    }

    #[test]
    fn no_times_no_rate() {
        assert_eq!(timing(&[]).rate_hz(), None);
        assert_eq!(timing(&[1.0]).typical_step_s(), None);
        assert_eq!(timing(&[1.0]).missing(), 0);
    }
}
