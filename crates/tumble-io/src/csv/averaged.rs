//! Averaged run files: one row a dwell.

use std::io::Read;

use tumble_core::Readings;

use super::header::Columns;
use super::lines::Lines;
use super::number::{integer, trimmed};
use super::row::{FieldBuffer, Row};
use super::run_file::{Dwell, RunFileOptions};
use crate::error::{Place, ReadError};

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
    let mean = columns.require("mean_code", header)?;
    let samples = columns.require("samples", header)?;
    let std = columns.get("std_code");
    let temperature = columns.get("temperature_degc");
    let mut dwells = Vec::new();
    let mut buffer = FieldBuffer::default();
    while let Some((line, text)) = lines.next_data()? {
        let row = Row { fields: buffer.split(text, columns.delimiter), columns, file: &file, line };
        row.check_width()?;
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
        dwells.push(Dwell {
            dial_deg: match (angle, options.fixed_angle_deg) {
                (Some(i), _) => row.real(i, "an angle in degrees")?,
                (None, fixed) => fixed.unwrap_or(0.0),
            },
            readings: Readings::Averaged {
                mean: row.real(mean, "a mean code")?,
                samples: count,
                std,
            },
            temperature_degc: match temperature {
                Some(i) => Some(row.real(i, "a temperature in °C")?),
                None => None,
            },
            line,
        });
    }
    Ok(dwells)
}
