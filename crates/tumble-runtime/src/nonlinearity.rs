//! Further terms of the static model, and their inverse.

/// Newton steps of the inverse. From `a = x` the first leaves the square of the nonlinearity's size, and each squares what
/// is left: with 10 mg/g² within ±2 g four reach rounding.
const STEPS: usize = 6;

/// Coefficients of further terms (IEEE 1293) of one unit, as its passport gives them; the default has none.
///
/// **Model** `x = a + K2 a² + K3 a³ + ½ K1′ |a| + c_T (T − T̄) + s_T (T − T̄) a` with `x = k* (N + c(N)) − Δa`.
///
/// **Units** SI: accelerations in m/s², temperatures in °C.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Nonlinearity {
    /// `K2`, 1/(m/s²).
    pub k2_per_m_s2: f64,
    /// `K3`, 1/(m/s²)².
    pub k3_per_m2_s4: f64,
    /// `K1′`: scale factor for positive minus that for negative accelerations, relative.
    pub scale_sign: f64,
    /// `c_T`, m/s² per kelvin.
    pub bias_per_k_m_s2: f64,
    /// `s_T`, per kelvin.
    pub scale_per_k: f64,
    /// `T̄`, °C: at this temperature the terms on temperature vanish.
    pub reference_temperature_degc: f64,
    /// Covariance of each term (rows in the order above) with `k*`, `Δa` and each term.
    pub covariance: [[f64; 7]; 5],
}

impl Nonlinearity {
    /// Whether there are no terms at all.
    #[inline]
    #[must_use]
    pub fn is_none(&self) -> bool {
        self.is_linear() && !self.needs_temperature()
    }

    /// Whether a temperature is needed.
    #[inline]
    #[must_use]
    pub fn needs_temperature(&self) -> bool {
        self.bias_per_k_m_s2 != 0.0 || self.scale_per_k != 0.0
    }

    fn is_linear(&self) -> bool {
        self.k2_per_m_s2 == 0.0 && self.k3_per_m2_s4 == 0.0 && self.scale_sign == 0.0
    }

    /// `x` of an acceleration at a temperature that is `kelvin` above `T̄`.
    #[inline]
    #[must_use]
    pub fn distort_m_s2(&self, a_m_s2: f64, kelvin: f64) -> f64 {
        let a = a_m_s2;
        let slope = 1.0 + 0.5 * sign(a) * self.scale_sign + self.scale_per_k * kelvin;
        self.bias_per_k_m_s2 * kelvin + a * (slope + a * (self.k2_per_m_s2 + a * self.k3_per_m2_s4))
    }

    /// `dx/da`.
    #[inline]
    fn slope(&self, a: f64, kelvin: f64) -> f64 {
        1.0 + 0.5 * sign(a) * self.scale_sign
            + self.scale_per_k * kelvin
            + a * (2.0 * self.k2_per_m_s2 + 3.0 * a * self.k3_per_m2_s4)
    }

    /// The acceleration of an `x`: the inverse of [`Self::distort_m_s2`], exact to rounding where the terms together
    /// change the slope by less than a tenth.
    ///
    /// ```
    /// use tumble_runtime::Nonlinearity;
    /// let bent = Nonlinearity { k2_per_m_s2: 1e-4, ..Nonlinearity::default() };
    /// let a = bent.undo_m_s2(9.8 + 1e-4 * 9.8 * 9.8, 0.0);
    /// assert!((a - 9.8).abs() < 1e-14);
    /// assert_eq!(Nonlinearity::default().undo_m_s2(1.25, 7.0), 1.25);
    /// ```
    #[inline]
    #[must_use]
    pub fn undo_m_s2(&self, x_m_s2: f64, kelvin: f64) -> f64 {
        let mut a = x_m_s2;
        if self.is_none() {
            return a;
        }
        for _ in 0..STEPS {
            a -= (self.distort_m_s2(a, kelvin) - x_m_s2) / self.slope(a, kelvin);
        }
        a
    }

    /// Variance of an acceleration `a` caused by the terms and by what they share with `k*` and `Δa`, beyond that of the
    /// latter two alone; and the square of `da/dx`, which all of it must be multiplied with.
    pub(crate) fn variance(&self, n: f64, a: f64, kelvin: f64) -> (f64, f64) {
        // x = n k* − Δa is what the terms explain: ∂/∂(k*, Δa, K2, K3, K1′, c_T, s_T).
        let gradient = [n, -1.0, -a * a, -a * a * a, -0.5 * a * sign(a), -kelvin, -kelvin * a];
        let mut sum = 0.0;
        for (i, row) in self.covariance.iter().enumerate() {
            for (j, c) in row.iter().enumerate() {
                // Against k* and Δa both halves of the symmetric matrix, which is not stored twice.
                let twice = if j < 2 { 2.0 } else { 1.0 };
                sum += twice * gradient[2 + i] * gradient[j] * c;
            }
        }
        let slope = self.slope(a, kelvin);
        (sum, 1.0 / (slope * slope))
    }
}

/// −1, 0, 1; `core` has no `signum` that gives zero.
#[inline]
fn sign(a: f64) -> f64 {
    f64::from(u8::from(a > 0.0)) - f64::from(u8::from(a < 0.0))
}
