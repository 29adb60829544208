//! Single samples far from the rest of their dwell.

use super::motion::block_means;
use super::robust::{median, spread};
use crate::{
    Code, CodeHistogram, ConverterEnds, Finding, FindingKind, Output, Position, Quantizer, Readings,
};

/// Distance from the median in robust standard deviations: of 10¹⁵ Gaussian samples one lies so far out.
pub(crate) const FAR: f64 = 8.0;
/// And so many LSB more: in a quiet dwell the middle half is one code.
pub(crate) const FAR_LSB: f64 = 2.0;
/// Least standard deviation of codes, LSB: quantization alone gives 1/√12.
const LEAST_SPREAD_LSB: f64 = 0.3;
/// Fewest samples whose middle says anything.
const FEWEST: u64 = 20;
/// Fewest samples whose middle half alone is believed.
const FEW: u64 = 100;
/// Robust standard deviations from which a block of real readings holds a wild one. More than of codes: slow noise
/// moves blocks.
pub(crate) const FAR_BLOCK: f64 = 12.0;
/// Codes that are listed.
const LISTED: usize = 4;

/// Samples of a dwell that lie far out.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Outlying {
    /// Codes with their counts, ascending.
    pub codes: Vec<(Code, u64)>,
    median: f64,
}

impl Outlying {
    pub fn count(&self) -> u64 {
        self.codes.iter().map(|(_, k)| k).sum()
    }
}

/// Quantile of a histogram: the code that holds it.
fn quantile(histogram: &CodeHistogram, share: f64) -> f64 {
    let target = share * histogram.samples() as f64;
    let mut seen = 0.0;
    for (code, count) in histogram.bins() {
        seen += count as f64;
        if seen >= target {
            return f64::from(code.0);
        }
    }
    0.0
}

/// Standard deviation of codes as their middle tells it, LSB; `None` of too few.
pub(super) fn code_spread(histogram: &CodeHistogram) -> Option<f64> {
    let between = |a: f64, b: f64| quantile(histogram, b) - quantile(histogram, a);
    let half = between(0.25, 0.75) / 1.349;
    // The middle half of few samples is a bad measure; of many it takes a quarter of wild ones.
    let middle = if histogram.samples() < FEW { half.max(between(0.1, 0.9) / 2.563) } else { half };
    (histogram.samples() >= FEWEST).then_some(middle.max(LEAST_SPREAD_LSB))
}

/// Codes beyond eight robust standard deviations and two LSB. `usual` is the spread of the run's dwells: one dwell
/// may look quieter than it is.
pub(super) fn outlying(histogram: &CodeHistogram, usual: f64) -> Option<Outlying> {
    let limit = FAR * code_spread(histogram)?.max(usual) + FAR_LSB;
    let median = quantile(histogram, 0.5);
    let codes: Vec<(Code, u64)> =
        histogram.bins().filter(|(c, _)| (f64::from(c.0) - median).abs() > limit).collect();
    (!codes.is_empty()).then_some(Outlying { codes, median })
}

/// Spread of single codes that is usual in a run, LSB.
pub(super) fn usual_spread(positions: &[&Position]) -> f64 {
    let spreads: Vec<f64> = positions
        .iter()
        .filter_map(|p| match &p.readings {
            Readings::Codes { histogram, .. } => code_spread(histogram),
            _ => None,
        })
        .collect();
    median(&spreads).unwrap_or(LEAST_SPREAD_LSB)
}

/// Dwells of a run with samples far out, in one finding; beside it which dwells, by their index.
pub(super) fn outlying_samples(
    run: &str,
    positions: &[&Position],
    output: &Output,
    skip: &[usize],
) -> (Option<Finding>, Vec<usize>) {
    let usual = usual_spread(positions);
    let hits: Vec<(usize, u64, String)> = positions
        .iter()
        .enumerate()
        .filter(|(i, _)| !skip.contains(i))
        .filter_map(|(i, p)| match &p.readings {
            Readings::Codes { histogram, .. } => outlying(histogram, usual)
                .map(|o| (i, o.count(), describe(&o, histogram.samples(), &output.ends))),
            Readings::Values { .. } => wild_blocks(&p.readings).map(|(k, text)| (i, k, text)),
            Readings::Averaged { .. } => None,
        })
        .collect();
    let dwells = hits.iter().map(|h| h.0).collect();
    let Some((first, _, text)) = hits.first() else { return (None, dwells) };
    let more = match hits.len() {
        1 => String::new(),
        n => format!("; {} in {n} dwells of {run}", hits.iter().map(|h| h.1).sum::<u64>()),
    };
    let limit = match output.quantizer {
        Quantizer::None => format!("{FAR_BLOCK} robust standard deviations of block means"),
        _ => format!("{FAR} robust standard deviations and {FAR_LSB} LSB from the median"),
    };
    let finding = Finding {
        kind: FindingKind::OutlyingSamples,
        place: positions[*first].place.clone(),
        observed: format!("{text}{more}"),
        limit,
        remedy: "look at these rows: a dropped bit, a missed read or a knock is no acceleration; take them out of the file or measure the dwell again, and mend the line or the logger".into(),
    };
    (Some(finding), dwells)
}

fn describe(o: &Outlying, samples: u64, ends: &ConverterEnds) -> String {
    let listed: Vec<String> = o
        .codes
        .iter()
        .take(LISTED)
        .map(|(c, k)| if *k > 1 { format!("{} ({k} times)", c.0) } else { c.0.to_string() })
        .collect();
    let rest = if o.codes.len() > LISTED { ", …" } else { "" };
    let what = match () {
        () if o.codes.iter().all(|(c, _)| c.0 == 0) => ": zeros",
        () if o.codes.iter().all(|(c, _)| ends.censors(*c)) => ": the converter's ends",
        () if o.codes.iter().all(|(c, _)| one_bit(f64::from(c.0) - o.median)) => ": one bit",
        () => "",
    };
    format!(
        "{} of {samples} samples at {}{rest}, median {}{what}",
        o.count(),
        listed.join(", "),
        o.median
    )
}

/// Whether a distance is a power of two, but for a little noise.
fn one_bit(distance: f64) -> bool {
    let bit = 2f64.powf(distance.abs().log2().round());
    (distance.abs() - bit).abs() <= 0.05 * bit
}

/// Blocks of real readings that hold something wild; single samples are not kept.
fn wild_blocks(readings: &Readings) -> Option<(u64, String)> {
    let (blocks, length) = block_means(readings)?;
    let (middle, spread) = (median(&blocks)?, spread(&blocks)?);
    if (blocks.len() as u64) < FEWEST || spread <= 0.0 {
        return None;
    }
    let wild: Vec<usize> =
        (0..blocks.len()).filter(|i| (blocks[*i] - middle).abs() > FAR_BLOCK * spread).collect();
    let first = *wild.first()?;
    let text = if length == 1 {
        format!(
            "{} of {} samples far out, the first is sample {}: {:.4}",
            wild.len(),
            blocks.len(),
            first + 1,
            blocks[first]
        )
    } else {
        format!(
            "{} of {} blocks of {length} samples hold readings far out, the first from sample {} on: mean {:.4}, median {middle:.4}",
            wild.len(),
            blocks.len(),
            first as u64 * length + 1,
            blocks[first]
        )
    };
    Some((wild.len() as u64, text))
}
