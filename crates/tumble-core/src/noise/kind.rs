//! What kind of noise dominates at an averaging time.

use super::Deviation;

/// Kinds of noise by the power `α` of their spectral density, `S_y ~ f^α`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum NoiseKind {
    /// `α = −2`: random walk of the reading (K).
    RandomWalk,
    /// `α = −1`: flicker of the reading (bias instability, B).
    Flicker,
    /// `α = 0`: white reading (velocity random walk, N).
    White,
    /// `α = 1`: flicker of the velocity.
    FlickerVelocity,
    /// `α = 2`: white velocity (quantization, Q).
    WhiteVelocity,
}

impl NoiseKind {
    /// `α`.
    #[must_use]
    pub fn power(self) -> i32 {
        self as i32 - 2
    }

    /// The kind nearest to a power.
    #[must_use]
    pub fn nearest(power: f64) -> Self {
        match power.round() as i32 {
            ..=-2 => Self::RandomWalk,
            -1 => Self::Flicker,
            0 => Self::White,
            1 => Self::FlickerVelocity,
            2.. => Self::WhiteVelocity,
        }
    }

    /// For people.
    #[must_use]
    pub fn words(self) -> &'static str {
        match self {
            Self::RandomWalk => "random walk",
            Self::Flicker => "flicker",
            Self::White => "white",
            Self::FlickerVelocity => "flicker of the velocity",
            Self::WhiteVelocity => "white velocity (quantization)",
        }
    }
}

/// Fewest averages from which the correlation of neighbours is believed.
const FEWEST: usize = 30;

/// The kind of noise at an averaging factor, from the lag-1 autocorrelation of the averaged record; `None` where fewer
/// than 30 averages are left.
///
/// **Model** `r1` of the averages, differenced `d` times until `δ = r1/(1+r1) < 1/4`; then `α = −2δ − 2d`, rounded. White
/// noise of the velocity at `m = 1` is seen in the velocity itself, which is differenced once more: `α + 2`.
///
/// **Source** W. J. Riley, C. A. Greenhall, *Power law noise identification using the lag 1 autocorrelation*, EFTF 2004.
#[must_use]
pub fn kind_at(velocity: &[f64], factor: usize, deviation: Deviation) -> Option<NoiseKind> {
    // The deepest difference that the deviation can bear.
    let deepest = if deviation == Deviation::Hadamard { 3 } else { 2 };
    let mut z: Vec<f64> = velocity.iter().copied().step_by(factor).collect();
    if z.len() < FEWEST + 1 {
        return None;
    }
    // A linear drift of the reading is a parabola of the velocity: taken out, as it is no noise.
    detrend(&mut z);
    let mut differenced = 0;
    loop {
        let delta = lag_one(&z).map(|r| r / (1.0 + r))?;
        if delta < 0.25 || differenced == deepest {
            // Of the velocity: its power is α − 2.
            return Some(NoiseKind::nearest(-2.0 * delta - 2.0 * f64::from(differenced) + 2.0));
        }
        z = z.windows(2).map(|w| w[1] - w[0]).collect();
        differenced += 1;
        if z.len() < FEWEST {
            return None;
        }
    }
}

/// Correlation of neighbours about the mean; `None` of a constant.
fn lag_one(z: &[f64]) -> Option<f64> {
    let mean = crate::stats::mean(z)?;
    let square: f64 = z.iter().map(|v| (v - mean).powi(2)).sum();
    let product: f64 = z.windows(2).map(|w| (w[0] - mean) * (w[1] - mean)).sum();
    (square > 0.0).then_some(product / square)
}

/// Takes a parabola out, by least squares on orthogonal polynomials.
fn detrend(z: &mut [f64]) {
    let n = z.len() as f64;
    let t = |i: usize| 2.0 * i as f64 / (n - 1.0) - 1.0;
    let mean_square = (0..z.len()).map(|i| t(i).powi(2)).sum::<f64>() / n;
    let basis: [&dyn Fn(usize) -> f64; 3] = [&|_| 1.0, &t, &|i| t(i).powi(2) - mean_square];
    for p in basis {
        let (mut along, mut square) = (0.0, 0.0);
        for (i, v) in z.iter().enumerate() {
            along += v * p(i);
            square += p(i) * p(i);
        }
        let share = along / square;
        z.iter_mut().enumerate().for_each(|(i, v)| *v -= share * p(i));
    }
}
