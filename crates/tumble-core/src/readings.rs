//! The readings of one dwell, however they were recorded.

use crate::{BlockSums, Code, CodeHistogram, ConverterEnds, Quantizer};

/// Sample standard deviation (n − 1) from exact integer sums.
///
/// `n Σx² − (Σx)²` is formed in integers where it fits, so nothing cancels.
pub(crate) fn std_from_sums(sum: i128, squares: i128, n: u64) -> Option<f64> {
    if n < 2 {
        return None;
    }
    let count = i128::from(n);
    let scatter = match (count.checked_mul(squares), sum.checked_mul(sum)) {
        (Some(a), Some(b)) => (a - b) as f64 / count as f64,
        _ => squares as f64 - (sum as f64) * (sum as f64) / n as f64,
    };
    Some((scatter.max(0.0) / (n - 1) as f64).sqrt())
}

/// Readings that are real numbers, added up exactly.
///
/// Each reading is held as an integer number of [`ValueMoments::RESOLUTION`]; the sums are integers, so they
/// merge in any order.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct ValueMoments {
    sum: i128,
    /// Sum of squares, low word; a hundred of the very largest readings fill it.
    squares: u128,
    /// Its high word.
    squares_high: u64,
    samples: u64,
}

/// A reading that does not fit: not finite, or too large.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ValueOutOfRange {
    /// The reading.
    pub value: f64,
    /// Largest magnitude that is accepted.
    pub limit: f64,
}

impl ValueMoments {
    /// Resolution of the sums, in the reading's own unit. Twelve decimals: a thousand times finer than a
    /// 24-bit converter resolves.
    pub const RESOLUTION: f64 = 1e-12;
    /// Largest magnitude of a reading, in its own unit.
    pub const LIMIT: f64 = 1e6;

    /// A reading as a whole number of resolutions.
    pub fn steps(value: f64) -> Result<i128, ValueOutOfRange> {
        if value.is_finite() && value.abs() <= Self::LIMIT {
            Ok((value / Self::RESOLUTION).round() as i128)
        } else {
            Err(ValueOutOfRange { value, limit: Self::LIMIT })
        }
    }

    /// Adds one reading, given in [`Self::steps`].
    pub fn record(&mut self, steps: i128) {
        self.sum += steps;
        self.add_squares((steps * steps).unsigned_abs(), 0);
        self.samples += 1;
    }

    /// Adds another dwell's sums.
    pub fn merge(&mut self, other: &Self) {
        self.sum += other.sum;
        self.add_squares(other.squares, other.squares_high);
        self.samples += other.samples;
    }

    #[inline]
    fn add_squares(&mut self, low: u128, high: u64) {
        let (sum, carry) = self.squares.overflowing_add(low);
        self.squares = sum;
        self.squares_high += high + u64::from(carry);
    }

    /// Number of readings.
    #[must_use]
    pub fn samples(&self) -> u64 {
        self.samples
    }

    /// Mean, in the reading's unit.
    #[must_use]
    pub fn mean(&self) -> Option<f64> {
        (self.samples > 0).then(|| self.sum as f64 / self.samples as f64 * Self::RESOLUTION)
    }

    /// Sample standard deviation (n − 1).
    #[must_use]
    pub fn std(&self) -> Option<f64> {
        if self.samples < 2 {
            return None;
        }
        const WORD: f64 = (1u128 << 127) as f64 * 2.0;
        let (sum, n) = (self.sum as f64, self.samples as f64);
        let rough = self.squares_high as f64 * WORD + self.squares as f64 - sum * sum / n;
        // Scatter that fills the word itself does not cancel.
        if rough > WORD / 8.0 {
            return Some((rough / (n - 1.0)).sqrt() * Self::RESOLUTION);
        }
        // Σ(x − m)² = Σx² − m (Σx + r) with Σx = n m + r: below one word, so the low words say it all.
        let count = i128::from(self.samples);
        let (m, r) = (self.sum.div_euclid(count), self.sum.rem_euclid(count));
        let product = m.wrapping_mul(self.sum.wrapping_add(r));
        let about_m = (self.squares as i128).wrapping_sub(product);
        std_from_sums(r, about_m, self.samples).map(|s| s * Self::RESOLUTION)
    }
}

/// The readings of one dwell.
#[derive(Debug, Clone, PartialEq)]
pub enum Readings {
    /// Raw codes.
    Codes {
        /// How often each code came.
        histogram: CodeHistogram,
        /// Block sums of the codes in time order.
        blocks: BlockSums,
    },
    /// Raw readings that are not quantized (V, g, m/s²).
    Values {
        /// Exact sums.
        moments: ValueMoments,
        /// Block sums in time order, in [`ValueMoments::RESOLUTION`].
        blocks: BlockSums,
    },
    /// Averages that somebody else made.
    Averaged {
        /// Mean code `N̂` (or mean reading).
        mean: f64,
        /// Samples that went into it.
        samples: u64,
        /// Standard deviation of single samples, when known.
        std: Option<f64>,
    },
}

impl Readings {
    /// Number of samples.
    #[must_use]
    pub fn samples(&self) -> u64 {
        match self {
            Self::Codes { histogram, .. } => histogram.samples(),
            Self::Values { moments, .. } => moments.samples(),
            Self::Averaged { samples, .. } => *samples,
        }
    }

    /// Mean reading `N̂`, LSB (or the reading's unit). `None` without samples.
    #[must_use]
    pub fn mean(&self) -> Option<f64> {
        match self {
            Self::Codes { histogram, .. } => histogram.mean(),
            Self::Values { moments, .. } => moments.mean(),
            Self::Averaged { mean, .. } => Some(*mean),
        }
    }

    /// Sample standard deviation (n − 1) of single readings.
    #[must_use]
    pub fn std(&self) -> Option<f64> {
        match self {
            Self::Codes { histogram, .. } => histogram.std(),
            Self::Values { moments, .. } => moments.std(),
            Self::Averaged { std, .. } => *std,
        }
    }

    /// The code, when the whole dwell shows one code only.
    #[must_use]
    pub fn only_code(&self) -> Option<Code> {
        match self {
            Self::Codes { histogram, .. } => {
                histogram.extent().filter(|(lo, hi)| lo == hi).map(|(lo, _)| lo)
            }
            Self::Averaged { mean, std: Some(0.0), .. } if mean.fract() == 0.0 => {
                Some(Code(*mean as i32))
            }
            _ => None,
        }
    }

    /// Samples at or beyond the converter's ends. An average counts as a whole when its mean stands there.
    #[must_use]
    pub fn censored(&self, ends: &ConverterEnds) -> u64 {
        match self {
            Self::Codes { histogram, .. } => {
                histogram.bins().filter(|(c, _)| ends.censors(*c)).map(|(_, k)| k).sum()
            }
            Self::Averaged { mean, samples, .. } => {
                let at =
                    |end: Option<Code>| end.is_some_and(|c| (mean - f64::from(c.0)).abs() < 1.0);
                if at(ends.min_code) || at(ends.max_code) { *samples } else { 0 }
            }
            Self::Values { .. } => 0,
        }
    }

    /// Variance of the mean, LSB²: the larger of `s²/n` and what the blocks show, plus what quantization leaves
    /// where the noise does not dither it away.
    ///
    /// **Model** the mean of a quantized Gaussian is off by a periodic function of the analogue value; over all
    /// phases its variance is `Σ_k exp(−4π²k²σ²) / (2π²k²)` LSB²: 1/12 without noise, 2e-6 at σ = 0.5 LSB.
    ///
    /// `code_variance_lsb2` is the variance of single codes within dwells, pooled over the run: one quiet dwell shows
    /// anything between 0 and 1/4, whatever its noise.
    #[must_use]
    pub fn variance_of_mean(&self, quantizer: Quantizer, code_variance_lsb2: f64) -> f64 {
        let variance = self.std().map_or(0.0, |s| s * s);
        let white = variance / self.samples().max(1) as f64;
        let blocks = match self {
            Self::Codes { blocks, .. } => blocks.variance_of_mean(),
            Self::Values { blocks, .. } => blocks
                .variance_of_mean()
                .map(|v| v * ValueMoments::RESOLUTION * ValueMoments::RESOLUTION),
            Self::Averaged { .. } => None,
        };
        let resolution = match quantizer {
            Quantizer::None => 0.0,
            // Codes' variance holds 1/12 of quantization itself (Sheppard).
            _ => undithered_variance((code_variance_lsb2 - 1.0 / 12.0).max(0.0)),
        };
        white.max(blocks.unwrap_or(0.0)) + resolution
    }
}

/// Variance over all phases of the error that quantization leaves in a mean, LSB², for noise of variance `σ²`.
fn undithered_variance(noise_variance_lsb2: f64) -> f64 {
    use core::f64::consts::PI;
    if noise_variance_lsb2 < 1e-6 {
        return 1.0 / 12.0;
    }
    (1..2000)
        .map(|k| f64::from(k * k))
        .map(|k2| (-4.0 * PI * PI * k2 * noise_variance_lsb2).exp() / (2.0 * PI * PI * k2))
        .take_while(|term| *term > 1e-18)
        .sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantization_is_left_only_where_noise_does_not_dither() {
        assert!((undithered_variance(0.0) - 1.0 / 12.0).abs() < 1e-15);
        assert!((undithered_variance(1e-5) - 1.0 / 12.0).abs() < 0.003);
        assert!((undithered_variance(0.25) - 2.6e-6).abs() < 0.1e-6);
        assert!(undithered_variance(1.0) < 1e-17);
    }

    #[test]
    fn real_readings_add_up_exactly_in_any_order() {
        let values = [0.1, 0.2, -0.3, 1e-9, 123.456];
        let mut forward = ValueMoments::default();
        let mut backward = ValueMoments::default();
        values.iter().for_each(|v| forward.record(ValueMoments::steps(*v).unwrap()));
        values.iter().rev().for_each(|v| backward.record(ValueMoments::steps(*v).unwrap()));
        assert_eq!(forward, backward);
        assert!((forward.mean().unwrap() - 24.691_200_000_2).abs() < 1e-12);
        assert!(ValueMoments::steps(f64::NAN).is_err());
        assert!(ValueMoments::steps(1e7).is_err());
    }

    #[test]
    fn large_readings_keep_their_scatter() {
        // The sum of their squares fills more than 128 bits.
        let mut halves = [ValueMoments::default(), ValueMoments::default()];
        for i in 0..100_000 {
            let value = -999_000.0 + if i % 2 == 0 { 0.25 } else { -0.25 };
            halves[i / 50_000].record(ValueMoments::steps(value).unwrap());
        }
        let [mut whole, other] = halves;
        whole.merge(&other);
        let expected = 0.25 * (100_000.0_f64 / 99_999.0).sqrt();
        assert!((whole.std().unwrap() / expected - 1.0).abs() < 1e-9, "{:?}", whole.std());
        let mut wild = ValueMoments::default();
        for i in 0..100_000 {
            wild.record(ValueMoments::steps(if i % 2 == 0 { 1e6 } else { -1e6 }).unwrap());
        }
        assert!((wild.std().unwrap() / 1e6 - 1.0).abs() < 1e-5, "{:?}", wild.std());
    }

    #[test]
    fn one_code_dwells_are_told_apart() {
        let mut histogram = CodeHistogram::default();
        histogram.record_many(Code(4), 10);
        let quiet = Readings::Codes { histogram, blocks: BlockSums::default() };
        assert_eq!(quiet.only_code(), Some(Code(4)));
        let noisy = Readings::Averaged { mean: 4.0, samples: 10, std: Some(1.0) };
        assert_eq!(noisy.only_code(), None);
    }
}
