//! Interval of a coefficient: the sizes at which what was found is no surprise.

use super::covariance::AllanCovariance;
use super::likelihood::{Scoring, simplest};
use super::resampling::{DRAWS, Draws};
use super::subset::{COUNT, Problem};
use super::{Coefficients, Variance};
use crate::linalg::Matrix;
use crate::stats::normal_quantile;

/// What another coefficient must add to twice the logarithm of the likelihood to stand in the model that is drawn from.
/// With less, what is not there widens the intervals of the others; with more, what is there but weak is missed.
const WORTH: f64 = 1.0;
/// Sizes that are tried, about what was found or what is just seen.
const FARTHEST: f64 = 1e6;
/// First step from what was found, in the logarithm of the squared coefficient, and its growth.
const STEP: f64 = 0.1;
const GROWTH: f64 = 2.0;
/// Trials of a bound, and where it is known well enough: in the logarithm, and in the normal quantile of the probability.
const TRIALS: usize = 12;
const FINE: f64 = 2e-3;
const NEAR: f64 = 0.01;

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
        let low = if found > 0.0 && self.surplus(0.0, End::Low).is_some_and(|s| s < 0.0) {
            self.bound(center, End::Low)
        } else {
            0.0
        };
        [low, self.bound(center, End::High)]
    }

    /// The size at which the surplus changes its sign, outwards from the centre.
    fn bound(&self, center: f64, end: End) -> f64 {
        let (sign, none) = match end {
            End::Low => (-1.0, 0.0),
            End::High => (1.0, f64::INFINITY),
        };
        let surplus = |at: f64| self.surplus(center * at.exp(), end);
        let (mut within, mut step) = ((0.0, None), STEP);
        // In the logarithm from the centre.
        let mut out = loop {
            let at: f64 = within.0 + sign * step;
            if at.abs() > FARTHEST.ln() {
                return none;
            }
            match surplus(at) {
                Some(s) if s < 0.0 => break (at, s),
                found => within = (at, found),
            }
            step *= GROWTH;
        };
        let mut within = (within.0, within.1.unwrap_or(-normal_quantile(self.tail)));
        // Regula falsi, with the weight of an end halved that stays twice.
        let mut stayed = 0;
        for _ in 0..TRIALS {
            let at = within.0 + (out.0 - within.0) * within.1 / (within.1 - out.1);
            if (out.0 - within.0).abs() < FINE {
                return center * at.exp();
            }
            let Some(s) = surplus(at) else { return none };
            if s.abs() < NEAR {
                return center * at.exp();
            }
            if s < 0.0 {
                out = (at, s);
                stayed = if stayed < 0 { stayed - 1 } else { -1 };
                within.1 *= if stayed < -1 { 0.5 } else { 1.0 };
            } else {
                within = (at, s);
                stayed = if stayed > 0 { stayed + 1 } else { 1 };
                out.1 *= if stayed > 1 { 0.5 } else { 1.0 };
            }
        }
        center * (0.5 * (within.0 + out.0)).exp()
    }

    /// How far the probability of so small (at the upper end) or so large a root is above the tail, in normal quantiles.
    fn surplus(&self, size: f64, end: End) -> Option<f64> {
        let [small, large] = self.chances(size)?;
        let p = if end == End::Low { large } else { small };
        // Of all draws: one would have an infinite quantile.
        let p = p.min(1.0 - 0.5 / DRAWS as f64);
        Some(normal_quantile(p) - normal_quantile(self.tail))
    }

    /// Probabilities of a root as small, and of one as large, as the record's own at a true size.
    pub fn chances(&self, size: f64) -> Option<[f64; 2]> {
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
        for drawn in self.draws.variances(self.variances, &model, &covariance)? {
            let other = root(&drawn)?;
            small += f64::from(u8::from(other <= own));
            large += f64::from(u8::from(other >= own));
        }
        Some([small, large].map(|n| n / (DRAWS + 1) as f64))
    }

    fn covariance(&self, model: [f64; COUNT]) -> Matrix {
        self.family.at(&Coefficients::from_order(model))
    }
}
