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
const FEWEST: u64 = 30;

/// Sums over averages of a record, one after another without overlap, that tell what kind of noise they hold.
///
/// **Model** `r1`, the lag-1 autocorrelation of the averages; where `δ = r1/(1+r1)` is a quarter or more, that of their
/// differences, `d = 1`, and so on; then `α = −2δ − 2d`, rounded.
///
/// **Source** W. J. Riley, C. A. Greenhall, *Power law noise identification using the lag 1 autocorrelation*, EFTF 2004.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct KindSums {
    last: Option<f64>,
    averages: LagOne,
    differences: LagOne,
    second: LagOne,
}

impl KindSums {
    /// The next point of the velocity, one averaging time after the last.
    pub fn push(&mut self, velocity: f64) {
        if let Some(average) = self.last.replace(velocity).map(|last| velocity - last)
            && let Some(difference) = self.averages.push(average)
            && let Some(second) = self.differences.push(difference)
        {
            self.second.push(second);
        }
    }

    /// The kind of noise; `None` below 30 averages. [`Deviation::Hadamard`] bears one difference more.
    #[must_use]
    pub fn kind(&self, deviation: Deviation) -> Option<NoiseKind> {
        if self.averages.count < FEWEST {
            return None;
        }
        let chain = [&self.averages, &self.differences, &self.second];
        let deepest = if deviation == Deviation::Hadamard { 2 } else { 1 };
        for (d, sums) in chain.iter().enumerate() {
            let r = sums.correlation()?;
            let delta = r / (1.0 + r);
            if delta < 0.25 || d == deepest {
                return Some(NoiseKind::nearest(-2.0 * delta - 2.0 * d as f64));
            }
        }
        None
    }
}

/// Sums of a series and of products of neighbours.
#[derive(Debug, Clone, Default, PartialEq)]
struct LagOne {
    count: u64,
    /// Taken from every value, so that the sums keep their digits.
    origin: f64,
    first: f64,
    last: f64,
    sum: f64,
    square: f64,
    product: f64,
}

impl LagOne {
    /// The next value; gives its difference from the last.
    fn push(&mut self, value: f64) -> Option<f64> {
        if self.count == 0 {
            self.origin = value;
        }
        let v = value - self.origin;
        let difference = (self.count > 0).then_some(v - self.last);
        if self.count == 0 {
            self.first = v;
        } else {
            self.product += v * self.last;
        }
        self.count += 1;
        self.sum += v;
        self.square += v * v;
        self.last = v;
        difference
    }

    /// Correlation of neighbours about the mean; `None` of a constant.
    fn correlation(&self) -> Option<f64> {
        let n = self.count as f64;
        let mean = self.sum / n;
        let square = self.square - n * mean * mean;
        // Σ (v_i − μ)(v_{i+1} − μ): the ends stand in one of the two sums only.
        let product = self.product - mean * (2.0 * self.sum - self.first - self.last)
            + (n - 1.0) * mean * mean;
        (square > 0.0).then_some(product / square)
    }
}

/// The kind of noise at an averaging factor of a record in memory.
#[must_use]
pub fn kind_at(velocity: &[f64], factor: usize, deviation: Deviation) -> Option<NoiseKind> {
    let mut sums = KindSums::default();
    velocity.iter().step_by(factor).for_each(|x| sums.push(*x));
    sums.kind(deviation)
}
