//! Texts of a passport made harmless: control characters visible, no bidirectional overrides, bounded length.

use serde_json::Value;
use tumble_io::passport::Passport;

/// Longest text that is rendered, in characters. Findings of Tumble itself stay below 500.
const LONGEST: usize = 500;

/// The same passport with every text safe to show.
///
/// Control characters other than newline become their visible pictures (ESC → ␛), characters that reorder,
/// hide or break text (bidirectional controls, line separators, noncharacters) become U+FFFD, and texts beyond 500
/// characters are cut with `…`. Escaping for HTML is not done here: the markup builder does it.
///
/// A passport with a number that is not finite cannot be written as JSON, so none is ever read; one that a program
/// put together is replaced by an indeterminate passport that says so.
///
/// # Examples
///
/// ```
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// # let text = include_str!("../tests/data/least.json");
/// let mut passport = tumble_report::Passport::from_json(text)?;
/// passport.sensor.serial = "3\u{1b}[2J".into();
/// assert_eq!(tumble_report::sanitized(&passport).sensor.serial, "3␛[2J");
/// # Ok(())
/// # }
/// ```
#[must_use]
pub fn sanitized(passport: &Passport) -> Passport {
    serde_json::to_value(passport)
        .and_then(|mut tree| {
            clean(&mut tree);
            serde_json::from_value(tree)
        })
        .unwrap_or_else(|_| unreadable())
}

fn clean(tree: &mut Value) {
    match tree {
        Value::String(text) => *text = clean_text(text),
        Value::Array(items) => items.iter_mut().for_each(clean),
        Value::Object(fields) => fields.values_mut().for_each(clean),
        Value::Null | Value::Bool(_) | Value::Number(_) => {}
    }
}

pub(crate) fn clean_text(text: &str) -> String {
    let mut out: String = text.chars().take(LONGEST).map(visible).collect();
    if text.chars().nth(LONGEST).is_some() {
        out.push('…');
    }
    out
}

fn visible(c: char) -> char {
    match c {
        '\n' => c,
        // The block of control pictures has the order of ASCII.
        '\0'..='\u{1f}' => {
            char::from_u32(0x2400 + u32::from(c)).unwrap_or(char::REPLACEMENT_CHARACTER)
        }
        '\u{7f}' => '\u{2421}',
        // C1 controls act like ESC sequences in some terminals.
        '\u{80}'..='\u{9f}' => char::REPLACEMENT_CHARACTER,
        // Marks, embeddings, overrides and isolates of bidirectional text.
        '\u{61c}' | '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}' => {
            char::REPLACEMENT_CHARACTER
        }
        // Zero-width characters and separators hide or break text.
        '\u{200b}'..='\u{200d}' | '\u{2028}' | '\u{2029}' | '\u{2060}' | '\u{feff}' => {
            char::REPLACEMENT_CHARACTER
        }
        // Tags are invisible letters; noncharacters are no XML.
        '\u{e0000}'..='\u{e007f}' | '\u{fffe}' | '\u{ffff}' => char::REPLACEMENT_CHARACTER,
        c => c,
    }
}

/// Stands for a passport whose numbers cannot be rendered.
fn unreadable() -> Passport {
    use tumble_io::passport as p;
    let unknown = || String::from("unknown");
    Passport {
        schema: p::SCHEMA.into(),
        id: String::new(),
        issued: None,
        verdict: "indeterminate".into(),
        reasons: Vec::new(),
        missing: vec!["a number in this passport is not finite: it cannot be shown".into()],
        conformity: p::Conformity { status: "not_assessed".into(), ..p::Conformity::default() },
        sensor: p::Sensor { model: unknown(), serial: unknown(), axis: unknown(), kind: None },
        output: p::Output {
            quantizer: unknown(),
            unit: "LSB".into(),
            rate_hz: None,
            min_code: None,
            max_code: None,
        },
        bench: p::Bench {
            gravity_m_s2: p::Gravity { value: 0.0, standard_uncertainty: 0.0, source: unknown() },
            angle_uncertainty_arcmin: None,
            angle_range_deg: None,
            updown_lean_arcmin: 0.0,
            systematics: Vec::new(),
            temperature_spread_k: None,
        },
        method: unknown(),
        nominal_scale_m_s2_per_lsb: 0.0,
        nominal_scale_source: unknown(),
        validity: p::Validity { temperature_degc: None, dates: Vec::new() },
        parameters: Vec::new(),
        result: None,
        compensation: None,
        runs: Vec::new(),
        error_level_lsb: None,
        structure: None,
        terms: Vec::new(),
        influence: p::Influence::default(),
        outliers: Vec::new(),
        left_out_comparison: Vec::new(),
        budget: Vec::new(),
        findings: Vec::new(),
        inputs: Vec::new(),
        options: p::Options {
            method: unknown(),
            weights: unknown(),
            level: 0.0,
            monte_carlo_digits: 0,
            terms: None,
            targets: p::Targets { bias_m_s2: 0.0, misalignment_rad: 0.0, scale_error: 0.0 },
            left_out: Vec::new(),
        },
        software: p::Software { name: unknown(), version: String::new(), target: String::new() },
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texts_become_harmless() {
        for (text, shown) in [
            ("plain", "plain"),
            ("two\nlines", "two\nlines"),
            ("\u{1b}[2J", "␛[2J"),
            ("a\0b\rc\td\u{7f}", "a␀b␍c␉d␡"),
            ("\u{202e}gpj.exe", "\u{fffd}gpj.exe"),
            ("\u{9b}31m", "\u{fffd}31m"),
            ("µ′ 加速度 −", "µ′ 加速度 −"),
        ] {
            assert_eq!(clean_text(text), shown);
        }
        assert_eq!(clean_text(&"x".repeat(501)).chars().count(), 501);
        assert_eq!(clean_text(&"x".repeat(500)), "x".repeat(500));
    }
}
