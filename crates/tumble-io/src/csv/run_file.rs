//! A run file: raw, averaged or continuous, by its columns and by what experiment.toml says.

use std::collections::BTreeMap;
use std::path::Path;

use tumble_core::{Quantizer, Readings, Record};

use super::dial::AngleUnit;
use super::dialect::{Delimiter, Dialect, Missing};
use super::header::{Columns, Mapping};
use super::lines::Lines;
use super::row::FieldBuffer;
use super::{averaged, continuous, raw, sketch};
use crate::error::{Place, Problem, ReadError};
use crate::source::{Source, Watch};

/// Start of each dwell that is thrown away.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Discard {
    /// So many seconds.
    Seconds(f64),
    /// Until the readings stand still; motion at the end, too.
    Detected,
}

/// How a run file is to be read.
#[derive(Debug, Clone)]
pub(crate) struct RunFileOptions<'a> {
    /// Known column → the user's.
    pub(crate) mapping: &'a Mapping,
    /// Only rows whose columns hold these texts.
    pub(crate) rows: &'a BTreeMap<String, String>,
    /// How the file is written.
    pub(crate) dialect: &'a Dialect,
    /// The whole file is one dwell at this dial angle.
    pub(crate) fixed_angle_deg: Option<f64>,
    /// The file is a continuous record; its dwells stand at these readings of the dial.
    pub(crate) angles_deg: Option<&'a [f64]>,
    /// Start of each dwell that is thrown away.
    pub(crate) discard: Discard,
    /// Samples per second, where no time is recorded.
    pub(crate) rate_hz: Option<f64>,
    /// The converter.
    pub(crate) quantizer: Quantizer,
    /// Unit of real readings.
    pub(crate) unit: &'a str,
    /// Told how far reading has come.
    pub(crate) watch: &'a dyn Watch,
}

impl RunFileOptions<'_> {
    pub(super) fn angle_unit(&self) -> AngleUnit {
        self.dialect.angle_unit.unwrap_or_default()
    }

    pub(super) fn skips_missing(&self) -> bool {
        self.dialect.missing == Missing::Skip
    }
}

/// One dwell as read.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Dwell {
    /// What was read.
    pub(crate) readings: Readings,
    /// Mean temperature.
    pub(crate) temperature_degc: Option<f64>,
    /// Place, times, the dial.
    pub(crate) record: Record,
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
    let source = Source::open(path, shown_as)?.watched(options.watch);
    let mut lines = Lines::new(source, shown_as).with_comment(&options.dialect.comment);
    let read = read_lines(&mut lines, options);
    // What goes wrong at the header is often a header that stands elsewhere: a look at the file may tell where.
    let source = lines.into_inner();
    let (dwells, ignored) = match read {
        Ok(read) => read,
        // A row that was only half written is no row that needs mending.
        Err(e) if source.changed() => return Err(ReadError { problem: Problem::Changed, ..e }),
        Err(e) => return Err(sketch::with_advice(e, path, options)),
    };
    let sha256 = source
        .finish()
        .map_err(|e| ReadError { place: Place::file(shown_as), problem: Source::problem(e) })?;
    Ok(RunFile { dwells, ignored, sha256 })
}

/// Reads header and rows.
pub(crate) fn read_lines<R: std::io::Read>(
    lines: &mut Lines<R>,
    options: &RunFileOptions<'_>,
) -> Result<(Vec<Dwell>, Vec<String>), ReadError> {
    let (place, columns) = header(lines, options)?;
    columns.check_units(&place, options.dialect, (options.quantizer, options.unit))?;
    let has_angle = columns.get("angle_deg").is_some();
    if has_angle && (options.fixed_angle_deg.is_some() || options.angles_deg.is_some()) {
        let remedy = match options.angles_deg {
            Some(_) => "drop `angles_deg`, or the column from `columns`",
            None => "use `file = …` instead of `files = [{file, angle_deg}]`, or drop the column",
        };
        return Err(ReadError {
            place,
            problem: Problem::Columns {
                seen: columns.names,
                what: "the file has angles, and experiment.toml gives them, too".into(),
                remedy: remedy.into(),
            },
        });
    }
    let dwells = if columns.get("mean_code").is_some() {
        averaged::read(lines, &place, &columns, options)?
    } else if let Some(angles) = options.angles_deg {
        continuous::read(lines, &place, &columns, options, angles)?
    } else {
        raw::read(lines, &place, &columns, options)?
    };
    if dwells.is_empty() {
        let what = if options.rows.is_empty() {
            "no rows under the header; export the record again, with its readings"
        } else {
            "no row holds what `rows` asks for; correct `rows` in experiment.toml"
        };
        return Err(ReadError { place, problem: Problem::Empty { what } });
    }
    // A column that rows are chosen by is used.
    let ignored = columns.ignored.into_iter().filter(|c| !options.rows.contains_key(c)).collect();
    Ok((dwells, ignored))
}

/// Reads the header, and goes on to the first line of data.
fn header<R: std::io::Read>(
    lines: &mut Lines<R>,
    options: &RunFileOptions<'_>,
) -> Result<(Place, Columns), ReadError> {
    let dialect = options.dialect;
    let shown_as = lines.shown_as().to_owned();
    let empty = || ReadError {
        place: Place::file(shown_as.as_str()),
        problem: Problem::Empty {
            what: "the file is empty; it needs a header line such as `angle_deg,code`",
        },
    };
    let (number, text) = match dialect.header_line {
        None => match lines.next_data()? {
            Some((number, line)) => (number, line.to_vec()),
            None => return Err(empty()),
        },
        Some(0) => {
            // The first row is data: its width is looked at and it is read again.
            lines.skip_to(dialect.data_line.unwrap_or(1))?;
            let Some((number, line)) = lines.next_data()? else { return Err(empty()) };
            let delimiter = dialect.delimiter.unwrap_or(Delimiter::Byte(b','));
            let width = FieldBuffer::default().split(line, delimiter).len();
            lines.put_back();
            let place = Place::line(shown_as.as_str(), number);
            let columns = Columns::numbered(width, &place, dialect, options.mapping)?;
            return Ok((place, columns));
        }
        Some(number) => match lines.line(number)? {
            Some(line) => {
                // A header may stand in a comment.
                let mark = |b: &u8| *b == b'#' || options.dialect.comment.contains(b);
                let start = line.iter().position(|b| !mark(b)).unwrap_or(line.len());
                (number, line[start..].to_vec())
            }
            None => {
                return Err(ReadError {
                    place: Place::line(shown_as.as_str(), number),
                    problem: Problem::Empty {
                        what: "the file ends before its header; correct header_line in [csv]",
                    },
                });
            }
        },
    };
    let mut place = Place::line(shown_as.as_str(), number);
    // Spreadsheets write the separator into a first line of its own: `sep=;`.
    let announced = text
        .strip_prefix(b"sep=")
        .or_else(|| text.strip_prefix(b"SEP="))
        .filter(|rest| rest.len() == 1 && dialect.header_line.is_none());
    let columns = match announced {
        Some(separator) => {
            let stated =
                Dialect { delimiter: Some(Delimiter::Byte(separator[0])), ..dialect.clone() };
            let Some((number, line)) = lines.next_data()? else { return Err(empty()) };
            place = Place::line(shown_as.as_str(), number);
            Columns::parse(line, &place, &stated, options.mapping)?
        }
        None => Columns::parse(&text, &place, dialect, options.mapping)?,
    };
    if let Some(first) = dialect.data_line {
        lines.skip_to(first)?;
    }
    Ok((place, columns))
}
