//! A record at rest, reading by reading, with bounded memory.

use std::path::Path;

use tumble_core::noise::{FIRST_READINGS, NoiseRecord, Step, StepWatch};

use super::layout::{Layout, layout};
use super::{NoiseFailure, NoiseSettings};
use crate::csv::{
    DecimalSign, Dialect, FieldBuffer, HeaderUnit, Lines, Row, TimeUnit, date_s, real,
    says_missing, trimmed,
};
use crate::error::{Place, Problem, ReadError};
use crate::source::{Source, Watch};

/// Readings that are handed on at once.
const BATCH: usize = 1 << 14;

/// An angle of the dial that has moved, degrees: less is a jittery display.
const MOVED_DEG: f64 = 0.5;
/// Whole numbers that step by at least so many seconds are likelier parts of seconds.
const SLOW_S: f64 = 1.5;

/// What reading gives beside the record.
#[derive(Debug)]
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
    /// The column of times.
    pub time_column: Option<String>,
    /// The file has times, and they were not used.
    pub times_unused: bool,
    /// The times were read as seconds without `--time-unit`, and are whole numbers that step by this many.
    pub slow_s: Option<f64>,
    /// Unit that the header of the readings names.
    pub unit: Option<HeaderUnit>,
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
    /// All times are whole numbers.
    whole_times: bool,
    file: String,
    /// Name of the column of times.
    time_name: String,
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
        self.whole_times &= time.fract() == 0.0;
        let Some(watch) = &mut self.watch else { return Ok(()) };
        match watch.push(time) {
            Step::Regular | Step::Short => {}
            Step::Gap { .. } => self.cut()?,
            Step::Back => {
                return Err(NoiseFailure::Read(ReadError {
                    place: Place::field(self.file.as_str(), line, self.time_name.as_str()),
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

/// Reads a file, or a pipe, into a record.
pub(super) fn read(
    path: &Path,
    settings: &NoiseSettings,
    record: &mut NoiseRecord,
    watch: &dyn Watch,
) -> Result<Read, NoiseFailure> {
    let file = path.display().to_string();
    let source = Source::open_or_pipe(path, &file)?.watched(watch);
    let mut lines = Lines::new(source, &file);
    let mut read = read_text(&mut lines, settings, record)?;
    read.sha256 = lines
        .into_inner()
        .finish()
        .map_err(|e| ReadError { place: Place::file(file), problem: Source::problem(e) })?;
    Ok(read)
}

/// Reads text into a record; the digest is left empty.
pub(super) fn read_text<R: std::io::Read>(
    lines: &mut Lines<R>,
    settings: &NoiseSettings,
    record: &mut NoiseRecord,
) -> Result<Read, NoiseFailure> {
    let file = lines.shown_as().to_owned();
    let first = lines.next_data()?.map(|(n, line)| (n, line.to_vec()));
    let Some((number, line)) = first else {
        let what = "no readings in the file; give one reading a line, or a header with a column `code` or `output`";
        return Err(ReadError { place: Place::file(file), problem: Problem::Empty { what } }.into());
    };
    let layout = layout(&line, &Place::line(file.as_str(), number), settings)?;
    let time = layout.as_ref().and_then(|l| l.time);
    if settings.rate_hz.is_none() && time.is_none() {
        let times = layout.as_ref().and_then(Layout::likely_times).map(ToOwned::to_owned);
        return Err(NoiseFailure::NoRate { file, times });
    }
    if !layout.as_ref().is_some_and(|l| l.header) {
        lines.put_back();
    }
    let name = |i: usize| layout.as_ref().map(|l| l.columns.name(i).to_owned());
    let time_column = time.and_then(name);
    let mut feed = Feed {
        record,
        batch: Vec::with_capacity(BATCH),
        first: Vec::new(),
        breaks: Vec::new(),
        watch: None,
        timed: settings.rate_hz.is_none(),
        whole_times: true,
        file: file.clone(),
        time_name: time_column.clone().unwrap_or_default(),
    };
    let (without, time_unit) = rows(lines, layout.as_ref(), &mut feed)?;
    if feed.timed && feed.watch.is_none() {
        feed.begin()?;
    }
    feed.flush()?;
    let times = feed.watch.take();
    let interval_s = match (settings.rate_hz, &times) {
        (Some(rate), _) => 1.0 / rate,
        (None, Some(watch)) => watch.interval_s().map_err(|e| NoiseFailure::times(&file, e))?,
        (None, None) => return Err(NoiseFailure::NoRate { file, times: None }),
    };
    let seconds = settings.time_unit.is_none() && time_unit.is_none_or(|u| u == TimeUnit::Seconds);
    let slow = times.is_some() && seconds && feed.whole_times && interval_s >= SLOW_S;
    Ok(Read {
        sha256: String::new(),
        interval_s,
        times,
        without,
        column: layout.as_ref().and_then(|l| name(l.reading)),
        time_column: time_column.filter(|_| settings.rate_hz.is_none()),
        times_unused: time.is_some() && settings.rate_hz.is_some(),
        slow_s: slow.then_some(interval_s),
        unit: layout.as_ref().and_then(Layout::unit_of_readings),
    })
}

/// All rows; gives the number of those without a reading, and the unit of the times where something says it.
fn rows<R: std::io::Read>(
    lines: &mut Lines<R>,
    layout: Option<&Layout>,
    feed: &mut Feed<'_>,
) -> Result<(u64, Option<TimeUnit>), NoiseFailure> {
    let Some(layout) = layout else { return Ok((bare_rows(lines, feed)?, None)) };
    let file = lines.shown_as().to_owned();
    let mut dialect = Dialect { time_unit: layout.time_unit, ..Dialect::default() };
    let mut buffer = FieldBuffer::default();
    let mut dial = Dial::default();
    let mut without = 0;
    let mut is_first = true;
    while let Some((number, line)) = lines.next_data()? {
        let fields = buffer.split(line, layout.columns.delimiter);
        let row = Row { fields, columns: &layout.columns, file: &file, line: number };
        row.check_width()?;
        if let Some(angle) = layout.angle {
            dial.stands_still(&row, angle)?;
        }
        let time = layout.time.filter(|_| feed.timed);
        if let Some(i) = time
            && std::mem::take(&mut is_first)
            && !layout.unit_is_given
            && real(row.text(i), DecimalSign::CommaOrPoint).is_none()
            && date_s(row.text(i)).is_some()
        {
            dialect.time_unit = Some(TimeUnit::Date);
        }
        if says_missing(row.text(layout.reading)) {
            without += 1;
            feed.missing()?;
            continue;
        }
        let value = row.real(layout.reading, "a number").map_err(own_remedy)?;
        match time {
            Some(time) => {
                let time = row.time_s(time, &dialect).map_err(own_remedy)?;
                feed.timed_reading(number, time, value)?;
            }
            None => feed.reading(value)?,
        }
    }
    Ok((without, dialect.time_unit))
}

/// One number a line; gives the number of those that say that there is none.
fn bare_rows<R: std::io::Read>(
    lines: &mut Lines<R>,
    feed: &mut Feed<'_>,
) -> Result<u64, NoiseFailure> {
    let file = lines.shown_as().to_owned();
    let mut without = 0;
    while let Some((number, line)) = lines.next_data()? {
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
    }
    Ok(without)
}

/// The dial's angle, where the record has one.
#[derive(Default)]
struct Dial {
    first_deg: Option<f64>,
}

impl Dial {
    /// Refuses a record of several dwells: its steps are no noise.
    fn stands_still(&mut self, row: &Row<'_>, index: usize) -> Result<(), ReadError> {
        let Some(angle_deg) = real(row.text(index), DecimalSign::CommaOrPoint) else {
            return Ok(());
        };
        let first_deg = *self.first_deg.get_or_insert(angle_deg);
        if (angle_deg - first_deg).abs() <= MOVED_DEG {
            return Ok(());
        }
        Err(ReadError {
            place: Place::field(row.file, row.line, row.columns.name(index)),
            problem: Problem::Field {
                text: String::from_utf8_lossy(row.text(index)).into_owned(),
                expected: "the angle of the first row: the sensor was turned",
                remedy: "give a record at rest, the rows of one dwell (`tumble check` shows the noise of each dwell)",
            },
        })
    }
}

/// Remedies of experiment.toml do not help here.
fn own_remedy(mut e: ReadError) -> ReadError {
    if let Problem::Field { remedy, text, .. } = &mut e.problem {
        if remedy.contains("\"date\"") {
            *remedy = "give --time-unit date where these are dates or times of day";
        } else if remedy.contains("[csv]") {
            *remedy = "write decimal points, or decimal commas in a file with `;` between columns; no thousands marks";
        } else if remedy.contains("`columns`") && text.is_empty() {
            *remedy = "fill in the empty cell or remove the row, or give --rate HZ (the times are then not used)";
        }
    }
    e
}
