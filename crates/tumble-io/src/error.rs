//! Input that cannot be read: what, where, and one thing to do about it.

use std::fmt;
use std::path::PathBuf;

/// A place in an input.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Place {
    /// File, as the user named it.
    pub file: String,
    /// Line, counted from one.
    pub line: Option<u64>,
    /// Column: a field's name, or a character's number in a text file.
    pub column: Option<String>,
}

impl Place {
    /// A whole file.
    #[must_use]
    pub fn file(file: impl Into<String>) -> Self {
        Self { file: file.into(), ..Self::default() }
    }
    /// A line of a file.
    #[must_use]
    pub fn line(file: impl Into<String>, line: u64) -> Self {
        Self { file: file.into(), line: Some(line), column: None }
    }
    /// A field in a line.
    #[must_use]
    pub fn field(file: impl Into<String>, line: u64, column: impl Into<String>) -> Self {
        Self { file: file.into(), line: Some(line), column: Some(column.into()) }
    }
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&visible(&self.file))?;
        if let Some(line) = self.line {
            write!(f, ", line {line}")?;
        }
        if let Some(column) = &self.column {
            write!(f, ", column {}", visible(column))?;
        }
        Ok(())
    }
}

/// Text from outside, safe to print on a terminal: control characters become visible.
pub(crate) fn printable(text: &str) -> String {
    text.chars().map(|c| if c.is_control() { '\u{fffd}' } else { c }).collect()
}

/// [`printable`], and cut where it is long.
pub(crate) fn visible(text: &str) -> String {
    cut(text, 80)
}

/// A sentence that holds text from outside: [`printable`], and cut where nobody reads on.
fn sentence(text: &str) -> String {
    cut(text, 600)
}

fn cut(text: &str, longest: usize) -> String {
    let mut out: String = printable(text).chars().take(longest).collect();
    if text.chars().nth(longest).is_some() {
        out.push('…');
    }
    out
}

/// A list for people: the first forty, and how many more there are.
pub(crate) fn first_of(names: &[String]) -> String {
    const SHOWN: usize = 40;
    let shown: Vec<String> = names.iter().take(SHOWN).map(|n| cut(n, 82)).collect();
    let mut out = shown.join(", ");
    if names.len() > SHOWN {
        out.push_str(&format!(", and {} more", names.len() - SHOWN));
    }
    out
}

/// Input that cannot be read; nothing was judged.
#[derive(Debug)]
pub struct ReadError {
    /// Where.
    pub place: Place,
    /// What.
    pub problem: Problem,
}

/// What is wrong with an input.
#[derive(Debug)]
pub enum Problem {
    /// The operating system refused.
    Io(std::io::Error),
    /// Not an experiment folder.
    NoExperiment {
        /// The folder.
        folder: PathBuf,
    },
    /// TOML that does not parse, or a value of the wrong type.
    Toml {
        /// What the parser says.
        message: String,
    },
    /// A key that is not known.
    UnknownKey {
        /// The key.
        key: String,
        /// The nearest known one.
        nearest: Option<String>,
        /// Known keys.
        known: Vec<String>,
    },
    /// A key that must be there.
    MissingKey {
        /// The key with its table.
        key: &'static str,
        /// What to write.
        example: &'static str,
    },
    /// A value that is not possible.
    Value {
        /// The key with its table.
        key: String,
        /// What was given.
        given: String,
        /// What is possible.
        expected: String,
    },
    /// A path that leaves the folder.
    OutsideFolder {
        /// The path.
        path: String,
    },
    /// A file that experiment.toml names and that is not there.
    NoFile {
        /// The file.
        path: String,
        /// A file of the folder whose name is much like it.
        nearest: Option<String>,
    },
    /// A name that occurs twice or not at all.
    RunName {
        /// The name.
        name: String,
        /// Names that exist.
        known: Vec<String>,
    },
    /// A file in a form that is not read.
    Format {
        /// What it looks like.
        seen: &'static str,
        /// What to do.
        remedy: &'static str,
    },
    /// More bytes than a compressed file may hold.
    TooLarge {
        /// Limit in bytes.
        limit: u64,
    },
    /// More bytes than a packed file of its size may hold.
    TooDense {
        /// Limit of unpacked over stored bytes.
        limit: u64,
    },
    /// A packed file that does not unpack.
    Damaged {
        /// gzip or zstd.
        packing: &'static str,
        /// What the decoder says.
        message: String,
    },
    /// A document that is longer than any of its kind.
    TooLong {
        /// Limit in bytes.
        limit: u64,
    },
    /// More dwells than a file may hold.
    TooManyDwells {
        /// Limit of dwells.
        limit: usize,
    },
    /// More different codes, over all dwells of a file, than are kept.
    TooManyCodes {
        /// Limit of codes.
        limit: usize,
    },
    /// The file was written to while it was read.
    Changed,
    /// A line that is too long to be data.
    LineTooLong {
        /// Limit in bytes.
        limit: usize,
    },
    /// No header line, or no rows.
    Empty {
        /// What is missing.
        what: &'static str,
    },
    /// Columns that do not make a run file.
    Columns {
        /// The header's columns.
        seen: Vec<String>,
        /// What is missing or doubled.
        what: String,
        /// What to write.
        remedy: String,
    },
    /// Numbers where the header is expected.
    NoHeader {
        /// The line.
        first: String,
        /// Its fields.
        columns: usize,
    },
    /// A header whose unit is not the one that its column would be read in.
    HeaderUnit {
        /// What the header says.
        unit: &'static str,
        /// What to write.
        remedy: String,
    },
    /// A row with another number of fields than the header.
    Fields {
        /// In the row.
        seen: usize,
        /// In the header.
        expected: usize,
        /// The separator's name.
        delimiter: &'static str,
        /// The row.
        text: String,
        /// All its fields are numbers.
        numbers: bool,
    },
    /// A field that is not what its column holds.
    Field {
        /// The text.
        text: String,
        /// What was expected.
        expected: &'static str,
        /// What to do.
        remedy: &'static str,
    },
    /// A document of another kind, or one that does not say what is needed.
    Document {
        /// What it is, or lacks.
        what: String,
        /// What to do.
        remedy: &'static str,
    },
    /// A problem of which a look at the file tells more.
    Advised {
        /// The problem.
        problem: Box<Problem>,
        /// What to write.
        advice: String,
    },
    /// Another number of angles than of dwells in a continuous record.
    AnglesOfDwells {
        /// Angles that experiment.toml lists.
        listed: usize,
        /// Dwells that were found: lines and level of each.
        found: Vec<String>,
    },
    /// A dwell or record that is too long to be searched for where it stands still.
    TooLongToSearch {
        /// Limit of samples.
        limit: usize,
    },
    /// A dwell that holds more different codes than noise can make.
    NotADwell {
        /// Limit of different codes.
        limit: usize,
    },
}

impl Problem {
    /// A key that is not known, with the nearest known one.
    pub(crate) fn unknown_key(key: &str, known: Vec<String>) -> Self {
        let nearest = nearest(key, &known);
        Self::UnknownKey { key: key.to_owned(), nearest, known }
    }
}

/// The known name that is most like one that is not, if any is.
pub(crate) fn nearest(name: &str, known: &[String]) -> Option<String> {
    known
        .iter()
        .map(|k| (strsim::jaro_winkler(&name.to_lowercase(), &k.to_lowercase()), k))
        .filter(|(similar, _)| *similar > 0.75)
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .map(|(_, k)| k.clone())
}

impl fmt::Display for ReadError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.place, self.problem)
    }
}

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let list = |names: &[String]| {
            let quoted: Vec<String> = names.iter().map(|n| format!("`{}`", visible(n))).collect();
            first_of(&quoted)
        };
        match self {
            Self::Io(e) => f.write_str(&crate::advice(e)),
            Self::Damaged { packing, message } => write!(
                f,
                "the {packing} file is damaged or was cut off ({}); copy it again, or unpack what is left and look at it",
                visible(message)
            ),
            Self::TooLong { limit } => write!(
                f,
                "more than {} MiB; no such file is that long: is this another file?",
                limit >> 20
            ),
            Self::TooManyDwells { limit } => write!(
                f,
                "more than {limit} dwells; dwells are consecutive rows of one angle, so check the angle column, or give \
                 averages in several files"
            ),
            Self::TooManyCodes { limit } => write!(
                f,
                "more than {limit} different codes in the dwells of one file; split the file into runs, or give averages"
            ),
            Self::NoExperiment { folder } => write!(
                f,
                "no experiment.toml in {}; an experiment is a folder with experiment.toml and its run files \
                 (`tumble simulate OUT --preset paper-3` writes one to look at)",
                visible(&folder.display().to_string())
            ),
            Self::Toml { message } => write!(f, "{}", visible_lines(message)),
            Self::UnknownKey { key, nearest, known } => {
                write!(f, "unknown key `{}`", visible(key))?;
                match nearest {
                    Some(n) => write!(f, "; did you mean `{n}`?"),
                    None => {
                        write!(f, "; remove it, or use one of those known here: {}", list(known))
                    }
                }
            }
            Self::MissingKey { key, example } => write!(f, "{key} is missing; write {example}"),
            Self::Value { key, given, expected } => {
                write!(f, "{key} = {} is not possible; give {expected}", visible(given))
            }
            Self::OutsideFolder { path } if path.contains('\\') => write!(
                f,
                "`{}` has backslashes; write / between folders, and a path inside the experiment folder",
                visible(path)
            ),
            Self::OutsideFolder { path } => write!(
                f,
                "`{}` leaves the experiment folder; copy the file into the folder and name it relative to experiment.toml",
                visible(path)
            ),
            Self::NoFile { path, nearest } => {
                write!(f, "`{}` is not in the folder", visible(path))?;
                match nearest {
                    Some(n) => write!(f, "; did you mean `{}`?", visible(n)),
                    None => f.write_str("; name a file that lies beside experiment.toml"),
                }
            }
            Self::RunName { name, known } => write!(
                f,
                "`{}` must name exactly one run; the runs are {}. A run is named after its file, or by `name`",
                visible(name),
                list(known)
            ),
            Self::Document { what, remedy } => write!(f, "{}; {remedy}", sentence(what)),
            Self::Format { seen, remedy } => write!(f, "{seen}; {remedy}"),
            Self::TooLarge { limit } => write!(
                f,
                "unpacks to more than {} GiB; split the record into one file a run",
                limit >> 30
            ),
            Self::TooDense { limit } => write!(
                f,
                "unpacks to more than {limit} times its size; no record of a converter does: unpack it and look at it"
            ),
            Self::Changed => f.write_str(
                "the file was written to while it was read; stop the logger, or copy the finished part into the folder",
            ),
            Self::NoHeader { first, columns } => write!(
                f,
                "`{}` holds numbers where names of columns are expected; name them in a first line, or write \
                 header_line = 0 and columns = {{angle_deg = 1, code = {}}} in [csv] (numbers of the columns)",
                visible(first),
                (*columns).max(1)
            ),
            Self::HeaderUnit { unit, remedy } => write!(f, "the header says {unit}; {}", sentence(remedy)),
            Self::Advised { problem, advice } => write!(f, "{problem}. {}", sentence(advice)),
            Self::AnglesOfDwells { listed, found } => {
                const SHOWN: usize = 80;
                write!(
                    f,
                    "angles_deg lists {listed} angles, and the sensor stood still {} times: {}{}; list the dial's angle for \
                     each of them in this order, nan for one that does not count",
                    found.len(),
                    found.iter().take(SHOWN).cloned().collect::<Vec<_>>().join(", "),
                    if found.len() > SHOWN { ", …" } else { "" }
                )
            }
            Self::TooLongToSearch { limit } => write!(
                f,
                "more than {limit} samples to be searched for where the sensor stood still; give discard_s in seconds, or \
                 split the record"
            ),
            Self::LineTooLong { limit } => {
                write!(
                    f,
                    "a line longer than {limit} bytes; give a CSV file with one reading a line (is this a binary file?)"
                )
            }
            Self::Empty { what } => write!(f, "{what}"),
            Self::Columns { seen, what, remedy } => {
                write!(
                    f,
                    "{}; the header has {}; {}",
                    sentence(what),
                    list(seen),
                    sentence(remedy)
                )
            }
            Self::Fields { seen, expected, delimiter, text, numbers } => write!(
                f,
                "`{}` has {} where the header has {expected} (separated by {}); {}",
                visible(text),
                if *seen == 1 { "1 field".to_owned() } else { format!("{seen} fields") },
                match *delimiter {
                    "tab" | "blanks" => format!("{delimiter}s").replace("ss", "s"),
                    mark => format!("`{mark}`"),
                },
                if *delimiter == "," && seen > expected && *numbers {
                    "decimal commas between commas cannot be told apart: export with `;`, or with decimal points"
                } else if seen > expected {
                    "mend or remove the row, or put rows of another kind into a file of their own"
                } else {
                    "mend or remove the row, or begin it with `#` (a truncated last line is common)"
                }
            ),
            Self::Field { text, expected, remedy } if text.is_empty() => {
                write!(f, "the cell is empty and should hold {expected}; {remedy}")
            }
            Self::Field { text, expected, remedy } => {
                write!(f, "`{}` is not {expected}; {remedy}", visible(text))
            }
            Self::NotADwell { limit } => write!(
                f,
                "one dwell with more than {limit} different codes; dwells are consecutive rows of one angle, so check the angle column"
            ),
        }
    }
}

/// A parser's message and its remedy have several lines; each is made visible.
fn visible_lines(text: &str) -> String {
    text.lines().take(12).map(|line| cut(line, 240)).collect::<Vec<_>>().join("; ")
}

impl std::error::Error for ReadError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match &self.problem {
            Problem::Io(e) => Some(e),
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lists_end() {
        let names: Vec<String> = (0..1000).map(|i| i.to_string()).collect();
        assert!(first_of(&names).ends_with("38, 39, and 960 more"), "{}", first_of(&names));
        assert_eq!(first_of(&names[..2]), "0, 1");
    }
}
