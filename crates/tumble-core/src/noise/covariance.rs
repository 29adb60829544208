//! How the variances of one record at several averaging times hang together.

use super::{Coefficients, Variance};
use crate::linalg::Matrix;

/// Offsets about a kink that are taken densely, in the smaller averaging factor.
const NEAR: f64 = 4.0;
/// Steps an averaging factor there.
const STEPS: f64 = 12.0;
/// Growth of the step farther out.
const GROWTH: f64 = 1.2;
/// Weights of a second difference.
const SECOND: [f64; 3] = [1.0, -2.0, 1.0];

/// Covariance of the overlapping Allan variances of a record, for any model of its noise.
///
/// **Model** with `z` the second differences and `γ_ab(l)` their cross-covariance at factors `a`, `b` and lag `l`,
/// `cov(σ²_a, σ²_b) = Σ_l w(l) [2 γ_ab(l)² + 4 d_a d_b γ_ab(l)] / (4 τ_a² τ_b² M_a M_b)`; `w(l)` counts the pairs at that
/// lag, `d = R τ²` is what a ramp adds to every difference. `γ` comes from the generalized autocovariance of the velocity,
/// `Q² δ(t) − N²|t|/2 + B² t² ln|t|/(2π) + K² |t|³/12`. It is a sum of four kinds: their products are summed up once, and
/// every model is a weighted sum of the products. The sum over lags is thinned where the summand is smooth; the part that a
/// ramp brings is summed exactly.
///
/// **Source** own derivation from Gaussian fourth moments (Isserlis); the diagonal is Greenhall's.
#[derive(Debug, Clone)]
pub struct AllanCovariance {
    size: usize,
    measured: Vec<f64>,
    discrepancy: f64,
    /// For each pair of variances, row by row of the upper triangle.
    pairs: Vec<Pair>,
}

/// What a pair of variances has in common, in the order of [`weights`].
type Pair = [f64; WEIGHTS];

/// Q, N, B, K.
const KINDS: usize = 4;
/// Pairs of kinds, and each kind beside the ramp.
const WEIGHTS: usize = KINDS * (KINDS + 1) / 2 + KINDS;

/// Products of squared coefficients: each pair of kinds once, then each kind and the ramp.
fn weights(model: &Coefficients) -> Pair {
    let c = [model.q2, model.n2, model.b2, model.k2];
    let mut out = [0.0; WEIGHTS];
    let mut places = out.iter_mut();
    for i in 0..KINDS {
        (i..KINDS).zip(&mut places).for_each(|(j, place)| *place = c[i] * c[j]);
    }
    c.iter().zip(places).for_each(|(c, place)| *place = c * model.r2);
    out
}

impl AllanCovariance {
    /// Of variances of one record whose readings are `interval_s` apart.
    #[must_use]
    pub fn of(variances: &[Variance], interval_s: f64) -> Self {
        let size = variances.len();
        let pairs = (0..size)
            .flat_map(|i| (i..size).map(move |j| (i, j)))
            .map(|(i, j)| pair(&variances[i], &variances[j], interval_s))
            .collect();
        let measured = variances.iter().map(|v| v.variance).collect();
        Self { size, measured, discrepancy: 0.0, pairs }
    }

    /// The same where the true variances differ from any model, each on its own, by so much (standard, relative to what
    /// was measured: relative to the model it would grow with every misfit).
    #[must_use]
    pub fn with_discrepancy(self, discrepancy: f64) -> Self {
        Self { discrepancy, ..self }
    }

    /// The covariance under a model.
    #[must_use]
    pub fn at(&self, model: &Coefficients) -> Matrix {
        let weights = weights(model);
        let mut out = Matrix::zeros(self.size, self.size);
        let mut pairs = self.pairs.iter();
        for i in 0..self.size {
            for (j, pair) in (i..self.size).zip(&mut pairs) {
                let sum: f64 = weights.iter().zip(pair).map(|(w, p)| w * p).sum();
                out[(i, j)] = sum;
                out[(j, i)] = sum;
            }
        }
        for i in 0..self.size {
            out[(i, i)] += (self.discrepancy * self.measured[i]).powi(2);
        }
        out
    }
}

/// Generalized autocovariance of the velocity at a lag in readings, for a unit of each kind.
fn autocovariance(lag: f64, interval_s: f64) -> [f64; KINDS] {
    let t = (lag * interval_s).abs();
    if t == 0.0 {
        return [1.0, 0.0, 0.0, 0.0];
    }
    [0.0, -0.5 * t, t * t * t.ln() / core::f64::consts::TAU, t.powi(3) / 12.0]
}

/// Cross-covariance of the differences at factors `a` and `b`, for a unit of each kind.
fn of_differences(lag: f64, ma: f64, mb: f64, interval_s: f64) -> [f64; KINDS] {
    let mut sum = [0.0; KINDS];
    for (p, cp) in SECOND.iter().enumerate() {
        for (q, cq) in SECOND.iter().enumerate() {
            let s = autocovariance(lag + p as f64 * ma - q as f64 * mb, interval_s);
            (0..KINDS).for_each(|k| sum[k] += cp * cq * s[k]);
        }
    }
    sum
}

fn pair(a: &Variance, b: &Variance, interval_s: f64) -> Pair {
    let (ma, mb) = (a.factor as f64, b.factor as f64);
    let (na, nb) = (a.terms as f64, b.terms as f64);
    // Lag of the first point of a difference at `b` behind that of one at `a`: from −(M_b − 1) to M_a − 1.
    let lags = lags(ma, mb, 1.0 - nb, na - 1.0);
    // Places i in 0..M_a with i − l in 0..M_b.
    let pairs = |l: f64| (na.min(nb + l) - l.max(0.0)).max(0.0);
    let unit = 1.0 / (4.0 * (a.tau_s * b.tau_s).powi(2) * na * nb);
    let mut products = [[0.0; KINDS]; KINDS];
    for (k, l) in lags.iter().enumerate() {
        let before = if k > 0 { l - lags[k - 1] } else { 1.0 };
        let after = lags.get(k + 1).map_or(1.0, |next| next - l);
        let weight = unit * (before + after) * pairs(*l);
        let g = of_differences(*l, ma, mb, interval_s);
        for i in 0..KINDS {
            for j in 0..KINDS {
                products[i][j] += weight * g[i] * g[j];
            }
        }
    }
    let ramp = 4.0 * unit * (a.tau_s * b.tau_s).powi(2);
    let beside_ramp = of_sums(a, b, interval_s);
    let mut out = [0.0; WEIGHTS];
    let mut places = out.iter_mut();
    for i in 0..KINDS {
        for (j, place) in (i..KINDS).zip(&mut places) {
            // Each unlike pair stands for two.
            *place = if i == j { products[i][j] } else { 2.0 * products[i][j] };
        }
    }
    beside_ramp.iter().zip(places).for_each(|(s, place)| *place = ramp * s);
    out
}

/// `Σ_l w(l) γ_ab(l)`: covariance of the sums of all differences at `a` and at `b`. They telescope: of the velocity only
/// four windows are left, `m` points long, at both ends of the record. Summed lag by lag, what cancels would drown it.
fn of_sums(a: &Variance, b: &Variance, interval_s: f64) -> [f64; KINDS] {
    let windows = |v: &Variance| {
        let (m, places) = (v.factor as f64, v.terms as f64);
        [(0.0, 1.0), (m, -1.0), (places, -1.0), (places + m, 1.0)]
    };
    let (ma, mb) = (a.factor as f64, b.factor as f64);
    let mut sum = [0.0; KINDS];
    for (p, cp) in windows(a) {
        for (q, cq) in windows(b) {
            let lag = p - q;
            for (at, sign) in [(lag + ma, 1.0), (lag, -1.0), (lag + ma - mb, -1.0), (lag - mb, 1.0)]
            {
                let both = twice_integrated(at * interval_s, interval_s);
                (0..KINDS).for_each(|k| sum[k] += cp * cq * sign * both[k]);
            }
        }
    }
    sum.map(|s| s / (interval_s * interval_s))
}

/// The functions whose second derivatives are [`autocovariance`], in time.
fn twice_integrated(t: f64, interval_s: f64) -> [f64; KINDS] {
    let t = t.abs();
    if t == 0.0 {
        return [0.0; KINDS];
    }
    let flicker = (t.ln() / 12.0 - 7.0 / 144.0) / core::f64::consts::TAU;
    [0.5 * interval_s * t, -t.powi(3) / 12.0, t.powi(4) * flicker, t.powi(5) / 240.0]
}

/// Whole lags: dense about the places where differences touch, sparser farther out.
fn lags(ma: f64, mb: f64, first: f64, last: f64) -> Vec<f64> {
    let small = ma.min(mb);
    let step = (small / STEPS).max(1.0);
    let mut out = vec![first, last];
    for p in 0..3 {
        for q in 0..3 {
            let kink = f64::from(q) * mb - f64::from(p) * ma;
            let mut offset: f64 = 0.0;
            let mut stride = step;
            while offset <= 6.0 * (ma + mb) {
                out.push((kink + offset).round());
                out.push((kink - offset).round());
                if offset > NEAR * small {
                    stride *= GROWTH;
                }
                offset += stride;
            }
        }
    }
    out.retain(|l| *l >= first && *l <= last);
    out.sort_by(f64::total_cmp);
    out.dedup();
    out
}
