//! Angles as dials and people write them: degrees, degrees minutes seconds, gon, radians.

use super::number::{DecimalSign, real};

/// Unit of the dial.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(crate) enum AngleUnit {
    /// Decimal degrees.
    #[default]
    Degrees,
    /// Degrees, minutes, seconds: `-12 30 15`, `-12:30:15`, `-12°30'15"`.
    DegreesMinutesSeconds,
    /// 400 to the full circle.
    Gon,
    Radians,
}

impl AngleUnit {
    pub(crate) const ALL: [Self; 4] =
        [Self::Degrees, Self::DegreesMinutesSeconds, Self::Gon, Self::Radians];

    /// Name in experiment.toml.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Degrees => "deg",
            Self::DegreesMinutesSeconds => "dms",
            Self::Gon => "gon",
            Self::Radians => "rad",
        }
    }

    pub(crate) fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|u| u.name() == name)
    }

    /// Degrees per unit.
    pub(crate) fn in_deg(self) -> f64 {
        match self {
            Self::Degrees | Self::DegreesMinutesSeconds => 1.0,
            Self::Gon => 0.9,
            Self::Radians => 180.0 / core::f64::consts::PI,
        }
    }

    /// The dial's reading in its own unit. Degrees may carry their marks: `-12°30'`.
    pub(crate) fn value(self, field: &[u8], decimal: DecimalSign) -> Option<f64> {
        match self {
            Self::DegreesMinutesSeconds => dms(field, decimal),
            Self::Degrees => real(field, decimal)
                .or_else(|| has_marks(field).then(|| dms(field, decimal)).flatten()),
            _ => real(field, decimal),
        }
    }

    pub(crate) fn expected(self) -> &'static str {
        match self {
            Self::Degrees => "an angle in degrees",
            Self::DegreesMinutesSeconds => "an angle in degrees, minutes and seconds",
            Self::Gon => "an angle in gon",
            Self::Radians => "an angle in radians",
        }
    }
}

/// Marks that only angles carry. A lone 0xB0 is the degree sign of Windows code pages.
fn has_marks(field: &[u8]) -> bool {
    let text = String::from_utf8_lossy(field);
    field.contains(&0xb0) || text.contains(['°', '\'', '′', '"', '″', '’', '”'])
}

/// Degrees, minutes, seconds: one sign in front, minutes and seconds below 60, only the last part with decimals.
pub(crate) fn dms(field: &[u8], decimal: DecimalSign) -> Option<f64> {
    const LONGEST: usize = 40;
    if field.len() > LONGEST {
        return None;
    }
    let latin: String = match std::str::from_utf8(field) {
        Ok(text) => text.to_owned(),
        Err(_) => field.iter().map(|b| char::from(*b)).collect(),
    };
    // Marks of seconds stand behind; quotes in front are those of the field.
    let text = latin.trim().trim_start_matches('"').replace('−', "-");
    let (negative, rest) = match (text.strip_prefix('-'), text.strip_prefix('+')) {
        (Some(rest), _) => (true, rest),
        (None, Some(rest)) => (false, rest),
        (None, None) => (false, text.as_str()),
    };
    let separator = |c: char| {
        c.is_whitespace()
            || matches!(c, ':' | '°' | '\'' | '′' | '"' | '″' | '’' | '”' | 'd' | 'm' | 's')
    };
    let parts: Vec<&str> = rest.split(separator).filter(|p| !p.is_empty()).collect();
    if parts.is_empty() || parts.len() > 3 {
        return None;
    }
    let mut value = 0.0;
    for (i, (part, weight)) in parts.iter().zip([1.0, 60.0, 3600.0]).enumerate() {
        let last = i + 1 == parts.len();
        if !part.starts_with(|c: char| c.is_ascii_digit())
            || (!last && !part.bytes().all(|b| b.is_ascii_digit()))
        {
            return None;
        }
        let number = real(part.as_bytes(), decimal)?;
        if i > 0 && number >= 60.0 {
            return None;
        }
        value += number / weight;
    }
    Some(if negative { -value } else { value })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn degrees_minutes_seconds() {
        let value = |t: &str| dms(t.as_bytes(), DecimalSign::CommaOrPoint);
        let expected = -(12.0 + 30.0 / 60.0 + 15.0 / 3600.0);
        for text in
            ["-12 30 15", "-12:30:15", "-12°30'15\"", "−12° 30′ 15″", "-12d30m15s", "-12°30,25'"]
        {
            assert!((value(text).unwrap() - expected).abs() < 1e-12, "{text}");
        }
        // The sign of a negative angle below one degree stands in front of a zero.
        assert_eq!(value("-0 30 0"), Some(-0.5));
        for wrong in ["", "12 61", "12 30 60", "1.5 30", "12 -30", "1 2 3 4", "x", "12 e5"] {
            assert_eq!(value(wrong), None, "{wrong}");
        }
        assert_eq!(dms(b"12\xb030", DecimalSign::Point), Some(12.5));
        assert_eq!(value("\"-12°30'15\"\"\""), Some(-12.504_166_666_666_667));
    }

    #[test]
    fn units_of_the_dial() {
        let point = DecimalSign::Point;
        assert_eq!(AngleUnit::Degrees.value(b"12.5\xc2\xb0", point), Some(12.5));
        assert_eq!(AngleUnit::Degrees.value(b"12:30", point), None);
        assert_eq!(AngleUnit::DegreesMinutesSeconds.value(b"12:30", point), Some(12.5));
        assert_eq!(
            AngleUnit::Gon.value(b"100", point).map(|v| v * AngleUnit::Gon.in_deg()),
            Some(90.0)
        );
        assert!((AngleUnit::Radians.in_deg() - 57.295_779_513_082_32).abs() < 1e-12);
    }
}
