//! Q, N, B, K and R from Allan variances.

use super::Variance;
use super::covariance::allan_covariance;
use crate::linalg::{Matrix, Triangular};
use crate::stats::chi_squared_quantile;

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
/// **Uncertainty** squares of coefficients are sums of squares, so their interval is that of `χ²` with `2 c²/u²(c)`
/// degrees of freedom (Satterthwaite). It holds what the model holds: other kinds of noise are not in it.
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
    let mut best = best_subset(variances, &c)?;
    for _ in 0..ROUNDS {
        c = allan_covariance(variances, &Coefficients::from_order(best.values), interval_s);
        best = best_subset(variances, &c)?;
    }
    let squares = Coefficients::from_order(best.values);
    let coefficients = core::array::from_fn(|i| coefficient(variances, &c, &best, i, level));
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
    chi_squared: f64,
}

fn best_subset(variances: &[Variance], covariance: &Matrix) -> Option<Subset> {
    let whiten = Cholesky::of(covariance)?;
    (1u32..32)
        .map(|bits| core::array::from_fn(|i| bits >> i & 1 == 1))
        .filter_map(|set| subset(variances, &whiten, set))
        .filter(|s| s.values.iter().all(|v| *v >= 0.0))
        .min_by(|a, b| a.chi_squared.total_cmp(&b.chi_squared))
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
    for (k, i) in places.iter().enumerate() {
        values[*i] = solution[k];
        uncertainties[*i] = unit[(k, k)].sqrt();
    }
    Some(Subset { set, values, uncertainties, chi_squared: triangle.residual_sum_of_squares() })
}

/// A coefficient from its square.
fn coefficient(
    variances: &[Variance],
    covariance: &Matrix,
    best: &Subset,
    i: usize,
    level: f64,
) -> Coefficient {
    let (c, u) = (best.values[i], best.uncertainties[i]);
    if best.set[i] && c > 0.0 {
        let dof = 2.0 * (c / u).powi(2);
        let at = |p: f64| chi_squared_quantile(p, dof).map(|q| (c * dof / q).sqrt());
        let value = c.sqrt();
        let low = at(0.5 * (1.0 + level)).unwrap_or(0.0);
        let high = at(0.5 * (1.0 - level)).unwrap_or(f64::INFINITY);
        return Coefficient {
            value,
            standard_uncertainty: Some(u / (2.0 * value)),
            interval: [low, high],
        };
    }
    // Left out: what it could be if it were let in, from its uncertainty beside the others.
    let mut set = best.set;
    set[i] = true;
    let bound = Cholesky::of(covariance).and_then(|w| subset(variances, &w, set)).map(|s| {
        let one_sided = crate::stats::normal_quantile(level);
        (s.values[i] + one_sided * s.uncertainties[i]).max(0.0).sqrt()
    });
    Coefficient {
        value: 0.0,
        standard_uncertainty: None,
        interval: [0.0, bound.unwrap_or(f64::INFINITY)],
    }
}

/// `C = L Lᵀ`.
struct Cholesky {
    lower: Matrix,
}

impl Cholesky {
    fn of(c: &Matrix) -> Option<Self> {
        let n = c.rows();
        let mut l = Matrix::zeros(n, n);
        for j in 0..n {
            let mut d = c[(j, j)];
            for k in 0..j {
                d -= l[(j, k)] * l[(j, k)];
            }
            // Thinned sums leave a covariance that is not quite one: held at a thousandth of the diagonal.
            let d = d.max(1e-3 * c[(j, j)]);
            if !(d > 0.0 && d.is_finite()) {
                return None;
            }
            l[(j, j)] = d.sqrt();
            for i in j + 1..n {
                let mut s = c[(i, j)];
                for k in 0..j {
                    s -= l[(i, k)] * l[(j, k)];
                }
                l[(i, j)] = s / l[(j, j)];
            }
        }
        Some(Self { lower: l })
    }

    /// `L⁻¹ y`.
    fn solve_lower(&self, y: &[f64]) -> Vec<f64> {
        let mut out = y.to_vec();
        for i in 0..out.len() {
            for k in 0..i {
                let known = out[k];
                out[i] -= self.lower[(i, k)] * known;
            }
            out[i] /= self.lower[(i, i)];
        }
        out
    }
}
