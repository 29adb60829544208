//! A stream of codes for `compensate`: with a header or without, from a file or standard input.

use std::io::Read;

use super::dialect::Dialect;
use super::header::{Columns, Mapping};
use super::lines::Lines;
use super::number::{DecimalSign, integer, real, trimmed};
use super::row::{FieldBuffer, Row};
use crate::error::{Place, Problem, ReadError};

/// One reading of a stream.
#[derive(Debug, Clone, PartialEq)]
pub struct Reading {
    /// Time as it was written, where the stream has a column `t_s`.
    pub time: Option<String>,
    /// The reading as it was written.
    pub text: String,
    /// The reading: a code, or a real number where the passport's converter does not quantize.
    pub value: f64,
    /// Temperature, where the stream has a column `temperature_degc`.
    pub temperature_degc: Option<f64>,
}

/// Alias of what a stream can fail with.
pub type CodeStreamError = ReadError;

/// Places of what is read.
struct Header {
    columns: Columns,
    reading: usize,
    time: Option<usize>,
    temperature: Option<usize>,
}

/// Codes from CSV text: a header with `code` (or `output`) and perhaps `t_s` and `temperature_degc`, or bare numbers, one a line.
pub struct CodeStream<R> {
    lines: Lines<R>,
    header: Option<Header>,
    /// A first line that was no header.
    first: Option<(u64, Vec<u8>)>,
    whole_codes: bool,
    buffer: FieldBuffer,
}

impl<R: Read> CodeStream<R> {
    /// Looks at the first line. `whole_codes`: readings must be integers.
    ///
    /// **Errors** [`ReadError`] where the first line is neither a header with a known column nor a number.
    pub fn new(reader: R, shown_as: &str, whole_codes: bool) -> Result<Self, CodeStreamError> {
        let mut lines = Lines::new(reader, shown_as);
        let first = lines.next_data()?.map(|(n, line)| (n, line.to_vec()));
        let mut stream =
            Self { lines, header: None, first: None, whole_codes, buffer: FieldBuffer::default() };
        let Some((number, line)) = first else { return Ok(stream) };
        if real(trimmed(&line), DecimalSign::CommaOrPoint).is_some() {
            stream.first = Some((number, line));
            return Ok(stream);
        }
        let place = Place::line(shown_as, number);
        let columns = Columns::parse(&line, &place, &Dialect::default(), &Mapping::new())?;
        let wanted = if whole_codes { "code" } else { "output" };
        let Some(reading) = columns.get(wanted) else {
            return Err(ReadError {
                place,
                problem: Problem::Columns {
                    seen: columns.names,
                    what: format!("no column `{wanted}`"),
                    remedy: format!("name the column `{wanted}`, or give bare numbers, one a line"),
                },
            });
        };
        let time = columns.get("t_s");
        let temperature = columns.get("temperature_degc");
        stream.header = Some(Header { columns, reading, time, temperature });
        Ok(stream)
    }

    /// Whether readings come with a time.
    #[must_use]
    pub fn has_time(&self) -> bool {
        self.header.as_ref().is_some_and(|h| h.time.is_some())
    }

    /// Whether readings come with a temperature.
    #[must_use]
    pub fn has_temperature(&self) -> bool {
        self.header.as_ref().is_some_and(|h| h.temperature.is_some())
    }

    /// The next reading.
    pub fn next_reading(&mut self) -> Result<Option<Reading>, CodeStreamError> {
        let file = self.lines.shown_as().to_owned();
        if let Some((number, line)) = self.first.take() {
            return bare(&file, number, &line, self.whole_codes).map(Some);
        }
        let whole = self.whole_codes;
        let Some((number, line)) = self.lines.next_data()? else { return Ok(None) };
        let Some(Header { columns, reading, time, temperature }) = &self.header else {
            return bare(&file, number, line, whole).map(Some);
        };
        let fields = self.buffer.split(line, columns.delimiter);
        let row = Row { fields, columns, file: &file, line: number };
        row.check_width()?;
        let text = trimmed(row.fields.get(*reading));
        let value = if whole {
            integer(text)
                .map(f64::from)
                .ok_or_else(|| row.wrong(*reading, "an integer code", "mend or remove the row"))?
        } else {
            row.real(*reading, "a number")?
        };
        let time = match time {
            Some(i) => {
                // Checked to be a number, so that nothing else passes through.
                row.real(*i, "a time in seconds")?;
                Some(String::from_utf8_lossy(trimmed(row.fields.get(*i))).replace(',', "."))
            }
            None => None,
        };
        let temperature_degc = match temperature {
            Some(i) => Some(row.real(*i, "a temperature in °C")?),
            None => None,
        };
        let text = String::from_utf8_lossy(text).replace(',', ".");
        Ok(Some(Reading { time, text, value, temperature_degc }))
    }
}

fn bare(file: &str, number: u64, line: &[u8], whole: bool) -> Result<Reading, ReadError> {
    let text = trimmed(line);
    let value =
        if whole { integer(text).map(f64::from) } else { real(text, DecimalSign::CommaOrPoint) };
    match value {
        Some(value) => {
            let text = String::from_utf8_lossy(text).replace(',', ".");
            Ok(Reading { time: None, text, value, temperature_degc: None })
        }
        None => Err(ReadError {
            place: Place::line(file, number),
            problem: Problem::Field {
                text: String::from_utf8_lossy(line).into_owned(),
                expected: if whole { "an integer code" } else { "a number" },
                remedy: "give one code a line, or a header with a column `code`",
            },
        }),
    }
}
