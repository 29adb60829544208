//! The nominal scale factor `k0`.

use crate::{Experiment, Finding, FindingKind, VerticalPair};

/// `k0` and where it comes from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NominalScale {
    /// m/s² per LSB.
    pub value_m_s2_per_lsb: f64,
    /// Stated, or measured with the axis up and down.
    pub source: NominalScaleSource,
}

/// Where `k0` comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum NominalScaleSource {
    /// Given in the experiment.
    Stated,
    /// From the up/down dwells.
    UpDown,
}

/// There is no usable nominal scale factor.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum NominalScaleError {
    /// Neither stated nor measurable.
    Absent,
    /// Stated, but not a positive number.
    NotPositive {
        /// What was stated, m/s² per LSB.
        stated: f64,
    },
    /// Up reads no more than down.
    UpNotAboveDown {
        /// `N↑`, LSB.
        up_lsb: f64,
        /// `N↓`, LSB.
        down_lsb: f64,
    },
}

/// The sign trap: programs that take the pull of gravity for the acceleration, and give a sensitivity error near −200 %.
const SIGN_REMEDY: &str = "Exchange `up` and `down` in [scale]; a record of the pull of gravity (−g with the axis up) is \
                           read so, too: Tumble counts +g with the axis up, as IEEE 1293 does";

impl std::fmt::Display for NominalScaleError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Absent => write!(
                f,
                "no nominal scale factor: give `nominal_scale` (m/s² per LSB) in [output], or dwells with the \
                 axis up and down in [scale]"
            ),
            Self::NotPositive { stated } => {
                write!(
                    f,
                    "nominal_scale = {stated} is not a positive number; give m/s² per LSB (g per LSB times 9.80665)"
                )
            }
            Self::UpNotAboveDown { up_lsb, down_lsb } => write!(
                f,
                "[scale]: axis up reads {up_lsb:.4} and axis down {down_lsb:.4}; up must read more. {SIGN_REMEDY}"
            ),
        }
    }
}

impl std::error::Error for NominalScaleError {}

/// `k0 = 2 g / (N↑ − N↓)`, each mean first corrected by its quantizer's offset, m/s² per LSB.
///
/// **Source** method section 3.
///
/// ```
/// use tumble_core::{Quantizer, nominal_scale_from_means};
/// let k0 = nominal_scale_from_means(1283.41, -1267.93, Quantizer::Truncate, 9.81).unwrap();
/// assert!((k0 - 0.007_687_063_635_722_514).abs() < 1e-17);
/// assert_eq!(nominal_scale_from_means(-1267.0, 1283.0, Quantizer::Truncate, 9.81), None);
/// ```
#[must_use]
pub fn nominal_scale_from_means(
    up_mean: f64,
    down_mean: f64,
    quantizer: crate::Quantizer,
    gravity_m_s2: f64,
) -> Option<f64> {
    let span = quantizer.analogue_lsb(up_mean) - quantizer.analogue_lsb(down_mean);
    (span > 0.0).then(|| 2.0 * gravity_m_s2 / span)
}

/// Relative disagreement between a stated and a measured `k0` that is worth a warning. Data sheets state ±4 to
/// ±8 %; 10 % is beyond both.
pub(crate) const DISAGREEMENT_LIMIT: f64 = 0.10;

/// The nominal scale factor of an experiment, and what is noteworthy about it.
pub fn nominal_scale(
    experiment: &Experiment,
) -> Result<(NominalScale, Vec<Finding>), NominalScaleError> {
    let measured = experiment.vertical.as_ref().map(|p| measured(experiment, p));
    match (experiment.output.nominal_scale_m_s2_per_lsb, measured) {
        (Some(stated), _) if !(stated > 0.0 && stated.is_finite()) => {
            Err(NominalScaleError::NotPositive { stated })
        }
        (Some(stated), measured) => {
            let scale =
                NominalScale { value_m_s2_per_lsb: stated, source: NominalScaleSource::Stated };
            let findings = match measured {
                Some(Ok(k0)) if (k0 / stated - 1.0).abs() > DISAGREEMENT_LIMIT => vec![Finding {
                    kind: FindingKind::NominalScaleDisagrees,
                    place: String::from("[scale]"),
                    observed: format!("{k0:.6} m/s² per LSB from up and down, {stated:.6} stated"),
                    limit: format!("{:.0} %", DISAGREEMENT_LIMIT * 100.0),
                    remedy: String::from(
                        "check nominal_scale's unit (m/s² per LSB) and which file is up",
                    ),
                }],
                Some(Err(NominalScaleError::UpNotAboveDown { up_lsb, down_lsb })) => {
                    vec![Finding {
                        kind: FindingKind::SignReversed,
                        place: String::from("[scale]"),
                        observed: format!("axis up reads {up_lsb:.4}, axis down {down_lsb:.4}"),
                        limit: String::from("up reads more than down"),
                        remedy: SIGN_REMEDY.into(),
                    }]
                }
                _ => Vec::new(),
            };
            Ok((scale, findings))
        }
        (None, Some(measured)) => measured.map(|value_m_s2_per_lsb| {
            (NominalScale { value_m_s2_per_lsb, source: NominalScaleSource::UpDown }, Vec::new())
        }),
        (None, None) => Err(NominalScaleError::Absent),
    }
}

fn measured(experiment: &Experiment, pair: &VerticalPair) -> Result<f64, NominalScaleError> {
    let up = pair.up.readings.mean().unwrap_or(0.0);
    let down = pair.down.readings.mean().unwrap_or(0.0);
    nominal_scale_from_means(
        up,
        down,
        experiment.output.quantizer,
        experiment.bench.gravity.value_m_s2,
    )
    .ok_or(NominalScaleError::UpNotAboveDown { up_lsb: up, down_lsb: down })
}
