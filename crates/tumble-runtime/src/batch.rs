//! Batches over slices: one pass, no branch in the loop.

use crate::{Compensation, QuantizerOffset};

/// The two slices of a batch have different lengths.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct LengthMismatch {
    /// Number of codes.
    pub codes: usize,
    /// Room for results.
    pub accelerations: usize,
}

impl core::fmt::Display for LengthMismatch {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        write!(f, "{} codes but room for {} accelerations", self.codes, self.accelerations)
    }
}

impl core::error::Error for LengthMismatch {}

impl Compensation {
    /// Accelerations of a batch of codes, m/s², at the reference temperature where there are terms on temperature.
    ///
    /// **Errors** [`LengthMismatch`] when the slices differ in length; nothing is written then.
    ///
    /// ```
    /// # use tumble_runtime::{Compensation, Nonlinearity, QuantizerOffset};
    /// # let unit = Compensation { scale_factor_m_s2_per_lsb: 0.5, bias_m_s2: 1.0,
    /// #     quantizer_offset: QuantizerOffset::Half, covariance: [[0.0; 2]; 2],
    /// #     nonlinearity: Nonlinearity::default() };
    /// let mut out = [0.0; 3];
    /// unit.apply(&[-1, 0, 7], &mut out)?;
    /// assert_eq!(out, [-1.25, -0.75, 2.75]);
    /// assert!(unit.apply(&[1], &mut out).is_err());
    /// # Ok::<(), tumble_runtime::LengthMismatch>(())
    /// ```
    pub fn apply(&self, codes: &[i32], accelerations: &mut [f64]) -> Result<(), LengthMismatch> {
        if codes.len() != accelerations.len() {
            return Err(LengthMismatch { codes: codes.len(), accelerations: accelerations.len() });
        }
        let (k, bias) = (self.scale_factor_m_s2_per_lsb, self.bias_m_s2);
        // The match stands outside the loops so that each loop is straight-line arithmetic.
        match self.quantizer_offset {
            QuantizerOffset::HalfSign => {
                for (a, &n) in accelerations.iter_mut().zip(codes) {
                    let sign = i32::from(n > 0) - i32::from(n < 0);
                    *a = k * (f64::from(n) + 0.5 * f64::from(sign)) - bias;
                }
            }
            QuantizerOffset::Half => {
                for (a, &n) in accelerations.iter_mut().zip(codes) {
                    *a = k * (f64::from(n) + 0.5) - bias;
                }
            }
            QuantizerOffset::None => {
                for (a, &n) in accelerations.iter_mut().zip(codes) {
                    *a = k * f64::from(n) - bias;
                }
            }
        }
        // Further terms in a pass of their own: without any, nothing is paid for them.
        if !self.nonlinearity.is_none() {
            for a in accelerations.iter_mut() {
                *a = self.nonlinearity.undo_m_s2(*a, 0.0);
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn batch_is_bit_equal_to_one_at_a_time() {
        for offset in [QuantizerOffset::HalfSign, QuantizerOffset::Half, QuantizerOffset::None] {
            let unit = Compensation {
                scale_factor_m_s2_per_lsb: 0.007_69,
                bias_m_s2: 0.0123,
                quantizer_offset: offset,
                covariance: [[0.0; 2]; 2],
                nonlinearity: crate::Nonlinearity {
                    k2_per_m_s2: 1e-5,
                    ..crate::Nonlinearity::default()
                },
            };
            let codes: [i32; 9] = [i32::MIN, -2048, -1, 0, 1, 2, 77, 2047, i32::MAX];
            let mut out = [0.0; 9];
            unit.apply(&codes, &mut out).unwrap();
            for (&n, &a) in codes.iter().zip(&out) {
                assert_eq!(a.to_bits(), unit.acceleration_m_s2(n).to_bits(), "{offset:?} {n}");
            }
        }
    }
}
