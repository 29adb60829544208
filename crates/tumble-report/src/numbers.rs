//! Numbers as people write them: a value to the place of its uncertainty (JCGM 100, 7.2.6).
//!
//! All functions give ASCII (`-`, `e-3`), good for copying; [`typographic`] turns that into print (`−`, `×10⁻³`).

/// Significant digits of an uncertainty.
const DIGITS: i32 = 2;
/// More decimals than these, and a common power of ten is taken out.
const MOST_DECIMALS: i32 = 6;
/// A value from this power of ten on is written with a power of ten.
const LARGEST_POWER: i32 = 6;
/// Digits that a double holds.
const DOUBLE_DIGITS: i32 = 15;
/// Stands for a number that is not there.
pub(crate) const NONE: &str = "–";

/// Several numbers rounded to one place, with a common power of ten.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Rounded {
    /// The numbers, over the power of ten.
    pub texts: Vec<String>,
    /// The power of ten, a multiple of three; mostly 0.
    pub exponent: i32,
}

impl Rounded {
    /// `e-3`, or nothing.
    fn suffix(&self) -> String {
        if self.exponent == 0 { String::new() } else { format!("e{}", self.exponent) }
    }

    /// `joined` with the power of ten behind brackets where there is one.
    fn bracketed(&self, joined: &str) -> String {
        if self.exponent == 0 { joined.to_owned() } else { format!("({joined}){}", self.suffix()) }
    }
}

/// Power of ten of the leading digit after rounding to `digits` significant ones.
fn power(v: f64, digits: i32) -> Option<i32> {
    let digits = usize::try_from(digits - 1).unwrap_or(0);
    // The formatter rounds across decades (0.0996 is 1.0e-1) and is exact.
    format!("{:.digits$e}", v.abs())
        .rsplit_once('e')?
        .1
        .parse()
        .ok()
        .filter(|_| v.is_finite() && v != 0.0)
}

/// Rounds all `values` to the place of the second significant digit of `u`. `None` without a usable `u`.
pub(crate) fn rounded_to(values: &[f64], u: f64) -> Option<Rounded> {
    let place = power(u, DIGITS)? - (DIGITS - 1);
    let largest = values.iter().fold(u.abs(), |m, v| m.max(v.abs()));
    let top = power(largest, DOUBLE_DIGITS)?;
    if top - place >= DOUBLE_DIGITS || values.iter().any(|v| !v.is_finite()) {
        return None;
    }
    let exponent =
        if place < -MOST_DECIMALS || top >= LARGEST_POWER { top.div_euclid(3) * 3 } else { 0 };
    Some(Rounded {
        texts: values.iter().map(|v| at_place(*v, place, exponent)).collect(),
        exponent,
    })
}

/// An uncertainty alone over a power of ten, to its own two significant digits.
pub(crate) fn own_digits(u: f64, exponent: i32) -> String {
    match power(u, DIGITS) {
        Some(top) => at_place(u, top - (DIGITS - 1), exponent),
        None => fixed(u, 0),
    }
}

/// `v` without a power of ten, to the place of the second significant digit of `u`. `None` where that would be
/// longer than people read.
pub(crate) fn plain(v: f64, u: f64) -> Option<String> {
    let place = power(u, DIGITS)? - (DIGITS - 1);
    let readable = power(v, DOUBLE_DIGITS)
        .is_none_or(|top| top - place < DOUBLE_DIGITS && top < LARGEST_POWER);
    (v.is_finite() && readable && place >= -DOUBLE_DIGITS).then(|| at_place(v, place, 0))
}

/// `v` over ten to the `exponent`, rounded to ten to the `place`.
fn at_place(v: f64, place: i32, exponent: i32) -> String {
    // Rounding in decimal text, from the exact value: multiplying by a power of ten first would round twice.
    let Some(top) = power(v, DOUBLE_DIGITS) else { return fixed(0.0, exponent - place) };
    let digits = top - place;
    if digits < 0 {
        // Below the place: 0 or one unit of it.
        let one = v.abs() >= 0.5 * 10f64.powi(place);
        return fixed(
            if one { v.signum() * 10f64.powi(place - exponent) } else { 0.0 },
            exponent - place,
        );
    }
    let kept = format!("{v:.*e}", usize::try_from(digits).unwrap_or(0));
    let (mantissa, power) = kept.rsplit_once('e').unwrap_or((&kept, "0"));
    let power: i32 = power.parse().unwrap_or(0);
    format!("{mantissa}e{}", power - exponent)
        .parse()
        .map_or_else(|_| NONE.to_owned(), |scaled| fixed(scaled, exponent - place))
}

/// With a number of decimals (none below 1); never `-0`.
pub(crate) fn fixed(v: f64, decimals: i32) -> String {
    if !v.is_finite() {
        return NONE.into();
    }
    let text = format!("{v:.*}", usize::try_from(decimals).unwrap_or(0).min(17));
    match text.strip_prefix('-') {
        Some(rest) if !rest.bytes().any(|b| b.is_ascii_digit() && b != b'0') => rest.to_owned(),
        _ => text,
    }
}

/// A number alone, to some significant digits.
pub(crate) fn significant(v: f64, digits: i32) -> String {
    if v == 0.0 {
        return "0".into();
    }
    let Some(top) = power(v, digits) else { return NONE.into() };
    if (-4..LARGEST_POWER).contains(&top) {
        let rounded: f64 =
            format!("{v:.*e}", usize::try_from(digits - 1).unwrap_or(0)).parse().unwrap_or(v);
        return fixed(rounded, digits - 1 - top);
    }
    format!("{v:.*e}", usize::try_from(digits - 1).unwrap_or(0))
}

/// `value ± u`: the uncertainty to two significant digits, the value to the same place.
///
/// A common power of ten is taken out where there would be more than six decimals, or a million and more. An
/// uncertainty of zero is written `± 0` behind the value to nine digits.
///
/// # Examples
///
/// ```
/// use tumble_report::value_with_uncertainty;
/// assert_eq!(value_with_uncertainty(-0.006_283_1, 0.000_164), "-0.00628 ± 0.00016");
/// assert_eq!(value_with_uncertainty(1.0, 0.0996), "1.00 ± 0.10");
/// assert_eq!(value_with_uncertainty(0.007_697_69, 5.3e-7), "(7.69769 ± 0.00053)e-3");
/// ```
#[must_use]
pub fn value_with_uncertainty(value: f64, u: f64) -> String {
    match rounded_to(&[value, u.abs()], u) {
        Some(r) => r.bracketed(&r.texts.join(" ± ")),
        None if u == 0.0 => format!("{} ± 0", trimmed(&significant(value, 9))),
        None if !u.is_finite() => significant(value, 6),
        None => format!("{} ± {}", significant(value, DOUBLE_DIGITS), significant(u.abs(), DIGITS)),
    }
}

/// `low to high`, to two significant digits of the half-width.
pub(crate) fn interval(low: f64, high: f64) -> String {
    match rounded_to(&[low, high], (high - low) / 2.0) {
        Some(r) => r.bracketed(&r.texts.join(" to ")),
        None => format!("{} to {}", significant(low, 6), significant(high, 6)),
    }
}

/// Without zeros behind the point that say nothing.
fn trimmed(text: &str) -> &str {
    if text.contains('.') && !text.contains('e') {
        text.trim_end_matches('0').trim_end_matches('.')
    } else {
        text
    }
}

/// A p-value.
pub(crate) fn p_value(p: f64) -> String {
    if p < 0.001 { "< 0.001".into() } else { format!("= {}", significant(p, 2)) }
}

/// A correlation: three decimals, more where they are all nines.
pub(crate) fn correlation(r: f64) -> String {
    (3..=6)
        .map(|d| fixed(r, d))
        .find(|t| !t.trim_start_matches('-').starts_with('1'))
        .unwrap_or_else(|| fixed(r, 0))
}

/// A number as printed: true minus sign, powers of ten.
pub(crate) fn typographic(ascii: &str) -> String {
    let (head, tail) = match ascii.rsplit_once('e') {
        Some((h, t)) if !t.is_empty() && t.bytes().all(|b| b == b'-' || b.is_ascii_digit()) => {
            (h, format!("×{}", power_of_ten(t.parse().unwrap_or(0))))
        }
        _ => (ascii, String::new()),
    };
    format!("{}{tail}", head.replace('-', "−"))
}

/// `10⁻³`.
pub(crate) fn power_of_ten(exponent: i32) -> String {
    const UPPER: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    let raised = |c: char| match c.to_digit(10) {
        Some(d) => UPPER.get(d as usize).copied().unwrap_or(c),
        None => '⁻',
    };
    format!("10{}", exponent.to_string().chars().map(raised).collect::<String>())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_rounded_to_the_place_of_their_uncertainty() {
        for (value, u, text) in [
            (-0.006_283_1, 0.000_164, "-0.00628 ± 0.00016"),
            (1.0, 0.0996, "1.00 ± 0.10"),
            (1.0, 0.0994, "1.000 ± 0.099"),
            (9.996, 0.996, "10.0 ± 1.0"),
            (56_789.0, 1_234.0, "56800 ± 1200"),
            (1_003.2, 12_345.0, "1000 ± 12000"),
            (3.0, 1_200.0, "0 ± 1200"),
            (-3.0, 1_200.0, "0 ± 1200"),
            (60.0, 1_200.0, "100 ± 1200"),
            (-0.000_001, 0.25, "0.00 ± 0.25"),
            (0.007_697_69, 5.3e-7, "(7.69769 ± 0.00053)e-3"),
            (1.234_56e7, 1.2e3, "(12.3456 ± 0.0012)e6"),
            (1.5e-12, 2.0e-13, "(1.50 ± 0.20)e-12"),
            (1.5e300, 2.0e299, "(1.50 ± 0.20)e300"),
            (4e-300, 2.1e-301, "(4.00 ± 0.21)e-300"),
            (1.0, 0.0, "1 ± 0"),
            (0.0, 0.0, "0 ± 0"),
            (0.001, 0.0, "0.001 ± 0"),
            (1.0, f64::NAN, "1.00000"),
            (1.0, -0.5, "1.00 ± 0.50"),
            (1.0, 1e-20, "1.00000000000000 ± 1.0e-20"),
        ] {
            assert_eq!(value_with_uncertainty(value, u), text, "{value} ± {u}");
        }
    }

    #[test]
    fn plain_numbers_and_lone_uncertainties() {
        assert_eq!(plain(0.007_697_711_429, 1.5e-9).as_deref(), Some("0.0076977114"));
        assert_eq!(plain(-0.007_637, 2e-5).as_deref(), Some("-0.007637"));
        assert_eq!(plain(0.0, 0.02).as_deref(), Some("0.000"));
        assert_eq!(plain(1.0, 0.0), None);
        assert_eq!(plain(1.0, 1e-20), None);
        assert_eq!(own_digits(1.52e-7, -3), "0.00015");
        assert_eq!(own_digits(0.726, 0), "0.73");
        assert_eq!(own_digits(0.0, 0), "0");
    }

    #[test]
    fn intervals_have_the_digits_of_their_half_width() {
        assert_eq!(interval(-0.008_12, -0.004_61), "-0.0081 to -0.0046");
        assert_eq!(interval(0.007_697_1, 0.007_698_3), "(7.69710 to 7.69830)e-3");
        assert_eq!(interval(1.0, 1.0), "1.00000 to 1.00000");
    }

    #[test]
    fn lone_numbers() {
        for (v, digits, text) in [
            (0.0, 3, "0"),
            (48.217, 3, "48.2"),
            (0.999_6, 3, "1.00"),
            (48_217.0, 3, "48200"),
            (1.234e-7, 2, "1.2e-7"),
            (-0.05, 2, "-0.050"),
            (f64::INFINITY, 2, NONE),
        ] {
            assert_eq!(significant(v, digits), text);
        }
        assert_eq!(correlation(-0.998_74), "-0.999");
        assert_eq!(correlation(-0.999_98), "-0.99998");
        assert_eq!(p_value(0.000_4), "< 0.001");
        assert_eq!(p_value(0.0456), "= 0.046");
    }

    #[test]
    fn print() {
        assert_eq!(typographic("-0.00628 ± 0.00016"), "−0.00628 ± 0.00016");
        assert_eq!(typographic("(7.69769 ± 0.00053)e-3"), "(7.69769 ± 0.00053)×10⁻³");
        assert_eq!(typographic("1.2e-7"), "1.2×10⁻⁷");
    }
}
