//! Averaged run files: one row a dwell.

use std::io::Read;

use tumble_core::{Dial, Readings, Record};

use super::header::Columns;
use super::lines::Lines;
use super::number::{integer, trimmed};
use super::raw::too_many;
use super::row::{FieldBuffer, Row};
use super::run_file::{Discard, Dwell, RunFileOptions};
use crate::error::{Place, Problem, ReadError};

/// Reads all dwells of an averaged file.
pub(super) fn read<R: Read>(
    lines: &mut Lines<R>,
    header: &Place,
    columns: &Columns,
    options: &RunFileOptions<'_>,
) -> Result<Vec<Dwell>, ReadError> {
    let file = lines.shown_as().to_owned();
    let angle = match options.fixed_angle_deg {
        Some(_) => None,
        None => Some(columns.require("angle_deg", header)?),
    };
    if options.discard != Discard::Seconds(0.0) {
        return Err(ReadError {
            place: header.clone(),
            problem: Problem::Columns {
                seen: columns.names.clone(),
                what: "averages have no start that could be thrown away".into(),
                remedy: "remove discard_s, or give the raw record".into(),
            },
        });
    }
    let mean = columns.require("mean_code", header)?;
    let samples = columns.require("samples", header)?;
    let std = columns.get("std_code");
    let temperature = columns.get("temperature_degc");
    let mut filters = Vec::new();
    for (column, text) in options.rows {
        filters.push((columns.find(column, header)?, text));
    }
    let mut dwells = Vec::new();
    let mut buffer = FieldBuffer::default();
    while let Some((line, text)) = lines.next_data()? {
        let row = Row { fields: buffer.split(text, columns.delimiter), columns, file: &file, line };
        row.check_width()?;
        if filters.iter().any(|(i, text)| row.text(*i) != text.as_bytes()) {
            continue;
        }
        if let Some(problem) = too_many(dwells.len(), 0) {
            return Err(ReadError { place: row.place(), problem });
        }
        let written = trimmed(row.fields.get(samples));
        // `1.000` may be one or a thousand: a count has no mark.
        let count = integer(written)
            .filter(|_| written.iter().all(|b| b.is_ascii_digit()))
            .and_then(|n| u64::try_from(n).ok())
            .filter(|n| *n > 0)
            .ok_or_else(|| {
                row.wrong(
                    samples,
                    "a positive number of samples",
                    "give the number of samples in the mean",
                )
            })?;
        let std = match std {
            Some(i) => {
                let s = row.real(i, "a standard deviation")?;
                if s < 0.0 {
                    let remedy = "give the standard deviation of single samples (n − 1)";
                    return Err(row.wrong(i, "a standard deviation", remedy));
                }
                Some(s)
            }
            None => None,
        };
        let dial = match (angle, options.fixed_angle_deg) {
            (Some(i), _) => Dial {
                typed: String::from_utf8_lossy(row.text(i)).into_owned(),
                value: row.dial(i, options.dialect)?,
                unit_deg: options.angle_unit().in_deg(),
                direction: 1.0,
            },
            (None, fixed) => {
                let value = fixed.unwrap_or(0.0);
                Dial { typed: value.to_string(), value, unit_deg: 1.0, direction: 1.0 }
            }
        };
        dwells.push(Dwell {
            readings: Readings::Averaged {
                mean: row.real(mean, "a mean code")?,
                samples: count,
                std,
            },
            temperature_degc: match temperature {
                Some(i) => Some(row.real(i, "a temperature in °C")?),
                None => None,
            },
            record: Record {
                file: file.clone(),
                line: Some(line),
                rows: 1,
                dial: Some(dial),
                ..Record::default()
            },
        });
    }
    Ok(dwells)
}
