//! TOML as people write it: every refusal with line and column, unknown keys with the nearest known one.

use serde::de::DeserializeOwned;

use crate::error::{Place, Problem, ReadError};

/// Parses a file. A byte-order mark is fine.
pub(crate) fn from_toml<T: DeserializeOwned>(text: &str, shown_as: &str) -> Result<T, ReadError> {
    let text = without_mark(text);
    toml::from_str::<T>(text).map_err(|e| {
        let place = place(text, shown_as, e.span().map_or(0, |s| s.start));
        let line = line_of(text, place.line.unwrap_or(1));
        ReadError { problem: problem(e.message(), line), place }
    })
}

/// The text that spans count in.
pub(crate) fn without_mark(text: &str) -> &str {
    text.strip_prefix('\u{feff}').unwrap_or(text)
}

/// Line and column of a byte of the text.
pub(crate) fn place(text: &str, shown_as: &str, at: usize) -> Place {
    let (line, column) = line_and_column(text, at);
    Place::field(shown_as, line, column.to_string())
}

fn line_and_column(text: &str, at: usize) -> (u64, usize) {
    let before = text.get(..at).unwrap_or(text);
    let line = before.matches('\n').count() as u64 + 1;
    let column = before.rsplit('\n').next().map_or(0, |l| l.chars().count()) + 1;
    (line, column)
}

/// The deserializer's message about an unknown key names the key and the known ones between backticks.
fn problem(message: &str, line: &str) -> Problem {
    let mut quoted = message.split('`').skip(1).step_by(2).map(str::to_owned);
    match (message.starts_with("unknown field"), quoted.next()) {
        (true, Some(key)) => Problem::unknown_key(&key, quoted.collect()),
        _ => Problem::Toml { message: format!("{message}\n{}", toml_remedy(message, line)) },
    }
}

fn line_of(text: &str, number: u64) -> &str {
    let index = usize::try_from(number.saturating_sub(1)).unwrap_or(usize::MAX);
    text.lines().nth(index).unwrap_or_default()
}

/// One thing to do about a line that is no TOML, or holds another type than its key wants.
fn toml_remedy(message: &str, line: &str) -> String {
    let line = line.split_once(" #").map_or(line, |(before, _)| before).trim();
    let (key, given) = line.split_once('=').map_or(("", line), |(k, v)| (k.trim(), v.trim()));
    let bare = given.trim_matches(['"', '\'']);
    let digits = |t: &str| !t.is_empty() && t.bytes().all(|b| b.is_ascii_digit());
    let is_comma_number = bare
        .split_once(',')
        .is_some_and(|(whole, rest)| digits(whole.trim_start_matches(['-', '+'])) && digits(rest));
    if is_comma_number {
        return format!(
            "TOML numbers have a decimal point: write {key} = {}",
            bare.replace(',', ".")
        );
    }
    if given.starts_with('"') && given.contains('\\') {
        // Also right where the path leaves the folder: that is refused with its own words.
        return format!(
            "a backslash is special between \" \": write {key} = \"{}\"",
            bare.replace('\\', "/")
        );
    }
    if message.starts_with("missing field") {
        let table = message.split('`').nth(1).unwrap_or("it");
        return format!(
            "add {table}; docs/experiment.md shows a whole file, `tumble simulate OUT` writes one"
        );
    }
    if message.starts_with("invalid type: string") && bare.parse::<f64>().is_ok() {
        return format!("numbers stand without quotes: write {key} = {bare}");
    }
    if message.contains("expected a string") && !bare.is_empty() && !given.contains(['"', '[', '{'])
    {
        return format!("texts stand between quotes: write {key} = \"{bare}\"");
    }
    if message.starts_with("duplicate key") {
        return "remove one of the two; every run needs a [[run]] of its own, with two brackets"
            .into();
    }
    if message.starts_with("unknown variant") {
        return "write one of these, in small letters".into();
    }
    if line.starts_with('[') && line.matches('[').count() != line.matches(']').count() {
        return "close the bracket: tables are [bench], runs [[run]]".into();
    }
    if given.matches('=').count() > 0 || (key.is_empty() && !line.starts_with('[')) {
        return "one key and one value a line: gravity = 9.81".into();
    }
    if !given.is_empty()
        && given.bytes().all(|b| b.is_ascii_alphanumeric() || b"-_. /".contains(&b))
        && !given.as_bytes()[0].is_ascii_digit()
    {
        return format!("texts stand between quotes: write {key} = \"{bare}\"");
    }
    "a line is KEY = VALUE, texts between \" \", numbers with a point and no unit; docs/experiment.md shows all keys".into()
}
