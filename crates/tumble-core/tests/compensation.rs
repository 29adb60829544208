//! What the converter and the sensor distort, the passport's coefficients undo.
#![allow(clippy::unwrap_used)] // A test that cannot unwrap has failed.

use proptest::prelude::*;
use tumble_core::{Compensation, Quantizer};

fn unit(scale: f64, bias: f64, quantizer: Quantizer) -> Compensation {
    Compensation {
        scale_factor_m_s2_per_lsb: scale,
        bias_m_s2: bias,
        quantizer_offset: quantizer.offset(),
        covariance: [[0.0; 2]; 2],
    }
}

proptest! {
    /// Exact but for the width of a code: half an LSB, one LSB around the zero of a truncating converter.
    #[test]
    fn compensation_undoes_the_distortion_to_half_an_lsb(
        a in -20.0..20.0f64,
        scale in 1e-4..0.1f64,
        bias in -1.0..1.0f64,
        which in 0..3usize,
    ) {
        let quantizer = [Quantizer::Truncate, Quantizer::Floor, Quantizer::Round][which];
        let code = quantizer.code((a + bias) / scale).unwrap();
        let back = unit(scale, bias, quantizer).acceleration_m_s2(code.0);
        let width = if quantizer == Quantizer::Truncate && code.0 == 0 { 1.0 } else { 0.5 };
        prop_assert!((back - a).abs() <= width * scale * (1.0 + 1e-9) + 1e-12, "{a} came back as {back}");
    }

    /// Without a quantizer it is the identity.
    #[test]
    fn unquantized_readings_come_back(a in -20.0..20.0f64, scale in 1e-4..0.1f64, bias in -1.0..1.0f64) {
        let back = unit(scale, bias, Quantizer::None).acceleration_of_mean_m_s2((a + bias) / scale);
        prop_assert!((back - a).abs() < 1e-12);
    }
}
