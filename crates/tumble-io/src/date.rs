//! Days of the calendar, as text.

/// Whether a text is a day of the Gregorian calendar as `YYYY-MM-DD`.
///
/// ```
/// assert!(tumble_io::is_iso_date("2028-02-29"));
/// assert!(!tumble_io::is_iso_date("2026-02-29") && !tumble_io::is_iso_date("23.11.2026"));
/// ```
#[must_use]
pub fn is_iso_date(text: &str) -> bool {
    let bytes = text.as_bytes();
    let [y, m, d] = [0..4, 5..7, 8..10].map(|r| bytes.get(r).and_then(digits));
    let (Some(year), Some(month), Some(day)) = (y, m, d) else { return false };
    let leap = (year % 4 == 0 && year % 100 != 0) || year % 400 == 0;
    let days = match month {
        1 | 3 | 5 | 7 | 8 | 10 | 12 => 31,
        4 | 6 | 9 | 11 => 30,
        2 => 28 + u32::from(leap),
        _ => 0,
    };
    bytes.len() == 10 && bytes[4] == b'-' && bytes[7] == b'-' && (1..=days).contains(&day)
}

fn digits(text: &[u8]) -> Option<u32> {
    text.iter().try_fold(0, |n, b| b.is_ascii_digit().then(|| 10 * n + u32::from(b - b'0')))
}

#[cfg(test)]
mod tests {
    use super::is_iso_date;

    #[test]
    fn only_days_that_exist() {
        for day in ["2026-11-23", "2000-02-29", "1999-12-31"] {
            assert!(is_iso_date(day), "{day}");
        }
        for wrong in [
            "",
            "2026",
            "2026-11",
            "2026-11-31",
            "2026-13-01",
            "2026-00-10",
            "2026-01-00",
            "1900-02-29",
            "2026-1-2",
            "2026/11/23",
            "23-11-2026",
            "2026-11-23T10",
            "tomorrow",
            "２０２６-11-23",
            "2026-11-2é",
        ] {
            assert!(!is_iso_date(wrong), "{wrong}");
        }
    }
}
