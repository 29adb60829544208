//! Flags of `tumble plan`.

use std::path::PathBuf;

use clap::Args;
use tumble_core::Angle;

use super::level;
use crate::quantity::{self, AccelerationArg, NoiseArg};

#[derive(Debug, Args)]
#[command(
    allow_negative_numbers = true,
    after_help = "\
Chooses angles, order, dwell and number of runs, and says what they will tell
before anyone turns the table. With --hours it makes the most of the time; with
--target alone it takes as little time as the targets need. Exit code 1: the
targets cannot be met, and the output says with what they could.

Targets: bias=0.5mm/s2 misalignment=0.5mrad scale=200ppm k2=50ug/g2
k3=1e-5 temp-bias=0.1mm/s2 temp-scale=50ppm (per kelvin). One and more; only
those count then.

Examples:
  tumble plan --sensor ADXL203 --range 65 --hours 1
  tumble plan --range 65 --scatter 1arcmin --updown --target bias=0.5mm/s2
  tumble plan bench.toml --hours 2 --out plan
  tumble plan --noise-file still/noise.json --range 65 --hours 2
  tumble plan my-sensor --terms k2 --json | jq .predicted"
)]
pub(crate) struct PlanArgs {
    /// A bench.toml, or an experiment folder whose bench and sensor to take.
    #[arg(value_name = "BENCH")]
    pub(crate) bench: Option<PathBuf>,
    /// Model of the sensor, as `tumble catalogue` lists it.
    #[arg(long, value_name = "MODEL")]
    pub(crate) sensor: Option<String>,
    /// Range of the table, degrees: 65 for both ways, or LOW:HIGH.
    #[arg(long, value_name = "DEG", allow_hyphen_values = true, value_parser = range)]
    pub(crate) range: Option<Range>,
    /// Time for everything, hours.
    #[arg(long)]
    pub(crate) hours: Option<f64>,
    /// Largest expanded uncertainty that still serves; may be repeated.
    #[arg(long, value_name = "TERM=SIZE", value_parser = quantity::target)]
    pub(crate) target: Vec<quantity::Target>,
    /// Random error of setting an angle, standard.
    #[arg(long, value_name = "ANGLE", value_parser = quantity::angle)]
    pub(crate) scatter: Option<Angle>,
    /// Step in which the dial is set.
    #[arg(long, value_name = "ANGLE", value_parser = quantity::angle)]
    pub(crate) step: Option<Angle>,
    /// Noise: one-sided density (110ug/rtHz), or of a sample (1.2LSB).
    #[arg(long, value_name = "NOISE", value_parser = quantity::noise)]
    pub(crate) noise: Option<NoiseArg>,
    /// Noise as `tumble noise RECORD --json` found it, in a file.
    #[arg(long, value_name = "FILE")]
    pub(crate) noise_file: Option<PathBuf>,
    /// Bias instability, the B of the Allan variance.
    #[arg(long, value_name = "A", value_parser = quantity::acceleration)]
    pub(crate) bias_instability: Option<AccelerationArg>,
    /// Random walk, the K of the Allan variance, m/s2/rts.
    #[arg(long, value_name = "WALK", value_parser = quantity::random_walk)]
    pub(crate) random_walk: Option<f64>,
    /// Steady drift an hour.
    #[arg(long, value_name = "A", value_parser = quantity::acceleration)]
    pub(crate) drift: Option<AccelerationArg>,
    /// Standard deviation of the bias between power-ups.
    #[arg(long, value_name = "A", value_parser = quantity::acceleration)]
    pub(crate) turn_on: Option<AccelerationArg>,
    /// One LSB of the converter.
    #[arg(long, value_name = "A", value_parser = quantity::acceleration)]
    pub(crate) lsb: Option<AccelerationArg>,
    /// Samples per second [default: 50].
    #[arg(long, value_name = "HZ")]
    pub(crate) rate: Option<f64>,
    /// Dwells with the axis up and down, off the table, are possible.
    #[arg(long)]
    pub(crate) updown: bool,
    /// Lean of those dwells, standard.
    #[arg(long, value_name = "ANGLE", value_parser = quantity::angle)]
    pub(crate) lean: Option<Angle>,
    /// The body can be turned by 180° on the platform between runs.
    #[arg(long)]
    pub(crate) remounting: bool,
    /// Fitted beside bias, misalignment, scale: k2, k3, temp-bias, temp-scale.
    #[arg(long, value_name = "TERMS", value_delimiter = ',')]
    pub(crate) terms: Vec<String>,
    /// Rise of the temperature during a run, K.
    #[arg(long, value_name = "K")]
    pub(crate) temperature_rise: Option<f64>,
    /// Number of runs [default: 3 to 6, chosen].
    #[arg(long)]
    pub(crate) runs: Option<u32>,
    /// Length of a dwell, s [default: chosen].
    #[arg(long, value_name = "SECONDS")]
    pub(crate) dwell: Option<f64>,
    /// Angles that are there only to test the model [default: 3].
    #[arg(long)]
    pub(crate) spares: Option<usize>,
    /// What is made small: minimax (largest over its target), A or D.
    #[arg(long)]
    pub(crate) criterion: Option<String>,
    /// Time to turn the table to an angle, s.
    #[arg(long, value_name = "SECONDS")]
    pub(crate) set_time: Option<f64>,
    /// Time to let it settle, s.
    #[arg(long, value_name = "SECONDS")]
    pub(crate) settle: Option<f64>,
    /// Time to stand the body upright, s.
    #[arg(long, value_name = "SECONDS")]
    pub(crate) upright_time: Option<f64>,
    /// Time from power-up to the first dwell of a run, s.
    #[arg(long, value_name = "SECONDS")]
    pub(crate) restart: Option<f64>,
    /// Local gravity, m/s², taken as exact.
    #[arg(long, value_name = "M/S2")]
    pub(crate) gravity: Option<f64>,
    /// Scale error of the dial, standard.
    #[arg(long, value_name = "RATIO", value_parser = quantity::ratio)]
    pub(crate) dial_scale: Option<f64>,
    /// Eccentricity of the dial, amplitude.
    #[arg(long, value_name = "ANGLE", value_parser = quantity::angle)]
    pub(crate) eccentricity: Option<Angle>,
    /// Zero of the dial and level of the table, standard.
    #[arg(long, value_name = "ANGLE", value_parser = quantity::angle)]
    pub(crate) dial_zero: Option<Angle>,
    /// Tilt of the table's axis and lean of the sensor, standard, each.
    #[arg(long, value_name = "ANGLE", value_parser = quantity::angle)]
    pub(crate) tilt: Option<Angle>,
    /// K2 where it is not fitted, standard.
    #[arg(long, value_name = "K2", value_parser = quantity::k2)]
    pub(crate) k2: Option<f64>,
    /// K3 where it is not fitted, standard, 1/(m/s²)².
    #[arg(long, value_name = "K3")]
    pub(crate) k3: Option<f64>,
    /// Level of confidence of expanded uncertainties [default: 0.95].
    #[arg(long, value_parser = level)]
    pub(crate) level: Option<f64>,
    /// Your own types of sensors, over the built-in ones.
    #[arg(long, value_name = "FILE")]
    pub(crate) catalogue: Option<PathBuf>,
    /// Write plan.toml, plan.json and the checklist plan.html here.
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    /// Print JSON.
    #[arg(long)]
    pub(crate) json: bool,
    /// Replace another plan in the folder; the old one is kept beside it.
    #[arg(long)]
    pub(crate) replace: bool,
}

/// Lowest and highest angle; a type of its own, for clap takes an array as repeated flags.
#[derive(Debug, Clone)]
pub(crate) struct Range(pub(crate) [f64; 2]);

fn range(text: &str) -> Result<Range, String> {
    let number = |t: &str| t.trim().replace('−', "-").parse::<f64>().ok().filter(|v| v.is_finite());
    let both = match text.split_once(':') {
        Some((low, high)) => number(low).zip(number(high)),
        None => number(text).map(|v| (-v.abs(), v.abs())),
    };
    both.map(|(low, high)| Range([low, high]))
        .ok_or_else(|| "give degrees, 65 for both ways or LOW:HIGH, for instance -30:29".into())
}
