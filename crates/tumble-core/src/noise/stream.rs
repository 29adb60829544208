//! Variances of a record that does not fit into memory.

use super::differences::{second_differences, third_differences, windowed_second_differences};
use super::velocity::origin;
use super::{Deviation, KindSums, NoiseKind, Variance};

/// Averaging factor up to which every place is used. Beyond, places are `m/FULL_OVERLAP` readings apart: what that costs
/// in degrees of freedom is below 10⁻⁴ of them.
pub const FULL_OVERLAP: usize = 1 << 14;
/// How averaging factors follow one another.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Spacing {
    /// 1, 2, 4, 8, …
    Octave,
    /// 1, 2, 4, 10, 20, 40, …
    Decade,
}

impl Spacing {
    /// Factors up to a third of a record.
    #[must_use]
    pub fn factors(self, readings: usize) -> Vec<usize> {
        match self {
            Self::Octave => super::octaves(readings),
            Self::Decade => {
                decades().take_while(|m| m.checked_mul(3).is_some_and(|m| m <= readings)).collect()
            }
        }
    }

    /// Factors that are worked on where points are `2^level` readings apart, in points.
    fn of_level(self, level: u32) -> Vec<usize> {
        match (self, level) {
            (Self::Octave, 0) => (0..=FULL_OVERLAP.ilog2()).map(|k| 1 << k).collect(),
            (Self::Octave, _) => vec![FULL_OVERLAP],
            (Self::Decade, _) => {
                decades().filter(|m| level_of(*m) == level).map(|m| m >> level).collect()
            }
        }
    }
}

/// 1, 2 and 4 a decade.
fn decades() -> impl Iterator<Item = usize> {
    (0..MOST_DECADES).flat_map(|d| [1, 2, 4].map(|f| f * 10usize.pow(d)))
}

/// 4·10⁸ is the last: beyond a third of 10⁹ readings.
const MOST_DECADES: u32 = 9;

/// The first level at which a factor is not above [`FULL_OVERLAP`], or the last whose points it is a multiple of.
fn level_of(factor: usize) -> u32 {
    let needed = factor.div_ceil(FULL_OVERLAP).next_power_of_two().ilog2();
    needed.min(factor.trailing_zeros())
}

/// Points that are worked on at once.
const CHUNK: usize = 1 << 16;
/// The same in the thinned levels.
const SMALL_CHUNK: usize = 1 << 12;

/// Overlapping Allan, modified and Hadamard variances at octaves (or 1, 2, 4 a decade), in memory that does not grow with
/// the record: about 1.5 MB, and 0.8 MB for each octave beyond [`FULL_OVERLAP`] (up to 10 MB for decades).
///
/// Readings come in pieces of any size; the answer does not depend on where they were cut. Codes are summed as whole
/// numbers, exactly.
///
/// ```
/// use tumble_core::noise::{Deviation, VarianceStream};
/// let mut stream = VarianceStream::new(Deviation::Allan, 1.0);
/// stream.push(&[892.0, 809.0, 823.0, 798.0, 671.0]);
/// stream.push(&[644.0, 883.0, 903.0, 677.0]);
/// let v = stream.finish();
/// assert!((v[1].0.variance.sqrt() - 85.95287).abs() < 1e-5); // NIST SP 1065, table 31
/// ```
#[derive(Debug, Clone)]
pub struct VarianceStream {
    deviation: Deviation,
    spacing: Spacing,
    interval_s: f64,
    /// Taken from every reading.
    reference: Option<f64>,
    sum: f64,
    readings: u64,
    levels: Vec<Level>,
}

impl VarianceStream {
    /// For a deviation at an interval of the readings; [`Deviation::Total`] and [`Deviation::AllanPlain`] need the whole
    /// record and give nothing here.
    #[must_use]
    pub fn new(deviation: Deviation, interval_s: f64) -> Self {
        Self::spaced(deviation, interval_s, Spacing::Octave)
    }

    /// The same with another spacing of the averaging factors.
    #[must_use]
    pub fn spaced(deviation: Deviation, interval_s: f64, spacing: Spacing) -> Self {
        Self {
            deviation,
            spacing,
            interval_s,
            reference: None,
            sum: 0.0,
            readings: 0,
            levels: vec![Level::of(spacing, 0)],
        }
    }

    /// The next readings.
    pub fn push(&mut self, readings: &[f64]) {
        let Some(reference) = self.reference.or_else(|| origin(readings)) else { return };
        if self.reference.replace(reference).is_none() {
            self.add_point(0.0);
        }
        for y in readings {
            self.sum += y - reference;
            self.add_point(self.sum);
        }
        self.readings += readings.len() as u64;
    }

    /// Number of readings so far.
    #[must_use]
    pub fn readings(&self) -> u64 {
        self.readings
    }

    fn add_point(&mut self, x: f64) {
        self.levels[0].points.push(x);
        if self.levels[0].is_full(CHUNK) {
            self.work(0);
        }
    }

    /// Works a level's new points off and hands every other one on.
    fn work(&mut self, at: usize) {
        let deviation = self.deviation;
        let handed = self.levels[at].work(deviation);
        if self.levels.len() == at + 1 {
            self.levels.push(Level::of(self.spacing, at as u32 + 1));
        }
        self.levels[at + 1].points.extend(handed);
        if self.levels[at + 1].is_full(SMALL_CHUNK) {
            self.work(at + 1);
        }
    }

    /// The variances so far, in order of the factor, with the kind of noise that neighbouring averages show.
    #[must_use]
    pub fn finish(mut self) -> Vec<(Variance, Option<NoiseKind>)> {
        let mut at = 0;
        while at < self.levels.len() {
            self.work(at);
            // A level that has seen too little for its factor ends the chain.
            if self.levels[at + 1].points.len() + (self.levels[at + 1].seen as usize) < 3 {
                break;
            }
            at += 1;
        }
        let mut out = Vec::new();
        for (k, level) in self.levels.iter().enumerate() {
            for (j, (sum, terms)) in level.sums.iter().enumerate() {
                let local = level.factors[j];
                let factor = local << k;
                let tau_s = factor as f64 * self.interval_s;
                let unit = match self.deviation {
                    Deviation::Hadamard => 6.0,
                    Deviation::Modified => 2.0 * (local as f64).powi(2),
                    _ => 2.0,
                };
                // Points are in readings: the interval comes back here.
                let scale = unit * (factor as f64).powi(2) * *terms as f64;
                if *terms > 0 {
                    let v = Variance { factor, tau_s, terms: *terms, variance: sum / scale };
                    let octave = factor.ilog2() as usize;
                    let kind = self.levels.get(octave).and_then(|l| l.kinds.kind(self.deviation));
                    out.push((v, kind));
                }
            }
        }
        out.sort_by_key(|(v, _)| v.factor);
        out
    }
}

/// Points of the velocity, every `2^k`-th of them (or their averages, for the modified variance).
#[derive(Debug, Clone)]
struct Level {
    points: Vec<f64>,
    /// How many of the points were worked off already; they stay as history.
    done: usize,
    /// Points worked off since the beginning.
    seen: u64,
    /// Points that the largest factor reaches back.
    history: usize,
    factors: Vec<usize>,
    /// Sum and number of squared differences for each factor.
    sums: Vec<(f64, usize)>,
    /// A point that waits for its partner.
    waiting: Option<f64>,
    /// What kind of noise neighbours a point apart show.
    kinds: KindSums,
}

impl Level {
    fn of(spacing: Spacing, level: u32) -> Self {
        let factors = spacing.of_level(level);
        let sums = vec![(0.0, 0); factors.len()];
        let history = 3 * factors.iter().copied().max().unwrap_or(1);
        Self {
            points: Vec::new(),
            done: 0,
            seen: 0,
            history,
            factors,
            sums,
            waiting: None,
            kinds: KindSums::default(),
        }
    }

    fn is_full(&self, chunk: usize) -> bool {
        self.points.len() >= self.done + chunk.max(self.history / 4)
    }

    /// Adds the differences that end in new points; gives every other new point, or the averages of pairs.
    fn work(&mut self, deviation: Deviation) -> Vec<f64> {
        for (m, (sum, terms)) in self.factors.iter().zip(&mut self.sums) {
            let span = match deviation {
                Deviation::Hadamard => 3 * m,
                Deviation::Modified => 3 * m - 1,
                _ => 2 * m,
            };
            let x = &self.points[self.done.saturating_sub(span)..];
            let new = x.len().saturating_sub(span);
            if new == 0 {
                continue;
            }
            *terms += new;
            *sum += match deviation {
                Deviation::Hadamard => third_differences(x, *m),
                Deviation::Modified => windowed_second_differences(x, *m),
                _ => second_differences(x, &[*m])[0],
            };
        }
        let mut handed = Vec::with_capacity((self.points.len() - self.done) / 2 + 1);
        for x in &self.points[self.done..] {
            self.kinds.push(*x);
            match (self.waiting.take(), deviation) {
                (None, Deviation::Modified) => self.waiting = Some(*x),
                (Some(before), Deviation::Modified) => handed.push(0.5 * (before + x)),
                // The first of a pair at once: it may be the last of the record.
                (None, _) => {
                    self.waiting = Some(*x);
                    handed.push(*x);
                }
                (Some(_), _) => {}
            }
        }
        self.seen += (self.points.len() - self.done) as u64;
        let keep = self.history.min(self.points.len());
        self.points.drain(..self.points.len() - keep);
        self.done = keep;
        handed
    }
}
