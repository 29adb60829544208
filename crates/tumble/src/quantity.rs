//! Numbers with units on the command line: `-0.82LSB`, `3arcmin`, `110ug/rtHz`.

use tumble_core::plan::Term;
use tumble_core::{Angle, STANDARD_GRAVITY_M_S2};

/// An acceleration: in m/s², or in LSB of the nominal scale.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum AccelerationArg {
    MS2(f64),
    Lsb(f64),
}

impl AccelerationArg {
    pub(crate) fn m_s2(self, nominal_scale: f64) -> f64 {
        match self {
            Self::MS2(v) => v,
            Self::Lsb(v) => v * nominal_scale,
        }
    }
}

/// Splits a number from its unit.
fn split(text: &str) -> Result<(f64, &str), String> {
    let text = text.trim().replace('−', "-");
    // "1e-3g": an `e` belongs to the number only when digits follow.
    let ends = (0..=text.len()).rev().filter(|i| text.is_char_boundary(*i));
    for end in ends {
        if let Ok(value) = text[..end].trim().parse::<f64>()
            && value.is_finite()
            && text[..end].ends_with(|c: char| c.is_ascii_digit() || c == '.')
        {
            let unit_at = text.len() - text[end..].trim_start().len();
            // The unit is one of a few constants: give back a static one.
            let unit = UNITS.iter().find(|u| **u == &text[unit_at..]);
            return unit.map(|u| (value, *u)).ok_or_else(|| {
                format!("unit `{}` is not known; units are {}", &text[unit_at..], UNITS.join(" "))
            });
        }
    }
    Err(format!(
        "`{text}` does not start with a number; give one with its unit, for instance 3arcmin or 8mg"
    ))
}

const UNITS: [&str; 20] = [
    "",
    "m/s2",
    "mm/s2",
    "g",
    "mg",
    "ug",
    "LSB",
    "rad",
    "mrad",
    "deg",
    "arcmin",
    "arcsec",
    "%",
    "ppm",
    "m/s2/rtHz",
    "mg/rtHz",
    "ug/rtHz",
    "m/s2/rts",
    "1/(m/s2)",
    "ug/g2",
];

fn wrong_unit(unit: &str, expected: &str) -> String {
    let unit = if unit.is_empty() { "no unit" } else { unit };
    format!("{unit} does not fit here; give {expected}")
}

/// `0.05m/s2`, `5mm/s2`, `-8mg`, `-0.82LSB`.
pub(crate) fn acceleration(text: &str) -> Result<AccelerationArg, String> {
    let (v, unit) = split(text)?;
    match unit {
        "m/s2" => Ok(AccelerationArg::MS2(v)),
        "mm/s2" => Ok(AccelerationArg::MS2(v * 1e-3)),
        "g" => Ok(AccelerationArg::MS2(v * STANDARD_GRAVITY_M_S2)),
        "mg" => Ok(AccelerationArg::MS2(v * 1e-3 * STANDARD_GRAVITY_M_S2)),
        "ug" => Ok(AccelerationArg::MS2(v * 1e-6 * STANDARD_GRAVITY_M_S2)),
        "LSB" => Ok(AccelerationArg::Lsb(v)),
        other => Err(wrong_unit(other, "m/s2, mm/s2, mg, ug or LSB, for instance -0.82LSB")),
    }
}

/// `2mrad`, `3arcmin`, `0.1deg`.
pub(crate) fn angle(text: &str) -> Result<Angle, String> {
    let (v, unit) = split(text)?;
    match unit {
        "rad" => Ok(Angle::from_rad(v)),
        "mrad" => Ok(Angle::from_rad(v * 1e-3)),
        "deg" => Ok(Angle::from_deg(v)),
        "arcmin" => Ok(Angle::from_arcmin(v)),
        "arcsec" => Ok(Angle::from_arcmin(v / 60.0)),
        "" if v == 0.0 => Ok(Angle::from_rad(0.0)),
        other => Err(wrong_unit(other, "deg, arcmin, arcsec, mrad or rad, for instance 3arcmin")),
    }
}

/// `0.01`, `1%`, `500ppm`.
pub(crate) fn ratio(text: &str) -> Result<f64, String> {
    let (v, unit) = split(text)?;
    match unit {
        "" => Ok(v),
        "%" => Ok(v * 1e-2),
        "ppm" => Ok(v * 1e-6),
        other => Err(wrong_unit(other, "a bare number, % or ppm, for instance 0.1%")),
    }
}

/// Noise of a sample (`1.2LSB`, `9mm/s2`) or a one-sided density (`110ug/rtHz`).
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum NoiseArg {
    Sample(AccelerationArg),
    /// m/s² per √Hz, one-sided.
    Density(f64),
}

impl NoiseArg {
    /// Standard deviation of a sample, m/s²: a one-sided density `n` up to half of the rate gives `n √(rate/2)`.
    pub(crate) fn m_s2(self, nominal_scale: f64, rate_hz: f64) -> f64 {
        match self {
            Self::Sample(a) => a.m_s2(nominal_scale),
            Self::Density(n) => n * (rate_hz / 2.0).sqrt(),
        }
    }
}

pub(crate) fn noise(text: &str) -> Result<NoiseArg, String> {
    let (v, unit) = split(text)?;
    match unit {
        "m/s2/rtHz" => Ok(NoiseArg::Density(v)),
        "mg/rtHz" => Ok(NoiseArg::Density(v * 1e-3 * STANDARD_GRAVITY_M_S2)),
        "ug/rtHz" => Ok(NoiseArg::Density(v * 1e-6 * STANDARD_GRAVITY_M_S2)),
        _ => acceleration(text).map(NoiseArg::Sample),
    }
}

/// Bias random walk, m/s² per √s: `1e-4m/s2/rts`.
pub(crate) fn random_walk(text: &str) -> Result<f64, String> {
    let (v, unit) = split(text)?;
    match unit {
        "m/s2/rts" => Ok(v),
        other => Err(wrong_unit(other, "m/s2/rts, for instance 1e-4m/s2/rts")),
    }
}

/// K2: `100ug/g2`, `1e-5 1/(m/s2)`.
pub(crate) fn k2(text: &str) -> Result<f64, String> {
    let (v, unit) = split(text)?;
    match unit {
        // µg per g²: 1e-6 gn / gn².
        "ug/g2" => Ok(v * 1e-6 / STANDARD_GRAVITY_M_S2),
        "1/(m/s2)" => Ok(v),
        other => Err(wrong_unit(other, "ug/g2 or 1/(m/s2), for instance 100ug/g2")),
    }
}

/// Largest expanded uncertainty of a term that still serves.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Target {
    /// Of an acceleration; perhaps in LSB.
    Acceleration(Term, AccelerationArg),
    /// In the term's own unit.
    Plain(Term, f64),
}

/// `bias=0.5mm/s2`, `scale=200ppm`, `misalignment=1mrad`, `k2=50ug/g2`.
pub(crate) fn target(text: &str) -> Result<Target, String> {
    let names = Term::ALL.map(Term::name).join(" ");
    let help = || format!("give TERM=SIZE, for instance bias=0.5mm/s2; terms are {names}");
    let (name, size) = text.split_once('=').ok_or_else(help)?;
    let name = name.trim();
    let term = Term::ALL.into_iter().find(|t| t.name().eq_ignore_ascii_case(name));
    Ok(match term.ok_or_else(help)? {
        term @ (Term::Bias | Term::BiasPerKelvin) => {
            Target::Acceleration(term, acceleration(size)?)
        }
        term @ Term::Misalignment => Target::Plain(term, angle(size)?.rad()),
        term @ (Term::ScaleError | Term::ScalePerKelvin) => Target::Plain(term, ratio(size)?),
        term @ Term::K2 => Target::Plain(term, k2(size)?),
        term @ Term::K3 => {
            let v = size.trim().parse().map_err(|_| "give K3 in 1/(m/s2)2, for instance 1e-6")?;
            Target::Plain(term, v)
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_with_units() {
        assert_eq!(acceleration("-0.82LSB"), Ok(AccelerationArg::Lsb(-0.82)));
        assert_eq!(acceleration("−5 mm/s2"), Ok(AccelerationArg::MS2(-0.005)));
        assert!((angle("3arcmin").unwrap().deg() - 0.05).abs() < 1e-15);
        assert_eq!(ratio("1e-3"), Ok(1e-3));
        assert_eq!(ratio("500ppm"), Ok(5e-4));
        assert!((k2("100ug/g2").unwrap() * STANDARD_GRAVITY_M_S2 - 1e-4).abs() < 1e-18);
        let density = noise("110ug/rtHz").unwrap().m_s2(1.0, 50.0);
        assert!((density - 110e-6 * 9.80665 * 5.0).abs() < 1e-15);
    }

    #[test]
    fn targets_have_a_term_and_a_size_that_fits_it() {
        let bias = AccelerationArg::MS2(0.5e-3);
        assert_eq!(target("bias=0.5mm/s2"), Ok(Target::Acceleration(Term::Bias, bias)));
        assert_eq!(target("scale = 0.5"), Ok(Target::Plain(Term::ScaleError, 0.5)));
        assert!(target("bias").unwrap_err().contains("TERM=SIZE"));
        assert!(target("offset=1mg").unwrap_err().contains("misalignment"));
        assert!(target("bias=1mrad").unwrap_err().contains("mm/s2"));
    }

    #[test]
    fn wrong_units_say_what_fits() {
        for wrong in ["5", "5arcmin", "x", "", "5 parsec", "nan m/s2", "e"] {
            assert!(acceleration(wrong).is_err(), "{wrong}");
        }
        assert!(angle("5mg").unwrap_err().contains("arcmin"));
        assert!(angle("0").is_ok());
    }
}
