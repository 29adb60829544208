//! Interval of a coefficient: the sizes at which what was found is no surprise.

use super::covariance::AllanCovariance;
use super::likelihood::{Scoring, simplest};
use super::resampling::{DRAWS, Draws};
use super::subset::{COUNT, Problem};
use super::{Coefficients, Variance};
use crate::linalg::Matrix;
use crate::stats::normal_quantile;

/// What another coefficient must add to twice the logarithm of the likelihood to stand in the model that is drawn from.
/// With less, what is not there widens the intervals of the others; with more, what is there but weak is missed. By
/// simulation: with 2 (Akaike's) flicker and ramp beside a weak random walk are held up to a percent less.
const WORTH: f64 = 1.0;
/// Sizes that are tried, about what was found or what is just seen.
const FARTHEST: f64 = 1e6;
/// Growth of the step from what was found, and the least first one, in the logarithm of the squared coefficient.
const GROWTH: f64 = 1.5;
const NARROW: f64 = 1e-3;
/// Trials of a bound; where it is near enough for a last step (in the normal quantile of the probability); and where few
/// draws can say no more (in its distance from what was found).
const TRIALS: usize = 8;
const NEAR: f64 = 0.05;
const FINE: f64 = 0.02;
/// Draws beyond a bound where it is found roughly: 200 in all at 95 %.
const FEW: f64 = 5.0;

/// What the sizes are tried on.
pub(super) struct Trial<'a> {
    pub variances: &'a [Variance],
    pub family: &'a AllanCovariance,
    pub draws: &'a Draws,
    /// Squared coefficients that were found.
    pub found: [f64; COUNT],
    /// The coefficient in question.
    pub which: usize,
    /// Probability of each tail.
    pub tail: f64,
}

/// End of an interval.
#[derive(Clone, Copy, PartialEq, Eq)]
enum End {
    Low,
    High,
}

impl Trial<'_> {
    /// The interval of the squared coefficient; `seen`, an uncertainty of it, sets the scale where nothing was found.
    ///
    /// **Model** at a true size `c` the other coefficients take their most likely values, without those that add nothing.
    /// From this model other records' variances are drawn; each gives the others anew and, with the covariance of what it
    /// gives, the root of the growth of `χ²` between the best fit and the best with `c` held, with its sign. The interval
    /// holds the sizes at which the record's own root is neither among the smallest nor the largest.
    pub fn interval(&self, seen: f64) -> [f64; 2] {
        let found = self.found[self.which];
        let center = if found > 0.0 { found } else { seen };
        // Where no model is likely without it, none can be drawn from.
        let zero_surprises = || self.surplus(0.0, End::Low, DRAWS).is_none_or(|s| s < 0.0);
        let low = match found > 0.0 && zero_surprises() {
            true => self.bound(center, seen, End::Low),
            false => 0.0,
        };
        [low, self.bound(center, seen, End::High)]
    }

    /// Whether the interval holds a size.
    pub fn holds(&self, size: f64) -> bool {
        let found = self.found[self.which];
        match self.chances(size, DRAWS) {
            Some(p) => p.iter().all(|p| *p > self.tail),
            None => size == found,
        }
    }

    /// The size at which the surplus changes its sign, outwards from the centre: found with few draws, finished with all.
    fn bound(&self, center: f64, seen: f64, end: End) -> f64 {
        let (outwards, none) = match end {
            End::Low => (-1.0, 0.0),
            End::High => (1.0, f64::INFINITY),
        };
        // In the logarithm from the centre.
        let first = normal_quantile(1.0 - self.tail) * seen / center;
        let Some(rough) = self.rough(center, outwards * first.clamp(NARROW, 1.0), end) else {
            return none;
        };
        let (mut at, mut slope) = (rough, normal_quantile(self.tail) / rough);
        let mut last: Option<[f64; 2]> = None;
        for _ in 0..TRIALS {
            let Some(s) = self.surplus(center * at.exp(), end, DRAWS) else { return none };
            if let Some([before, then]) = last {
                let new = (s - then) / (at - before);
                // Farther out there is less surplus.
                slope = if new * outwards < 0.0 { new } else { slope };
            }
            last = Some([at, s]);
            at -= (s / slope).clamp(-0.5 * rough.abs(), 0.5 * rough.abs());
            if s.abs() < NEAR {
                break;
            }
        }
        center * at.exp()
    }

    /// About where the surplus changes its sign.
    fn rough(&self, center: f64, first: f64, end: End) -> Option<f64> {
        let few = ((FEW / self.tail).ceil() as usize).min(DRAWS);
        let surplus = |at: f64| self.surplus(center * at.exp(), end, few);
        let mut within = (0.0, -normal_quantile(self.tail));
        let mut at = first;
        let mut out = loop {
            match surplus(at) {
                Some(s) if s >= 0.0 => within = (at, s),
                Some(s) => break (at, s),
                None => return None,
            }
            at *= GROWTH;
            if at.abs() > FARTHEST.ln() {
                return None;
            }
        };
        for _ in 0..TRIALS {
            if (out.0 - within.0).abs() < FINE * out.0.abs() {
                break;
            }
            // Regula falsi, kept off the ends.
            let part: f64 = within.1 / (within.1 - out.1);
            let at = within.0 + (out.0 - within.0) * part.clamp(0.1, 0.9);
            match surplus(at)? {
                s if s.abs() < NEAR => return Some(at),
                s if s < 0.0 => out = (at, s),
                s => within = (at, s),
            }
        }
        Some(0.5 * (within.0 + out.0))
    }

    /// How far the probability of so small (at the upper end) or so large a root is above the tail, in normal quantiles.
    fn surplus(&self, size: f64, end: End, draws: usize) -> Option<f64> {
        let [small, large] = self.chances(size, draws)?;
        let p = if end == End::Low { large } else { small };
        // All draws would have an infinite quantile.
        Some(normal_quantile(p.min(1.0 - 0.5 / draws as f64)) - normal_quantile(self.tail))
    }

    /// Probabilities of a root as small, and of one as large, as the record's own at a true size.
    fn chances(&self, size: f64, draws: usize) -> Option<[f64; 2]> {
        let i = self.which;
        let mut start = self.found;
        start[i] = size;
        let problem = Problem::new(self.variances, &self.covariance(start))?;
        let start = problem.best(self.variances.len(), Some((i, size)))?.values;
        let held = core::array::from_fn(|j| j == i);
        let model = simplest(self.variances, self.family, start, held, WORTH)?;
        let scoring = Scoring::about(self.variances, self.family, model, held)?;
        let mut record = self.variances.to_vec();
        let mut root = |measured: &[f64]| {
            let own = self.covariance(scoring.step(measured));
            record.iter_mut().zip(measured).for_each(|(v, y)| v.variance = *y);
            Some(Problem::new(&record, &own)?.root(i, size))
        };
        let measured: Vec<f64> = self.variances.iter().map(|v| v.variance).collect();
        let own = root(&measured)?;
        let (mut small, mut large) = (1.0, 1.0);
        let covariance = self.covariance(model);
        let model = Coefficients::from_order(model);
        for drawn in self.draws.variances(self.variances, &model, &covariance, draws)? {
            let other = root(&drawn)?;
            small += f64::from(u8::from(other <= own));
            large += f64::from(u8::from(other >= own));
        }
        Some([small, large].map(|n| n / (draws + 1) as f64))
    }

    fn covariance(&self, model: [f64; COUNT]) -> Matrix {
        self.family.at(&Coefficients::from_order(model))
    }
}
