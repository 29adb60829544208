//! What a header says by itself: a column's likely role, and its unit.
//!
//! Used to propose and to contradict, never to read: which column is which stands in experiment.toml.

/// Units that headers name.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum HeaderUnit {
    Degrees,
    Gon,
    /// Degrees in German, gon elsewhere.
    Grad,
    Radians,
    Seconds,
    Milliseconds,
    Microseconds,
    Nanoseconds,
    /// Minutes or hours.
    LongTime,
    Volts,
    Millivolts,
    StandardGravity,
    MilliGravity,
    MetresPerSecondSquared,
    Lsb,
    Celsius,
    Fahrenheit,
    Kelvin,
}

/// What a column holds, by its name.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Role {
    Angle,
    Reading,
    Mean,
    Samples,
    Std,
    Time,
    Temperature,
    Position,
    /// Which sensor or channel a row belongs to.
    Sensor,
}

impl HeaderUnit {
    fn named(text: &str) -> Option<Self> {
        let plain: String = text
            .to_lowercase()
            .chars()
            .filter(|c| !c.is_whitespace() && !matches!(c, '^' | '*' | '·' | '.'))
            .collect();
        Some(match plain.as_str() {
            "°" | "deg" | "degree" | "degrees" | "grad°" | "º" => Self::Degrees,
            "gon" | "gradian" | "gradians" => Self::Gon,
            "grad" => Self::Grad,
            "rad" | "radian" | "radians" => Self::Radians,
            "s" | "sec" | "secs" | "second" | "seconds" | "с" => Self::Seconds,
            "ms" | "msec" | "millis" | "milliseconds" | "мс" => Self::Milliseconds,
            "us" | "µs" | "μs" | "usec" | "micros" | "microseconds" | "мкс" => {
                Self::Microseconds
            }
            "ns" | "nsec" | "nanos" | "nanoseconds" => Self::Nanoseconds,
            "v" | "volt" | "volts" | "в" => Self::Volts,
            "mv" | "millivolt" | "millivolts" | "мв" => Self::Millivolts,
            "g" | "gn" | "g's" | "gs" => Self::StandardGravity,
            "mg" => Self::MilliGravity,
            "m/s2" | "m/s²" | "ms-2" | "ms⁻²" | "m/s/s" | "mps2" | "м/с2" | "м/с²" => {
                Self::MetresPerSecondSquared
            }
            "lsb" | "count" | "counts" | "digits" | "digit" | "raw" | "codes" | "adc" => Self::Lsb,
            "°c" | "degc" | "celsius" | "c" | "ºc" => Self::Celsius,
            "°f" | "degf" | "fahrenheit" | "f" => Self::Fahrenheit,
            "k" | "kelvin" => Self::Kelvin,
            _ => return None,
        })
    }

    /// As people write it.
    pub(crate) fn text(self) -> &'static str {
        match self {
            Self::Degrees => "degrees",
            Self::Gon => "gon",
            Self::Grad => "Grad",
            Self::Radians => "radians",
            Self::Seconds => "s",
            Self::Milliseconds => "ms",
            Self::Microseconds => "µs",
            Self::Nanoseconds => "ns",
            Self::LongTime => "minutes or hours",
            Self::Volts => "V",
            Self::Millivolts => "mV",
            Self::StandardGravity => "g",
            Self::MilliGravity => "mg",
            Self::MetresPerSecondSquared => "m/s²",
            Self::Lsb => "LSB",
            Self::Celsius => "°C",
            Self::Fahrenheit => "°F",
            Self::Kelvin => "K",
        }
    }

    /// Name of the unit of real readings in experiment.toml.
    pub(crate) fn of_readings(self) -> Option<&'static str> {
        match self {
            Self::Volts => Some("V"),
            Self::Millivolts => Some("mV"),
            Self::StandardGravity => Some("g"),
            Self::MilliGravity => Some("mg"),
            Self::MetresPerSecondSquared => Some("m/s2"),
            _ => None,
        }
    }
}

/// A header in its name and its unit: `Angle [deg]`, `t_ms`, `ax (m/s^2)`, `Winkel/°`.
pub(crate) fn split_unit(header: &str) -> (&str, Option<HeaderUnit>) {
    let header = header.trim();
    for (open, close) in [('[', ']'), ('(', ')'), ('<', '>'), ('{', '}')] {
        if let Some((name, rest)) = header.split_once(open) {
            let text = rest.trim_end().trim_end_matches(close);
            // `x_min` is a minimum, `t [min]` is not.
            let long = matches!(text.trim(), "min" | "minutes" | "h" | "hours" | "hr");
            let unit = HeaderUnit::named(text).or(long.then_some(HeaderUnit::LongTime));
            if unit.is_some() {
                return (name.trim(), unit);
            }
        }
    }
    for separator in [" in ", "_", "/", ",", " "] {
        let cut = match separator {
            // `m/s2` holds a slash itself: the unit begins at the first one.
            "/" => header.split_once('/'),
            _ => header.rsplit_once(separator),
        };
        if let Some((name, unit)) = cut
            && let Some(unit) = HeaderUnit::named(unit)
            && !name.trim().is_empty()
        {
            return (name.trim(), Some(unit));
        }
    }
    (header, HeaderUnit::named(header).filter(|u| matches!(u, HeaderUnit::Lsb)))
}

/// Words by role. A header fits by its whole name or by one of its words.
const WORDS: [(Role, &[&str]); 9] = [
    (Role::Std, &["std", "stdev", "stddev", "sd", "sigma", "rms", "std_code", "streuung", "ско"]),
    (Role::Samples, &["samples", "n", "count", "num", "n_samples", "anzahl", "nsamples"]),
    (
        Role::Mean,
        &[
            "mean",
            "avg",
            "average",
            "mean_code",
            "mittel",
            "mittelwert",
            "среднее",
            "moyenne",
            "media",
        ],
    ),
    (
        Role::Time,
        &[
            "t",
            "time",
            "timestamp",
            "ts",
            "t_s",
            "millis",
            "micros",
            "zeit",
            "время",
            "temps",
            "tiempo",
            "uptime",
            "tick",
            "ticks",
            "date",
            "datetime",
            "clock",
            "epoch",
            "uhrzeit",
            "datum",
            "host_time",
        ],
    ),
    (
        Role::Temperature,
        &["temperature", "temp", "temperatur", "temperature_degc", "температура", "tempc", "t_c"],
    ),
    (
        Role::Angle,
        &[
            "angle",
            "winkel",
            "phi",
            "φ",
            "угол",
            "angolo",
            "angulo",
            "ángulo",
            "tilt",
            "angle_deg",
            "dial",
            "pitch",
            "inclination",
            "neigung",
            "theta",
            "θ",
            "table",
            "incl",
            "kąt",
            "deg",
            "alpha",
            "setpoint",
            "platform",
        ],
    ),
    (
        Role::Position,
        &[
            "position",
            "pos",
            "dwell",
            "step",
            "nr",
            "no",
            "index",
            "point",
            "punkt",
            "stufe",
            "точка",
            "pose",
        ],
    ),
    (
        Role::Sensor,
        &[
            "sensor",
            "channel",
            "serial",
            "device",
            "unit",
            "id",
            "node",
            "kanal",
            "chan",
            "датчик",
            "dev",
        ],
    ),
    (
        Role::Reading,
        &[
            "code",
            "codes",
            "adc",
            "raw",
            "counts",
            "lsb",
            "output",
            "reading",
            "value",
            "acc",
            "accel",
            "acceleration",
            "ax",
            "ay",
            "az",
            "x",
            "y",
            "z",
            "accx",
            "accy",
            "accz",
            "acc_x",
            "acc_y",
            "acc_z",
            "accel_x",
            "accel_y",
            "accel_z",
            "voltage",
            "volt",
            "u",
            "uout",
            "vout",
            "код",
            "ускорение",
            "sig",
            "signal",
            "ch0",
            "ch1",
            "ch2",
            "ch3",
            "adc0",
            "adc1",
            "beschleunigung",
            "wert",
            "axraw",
            "xout",
        ],
    ),
];

/// A column's likely role, by its name alone.
pub(crate) fn role(header: &str) -> Option<Role> {
    let (name, unit) = split_unit(header);
    let lower = name.to_lowercase();
    let whole = WORDS.iter().find(|(_, words)| words.contains(&lower.as_str()));
    let words: Vec<&str> =
        lower.split(|c: char| !c.is_alphanumeric()).filter(|w| w.chars().count() > 1).collect();
    let by_word = || WORDS.iter().find(|(_, known)| words.iter().any(|w| known.contains(w)));
    let by_name = whole.or_else(by_word).map(|(role, _)| *role);
    match (by_name, unit) {
        // `T [°C]` is no time, and `X_Value (s)` no reading: names of readings are words for anything.
        (
            Some(Role::Time | Role::Reading) | None,
            Some(HeaderUnit::Celsius | HeaderUnit::Fahrenheit | HeaderUnit::Kelvin),
        ) => Some(Role::Temperature),
        (
            Some(Role::Reading) | None,
            Some(HeaderUnit::Degrees | HeaderUnit::Gon | HeaderUnit::Grad | HeaderUnit::Radians),
        ) => Some(Role::Angle),
        (
            Some(Role::Reading) | None,
            Some(
                HeaderUnit::Seconds
                | HeaderUnit::Milliseconds
                | HeaderUnit::Microseconds
                | HeaderUnit::Nanoseconds
                | HeaderUnit::LongTime,
            ),
        ) => Some(Role::Time),
        (Some(role), _) => Some(role),
        (None, Some(_)) => Some(Role::Reading),
        (None, None) => None,
    }
}

/// The role of a known column.
pub(crate) fn role_of_known(known: &str) -> Option<Role> {
    Some(match known {
        "angle_deg" => Role::Angle,
        "code" | "output" => Role::Reading,
        "mean_code" => Role::Mean,
        "samples" => Role::Samples,
        "std_code" => Role::Std,
        "t_s" => Role::Time,
        "temperature_degc" => Role::Temperature,
        "position" => Role::Position,
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_in_headers() {
        use HeaderUnit as U;
        for (header, name, unit) in [
            ("Angle [deg]", "Angle", Some(U::Degrees)),
            ("Winkel/°", "Winkel", Some(U::Degrees)),
            ("t_ms", "t", Some(U::Milliseconds)),
            ("ax (m/s^2)", "ax", Some(U::MetresPerSecondSquared)),
            ("acc/m/s²", "acc", Some(U::MetresPerSecondSquared)),
            ("Temp. [°C]", "Temp.", Some(U::Celsius)),
            ("T in °F", "T", Some(U::Fahrenheit)),
            ("angle_gon", "angle", Some(U::Gon)),
            ("Zeit [min]", "Zeit", Some(U::LongTime)),
            ("acc_min", "acc_min", None),
            ("Winkel [Grad]", "Winkel", Some(U::Grad)),
            ("acc_x", "acc_x", None),
            ("code", "code", None),
            ("ADC", "ADC", Some(U::Lsb)),
            ("", "", None),
            ("s", "s", None),
        ] {
            assert_eq!(split_unit(header), (name, unit), "{header}");
        }
    }

    #[test]
    fn roles_by_name() {
        for (header, expected) in [
            ("Angle [deg]", Some(Role::Angle)),
            ("Winkel", Some(Role::Angle)),
            ("Table angle", Some(Role::Angle)),
            ("time (ms)", Some(Role::Time)),
            ("T [°C]", Some(Role::Temperature)),
            ("X_Value (s)", Some(Role::Time)),
            ("Wert [Grad]", Some(Role::Angle)),
            ("Temp_degC", Some(Role::Temperature)),
            ("acc_x", Some(Role::Reading)),
            ("ADC raw", Some(Role::Reading)),
            ("Mean code", Some(Role::Mean)),
            ("Std dev", Some(Role::Std)),
            ("battery", None),
            ("угол", Some(Role::Angle)),
        ] {
            assert_eq!(role(header), expected, "{header}");
        }
    }
}
