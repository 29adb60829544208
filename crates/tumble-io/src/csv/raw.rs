//! Raw run files: one row a sample; consecutive rows of one angle are one dwell.

use std::io::Read;

use tumble_core::{
    BlockSums, Code, CodeHistogram, Dial, Quantizer, Readings, Record, Timing, ValueMoments,
    settled_stretch,
};

use super::header::Columns;
use super::lines::Lines;
use super::number::says_missing;
use super::row::{FieldBuffer, Row};
use super::run_file::{Discard, Dwell, RunFileOptions};
use crate::error::{Place, Problem, ReadError};

/// Different codes that one dwell may hold. White noise of a 24-bit converter over an hour stays below.
const DISTINCT_LIMIT: usize = 1 << 20;
/// Samples after which the number of different codes is looked at.
const DISTINCT_CHECK: u64 = 1 << 16;
/// Dwells of one file: a table that is turned by motor has some thousand; more is a column that is no angle.
pub(super) const MOST_DWELLS: usize = 10_000;
/// Different codes over all dwells of a file. Sixty dwells of 100 000 different codes each stay below.
const MOST_CODES: usize = 1 << 23;
/// Samples that are kept to look for where the sensor stood still: more than a day at 50 Hz, and 16 to 56 bytes each.
pub(super) const KEPT_LIMIT: usize = 5_000_000;

/// Indices of the columns of a raw file.
pub(super) struct Indices {
    angle: Option<usize>,
    reading: usize,
    position: Option<usize>,
    time: Option<usize>,
    temperature: Option<usize>,
    /// Only rows whose column holds this text.
    filters: Vec<(usize, Vec<u8>)>,
}

/// What one row says.
pub(super) struct Sample {
    /// `None`: the row holds no reading, and those are to be left out.
    pub(super) reading: Option<Value>,
    pub(super) time_s: Option<f64>,
    pub(super) temperature: Option<i64>,
}

/// One reading, exactly.
#[derive(Clone, Copy)]
pub(super) enum Value {
    Code(i32),
    /// In [`ValueMoments::RESOLUTION`]; up to [`ValueMoments::LIMIT`] they fit.
    Steps(i64),
}

impl Value {
    fn is_zero(self) -> bool {
        matches!(self, Self::Code(0) | Self::Steps(0))
    }

    pub(super) fn real(self) -> f64 {
        match self {
            Self::Code(n) => f64::from(n),
            Self::Steps(s) => s as f64 * ValueMoments::RESOLUTION,
        }
    }
}

/// Equality of two short texts. The library's `memcmp` took half of the reading time for these few bytes.
#[inline]
fn same_text(a: &[u8], b: &[u8]) -> bool {
    a.len() == b.len() && a.iter().zip(b).all(|(x, y)| x == y)
}

impl Indices {
    pub(super) fn of(
        header: &Place,
        columns: &Columns,
        options: &RunFileOptions<'_>,
    ) -> Result<Self, ReadError> {
        let reading = if options.quantizer == Quantizer::None { "output" } else { "code" };
        let without_angle = options.fixed_angle_deg.is_some() || options.angles_deg.is_some();
        let mut filters = Vec::new();
        for (column, text) in options.rows {
            filters.push((columns.find(column, header)?, text.as_bytes().to_vec()));
        }
        let wanted = [(!without_angle).then_some("angle_deg"), Some(reading)];
        columns.require_all(&wanted.into_iter().flatten().collect::<Vec<_>>(), header)?;
        let found = Self {
            angle: if without_angle { None } else { Some(columns.require("angle_deg", header)?) },
            reading: columns.require(reading, header)?,
            position: columns.get("position"),
            time: columns.get("t_s"),
            temperature: columns.get("temperature_degc"),
            filters,
        };
        let by_seconds = matches!(options.discard, Discard::Seconds(s) if s > 0.0);
        if by_seconds && found.time.is_none() && options.rate_hz.is_none() {
            return Err(ReadError {
                place: header.clone(),
                problem: Problem::MissingKey {
                    key: "rate_hz",
                    example: "rate_hz = … in [output], or record a column t_s: discard_s needs one of them",
                },
            });
        }
        Ok(found)
    }

    /// Whether a row belongs to this run.
    #[inline]
    pub(super) fn wants(&self, row: &Row<'_>) -> bool {
        self.filters.iter().all(|(i, text)| row.text(*i) == text.as_slice())
    }

    /// Reads one row. Even a sample that is thrown away must be one: a broken file is broken everywhere.
    #[inline]
    pub(super) fn sample(
        &self,
        row: &Row<'_>,
        options: &RunFileOptions<'_>,
    ) -> Result<Sample, ReadError> {
        let time_s = match self.time {
            Some(i) => Some(row.time_s(i, options.dialect)?),
            None => None,
        };
        if options.skips_missing() && says_missing(row.fields.get(self.reading)) {
            return Ok(Sample { reading: None, time_s, temperature: None });
        }
        let reading = if options.quantizer == Quantizer::None {
            let value = row.real(self.reading, "a number")?;
            let steps = ValueMoments::steps(value).ok().and_then(|s| i64::try_from(s).ok());
            Value::Steps(steps.ok_or_else(|| {
                row.wrong(self.reading, "a reading below 1e6", "use a larger unit")
            })?)
        } else {
            Value::Code(row.code(self.reading, options.dialect.codes)?)
        };
        let temperature = match self.temperature {
            Some(i) => {
                let t = row.real(i, "a temperature in °C")?;
                let steps = ValueMoments::steps(t).ok().and_then(|s| i64::try_from(s).ok());
                Some(steps.ok_or_else(|| row.wrong(i, "a temperature in °C", "mend the row"))?)
            }
            None => None,
        };
        Ok(Sample { reading: Some(reading), time_s, temperature })
    }
}

/// The dwell that is being read.
struct Open {
    angle_text: Vec<u8>,
    position_text: Vec<u8>,
    gathered: Gathered,
}

/// What has been gathered of a dwell.
pub(super) struct Gathered {
    pub(super) record: Record,
    pub(super) temperature: ValueMoments,
    pub(super) readings: Readings,
    /// Readings in time order, while the settled stretch is still to be found.
    kept: Option<Vec<Value>>,
    last: Option<i32>,
    /// The start that is thrown away has passed. A clock that is set back later does not bring it back.
    started: bool,
}

/// Reads all dwells of a raw file.
pub(super) fn read<R: Read>(
    lines: &mut Lines<R>,
    header: &Place,
    columns: &Columns,
    options: &RunFileOptions<'_>,
) -> Result<Vec<Dwell>, ReadError> {
    let shown_as = lines.shown_as().to_owned();
    let at = Indices::of(header, columns, options)?;
    let mut dwells = Vec::new();
    let mut open: Option<Open> = None;
    let (mut zeros, mut codes) = (ZeroRows::default(), 0);
    let mut fields_of_line = FieldBuffer::default();
    while let Some((number, line)) = lines.next_data()? {
        let fields = fields_of_line.split(line, columns.delimiter);
        let row = Row { fields, columns, file: &shown_as, line: number };
        row.check_width()?;
        if !at.wants(&row) {
            continue;
        }
        let angle_text = at.angle.map_or(&b""[..], |i| row.fields.get(i));
        let position_text = at.position.map_or(&b""[..], |i| row.fields.get(i));
        let same = open.as_ref().is_some_and(|d| {
            same_text(&d.angle_text, angle_text) && same_text(&d.position_text, position_text)
        });
        if !same {
            let value = match (at.angle, options.fixed_angle_deg) {
                (Some(i), _) => row.dial(i, options.dialect)?,
                (None, fixed) => fixed.unwrap_or(0.0),
            };
            // `30` and `30.0` are one angle.
            let continues = open.as_ref().is_some_and(|d| {
                d.gathered.record.dial.as_ref().is_some_and(|dial| dial.value == value)
                    && d.position_text == position_text
            });
            if continues {
                if let Some(d) = open.as_mut() {
                    d.angle_text = angle_text.to_vec();
                }
            } else {
                let unit_deg = at.angle.map_or(1.0, |_| options.angle_unit().in_deg());
                let typed = match at.angle {
                    Some(_) => String::from_utf8_lossy(angle_text.trim_ascii()).into_owned(),
                    None => value.to_string(),
                };
                let dial = Dial { typed, value, unit_deg, direction: 1.0 };
                let next = Open {
                    angle_text: angle_text.to_vec(),
                    position_text: position_text.to_vec(),
                    gathered: Gathered::new(&shown_as, number, Some(dial), options),
                };
                if let Some(done) = open.replace(next) {
                    dwells.push(done.gathered.close(options)?);
                    codes += dwells.last().map_or(0, different_codes);
                    if let Some(problem) = too_many(dwells.len(), codes) {
                        return Err(ReadError { place: row.place(), problem });
                    }
                }
            }
        }
        let sample = at.sample(&row, options)?;
        if let Some(dwell) = open.as_mut() {
            zeros.see(&sample, dwell.gathered.dial_value(), number);
            dwell.gathered.add(&sample, &row, options)?;
        }
    }
    if let Some(mut done) = open {
        done.gathered.record.zero_rows = zeros.found();
        dwells.push(done.gathered.close(options)?);
    }
    Ok(dwells)
}

/// What is wrong with so many dwells that hold so many different codes.
pub(super) fn too_many(dwells: usize, codes: usize) -> Option<Problem> {
    match () {
        () if dwells >= MOST_DWELLS => Some(Problem::TooManyDwells { limit: MOST_DWELLS }),
        () if codes > MOST_CODES => Some(Problem::TooManyCodes { limit: MOST_CODES }),
        () => None,
    }
}

fn different_codes(dwell: &Dwell) -> usize {
    match &dwell.readings {
        Readings::Codes { histogram, .. } => histogram.distinct(),
        _ => 0,
    }
}

/// Rows at the end of a file in which every number is zero: what loggers leave that write files of a fixed length.
#[derive(Default)]
struct ZeroRows {
    first_line: u64,
    rows: u64,
}

impl ZeroRows {
    #[inline]
    fn see(&mut self, sample: &Sample, dial: f64, line: u64) {
        let zero = sample.reading.is_some_and(Value::is_zero)
            && dial == 0.0
            && sample.time_s.is_none_or(|t| t == 0.0)
            && sample.temperature.is_none_or(|t| t == 0);
        if !zero {
            self.rows = 0;
            return;
        }
        if self.rows == 0 {
            self.first_line = line;
        }
        self.rows += 1;
    }

    /// One row of zeros is a reading like others.
    fn found(&self) -> Option<(u64, u64)> {
        (self.rows > 1).then_some((self.first_line, self.rows))
    }
}

impl Gathered {
    pub(super) fn new(
        file: &str,
        line: u64,
        dial: Option<Dial>,
        options: &RunFileOptions<'_>,
    ) -> Self {
        let blocks = BlockSums::default();
        let readings = match options.quantizer {
            Quantizer::None => Readings::Values { moments: ValueMoments::default(), blocks },
            _ => Readings::Codes { histogram: CodeHistogram::default(), blocks },
        };
        Self {
            record: Record { file: file.to_owned(), line: Some(line), dial, ..Record::default() },
            temperature: ValueMoments::default(),
            readings,
            kept: (options.discard == Discard::Detected).then(Vec::new),
            last: None,
            started: false,
        }
    }

    fn dial_value(&self) -> f64 {
        self.record.dial.as_ref().map_or(0.0, |d| d.value)
    }

    #[inline]
    fn add(
        &mut self,
        sample: &Sample,
        row: &Row<'_>,
        options: &RunFileOptions<'_>,
    ) -> Result<(), ReadError> {
        if let Some(t) = sample.time_s {
            self.record.timing.get_or_insert_default().record(t, row.line);
        }
        let rows = self.record.rows;
        self.record.rows += 1;
        let Some(reading) = sample.reading else {
            self.record.without_reading += 1;
            return Ok(());
        };
        if let Discard::Seconds(limit) = options.discard
            && limit > 0.0
            && !self.started
        {
            let start = self.record.timing.as_ref().and_then(|t| t.first_s);
            let elapsed = match (sample.time_s.zip(start), options.rate_hz) {
                (Some((t, start)), _) => t - start,
                (None, Some(rate)) => rows as f64 / rate,
                (None, None) => f64::INFINITY,
            };
            if elapsed < limit {
                self.record.left_out[0] += 1;
                return Ok(());
            }
            self.started = true;
        }
        if let Some(kept) = &mut self.kept {
            if kept.len() >= KEPT_LIMIT {
                return Err(ReadError {
                    place: row.place(),
                    problem: Problem::TooLongToSearch { limit: KEPT_LIMIT },
                });
            }
            kept.push(reading);
        } else {
            self.count(reading);
            self.check_distinct(row)?;
        }
        if let Some(steps) = sample.temperature {
            self.temperature.record(i128::from(steps));
        }
        Ok(())
    }

    /// Counts one reading that belongs to the dwell.
    #[inline]
    pub(super) fn count(&mut self, reading: Value) {
        match (&mut self.readings, reading) {
            (Readings::Codes { histogram, blocks }, Value::Code(code)) => {
                histogram.record(Code(code));
                blocks.record(i128::from(code));
                let repeats = if self.last == Some(code) { self.record.closing_repeats } else { 0 };
                self.record.closing_repeats = repeats + 1;
                self.last = Some(code);
            }
            (Readings::Values { moments, blocks }, Value::Steps(steps)) => {
                let steps = i128::from(steps);
                moments.record(steps);
                blocks.record(steps);
            }
            _ => {}
        }
    }

    #[inline]
    fn check_distinct(&self, row: &Row<'_>) -> Result<(), ReadError> {
        match &self.readings {
            Readings::Codes { histogram, .. }
                if histogram.samples().is_multiple_of(DISTINCT_CHECK)
                    && histogram.distinct() > DISTINCT_LIMIT =>
            {
                Err(ReadError {
                    place: row.place(),
                    problem: Problem::NotADwell { limit: DISTINCT_LIMIT },
                })
            }
            _ => Ok(()),
        }
    }

    fn close(mut self, options: &RunFileOptions<'_>) -> Result<Dwell, ReadError> {
        if let Some(kept) = self.kept.take() {
            let reals: Vec<f64> = kept.iter().map(|v| v.real()).collect();
            let still = settled_stretch(&reals);
            self.record.left_out = [still.start as u64, (kept.len() - still.end) as u64];
            kept[still].iter().for_each(|v| self.count(*v));
        }
        if self.readings.samples() == 0 {
            let place = Place::line(self.record.file.as_str(), self.record.line.unwrap_or(1));
            let (dial, rows) = (self.dial_value(), self.record.rows);
            let problem = match options.discard {
                Discard::Seconds(limit) if self.record.left_out[0] > 0 => Problem::Value {
                    key: "discard_s".into(),
                    given: limit.to_string(),
                    expected: format!("less than the dwell at {dial} lasts ({rows} rows)"),
                },
                _ => Problem::Empty {
                    what: "a dwell without a single reading; remove its rows, or measure it again",
                },
            };
            return Err(ReadError { place, problem });
        }
        Ok(self.into_dwell())
    }

    pub(super) fn into_dwell(self) -> Dwell {
        Dwell {
            readings: self.readings,
            temperature_degc: self.temperature.mean(),
            record: self.record,
        }
    }

    pub(super) fn timing(&mut self) -> &mut Timing {
        self.record.timing.get_or_insert_default()
    }
}
