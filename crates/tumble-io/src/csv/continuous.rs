//! Continuous records: no angle beside the readings; dwells are where the sensor stood still, their angles are listed in
//! experiment.toml.

use std::io::Read;

use tumble_core::{Dial, stats, still_stretches};

use super::header::Columns;
use super::lines::Lines;
use super::raw::{Gathered, Indices, KEPT_LIMIT, Sample, Value};
use super::row::{FieldBuffer, Row};
use super::run_file::{Dwell, RunFileOptions};
use crate::error::{Place, Problem, ReadError};

/// One kept row.
struct Kept {
    line: u64,
    reading: Value,
    time_s: Option<f64>,
    temperature: Option<i64>,
}

/// Cuts a continuous record into dwells. `angles_deg`: the dial at each of them; `nan` leaves one out.
pub(super) fn read<R: Read>(
    lines: &mut Lines<R>,
    header: &Place,
    columns: &Columns,
    options: &RunFileOptions<'_>,
    angles: &[f64],
) -> Result<Vec<Dwell>, ReadError> {
    let shown_as = lines.shown_as().to_owned();
    let at = Indices::of(header, columns, options)?;
    let mut kept: Vec<Kept> = Vec::new();
    let mut without_reading = 0;
    let mut buffer = FieldBuffer::default();
    while let Some((number, line)) = lines.next_data()? {
        let fields = buffer.split(line, columns.delimiter);
        let row = Row { fields, columns, file: &shown_as, line: number };
        row.check_width()?;
        if !at.wants(&row) {
            continue;
        }
        let Sample { reading, time_s, temperature } = at.sample(&row, options)?;
        let Some(reading) = reading else {
            without_reading += 1;
            continue;
        };
        if kept.len() >= KEPT_LIMIT {
            let problem = Problem::TooLongToSearch { limit: KEPT_LIMIT };
            return Err(ReadError { place: row.place(), problem });
        }
        kept.push(Kept { line: number, reading, time_s, temperature });
    }
    let reals: Vec<f64> = kept.iter().map(|k| k.reading.real()).collect();
    let stretches = still_stretches(&reals);
    if stretches.is_empty() {
        return Err(ReadError {
            place: Place::file(shown_as.as_str()),
            problem: Problem::Empty {
                what: "no angle stands beside the readings, and they stand still nowhere; name the column of angles in `columns`, \
                       or leave the table still for some seconds at each angle",
            },
        });
    }
    if stretches.len() != angles.len() {
        let found = stretches
            .iter()
            .map(|s| {
                let level = stats::mean(&reals[s.clone()]).unwrap_or_default();
                format!("lines {}–{} at {level:.4}", kept[s.start].line, kept[s.end - 1].line)
            })
            .collect();
        let problem = Problem::AnglesOfDwells { listed: angles.len(), found };
        return Err(ReadError { place: Place::file(shown_as.as_str()), problem });
    }
    let mut dwells = Vec::new();
    let mut from = 0;
    for (stretch, value) in stretches.into_iter().zip(angles) {
        let before = (stretch.start - from) as u64;
        from = stretch.end;
        if value.is_nan() {
            continue;
        }
        let dial = Dial {
            typed: value.to_string(),
            value: *value,
            unit_deg: options.angle_unit().in_deg(),
            direction: 1.0,
        };
        let first = kept[stretch.start].line;
        let mut dwell = Gathered::new(&shown_as, first, Some(dial), options);
        dwell.record.left_out[0] = before;
        dwell.record.without_reading = core::mem::take(&mut without_reading);
        dwell.record.rows = before + stretch.len() as u64;
        for row in &kept[stretch] {
            dwell.count(row.reading);
            if let Some(t) = row.time_s {
                dwell.timing().record(t, row.line);
            }
            if let Some(steps) = row.temperature {
                dwell.temperature.record(i128::from(steps));
            }
        }
        dwells.push(dwell.into_dwell());
    }
    Ok(dwells)
}
