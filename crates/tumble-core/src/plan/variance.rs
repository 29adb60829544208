//! What a dwell scatters by, and how slow noise ties dwells together.

use core::f64::consts::PI;

use super::problem::{PlanNoise, PlanProblem, Site};

/// Harmonics of the rounding error; the next is below 1e-3 of the first for any noise.
const HARMONICS: u32 = 40;

/// Variances of the mean of a dwell by source, (m/s²)².
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct DwellVariance {
    pub white: f64,
    pub rounding: f64,
    pub setting: f64,
    pub level: f64,
}

impl DwellVariance {
    pub fn of(problem: &PlanProblem, site: Site, dwell_s: f64) -> Self {
        let setting = problem.gravity.value_m_s2 * site.cosine() * problem.setting_scatter.rad();
        Self {
            white: problem.noise.white_m_s2_rts.powi(2) / dwell_s,
            rounding: rounding(problem, dwell_s),
            setting: setting * setting,
            level: problem.level_scatter_m_s2.powi(2),
        }
    }

    /// What differs from dwell to dwell.
    pub fn total(self) -> f64 {
        self.white + self.rounding + self.setting + self.level
    }
}

/// Standard deviation of a single reading over one LSB; `None` without a converter.
pub(super) fn dither_lsb(problem: &PlanProblem) -> Option<f64> {
    let c = problem.converter?;
    Some(problem.noise.white_m_s2_rts * c.rate_hz.sqrt() / c.lsb_m_s2)
}

/// Variance of a dwell's mean by rounding.
///
/// **Model** an average over a converter is off by `Σ (−1)ᵏ/(πk) e^(−2π²k²s²) sin 2πkx` LSB, with `s` the noise of a reading
/// in LSB; where in its step a dwell falls is anything, so the variance is `Σ e^(−4π²k²s²)/(2π²k²)`: 1/12 without noise. What
/// is left of 1/12 averages as noise does.
fn rounding(problem: &PlanProblem, dwell_s: f64) -> f64 {
    let (Some(c), Some(s)) = (problem.converter, dither_lsb(problem)) else { return 0.0 };
    let frozen: f64 = (1..=HARMONICS)
        .map(|k| f64::from(k).powi(2))
        .map(|k2: f64| (-4.0 * PI * PI * k2 * s * s).exp() / (2.0 * PI * PI * k2))
        .sum();
    let samples = (dwell_s * c.rate_hz).max(1.0);
    c.lsb_m_s2.powi(2) * (frozen + (1.0_f64 / 12.0 - frozen).max(0.0) / samples)
}

/// Covariance of the drift that dwells share, referred to its mean over the run, (m/s²)².
///
/// **Model** generalized covariances of averages over dwells of length T: `−(B²/π) ln|τ|` for flicker, `−K²|τ|/2` for random
/// walk, both good for contrasts only, which is what is left when the mean of the run is taken off: a run's bias *is* the
/// bias at the mean of its dwells. Adjacent dwells give back the Allan variance.
pub(super) fn drift_covariance(
    noise: &PlanNoise,
    centres_s: &[f64],
    dwell_s: f64,
) -> Vec<Vec<f64>> {
    let n = centres_s.len();
    let middle = centres_s.iter().sum::<f64>() / n.max(1) as f64;
    let mut c = vec![vec![0.0; n]; n];
    for i in 0..n {
        for j in 0..n {
            let lag = (centres_s[i] - centres_s[j]).abs();
            c[i][j] = shared(noise, lag, dwell_s)
                + noise.ramp_m_s3.powi(2) * (centres_s[i] - middle) * (centres_s[j] - middle);
        }
    }
    centred(&mut c);
    c
}

/// Generalized covariance of two dwells' means.
fn shared(noise: &PlanNoise, lag_s: f64, dwell_s: f64) -> f64 {
    let walk = |x: f64| x.abs().powi(3) / 6.0;
    let flicker = |x: f64| {
        let x = x.abs();
        if x == 0.0 { 0.0 } else { x * x * (0.5 * x.ln() - 0.75) }
    };
    let twice = |f: &dyn Fn(f64) -> f64| {
        (f(lag_s + dwell_s) - 2.0 * f(lag_s) + f(lag_s - dwell_s)) / (dwell_s * dwell_s)
    };
    let mut c = 0.0;
    if noise.walk_m_s2_rts > 0.0 {
        c -= 0.5 * noise.walk_m_s2_rts.powi(2) * twice(&walk);
    }
    if noise.flicker_m_s2 > 0.0 {
        c -= noise.flicker_m_s2.powi(2) / PI * twice(&flicker);
    }
    c
}

/// What the drift alone makes two dwells differ by, half the variance: at the distance of neighbours no order helps.
pub(super) fn short_term(noise: &PlanNoise, lag_s: f64, dwell_s: f64) -> f64 {
    (shared(noise, 0.0, dwell_s) - shared(noise, lag_s, dwell_s)).max(0.0)
}

/// Takes the mean off rows and columns.
fn centred(c: &mut [Vec<f64>]) {
    let n = c.len() as f64;
    let means: Vec<f64> = c.iter().map(|row| row.iter().sum::<f64>() / n).collect();
    let all = means.iter().sum::<f64>() / n;
    for i in 0..c.len() {
        for j in 0..c.len() {
            c[i][j] += all - means[i] - means[j];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Angle;

    #[test]
    fn adjacent_dwells_give_the_allan_variance() {
        let t = 7.0;
        for (noise, expected) in [
            (PlanNoise { flicker_m_s2: 2.0, ..Default::default() }, 2.0 * 2f64.ln() / PI * 4.0),
            (PlanNoise { walk_m_s2_rts: 2.0, ..Default::default() }, 4.0 * t / 3.0),
        ] {
            let allan = short_term(&noise, t, t);
            assert!((allan / expected - 1.0).abs() < 1e-12, "{allan} {expected}");
        }
    }

    #[test]
    fn rounding_is_a_twelfth_without_noise_and_nothing_with_much() {
        let mut p = PlanProblem::with_range(Angle::from_deg(65.0));
        p.converter = Some(super::super::PlanConverter { lsb_m_s2: 1.0, rate_hz: 1.0 });
        p.noise.white_m_s2_rts = 0.0;
        assert!((rounding(&p, 1e9) * 12.0 - 1.0).abs() < 0.02);
        p.noise.white_m_s2_rts = 1.0;
        assert!(rounding(&p, 1e9) < 1e-9);
    }
}
