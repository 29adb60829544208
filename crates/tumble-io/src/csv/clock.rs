//! Times in fields: seconds and parts of them, dates, times of day.

use jiff::civil::{DateTime, Time};
use jiff::{Timestamp, tz::Offset};

use super::number::{DecimalSign, real};

/// Unit of the column `t_s`.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum TimeUnit {
    /// s
    #[default]
    Seconds,
    /// ms
    Milliseconds,
    /// us
    Microseconds,
    /// ns
    Nanoseconds,
    /// ISO 8601, `dd.mm.yyyy hh:mm:ss`, or a time of day.
    Date,
}

impl TimeUnit {
    pub(crate) const ALL: [Self; 5] =
        [Self::Seconds, Self::Milliseconds, Self::Microseconds, Self::Nanoseconds, Self::Date];

    /// Name in experiment.toml.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Seconds => "s",
            Self::Milliseconds => "ms",
            Self::Microseconds => "us",
            Self::Nanoseconds => "ns",
            Self::Date => "date",
        }
    }

    pub(crate) fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|u| u.name() == name)
    }

    fn per_second(self) -> f64 {
        match self {
            Self::Seconds | Self::Date => 1.0,
            Self::Milliseconds => 1e3,
            Self::Microseconds => 1e6,
            Self::Nanoseconds => 1e9,
        }
    }

    /// A field as seconds from an origin that all fields of a file share.
    pub(crate) fn seconds(self, field: &[u8], decimal: DecimalSign) -> Option<f64> {
        match self {
            Self::Date => date_s(field),
            unit => real(field, decimal).map(|t| t / unit.per_second()),
        }
    }

    pub(crate) fn expected(self) -> &'static str {
        match self {
            Self::Seconds => "a time in seconds",
            Self::Milliseconds => "a time in milliseconds",
            Self::Microseconds => "a time in microseconds",
            Self::Nanoseconds => "a time in nanoseconds",
            Self::Date => {
                "a date and time (2026-11-20T10:15:30.25, 20.11.2026 10:15:30, 10:15:30.25)"
            }
        }
    }
}

/// Longest text that is looked at as a date.
const LONGEST_DATE: usize = 48;

/// A date as seconds since 1970, UTC where an offset is given, else as if it were; a time of day as seconds since midnight.
pub(crate) fn date_s(field: &[u8]) -> Option<f64> {
    if field.len() < 5 || field.len() > LONGEST_DATE || !field[0].is_ascii_digit() {
        return None;
    }
    let text = std::str::from_utf8(field).ok()?.replace(',', ".");
    if let Ok(instant) = text.parse::<Timestamp>() {
        return Some(since_1970(instant));
    }
    let civil = text
        .parse::<DateTime>()
        .ok()
        .filter(|_| text.contains(':'))
        .or_else(|| DateTime::strptime("%d.%m.%Y %H:%M:%S%.f", &text).ok())
        .or_else(|| DateTime::strptime("%d.%m.%Y %H:%M", &text).ok())
        .or_else(|| DateTime::strptime("%Y/%m/%d %H:%M:%S%.f", &text).ok());
    if let Some(civil) = civil {
        let instant = Offset::UTC.to_timestamp(civil).ok()?;
        return Some(since_1970(instant));
    }
    let time = text.parse::<Time>().ok().or_else(|| Time::strptime("%H:%M:%S%.f", &text).ok())?;
    let nanoseconds = time.since(Time::midnight()).ok()?.total(jiff::Unit::Nanosecond).ok()?;
    Some(nanoseconds / 1e9)
}

/// Whole seconds stay whole.
fn since_1970(instant: Timestamp) -> f64 {
    instant.as_second() as f64 + f64::from(instant.subsec_nanosecond()) / 1e9
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parsed(text: &str) -> Option<f64> {
        TimeUnit::Date.seconds(text.as_bytes(), DecimalSign::Point)
    }

    #[test]
    fn dates() {
        let base = parsed("2026-11-20T10:15:30").unwrap();
        assert_eq!(base, 1_795_169_730.0);
        for same in [
            "2026-11-20 10:15:30",
            "2026-11-20T10:15:30Z",
            "2026-11-20T12:15:30+02:00",
            "20.11.2026 10:15:30",
            "2026/11/20 10:15:30",
            "2026-11-20T10:15:30,000",
        ] {
            assert_eq!(parsed(same), Some(base), "{same}");
        }
        assert!((parsed("2026-11-20T10:15:30.25").unwrap() - base - 0.25).abs() < 1e-6);
        assert_eq!(parsed("10:15:30.5"), Some(36_930.5));
        // Nanoseconds times 1e-9 gave 3661.0000000000005.
        assert_eq!(parsed("01:01:01"), Some(3661.0));
        for wrong in
            ["", "11/20/2026 10:15", "2026-13-01T00:00:00", "25:00:00", "2026-11-20", "1.5"]
        {
            assert_eq!(parsed(wrong), None, "{wrong}");
        }
    }

    #[test]
    fn parts_of_seconds() {
        let ms = TimeUnit::Milliseconds.seconds(b"1795169730250", DecimalSign::Point).unwrap();
        assert!((ms - 1_795_169_730.25).abs() < 1e-6);
        assert_eq!(TimeUnit::named("us"), Some(TimeUnit::Microseconds));
        assert_eq!(TimeUnit::named("h"), None);
    }
}
