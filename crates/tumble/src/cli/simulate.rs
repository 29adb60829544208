//! Flags of `tumble simulate`.

use std::path::PathBuf;

use clap::{Args, ValueEnum};
use tumble_core::Angle;

use crate::quantity::{self, AccelerationArg, NoiseArg};

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum PresetArg {
    /// The paper's first sensor.
    #[value(name = "paper-1")]
    Paper1,
    /// The paper's second sensor.
    #[value(name = "paper-2")]
    Paper2,
    /// The paper's third sensor: 0.9 → 0.2 LSB.
    #[value(name = "paper-3")]
    Paper3,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum QuantizerArg {
    /// Toward zero.
    Truncate,
    /// Down.
    Floor,
    /// To nearest.
    Round,
    /// Not at all.
    None,
}

#[derive(Debug, Args)]
#[command(
    allow_negative_numbers = true,
    after_help = "\
Every flag overrides the preset. Units stand behind the number:
  accelerations m/s2 mm/s2 mg ug LSB; angles deg arcmin arcsec mrad rad;
  ratios bare, % or ppm; noise also ug/rtHz; K2 ug/g2.

Examples:
  tumble simulate demo --preset paper-3
  tumble simulate wide --preset paper-3 --angles -65:65:60 --seed 7
  tumble simulate ours --plan plan/plan.toml
  tumble simulate noisy --bias 0.1m/s2 --scale-error 0.5% --scatter 3arcmin"
)]
pub(crate) struct SimulateArgs {
    /// Folder to write.
    #[arg(value_name = "OUT")]
    pub(crate) out: PathBuf,
    /// Known bench and sensor to start from.
    #[arg(long, value_enum, default_value = "paper-3")]
    pub(crate) preset: PresetArg,
    /// Angles: FIRST:LAST:COUNT, a list of degrees, or `paper` (−30…29°).
    #[arg(long, value_name = "PLAN", allow_hyphen_values = true, value_parser = angles)]
    pub(crate) angles: Option<Angles>,
    /// Angles, dwell, runs and up/down of a plan; flags go before it.
    #[arg(long, value_name = "FILE")]
    pub(crate) plan: Option<PathBuf>,
    /// Number of runs.
    #[arg(long)]
    pub(crate) runs: Option<u32>,
    /// Seed of all random numbers: same seed, same bytes.
    #[arg(long)]
    pub(crate) seed: Option<u64>,
    /// Length of a dwell, s.
    #[arg(long, value_name = "SECONDS")]
    pub(crate) dwell: Option<f64>,
    /// Samples per second.
    #[arg(long, value_name = "HZ")]
    pub(crate) rate: Option<f64>,
    /// Local gravity, m/s².
    #[arg(long, value_name = "M/S2")]
    pub(crate) gravity: Option<f64>,
    /// Nominal scale factor, m/s² per LSB.
    #[arg(long, value_name = "M/S2")]
    pub(crate) nominal_scale: Option<f64>,
    /// Bias.
    #[arg(long, value_name = "A", allow_hyphen_values = true, value_parser = quantity::acceleration)]
    pub(crate) bias: Option<AccelerationArg>,
    /// Misalignment.
    #[arg(long, value_name = "ANGLE", allow_hyphen_values = true, value_parser = quantity::angle)]
    pub(crate) misalignment: Option<Angle>,
    /// Relative scale error.
    #[arg(long, value_name = "RATIO", allow_hyphen_values = true, value_parser = quantity::ratio)]
    pub(crate) scale_error: Option<f64>,
    /// Quadratic nonlinearity K2.
    #[arg(long, value_name = "K2", allow_hyphen_values = true, value_parser = quantity::k2)]
    pub(crate) k2: Option<f64>,
    /// Cubic nonlinearity K3, 1/(m/s²)².
    #[arg(long, value_name = "K3", allow_hyphen_values = true)]
    pub(crate) k3: Option<f64>,
    /// Noise: of a sample (1.2LSB) or as one-sided density (110ug/rtHz).
    #[arg(long, value_name = "NOISE", value_parser = quantity::noise)]
    pub(crate) noise: Option<NoiseArg>,
    /// Random walk of the bias, m/s2/rts.
    #[arg(long, value_name = "WALK", value_parser = quantity::random_walk)]
    pub(crate) random_walk: Option<f64>,
    /// Standard deviation of the bias between power-ups.
    #[arg(long, value_name = "A", value_parser = quantity::acceleration)]
    pub(crate) turn_on: Option<AccelerationArg>,
    /// Temperature from start to end of a run, °C, for instance 20:24.
    #[arg(long, value_name = "FROM:TO", allow_hyphen_values = true, value_parser = temperature)]
    pub(crate) temperature: Option<(f64, f64)>,
    /// Bias per kelvin.
    #[arg(long, value_name = "A", allow_hyphen_values = true, value_parser = quantity::acceleration)]
    pub(crate) bias_per_kelvin: Option<AccelerationArg>,
    /// Random error of setting an angle, standard.
    #[arg(long, value_name = "ANGLE", value_parser = quantity::angle)]
    pub(crate) scatter: Option<Angle>,
    /// What the operator states as that error [default: the true one].
    #[arg(long, value_name = "ANGLE", value_parser = quantity::angle)]
    pub(crate) stated_scatter: Option<Angle>,
    /// Zero error of the dial.
    #[arg(long, value_name = "ANGLE", allow_hyphen_values = true, value_parser = quantity::angle)]
    pub(crate) dial_zero: Option<Angle>,
    /// Scale error of the dial.
    #[arg(long, value_name = "RATIO", allow_hyphen_values = true, value_parser = quantity::ratio)]
    pub(crate) dial_scale: Option<f64>,
    /// Eccentricity of the dial.
    #[arg(long, value_name = "ANGLE", allow_hyphen_values = true, value_parser = quantity::angle)]
    pub(crate) eccentricity: Option<Angle>,
    /// Phase of the eccentricity.
    #[arg(long, value_name = "ANGLE", allow_hyphen_values = true, value_parser = quantity::angle)]
    pub(crate) eccentricity_phase: Option<Angle>,
    /// Tilt of the table's axis out of the horizontal.
    #[arg(long, value_name = "ANGLE", allow_hyphen_values = true, value_parser = quantity::angle)]
    pub(crate) axis_tilt: Option<Angle>,
    /// Lean of the sensor out of the plane in which the table turns.
    #[arg(long, value_name = "ANGLE", allow_hyphen_values = true, value_parser = quantity::angle)]
    pub(crate) sensor_lean: Option<Angle>,
    /// Lean of upright dwells, standard.
    #[arg(long, value_name = "ANGLE", value_parser = quantity::angle)]
    pub(crate) lean: Option<Angle>,
    /// Dwells with the axis up and down at the start of each run.
    #[arg(long)]
    pub(crate) updown: bool,
    /// Dwells with the axis up and down in a power-up of their own, as the table `scale`.
    #[arg(long)]
    pub(crate) scale_pair: bool,
    /// How the converter rounds.
    #[arg(long, value_enum)]
    pub(crate) quantizer: Option<QuantizerArg>,
    /// Lowest code of the converter.
    #[arg(long, allow_hyphen_values = true)]
    pub(crate) min_code: Option<i32>,
    /// Highest code of the converter.
    #[arg(long, allow_hyphen_values = true)]
    pub(crate) max_code: Option<i32>,
    /// Model for experiment.toml.
    #[arg(long, default_value = "ADXL203")]
    pub(crate) model: String,
    /// Serial number for experiment.toml [default: that of the preset].
    #[arg(long)]
    pub(crate) serial: Option<String>,
    /// Pack the run files with gzip.
    #[arg(long)]
    pub(crate) gz: bool,
    /// Write averages instead of raw codes.
    #[arg(long)]
    pub(crate) averaged: bool,
    /// Replace another simulation in the folder; the old one is kept beside it.
    #[arg(long)]
    pub(crate) replace: bool,
}

/// Parsed angles; a type of its own, for clap takes a plain vector as repeated flags.
#[derive(Debug, Clone)]
pub(crate) struct Angles(pub(crate) Vec<f64>);

fn angles(text: &str) -> Result<Angles, String> {
    tumble_core::simulate::parse_plan(text).map(Angles).map_err(|e| e.to_string())
}

fn temperature(text: &str) -> Result<(f64, f64), String> {
    let parse = |t: &str| t.trim().parse::<f64>().ok().filter(|v| v.is_finite());
    text.split_once(':')
        .and_then(|(a, b)| parse(a).zip(parse(b)))
        .ok_or_else(|| "give FROM:TO in °C, for instance 20:24".into())
}
