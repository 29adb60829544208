//! The header line: delimiter, and where each column stands.

use std::collections::BTreeMap;

use super::number::{DecimalSign, trimmed};
use crate::error::{Place, Problem, ReadError};

/// Columns that a run file may have, and what they hold.
pub(crate) const KNOWN: [&str; 9] = [
    "angle_deg",
    "code",
    "output",
    "mean_code",
    "samples",
    "std_code",
    "t_s",
    "temperature_degc",
    "position",
];

/// Where the columns of a file stand.
#[derive(Debug, Clone)]
pub(crate) struct Columns {
    pub(crate) delimiter: u8,
    pub(crate) decimal: DecimalSign,
    /// Names as the header gives them.
    pub(crate) names: Vec<String>,
    /// Known column → index.
    index: BTreeMap<&'static str, usize>,
    /// Columns that are not used.
    pub(crate) ignored: Vec<String>,
}

impl Columns {
    /// Reads a header line. `mapping` names the user's own headers: known column → header.
    pub(crate) fn parse(
        line: &[u8],
        place: &Place,
        mapping: &BTreeMap<String, String>,
    ) -> Result<Self, ReadError> {
        let fail = |problem| Err(ReadError { place: place.clone(), problem });
        let Ok(text) = std::str::from_utf8(line) else {
            return fail(Problem::Format {
                seen: "the header is not UTF-8 text",
                remedy: "save the file as UTF-8",
            });
        };
        if text.contains('\0') {
            return fail(Problem::Format { seen: "binary data", remedy: "give a CSV file" });
        }
        let (delimiter, decimal) = match text {
            t if t.contains(';') => (b';', DecimalSign::CommaOrPoint),
            t if t.contains('\t') => (b'\t', DecimalSign::CommaOrPoint),
            _ => (b',', DecimalSign::Point),
        };
        let names: Vec<String> = text
            .split(char::from(delimiter))
            .map(|n| String::from_utf8_lossy(trimmed(n.as_bytes())).into_owned())
            .collect();
        let mut index = BTreeMap::new();
        for known in KNOWN {
            let wanted = mapping.get(known).map_or(known, String::as_str);
            let mut places = names.iter().enumerate().filter(|(_, n)| *n == wanted);
            match (places.next(), places.next()) {
                (Some(_), Some(_)) => {
                    return fail(Problem::Columns {
                        what: format!("column `{wanted}` occurs twice"),
                        remedy: "rename one of them".into(),
                        seen: names,
                    });
                }
                (Some((i, _)), None) => {
                    index.insert(known, i);
                }
                (None, _) if mapping.contains_key(known) => {
                    return fail(Problem::Columns {
                        what: format!("column `{wanted}` (mapped to {known}) is missing"),
                        remedy: "correct `columns` in experiment.toml".into(),
                        seen: names,
                    });
                }
                (None, _) => {}
            }
        }
        let used: Vec<usize> = index.values().copied().collect();
        let ignored = names
            .iter()
            .enumerate()
            .filter(|(i, n)| !used.contains(i) && !n.is_empty())
            .map(|(_, n)| n.clone())
            .collect();
        Ok(Self { delimiter, decimal, names, index, ignored })
    }

    /// Index of a known column.
    pub(crate) fn get(&self, known: &str) -> Option<usize> {
        self.index.get(known).copied()
    }

    /// Index of a column that must be there.
    pub(crate) fn require(&self, known: &'static str, place: &Place) -> Result<usize, ReadError> {
        self.get(known).ok_or_else(|| self.missing(known, place))
    }

    /// The error for a column that must be there, with the nearest header as a proposal.
    pub(crate) fn missing(&self, known: &'static str, place: &Place) -> ReadError {
        let own = self
            .ignored
            .iter()
            .max_by(|a, b| {
                strsim::jaro_winkler(&a.to_lowercase(), known)
                    .total_cmp(&strsim::jaro_winkler(&b.to_lowercase(), known))
            })
            .map_or("Your Header", String::as_str);
        ReadError {
            place: place.clone(),
            problem: Problem::Columns {
                seen: self.names.clone(),
                what: format!("no column `{known}`"),
                remedy: format!(
                    "if another column holds it, write columns = {{{known} = \"{own}\"}} in its [[run]]"
                ),
            },
        }
    }

    /// Name of a column as the header gives it.
    pub(crate) fn name(&self, index: usize) -> &str {
        self.names.get(index).map_or("?", String::as_str)
    }
}
