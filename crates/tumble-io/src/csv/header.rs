//! The header line: delimiter, and where each column stands.

use std::collections::BTreeMap;

use serde::Deserialize;
use tumble_core::Quantizer;

use super::clock::TimeUnit;
use super::dial::AngleUnit;
use super::dialect::{Delimiter, Dialect};
use super::number::{DecimalSign, Marks, real, trimmed};
use super::roles::{HeaderUnit, role, role_of_known, split_unit};
use super::row::FieldBuffer;
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

/// A column of the user's file: by its header, or by its number counted from one.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize)]
#[serde(untagged)]
pub(crate) enum ColumnRef {
    Number(u32),
    Name(String),
}

impl std::fmt::Display for ColumnRef {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Number(n) => write!(f, "{n}"),
            Self::Name(name) => f.write_str(name),
        }
    }
}

/// `columns` of experiment.toml: known column → the user's.
pub(crate) type Mapping = BTreeMap<String, ColumnRef>;

/// Where the columns of a file stand.
#[derive(Debug, Clone)]
pub(crate) struct Columns {
    pub(crate) delimiter: Delimiter,
    pub(crate) decimal: DecimalSign,
    /// Names as the header gives them.
    pub(crate) names: Vec<String>,
    /// Known column → index.
    index: BTreeMap<&'static str, usize>,
    /// Columns that are not used.
    pub(crate) ignored: Vec<String>,
    /// Decimal marks that were seen.
    pub(super) marks: Marks,
}

/// A header's text: UTF-8, else as Windows writes it. Only names are in it, and they are matched as they come.
pub(crate) fn decoded(line: &[u8]) -> String {
    match std::str::from_utf8(line) {
        Ok(text) => text.to_owned(),
        Err(_) => line.iter().map(|b| char::from(*b)).collect(),
    }
}

/// Names of the columns in a header line.
pub(crate) fn names(text: &str, delimiter: Delimiter) -> Vec<String> {
    let mut buffer = FieldBuffer::default();
    let fields = buffer.split(text.as_bytes(), delimiter);
    (0..fields.len())
        .map(|i| String::from_utf8_lossy(trimmed(fields.get(i))).trim().to_owned())
        .collect()
}

impl Columns {
    /// Reads a header line.
    pub(crate) fn parse(
        line: &[u8],
        place: &Place,
        dialect: &Dialect,
        mapping: &Mapping,
    ) -> Result<Self, ReadError> {
        let fail = |problem| Err(ReadError { place: place.clone(), problem });
        let text = decoded(line);
        if text.contains('\0') {
            return fail(Problem::Format { seen: "binary data", remedy: "give a CSV file" });
        }
        let delimiter = dialect.delimiter.unwrap_or_else(|| Delimiter::of_header(&text));
        let names = names(&text, delimiter);
        let decimal = dialect.decimal.unwrap_or_else(|| delimiter.decimal());
        let number = |n: &String| real(n.as_bytes(), DecimalSign::CommaOrPoint).is_some();
        if dialect.header_line.is_none() && !names.is_empty() && names.iter().all(number) {
            return fail(Problem::NoHeader { first: text, columns: names.len() });
        }
        Self::located(names, delimiter, decimal, place, mapping)
    }

    /// Columns of a file without a header, known by their numbers.
    pub(crate) fn numbered(
        width: usize,
        place: &Place,
        dialect: &Dialect,
        mapping: &Mapping,
    ) -> Result<Self, ReadError> {
        let delimiter = dialect.delimiter.unwrap_or(Delimiter::Byte(b','));
        let decimal = dialect.decimal.unwrap_or_else(|| delimiter.decimal());
        let names = (1..=width).map(|n| format!("column {n}")).collect();
        Self::located(names, delimiter, decimal, place, mapping)
    }

    fn located(
        names: Vec<String>,
        delimiter: Delimiter,
        decimal: DecimalSign,
        place: &Place,
        mapping: &Mapping,
    ) -> Result<Self, ReadError> {
        let fail = |what: String, remedy: &str, seen: &[String]| {
            Err(ReadError {
                place: place.clone(),
                problem: Problem::Columns { what, remedy: remedy.into(), seen: seen.to_vec() },
            })
        };
        let mut index = BTreeMap::new();
        for known in KNOWN {
            let wanted = match mapping.get(known) {
                Some(ColumnRef::Number(n)) => {
                    match (*n as usize).checked_sub(1).filter(|i| *i < names.len()) {
                        Some(i) => {
                            index.insert(known, i);
                            continue;
                        }
                        None => {
                            let what = format!("no column number {n} (mapped to {known})");
                            return fail(what, "correct `columns` in experiment.toml", &names);
                        }
                    }
                }
                Some(ColumnRef::Name(name)) => name.as_str(),
                None => known,
            };
            let exact = matches(&names, |n| n == wanted);
            let found = if exact.is_empty() {
                matches(&names, |n| n.to_lowercase() == wanted.to_lowercase())
            } else {
                exact
            };
            match found[..] {
                [] if mapping.contains_key(known) => {
                    let what = format!("column `{wanted}` (mapped to {known}) is missing");
                    return fail(what, "correct `columns` in experiment.toml", &names);
                }
                [] => {}
                [one] => {
                    index.insert(known, one);
                }
                _ => {
                    let what = format!("column `{wanted}` occurs twice");
                    let remedy = format!(
                        "rename one of them, or name it by its number: columns = {{{known} = {}}}",
                        found[0] + 1
                    );
                    return fail(what, &remedy, &names);
                }
            }
        }
        let used: Vec<usize> = index.values().copied().collect();
        let ignored = names
            .iter()
            .enumerate()
            .filter(|(i, n)| !used.contains(i) && !n.is_empty())
            .map(|(_, n)| n.clone())
            .collect();
        let marks = Marks::new(names.len());
        Ok(Self { delimiter, decimal, names, index, ignored, marks })
    }

    /// Index of a known column.
    pub(crate) fn get(&self, known: &str) -> Option<usize> {
        self.index.get(known).copied()
    }

    /// Index of a column of the user's, used or not.
    pub(crate) fn find(&self, column: &str, place: &Place) -> Result<usize, ReadError> {
        match matches(&self.names, |n| n == column)[..] {
            [one] => Ok(one),
            _ => Err(ReadError {
                place: place.clone(),
                problem: Problem::Columns {
                    seen: self.names.clone(),
                    what: format!("`rows` names a column `{column}` that is not there once"),
                    remedy: "correct `rows` in experiment.toml".into(),
                },
            }),
        }
    }

    /// Index of a column that must be there.
    pub(crate) fn require(&self, known: &'static str, place: &Place) -> Result<usize, ReadError> {
        self.get(known).ok_or_else(|| self.missing(&[known], place))
    }

    /// Refuses a file in which one of these columns is missing; all that are missing are named at once.
    pub(crate) fn require_all(
        &self,
        wanted: &[&'static str],
        place: &Place,
    ) -> Result<(), ReadError> {
        let missing: Vec<&str> =
            wanted.iter().copied().filter(|known| self.get(known).is_none()).collect();
        if missing.is_empty() { Ok(()) } else { Err(self.missing(&missing, place)) }
    }

    /// The error for columns that must be there, with the likeliest headers as a proposal.
    pub(crate) fn missing(&self, known: &[&str], place: &Place) -> ReadError {
        let mapped: Vec<String> = known
            .iter()
            .map(|k| format!("{k} = \"{}\"", self.likeliest(k).unwrap_or("Your Header")))
            .collect();
        let named: Vec<String> = known.iter().map(|k| format!("no column `{k}`")).collect();
        ReadError {
            place: place.clone(),
            problem: Problem::Columns {
                seen: self.names.clone(),
                what: named.join(", "),
                remedy: format!(
                    "if other columns hold that, write columns = {{{}}} in [csv], or in its [[run]]",
                    mapped.join(", ")
                ),
            },
        }
    }

    /// The column that is likeliest to hold what a known one would.
    fn likeliest(&self, known: &str) -> Option<&str> {
        let wanted = role_of_known(known);
        let similar = |n: &&String| strsim::jaro_winkler(&n.to_lowercase(), known);
        let free = || self.ignored.iter().filter(|n| role(n).is_none() || role(n) == wanted);
        free()
            .find(|n| wanted.is_some() && role(n) == wanted)
            .or_else(|| free().max_by(|a, b| similar(a).total_cmp(&similar(b))))
            .map(String::as_str)
    }

    /// Name of a column as the header gives it.
    pub(crate) fn name(&self, index: usize) -> &str {
        self.names.get(index).map_or("?", String::as_str)
    }

    /// Refuses a header whose unit contradicts what experiment.toml says, or does not say.
    pub(crate) fn check_units(
        &self,
        place: &Place,
        dialect: &Dialect,
        output: (Quantizer, &str),
    ) -> Result<(), ReadError> {
        for (known, index) in &self.index {
            let name = self.name(*index);
            let Some(seen) = split_unit(name).1 else { continue };
            let Some(remedy) = contradiction(known, name, seen, dialect, output) else { continue };
            return Err(ReadError {
                place: Place { column: Some(name.to_owned()), ..place.clone() },
                problem: Problem::HeaderUnit { unit: seen.text(), remedy },
            });
        }
        Ok(())
    }
}

fn matches(names: &[String], fits: impl Fn(&String) -> bool) -> Vec<usize> {
    names.iter().enumerate().filter(|(_, n)| fits(n)).map(|(i, _)| i).collect()
}

/// What to write where a header's unit is not the one that the column would be read in.
fn contradiction(
    known: &str,
    header: &str,
    seen: HeaderUnit,
    dialect: &Dialect,
    (quantizer, unit): (Quantizer, &str),
) -> Option<String> {
    use HeaderUnit as U;
    let angle = |u: AngleUnit| {
        (dialect.angle_unit.is_none() && u != AngleUnit::Degrees)
            .then(|| format!("write angle_unit = \"{}\" in [bench]", u.name()))
    };
    let time = |u: TimeUnit| {
        (dialect.time_unit.is_none() && u != TimeUnit::Seconds)
            .then(|| format!("write time_unit = \"{}\" in [csv]", u.name()))
    };
    match (known, seen) {
        ("angle_deg", U::Gon) => angle(AngleUnit::Gon),
        ("angle_deg", U::Radians) => angle(AngleUnit::Radians),
        ("angle_deg", U::Grad) => dialect.angle_unit.is_none().then(|| {
            "Grad are degrees in German and gon elsewhere: write angle_unit = \"deg\" or \"gon\" in [bench]".into()
        }),
        ("t_s", U::Milliseconds) => time(TimeUnit::Milliseconds),
        ("t_s", U::Microseconds) => time(TimeUnit::Microseconds),
        ("t_s", U::Nanoseconds) => time(TimeUnit::Nanoseconds),
        ("t_s", U::LongTime) => Some(
            "times are read in s, ms, us and ns, or as dates: convert the column, or leave it out of `columns`".into(),
        ),
        ("code", u) => u.of_readings().map(|of| {
            format!(
                "codes are in LSB: write quantizer = \"none\" and unit = \"{of}\" in [output], and columns = {{output = \"{header}\"}}"
            )
        }),
        ("mean_code" | "std_code", u) if quantizer != Quantizer::None => {
            u.of_readings().map(|of| {
                format!(
                    "codes are in LSB: write quantizer = \"none\" and unit = \"{of}\" in [output], with nominal_scale in m/s² per {of}"
                )
            })
        }
        ("output" | "mean_code" | "std_code", u) => u.of_readings().filter(|of| !same_unit(of, unit)).map(|of| {
            format!("[output] says unit = \"{unit}\": write unit = \"{of}\", with nominal_scale in m/s² per {of}")
        }),
        ("temperature_degc", U::Fahrenheit | U::Kelvin) => {
            Some("temperatures are read in °C: convert the column, or leave it out of `columns`".into())
        }
        _ => None,
    }
}

fn same_unit(a: &str, b: &str) -> bool {
    let plain = |t: &str| t.replace('²', "2").replace('^', "").to_lowercase();
    plain(a) == plain(b)
}
