//! Dwells that moved: a drift, or two levels, in the means of a dwell's successive blocks.

use super::dwell_fit::{DwellFit, points};
use super::robust::{median, spread};
use crate::stats::student_factor;
use crate::{Finding, FindingKind, Output, Position, Quantizer, Readings, ValueMoments};

/// Fewest blocks in which a movement can be told from noise.
pub(crate) const FEWEST_BLOCKS: usize = 16;
/// Fewest blocks on either side of a jump: one wild sample makes one wild block, and is no level.
const FEWEST_ASIDE: usize = 4;
/// Student statistic from which a movement is real. White noise passes it once in 10⁵ dwells of sixteen blocks and once
/// in 10⁸ of 46; that a jump's place is free costs a factor of ten.
pub(crate) const SIGNIFICANT: f64 = 7.0;
/// What a movement must do to the dwell's mean, in scatters of the positions: less is lost in them.
pub(crate) const HARM_SCATTERS: f64 = 1.5;
/// Level at which a dwell's trend must differ from no trend, in the spread of the trends of all dwells. A bias that
/// walks gives every dwell a trend, up or down: none is singled out. Dwells that all settle alike have little spread.
const UNUSUAL_LEVEL: f64 = 1.0 - 1e-5;
/// What it must do to the mean where noise dithers, LSB.
pub(crate) const HARM_LSB: f64 = 0.25;
/// The same where a code's edge turns any movement into a whole LSB.
const HARM_QUIET_LSB: f64 = 0.6;
/// Least change from level to level there, LSB.
const CHANGE_QUIET_LSB: f64 = 1.25;
/// Noise below which codes jump by whole LSB, LSB.
const QUIET_LSB: f64 = 0.5;
/// Share of a jump's squares that a trend must leave over for the jump to be the better word.
const JUMP_BETTER: f64 = 0.8;
/// Trend within a level, Student statistic and share of the jump, from which it is none.
const LEVEL: f64 = 3.5;
const LEVEL_SHARE: f64 = 0.4;
/// A rest without movement, Student statistic.
const AT_REST: f64 = 3.5;

/// Block means of a dwell in its reading's unit, and the samples in a block.
pub(super) fn block_means(readings: &Readings) -> Option<(Vec<f64>, u64)> {
    let (blocks, unit) = match readings {
        Readings::Codes { blocks, .. } => (blocks, 1.0),
        Readings::Values { blocks, .. } => (blocks, ValueMoments::RESOLUTION),
        Readings::Averaged { .. } => return None,
    };
    Some((blocks.means().map(|m| m * unit).collect(), blocks.length()))
}

/// How a dwell moved.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Motion {
    kind: FindingKind,
    /// Change from start to end, or from level to level.
    change: f64,
    /// Blocks after which it rests, when that is in its first half.
    rests_after: Option<usize>,
}

/// What counts as a movement.
#[derive(Debug, Clone, Copy)]
struct Limits {
    /// Of the mean.
    harm: f64,
    /// From level to level, or from start to end.
    change: f64,
    /// Trend that is usual in the other dwells of the run.
    trend: f64,
}

impl Limits {
    /// Of a run, as far as its dwells tell without their fit.
    fn of(positions: &[&Position], output: &Output) -> Self {
        let deviations: Vec<f64> = positions.iter().filter_map(|p| p.readings.std()).collect();
        let noise = median(&deviations).unwrap_or(0.0);
        let (harm, change) = match output.quantizer {
            Quantizer::None => (0.0, 0.0),
            _ if noise < QUIET_LSB => (HARM_QUIET_LSB, CHANGE_QUIET_LSB),
            _ => (HARM_LSB, 0.0),
        };
        Self { harm, change, trend: 0.0 }
    }

    /// Held against the scatter of the dwells; where too few tell it, a movement must stand out of the noise of single
    /// samples.
    fn against(self, others: &[&Position], all: &[&Position], output: &Output) -> Self {
        let fit = DwellFit::of(points(others, output.quantizer));
        let deviations: Vec<f64> = all.iter().filter_map(|p| p.readings.std()).collect();
        let scatter = match fit {
            Some(f) => HARM_SCATTERS * f.scatter_lsb,
            None => 0.5 * median(&deviations).unwrap_or(0.0),
        };
        Self { harm: self.harm.max(scatter), ..self }
    }
}

/// A straight line through blocks: change over all of them, its Student statistic, squares left over.
fn trend(blocks: &[f64]) -> (f64, f64, f64) {
    let n = blocks.len() as f64;
    let (middle, mean) = (0.5 * (n - 1.0), blocks.iter().sum::<f64>() / n);
    let (mut xx, mut xy, mut yy) = (0.0, 0.0, 0.0);
    for (i, b) in blocks.iter().enumerate() {
        let (x, y) = (i as f64 - middle, b - mean);
        (xx, xy, yy) = (xx + x * x, xy + x * y, yy + y * y);
    }
    let left = (yy - xy * xy / xx).max(0.0);
    (xy / xx * (n - 1.0), student(yy, left, n), left)
}

/// The best jump: first block of the second level, change, Student statistic, squares left over.
fn jump(blocks: &[f64]) -> (usize, f64, f64, f64) {
    let n = blocks.len();
    let mean = blocks.iter().sum::<f64>() / n as f64;
    let total: f64 = blocks.iter().map(|b| (b - mean).powi(2)).sum();
    let mut below: f64 = blocks[..FEWEST_ASIDE].iter().map(|b| b - mean).sum();
    let mut best = (FEWEST_ASIDE, 0.0, 0.0, total);
    for at in FEWEST_ASIDE..=n - FEWEST_ASIDE {
        let (k, rest) = (at as f64, (n - at) as f64);
        let between = below * below * (1.0 / k + 1.0 / rest);
        let left = (total - between).max(0.0);
        if left < best.3 {
            best = (at, -below / rest - below / k, student(total, left, n as f64), left);
        }
        below += blocks[at] - mean;
    }
    best
}

/// Of one further parameter that lowers the squares from `total` to `left`.
fn student(total: f64, left: f64, n: f64) -> f64 {
    let gained = (total - left).max(0.0);
    if gained <= 1e-12 * total || total <= 0.0 {
        return 0.0;
    }
    (gained * (n - 2.0) / left.max(1e-12 * total)).sqrt()
}

fn motion(blocks: &[f64], limits: Limits) -> Option<Motion> {
    let n = blocks.len();
    let (drift, drift_t, drift_left) = trend(blocks);
    let (at, step, step_t, step_left) = jump(blocks);
    let shorter = at.min(n - at) as f64 / n as f64;
    if drift.abs() <= limits.trend {
        return None;
    }
    // Where codes jump by whole LSB, a line through one edge rises by one and a half.
    let risen = drift.abs().min(span(blocks).abs());
    let drifts = drift_t > SIGNIFICANT && 0.5 * drift.abs() > limits.harm && risen > limits.change;
    let steps = step_t > SIGNIFICANT
        && step.abs() * shorter > limits.harm
        && step.abs() > limits.change
        && two_sided(blocks, at);
    if !drifts && !steps {
        return None;
    }
    let rests_after = (1..=n / 2).find(|k| rests(&blocks[*k..], limits));
    let is_jump = steps && step_left < JUMP_BETTER * drift_left && levels(blocks, at, step);
    let (kind, change) = if is_jump {
        (FindingKind::DwellTwoLevels, step)
    } else {
        (
            FindingKind::DwellDrifts,
            if drifts && rests_after.is_none() { drift } else { span(blocks) },
        )
    };
    Some(Motion { kind, change, rests_after })
}

/// From the first blocks to the last.
fn span(blocks: &[f64]) -> f64 {
    let few = (blocks.len() / 16).max(1);
    let mean = |part: &[f64]| part.iter().sum::<f64>() / part.len() as f64;
    mean(&blocks[blocks.len() - few..]) - mean(&blocks[..few])
}

/// Whether nearly all blocks lie on their own side of the middle between both levels: a few wild blocks do not make
/// a level.
fn two_sided(blocks: &[f64], at: usize) -> bool {
    let (a, b) = (median(&blocks[..at]), median(&blocks[at..]));
    let (Some(a), Some(b)) = (a, b) else { return false };
    let middle = 0.5 * (a + b);
    let aside = |part: &[f64], level: f64| {
        part.iter().filter(|x| (**x - middle) * (level - middle) > 0.0).count() * 5
            >= part.len() * 4
    };
    aside(&blocks[..at], a) && aside(&blocks[at..], b)
}

/// Whether both sides of a jump are level: a decay is no jump, however steep.
fn levels(blocks: &[f64], at: usize, step: f64) -> bool {
    [&blocks[..at], &blocks[at..]].into_iter().all(|part| {
        let (change, t, _) = trend(part);
        t < LEVEL || change.abs() < LEVEL_SHARE * step.abs()
    })
}

fn rests(blocks: &[f64], limits: Limits) -> bool {
    if blocks.len() < 2 * FEWEST_ASIDE {
        return false;
    }
    let (change, t, _) = trend(blocks);
    let (at, step, step_t, _) = jump(blocks);
    let shorter = at.min(blocks.len() - at) as f64 / blocks.len() as f64;
    (t < AT_REST || 0.5 * change.abs() < 0.5 * limits.harm)
        && (step_t < SIGNIFICANT || step.abs() * shorter < 0.5 * limits.harm)
}

/// Dwell by its index, block means, samples in a block, and the trend that is usual in the other dwells.
struct Blocks {
    index: usize,
    means: Vec<f64>,
    length: u64,
    usual_trend: f64,
}

/// Dwells with enough blocks.
fn blocks_of(positions: &[&Position], skip: &[usize]) -> Vec<Blocks> {
    let mut all: Vec<Blocks> = positions
        .iter()
        .enumerate()
        .filter(|(i, _)| !skip.contains(i))
        .filter_map(|(index, p)| {
            let (means, length) = block_means(&p.readings)?;
            let enough = means.len() >= FEWEST_BLOCKS;
            enough.then_some(Blocks { index, means, length, usual_trend: f64::INFINITY })
        })
        .collect();
    let trends: Vec<f64> = all.iter().map(|b| trend(&b.means).0).collect();
    let Some(factor) = student_factor(UNUSUAL_LEVEL, trends.len() as f64 - 2.0) else {
        return all;
    };
    for (i, b) in all.iter_mut().enumerate() {
        let others: Vec<f64> = [&trends[..i], &trends[i + 1..]].concat();
        b.usual_trend = spread(&others).map_or(f64::INFINITY, |s| factor * s);
    }
    all
}

/// Index, movement and samples in a block of the dwells that moved.
fn moving(dwells: &[Blocks], limits: Limits) -> Vec<(usize, Motion, u64)> {
    dwells
        .iter()
        .filter_map(|b| {
            let limits = Limits { trend: b.usual_trend, ..limits };
            motion(&b.means, limits).map(|m| (b.index, m, b.length))
        })
        .collect()
}

/// Dwells of a run that moved, one finding a kind; beside it which dwells, by their index, and how.
pub(super) fn moved(
    run: &str,
    positions: &[&Position],
    output: &Output,
    skip: &[usize],
) -> (Vec<Finding>, Vec<(usize, FindingKind)>) {
    let limits = Limits::of(positions, output);
    let dwells = blocks_of(positions, skip);
    let candidates = moving(&dwells, limits);
    if candidates.is_empty() {
        return (Vec::new(), Vec::new());
    }
    // What moved must not widen the scatter that it is held against, unless most of the run moves.
    let few = 2 * candidates.len() < positions.len();
    let still = |i: usize| !(skip.contains(&i) || few && candidates.iter().any(|c| c.0 == i));
    let others: Vec<&Position> = (0..positions.len())
        .filter(|i| still(*i) && positions[*i].readings.censored(&output.ends) == 0)
        .map(|i| positions[i])
        .collect();
    let limits = limits.against(&others, positions, output);
    let motions = moving(&dwells, limits);
    let findings = [FindingKind::DwellDrifts, FindingKind::DwellTwoLevels]
        .into_iter()
        .filter_map(|kind| {
            let of_kind: Vec<_> = motions.iter().filter(|(_, m, _)| m.kind == kind).collect();
            let (first, motion, _) = of_kind.first()?;
            let what = match kind {
                FindingKind::DwellTwoLevels => "jumps",
                _ => "drifts",
            };
            Some(Finding {
                kind,
                place: positions[*first].place.clone(),
                observed: format!(
                    "the reading {what} by {:+.2} {} within the dwell ({} of {} dwells of {run})",
                    motion.change,
                    output.unit,
                    of_kind.len(),
                    positions.len()
                ),
                limit: format!(
                    "{:.2} {} in the dwell's mean, {SIGNIFICANT} standard errors",
                    limits.harm, output.unit
                ),
                remedy: remedy(kind, &of_kind, positions, output),
            })
        })
        .collect();
    (findings, motions.iter().map(|(i, m, _)| (*i, m.kind)).collect())
}

/// How much to throw away, where all of the movement is at the start and the rate is known.
fn remedy(
    kind: FindingKind,
    motions: &[&(usize, Motion, u64)],
    positions: &[&Position],
    output: &Output,
) -> String {
    let seconds: Option<Vec<f64>> = motions
        .iter()
        .map(|(i, m, length)| {
            let record = &positions[*i].record;
            let timed = record.timing.as_ref().and_then(crate::Timing::rate_hz);
            let rate = timed.or(output.rate_hz).filter(|r| *r > 0.0)?;
            let samples = m.rests_after? as u64 * length + record.left_out[0];
            Some(samples as f64 / rate)
        })
        .collect();
    let again = match kind {
        FindingKind::DwellTwoLevels => "the table or the sensor moved: measure the dwell again",
        _ => {
            "let table and sensor come to rest, and the sensor warm up, before the dwell; measure it again"
        }
    };
    match seconds.map(|s| s.into_iter().fold(0.0, f64::max)) {
        Some(start) if start > 0.0 => format!(
            "if it is the table settling at the start, set discard_s = {:.1} in its [[run]]; else {again}",
            (start * 10.0).ceil() / 10.0
        ),
        _ => again.into(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Block means with a little scatter that is no pattern.
    fn blocks(level: impl Fn(f64) -> f64) -> Vec<f64> {
        (0..46)
            .map(|i| level(f64::from(i) / 45.0) + 0.2 * f64::from(i * 7919 % 46) / 46.0)
            .collect()
    }

    fn seen(level: impl Fn(f64) -> f64) -> Option<(FindingKind, Option<usize>)> {
        motion(&blocks(level), Limits { harm: 0.25, change: 0.0, trend: 0.0 })
            .map(|m| (m.kind, m.rests_after))
    }

    #[test]
    fn drifts_jumps_and_settling_are_told_apart() {
        assert_eq!(seen(|_| 3.0), None);
        assert_eq!(seen(|x| 2.0 * x).map(|m| m.0), Some(FindingKind::DwellDrifts));
        assert_eq!(
            seen(|x| if x < 0.6 { 0.0 } else { 2.0 }).map(|m| m.0),
            Some(FindingKind::DwellTwoLevels)
        );
        let (kind, rests) = seen(|x| 9.0 * (-x / 0.06).exp()).unwrap();
        assert_eq!(kind, FindingKind::DwellDrifts);
        assert!((6..20).contains(&rests.unwrap()), "{rests:?}");
        // One wild block is no level, nor are two.
        assert_eq!(seen(|x| if x > 0.97 { 40.0 } else { 0.0 }), None);
    }
}
