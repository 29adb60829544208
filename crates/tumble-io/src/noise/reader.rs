//! A record at rest, reading by reading, with bounded memory.

use std::path::Path;

use tumble_core::noise::{FIRST_READINGS, NoiseRecord, Step, StepWatch};

use super::NoiseFailure;
use crate::csv::{
    ColumnRef, Columns, DecimalSign, Dialect, FieldBuffer, Lines, Mapping, Row, real, says_missing,
    trimmed,
};
use crate::error::{Place, Problem, ReadError};
use crate::source::{Source, Watch};

/// Readings that are handed on at once.
const BATCH: usize = 1 << 14;

/// What reading gives beside the record.
pub(super) struct Read {
    /// Digest of the file as it is stored.
    pub sha256: String,
    /// Distance of the readings.
    pub interval_s: f64,
    /// Where it comes from: `rate` or `times`.
    pub times: Option<StepWatch>,
    /// Rows without a reading.
    pub without: u64,
    /// The column that was read; `None` for bare numbers.
    pub column: Option<String>,
    /// The file has times, and they were not used.
    pub times_unused: bool,
}

/// Where the fields of a row stand.
struct Layout {
    columns: Columns,
    reading: usize,
    time: Option<usize>,
}

/// Hands readings on in batches, and cuts the record where times say so.
struct Feed<'r> {
    record: &'r mut NoiseRecord,
    batch: Vec<f64>,
    /// The first readings with their times, until the step is known.
    first: Vec<(u64, f64, f64)>,
    /// Rows without a reading among them: number of readings before.
    breaks: Vec<usize>,
    watch: Option<StepWatch>,
    timed: bool,
    file: String,
}

impl Feed<'_> {
    fn flush(&mut self) -> Result<(), NoiseFailure> {
        self.record.push(&self.batch).map_err(|e| NoiseFailure::noise(&self.file, e))?;
        self.batch.clear();
        Ok(())
    }

    fn cut(&mut self) -> Result<(), NoiseFailure> {
        self.flush()?;
        self.record.gap().map_err(|e| NoiseFailure::noise(&self.file, e))
    }

    fn reading(&mut self, value: f64) -> Result<(), NoiseFailure> {
        self.batch.push(value);
        if self.batch.len() >= BATCH { self.flush() } else { Ok(()) }
    }

    fn missing(&mut self) -> Result<(), NoiseFailure> {
        if self.timed && self.watch.is_none() {
            self.breaks.push(self.first.len());
            return Ok(());
        }
        self.cut()
    }

    fn timed_reading(&mut self, line: u64, time: f64, value: f64) -> Result<(), NoiseFailure> {
        if self.watch.is_none() {
            self.first.push((line, time, value));
            return if self.first.len() >= FIRST_READINGS { self.begin() } else { Ok(()) };
        }
        let Some(watch) = &mut self.watch else { return Ok(()) };
        match watch.push(time) {
            Step::Regular | Step::Short => {}
            Step::Gap { .. } => self.cut()?,
            Step::Back => {
                return Err(NoiseFailure::Read(ReadError {
                    place: Place::field(self.file.as_str(), line, "t_s"),
                    problem: Problem::Field {
                        text: time.to_string(),
                        expected: "after the time before it",
                        remedy: "sort the rows, give one record a file, or give --rate HZ (the times are then not used)",
                    },
                }));
            }
        }
        self.reading(value)
    }

    /// The step follows from the first times; then they are read as all others.
    fn begin(&mut self) -> Result<(), NoiseFailure> {
        let first = std::mem::take(&mut self.first);
        let times: Vec<f64> = first.iter().map(|(_, t, _)| *t).collect();
        let watch = StepWatch::of(&times).map_err(|e| NoiseFailure::times(&self.file, e))?;
        self.watch = Some(watch);
        let breaks = std::mem::take(&mut self.breaks);
        for (i, (line, time, value)) in first.into_iter().enumerate() {
            if breaks.contains(&i) {
                self.cut()?;
            }
            self.timed_reading(line, time, value)?;
        }
        Ok(())
    }
}

/// Reads a file into a record.
pub(super) fn read(
    path: &Path,
    column: Option<&str>,
    rate_hz: Option<f64>,
    record: &mut NoiseRecord,
    watch: &dyn Watch,
) -> Result<Read, NoiseFailure> {
    let file = path.display().to_string();
    let source = Source::open(path, &file)?.watched(watch);
    let mut lines = Lines::new(source, &file);
    let first = lines.next_data()?.map(|(n, line)| (n, line.to_vec()));
    let Some((number, line)) = first else {
        let what = "no readings in the file; give one reading a line, or a header with a column `code` or `output`";
        return Err(ReadError { place: Place::file(file), problem: Problem::Empty { what } }.into());
    };
    let layout = layout(&line, &Place::line(file.as_str(), number), column)?;
    let has_time = layout.as_ref().is_some_and(|l| l.time.is_some());
    let times_unused = has_time && rate_hz.is_some();
    if rate_hz.is_none() && !has_time {
        return Err(NoiseFailure::NoRate { file });
    }
    let header = layout.as_ref().is_some_and(|l| l.header);
    if !header {
        lines.put_back();
    }
    let layout = layout.map(|l| Layout { columns: l.columns, reading: l.reading, time: l.time });
    let mut feed = Feed {
        record,
        batch: Vec::with_capacity(BATCH),
        first: Vec::new(),
        breaks: Vec::new(),
        watch: None,
        timed: rate_hz.is_none(),
        file: file.clone(),
    };
    let without = rows(&mut lines, layout.as_ref(), &mut feed)?;
    if feed.timed && feed.watch.is_none() {
        feed.begin()?;
    }
    feed.flush()?;
    let times = feed.watch.take();
    let interval_s = match (rate_hz, &times) {
        (Some(rate), _) => 1.0 / rate,
        (None, Some(watch)) => watch.interval_s().map_err(|e| NoiseFailure::times(&file, e))?,
        (None, None) => return Err(NoiseFailure::NoRate { file }),
    };
    let sha256 = lines
        .into_inner()
        .finish()
        .map_err(|e| ReadError { place: Place::file(file), problem: Source::problem(e) })?;
    let column = layout.map(|l| l.columns.name(l.reading).to_owned());
    Ok(Read { sha256, interval_s, times, without, column, times_unused })
}

/// All rows; gives the number of those without a reading.
fn rows<R: std::io::Read>(
    lines: &mut Lines<R>,
    layout: Option<&Layout>,
    feed: &mut Feed<'_>,
) -> Result<u64, NoiseFailure> {
    let file = lines.shown_as().to_owned();
    let dialect = Dialect::default();
    let mut buffer = FieldBuffer::default();
    let mut without = 0;
    while let Some((number, line)) = lines.next_data()? {
        let Some(layout) = layout else {
            let text = trimmed(line);
            match real(text, DecimalSign::CommaOrPoint) {
                Some(value) => feed.reading(value)?,
                None if says_missing(text) => {
                    without += 1;
                    feed.missing()?;
                }
                None => {
                    return Err(ReadError {
                        place: Place::line(file, number),
                        problem: Problem::Field {
                            text: String::from_utf8_lossy(text).into_owned(),
                            expected: "a number",
                            remedy: "give one reading a line, or a header with a column `code` or `output`",
                        },
                    }
                    .into());
                }
            }
            continue;
        };
        let fields = buffer.split(line, layout.columns.delimiter);
        let row = Row { fields, columns: &layout.columns, file: &file, line: number };
        row.check_width()?;
        if says_missing(row.text(layout.reading)) {
            without += 1;
            feed.missing()?;
            continue;
        }
        let value = row.real(layout.reading, "a number")?;
        match layout.time.filter(|_| feed.timed) {
            Some(time) => feed.timed_reading(number, row.time_s(time, &dialect)?, value)?,
            None => feed.reading(value)?,
        }
    }
    Ok(without)
}

/// A layout, and whether the line was a header.
struct Found {
    columns: Columns,
    reading: usize,
    time: Option<usize>,
    header: bool,
}

/// What the first line says; `None` for bare numbers.
fn layout(line: &[u8], place: &Place, column: Option<&str>) -> Result<Option<Found>, ReadError> {
    if column.is_none() && real(trimmed(line), DecimalSign::CommaOrPoint).is_some() {
        return Ok(None);
    }
    let number = column.and_then(|c| c.parse::<u32>().ok());
    let columns = match Columns::parse(line, place, &Dialect::default(), &Mapping::new()) {
        Ok(columns) => columns,
        Err(ReadError { problem: Problem::NoHeader { columns: width, .. }, .. }) => {
            let Some(number) = number else {
                return Err(ReadError {
                    place: place.clone(),
                    problem: Problem::Columns {
                        seen: Vec::new(),
                        what: format!("{width} numbers a line and no names"),
                        remedy: "name the columns in a first line, or give the number of the readings' column: \
                                 --column 2"
                            .into(),
                    },
                });
            };
            let mapping = Mapping::from([("output".to_owned(), ColumnRef::Number(number))]);
            // As a header it would show the same separator.
            let text = crate::csv::decoded(line);
            let delimiter = Some(crate::csv::Delimiter::of_header(&text));
            let dialect = Dialect { delimiter, ..Dialect::default() };
            let columns = Columns::numbered(width, place, &dialect, &mapping)
                .map_err(|_| unknown(place, &[format!("columns 1 to {width}")], column))?;
            let reading = columns.get("output").unwrap_or(0);
            return Ok(Some(Found { columns, reading, time: None, header: false }));
        }
        Err(e) => return Err(e),
    };
    let reading = match (column, number) {
        (None, _) => columns.get("code").or_else(|| columns.get("output")),
        (Some(name), number) => columns
            .find(name, place)
            .ok()
            .or_else(|| number.and_then(|n| (n as usize).checked_sub(1)))
            .filter(|i| *i < columns.names.len()),
    };
    let Some(reading) = reading else { return Err(unknown(place, &columns.names, column)) };
    let time = columns.get("t_s");
    Ok(Some(Found { columns, reading, time, header: true }))
}

fn unknown(place: &Place, names: &[String], column: Option<&str>) -> ReadError {
    let what = match column {
        Some(c) => format!("no column `{c}`"),
        None => "no column `code` or `output`".to_owned(),
    };
    let remedy = "say which one holds the readings: --column NAME, or --column 2".to_owned();
    let problem = Problem::Columns { seen: names.to_vec(), what, remedy };
    ReadError { place: place.clone(), problem }
}
