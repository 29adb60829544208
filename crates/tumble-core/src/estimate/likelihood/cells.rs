//! Log-likelihood of one dwell's codes, for the analogue level behind them.

use crate::stats::IntervalProbability;
use crate::{Code, CodeHistogram, ConverterEnds, Quantizer};

/// Cells that a dwell is condensed to at most; neighbouring codes share a cell beyond.
const MAX_CELLS: usize = 48;

/// An interval of analogue values and how many samples fell into it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Cell {
    /// Lower end, LSB; −∞ for codes at the converter's lower end.
    pub lo: f64,
    /// Upper end, LSB; +∞ for codes at the converter's upper end.
    pub hi: f64,
    /// Samples.
    pub count: f64,
}

/// A function of the level `μ` with its first two derivatives.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Jet {
    pub value: f64,
    pub slope: f64,
    /// Never positive: the normal distribution is log-concave, and so is its share of an interval.
    pub curvature: f64,
}

/// The codes of one dwell as intervals.
///
/// **Model** `x_i = μ + e_i`, `e_i ~ N(0, σ²)`, `P(cell) = Φ((hi − μ)/σ) − Φ((lo − μ)/σ)`;
/// `ℓ(μ) = Σ count · ln P(cell) / f`, with `f ≥ 1` the factor by which correlated samples know less than independent
/// ones (method section 8).
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Cells {
    pub cells: Vec<Cell>,
}

impl Cells {
    /// Codes as the intervals that they stand for; codes at the converter's ends stand for half-lines.
    pub fn of(histogram: &CodeHistogram, quantizer: Quantizer, ends: &ConverterEnds) -> Self {
        let counts: Vec<(Code, f64)> = histogram.bins().map(|(c, k)| (c, k as f64)).collect();
        Self::of_counts(&counts, quantizer, ends)
    }

    /// The same from ascending codes with counts that need not be whole.
    pub fn of_counts(counts: &[(Code, f64)], quantizer: Quantizer, ends: &ConverterEnds) -> Self {
        let span = match counts {
            [(lo, _), .., (hi, _)] => i64::from(hi.0) - i64::from(lo.0) + 1,
            _ => 1,
        };
        // Cells of a quarter of the noise lose 0.3 % of the information; 48 cells over ±4σ are a sixth of it.
        let width = ((span - 1) / MAX_CELLS as i64 + 1).max(1);
        let mut cells: Vec<Cell> = Vec::new();
        let mut group = None;
        for &(code, count) in counts {
            let (mut lo, mut hi) = quantizer.interval_lsb(code);
            let below = ends.min_code.is_some_and(|m| code <= m);
            let above = ends.max_code.is_some_and(|m| code >= m);
            if below {
                lo = f64::NEG_INFINITY;
            }
            if above {
                hi = f64::INFINITY;
            }
            // Half-lines stay alone.
            let this = (i64::from(code.0).div_euclid(width), below, above);
            match cells.last_mut() {
                Some(last) if group == Some(this) => {
                    last.hi = hi;
                    last.count += count;
                }
                _ => cells.push(Cell { lo, hi, count }),
            }
            group = Some(this);
        }
        let mut cells = Self { cells };
        if width > 1 {
            cells.close_gaps();
        }
        cells
    }

    /// Codes that did not occur inside of the record belong to a cell too, once cells hold several codes. Where the
    /// half-line of a converter's end begins is not moved.
    fn close_gaps(&mut self) {
        for i in 1..self.cells.len() {
            let (below, above) = (self.cells[i - 1], self.cells[i]);
            let middle = match (below.lo.is_infinite(), above.hi.is_infinite()) {
                (true, _) => below.hi,
                (_, true) => above.lo,
                _ => 0.5 * (below.hi + above.lo),
            };
            self.cells[i - 1].hi = middle;
            self.cells[i].lo = middle;
        }
    }

    /// `ℓ(μ)` and its derivatives.
    pub fn jet(&self, level: f64, sigma: f64, inflation: f64) -> Jet {
        let mut out = Jet::default();
        for c in &self.cells {
            let (a, b) = ((c.lo - level) / sigma, (c.hi - level) / sigma);
            let p = IntervalProbability::of(a, b);
            // P′/P and P″/P over σ and σ².
            let slope = p.lower_ratio - p.upper_ratio;
            let end = |z: f64, ratio: f64| if ratio > 0.0 { z * ratio } else { 0.0 };
            let bend = end(a, p.lower_ratio) - end(b, p.upper_ratio);
            out.value += c.count * p.ln;
            out.slope += c.count * slope;
            out.curvature += c.count * (bend - slope * slope).min(0.0);
        }
        Jet {
            value: out.value / inflation,
            slope: out.slope / (sigma * inflation),
            curvature: out.curvature / (sigma * sigma * inflation),
        }
    }

    /// Ends of what was seen.
    pub fn extent(&self) -> (f64, f64) {
        let lo = self.cells.first().map_or(0.0, |c| c.lo);
        let hi = self.cells.last().map_or(0.0, |c| c.hi);
        (lo, hi)
    }

    /// Whether every sample stood at one end of the converter: a bound, not a value.
    pub fn one_sided(&self) -> bool {
        let (lo, hi) = self.extent();
        self.cells.len() == 1 && (lo.is_infinite() || hi.is_infinite())
    }

    /// Whether a single code was seen, or a single end.
    pub fn one_code(&self) -> bool {
        self.cells.len() == 1
    }

    /// A level to start from: the middle of the cells, weighted.
    pub fn middle(&self) -> f64 {
        let (sum, count) = self.cells.iter().fold((0.0, 0.0), |(s, n), c| {
            let at = match (c.lo.is_finite(), c.hi.is_finite()) {
                (true, true) => 0.5 * (c.lo + c.hi),
                (true, false) => c.lo,
                (false, true) => c.hi,
                (false, false) => 0.0,
            };
            (s + c.count * at, n + c.count)
        });
        sum / count
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn codes(list: &[(i32, u64)]) -> CodeHistogram {
        let mut h = CodeHistogram::default();
        list.iter().for_each(|(n, k)| h.record_many(Code(*n), *k));
        h
    }

    #[test]
    fn derivatives_are_those_of_the_value() {
        let ends = ConverterEnds { min_code: None, max_code: Some(Code(5)) };
        let cells =
            Cells::of(&codes(&[(-1, 3), (0, 40), (1, 7), (5, 2)]), Quantizer::Truncate, &ends);
        for (level, sigma) in [(0.3, 0.2), (-0.9, 1.0), (4.0, 3.0), (20.0, 0.5)] {
            let h = 1e-5 * sigma;
            let (up, down, here) = (
                cells.jet(level + h, sigma, 1.5),
                cells.jet(level - h, sigma, 1.5),
                cells.jet(level, sigma, 1.5),
            );
            let slope = (up.value - down.value) / (2.0 * h);
            let curvature = (up.slope - down.slope) / (2.0 * h);
            assert!((slope / here.slope - 1.0).abs() < 1e-6, "{level} {sigma}: {slope} {here:?}");
            assert!(
                (curvature / here.curvature - 1.0).abs() < 1e-6,
                "{level}: {curvature} {here:?}"
            );
        }
    }

    #[test]
    fn many_codes_are_condensed_without_losing_a_sample() {
        let mut h = CodeHistogram::default();
        (-4000..4000).for_each(|n| h.record_many(Code(n), 1 + (n % 3 == 0) as u64));
        let cells = Cells::of(&h, Quantizer::Truncate, &ConverterEnds::default());
        assert!(cells.cells.len() <= MAX_CELLS + 2, "{}", cells.cells.len());
        assert_eq!(cells.cells.iter().map(|c| c.count).sum::<f64>(), h.samples() as f64);
        assert!(cells.cells.windows(2).all(|w| w[0].hi == w[1].lo));
    }

    #[test]
    fn codes_at_the_ends_are_half_lines() {
        let ends = ConverterEnds { min_code: Some(Code(-5)), max_code: Some(Code(5)) };
        let both = Cells::of(&codes(&[(-5, 1), (0, 1), (5, 1)]), Quantizer::Floor, &ends);
        assert_eq!(both.extent(), (f64::NEG_INFINITY, f64::INFINITY));
        // Condensed or not, saturation begins where it begins.
        let mut h = codes(&[(1000, 40)]);
        (700..950).step_by(3).for_each(|n| h.record(Code(n)));
        let ends = ConverterEnds { min_code: None, max_code: Some(Code(1000)) };
        let condensed = Cells::of(&h, Quantizer::Floor, &ends);
        assert_eq!(condensed.cells.last().map(|c| c.lo), Some(1000.0));
        let ends = ConverterEnds { min_code: Some(Code(-5)), max_code: Some(Code(5)) };
        let saturated = Cells::of(&codes(&[(5, 100)]), Quantizer::Floor, &ends);
        assert!(saturated.one_sided());
        let jet = saturated.jet(4.0, 0.5, 1.0);
        assert!(jet.slope > 0.0 && jet.curvature < 0.0);
    }
}
