//! One row: its fields, and how to complain about them.

use super::header::Columns;
use super::number::{real, trimmed};
use crate::error::{Place, Problem, ReadError};

/// The places of a line's fields, kept from line to line so that nothing is allocated in the loop.
#[derive(Default)]
pub(super) struct FieldBuffer {
    ends: Vec<(usize, usize)>,
}

/// The fields of one line.
pub(super) struct Fields<'a> {
    line: &'a [u8],
    ends: &'a [(usize, usize)],
}

impl FieldBuffer {
    /// Splits a line; a field in quotes may hold the delimiter.
    #[inline]
    pub(super) fn split<'a>(&'a mut self, line: &'a [u8], delimiter: u8) -> Fields<'a> {
        self.ends.clear();
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
                quoted = !quoted;
            }
        }
        self.ends.push((start, line.len()));
        Fields { line, ends: &self.ends }
    }
}

impl<'a> Fields<'a> {
    pub(super) fn len(&self) -> usize {
        self.ends.len()
    }

    /// A field; the width was checked before.
    #[inline]
    pub(super) fn get(&self, index: usize) -> &'a [u8] {
        self.ends.get(index).map_or(&[], |(a, b)| &self.line[*a..*b])
    }
}

/// One line with what is needed to complain about it.
pub(super) struct Row<'a> {
    pub(super) fields: Fields<'a>,
    pub(super) columns: &'a Columns,
    pub(super) file: &'a str,
    /// Its number.
    pub(super) line: u64,
}

impl Row<'_> {
    pub(super) fn place(&self) -> Place {
        Place::line(self.file, self.line)
    }

    #[inline]
    pub(super) fn check_width(&self) -> Result<(), ReadError> {
        let (seen, expected) = (self.fields.len(), self.columns.names.len());
        if seen == expected {
            return Ok(());
        }
        Err(ReadError { place: self.place(), problem: Problem::Fields { seen, expected } })
    }

    pub(super) fn real(&self, index: usize, expected: &'static str) -> Result<f64, ReadError> {
        let text = trimmed(self.fields.get(index));
        real(text, self.columns.decimal).ok_or_else(|| {
            let remedy = match text {
                [] => "fill in the empty cell or remove the row",
                t if t.contains(&b',') => "write a decimal point, and no thousands marks",
                _ => "mend or remove the row",
            };
            self.wrong(index, expected, remedy)
        })
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
                text: String::from_utf8_lossy(self.fields.get(index)).into_owned(),
                expected,
                remedy,
            },
        }
    }
}
