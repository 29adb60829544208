//! The three sensors of the paper, as far as its figures can be read.

use super::Truth;
use super::plan::parse_plan;
use crate::{Angle, ConverterEnds, Quantizer};

/// A known bench with a known sensor.
///
/// **Source** method section 13: bias in LSB, misalignment zero, 0.55′ of setting scatter, 1.2 LSB of noise.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Preset {
    /// Bias 0.08 LSB, scale error 0.01.
    Paper1,
    /// Bias 0.37 LSB, scale error 0.024.
    Paper2,
    /// Bias −0.82 LSB, scale error 0.001: the sensor of "0.9 → 0.2 LSB".
    Paper3,
}

impl Preset {
    /// Bias in LSB and relative scale error, as printed in the paper's table.
    #[must_use]
    pub fn printed_errors(self) -> (f64, f64) {
        match self {
            Self::Paper1 => (0.08, 0.01),
            Self::Paper2 => (0.37, 0.024),
            Self::Paper3 => (-0.82, 0.001),
        }
    }

    /// The whole bench.
    #[must_use]
    pub fn truth(self) -> Truth {
        let k0 = 0.007_69;
        let (bias_lsb, scale_error) = self.printed_errors();
        Truth {
            gravity_m_s2: 9.81,
            nominal_scale_m_s2_per_lsb: k0,
            bias_m_s2: bias_lsb * k0,
            misalignment: Angle::from_rad(0.0),
            scale_error,
            k2_per_m_s2: 0.0,
            k3_per_m2_s4: 0.0,
            noise_m_s2: 1.2 * k0,
            random_walk_m_s2_rts: 0.0,
            turn_on_m_s2: 0.0,
            bias_per_k_m_s2: 0.0,
            scale_sign: 0.0,
            scale_per_k: 0.0,
            temperature_degc: None,
            setting_scatter: Angle::from_arcmin(0.55),
            dial_zero: Angle::from_rad(0.0),
            dial_scale: 0.0,
            eccentricity: Angle::from_rad(0.0),
            eccentricity_phase: Angle::from_rad(0.0),
            axis_tilt: Angle::from_rad(0.0),
            sensor_lean: Angle::from_rad(0.0),
            vertical_lean: Angle::from_arcmin(0.0),
            upright_in_each_run: false,
            quantizer: Quantizer::Truncate,
            ends: ConverterEnds::default(),
            angles_deg: parse_plan("paper").unwrap_or_default(),
            dwell_s: 30.0,
            rate_hz: 50.0,
            runs: 5,
            seed: 1,
        }
    }
}
