//! What a data sheet says of a type of sensor: the limits that a unit of it is held against.

use crate::STANDARD_GRAVITY_M_S2;

/// How well a number of the catalogue is known.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Mark {
    /// From memory or hearsay: compare it with the data sheet before relying on it.
    Recalled,
    /// From a second-hand source, or computed from a verified number under an assumption.
    Partly,
    /// Read in the maker's own document.
    Verified,
}

impl Mark {
    /// In a word.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Recalled => "recalled",
            Self::Partly => "partly",
            Self::Verified => "verified",
        }
    }

    /// For people: what is not verified says so.
    #[must_use]
    pub fn words(self) -> &'static str {
        match self {
            Self::Recalled => "recalled, not verified",
            Self::Partly => "only partly verified",
            Self::Verified => "verified",
        }
    }
}

/// Unit of a nominal sensitivity.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SensitivityUnit {
    /// Codes per gn: a digital sensor.
    LsbPerG,
    /// Millivolts per gn: an analogue sensor, read by a converter of its own.
    MillivoltPerG,
}

impl SensitivityUnit {
    /// As written.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::LsbPerG => "LSB/g",
            Self::MillivoltPerG => "mV/g",
        }
    }
}

/// One range, supply or setting with its sensitivity.
#[derive(Debug, Clone, PartialEq)]
pub struct SensorMode {
    /// Name, unique within the type: `+-2 g`, `5 V`.
    pub name: String,
    /// Nominal range, multiples of 9.80665 m/s².
    pub range_gn: Option<f64>,
    /// Nominal sensitivity, in [`Self::unit`].
    pub sensitivity: f64,
    /// Unit of the sensitivity.
    pub unit: SensitivityUnit,
    /// How well the sensitivity is known.
    pub mark: Mark,
    /// Largest relative deviation of a unit from it, with its own mark.
    pub tolerance: Option<(f64, Mark)>,
}

impl SensorMode {
    /// Nominal scale factor of a digital sensor, m/s² per LSB; `None` for an analogue one.
    ///
    /// ```
    /// use tumble_core::{Mark, SensitivityUnit, SensorMode};
    /// let mode = SensorMode {
    ///     name: "+-2 g".into(),
    ///     range_gn: Some(2.0),
    ///     sensitivity: 16_384.0,
    ///     unit: SensitivityUnit::LsbPerG,
    ///     mark: Mark::Verified,
    ///     tolerance: Some((0.03, Mark::Verified)),
    /// };
    /// assert!((mode.nominal_scale_m_s2_per_lsb().unwrap() - 5.985_504e-4).abs() < 1e-10);
    /// ```
    #[must_use]
    pub fn nominal_scale_m_s2_per_lsb(&self) -> Option<f64> {
        (self.unit == SensitivityUnit::LsbPerG).then(|| STANDARD_GRAVITY_M_S2 / self.sensitivity)
    }

    /// Nominal scale factor for readings in a unit, m/s² per that unit; `None` where a converter that the
    /// catalogue does not know stands in between.
    #[must_use]
    pub fn nominal_scale_m_s2_per(&self, reading_unit: &str) -> Option<f64> {
        let per_g = match (reading_unit, self.unit) {
            ("LSB", SensitivityUnit::LsbPerG) | ("mV", SensitivityUnit::MillivoltPerG) => {
                self.sensitivity
            }
            ("V", SensitivityUnit::MillivoltPerG) => self.sensitivity / 1000.0,
            // Readings that the driver or the user converted with the nominal sensitivity.
            ("g", _) => 1.0,
            ("mg", _) => 1000.0,
            ("m/s²" | "m/s2" | "m/s^2", _) => STANDARD_GRAVITY_M_S2,
            _ => return None,
        };
        Some(STANDARD_GRAVITY_M_S2 / per_g)
    }
}

/// What a limit is a limit of.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum LimitOf {
    /// Output at zero acceleration, beside its nominal value.
    ZeroG,
    /// Its change with temperature.
    ZeroGTempco,
    /// Change of the sensitivity with temperature.
    ScaleTempco,
    /// Noise, one-sided spectral density.
    NoiseDensity,
    /// Deviation from a straight line, of full scale.
    Nonlinearity,
    /// Response to acceleration across the axis.
    CrossAxis,
    /// Axis against the package.
    Alignment,
    /// Bits of the output word that mean something.
    Resolution,
}

impl LimitOf {
    /// All, in the order of every list.
    pub const ALL: [Self; 8] = [
        Self::ZeroG,
        Self::ZeroGTempco,
        Self::ScaleTempco,
        Self::NoiseDensity,
        Self::Nonlinearity,
        Self::CrossAxis,
        Self::Alignment,
        Self::Resolution,
    ];

    /// Name in a catalogue.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::ZeroG => "zero-g",
            Self::ZeroGTempco => "zero-g tempco",
            Self::ScaleTempco => "scale tempco",
            Self::NoiseDensity => "noise density",
            Self::Nonlinearity => "nonlinearity",
            Self::CrossAxis => "cross-axis",
            Self::Alignment => "alignment",
            Self::Resolution => "resolution",
        }
    }

    /// Unit of its numbers.
    #[must_use]
    pub fn unit(self) -> &'static str {
        match self {
            Self::ZeroG => "mg",
            Self::ZeroGTempco => "mg/K",
            Self::ScaleTempco => "%/K",
            Self::NoiseDensity => "ug/rtHz",
            Self::Nonlinearity => "% FS",
            Self::CrossAxis => "%",
            Self::Alignment => "deg",
            Self::Resolution => "bit",
        }
    }
}

/// One limit of a type. Symmetric: `±` is meant wherever a sign can be.
#[derive(Debug, Clone, PartialEq)]
pub struct TypeLimit {
    /// Of what.
    pub of: LimitOf,
    /// Axes that it holds for, `XY`; `None`: all.
    pub axes: Option<String>,
    /// Mode that it holds for; `None`: all.
    pub mode: Option<String>,
    /// Typical size, in the unit of [`Self::of`].
    pub typical: Option<f64>,
    /// Largest size, in the same unit.
    pub maximum: Option<f64>,
    /// How well it is known.
    pub mark: Mark,
    /// Conditions, or how it was computed.
    pub note: String,
}

/// A typical value is a standard deviation or so; what is beyond three of them is worth a warning.
pub(crate) const TYPICAL_TO_LIMIT: f64 = 3.0;

impl TypeLimit {
    /// Largest size that a unit of the type may show: the maximum, else three times the typical size.
    #[must_use]
    pub fn bound(&self) -> Option<f64> {
        self.maximum.or(self.typical.map(|t| TYPICAL_TO_LIMIT * t))
    }
}

/// A type of sensor with what its data sheet says.
#[derive(Debug, Clone, PartialEq)]
pub struct SensorType {
    /// Model.
    pub model: String,
    /// Where the numbers come from.
    pub source: String,
    /// Which catalogue it stands in, for people: `built-in`, or a file.
    pub catalogue: String,
    /// Whether sensitivity and zero follow the supply.
    pub ratiometric: bool,
    /// Ranges, supplies or settings, at least one.
    pub modes: Vec<SensorMode>,
    /// Limits.
    pub limits: Vec<TypeLimit>,
}

impl SensorType {
    /// Limits of one kind that may hold for an axis and a mode. Where the axis (or mode) is unknown, those of all.
    pub fn limits_for<'a>(
        &'a self,
        of: LimitOf,
        axis: Option<char>,
        mode: Option<&'a str>,
    ) -> impl Iterator<Item = &'a TypeLimit> + 'a {
        self.limits.iter().filter(move |l| {
            let axis_fits = match (&l.axes, axis) {
                (Some(axes), Some(axis)) => axes.contains(axis),
                _ => true,
            };
            let mode_fits = match (&l.mode, mode) {
                (Some(own), Some(mode)) => own == mode,
                _ => true,
            };
            l.of == of && axis_fits && mode_fits
        })
    }
}

/// The axis that a free text means: `X`, `-y`, `axis Z`. `None` where it is none of the three.
#[must_use]
pub(crate) fn axis_letter(text: &str) -> Option<char> {
    let upper = text.to_uppercase();
    let mut words =
        upper.split(|c: char| !c.is_alphanumeric()).filter(|w| !w.is_empty() && *w != "AXIS");
    match (words.next(), words.next()) {
        (Some("X"), None) => Some('X'),
        (Some("Y"), None) => Some('Y'),
        (Some("Z"), None) => Some('Z'),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mode(sensitivity: f64, unit: SensitivityUnit) -> SensorMode {
        SensorMode {
            name: "m".into(),
            range_gn: None,
            sensitivity,
            unit,
            mark: Mark::Verified,
            tolerance: None,
        }
    }

    #[test]
    fn nominal_scales_by_unit_of_reading() {
        use SensitivityUnit::{LsbPerG, MillivoltPerG};
        let gn = STANDARD_GRAVITY_M_S2;
        for (sensitivity, unit, reading, expected) in [
            (256.0, LsbPerG, "LSB", Some(gn / 256.0)),
            (1000.0, MillivoltPerG, "V", Some(gn)),
            (560.0, MillivoltPerG, "mV", Some(gn / 560.0)),
            (560.0, MillivoltPerG, "g", Some(gn)),
            (256.0, LsbPerG, "mg", Some(gn / 1000.0)),
            (256.0, LsbPerG, "m/s²", Some(1.0)),
            // Through a converter that is not known, or the wrong way round.
            (1000.0, MillivoltPerG, "LSB", None),
            (256.0, LsbPerG, "V", None),
            (256.0, LsbPerG, "furlong", None),
        ] {
            let found = mode(sensitivity, unit).nominal_scale_m_s2_per(reading);
            assert_eq!(found, expected, "{sensitivity} {unit:?} in {reading}");
        }
        assert_eq!(mode(1000.0, MillivoltPerG).nominal_scale_m_s2_per_lsb(), None);
    }

    #[test]
    fn axes_are_understood_or_not() {
        for (text, axis) in [
            ("X", Some('X')),
            (" -y", Some('Y')),
            ("axis Z", Some('Z')),
            ("z-axis", Some('Z')),
            ("", None),
            ("XY", None),
            ("roll", None),
            ("X Y", None),
        ] {
            assert_eq!(axis_letter(text), axis, "{text}");
        }
    }
}
