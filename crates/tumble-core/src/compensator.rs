//! Coefficients at work: a reading, its acceleration and both of its uncertainties.

use tumble_runtime::Compensation;

use crate::{Code, ConverterEnds, Quantizer};

/// The coefficients of a passport with what is known about single readings.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Compensator {
    /// Scale factor, bias, quantizer offset, further terms and their covariance.
    pub coefficients: Compensation,
    /// The converter.
    pub quantizer: Quantizer,
    /// Its ends.
    pub ends: ConverterEnds,
    /// Lowest and highest mean reading of the calibration, LSB.
    pub valid_range_lsb: (f64, f64),
    /// Standard deviation of a single reading at rest, LSB.
    pub reading_std_lsb: Option<f64>,
}

/// One compensated reading.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Compensated {
    /// m/s².
    pub acceleration_m_s2: f64,
    /// Standard uncertainty from the coefficients, m/s²: common to all readings of this unit.
    pub u_calibration_m_s2: f64,
    /// Standard uncertainty of this reading alone (noise and resolution), m/s²: falls with averaging.
    pub u_reading_m_s2: f64,
    /// Whether the calibration covered this reading.
    pub inside_range: bool,
}

/// `1/√12`: standard deviation of what rounding to one LSB hides.
const RESOLUTION_LSB: f64 = 0.288_675_134_594_812_9;

impl Compensator {
    /// Compensates one reading; `None` where the converter stood at its end, which is no measurement.
    ///
    /// **Uncertainty** `u_calibration` holds the passport's covariance of scale factor and bias; `u_reading` the
    /// scatter of single readings within dwells, at least the resolution. Vibration, and temperature and
    /// nonlinearity beyond the passport's further terms, are in neither.
    ///
    /// Terms on temperature are taken at their reference: see [`Self::needs_temperature`].
    #[must_use]
    pub fn compensate(&self, reading: f64) -> Option<Compensated> {
        self.compensate_at(reading, self.coefficients.nonlinearity.reference_temperature_degc)
    }

    /// Whether the passport has terms on temperature: readings then need one.
    #[must_use]
    pub fn needs_temperature(&self) -> bool {
        self.coefficients.nonlinearity.needs_temperature()
    }

    /// [`Self::compensate`] at a temperature, °C.
    #[must_use]
    pub fn compensate_at(&self, reading: f64, temperature_degc: f64) -> Option<Compensated> {
        let quantized = self.quantizer != Quantizer::None;
        if quantized && self.ends.censors(Code(reading as i32)) {
            return None;
        }
        let c = &self.coefficients;
        let floor = if quantized { RESOLUTION_LSB } else { 0.0 };
        let reading_std = self.reading_std_lsb.unwrap_or(0.0).max(floor);
        let (low, high) = self.valid_range_lsb;
        Some(Compensated {
            acceleration_m_s2: c.acceleration_at_m_s2(reading, temperature_degc),
            u_calibration_m_s2: c
                .calibration_variance_at(reading, temperature_degc)
                .max(0.0)
                .sqrt(),
            u_reading_m_s2: c.scale_factor_m_s2_per_lsb * reading_std,
            inside_range: (low..=high).contains(&reading),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::QuantizerOffset;

    fn unit() -> Compensator {
        Compensator {
            coefficients: Compensation {
                scale_factor_m_s2_per_lsb: 0.01,
                bias_m_s2: 0.5,
                quantizer_offset: QuantizerOffset::HalfSign,
                covariance: [[4e-12, 0.0], [0.0, 9e-6]],
                nonlinearity: crate::Nonlinearity::default(),
            },
            quantizer: Quantizer::Truncate,
            ends: ConverterEnds { min_code: Some(Code(-2048)), max_code: Some(Code(2047)) },
            valid_range_lsb: (-1000.0, 1000.0),
            reading_std_lsb: Some(1.2),
        }
    }

    #[test]
    fn both_uncertainties() {
        let c = unit().compensate(999.0).unwrap();
        assert!((c.acceleration_m_s2 - (9.995 - 0.5)).abs() < 1e-12);
        // √((999.5·2e-6)² + (3e-3)²)
        assert!((c.u_calibration_m_s2 - 0.003_604_996_7).abs() < 1e-9, "{c:?}");
        assert!((c.u_reading_m_s2 - 0.012).abs() < 1e-15);
    }

    #[test]
    fn the_converters_end_is_no_measurement_and_the_range_is_named() {
        assert_eq!(unit().compensate(2047.0), None);
        assert!(!unit().compensate(1500.0).unwrap().inside_range);
        assert!(unit().compensate(-1000.0).unwrap().inside_range);
    }
}
