//! Local gravity.

/// Local gravity with its standard uncertainty.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Gravity {
    /// `g`, m/s².
    pub value_m_s2: f64,
    /// `u(g)`, m/s².
    pub standard_uncertainty_m_s2: f64,
    /// How it is known.
    pub source: GravitySource,
}

/// How local gravity is known.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum GravitySource {
    /// Given, with its uncertainty.
    Stated,
    /// Given without an uncertainty: taken as exact, and said so.
    StatedWithoutUncertainty,
    /// Normal gravity of the WGS 84 ellipsoid.
    Normal {
        /// Geodetic latitude, degrees, north positive.
        latitude_deg: f64,
        /// Height above the ellipsoid, m.
        height_m: f64,
    },
}

impl Gravity {
    /// Normal gravity of the WGS 84 ellipsoid at a latitude and height.
    ///
    /// **Model** `γ0 = γe (1 + k sin²φ)/√(1 − e² sin²φ)`,
    /// `γ = γ0 [1 − (2/a)(1 + f + m − 2 f sin²φ) h + 3 h²/a²]`.
    ///
    /// **Uncertainty** what the real field differs from the formula by: rectangular ±5e-4 m/s² below 500 m
    /// (29 ppm standard), ±1e-3 below 2000 m (59 ppm), ±2e-3 above, where anomalies reach hundreds of mGal.
    ///
    /// **Source** NIMA TR8350.2; bounds after NPL and PTB (metrology notes, section 3).
    ///
    /// ```
    /// use tumble_core::Gravity;
    /// let kharkiv = Gravity::normal(49.9935, 152.0);
    /// assert!((kharkiv.value_m_s2 - 9.810_227).abs() < 1e-6);
    /// assert!((Gravity::normal(45.0, 1000.0).value_m_s2 - 9.803_112_944).abs() < 1e-9);
    /// ```
    #[must_use]
    pub fn normal(latitude_deg: f64, height_m: f64) -> Self {
        const A: f64 = 6_378_137.0;
        const F: f64 = 1.0 / 298.257_223_563;
        const E2: f64 = 0.006_694_379_990_14;
        const GAMMA_E: f64 = 9.780_325_335_9;
        const K: f64 = 0.001_931_852_646_40;
        const M: f64 = 0.003_449_786_506_84;
        let s2 = latitude_deg.to_radians().sin().powi(2);
        let at_zero = GAMMA_E * (1.0 + K * s2) / (1.0 - E2 * s2).sqrt();
        let value_m_s2 = at_zero
            * (1.0 - 2.0 / A * (1.0 + F + M - 2.0 * F * s2) * height_m
                + 3.0 * (height_m / A).powi(2));
        let half_width = match height_m {
            h if h < 500.0 => 5e-4,
            h if h < 2000.0 => 1e-3,
            _ => 2e-3,
        };
        Self {
            value_m_s2,
            standard_uncertainty_m_s2: half_width / 3f64.sqrt(),
            source: GravitySource::Normal { latitude_deg, height_m },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn normal_gravity_of_the_tables() {
        for (latitude, gamma) in [
            (0.0, 9.780_325_335_9),
            (30.0, 9.793_247_269_2),
            (45.0, 9.806_197_769_3),
            (50.0, 9.810_702_135_6),
            (60.0, 9.819_176_953_1),
            (90.0, 9.832_184_937_8),
        ] {
            assert!(
                (Gravity::normal(latitude, 0.0).value_m_s2 - gamma).abs() < 2e-10,
                "{latitude}"
            );
        }
    }

    #[test]
    fn a_measured_value_lies_inside_what_the_formula_claims() {
        // NBS Gaithersburg 1965, absolute: 52 mGal above the formula. ±50 mGal is typical, not a bound.
        let formula = Gravity::normal(39.13, 135.0);
        let z = (9.801_018 - formula.value_m_s2) / formula.standard_uncertainty_m_s2;
        assert!(z.abs() < 2.0, "{z}");
    }
}
