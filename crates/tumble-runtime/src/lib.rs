//! The code that flies: turns accelerometer codes into acceleration with the coefficients of one unit's
//! calibration passport.
//!
//! `no_std`, no allocation, no dependencies. Everything here is plain arithmetic on `f64`; a batch is a loop
//! over slices without branches, which the compiler vectorizes.
//!
//! **Model** `a = k* · (N + c(N)) − Δa`, where `N` is the code, `c` the quantizer's offset, `k*` the scale
//! factor of this unit and `Δa` its bias. Where the passport has further terms, that is `x`, and `a` solves
//! `x = a + K2 a² + …` ([`Nonlinearity`]).
//!
//! **Units** codes in LSB; `k*` in m/s² per LSB; `Δa` and results in m/s². Positive acceleration points along
//! the sensitive axis; a unit at rest with that axis up reads `+g` (specific force).
//!
//! **Source** method section 12 (`docs/method.md` of the Tumble repository).
//!
//! ```
//! use tumble_runtime::{Compensation, Nonlinearity, QuantizerOffset};
//!
//! let unit = Compensation {
//!     scale_factor_m_s2_per_lsb: 0.0077,
//!     bias_m_s2: -0.0063,
//!     quantizer_offset: QuantizerOffset::HalfSign,
//!     covariance: [[1e-12, 0.0], [0.0, 1e-8]],
//!     nonlinearity: Nonlinearity::default(),
//! };
//! assert!((unit.acceleration_m_s2(100) - (0.0077 * 100.5 + 0.0063)).abs() < 1e-15);
//! ```
#![no_std]

mod batch;
mod nonlinearity;

pub use batch::LengthMismatch;
pub use nonlinearity::Nonlinearity;

/// The offset between a code and the middle of the interval of analogue values that it stands for.
///
/// **Units** LSB. It belongs to the converter and is fixed by how the converter rounds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum QuantizerOffset {
    /// `0.5 · sign N`: the converter truncates toward zero.
    HalfSign,
    /// `+0.5`: the converter rounds down (two's-complement truncation).
    Half,
    /// `0`: the converter rounds to nearest, or the reading is not quantized.
    None,
}

impl QuantizerOffset {
    /// The offset `c(N)` in LSB for a code or for a mean of codes.
    ///
    /// ```
    /// use tumble_runtime::QuantizerOffset;
    /// assert_eq!(QuantizerOffset::HalfSign.lsb(-3.0), -0.5);
    /// assert_eq!(QuantizerOffset::HalfSign.lsb(0.0), 0.0);
    /// assert_eq!(QuantizerOffset::Half.lsb(-3.0), 0.5);
    /// ```
    #[inline]
    #[must_use]
    pub fn lsb(self, code: f64) -> f64 {
        match self {
            Self::HalfSign => {
                0.5 * (f64::from(u8::from(code > 0.0)) - f64::from(u8::from(code < 0.0)))
            }
            Self::Half => 0.5,
            Self::None => 0.0,
        }
    }
}

/// The coefficients of one unit, as its passport gives them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Compensation {
    /// `k*`, m/s² per LSB (or per unit of the reading).
    pub scale_factor_m_s2_per_lsb: f64,
    /// `Δa`, m/s²: what the unit reads too much at zero acceleration.
    pub bias_m_s2: f64,
    /// `c`, LSB.
    pub quantizer_offset: QuantizerOffset,
    /// Covariance of (`k*`, `Δa`), in that order: `[[(m/s²/LSB)², …], […, (m/s²)²]]`.
    pub covariance: [[f64; 2]; 2],
    /// Further terms; the default has none.
    pub nonlinearity: Nonlinearity,
}

impl Compensation {
    /// Acceleration of one code, m/s², at the reference temperature where there are terms on temperature.
    #[inline]
    #[must_use]
    pub fn acceleration_m_s2(&self, code: i32) -> f64 {
        self.acceleration_of_mean_m_s2(f64::from(code))
    }

    /// Acceleration of a mean of codes, or of a reading that is not quantized, m/s².
    #[inline]
    #[must_use]
    pub fn acceleration_of_mean_m_s2(&self, mean_code: f64) -> f64 {
        self.nonlinearity.undo_m_s2(self.linear_m_s2(mean_code), 0.0)
    }

    /// The same at a temperature, °C.
    #[inline]
    #[must_use]
    pub fn acceleration_at_m_s2(&self, mean_code: f64, temperature_degc: f64) -> f64 {
        let kelvin = temperature_degc - self.nonlinearity.reference_temperature_degc;
        self.nonlinearity.undo_m_s2(self.linear_m_s2(mean_code), kelvin)
    }

    /// `x = k* (N + c(N)) − Δa`, m/s².
    #[inline]
    fn linear_m_s2(&self, mean_code: f64) -> f64 {
        let analogue = mean_code + self.quantizer_offset.lsb(mean_code);
        self.scale_factor_m_s2_per_lsb * analogue - self.bias_m_s2
    }

    /// Variance of that acceleration caused by the coefficients, (m/s²)².
    ///
    /// **Uncertainty** contains what the passport's covariance contains; leaves out the reading's own noise and
    /// resolution. It is a variance because `core` has no square root: one `sqrt` on the caller's side gives
    /// the standard uncertainty.
    ///
    /// **Model** `u² = n² u²(k*) + u²(Δa) − 2 n cov(k*, Δa)` with `n = N + c(N)`.
    #[inline]
    #[must_use]
    pub fn calibration_variance(&self, mean_code: f64) -> f64 {
        let n = mean_code + self.quantizer_offset.lsb(mean_code);
        let [[kk, kb], [_, bb]] = self.covariance;
        n * n * kk + bb - 2.0 * n * kb
    }

    /// The same with the further terms, at a temperature, °C.
    ///
    /// **Model** `u² = g C gᵀ/(dx/da)²` with `g = (n, −1, −a², −a³, −½|a|, −(T − T̄), −(T − T̄) a)`.
    #[must_use]
    pub fn calibration_variance_at(&self, mean_code: f64, temperature_degc: f64) -> f64 {
        let kelvin = temperature_degc - self.nonlinearity.reference_temperature_degc;
        let a = self.nonlinearity.undo_m_s2(self.linear_m_s2(mean_code), kelvin);
        let n = mean_code + self.quantizer_offset.lsb(mean_code);
        let (of_terms, factor) = self.nonlinearity.variance(n, a, kelvin);
        (self.calibration_variance(mean_code) + of_terms) * factor
    }
}
