//! A run file: raw or averaged, by its columns.

use std::collections::BTreeMap;
use std::path::Path;

use tumble_core::{Quantizer, Readings};

use super::header::Columns;
use super::lines::Lines;
use super::{averaged, raw};
use crate::error::{Place, Problem, ReadError};
use crate::source::Source;

/// How a run file is to be read.
#[derive(Debug, Clone)]
pub(crate) struct RunFileOptions<'a> {
    /// Known column → the user's header.
    pub(crate) mapping: &'a BTreeMap<String, String>,
    /// The whole file is one dwell at this dial angle.
    pub(crate) fixed_angle_deg: Option<f64>,
    /// Start of each dwell that is thrown away, s.
    pub(crate) discard_s: f64,
    /// Samples per second, where no time is recorded.
    pub(crate) rate_hz: Option<f64>,
    /// The converter.
    pub(crate) quantizer: Quantizer,
}

/// One dwell as read.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Dwell {
    /// Angle as the dial shows it, degrees.
    pub(crate) dial_deg: f64,
    /// What was read.
    pub(crate) readings: Readings,
    /// Mean temperature.
    pub(crate) temperature_degc: Option<f64>,
    /// First line.
    pub(crate) line: u64,
}

/// A run file as read.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct RunFile {
    /// In measured order.
    pub(crate) dwells: Vec<Dwell>,
    /// Columns that were not used.
    pub(crate) ignored: Vec<String>,
    /// SHA-256 of the file as it is stored.
    pub(crate) sha256: String,
}

/// Reads a run file in one pass.
pub(crate) fn read_run_file(
    path: &Path,
    shown_as: &str,
    options: &RunFileOptions<'_>,
) -> Result<RunFile, ReadError> {
    let mut lines = Lines::new(Source::open(path, shown_as)?, shown_as);
    let (number, header) = match lines.next_data()? {
        Some((number, line)) => (number, line.to_vec()),
        None => {
            let what = "the file is empty; it needs a header line such as `angle_deg,code`";
            return Err(ReadError {
                place: Place::file(shown_as),
                problem: Problem::Empty { what },
            });
        }
    };
    let place = Place::line(shown_as, number);
    let columns = Columns::parse(&header, &place, options.mapping)?;
    if options.fixed_angle_deg.is_some() && columns.get("angle_deg").is_some() {
        return Err(ReadError {
            place,
            problem: Problem::Columns {
                seen: columns.names,
                what: "the file has angles, and experiment.toml gives one for the whole file"
                    .into(),
                remedy:
                    "use `file = …` instead of `files = [{file, angle_deg}]`, or drop the column"
                        .into(),
            },
        });
    }
    let dwells = if columns.get("mean_code").is_some() {
        averaged::read(&mut lines, &place, &columns, options)?
    } else {
        raw::read(&mut lines, &place, &columns, options)?
    };
    if dwells.is_empty() {
        let what = "no rows under the header; export the record again, with its readings";
        return Err(ReadError { place, problem: Problem::Empty { what } });
    }
    let sha256 = lines
        .into_inner()
        .finish()
        .map_err(|e| ReadError { place: Place::file(shown_as), problem: Problem::Io(e) })?;
    Ok(RunFile { dwells, ignored: columns.ignored, sha256 })
}
