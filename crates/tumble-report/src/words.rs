//! Words: wrapping, shortening, and what codes of the passport mean in plain language.

use std::fmt::Write as _;

/// Whitespace runs become single spaces: a text that must stay on its line.
pub(crate) fn one_line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// On one line, at most `longest` characters, cut with `…`.
pub(crate) fn shortened(text: &str, longest: usize) -> String {
    let line = one_line(text);
    if line.chars().count() <= longest {
        return line;
    }
    line.chars().take(longest.saturating_sub(1)).chain(['…']).collect()
}

/// Text wrapped to `width` columns; every line starts with `indent` spaces, the first with `lead`.
pub(crate) fn wrapped(lead: &str, text: &str, indent: usize, width: usize) -> String {
    let mut out = String::new();
    let mut line = lead.to_owned();
    let mut empty = true;
    let room = |line: &str| width.saturating_sub(line.chars().count());
    for word in text.split_whitespace() {
        let mut word: String = word.to_owned();
        if !empty && word.chars().count() + 1 > room(&line) {
            // Writing into a String cannot fail.
            let _ = writeln!(out, "{}", line.trim_end());
            line = " ".repeat(indent);
            empty = true;
        }
        if !empty {
            line.push(' ');
        }
        // A word longer than a line is broken.
        while word.chars().count() > room(&line).max(1) {
            let head: String = word.chars().take(room(&line).max(1)).collect();
            word = word.chars().skip(head.chars().count()).collect();
            let _ = writeln!(out, "{line}{head}");
            line = " ".repeat(indent);
        }
        line.push_str(&word);
        empty = false;
    }
    let _ = writeln!(out, "{}", line.trim_end());
    out
}

/// On one line, with a capital first letter.
pub(crate) fn capitalized(text: &str) -> String {
    let text = one_line(text);
    let mut chars = text.chars();
    let first: String = chars.next().map(|c| c.to_uppercase().collect()).unwrap_or_default();
    format!("{first}{}", chars.as_str())
}

/// With a capital first letter and one full stop.
pub(crate) fn as_sentence(text: &str) -> String {
    let text = capitalized(text);
    if text.is_empty() || text.ends_with(['.', '!', '?', '…']) {
        text
    } else {
        format!("{text}.")
    }
}

/// `1 run`, `2 runs`.
pub(crate) fn counted(n: usize, noun: &str) -> String {
    if n == 1 { format!("1 {noun}") } else { format!("{n} {noun}s") }
}

/// The quantizer's offset `c(N)` in words.
pub(crate) fn offset(name: &str) -> &str {
    match name {
        "half_sign" => {
            "+0.5 for N > 0, −0.5 for N < 0, 0 for N = 0 (the converter cuts the fraction off, toward zero)"
        }
        "half" => "+0.5 for every N (the converter rounds down)",
        "none" => "0 (the converter rounds to the nearest code, or the output is not quantized)",
        other => other,
    }
}

/// The quantizer in words.
pub(crate) fn quantizer(name: &str) -> &str {
    match name {
        "truncate" => "truncates toward zero",
        "floor" => "rounds down (floor)",
        "round" => "rounds to the nearest code",
        "none" => "not quantized",
        other => other,
    }
}

/// The method in words.
pub(crate) fn method(name: &str) -> &str {
    match name {
        "exact" => "exact linear form: least squares on 1, sin φ, cos φ, inverted",
        "paper" => "linearized in the small errors, ordinary least squares (as published)",
        "likelihood" => "two-level likelihood of the codes",
        other => other,
    }
}

/// Units as printed.
pub(crate) fn unit(name: &str) -> String {
    match name {
        "1" => "1".into(),
        other => other.replace("m/s2", "m/s²"),
    }
}

/// How strongly two parameters are tied.
pub(crate) fn tie(r: f64) -> &'static str {
    match r.abs() {
        r if r >= 0.99 => "almost inseparable under this plan",
        r if r >= 0.9 => "strongly tied to one another under this plan",
        r if r >= 0.5 => "tied to one another",
        _ => "nearly independent",
    }
}

/// A parameter's name in the passport, in words.
pub(crate) fn parameter(name: &str) -> &str {
    match name {
        "scale_error" => "scale error",
        "scale_factor" => "scale factor",
        other => other,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wrapping_keeps_the_width() {
        let text = wrapped("* ", &"word ".repeat(40), 2, 30);
        assert!(text.lines().all(|l| l.chars().count() <= 30), "{text}");
        assert!(text.lines().skip(1).all(|l| l.starts_with("  w")));
        let long = wrapped("", &"x".repeat(95), 4, 40);
        assert!(long.lines().all(|l| l.chars().count() <= 40), "{long}");
        assert_eq!(wrapped("lead", "", 2, 20), "lead\n");
    }

    #[test]
    fn shortening() {
        assert_eq!(shortened("a\nb  c", 10), "a b c");
        assert_eq!(shortened("abcdef", 4), "abc…");
        assert_eq!(as_sentence("check it"), "Check it.");
    }
}
