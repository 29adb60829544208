//! Q, N, B, K and R from Allan variances.

use super::Variance;
use super::covariance::AllanCovariance;
use super::interval::Trial;
use super::resampling::Draws;
use super::subset::{COUNT, Problem, Subset};
use crate::linalg::Matrix;
use crate::stats::chi_squared_p_value;

/// Probability of a `χ²` below which a discrepancy is looked for.
const NO_CHANCE: f64 = 1e-3;
/// Discrepancies that are looked at, and halvings of their logarithm.
const LARGEST_DISCREPANCY: (f64, f64) = (1e-5, 3.0);
const HALVINGS: usize = 16;

/// Rounds of weights and fit; the weights hardly change after the third.
const ROUNDS: usize = 6;

/// Squares of the coefficients of `σ²(τ) = 3Q²/τ² + N²/τ + (2 ln2/π) B² + K² τ/3 + R² τ²/2`.
///
/// **Units** for readings in m/s²: Q m/s, N m/s/√s, B m/s², K m/s²/√s, R m/s³.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Coefficients {
    /// Quantization (white velocity).
    pub q2: f64,
    /// Velocity random walk (white reading).
    pub n2: f64,
    /// Bias instability (flicker).
    pub b2: f64,
    /// Random walk of the reading.
    pub k2: f64,
    /// Ramp.
    pub r2: f64,
}

impl Coefficients {
    /// In the order Q, N, B, K, R.
    #[must_use]
    pub fn in_order(&self) -> [f64; 5] {
        [self.q2, self.n2, self.b2, self.k2, self.r2]
    }

    pub(super) fn from_order(c: [f64; 5]) -> Self {
        Self { q2: c[0], n2: c[1], b2: c[2], k2: c[3], r2: c[4] }
    }

    /// `σ²(τ)`.
    #[must_use]
    pub fn variance(&self, tau_s: f64) -> f64 {
        self.parts(tau_s).iter().sum()
    }
}

/// What each squared coefficient adds at an averaging time.
pub(super) fn columns(tau_s: f64) -> [f64; 5] {
    let flicker = 2.0 * core::f64::consts::LN_2 / core::f64::consts::PI;
    [3.0 / (tau_s * tau_s), 1.0 / tau_s, flicker, tau_s / 3.0, 0.5 * tau_s * tau_s]
}

/// One coefficient with its uncertainty.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Coefficient {
    /// Value; zero where the fit is best without it.
    pub value: f64,
    /// Standard uncertainty; absent at zero.
    pub standard_uncertainty: Option<f64>,
    /// Interval at the level asked for. At zero, from zero to the largest value that the data allow.
    pub interval: [f64; 2],
}

/// A fit of the model.
#[derive(Debug, Clone, PartialEq)]
pub struct NoiseFit {
    /// Q, N, B, K, R.
    pub coefficients: [Coefficient; 5],
    /// Their squares, as fitted.
    pub squares: Coefficients,
    /// `χ²` of the variances about the model, with their covariance.
    pub chi_squared: f64,
    /// How far the true variances are from any such model (relative, standard), where `χ²` is no chance; else zero.
    pub discrepancy: f64,
    /// Variances less coefficients.
    pub degrees_of_freedom: usize,
}

/// Fits the model to overlapping Allan variances, no coefficient negative, weighted with the covariance of the variances.
///
/// **Model** generalized least squares; of all sets of coefficients the best with none negative (32 sets are tried).
/// The covariance is that of the fitted model itself, found in a few rounds.
///
/// **Uncertainty** the standard uncertainty is that of the fit with the coefficients that are left in it. The interval
/// holds the true sizes at which what was found is no surprise, judged by records drawn with that size and fitted anew: it
/// knows that a coefficient that was left out may be there after all, and is not symmetric. It may be far wider than the
/// standard uncertainty: a ramp is not known better than the random walk beside it, which may be hard to see. Real sensors
/// have filters, vibration and noise of other kinds, and long records show them: where `χ²` is no chance, a relative
/// discrepancy of every variance is estimated and stands in weights and intervals. A level above 0.995 is more than the
/// draws can tell: intervals then have no ends.
///
/// `None` with fewer than two variances, or where one is zero.
#[must_use]
pub fn fit(variances: &[Variance], interval_s: f64, level: f64) -> Option<NoiseFit> {
    let found = Found::of(variances, interval_s)?;
    let draws = Draws::of(variances.len());
    let best = &found.best;
    let coefficients = core::array::from_fn(|which| {
        let square = best.values[which];
        let mut set = best.set;
        set[which] = true;
        // Of a coefficient that was left out: what it would have been known to.
        let let_in = found.problem.fit(variances.len(), set, None);
        let interval = let_in.map_or([0.0, f64::INFINITY], |s| {
            found.trial(variances, &draws, which, level).interval(s.uncertainties[which])
        });
        Coefficient {
            value: square.sqrt(),
            standard_uncertainty: (square > 0.0)
                .then(|| best.uncertainties[which] / (2.0 * square.sqrt())),
            interval: interval.map(f64::sqrt),
        }
    });
    Some(NoiseFit {
        coefficients,
        squares: Coefficients::from_order(best.values),
        chi_squared: found.chi_squared,
        discrepancy: found.discrepancy,
        degrees_of_freedom: found.degrees_of_freedom,
    })
}

/// Whether the intervals of [`fit`] hold given values of some coefficients: the test that the intervals are made of, without
/// looking for their ends.
///
/// `None` where there is no fit, and of a coefficient that is not asked for.
#[must_use]
pub fn intervals_hold(
    variances: &[Variance],
    interval_s: f64,
    level: f64,
    values: [Option<f64>; COUNT],
) -> Option<[Option<bool>; COUNT]> {
    let found = Found::of(variances, interval_s)?;
    let draws = Draws::of(variances.len());
    Some(core::array::from_fn(|i| {
        values[i].map(|value| found.trial(variances, &draws, i, level).holds(value * value))
    }))
}

/// What the variances give before intervals.
struct Found {
    family: AllanCovariance,
    problem: Problem,
    best: Subset,
    chi_squared: f64,
    degrees_of_freedom: usize,
    discrepancy: f64,
}

impl Found {
    fn of(variances: &[Variance], interval_s: f64) -> Option<Self> {
        let n = variances.len();
        if n < 2 || !variances.iter().all(|v| v.variance > 0.0 && v.variance.is_finite()) {
            return None;
        }
        // To begin with: relative weights by the number of independent averages.
        let mut c = Matrix::zeros(n, n);
        for (i, v) in variances.iter().enumerate() {
            c[(i, i)] = v.variance.powi(2) * 2.0 * v.factor as f64 / v.terms as f64;
        }
        let first = Problem::new(variances, &c)?.best(n, None)?;
        let mut family = AllanCovariance::of(variances, interval_s);
        let (mut problem, mut best) = rounds(variances, &family, &first)?;
        let dof = n.saturating_sub(best.set.iter().filter(|s| **s).count());
        let chi_squared = best.chi_squared;
        let mut discrepancy = 0.0;
        if chi_squared_p_value(chi_squared, dof as f64).is_some_and(|p| p < NO_CHANCE) {
            discrepancy = found_discrepancy(variances, &family, &first);
            family = family.with_discrepancy(discrepancy);
            (problem, best) = rounds(variances, &family, &first)?;
        }
        Some(Self { family, problem, best, chi_squared, degrees_of_freedom: dof, discrepancy })
    }

    fn trial<'a>(
        &'a self,
        variances: &'a [Variance],
        draws: &'a Draws,
        which: usize,
        level: f64,
    ) -> Trial<'a> {
        let (family, found) = (&self.family, self.best.values);
        Trial { variances, family, draws, found, which, tail: 0.5 * (1.0 - level) }
    }
}

/// The fit and its covariance brought together, from a first fit on.
fn rounds(
    variances: &[Variance],
    family: &AllanCovariance,
    first: &Subset,
) -> Option<(Problem, Subset)> {
    let mut best = first.clone();
    let mut problem = None;
    for _ in 0..ROUNDS {
        let c = family.at(&Coefficients::from_order(best.values));
        let next = Problem::new(variances, &c)?;
        best = next.best(variances.len(), None)?;
        problem = Some(next);
    }
    Some((problem?, best))
}

/// **Model** Mandel and Paule: the discrepancy at which `χ²` is its number of degrees of freedom.
fn found_discrepancy(variances: &[Variance], family: &AllanCovariance, first: &Subset) -> f64 {
    let (mut low, mut high) = LARGEST_DISCREPANCY;
    for _ in 0..HALVINGS {
        let middle = f64::sqrt(low * high);
        let there = rounds(variances, &family.clone().with_discrepancy(middle), first);
        let surplus = there.is_none_or(|(_, best)| {
            let used = best.set.iter().filter(|s| **s).count();
            best.chi_squared > variances.len().saturating_sub(used) as f64
        });
        if surplus {
            low = middle;
        } else {
            high = middle;
        }
    }
    high
}
