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

/// Covariance of the overlapping Allan variances of a record, for a model of its noise.
///
/// **Model** with `z` the second differences and `γ_ab(l)` their cross-covariance at factors `a`, `b` and lag `l`,
/// `cov(σ²_a, σ²_b) = Σ_l w(l) [2 γ_ab(l)² + 4 d_a d_b γ_ab(l)] / (4 τ_a² τ_b² M_a M_b)`; `w(l)` counts the pairs at that
/// lag, `d = R τ²` is what a ramp adds to every difference. `γ` comes from the generalized autocovariance of the velocity,
/// `Q² δ(t) − N²|t|/2 + B² t² ln|t|/(2π) + K² |t|³/12`. The sum over lags is thinned where the summand is smooth.
///
/// **Source** own derivation from Gaussian fourth moments (Isserlis); the diagonal is Greenhall's.
#[must_use]
pub fn allan_covariance(variances: &[Variance], model: &Coefficients, interval_s: f64) -> Matrix {
    let n = variances.len();
    let mut c = Matrix::zeros(n, n);
    for i in 0..n {
        for j in i..n {
            let v = pair(&variances[i], &variances[j], model, interval_s);
            c[(i, j)] = v;
            c[(j, i)] = v;
        }
    }
    c
}

/// Generalized autocovariance of the velocity at a lag in readings.
fn autocovariance(lag: f64, model: &Coefficients, interval_s: f64) -> f64 {
    let t = (lag * interval_s).abs();
    if t == 0.0 {
        return model.q2;
    }
    t * (-0.5 * model.n2 + t * (model.b2 * t.ln() / core::f64::consts::TAU + t * model.k2 / 12.0))
}

fn pair(a: &Variance, b: &Variance, model: &Coefficients, interval_s: f64) -> f64 {
    let (ma, mb) = (a.factor as f64, b.factor as f64);
    let gamma = |lag: f64| -> f64 {
        let mut sum = 0.0;
        for (p, cp) in SECOND.iter().enumerate() {
            for (q, cq) in SECOND.iter().enumerate() {
                let at = lag + p as f64 * ma - q as f64 * mb;
                sum += cp * cq * autocovariance(at, model, interval_s);
            }
        }
        sum
    };
    let ramp = model.r2 * (a.tau_s * b.tau_s).powi(2);
    let summand = |lag: f64| {
        let g = gamma(lag);
        2.0 * g * g + 4.0 * ramp * g
    };
    // Lag of the first point of a difference at `b` behind that of one at `a`: from −(M_b − 1) to M_a − 1.
    let (first, last) = (-(b.terms as f64 - 1.0), a.terms as f64 - 1.0);
    let lags = lags(ma, mb, first, last);
    let pairs = |l: f64| {
        // Places i in 0..M_a with i − l in 0..M_b.
        ((a.terms as f64).min(b.terms as f64 + l) - l.max(0.0)).max(0.0)
    };
    let mut sum = 0.0;
    for (k, l) in lags.iter().enumerate() {
        let before = if k > 0 { l - lags[k - 1] } else { 1.0 };
        let after = lags.get(k + 1).map_or(1.0, |next| next - l);
        sum += 0.5 * (before + after) * pairs(*l) * summand(*l);
    }
    sum / (4.0 * (a.tau_s * b.tau_s).powi(2) * a.terms as f64 * b.terms as f64)
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
