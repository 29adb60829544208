//! TOML as people write it: every refusal with line and column, unknown keys with the nearest known one.

use serde::de::DeserializeOwned;

use crate::error::{Place, Problem, ReadError};

/// Parses a file. A byte-order mark is fine.
pub(crate) fn from_toml<T: DeserializeOwned>(text: &str, shown_as: &str) -> Result<T, ReadError> {
    let text = without_mark(text);
    toml::from_str::<T>(text).map_err(|e| ReadError {
        place: place(text, shown_as, e.span().map_or(0, |s| s.start)),
        problem: problem(e.message()),
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
fn problem(message: &str) -> Problem {
    let mut quoted = message.split('`').skip(1).step_by(2).map(str::to_owned);
    match (message.starts_with("unknown field"), quoted.next()) {
        (true, Some(key)) => {
            let known: Vec<String> = quoted.collect();
            let nearest = known
                .iter()
                .map(|k| (strsim::jaro_winkler(&key.to_lowercase(), k), k))
                .filter(|(similar, _)| *similar > 0.75)
                .max_by(|a, b| a.0.total_cmp(&b.0))
                .map(|(_, k)| k.clone());
            Problem::UnknownKey { key, nearest, known }
        }
        _ => Problem::Toml { message: message.to_owned() },
    }
}
