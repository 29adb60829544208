//! A record as it is read: pieces between gaps, what each variance makes of them, what the readings look like.

use std::collections::BTreeMap;

use super::{
    Deviation, NoiseKind, Spacing, Variance, VarianceStream, Velocity, all_factors, variances,
};

/// More pieces than these are no record with gaps but a record without a constant rate.
pub const MOST_PIECES: usize = 1000;
/// Readings up to which the total variance keeps the record in memory.
pub const MOST_IN_MEMORY: usize = 10_000_000;
/// Readings up to which every averaging factor is tried.
pub const MOST_FOR_ALL: usize = 1_000_000;

/// Which averaging times.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Times {
    /// Spaced, in bounded memory.
    Spaced(Spacing),
    /// Every multiple of the interval, overlapping Allan only.
    All,
}

/// Why a record cannot be analysed.
#[derive(Debug, Clone, PartialEq)]
pub enum NoiseError {
    /// A reading that is not finite.
    NotFinite {
        /// Its number, counted from one.
        reading: u64,
    },
    /// Readings whose squares, or the squares of whose sums, are no numbers any more.
    Magnitude {
        /// The largest reading, without its sign.
        largest: f64,
    },
    /// Too short.
    TooShort {
        /// Readings of the longest piece.
        readings: u64,
    },
    /// All readings are the same.
    Constant {
        /// The reading.
        value: f64,
    },
    /// More gaps than a record has.
    TooManyGaps {
        /// Limit of pieces.
        limit: usize,
    },
    /// Too long for what needs the whole record.
    TooLong {
        /// What needs it.
        what: &'static str,
        /// Limit of readings.
        limit: usize,
    },
    /// The total variance of a record with gaps.
    TotalWithGaps,
}

impl core::fmt::Display for NoiseError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::NotFinite { reading } => write!(f, "reading {reading} is not finite"),
            Self::Magnitude { largest } => write!(
                f,
                "readings of the size of {largest:e} cannot be computed with; give them in another unit (m/s², g, V or LSB)"
            ),
            Self::TooShort { readings } => write!(
                f,
                "{readings} readings in a row are too few; {FEWEST} are the least, and an hour at rest is a good start"
            ),
            Self::Constant { value } => write!(
                f,
                "all readings are {value}: the converter hides the noise, or it is stuck; give a finer scale or more gain"
            ),
            Self::TooManyGaps { limit } => write!(
                f,
                "more than {limit} gaps: the rate is not constant, or the logger loses readings; give --rate HZ where the \
                 times are the logger's and no reading is missing"
            ),
            Self::TooLong { what, limit } => write!(
                f,
                "more than {limit} readings are too many for {what}; leave it out, or give a part of the record"
            ),
            Self::TotalWithGaps => f.write_str(
                "the total deviation needs one record without gaps; leave total out of --deviation",
            ),
        }
    }
}

impl core::error::Error for NoiseError {}

/// Fewest readings of the longest piece: three averages of three octaves.
const FEWEST: u64 = 12;

/// Sizes of the largest reading between which everything here stays finite, and not zero, also by the fourth power.
const SIZES: core::ops::RangeInclusive<f64> = 1e-50..=1e50;

/// One variance at one averaging factor, over all pieces.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Pooled {
    pub variance: Variance,
    /// Kind of noise in the longest piece that shows one.
    pub kind: Option<NoiseKind>,
}

/// Accumulates a record.
#[derive(Debug)]
pub struct NoiseRecord {
    deviations: Vec<Deviation>,
    pub(super) times: Times,
    /// The piece that is being read, one stream a deviation.
    streams: Vec<VarianceStream>,
    kept: Option<Vec<f64>>,
    /// Readings of the pieces.
    pub(super) pieces: Vec<u64>,
    /// By deviation and factor.
    pooled: Vec<BTreeMap<usize, (Pooled, u64)>>,
    total: Option<Vec<Pooled>>,
    pub(super) look: Look,
}

impl NoiseRecord {
    /// Of deviations (overlapping Allan is always among them) at averaging times.
    #[must_use]
    pub fn new(wanted: &[Deviation], times: Times) -> Self {
        let mut deviations = vec![Deviation::Allan];
        deviations.extend(wanted.iter().filter(|d| **d != Deviation::Allan));
        deviations.dedup();
        let keeps = times == Times::All || deviations.contains(&Deviation::Total);
        let mut record = Self {
            pooled: vec![BTreeMap::new(); deviations.len()],
            deviations,
            times,
            streams: Vec::new(),
            kept: keeps.then(Vec::new),
            pieces: Vec::new(),
            total: None,
            look: Look::default(),
        };
        record.begin();
        record
    }

    pub(super) fn deviations(&self) -> &[Deviation] {
        &self.deviations
    }

    fn spacing(&self) -> Spacing {
        match self.times {
            Times::Spaced(spacing) => spacing,
            Times::All => Spacing::Octave,
        }
    }

    fn begin(&mut self) {
        let spacing = self.spacing();
        self.streams =
            self.deviations.iter().map(|d| VarianceStream::spaced(*d, 1.0, spacing)).collect();
    }

    /// The next readings of a piece.
    ///
    /// **Errors** [`NoiseError::NotFinite`], [`NoiseError::TooLong`].
    pub fn push(&mut self, readings: &[f64]) -> Result<(), NoiseError> {
        self.look.push(readings)?;
        for (deviation, stream) in self.deviations.iter().zip(&mut self.streams) {
            let streamed = *deviation != Deviation::Total
                && (self.times != Times::All || *deviation == Deviation::Allan);
            if streamed {
                stream.push(readings);
            }
        }
        if let Some(kept) = &mut self.kept {
            let (what, limit) = match self.times {
                Times::All => ("every averaging time", MOST_FOR_ALL),
                Times::Spaced(_) => ("the total deviation", MOST_IN_MEMORY),
            };
            if kept.len() + readings.len() > limit {
                return Err(NoiseError::TooLong { what, limit });
            }
            kept.extend_from_slice(readings);
        }
        Ok(())
    }

    /// Readings are missing here: what follows is a piece of its own, and no difference reaches across.
    ///
    /// **Errors** [`NoiseError::TooManyGaps`], [`NoiseError::TotalWithGaps`].
    pub fn gap(&mut self) -> Result<(), NoiseError> {
        if self.deviations.contains(&Deviation::Total) {
            return Err(NoiseError::TotalWithGaps);
        }
        self.close();
        self.look.piece_ends();
        if self.pieces.len() >= MOST_PIECES {
            return Err(NoiseError::TooManyGaps { limit: MOST_PIECES });
        }
        Ok(())
    }

    /// Puts the piece that was read to the others.
    fn close(&mut self) {
        let readings = self.streams[0].readings();
        if readings == 0 {
            return;
        }
        self.pieces.push(readings);
        let streams = std::mem::take(&mut self.streams);
        for (stream, pooled) in streams.into_iter().zip(&mut self.pooled) {
            for (variance, kind) in stream.finish() {
                add(pooled, Pooled { variance, kind }, readings);
            }
        }
        let spacing = self.spacing();
        if let Some(kept) = &mut self.kept
            && let Some(velocity) = Velocity::of(kept, 1.0)
        {
            if self.times == Times::All {
                let own = std::mem::take(&mut self.pooled[0]);
                let kinds: BTreeMap<usize, _> = own.iter().map(|(m, p)| (*m, p.0.kind)).collect();
                self.pooled[0] = own;
                for variance in all_factors(&velocity) {
                    // Octaves were pooled already.
                    if !variance.factor.is_power_of_two() {
                        let kind = kinds.range(..variance.factor).next_back();
                        let kind = kind.and_then(|(_, kind)| *kind);
                        add(&mut self.pooled[0], Pooled { variance, kind }, readings);
                    }
                }
                kept.clear();
            } else {
                let factors = spacing.factors(kept.len());
                let found = variances(&velocity, Deviation::Total, &factors);
                let kind = |m: usize| super::kind_at(velocity.points(), m, Deviation::Total);
                let row = |v: Variance| Pooled { variance: v, kind: kind(v.factor) };
                self.total = Some(found.into_iter().map(row).collect());
            }
        }
        self.begin();
    }

    /// Ends the record: the variances of each deviation, factors up to a third of all readings.
    pub(super) fn end(&mut self) -> Result<Vec<Vec<Pooled>>, NoiseError> {
        self.close();
        let readings: u64 = self.pieces.iter().sum();
        let longest = self.pieces.iter().copied().max().unwrap_or(0);
        if longest < FEWEST {
            return Err(NoiseError::TooShort { readings: longest });
        }
        if self.look.least == self.look.greatest {
            return Err(NoiseError::Constant { value: self.look.least });
        }
        let largest = self.look.greatest.abs().max(self.look.least.abs());
        if !SIZES.contains(&largest) {
            return Err(NoiseError::Magnitude { largest });
        }
        let useful = |p: &Pooled| 3 * p.variance.factor as u64 <= readings;
        let deviations = self.deviations.clone();
        // The modified variance's stream holds averages of the velocity: what kind of noise it is, the velocity says.
        let kind = |factor: usize| self.pooled[0].get(&factor).and_then(|(p, _)| p.kind);
        let rows = deviations.iter().zip(&self.pooled).map(|(deviation, pooled)| {
            let rows: Vec<Pooled> = match (deviation, &self.total) {
                (Deviation::Total, Some(total)) => total.clone(),
                (Deviation::Modified, _) => pooled
                    .values()
                    .map(|(p, _)| Pooled { kind: kind(p.variance.factor), ..*p })
                    .collect(),
                _ => pooled.values().map(|(p, _)| *p).collect(),
            };
            rows.into_iter().filter(useful).collect()
        });
        Ok(rows.collect())
    }
}

/// Means over terms; the kind of the longest piece that shows one.
fn add(pooled: &mut BTreeMap<usize, (Pooled, u64)>, new: Pooled, readings: u64) {
    let Some((old, longest)) = pooled.get_mut(&new.variance.factor) else {
        pooled.insert(new.variance.factor, (new, readings));
        return;
    };
    let (a, b) = (old.variance.terms as f64, new.variance.terms as f64);
    old.variance.variance = (a * old.variance.variance + b * new.variance.variance) / (a + b);
    old.variance.terms += new.variance.terms;
    if new.kind.is_some() && (old.kind.is_none() || readings > *longest) {
        old.kind = new.kind;
        *longest = readings;
    }
}

/// What the readings look like, apart from their noise.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Look {
    pub count: u64,
    pub mean: f64,
    square: f64,
    pub least: f64,
    pub greatest: f64,
    /// Readings at the least and at the greatest value.
    pub at_least: u64,
    pub at_greatest: u64,
    /// All are whole numbers.
    pub whole: bool,
    last: Option<f64>,
    /// Neighbours that are the same, and pairs of neighbours.
    pub same: u64,
    pub neighbours: u64,
    run: u64,
    /// The longest run of one value, and the reading that begins it, counted from one.
    pub longest_run: (u64, u64),
    /// Its value.
    pub longest_value: f64,
}

impl Default for Look {
    fn default() -> Self {
        Self {
            count: 0,
            mean: 0.0,
            square: 0.0,
            least: f64::INFINITY,
            greatest: f64::NEG_INFINITY,
            at_least: 0,
            at_greatest: 0,
            whole: true,
            last: None,
            same: 0,
            neighbours: 0,
            run: 0,
            longest_run: (0, 0),
            longest_value: 0.0,
        }
    }
}

impl Look {
    fn push(&mut self, readings: &[f64]) -> Result<(), NoiseError> {
        for y in readings {
            if !y.is_finite() {
                return Err(NoiseError::NotFinite { reading: self.count + 1 });
            }
            self.count += 1;
            let off = y - self.mean;
            self.mean += off / self.count as f64;
            self.square += off * (y - self.mean);
            self.extremes(*y);
            self.whole &= y.fract() == 0.0;
            match self.last.replace(*y) {
                Some(last) if last == *y => {
                    self.same += 1;
                    self.neighbours += 1;
                    self.run += 1;
                }
                Some(_) => {
                    self.neighbours += 1;
                    self.run = 1;
                }
                None => self.run = 1,
            }
            if self.run > self.longest_run.0 {
                self.longest_run = (self.run, self.count + 1 - self.run);
                self.longest_value = *y;
            }
        }
        Ok(())
    }

    fn extremes(&mut self, y: f64) {
        if y < self.least {
            (self.least, self.at_least) = (y, 0);
        }
        if y > self.greatest {
            (self.greatest, self.at_greatest) = (y, 0);
        }
        self.at_least += u64::from(y == self.least);
        self.at_greatest += u64::from(y == self.greatest);
    }

    fn piece_ends(&mut self) {
        self.last = None;
        self.run = 0;
    }

    pub fn standard_deviation(&self) -> f64 {
        (self.square / (self.count.max(2) - 1) as f64).sqrt()
    }

    /// Whether a run of one value is longer than chance makes: below one in a million records.
    pub fn is_stuck(&self) -> bool {
        let (length, _) = self.longest_run;
        let others = self.same.saturating_sub(length) as f64;
        let pairs = self.neighbours.saturating_sub(length).max(1) as f64;
        // Of the rest of the record; it may hold no pair at all that agrees.
        let share = ((others + 1.0) / (pairs + 1.0)).min(1.0);
        length > 20 && length as f64 * share.log10() + (self.count as f64).log10() < -6.0
    }
}
