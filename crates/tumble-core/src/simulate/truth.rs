//! What the simulation knows and the estimation must find.

use crate::{Angle, ConverterEnds, Quantizer};

/// A sensor, a table and a plan, with every error known.
///
/// **Model** `φ* = φ (1 + ε_dial) + zero + e sin(φ + phase) + scatter + Δφ`,
/// `a = g (cos ψ cos η sin φ* + sin ψ sin η)`, upright `a = ±g cos(lean)`,
/// `x = (a + K2 a² + K3 a³ + ½ K1′ |a| + s_T (T − T̄) a + Δa + turn-on + c_T (T − T̄) + walk + noise) / (k0 (1 + δk))`,
/// code `= Q[x]`.
#[derive(Debug, Clone, PartialEq)]
pub struct Truth {
    /// `g`, m/s².
    pub gravity_m_s2: f64,
    /// `k0`, m/s² per LSB.
    pub nominal_scale_m_s2_per_lsb: f64,
    /// `Δa`, m/s².
    pub bias_m_s2: f64,
    /// `Δφ`.
    pub misalignment: Angle,
    /// `δk`.
    pub scale_error: f64,
    /// K2, (m/s²)/(m/s²)².
    pub k2_per_m_s2: f64,
    /// K3, (m/s²)/(m/s²)³.
    pub k3_per_m2_s4: f64,
    /// Scale factor for positive minus that for negative accelerations, relative.
    pub scale_sign: f64,
    /// White noise of a single sample, m/s².
    pub noise_m_s2: f64,
    /// Random walk of the bias within a run, m/s² per √s.
    pub random_walk_m_s2_rts: f64,
    /// Standard deviation of the bias between power-ups, m/s².
    pub turn_on_m_s2: f64,
    /// Bias per kelvin, m/s²/K.
    pub bias_per_k_m_s2: f64,
    /// Scale factor per kelvin, relative.
    pub scale_per_k: f64,
    /// Temperature at the start and the end of a run; recorded when given.
    pub temperature_degc: Option<(f64, f64)>,
    /// Random error of setting an angle, standard.
    pub setting_scatter: Angle,
    /// Zero error of the dial.
    pub dial_zero: Angle,
    /// Scale error of the dial, relative.
    pub dial_scale: f64,
    /// Eccentricity of the dial: amplitude of its once-a-turn error.
    pub eccentricity: Angle,
    /// Phase of the eccentricity.
    pub eccentricity_phase: Angle,
    /// Tilt `η` of the table's axis out of the horizontal.
    pub axis_tilt: Angle,
    /// Lean `ψ` of the sensitive axis out of the plane in which the table turns.
    pub sensor_lean: Angle,
    /// Standard deviation of the lean of upright dwells.
    pub vertical_lean: Angle,
    /// Whether dwells with the axis up and down are taken in each run's power-up.
    pub upright_in_each_run: bool,
    /// The converter's rounding.
    pub quantizer: Quantizer,
    /// The converter's ends: codes beyond come out as the end.
    pub ends: ConverterEnds,
    /// Table angles of a run in order, degrees.
    pub angles_deg: Vec<f64>,
    /// Length of a dwell, s.
    pub dwell_s: f64,
    /// Samples per second.
    pub rate_hz: f64,
    /// Number of runs.
    pub runs: u32,
    /// Seed of all random numbers.
    pub seed: u64,
}

/// A truth that cannot be simulated.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum TruthError {
    /// A quantity that must be positive and finite is not.
    NotPositive {
        /// Name.
        name: &'static str,
        /// Value.
        value: f64,
    },
    /// A quantity is not a number, or infinite.
    NotFinite {
        /// Name.
        name: &'static str,
    },
    /// A standard deviation is negative.
    Negative {
        /// Name.
        name: &'static str,
        /// Value.
        value: f64,
    },
    /// No angles, no runs or no samples.
    Empty {
        /// What is missing.
        what: &'static str,
    },
    /// More samples than a simulation should write.
    TooLarge {
        /// Samples asked for.
        samples: f64,
        /// Largest number.
        limit: f64,
    },
}

impl std::fmt::Display for TruthError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::NotPositive { name, value } => {
                write!(f, "{name} = {value}; give a positive number")
            }
            Self::NotFinite { name } => {
                write!(f, "{name} is infinite or no number; give a finite one")
            }
            Self::Negative { name, value } => write!(f, "{name} = {value}; give zero or more"),
            Self::Empty { what } => write!(f, "nothing to simulate: no {what}; give at least one"),
            Self::TooLarge { samples, limit } => {
                write!(
                    f,
                    "{samples:.0} samples are more than {limit:.0}; shorten the dwell or the plan"
                )
            }
        }
    }
}

impl std::error::Error for TruthError {}

/// Largest number of samples of one simulation: half a gigabyte of CSV, made in memory.
const SAMPLE_LIMIT: f64 = 5e7;

impl Truth {
    /// Samples of one dwell.
    #[must_use]
    pub fn samples_per_dwell(&self) -> u64 {
        (self.dwell_s * self.rate_hz).round().max(0.0) as u64
    }

    /// `k* = k0 (1 + δk)`, m/s² per LSB.
    #[must_use]
    pub fn actual_scale_m_s2_per_lsb(&self) -> f64 {
        self.nominal_scale_m_s2_per_lsb * (1.0 + self.scale_error)
    }

    /// Checks that it can be simulated.
    pub fn check(&self) -> Result<(), TruthError> {
        let positive = [
            ("gravity", self.gravity_m_s2),
            ("nominal scale", self.nominal_scale_m_s2_per_lsb),
            ("1 + scale error", 1.0 + self.scale_error),
            ("dwell", self.dwell_s),
            ("rate", self.rate_hz),
        ];
        let deviations = [
            ("noise", self.noise_m_s2),
            ("random walk", self.random_walk_m_s2_rts),
            ("turn-on spread", self.turn_on_m_s2),
            ("setting scatter", self.setting_scatter.rad()),
            ("vertical lean", self.vertical_lean.rad()),
        ];
        let others = [
            ("bias", self.bias_m_s2),
            ("misalignment", self.misalignment.rad()),
            ("K2", self.k2_per_m_s2),
            ("K3", self.k3_per_m2_s4),
            ("scale by sign", self.scale_sign),
            ("scale per kelvin", self.scale_per_k),
            ("dial zero", self.dial_zero.rad()),
            ("dial scale", self.dial_scale),
            ("eccentricity", self.eccentricity.rad()),
            ("axis tilt", self.axis_tilt.rad()),
            ("sensor lean", self.sensor_lean.rad()),
            ("bias per kelvin", self.bias_per_k_m_s2),
        ];
        let all = positive.iter().chain(&deviations).chain(&others);
        if let Some((name, _)) = all.clone().find(|(_, v)| !v.is_finite()) {
            return Err(TruthError::NotFinite { name });
        }
        if self.angles_deg.iter().any(|a| !a.is_finite()) {
            return Err(TruthError::NotFinite { name: "angle" });
        }
        if let Some((name, value)) = positive.iter().find(|(_, v)| *v <= 0.0) {
            return Err(TruthError::NotPositive { name, value: *value });
        }
        if let Some((name, value)) = deviations.iter().find(|(_, v)| *v < 0.0) {
            return Err(TruthError::Negative { name, value: *value });
        }
        let samples =
            self.dwell_s * self.rate_hz * self.angles_deg.len() as f64 * f64::from(self.runs);
        match () {
            () if self.angles_deg.is_empty() => Err(TruthError::Empty { what: "angles" }),
            () if self.runs == 0 => Err(TruthError::Empty { what: "runs" }),
            () if self.samples_per_dwell() == 0 => {
                Err(TruthError::Empty { what: "samples in a dwell" })
            }
            () if samples > SAMPLE_LIMIT => {
                Err(TruthError::TooLarge { samples, limit: SAMPLE_LIMIT })
            }
            () => Ok(()),
        }
    }
}
