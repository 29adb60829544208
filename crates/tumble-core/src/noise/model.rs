//! Q, N, B, K and R from Allan variances.

use super::Variance;
use super::cholesky::Cholesky;
use super::covariance::AllanCovariance;
use crate::linalg::{Matrix, Triangular};
use crate::stats::chi_squared_quantile;

/// Factors on a squared coefficient at which its uncertainty is computed, for its interval.
const AROUND: [f64; 3] = [0.25, 1.0, 4.0];

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

    fn from_order(c: [f64; 5]) -> Self {
        Self { q2: c[0], n2: c[1], b2: c[2], k2: c[3], r2: c[4] }
    }

    /// `σ²(τ)`.
    #[must_use]
    pub fn variance(&self, tau_s: f64) -> f64 {
        columns(tau_s).iter().zip(self.in_order()).map(|(f, c)| f * c).sum()
    }
}

/// What each squared coefficient adds at an averaging time.
fn columns(tau_s: f64) -> [f64; 5] {
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
    /// Variances less coefficients.
    pub degrees_of_freedom: usize,
}

/// Fits the model to overlapping Allan variances, no coefficient negative, weighted with the covariance of the variances.
///
/// **Model** generalized least squares; of all sets of coefficients the best with none negative (31 sets are tried).
/// The covariance is that of the fitted model itself, found in a few rounds.
///
/// **Uncertainty** what was found of a squared coefficient `c` is distributed as `c χ²/ν`, `ν = 2 c²/u²(c)`
/// (Satterthwaite). The interval holds the true sizes for which what was found is no surprise; `u` grows with the size.
/// It holds what the model holds: other kinds of noise are not in it.
///
/// `None` with fewer than two variances, or where all are zero.
#[must_use]
pub fn fit(variances: &[Variance], interval_s: f64, level: f64) -> Option<NoiseFit> {
    if variances.len() < 2 || !variances.iter().all(|v| v.variance > 0.0 && v.variance.is_finite())
    {
        return None;
    }
    // To begin with: relative weights by the number of independent averages.
    let n = variances.len();
    let mut c = Matrix::zeros(n, n);
    for (i, v) in variances.iter().enumerate() {
        c[(i, i)] = v.variance.powi(2) * 2.0 * v.factor as f64 / v.terms as f64;
    }
    let mut sets = feasible(variances, &c)?;
    let family = AllanCovariance::of(variances, interval_s);
    for _ in 0..ROUNDS {
        c = family.at(&Coefficients::from_order(sets[0].values));
        sets = feasible(variances, &c)?;
    }
    let best = &sets[0];
    let enough = chi_squared_quantile(level, 1.0)?;
    let squares = Coefficients::from_order(best.values);
    let coefficients = core::array::from_fn(|i| {
        let found = coefficient(variances, &family, &c, best, i, level);
        // Nothing is lost without it: then it may be nothing.
        let without = sets.iter().find(|s| !s.set[i]).map_or(f64::INFINITY, |s| s.chi_squared);
        match without - best.chi_squared < enough {
            true => Coefficient { interval: [0.0, found.interval[1]], ..found },
            false => found,
        }
    });
    Some(NoiseFit {
        coefficients,
        squares,
        chi_squared: best.chi_squared,
        degrees_of_freedom: n.saturating_sub(best.set.iter().filter(|s| **s).count()),
    })
}

/// A fit with some of the coefficients.
struct Subset {
    set: [bool; 5],
    values: [f64; 5],
    uncertainties: [f64; 5],
    /// How each variance moves each coefficient.
    weights: [Vec<f64>; 5],
    chi_squared: f64,
}

/// All sets of coefficients that fit with none negative, the best first.
fn feasible(variances: &[Variance], covariance: &Matrix) -> Option<Vec<Subset>> {
    let whiten = Cholesky::of(covariance)?;
    let mut all: Vec<Subset> = (1u32..32)
        .map(|bits| core::array::from_fn(|i| bits >> i & 1 == 1))
        .filter_map(|set| subset(variances, &whiten, set))
        .filter(|s| s.values.iter().all(|v| *v >= 0.0))
        .collect();
    all.sort_by(|a, b| a.chi_squared.total_cmp(&b.chi_squared));
    (!all.is_empty()).then_some(all)
}

fn subset(variances: &[Variance], whiten: &Cholesky, set: [bool; 5]) -> Option<Subset> {
    let places: Vec<usize> = (0..5).filter(|i| set[*i]).collect();
    let p = places.len();
    if p > variances.len() {
        return None;
    }
    let y = whiten.solve_lower(&variances.iter().map(|v| v.variance).collect::<Vec<_>>());
    let x: Vec<Vec<f64>> = places
        .iter()
        .map(|i| {
            let column: Vec<f64> = variances.iter().map(|v| columns(v.tau_s)[*i]).collect();
            whiten.solve_lower(&column)
        })
        .collect();
    let mut triangle = Triangular::new(p);
    for (j, y) in y.iter().enumerate() {
        let row: Vec<f64> = x.iter().map(|column| column[j]).collect();
        triangle.push(&row, *y);
    }
    let (solution, unit) = (triangle.solve().ok()?, triangle.unit_covariance().ok()?);
    let (mut values, mut uncertainties) = ([0.0; 5], [0.0; 5]);
    let mut weights = [const { Vec::new() }; 5];
    for (k, i) in places.iter().enumerate() {
        values[*i] = solution[k];
        uncertainties[*i] = unit[(k, k)].sqrt();
        let whitened: Vec<f64> =
            (0..y.len()).map(|j| (0..p).map(|l| unit[(k, l)] * x[l][j]).sum()).collect();
        weights[*i] = whiten.solve_upper(&whitened);
    }
    let chi_squared = triangle.residual_sum_of_squares();
    Some(Subset { set, values, uncertainties, weights, chi_squared })
}

/// A coefficient from its square.
fn coefficient(
    variances: &[Variance],
    family: &AllanCovariance,
    covariance: &Matrix,
    best: &Subset,
    i: usize,
    level: f64,
) -> Coefficient {
    let (c, u) = (best.values[i], best.uncertainties[i]);
    if best.set[i] && c > 0.0 {
        let value = c.sqrt();
        let spread = Spread::of(family, best, i);
        let tail = 0.5 * (1.0 - level);
        let interval = [spread.bound(c, 1.0 - tail).sqrt(), spread.bound(c, tail).sqrt()];
        return Coefficient { value, standard_uncertainty: Some(u / (2.0 * value)), interval };
    }
    Coefficient {
        value: 0.0,
        standard_uncertainty: None,
        interval: [0.0, bound_of_absent(variances, family, covariance, best, i, level)],
    }
}

/// Rounds in which the bound and the uncertainty at the bound are brought together.
const BOUND_ROUNDS: usize = 4;

/// Largest value of a coefficient that is left out: the size at which what would be found of it beside the others is
/// just no surprise. Its uncertainty grows with the size.
fn bound_of_absent(
    variances: &[Variance],
    family: &AllanCovariance,
    covariance: &Matrix,
    best: &Subset,
    i: usize,
    level: f64,
) -> f64 {
    let mut set = best.set;
    set[i] = true;
    let let_in = Cholesky::of(covariance).and_then(|w| subset(variances, &w, set));
    let Some(found) = let_in else { return f64::INFINITY };
    let factor = crate::stats::normal_quantile(0.5 * (1.0 + level));
    let mut size = (found.values[i] + factor * found.uncertainties[i]).max(0.0);
    for _ in 0..BOUND_ROUNDS {
        let mut c = best.values;
        c[i] = size;
        let there = family.at(&Coefficients::from_order(c));
        size = (found.values[i] + factor * variance_of(&found.weights[i], &there).sqrt()).max(0.0);
    }
    size.sqrt()
}

/// `wᵀ C w`.
fn variance_of(w: &[f64], c: &Matrix) -> f64 {
    let mut sum = 0.0;
    for a in 0..w.len() {
        for b in 0..w.len() {
            sum += w[a] * w[b] * c[(a, b)];
        }
    }
    sum.max(f64::MIN_POSITIVE)
}

/// Relative standard uncertainty of a squared coefficient for several true sizes of it.
struct Spread {
    /// `ln` of the size and of the relative uncertainty there.
    at: [(f64, f64); 3],
}

impl Spread {
    fn of(family: &AllanCovariance, best: &Subset, i: usize) -> Self {
        let w = &best.weights[i];
        let at = AROUND.map(|factor| {
            let mut c = best.values;
            c[i] *= factor;
            let covariance = family.at(&Coefficients::from_order(c));
            let u2 = variance_of(w, &covariance);
            (c[i].ln(), 0.5 * u2.ln() - c[i].ln())
        });
        Self { at }
    }

    /// Relative uncertainty at a size: a power between the sizes tried, and beyond.
    fn relative(&self, size: f64) -> f64 {
        let x = size.ln();
        let [a, b, c] = self.at;
        let (p, q) = if x < b.0 { (a, b) } else { (b, c) };
        (p.1 + (q.1 - p.1) * (x - p.0) / (q.0 - p.0)).exp()
    }

    /// The true size of which what was found is the `p` quantile: found/size is `χ²/ν` with `ν = 2/u²_rel`.
    fn bound(&self, found: f64, p: f64) -> f64 {
        let excess = |size: f64| {
            let dof = 2.0 / self.relative(size).powi(2);
            match chi_squared_quantile(p, dof.clamp(1e-3, 1e9)) {
                Some(q) => size * q / dof - found,
                None => 0.0,
            }
        };
        let (mut low, mut high) = (found * 1e-6, found * 1e6);
        for _ in 0..80 {
            let middle = (low * high).sqrt();
            if excess(middle) > 0.0 {
                high = middle;
            } else {
                low = middle;
            }
        }
        (low * high).sqrt()
    }
}
