//! What is stated for a plan: by a file, by flags, or by both.

use serde::Deserialize;
use tumble_core::plan::TERMS;
use tumble_core::systematic::Systematics;

use crate::noise::KnownNoise;

/// Everything that a plan can be told; `None`: not stated here. The first part stands in `[plan]` of a `bench.toml`.
#[derive(Debug, Clone, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct PlanSettings {
    /// Time for everything, hours.
    pub hours: Option<f64>,
    /// Number of runs.
    pub runs: Option<u32>,
    /// Length of a dwell, s.
    pub dwell_s: Option<f64>,
    /// Spare angles.
    pub spares: Option<usize>,
    /// `minimax`, `A` or `D`.
    pub criterion: Option<String>,
    /// Fitted beside bias, misalignment, scale error: `k2`, `k3`, `temp-bias`, `temp-scale`.
    pub terms: Option<Vec<String>>,
    /// Step of the dial, degrees.
    pub step_deg: Option<f64>,
    /// Time to turn the table to an angle, s.
    pub setting_s: Option<f64>,
    /// Time to let it settle, s.
    pub settle_s: Option<f64>,
    /// Time to stand the body upright, s.
    pub upright_s: Option<f64>,
    /// Time from power-up to the first dwell, s.
    pub restart_s: Option<f64>,
    /// Whether dwells up and down are possible.
    pub updown: Option<bool>,
    /// Whether the body can be turned by 180° between runs.
    pub remounting: Option<bool>,
    /// Noise, one-sided density, µg/√Hz.
    pub noise_ug_rthz: Option<f64>,
    /// Flicker, the B of the Allan variance, µg.
    pub bias_instability_ug: Option<f64>,
    /// Random walk, the K of the Allan variance, m/s² per √s.
    pub random_walk_m_s2_rts: Option<f64>,
    /// Steady drift, m/s² per hour.
    pub drift_m_s2_h: Option<f64>,
    /// Scatter between positions that is the same at all angles, m/s².
    pub level_scatter_m_s2: Option<f64>,
    /// Standard deviation of the bias between power-ups, m/s².
    pub turn_on_m_s2: Option<f64>,

    /// Errors that no scatter shows: of `[bench]`, `[sensor]` and `[output]` as everywhere, or of flags.
    #[serde(skip)]
    pub systematics: Systematics,
    /// Model of the sensor, for the catalogue.
    #[serde(skip)]
    pub sensor: Option<String>,
    /// Sensitive axis, free text.
    #[serde(skip)]
    pub axis: Option<String>,
    /// Noise as `tumble noise` found it; the figures of [`Self::noise_ug_rthz`] and the like go before.
    #[serde(skip)]
    pub known_noise: Option<KnownNoise>,
    /// Lowest and highest angle of the table, degrees.
    #[serde(skip)]
    pub range_deg: Option<[f64; 2]>,
    /// Scatter of setting an angle, minutes of arc, standard.
    #[serde(skip)]
    pub scatter_arcmin: Option<f64>,
    /// Local gravity, m/s².
    #[serde(skip)]
    pub gravity_m_s2: Option<f64>,
    /// Lean of upright dwells, minutes of arc, standard.
    #[serde(skip)]
    pub updown_lean_arcmin: Option<f64>,
    /// One LSB, m/s².
    #[serde(skip)]
    pub lsb_m_s2: Option<f64>,
    /// Samples per second.
    #[serde(skip)]
    pub rate_hz: Option<f64>,
    /// White noise, the N of the Allan variance, m/s² √s; goes before the density.
    #[serde(skip)]
    pub white_m_s2_rts: Option<f64>,
    /// Targets for expanded uncertainties, in the order of [`tumble_core::plan::Term::ALL`].
    #[serde(skip)]
    pub targets: [Option<f64>; TERMS],
    /// Level of confidence.
    #[serde(skip)]
    pub level: Option<f64>,
}

impl PlanSettings {
    /// These, and where they state nothing, the others.
    #[must_use]
    pub fn or(self, under: Self) -> Self {
        macro_rules! each {
            ($($field:ident)*) => {
                Self {
                    $($field: self.$field.or(under.$field),)*
                    // One target given anew: the others are not wanted any more.
                    targets: if self.targets.iter().any(Option::is_some) { self.targets } else { under.targets },
                    systematics: self.systematics.or(under.systematics),
                }
            };
        }
        each!(
            hours runs dwell_s spares criterion terms step_deg setting_s settle_s upright_s restart_s
            updown remounting noise_ug_rthz bias_instability_ug random_walk_m_s2_rts drift_m_s2_h level_scatter_m_s2
            turn_on_m_s2 sensor axis known_noise range_deg scatter_arcmin gravity_m_s2 updown_lean_arcmin lsb_m_s2 rate_hz white_m_s2_rts
            level
        )
    }
}
