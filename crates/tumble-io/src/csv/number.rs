//! Numbers in fields: exact, and never half understood.

/// How numbers are written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum DecimalSign {
    /// `1.5`
    Point,
    /// `1,5` or `1.5`: beside `;` or a tab both occur.
    CommaOrPoint,
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
