//! What the columns of a file hold: one pass over the file, a few numbers a column.

use std::collections::BTreeSet;
use std::path::Path;

use crate::csv::{
    CodeFormat, DecimalSign, FieldBuffer, HeaderUnit, Lines, Role, Sketch, date_s, decoded, dms,
    real, role, says_missing, sketch_file, trimmed,
};
use crate::error::{Place, Problem, ReadError};
use crate::source::{Source, Watch};

/// Different texts of a column that are kept.
const TEXTS: usize = 24;
/// Steps of a column that are kept to find the typical one.
const STEPS: usize = 1 << 12;

/// One column.
#[derive(Debug, Clone)]
pub(super) struct Column {
    pub(super) name: String,
    pub(super) unit: Option<HeaderUnit>,
    pub(super) role: Option<Role>,
    pub(super) filled: u64,
    pub(super) missing: u64,
    pub(super) numbers: u64,
    pub(super) whole: u64,
    /// Hexadecimal fields that are no decimal numbers.
    pub(super) hexadecimal: u64,
    /// Digits of the longest hexadecimal field.
    pub(super) hex_digits: usize,
    pub(super) dates: u64,
    /// Degrees, minutes, seconds that are no plain numbers.
    pub(super) dms: u64,
    pub(super) least: f64,
    pub(super) largest: f64,
    pub(super) changes: u64,
    pub(super) rising: u64,
    pub(super) falling: u64,
    /// Steps upward, from row to row.
    steps: Vec<f64>,
    /// Different texts, as long as they are few.
    pub(super) texts: BTreeSet<String>,
    last: Vec<u8>,
    last_number: f64,
}

impl Column {
    fn new(name: &str, unit: Option<HeaderUnit>) -> Self {
        Self {
            name: name.to_owned(),
            unit,
            role: role(name),
            filled: 0,
            missing: 0,
            numbers: 0,
            whole: 0,
            hexadecimal: 0,
            hex_digits: 0,
            dates: 0,
            dms: 0,
            least: f64::INFINITY,
            largest: f64::NEG_INFINITY,
            changes: 0,
            rising: 0,
            falling: 0,
            steps: Vec::new(),
            texts: BTreeSet::new(),
            last: Vec::new(),
            last_number: f64::NAN,
        }
    }

    fn see(&mut self, field: &[u8], decimal: DecimalSign) {
        if says_missing(field) {
            self.missing += 1;
            return;
        }
        if field != self.last.as_slice() {
            self.changes += u64::from(self.filled > 0);
            self.last.clear();
            self.last.extend_from_slice(field);
            if self.texts.len() <= TEXTS {
                self.texts.insert(decoded(field));
            }
        }
        self.filled += 1;
        if let Some(number) = real(field, decimal) {
            self.numbers += 1;
            self.whole += u64::from(number.fract() == 0.0);
            self.step_to(number);
            self.least = self.least.min(number);
            self.largest = self.largest.max(number);
        } else if let Some(t) = date_s(field) {
            self.dates += 1;
            self.step_to(t);
        }
        // `10:15:30` may be a time of day, or degrees: the column's name tells.
        if real(field, decimal).is_none() && dms(field, decimal).is_some() {
            self.dms += 1;
        }
        let hex = CodeFormat { hexadecimal: true, bits: None, offset: 0 };
        if field.len() <= 10 && hex.code(field).is_some() {
            let digits = field.len()
                - if field.starts_with(b"0x") || field.starts_with(b"0X") { 2 } else { 0 };
            self.hex_digits = self.hex_digits.max(digits);
            self.hexadecimal += u64::from(real(field, decimal).is_none());
        }
    }

    fn step_to(&mut self, number: f64) {
        let step = number - self.last_number;
        self.rising += u64::from(step > 0.0);
        self.falling += u64::from(step < 0.0);
        if step > 0.0 && self.steps.len() < STEPS {
            self.steps.push(step);
        }
        self.last_number = number;
    }

    /// The median of the steps upward: pauses between dwells do not count.
    pub(super) fn typical_step(&self) -> Option<f64> {
        let mut steps = self.steps.clone();
        steps.sort_by(f64::total_cmp);
        steps.get(steps.len() / 2).copied()
    }

    /// Whether it goes up as times do: a clock may be set back, but does not go up and down.
    pub(super) fn goes_up(&self) -> bool {
        self.rising > 0 && self.falling * 10 <= self.rising
    }

    /// Whether all that is filled is numbers.
    pub(super) fn is_numeric(&self) -> bool {
        self.filled > 0 && self.numbers == self.filled
    }

    /// Whether all that is filled is whole numbers, decimal or hexadecimal.
    pub(super) fn is_codes(&self) -> bool {
        self.filled > 0 && (self.whole == self.filled || self.is_hexadecimal())
    }

    /// Whether its readings are real numbers: by their unit, else because they are not whole.
    pub(super) fn is_real(&self) -> bool {
        let decimals = self.is_numeric() && !self.is_codes();
        self.unit.and_then(HeaderUnit::of_readings).is_some() || decimals
    }

    pub(super) fn is_hexadecimal(&self) -> bool {
        self.hexadecimal > 0 && self.whole + self.hexadecimal == self.filled
    }

    /// Whether it rises from nearly every row to the next.
    pub(super) fn always_rises(&self) -> bool {
        self.filled > 8 && self.rising * 20 >= (self.filled - 1) * 19
    }

    /// Whether it stays for rows on end.
    pub(super) fn stays(&self) -> bool {
        self.changes * 4 < self.filled
    }
}

/// A file after the survey.
#[derive(Debug, Clone)]
pub(super) struct Survey {
    pub(super) shown_as: String,
    pub(super) sketch: Sketch,
    pub(super) columns: Vec<Column>,
}

/// Surveys a file.
pub(super) fn survey(path: &Path, shown_as: &str, watch: &dyn Watch) -> Result<Survey, ReadError> {
    let Some(sketch) = sketch_file(path, shown_as)? else {
        let empty = std::fs::metadata(path).is_ok_and(|m| m.len() == 0);
        return Err(ReadError {
            place: Place::file(shown_as),
            problem: Problem::Empty {
                what: if empty {
                    "the file is empty; a record has a header and rows such as `angle_deg,code` and `-30,1108`"
                } else {
                    "no rows of numbers were found; a record has a header and rows such as `angle_deg,code` and `-30,1108`"
                },
            },
        });
    };
    if let Some(expected) = sketch.narrow_header {
        return Err(ReadError {
            place: Place::line(shown_as, sketch.data_line),
            problem: Problem::Fields {
                seen: sketch.names.len(),
                expected,
                delimiter: sketch.delimiter.name(),
                text: sketch.first_row,
                numbers: true,
            },
        });
    }
    let decimal = sketch.decimal();
    let mut columns: Vec<Column> =
        sketch.names.iter().zip(&sketch.units).map(|(n, u)| Column::new(n, *u)).collect();
    let comment = sketch.comment.unwrap_or_default().as_bytes();
    let mut lines =
        Lines::new(Source::open(path, shown_as)?.watched(watch), shown_as).with_comment(comment);
    lines.skip_to(sketch.data_line)?;
    let mut buffer = FieldBuffer::default();
    while let Some((_, line)) = lines.next_data()? {
        let fields = buffer.split(line, sketch.delimiter);
        // A row that is too short says nothing about its columns; reading will refuse it.
        if fields.len() < columns.len() {
            continue;
        }
        for (i, column) in columns.iter_mut().enumerate() {
            column.see(trimmed(fields.get(i)), decimal);
        }
    }
    Ok(Survey { shown_as: shown_as.to_owned(), sketch, columns })
}
