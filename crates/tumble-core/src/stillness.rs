//! Where a sensor stood still: the settled stretch of a dwell, and the dwells of a continuous record.
//!
//! **Model** readings are cut into blocks of equal length. While table and sensor stand still, block means scatter by the
//! noise and by slow drift; while they move, means run away and the spread inside blocks grows.
//! **Assumes** that a move is larger than the noise of a block's mean: what settles by less is left to the judgement of
//! the dwells (T0122, T0123).

use std::ops::Range;

/// Block means farther than this many of their own standard deviations from the level do not stand still. A thousand
/// blocks of honest noise stay inside with a probability of 99.9 %.
const STILL_SIGMAS: f64 = 5.0;
/// Spread inside a block, in units of the typical one, from which the block moves.
const MOVING_SPREAD: f64 = 3.0;
/// Blocks that a dwell is cut into to look for its settled stretch.
const BLOCKS_OF_A_DWELL: usize = 48;
/// Blocks that a record is cut into to look for dwells: sixty dwells have twenty blocks and more each.
const BLOCKS_OF_A_RECORD: usize = 2400;
/// Shortest dwell of a record, in blocks.
const SHORTEST_DWELL: usize = 6;

/// Noise of single readings, and their resolution.
#[derive(Debug, Clone, Copy)]
struct Noise {
    sigma: f64,
    resolution: f64,
}

impl Noise {
    /// From successive differences: their median knows nothing of moves. Quiet converters repeat one code for most of the
    /// time; then a third of the resolution stands in.
    fn of(readings: &[f64]) -> Self {
        let mut differences: Vec<f64> = readings.windows(2).map(|w| (w[1] - w[0]).abs()).collect();
        differences.sort_by(f64::total_cmp);
        let resolution = differences.iter().copied().find(|d| *d > 0.0).unwrap_or(0.0);
        let median = differences.get(differences.len() / 2).copied().unwrap_or(0.0);
        // Median of |x₁ − x₂| of a Gaussian: 0.6745 √2 σ.
        let sigma = (median / 0.953_9).max(resolution / 3.0);
        Self { sigma, resolution }
    }

    /// How far a mean of `n` readings may stand from a level.
    fn tolerance(self, n: usize, scatter: f64) -> f64 {
        STILL_SIGMAS * scatter.max(self.sigma / (n.max(1) as f64).sqrt()) + 0.5 * self.resolution
    }
}

fn mean(values: &[f64]) -> f64 {
    crate::stats::mean(values).unwrap_or(0.0)
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(0.0)
}

fn spread(values: &[f64]) -> f64 {
    let m = mean(values);
    mean(&values.iter().map(|v| (v - m).powi(2)).collect::<Vec<_>>()).sqrt()
}

/// The stretch of a dwell in which it stands still: settling at the start and motion at the end are cut off.
///
/// Never less than half of the dwell: where more moves, everything stays, and the dwell's trend is judged as it is.
///
/// ```
/// // Eight readings while the table still moves, then rest.
/// let dwell: Vec<f64> = (0..200).map(|i| if i < 8 { 80.0 - 9.0 * f64::from(i) } else { f64::from(i % 2) }).collect();
/// let still = tumble_core::settled_stretch(&dwell);
/// assert!((8..=16).contains(&still.start) && still.end == 200);
/// ```
#[must_use]
pub fn settled_stretch(readings: &[f64]) -> Range<usize> {
    let n = readings.len();
    let length = (n / BLOCKS_OF_A_DWELL).max(1);
    if n < 16 {
        return 0..n;
    }
    let noise = Noise::of(readings);
    let means: Vec<f64> = readings.chunks_exact(length).map(mean).collect();
    let level = median(means.clone());
    let scatter = 1.4826 * median(means.iter().map(|m| (m - level).abs()).collect());
    let tolerance = noise.tolerance(length, scatter);
    let still = |i: usize| means.get(i).is_none_or(|m| (m - level).abs() <= tolerance);
    // Two blocks in a row must stand: motion may cross the level once.
    let from = (0..means.len()).find(|i| still(*i) && still(i + 1)).unwrap_or(0);
    let to =
        (0..means.len()).rev().find(|i| still(*i) && still(i.saturating_sub(1))).unwrap_or(0) + 1;
    // The last moving block may end in the first still one: one more block is cut off.
    let start = if from == 0 { 0 } else { (from + 1) * length };
    let end = if to >= means.len() { n } else { to.saturating_sub(1) * length };
    if end.saturating_sub(start) * 2 < n { 0..n } else { start..end }
}

/// The dwells of a continuous record: stretches in which the sensor stood still, in time order.
///
/// Each stretch is settled ([`settled_stretch`]). Two dwells are told apart when their levels differ by more than the
/// noise of a block, or when something moved between them.
#[must_use]
pub fn still_stretches(readings: &[f64]) -> Vec<Range<usize>> {
    let n = readings.len();
    let length = (n / BLOCKS_OF_A_RECORD).max(4);
    let blocks: Vec<&[f64]> = readings.chunks_exact(length).collect();
    if blocks.len() < SHORTEST_DWELL {
        return if n == 0 { Vec::new() } else { std::iter::once(0..n).collect() };
    }
    let noise = Noise::of(readings);
    let means: Vec<f64> = blocks.iter().map(|b| mean(b)).collect();
    let spreads: Vec<f64> = blocks.iter().map(|b| spread(b)).collect();
    let usual = median(spreads.clone()).max(noise.sigma).max(0.5 * noise.resolution);
    let moving = |i: usize| spreads[i] > MOVING_SPREAD * usual;
    let mut stretches: Vec<Range<usize>> = Vec::new();
    let mut i = 0;
    while i < blocks.len() {
        if moving(i) {
            i += 1;
            continue;
        }
        let (mut sum, mut end) = (means[i], i + 1);
        while end < blocks.len() && !moving(end) {
            let count = end - i;
            let level = sum / count as f64;
            // A young level is known no better than the block beside it.
            let widened = (1.0 + 1.0 / count as f64).sqrt();
            if (means[end] - level).abs()
                > widened * noise.tolerance(length, usual / (length as f64).sqrt())
            {
                break;
            }
            sum += means[end];
            end += 1;
        }
        if end - i >= SHORTEST_DWELL {
            stretches.push(i..end);
        }
        i = end;
    }
    let last = blocks.len();
    joined(stretches, &means, noise.tolerance(length, usual / (length as f64).sqrt()))
        .into_iter()
        .map(|s| {
            // At a move the block beside it may hold a part of the move.
            let start = if s.start == 0 { 0 } else { (s.start + 1) * length };
            let end = if s.end == last { n } else { (s.end - 1) * length };
            let inner = settled_stretch(&readings[start..end]);
            start + inner.start..start + inner.end
        })
        .collect()
}

/// Neighbours at one level with next to nothing between them are one dwell that was knocked.
fn joined(stretches: Vec<Range<usize>>, means: &[f64], tolerance: f64) -> Vec<Range<usize>> {
    let level = |s: &Range<usize>| mean(&means[s.clone()]);
    let mut out: Vec<Range<usize>> = Vec::new();
    for s in stretches {
        match out.last_mut() {
            Some(before)
                if s.start - before.end <= 2 && (level(before) - level(&s)).abs() <= tolerance =>
            {
                before.end = s.end;
            }
            _ => out.push(s),
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use rand_core::SeedableRng;
    use rand_distr::{Distribution, StandardNormal};
    use rand_pcg::Pcg64;

    use super::*;

    /// Codes of a sensor that is turned from level to level, with motion in between.
    fn record(
        levels: &[f64],
        dwell: usize,
        motion: usize,
        sigma: f64,
        seed: u64,
    ) -> (Vec<f64>, Vec<Range<usize>>) {
        let mut random = Pcg64::seed_from_u64(seed);
        let mut normal = move || -> f64 { StandardNormal.sample(&mut random) };
        let (mut readings, mut truth) = (Vec::new(), Vec::new());
        for (i, level) in levels.iter().enumerate() {
            if i > 0 {
                for k in 0..motion {
                    let part = k as f64 / motion as f64;
                    let shake = 20.0 * sigma.max(1.0) * normal();
                    readings.push((levels[i - 1] + part * (level - levels[i - 1]) + shake).floor());
                }
            }
            let start = readings.len();
            readings.extend((0..dwell).map(|_| (level + sigma * normal()).floor()));
            truth.push(start..readings.len());
        }
        (readings, truth)
    }

    #[test]
    fn dwells_of_a_record_are_found_whatever_the_noise() {
        let levels: Vec<f64> =
            (-30..30).map(|d| 1275.7 * f64::from(d).to_radians().sin() + 0.37).collect();
        for (seed, sigma) in [0.05, 0.3, 1.2, 3.0].into_iter().enumerate() {
            for (dwell, motion) in [(1500, 150), (400, 60)] {
                let (readings, truth) = record(&levels, dwell, motion, sigma, seed as u64);
                let found = still_stretches(&readings);
                assert_eq!(found.len(), truth.len(), "σ {sigma}, {dwell} samples");
                for (f, t) in found.iter().zip(&truth) {
                    assert!(f.start >= t.start && f.end <= t.end, "σ {sigma}: {f:?} beyond {t:?}");
                    assert!(f.len() * 10 >= t.len() * 7, "σ {sigma}: {f:?} of {t:?}");
                }
            }
        }
    }

    #[test]
    fn a_record_without_moves_is_one_dwell() {
        let (readings, _) = record(&[100.3], 5000, 0, 1.0, 3);
        assert_eq!(still_stretches(&readings), std::iter::once(0..5000).collect::<Vec<_>>());
        assert!(still_stretches(&[]).is_empty());
        assert_eq!(still_stretches(&[1.0; 7]).len(), 1);
    }

    #[test]
    fn honest_dwells_are_left_whole() {
        let mut cut = 0;
        for seed in 0..2000 {
            let sigma = [0.05, 0.2, 0.5, 1.2, 5.0][seed as usize % 5];
            let n = [50, 200, 1500][seed as usize % 3];
            let (readings, _) = record(&[0.1 * seed as f64], n, 0, sigma, seed);
            cut += usize::from(settled_stretch(&readings) != (0..n));
        }
        assert!(cut < 10, "{cut} of 2000 honest dwells were cut");
    }

    #[test]
    fn settling_and_motion_are_cut_off() {
        for seed in 0..200 {
            let (mut readings, _) = record(&[250.4], 1500, 0, 1.2, seed);
            for (i, r) in readings.iter_mut().take(150).enumerate() {
                *r += (60.0 * (-(i as f64) / 30.0).exp()).floor();
            }
            for r in readings.iter_mut().skip(1450) {
                *r += 40.0;
            }
            let still = settled_stretch(&readings);
            assert!((90..=330).contains(&still.start), "{still:?}");
            assert!((1380..=1450).contains(&still.end), "{still:?}");
        }
    }
}
