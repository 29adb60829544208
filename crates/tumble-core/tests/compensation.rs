//! What the converter and the sensor distort, the passport's coefficients undo.
#![allow(clippy::unwrap_used)] // A test that cannot unwrap has failed.

use proptest::prelude::*;
use tumble_core::{Compensation, Nonlinearity, Quantizer};

fn unit(scale: f64, bias: f64, quantizer: Quantizer) -> Compensation {
    Compensation {
        scale_factor_m_s2_per_lsb: scale,
        bias_m_s2: bias,
        quantizer_offset: quantizer.offset(),
        covariance: [[0.0; 2]; 2],
        nonlinearity: Nonlinearity::default(),
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

    /// Further terms, as large as sensors and benches have them, over ±2 g and ±40 K: undone to rounding.
    #[test]
    fn further_terms_are_undone(
        a in -20.0..20.0f64,
        k2 in -1e-3..1e-3f64,
        k3 in -2e-5..2e-5f64,
        scale_sign in -0.02..0.02f64,
        bias_per_k in -0.05..0.05f64,
        scale_per_k in -1e-3..1e-3f64,
        temperature in -20.0..60.0f64,
    ) {
        let nonlinearity = Nonlinearity {
            k2_per_m_s2: k2,
            k3_per_m2_s4: k3,
            scale_sign,
            bias_per_k_m_s2: bias_per_k,
            scale_per_k,
            reference_temperature_degc: 20.0,
            ..Nonlinearity::default()
        };
        let kelvin = temperature - 20.0;
        // The model, written out once more.
        let x = a + k2 * a * a + k3 * a * a * a + 0.5 * scale_sign * a.abs()
            + bias_per_k * kelvin + scale_per_k * kelvin * a;
        prop_assert!((nonlinearity.distort_m_s2(a, kelvin) - x).abs() < 1e-13);
        let unit = Compensation { nonlinearity, ..unit(0.01, 0.3, Quantizer::None) };
        let back = unit.acceleration_at_m_s2((x + 0.3) / 0.01, temperature);
        prop_assert!((back - a).abs() < 2e-13, "{a} came back as {back}");
    }

    /// Without a quantizer it is the identity.
    #[test]
    fn unquantized_readings_come_back(a in -20.0..20.0f64, scale in 1e-4..0.1f64, bias in -1.0..1.0f64) {
        let back = unit(scale, bias, Quantizer::None).acceleration_of_mean_m_s2((a + bias) / scale);
        prop_assert!((back - a).abs() < 1e-12);
    }
}
