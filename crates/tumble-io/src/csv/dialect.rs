//! How a run file is written, as `[csv]` of experiment.toml says. What is not said follows from the file alone where
//! only one reading is possible; else it is refused.

use super::clock::TimeUnit;
use super::dial::AngleUnit;
use super::number::{CodeFormat, DecimalSign};

/// Separator of fields.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Delimiter {
    /// One byte.
    Byte(u8),
    /// Any run of blanks and tabs; those at the start count for nothing.
    Blanks,
}

impl Delimiter {
    /// Name in experiment.toml.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Byte(b';') => ";",
            Self::Byte(b'\t') => "tab",
            Self::Byte(b'|') => "|",
            Self::Byte(_) => ",",
            Self::Blanks => "blanks",
        }
    }

    /// By its name in experiment.toml.
    pub(crate) fn named(name: &str) -> Option<Self> {
        Some(match name {
            "," => Self::Byte(b','),
            ";" => Self::Byte(b';'),
            "|" => Self::Byte(b'|'),
            "tab" | "\t" => Self::Byte(b'\t'),
            "blanks" | "blank" | " " => Self::Blanks,
            _ => return None,
        })
    }

    /// What a header line shows: `;`, else a tab, else `|`, else `,`. Blanks stand in names, too.
    pub(crate) fn of_header(text: &str) -> Self {
        let separator = [b';', b'\t', b'|'].into_iter().find(|b| text.contains(char::from(*b)));
        Self::Byte(separator.unwrap_or(b','))
    }

    /// How numbers are written beside this separator, where nobody says it.
    pub(crate) fn decimal(self) -> DecimalSign {
        match self {
            Self::Byte(b',') => DecimalSign::Point,
            _ => DecimalSign::CommaOrPoint,
        }
    }
}

/// What is done with rows that hold no reading.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(crate) enum Missing {
    /// They are an error.
    #[default]
    Refuse,
    /// They are left out, counted and named (T0317).
    Skip,
}

/// How a file is written.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct Dialect {
    /// Line of the header; 0: there is none. Else the first line that is neither blank nor a comment.
    pub(crate) header_line: Option<u64>,
    /// First line of data, where something stands between header and data.
    pub(crate) data_line: Option<u64>,
    pub(crate) delimiter: Option<Delimiter>,
    pub(crate) decimal: Option<DecimalSign>,
    /// Lines that begin so are left out, as those that begin with `#`.
    pub(crate) comment: Vec<u8>,
    pub(crate) missing: Missing,
    pub(crate) codes: CodeFormat,
    /// Not said: seconds, unless the header says otherwise (then it is refused).
    pub(crate) time_unit: Option<TimeUnit>,
    /// Not said: degrees, unless the header says otherwise (then it is refused).
    pub(crate) angle_unit: Option<AngleUnit>,
}
