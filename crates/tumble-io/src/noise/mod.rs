//! `tumble noise`: a record at rest → what its noise is. The document `tumble-noise/1` is described in `docs/noise.md`.

mod build;
mod document;
mod known;
mod layout;
mod reader;

use std::path::Path;

use tumble_core::noise::{Deviation, NoiseError, NoiseOptions, NoiseRecord, StepError, Times};

pub use document::*;
pub(crate) use known::from_json;
pub use known::{KnownNoise, read_document};

use crate::csv::Lines;
pub use crate::csv::TimeUnit;
use crate::error::{Place, ReadError, visible};
use crate::source::Watch;

/// Name and major version of the document.
pub const SCHEMA: &str = "tumble-noise/1";

/// What a unit of the readings is in m/s², and who says so.
#[derive(Debug, Clone, PartialEq)]
pub struct Scale {
    /// m/s² per unit of the readings.
    pub m_s2_per_unit: f64,
    /// Where it comes from, for people.
    pub source: String,
}

/// What is asked of a record.
#[derive(Debug, Clone, PartialEq)]
pub struct NoiseSettings {
    /// Column of the readings, by its header or number; else `code` or `output`.
    pub column: Option<String>,
    /// Readings a second; else from the times.
    pub rate_hz: Option<f64>,
    /// Column of the times, by its header or number; else `t_s`.
    pub time: Option<String>,
    /// Unit of the times; else by the header, dates by their look, or seconds.
    pub time_unit: Option<TimeUnit>,
    /// Without it results stay in the unit of the readings.
    pub scale: Option<Scale>,
    /// Deviations beside overlapping Allan.
    pub deviations: Vec<Deviation>,
    /// Averaging times.
    pub times: Times,
    /// Level of the bands.
    pub level: f64,
}

/// Level of the intervals of the coefficients.
const FIT_LEVEL: f64 = 0.95;

/// Why there is no answer.
#[derive(Debug)]
pub enum NoiseFailure {
    /// The file cannot be read.
    Read(ReadError),
    /// The times are no rate.
    Times {
        /// File.
        file: String,
        /// Why.
        error: StepError,
    },
    /// The readings cannot be analysed.
    Noise {
        /// File.
        file: String,
        /// Why.
        error: NoiseError,
    },
    /// Neither rate nor times.
    NoRate {
        /// File.
        file: String,
        /// A column that looks like times.
        times: Option<String>,
    },
}

impl NoiseFailure {
    fn times(file: &str, error: StepError) -> Self {
        Self::Times { file: file.to_owned(), error }
    }

    fn noise(file: &str, error: NoiseError) -> Self {
        Self::Noise { file: file.to_owned(), error }
    }
}

impl From<ReadError> for NoiseFailure {
    fn from(e: ReadError) -> Self {
        Self::Read(e)
    }
}

impl std::fmt::Display for NoiseFailure {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let place = |file: &String| Place::file(file.as_str());
        match self {
            Self::Read(e) => write!(f, "{e}"),
            Self::Times { file, error } => write!(f, "{}: {error}", place(file)),
            Self::Noise { file, error } => write!(f, "{}: {error}", place(file)),
            Self::NoRate { file, times: None } => write!(
                f,
                "{}: the rate is not known; give it with --rate HZ, or times in a column `t_s` (seconds)",
                place(file)
            ),
            Self::NoRate { file, times: Some(column) } => write!(
                f,
                "{}: the rate is not known; give it with --rate HZ, or say which column holds the times: --time '{}'",
                place(file),
                visible(column)
            ),
        }
    }
}

impl std::error::Error for NoiseFailure {}

/// Reads a record and analyses its noise, in bounded memory unless every averaging time or the total deviation is asked
/// for.
///
/// **Errors** [`NoiseFailure`].
pub fn analyse(
    path: &Path,
    settings: &NoiseSettings,
    watch: &dyn Watch,
) -> Result<NoiseDocument, NoiseFailure> {
    let mut record = NoiseRecord::new(&settings.deviations, settings.times);
    let read = reader::read(path, settings, &mut record, watch)?;
    judged(&path.display().to_string(), settings, &read, record)
}

/// [`analyse`] of text, without a digest.
pub(crate) fn analyse_text(
    text: impl std::io::Read,
    shown_as: &str,
    settings: &NoiseSettings,
) -> Result<NoiseDocument, NoiseFailure> {
    let mut record = NoiseRecord::new(&settings.deviations, settings.times);
    let read = reader::read_text(&mut Lines::new(text, shown_as), settings, &mut record)?;
    judged(shown_as, settings, &read, record)
}

fn judged(
    file: &str,
    settings: &NoiseSettings,
    read: &reader::Read,
    record: NoiseRecord,
) -> Result<NoiseDocument, NoiseFailure> {
    let options = NoiseOptions {
        interval_s: read.interval_s,
        scale: settings.scale.as_ref().map_or(1.0, |s| s.m_s2_per_unit),
        level: settings.level,
        fit_level: FIT_LEVEL,
        step: None,
    };
    let analysis = record.finish(&options).map_err(|e| NoiseFailure::noise(file, e))?;
    Ok(build::build(file, settings, read, &analysis))
}
