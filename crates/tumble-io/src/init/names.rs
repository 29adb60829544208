//! Angles in file names: `minus30.csv`, `x_+45deg.txt`, `up.csv`.

/// What a file's name says about the position that it holds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Named {
    Angle(f64),
    Up,
    Down,
}

/// Words in front of a number that count something else.
const COUNTERS: [&str; 16] = [
    "run", "test", "log", "dwell", "rec", "record", "file", "part", "sensor", "unit", "ch", "adc",
    "sn", "id", "ln", "adxl",
];

/// What names without their folders and endings say, each if it says it once.
///
/// A number that stands in all names alike is no angle of any: a date, the type of the sensor.
pub(super) fn named(stems: &[&str]) -> Vec<Option<Named>> {
    let lower: Vec<String> = stems.iter().map(|s| s.to_lowercase().replace('−', "-")).collect();
    let mut numbers: Vec<Vec<f64>> = lower.iter().map(|l| angles(l)).collect();
    let many = numbers.iter().map(Vec::len).min().unwrap_or(0);
    if stems.len() > 1 && many > 1 && numbers.iter().all(|n| n.len() == many) {
        let differs: Vec<bool> =
            (0..many).map(|i| numbers.iter().any(|n| n[i] != numbers[0][i])).collect();
        for row in &mut numbers {
            let mut keep = differs.iter();
            row.retain(|_| keep.next().copied().unwrap_or(true));
        }
    }
    let one = |(lower, numbers): (&String, &Vec<f64>)| match (upright(lower), &numbers[..]) {
        (Some(upright), _) => Some(upright),
        (None, [angle]) => Some(Named::Angle(*angle)),
        (None, _) => None,
    };
    lower.iter().zip(&numbers).map(one).collect()
}

/// Up or down.
fn upright(lower: &str) -> Option<Named> {
    let words: Vec<&str> =
        lower.split(|c: char| !c.is_alphanumeric()).filter(|w| !w.is_empty()).collect();
    let says = |any: &[&str]| words.iter().any(|w| any.contains(w));
    match (says(&["up", "oben", "top", "вверх"]), says(&["down", "unten", "bottom", "вниз"]))
    {
        (true, false) => Some(Named::Up),
        (false, true) => Some(Named::Down),
        _ => None,
    }
}

/// Letters that may follow an angle at once.
const DEGREES: [&str; 7] = ["", "d", "deg", "degree", "degrees", "grad", "gr"];

/// Numbers that can be angles.
fn angles(text: &str) -> Vec<f64> {
    let bytes = text.as_bytes();
    let mut found = Vec::new();
    let mut i = 0;
    while i < bytes.len() {
        if !bytes[i].is_ascii_digit() {
            i += 1;
            continue;
        }
        let start = i;
        let mut points = 0;
        while i < bytes.len() && (bytes[i].is_ascii_digit() || (points == 0 && is_point(bytes, i)))
        {
            points += usize::from(!bytes[i].is_ascii_digit());
            i += 1;
        }
        let number = text[start..i].replace([',', 'p'], ".").parse::<f64>();
        let before = &text[..start];
        let word: String = before
            .chars()
            .rev()
            .take_while(|c| c.is_alphabetic())
            .collect::<Vec<_>>()
            .into_iter()
            .rev()
            .collect();
        let negative = before.ends_with("--")
            || matches!(word.as_str(), "m" | "n" | "minus" | "neg")
            || (before.ends_with('-')
                && !before.trim_end_matches('-').ends_with(|c: char| c.is_alphanumeric()))
            || (before.ends_with('-') && before.trim_end_matches('-').ends_with(['_', ' ']));
        // `run-1`, `log_20261120`, `adxl203`.
        let counted = COUNTERS
            .iter()
            .any(|c| word == *c || before.trim_end_matches(['-', '_', ' ']).ends_with(c));
        // `lis3dh` holds no angle.
        let after: String = text[i..].chars().take_while(|c| c.is_alphabetic()).collect();
        if let Ok(number) = number
            && number <= 360.0
            && !counted
            && DEGREES.contains(&after.as_str())
        {
            found.push(if negative { -number } else { number });
        }
    }
    found
}

/// A mark between digits: `12.5`, `12,5`, `12p5`.
fn is_point(bytes: &[u8], i: usize) -> bool {
    matches!(bytes[i], b'.' | b',' | b'p') && bytes.get(i + 1).is_some_and(u8::is_ascii_digit)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_files() {
        for (name, expected) in [
            ("minus30", Some(Named::Angle(-30.0))),
            ("-30", Some(Named::Angle(-30.0))),
            ("x_-12.5deg", Some(Named::Angle(-12.5))),
            ("angle_+45", Some(Named::Angle(45.0))),
            ("m15", Some(Named::Angle(-15.0))),
            ("pos_12p5", Some(Named::Angle(12.5))),
            ("tilt 30", Some(Named::Angle(30.0))),
            ("x_adi_up", Some(Named::Up)),
            ("x-down", Some(Named::Down)),
            ("run-1", None),
            ("log_20261120", None),
            ("adxl203_m30", Some(Named::Angle(-30.0))),
            ("record", None),
            ("30_60", None),
        ] {
            assert_eq!(named(&[name]), [expected], "{name}");
        }
    }

    #[test]
    fn what_all_names_hold_is_no_angle() {
        let angle = |a| Some(Named::Angle(a));
        let dated = ["2026-11-20_lis3dh_m60deg", "2026-11-20_lis3dh_0deg"];
        assert_eq!(named(&dated), [angle(-60.0), angle(0.0)]);
        assert_eq!(named(&["bma180_-30", "bma180_45"]), [angle(-30.0), angle(45.0)]);
        assert_eq!(named(&["lis3dh"]), [None]);
        assert_eq!(named(&["30_60", "40_50"]), [None, None]);
    }
}
