//! Single fields, headers and plans.

use tumble_core::Quantizer;
use tumble_core::simulate::parse_plan;

use super::{digit, said};
use crate::csv::{
    AngleUnit, CodeFormat, Columns, DecimalSign, Delimiter, Dialect, KNOWN, Mapping, TimeUnit,
    date_s, dms, integer, real, role, says_missing, split_unit, trimmed,
};
use crate::error::Place;

/// Whole numbers, real numbers and codes agree with the standard library's reading of them.
pub fn numbers(field: &[u8]) {
    let text = std::str::from_utf8(field).ok();
    assert!(trimmed(field).len() <= field.len());
    let whole = integer(field);
    if let Some(n) = whole {
        assert_eq!(real(field, DecimalSign::CommaOrPoint), Some(f64::from(n)), "{text:?}");
        assert!(!says_missing(field), "{text:?} is a number and missing");
    }
    if let Some(n) = text.and_then(|t| t.parse::<i32>().ok()) {
        let digits = field.iter().filter(|b| b.is_ascii_digit()).count();
        assert_eq!(whole, (digits <= 10).then_some(n), "{text:?}");
    }
    for sign in [DecimalSign::Point, DecimalSign::CommaOrPoint] {
        let Some(value) = real(field, sign) else { continue };
        assert!(value.is_finite());
        let plain = text.map(|t| t.replace('−', "-").replace(',', "."));
        assert_eq!(plain.and_then(|t| t.parse::<f64>().ok()), Some(value), "{text:?}");
        let again = format!("{value:?}");
        assert_eq!(real(again.as_bytes(), sign), Some(value), "{again}");
    }
    for hexadecimal in [false, true] {
        let plain = CodeFormat { hexadecimal, bits: None, offset: 0 };
        if !hexadecimal && let Some(n) = whole {
            assert_eq!(plain.code(field), Some(n));
        }
        for bits in 2..=32 {
            let format = CodeFormat { hexadecimal, bits: Some(bits), offset: 0 };
            let Some(code) = format.code(field) else { continue };
            let half = 1i64 << (bits - 1);
            assert!((-half..half).contains(&i64::from(code)), "{code} in {bits} bits");
            let word = i64::from(code).rem_euclid(2 * half);
            let again = if hexadecimal { format!("{word:X}") } else { word.to_string() };
            assert_eq!(format.code(again.as_bytes()), Some(code), "{again} in {bits} bits");
        }
    }
}

/// Angles of the dial: finite, the sign in front counts for all parts, what is composed is read as it was composed.
pub fn dial_angles(field: &[u8]) {
    for sign in [DecimalSign::Point, DecimalSign::CommaOrPoint] {
        for unit in AngleUnit::ALL {
            let value = unit.value(field, sign);
            assert!(value.is_none_or(f64::is_finite), "{value:?}");
            assert_eq!(value, unit.value(field, sign));
        }
        if let Some(value) = dms(field, sign)
            && field.first().is_some_and(u8::is_ascii_digit)
            && field.len() < 40
        {
            let turned = dms(&[b"-", field].concat(), sign);
            assert_eq!(turned, Some(-value));
        }
    }
    let [a, b, c, d, e, ..] = *field else { return };
    let (degrees, minutes, seconds) = (u16::from_le_bytes([a, b]), c % 60, d % 60);
    let expected = f64::from(degrees) + f64::from(minutes) / 60.0 + f64::from(seconds) / 3600.0;
    let written = match e % 4 {
        0 => format!("{degrees}°{minutes}'{seconds}\""),
        1 => format!("{degrees}:{minutes:02}:{seconds:02}"),
        2 => format!("{degrees} {minutes} {seconds}"),
        _ => format!("+{degrees}d{minutes}m{seconds}s"),
    };
    assert_eq!(dms(written.as_bytes(), DecimalSign::Point), Some(expected), "{written}");
}

/// Dates and times: finite, the same twice; what is composed is read as it was composed.
pub fn dates(field: &[u8]) {
    let seen = date_s(field);
    assert!(seen.is_none_or(f64::is_finite), "{seen:?}");
    assert_eq!(seen, date_s(field));
    for unit in TimeUnit::ALL {
        let seconds = unit.seconds(field, DecimalSign::CommaOrPoint);
        assert!(seconds.is_none_or(f64::is_finite), "{seconds:?}");
    }
    let [year, month, day, hour, minute, second, form, ..] = *field else { return };
    let (year, month, day) = (1970 + u32::from(year), 1 + month % 12, 1 + day % 28);
    let (hour, minute, second) = (hour % 24, minute % 60, second % 60);
    let of_day = 3600.0 * f64::from(hour) + 60.0 * f64::from(minute) + f64::from(second);
    let time = format!("{hour:02}:{minute:02}:{second:02}");
    assert_eq!(date_s(time.as_bytes()), Some(of_day), "{time}");
    let written = match form % 4 {
        0 => format!("{year}-{month:02}-{day:02}T{time}"),
        1 => format!("{year}-{month:02}-{day:02} {time}"),
        2 => format!("{day:02}.{month:02}.{year} {time}"),
        _ => format!("{year}/{month:02}/{day:02} {time}"),
    };
    let days = days_since_1970(i64::from(year), i64::from(month), i64::from(day));
    assert_eq!(date_s(written.as_bytes()), Some(days as f64 * 86400.0 + of_day), "{written}");
}

/// Days from 1970-01-01 in the Gregorian calendar, counted from the first of March.
fn days_since_1970(year: i64, month: i64, day: i64) -> i64 {
    let (y, m) = if month > 2 { (year, month - 3) } else { (year - 1, month + 9) };
    365 * y + y / 4 - y / 100 + y / 400 + (153 * m + 2) / 5 + day - 1 - 719_468
}

/// A header line: every column that is found stands in it; every refusal is fit to print.
pub fn header(data: &[u8]) {
    let [how, line @ ..] = data else { return };
    let mut how = u32::from(*how);
    let delimiter = match digit(&mut how, 5) {
        0 => None,
        1 => Some(Delimiter::Byte(b';')),
        2 => Some(Delimiter::Byte(b'\t')),
        3 => Some(Delimiter::Byte(b'|')),
        _ => Some(Delimiter::Blanks),
    };
    let header_line = (digit(&mut how, 2) == 1).then_some(1);
    let mapping: Mapping = match digit(&mut how, 3) {
        0 => Mapping::new(),
        1 => super::files::mapping("{angle_deg = 1, code = 2}"),
        _ => super::files::mapping("{angle_deg = \"Angle\", output = \"ax [g]\"}"),
    };
    let dialect = Dialect { delimiter, header_line, ..Dialect::default() };
    let place = Place::line("run.csv", 1);
    match Columns::parse(line, &place, &dialect, &mapping) {
        Ok(columns) => {
            let indices: Vec<usize> = KNOWN.iter().filter_map(|k| columns.get(k)).collect();
            assert!(indices.iter().all(|i| *i < columns.names.len()));
            assert!(columns.ignored.len() <= columns.names.len());
            for name in &columns.names {
                let _ = (role(name), split_unit(name));
            }
            for known in ["angle_deg", "code", "mean_code"] {
                said(&columns.missing(&[known], &place));
            }
            if let Err(e) = columns.check_units(&place, &dialect, (Quantizer::None, "V")) {
                said(&e);
            }
        }
        Err(e) => {
            said(&e);
        }
    }
}

/// A plan of angles: finite, and not more of them than anybody measures.
pub fn plan_string(data: &[u8]) {
    let text = String::from_utf8_lossy(data);
    match parse_plan(&text) {
        Ok(angles) => {
            assert!(!angles.is_empty() && angles.iter().all(|a| a.is_finite()), "{text}");
            assert!(angles.len() <= data.len().max(1 << 14), "{} angles", angles.len());
        }
        Err(e) => {
            said(&e);
        }
    }
}
