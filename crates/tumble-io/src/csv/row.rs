//! One row: its fields, and how to complain about them.

use super::clock::{TimeUnit, date_s};
use super::dial::{AngleUnit, dms};
use super::dialect::{Delimiter, Dialect};
use super::header::{Columns, decoded};
use super::number::{CodeFormat, DecimalSign, has_thousands, integer, real, says_missing, trimmed};
use crate::error::{Place, Problem, ReadError};

/// The places of a line's fields, kept from line to line so that nothing is allocated in the loop.
#[derive(Default)]
pub(crate) struct FieldBuffer {
    ends: Vec<(usize, usize)>,
}

/// The fields of one line.
pub(crate) struct Fields<'a> {
    line: &'a [u8],
    ends: &'a [(usize, usize)],
}

impl FieldBuffer {
    /// Splits a line; a field in quotes may hold the delimiter. A quote within a field is a mark of seconds, or of nothing.
    #[inline]
    pub(crate) fn split<'a>(&'a mut self, line: &'a [u8], delimiter: Delimiter) -> Fields<'a> {
        self.ends.clear();
        let Delimiter::Byte(delimiter) = delimiter else {
            self.split_at_blanks(line);
            return Fields { line, ends: &self.ends };
        };
        let mut start = 0;
        if memchr::memchr(b'"', line).is_none() {
            for end in memchr::memchr_iter(delimiter, line) {
                self.ends.push((start, end));
                start = end + 1;
            }
            self.ends.push((start, line.len()));
            return Fields { line, ends: &self.ends };
        }
        let mut quoted = false;
        for (i, b) in line.iter().enumerate() {
            if *b == delimiter && !quoted {
                self.ends.push((start, i));
                start = i + 1;
            } else if *b == b'"' {
                let before = &line[start..i];
                let opens = before.ends_with(b"\"") || before.trim_ascii().is_empty();
                quoted = !quoted && opens;
            }
        }
        self.ends.push((start, line.len()));
        Fields { line, ends: &self.ends }
    }

    fn split_at_blanks(&mut self, line: &[u8]) {
        let mut start = None;
        for (i, b) in line.iter().enumerate() {
            match (start, b.is_ascii_whitespace()) {
                (None, false) => start = Some(i),
                (Some(from), true) => {
                    self.ends.push((from, i));
                    start = None;
                }
                _ => {}
            }
        }
        if let Some(from) = start {
            self.ends.push((from, line.len()));
        }
    }
}

impl<'a> Fields<'a> {
    pub(crate) fn len(&self) -> usize {
        self.ends.len()
    }

    /// A field; the width was checked before.
    #[inline]
    pub(crate) fn get(&self, index: usize) -> &'a [u8] {
        self.ends.get(index).map_or(&[], |(a, b)| &self.line[*a..*b])
    }
}

const DECIMAL_COMMA: &str = "write a decimal point, and no thousands marks; where all numbers have decimal commas, decimal = \",\" in [csv]";
const THOUSANDS: &str = "write the number without thousands marks";
const BOTH_MARKS: &str = "where decimal commas stand in the same column, 1.000 may be one, or a thousand: write the whole \
     column with one decimal mark, and without thousands marks";
const MISSING: &str = "fill in the cell or remove the row; missing = \"skip\" in [csv] leaves rows without a reading out";

/// No dial counts farther: a thousand turns.
const FARTHEST_DIAL_DEG: f64 = 360_000.0;

/// Nanoseconds since 1970 that are taken for seconds stay below; differences of such times are finite.
const FARTHEST_TIME_S: f64 = 1e20;

/// What to do about a code that is none.
fn code_remedy(text: &[u8], format: CodeFormat) -> &'static str {
    let hex = CodeFormat { hexadecimal: true, bits: None, offset: 0 };
    match text {
        t if says_missing(t) => MISSING,
        t if format.bits.is_some() && format.code(t).is_none() && integer(t).is_some() => {
            "correct code_bits in [csv], or remove it where codes carry their sign"
        }
        t if has_thousands(t) => {
            "codes are whole LSB without thousands marks; volts, g or m/s² go into a column `output` with quantizer = \"none\""
        }
        t if !format.hexadecimal && hex.code(t).is_some() => {
            "write code_format = \"hex\" in [csv], and code_bits = 16 where the words are 16 bits with a sign"
        }
        _ => {
            "codes are whole LSB; volts, g or m/s² go into a column `output` with quantizer = \"none\", averages into `mean_code`"
        }
    }
}

/// One line with what is needed to complain about it.
pub(crate) struct Row<'a> {
    pub(crate) fields: Fields<'a>,
    pub(crate) columns: &'a Columns,
    pub(crate) file: &'a str,
    /// Its number.
    pub(crate) line: u64,
}

impl Row<'_> {
    pub(super) fn place(&self) -> Place {
        Place::line(self.file, self.line)
    }

    #[inline]
    pub(crate) fn check_width(&self) -> Result<(), ReadError> {
        let (seen, expected) = (self.fields.len(), self.columns.names.len());
        if seen == expected {
            return Ok(());
        }
        // Separators at the end of a row hold nothing.
        if seen > expected && (expected..seen).all(|i| trimmed(self.fields.get(i)).is_empty()) {
            return Ok(());
        }
        Err(ReadError {
            place: self.place(),
            problem: Problem::Fields {
                seen,
                expected,
                delimiter: self.columns.delimiter.name(),
                text: decoded(self.fields.line),
                numbers: (0..seen).all(|i| real(self.text(i), DecimalSign::Point).is_some()),
            },
        })
    }

    /// A field without blanks and quotes around it.
    pub(crate) fn text(&self, index: usize) -> &[u8] {
        trimmed(self.fields.get(index))
    }

    /// A code, as `[csv]` says that codes are written.
    #[inline]
    pub(super) fn code(&self, index: usize, format: CodeFormat) -> Result<i32, ReadError> {
        let field = self.fields.get(index);
        let plain = if format.is_plain() { integer(field) } else { None };
        plain.or_else(|| format.code(field)).ok_or_else(|| {
            let expected = match format.bits {
                Some(_) => "a code of so many bits as code_bits says, without a sign",
                None => "an integer code",
            };
            self.wrong(index, expected, code_remedy(trimmed(field), format))
        })
    }

    /// A reading of the dial, in the dial's own unit.
    pub(super) fn dial(&self, index: usize, dialect: &Dialect) -> Result<f64, ReadError> {
        let unit = dialect.angle_unit.unwrap_or_default();
        let text = self.text(index);
        self.check_marks(index)?;
        let possible = |v: &f64| (v * unit.in_deg()).abs() <= FARTHEST_DIAL_DEG;
        unit.value(text, self.columns.decimal).filter(possible).ok_or_else(|| {
            let remedy = match text {
                t if t == self.columns.name(index).as_bytes() => {
                    "it is the header once more: remove the row"
                }
                [] => "fill in the empty cell (the angle stands in every row), or remove the row",
                t if unit != AngleUnit::DegreesMinutesSeconds && dms(t, DecimalSign::CommaOrPoint).is_some() => {
                    "write angle_unit = \"dms\" in [bench] where these are degrees, minutes and seconds"
                }
                t if t.contains(&b',') => DECIMAL_COMMA,
                _ => "mend or remove the row",
            };
            self.wrong(index, unit.expected(), remedy)
        })
    }

    /// A time, s.
    #[inline]
    pub(crate) fn time_s(&self, index: usize, dialect: &Dialect) -> Result<f64, ReadError> {
        let unit = dialect.time_unit.unwrap_or_default();
        let text = self.text(index);
        if unit != TimeUnit::Date {
            self.check_marks(index)?;
        }
        let possible = |t: &f64| t.abs() <= FARTHEST_TIME_S;
        unit.seconds(text, self.columns.decimal).filter(possible).ok_or_else(|| {
            let remedy = match text {
                [] => "fill in the empty cell, remove the row, or leave the time out of `columns`",
                t if unit != TimeUnit::Date && date_s(t).is_some() => {
                    "write time_unit = \"date\" in [csv] where these are dates or times of day"
                }
                t if t.contains(&b',') => DECIMAL_COMMA,
                t if t.contains(&b'/') => {
                    "write dates as 2026-11-20T10:15:30: 11/20 and 20/11 cannot be told apart"
                }
                _ => "mend or remove the row",
            };
            self.wrong(index, unit.expected(), remedy)
        })
    }

    pub(crate) fn real(&self, index: usize, expected: &'static str) -> Result<f64, ReadError> {
        let text = self.text(index);
        self.check_marks(index)?;
        real(text, self.columns.decimal).ok_or_else(|| {
            let remedy = match text {
                t if says_missing(t) => MISSING,
                t if has_thousands(t) && self.columns.decimal == DecimalSign::CommaOrPoint => {
                    THOUSANDS
                }
                t if t.contains(&b',') => DECIMAL_COMMA,
                _ => "mend or remove the row",
            };
            self.wrong(index, expected, remedy)
        })
    }

    /// Refuses a number whose decimal mark contradicts those of its column.
    #[inline]
    fn check_marks(&self, index: usize) -> Result<(), ReadError> {
        let both = self.columns.decimal == DecimalSign::CommaOrPoint
            && !self.columns.marks.agree(index, self.text(index));
        let expected = "written like the rest of its column";
        if both { Err(self.wrong(index, expected, BOTH_MARKS)) } else { Ok(()) }
    }

    pub(super) fn wrong(
        &self,
        index: usize,
        expected: &'static str,
        remedy: &'static str,
    ) -> ReadError {
        ReadError {
            place: Place::field(self.file, self.line, self.columns.name(index)),
            problem: Problem::Field {
                text: String::from_utf8_lossy(self.text(index)).into_owned(),
                expected,
                remedy,
            },
        }
    }
}
