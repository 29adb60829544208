//! Numbers in fields: exact, and never half understood.

use std::cell::Cell;

/// How numbers are written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum DecimalSign {
    /// `1.5`
    Point,
    /// `1,5` or `1.5`: beside `;` or a tab both occur.
    CommaOrPoint,
}

/// How codes are written.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(crate) struct CodeFormat {
    /// `1F`, `0x1F` or `1Fh` instead of decimal digits.
    pub(crate) hexadecimal: bool,
    /// The codes are words of so many bits in two's complement, written without their sign: 65535 is −1 in 16.
    pub(crate) bits: Option<u32>,
    /// Taken off every code: the code of zero input of a converter that counts from the middle of its range.
    pub(crate) offset: i32,
}

impl CodeFormat {
    /// Whether codes are plain decimal numbers with their sign.
    #[inline]
    pub(crate) fn is_plain(self) -> bool {
        !self.hexadecimal && self.bits.is_none() && self.offset == 0
    }

    /// A code as it is written.
    pub(crate) fn code(self, field: &[u8]) -> Option<i32> {
        let field = trimmed(field);
        let value = if self.hexadecimal {
            hexadecimal(field)?
        } else {
            wide(field)
                .or_else(|| self.bits.is_none().then(|| written_otherwise(field)).flatten())?
        };
        let signed = match self.bits {
            None => value,
            Some(bits) => {
                let span = 1i64 << bits;
                if !(0..span).contains(&value) {
                    return None;
                }
                if value >= span / 2 { value - span } else { value }
            }
        };
        i32::try_from(signed.checked_sub(i64::from(self.offset))?).ok()
    }
}

/// A code with a typeset minus sign, or as scripts write whole numbers: `-1.108000000000000000e+03`. All its digits must
/// be there: `1.23E+05` is what a spreadsheet shows of 123456. Without a point, `1e3` is hexadecimal as likely.
fn written_otherwise(field: &[u8]) -> Option<i64> {
    if let Some(rest) = field.strip_prefix("−".as_bytes()) {
        let digit = rest.first().is_some_and(u8::is_ascii_digit);
        return integer(rest).filter(|_| digit).map(|n| -i64::from(n));
    }
    let at = field.iter().position(|b| matches!(b, b'e' | b'E'))?;
    let (mantissa, exponent) = (&field[..at], std::str::from_utf8(&field[at + 1..]).ok()?);
    let point = mantissa.iter().position(|b| matches!(b, b'.' | b','))?;
    let decimals = i64::try_from(mantissa.len() - point - 1).ok()?;
    let exponent: i64 = exponent.parse().ok()?;
    let value = real(field, DecimalSign::CommaOrPoint)?;
    let code = value.fract() == 0.0 && value.abs() <= 4_294_967_295.0 && decimals >= exponent;
    code.then_some(value as i64)
}

/// Whether a text is a number in groups of three digits: `1,108`, `1.108.000`, `1'108`.
pub(crate) fn has_thousands(field: &[u8]) -> bool {
    let Ok(text) = std::str::from_utf8(field) else { return false };
    let digits = text.trim_start_matches(['-', '+', '−']);
    let groups: Vec<&str> =
        digits.split([',', '.', '\'', '’', ' ', '\u{a0}', '\u{202f}']).collect();
    let all_digits = |g: &&str| g.bytes().all(|b| b.is_ascii_digit());
    groups.len() > 1
        && (1..=3).contains(&groups[0].len())
        && groups.iter().all(all_digits)
        && groups[1..].iter().all(|g| g.len() == 3)
}

/// What columns show of their decimal marks. Beside `;` both commas and points occur, but in a column with decimal commas
/// `1.000` is a thousand as likely as one.
#[derive(Debug, Clone, Default)]
pub(crate) struct Marks(Vec<Cell<u8>>);

impl Marks {
    const COMMA: u8 = 1;
    const THREE_AFTER_POINT: u8 = 2;

    pub(crate) fn new(columns: usize) -> Self {
        Self(vec![Cell::new(0); columns])
    }

    /// Notes a field; `false` where its column now holds both marks.
    #[inline]
    pub(crate) fn agree(&self, column: usize, field: &[u8]) -> bool {
        let Some(seen) = self.0.get(column) else { return true };
        let new = match field.iter().position(|b| matches!(b, b',' | b'.')) {
            Some(at) if field[at] == b',' => Self::COMMA,
            Some(at) if at <= 4 && field.len() == at + 4 && has_thousands(field) => {
                Self::THREE_AFTER_POINT
            }
            _ => return true,
        };
        seen.set(seen.get() | new);
        seen.get() != Self::COMMA | Self::THREE_AFTER_POINT
    }
}

/// An unsigned or signed whole number of up to ten digits.
fn wide(field: &[u8]) -> Option<i64> {
    match integer(field) {
        Some(n) => Some(i64::from(n)),
        // 32-bit words without their sign do not fit into a signed one.
        None => std::str::from_utf8(field).ok()?.parse::<u32>().ok().map(i64::from),
    }
}

/// `1F`, `0x1F`, `1Fh`, at most eight digits.
fn hexadecimal(field: &[u8]) -> Option<i64> {
    let text = std::str::from_utf8(field).ok()?;
    let digits = text
        .strip_prefix("0x")
        .or_else(|| text.strip_prefix("0X"))
        .or_else(|| text.strip_suffix(['h', 'H']))
        .unwrap_or(text);
    let fits = (1..=8).contains(&digits.len()) && digits.bytes().all(|b| b.is_ascii_hexdigit());
    fits.then(|| i64::from_str_radix(digits, 16).ok()).flatten()
}

/// Texts that loggers and spreadsheets write where there is no reading.
pub(crate) fn says_missing(field: &[u8]) -> bool {
    const WORDS: [&str; 14] = [
        "", "nan", "na", "n/a", "null", "none", "-", "--", "---", "?", "#n/a", "#nan", "inf",
        "-inf",
    ];
    let field = trimmed(field);
    field.len() <= 8 && WORDS.iter().any(|w| field.eq_ignore_ascii_case(w.as_bytes()))
}

/// A field without blanks around it and without plain quotes.
pub(crate) fn trimmed(field: &[u8]) -> &[u8] {
    let field = field.trim_ascii();
    match field {
        [b'"', inner @ .., b'"'] if !inner.contains(&b'"') => inner.trim_ascii(),
        _ => field,
    }
}

/// An integer code. `12.0` counts as one, `12.5` and `0x0c` do not.
#[inline]
pub(crate) fn integer(field: &[u8]) -> Option<i32> {
    let (negative, digits) = match field {
        [b'-', rest @ ..] => (true, rest),
        [b'+', rest @ ..] => (false, rest),
        _ => (false, field),
    };
    let mut value: i64 = 0;
    let mut seen = 0usize;
    let mut rest = digits;
    while let [d @ b'0'..=b'9', tail @ ..] = rest {
        // Ten digits and more could overflow; leading zeros are nothing that a converter writes.
        if seen == 10 {
            return None;
        }
        value = value * 10 + i64::from(d - b'0');
        seen += 1;
        rest = tail;
    }
    let whole = match rest {
        [] => true,
        [b'.' | b',', zeros @ ..] => !zeros.is_empty() && zeros.iter().all(|z| *z == b'0'),
        _ => false,
    };
    if seen == 0 || !whole {
        return None;
    }
    i32::try_from(if negative { -value } else { value }).ok()
}

/// A finite real number.
pub(crate) fn real(field: &[u8], sign: DecimalSign) -> Option<f64> {
    // The minus sign of typeset text is no other number.
    if let Some(rest) = field.strip_prefix("−".as_bytes()) {
        return match rest.first() {
            Some(b'0'..=b'9' | b'.' | b',') => real(rest, sign).map(|v| -v),
            _ => None,
        };
    }
    let plain = |text: &[u8]| {
        // `str::parse` also takes "inf", "nan" and "infinity".
        let numeric =
            text.iter().all(|b| matches!(b, b'0'..=b'9' | b'+' | b'-' | b'.' | b'e' | b'E'));
        let value: f64 = std::str::from_utf8(text).ok().filter(|_| numeric)?.parse().ok()?;
        value.is_finite().then_some(value)
    };
    match (sign, field.contains(&b',')) {
        (_, false) => plain(field),
        (DecimalSign::Point, true) => None,
        // A comma beside a point would be a thousands mark: not guessed.
        (DecimalSign::CommaOrPoint, true) if field.contains(&b'.') => None,
        (DecimalSign::CommaOrPoint, true) => {
            let pointed: Vec<u8> =
                field.iter().map(|b| if *b == b',' { b'.' } else { *b }).collect();
            plain(&pointed)
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn integers() {
        assert_eq!(integer(b"-1108"), Some(-1108));
        assert_eq!(integer(b"+7"), Some(7));
        assert_eq!(integer(b"12.000"), Some(12));
        assert_eq!(integer(b"2147483647"), Some(i32::MAX));
        assert_eq!(integer(b"-2147483648"), Some(i32::MIN));
        for wrong in [
            "",
            "-",
            "12.5",
            "0x0c",
            "1e3",
            "2147483648",
            "12.",
            "1 2",
            "--1",
            "nan",
            "99999999999999999999",
        ] {
            assert_eq!(integer(wrong.as_bytes()), None, "{wrong}");
        }
    }

    #[test]
    fn reals() {
        assert_eq!(real(b"-1,5", DecimalSign::CommaOrPoint), Some(-1.5));
        assert_eq!(real(b"-1.5e-3", DecimalSign::Point), Some(-0.0015));
        for wrong in ["1,234.5", "1.234,5", "1,2,3", "nan", "inf", "", "1e999", "12 °"] {
            assert_eq!(real(wrong.as_bytes(), DecimalSign::CommaOrPoint), None, "{wrong}");
        }
        assert_eq!(real(b"1,5", DecimalSign::Point), None);
        assert_eq!(real("−1.5".as_bytes(), DecimalSign::Point), Some(-1.5));
        assert_eq!(real("−−1.5".as_bytes(), DecimalSign::Point), None);
    }

    #[test]
    fn words_without_their_sign() {
        let hex = CodeFormat { hexadecimal: true, bits: Some(16), offset: 0 };
        assert_eq!(hex.code(b"FFFF"), Some(-1));
        assert_eq!(hex.code(b"0x7fff"), Some(32767));
        assert_eq!(hex.code(b"8000h"), Some(-32768));
        assert_eq!(hex.code(b"10000"), None);
        let word = CodeFormat { hexadecimal: false, bits: Some(16), offset: 0 };
        assert_eq!(word.code(b"65535"), Some(-1));
        assert_eq!(word.code(b"-1"), None);
        assert_eq!(word.code(b"65536"), None);
        let long = CodeFormat { hexadecimal: false, bits: Some(32), offset: 0 };
        assert_eq!(long.code(b"4294967295"), Some(-1));
        assert_eq!(CodeFormat { hexadecimal: true, bits: None, offset: 0 }.code(b"-1F"), None);
    }

    #[test]
    fn codes_as_scripts_and_documents_write_them() {
        let code = |t: &str| CodeFormat::default().code(t.as_bytes());
        assert_eq!(code("-3.495000000000000000e+03"), Some(-3495));
        assert_eq!(code("0.000000000000000000e+00"), Some(0));
        assert_eq!(code("−12"), Some(-12));
        for wrong in ["1.23E+05", "1e3", "1.5e+00", "−−1", "−-1", "1.0e+99", "1.0e"] {
            assert_eq!(code(wrong), None, "{wrong}");
        }
    }

    #[test]
    fn marks_of_thousands() {
        for text in ["1,108", "-1.108", "1'108", "1 108", "12.345.678"] {
            assert!(has_thousands(text.as_bytes()), "{text}");
        }
        for text in ["1108", "1.05", "1,1080", ",108", "1234,567", "a,108"] {
            assert!(!has_thousands(text.as_bytes()), "{text}");
        }
        let marks = Marks::new(2);
        assert!(marks.agree(0, b"998,5") && marks.agree(0, b"12.5") && marks.agree(1, b"1.000"));
        assert!(!marks.agree(0, b"1.000"));
        assert!(!marks.agree(1, b"0,5"));
    }

    #[test]
    fn missing_readings() {
        for word in ["", "NaN", " n/a ", "\"\"", "#N/A", "-"] {
            assert!(says_missing(word.as_bytes()), "{word}");
        }
        assert!(!says_missing(b"0") && !says_missing(b"error"));
    }

    #[test]
    fn quotes_and_blanks_go() {
        assert_eq!(trimmed(b" \"12\" "), b"12");
        assert_eq!(trimmed(b"\"a\"b\""), b"\"a\"b\"");
    }

    proptest! {
        #[test]
        fn agrees_with_the_standard_library(n in any::<i32>(), x in any::<f64>()) {
            prop_assert_eq!(integer(n.to_string().as_bytes()), Some(n));
            prop_assume!(x.is_finite());
            prop_assert_eq!(real(format!("{x:e}").as_bytes(), DecimalSign::Point), Some(x));
        }
    }
}
