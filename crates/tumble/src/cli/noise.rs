//! Flags of `tumble noise`.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

use super::level;

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum DeviationArg {
    /// Allan's, overlapping; always computed.
    Allan,
    /// Modified Allan: tells quantization from white noise.
    Modified,
    /// Hadamard's, overlapping: blind to a ramp.
    Hadamard,
    /// Total: steadier at long times; up to 10 million readings, no gaps.
    Total,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum TausArg {
    /// 1, 2, 4, 8, ... readings.
    Octave,
    /// 1, 2, 4, 10, 20, 40, ... readings.
    Decade,
    /// Every multiple, overlapping Allan only; up to a million readings.
    All,
}

#[derive(Debug, Args)]
#[command(
    allow_negative_numbers = true,
    after_help = "\
FILE: CSV with a column `code` or `output` (or --column) and perhaps `t_s` (or
--time), or bare numbers, one a line; gz and zst are unpacked; - is standard
input. The sensor stands still. Where times show missing readings the record is
cut; nothing is filled in. Memory does not grow with the record, but for `total`
and `all`.

Examples:
  tumble noise still.csv --rate 100
  tumble noise still.csv.gz --rate 100 --scale 0.00769
  tumble noise still.csv --sensor ADXL345 --mode '+-2 g' --out still-noise
  tumble noise log.csv --column acc_x --scale 1 --time t_ms
  tumble noise log.csv --column 3 --time 1 --time-unit ms
  tumble noise still.csv --rate 100 --deviation modified,hadamard,total
  tumble noise still.csv --passport out/passport.json --json | jq .dwell
  zcat still.csv.gz | tumble noise - --rate 100"
)]
pub(crate) struct NoiseArgs {
    /// Record of a sensor at rest.
    #[arg(value_name = "FILE")]
    pub(crate) file: PathBuf,
    /// Readings a second; times in the file are then not used.
    #[arg(long, value_name = "HZ", value_parser = rate)]
    pub(crate) rate: Option<f64>,
    /// Column of the times, by its header or number [default: t_s].
    #[arg(long, value_name = "COLUMN", conflicts_with = "rate")]
    pub(crate) time: Option<String>,
    /// Unit of the times [default: by the header, or dates by their look, or s].
    #[arg(long, value_enum, value_name = "UNIT", conflicts_with = "rate")]
    pub(crate) time_unit: Option<TimeUnitArg>,
    /// Column of the readings, by its header or number.
    #[arg(long, value_name = "COLUMN")]
    pub(crate) column: Option<String>,
    /// What a unit of the readings is, m/s² (1 where they are m/s²).
    #[arg(long, value_name = "M/S2", value_parser = noise_scale, group = "in_si")]
    pub(crate) scale: Option<f64>,
    /// Scale factor of this unit's passport.json.
    #[arg(long, value_name = "PASSPORT", group = "in_si")]
    pub(crate) passport: Option<PathBuf>,
    /// Nominal scale of a digital sensor of the catalogue.
    #[arg(long, value_name = "MODEL", group = "in_si")]
    pub(crate) sensor: Option<String>,
    /// Range or setting of --sensor, where it has several.
    #[arg(long, value_name = "MODE", requires = "sensor")]
    pub(crate) mode: Option<String>,
    /// Deviations, separated by commas.
    #[arg(long, value_enum, value_delimiter = ',', default_value = "allan")]
    pub(crate) deviation: Vec<DeviationArg>,
    /// Averaging times.
    #[arg(long, value_enum, default_value = "octave")]
    pub(crate) taus: TausArg,
    /// Level of the bands of the curves; coefficients have 95 %.
    #[arg(long, default_value_t = 0.683, value_parser = level)]
    pub(crate) level: f64,
    /// Print as JSON (docs/noise.md).
    #[arg(long)]
    pub(crate) json: bool,
    /// Write noise.json, noise.html and noise.svg here.
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    /// Replace another result in the folder; the old one is kept beside it.
    #[arg(long, requires = "out")]
    pub(crate) replace: bool,
    /// Print nothing but errors.
    #[arg(long, conflicts_with = "json")]
    pub(crate) quiet: bool,
}

/// Unit of a column of times.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum TimeUnitArg {
    /// Seconds.
    S,
    /// Milliseconds.
    Ms,
    /// Microseconds.
    Us,
    /// Nanoseconds.
    Ns,
    /// Dates (2026-11-20T10:15:30.25), or times of day.
    Date,
}

fn rate(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(v) if (1e-6..=1e9).contains(&v) => Ok(v),
        Ok(v) if v > 0.0 => Err("give readings a second, between 1e-6 and 1e9".into()),
        _ => Err("give a positive number, for instance 100".into()),
    }
}

fn noise_scale(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(v) if (1e-12..=1e12).contains(&v) => Ok(v),
        Ok(v) if v < 0.0 => Err("give it without its sign: noise has none".into()),
        _ => Err("give m/s² per unit of the readings, for instance 0.00769".into()),
    }
}
