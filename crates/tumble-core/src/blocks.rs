//! Means of successive blocks of one dwell, in the order of time.

/// Blocks that are kept before neighbours are joined.
const MAX_BLOCKS: usize = 64;

/// Sums over successive blocks of equal length, in time order.
///
/// Noise within a dwell is not white for ever; the variance of the dwell's mean comes from these blocks, not
/// from `s²/n` alone. A block starts as one sample; whenever 64 blocks are full, neighbours are joined and the
/// length doubles. So a dwell of any length keeps 32 to 64 blocks, and the blocks depend on nothing but the
/// sequence of the samples: not on how the file was cut into chunks, not on threads.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct BlockSums {
    length: u64,
    sums: Vec<i128>,
    partial: i128,
    in_partial: u64,
}

impl Default for BlockSums {
    fn default() -> Self {
        Self { length: 1, sums: Vec::new(), partial: 0, in_partial: 0 }
    }
}

impl BlockSums {
    /// Appends the next sample.
    #[inline]
    pub fn record(&mut self, sample: i128) {
        self.partial += sample;
        self.in_partial += 1;
        if self.in_partial == self.length {
            self.sums.push(self.partial);
            (self.partial, self.in_partial) = (0, 0);
            if self.sums.len() == MAX_BLOCKS {
                self.sums = self.sums.chunks_exact(2).map(|pair| pair[0] + pair[1]).collect();
                self.length *= 2;
            }
        }
    }

    /// Samples in a full block.
    #[must_use]
    pub fn length(&self) -> u64 {
        self.length
    }

    /// Means of the full blocks, in time order. An unfinished last block is left out.
    pub fn means(&self) -> impl ExactSizeIterator<Item = f64> + '_ {
        self.sums.iter().map(|s| *s as f64 / self.length as f64)
    }

    /// Variance of the mean over all blocks, as the blocks' own scatter tells it: `s²(block means) / blocks`.
    ///
    /// `None` below eight blocks, where the estimate says nothing. It contains what white noise contributes,
    /// and of slower noise what changes within a dwell.
    #[must_use]
    pub fn variance_of_mean(&self) -> Option<f64> {
        let n = self.sums.len();
        if n < 8 {
            return None;
        }
        let mean = self.means().sum::<f64>() / n as f64;
        let ss: f64 = self.means().map(|m| (m - mean).powi(2)).sum();
        Some(ss / (n - 1) as f64 / n as f64)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blocks_double_and_lose_nothing() {
        let mut b = BlockSums::default();
        for i in 0..1500 {
            b.record(i);
        }
        assert_eq!(b.length(), 32);
        assert_eq!(b.sums.len(), 1500 / 32);
        let counted: i128 = b.sums.iter().sum::<i128>() + b.partial;
        assert_eq!(counted, (0..1500).sum::<i128>());
        assert_eq!(b.means().next(), Some(15.5));
    }

    #[test]
    fn slow_noise_makes_the_mean_worse_than_white_noise_would() {
        let (mut white, mut slow) = (BlockSums::default(), BlockSums::default());
        for i in 0..1024i128 {
            white.record(if i % 2 == 0 { 1 } else { -1 });
            slow.record(if i < 512 { 1 } else { -1 });
        }
        assert!(white.variance_of_mean().unwrap() < 1e-12);
        assert!(slow.variance_of_mean().unwrap() > 1.0 / 64.0);
        assert_eq!(BlockSums::default().variance_of_mean(), None);
    }
}
