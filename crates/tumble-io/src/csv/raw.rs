//! Raw run files: one row a sample; consecutive rows of one angle are one dwell.

use std::io::Read;

use tumble_core::{BlockSums, Code, CodeHistogram, Quantizer, Readings, ValueMoments};

use super::header::Columns;
use super::lines::Lines;
use super::number::{integer, trimmed};
use super::row::{FieldBuffer, Row};
use super::run_file::{Dwell, RunFileOptions};
use crate::error::{Place, Problem, ReadError};

/// Different codes that one dwell may hold. White noise of a 24-bit converter over an hour stays below.
const DISTINCT_LIMIT: usize = 1 << 20;
/// Samples after which the number of different codes is looked at.
const DISTINCT_CHECK: u64 = 1 << 16;

/// Indices of the columns of a raw file.
struct Indices {
    angle: Option<usize>,
    reading: usize,
    position: Option<usize>,
    time: Option<usize>,
    temperature: Option<usize>,
}

/// Equality of two short texts. The library's `memcmp` took half of the reading time for these few bytes.
#[inline]
fn same_text(a: &[u8], b: &[u8]) -> bool {
    a.len() == b.len() && a.iter().zip(b).all(|(x, y)| x == y)
}

/// The dwell that is being read.
struct Open {
    angle_text: Vec<u8>,
    position_text: Vec<u8>,
    dial_deg: f64,
    line: u64,
    rows: u64,
    first_time_s: Option<f64>,
    temperature: ValueMoments,
    readings: Readings,
}

/// Reads all dwells of a raw file.
pub(super) fn read<R: Read>(
    lines: &mut Lines<R>,
    header: &Place,
    columns: &Columns,
    options: &RunFileOptions<'_>,
) -> Result<Vec<Dwell>, ReadError> {
    let shown_as = lines.shown_as().to_owned();
    let reading = if options.quantizer == Quantizer::None { "output" } else { "code" };
    let at = Indices {
        angle: match options.fixed_angle_deg {
            Some(_) => None,
            None => Some(columns.require("angle_deg", header)?),
        },
        reading: columns.require(reading, header)?,
        position: columns.get("position"),
        time: columns.get("t_s"),
        temperature: columns.get("temperature_degc"),
    };
    if options.discard_s > 0.0 && at.time.is_none() && options.rate_hz.is_none() {
        return Err(ReadError {
            place: header.clone(),
            problem: Problem::MissingKey {
                key: "rate_hz",
                example: "rate_hz = … in [output], or record a column t_s: discard_s needs one of them",
            },
        });
    }
    let mut dwells = Vec::new();
    let mut open: Option<Open> = None;
    let mut fields_of_line = FieldBuffer::default();
    while let Some((number, line)) = lines.next_data()? {
        let fields = fields_of_line.split(line, columns.delimiter);
        let row = Row { fields, columns, file: &shown_as, line: number };
        row.check_width()?;
        let angle_text = at.angle.map_or(&b""[..], |i| row.fields.get(i));
        let position_text = at.position.map_or(&b""[..], |i| row.fields.get(i));
        let same = open.as_ref().is_some_and(|d| {
            same_text(&d.angle_text, angle_text) && same_text(&d.position_text, position_text)
        });
        if !same {
            let dial_deg = match (at.angle, options.fixed_angle_deg) {
                (Some(i), _) => row.real(i, "an angle in degrees")?,
                (None, fixed) => fixed.unwrap_or(0.0),
            };
            // `30` and `30.0` are one angle.
            let continues = open
                .as_ref()
                .is_some_and(|d| d.dial_deg == dial_deg && d.position_text == position_text);
            if continues {
                if let Some(d) = open.as_mut() {
                    d.angle_text = angle_text.to_vec();
                }
            } else {
                let next =
                    Open::new(angle_text, position_text, dial_deg, number, options.quantizer);
                if let Some(done) = open.replace(next) {
                    dwells.push(done.close(&shown_as, options)?);
                }
            }
        }
        if let Some(dwell) = open.as_mut() {
            dwell.record(&row, &at, options)?;
        }
    }
    if let Some(done) = open {
        dwells.push(done.close(&shown_as, options)?);
    }
    Ok(dwells)
}

impl Open {
    fn new(angle: &[u8], position: &[u8], dial_deg: f64, line: u64, quantizer: Quantizer) -> Self {
        let blocks = BlockSums::default();
        let readings = match quantizer {
            Quantizer::None => Readings::Values { moments: ValueMoments::default(), blocks },
            _ => Readings::Codes { histogram: CodeHistogram::default(), blocks },
        };
        Self {
            angle_text: angle.to_vec(),
            position_text: position.to_vec(),
            dial_deg,
            line,
            rows: 0,
            first_time_s: None,
            temperature: ValueMoments::default(),
            readings,
        }
    }

    #[inline]
    fn record(
        &mut self,
        row: &Row<'_>,
        at: &Indices,
        options: &RunFileOptions<'_>,
    ) -> Result<(), ReadError> {
        let time = match at.time {
            Some(i) if options.discard_s > 0.0 => Some(row.real(i, "a time in seconds")?),
            _ => None,
        };
        let start = *self.first_time_s.get_or_insert(time.unwrap_or(0.0));
        let elapsed = match (time, options.rate_hz) {
            (Some(t), _) => t - start,
            (None, Some(rate)) => self.rows as f64 / rate,
            (None, None) => f64::INFINITY,
        };
        self.rows += 1;
        // Even a sample that is thrown away must be one: a broken file is broken everywhere.
        match &mut self.readings {
            Readings::Codes { histogram, blocks } => {
                let field = row.fields.get(at.reading);
                let Some(code) = integer(field).or_else(|| integer(trimmed(field))) else {
                    return Err(row.wrong(
                        at.reading,
                        "an integer code",
                        "codes are whole LSB; volts, g or m/s² go into a column `output` with quantizer = \"none\", averages into `mean_code`",
                    ));
                };
                if elapsed < options.discard_s {
                    return Ok(());
                }
                histogram.record(Code(code));
                blocks.record(i128::from(code));
                if histogram.samples().is_multiple_of(DISTINCT_CHECK)
                    && histogram.distinct() > DISTINCT_LIMIT
                {
                    return Err(ReadError {
                        place: row.place(),
                        problem: Problem::NotADwell { limit: DISTINCT_LIMIT },
                    });
                }
            }
            Readings::Values { moments, blocks } => {
                let value = row.real(at.reading, "a number")?;
                let steps = ValueMoments::steps(value).map_err(|_| {
                    row.wrong(at.reading, "a reading below 1e6", "use a larger unit")
                })?;
                if elapsed < options.discard_s {
                    return Ok(());
                }
                moments.record(steps);
                blocks.record(steps);
            }
            Readings::Averaged { .. } => {}
        }
        if let Some(i) = at.temperature {
            let t = row.real(i, "a temperature in °C")?;
            let steps = ValueMoments::steps(t)
                .map_err(|_| row.wrong(i, "a temperature in °C", "mend the row"))?;
            self.temperature.record(steps);
        }
        Ok(())
    }

    fn close(self, file: &str, options: &RunFileOptions<'_>) -> Result<Dwell, ReadError> {
        if self.readings.samples() == 0 {
            return Err(ReadError {
                place: Place::line(file, self.line),
                problem: Problem::Value {
                    key: "discard_s".into(),
                    given: options.discard_s.to_string(),
                    expected: format!(
                        "less than the dwell at {}° lasts ({} rows)",
                        self.dial_deg, self.rows
                    ),
                },
            });
        }
        Ok(Dwell {
            dial_deg: self.dial_deg,
            readings: self.readings,
            temperature_degc: self.temperature.mean(),
            line: self.line,
        })
    }
}
