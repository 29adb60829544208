//! What the user states of systematic errors.

use crate::Angle;

/// Systematic errors as stated in experiment.toml; `None`: not stated, [`super::Inputs::of`] has a default.
///
/// Standard uncertainties, but for [`Self::eccentricity`] (an amplitude), [`Self::nonlinearity_lsb`] (a limit) and
/// [`Self::resolution`] (a step).
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Systematics {
    /// Scale error `ε` of the dial, relative: the true angle is `φ (1 + ε)`.
    pub dial_scale: Option<f64>,
    /// Amplitude `e` of the dial's once-a-turn error, root mean square; its phase is unknown.
    pub eccentricity: Option<Angle>,
    /// Zero of the dial and level of the table, as errors of the sensor's own misalignment.
    pub dial_zero: Option<Angle>,
    /// Tilt `η` of the table's axis out of the horizontal.
    pub axis_tilt: Option<Angle>,
    /// Lean `ψ` of the sensitive axis out of the plane in which the table turns.
    pub sensor_lean: Option<Angle>,
    /// Largest deviation of the converter from a straight line over the measured range, LSB.
    pub nonlinearity_lsb: Option<f64>,
    /// Change of the converter's reference from calibration to use, relative.
    pub reference: Option<f64>,
    /// Step of readings that are not codes, in their own unit.
    pub resolution: Option<f64>,
    /// Change of temperature from the first to the last dwell of a run in which none was recorded, K.
    pub temperature_spread_k: Option<f64>,
    /// K2, (m/s²)/(m/s²)².
    pub k2_per_m_s2: Option<f64>,
    /// K3, (m/s²)/(m/s²)³.
    pub k3_per_m2_s4: Option<f64>,
}

impl Systematics {
    /// A bench and a sensor without any: stated, so that no default applies.
    pub const NONE: Self = Self {
        dial_scale: Some(0.0),
        eccentricity: Some(Angle::from_rad(0.0)),
        dial_zero: Some(Angle::from_rad(0.0)),
        axis_tilt: Some(Angle::from_rad(0.0)),
        sensor_lean: Some(Angle::from_rad(0.0)),
        nonlinearity_lsb: Some(0.0),
        reference: Some(0.0),
        resolution: Some(0.0),
        temperature_spread_k: Some(0.0),
        k2_per_m_s2: Some(0.0),
        k3_per_m2_s4: Some(0.0),
    };

    /// These, and where they state nothing, the others.
    #[must_use]
    pub fn or(self, under: Self) -> Self {
        Self {
            dial_scale: self.dial_scale.or(under.dial_scale),
            eccentricity: self.eccentricity.or(under.eccentricity),
            dial_zero: self.dial_zero.or(under.dial_zero),
            axis_tilt: self.axis_tilt.or(under.axis_tilt),
            sensor_lean: self.sensor_lean.or(under.sensor_lean),
            nonlinearity_lsb: self.nonlinearity_lsb.or(under.nonlinearity_lsb),
            reference: self.reference.or(under.reference),
            resolution: self.resolution.or(under.resolution),
            temperature_spread_k: self.temperature_spread_k.or(under.temperature_spread_k),
            k2_per_m_s2: self.k2_per_m_s2.or(under.k2_per_m_s2),
            k3_per_m2_s4: self.k3_per_m2_s4.or(under.k3_per_m2_s4),
        }
    }
}
