//! Commands, flags and their help.
//!
//! Past 500 lines: it is the text of `--help`, one struct a command.

use std::path::PathBuf;

use clap::{Args, CommandFactory as _, FromArgMatches as _, Parser, Subcommand, ValueEnum};
use tumble_core::Angle;
use tumble_core::estimate::{Term, TermChoice, TermSet};

use crate::quantity::{self, AccelerationArg, NoiseArg};

/// Calibrates accelerometers against gravity: raw codes in, a passport that you can trust out.
#[derive(Debug, Parser)]
#[command(
    name = "tumble",
    version,
    about,
    max_term_width = 80,
    after_help = "\
Exit codes: 0 accepted or done, 1 rejected, 2 usage or unreadable input,
3 accepted with warnings (--strict), 4 indeterminate, 5 I/O failure, 130 Ctrl-C."
)]
pub(crate) struct Cli {
    #[command(subcommand)]
    pub(crate) command: Command,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Draft an experiment.toml from your CSV files.
    Init(InitArgs),
    /// Say what was read of an experiment, without judgement.
    Check(CheckArgs),
    /// Certify experiments: estimate, judge, write the passport.
    Certify(CertifyArgs),
    /// Plan a measurement: which angles, in which order, how long, how often.
    Plan(Box<PlanArgs>),
    /// Simulate an experiment with a known truth.
    Simulate(Box<SimulateArgs>),
    /// Say what noise a record at rest holds, and how long to dwell.
    Noise(Box<NoiseArgs>),
    /// Turn codes into m/s² with a passport.
    Compensate(CompensateArgs),
    /// List the known types of sensors, with limits and sources.
    Catalogue(CatalogueArgs),
    /// Explain findings: what was seen, why it matters, what to do.
    Explain(ExplainArgs),
    /// Print completions for a shell.
    Completions(CompletionsArgs),
    /// Print the manual page, or write one a command.
    Man(ManArgs),
}

/// The way of a first experiment, by command.
const FIRST_STEPS: [(&str, &str, &str); 6] = [
    ("plan", "tumble plan --range 65 --hours 1", "angles and a checklist to print"),
    ("init", "tumble init log.csv", "experiment.toml from your own files"),
    ("simulate", "tumble simulate demo", "a folder to look at, simulated"),
    ("check", "tumble check demo", "what was read"),
    ("certify", "tumble certify demo --out out", "the verdict, and the passport"),
    ("explain", "tumble explain T0205", "what a finding means"),
];

/// The definition with its first steps; a step stands there only with its command.
pub(crate) fn definition() -> clap::Command {
    let definition = Cli::command();
    let mut help = String::from("First steps:\n");
    for (command, line, remark) in FIRST_STEPS {
        if definition.find_subcommand(command).is_some() {
            help.push_str(&format!("  {line:<30}  # {remark}\n"));
        }
    }
    let codes = definition.get_after_help().map(ToString::to_string).unwrap_or_default();
    definition.after_help(format!("{help}\n{codes}"))
}

/// The command line as arguments, or clap's answer to it: help and versions exit with 0, everything else with 2.
pub(crate) fn parse() -> Cli {
    let matches = definition().get_matches();
    Cli::from_arg_matches(&matches).unwrap_or_else(|e| e.exit())
}

#[derive(Debug, Args)]
#[command(
    allow_negative_numbers = true,
    after_help = "\
Looks at the files, guesses columns, units, rate, dwells, angles and scale, asks
nothing, writes a commented experiment.toml beside them, and says what it
assumed. Files of one sensor lie in one folder.

Examples:
  tumble init log.csv --latitude 50 --height 150
  tumble init run-*.csv --model ADXL203 --serial 3
  tumble init minus30.csv zero.csv plus30.csv
  tumble init imu.csv --reading acc_y --gravity 9.8102"
)]
pub(crate) struct InitArgs {
    /// CSV files of one sensor.
    #[arg(required = true, value_name = "CSV")]
    pub(crate) files: Vec<PathBuf>,
    /// Model of the sensor; may name an entry of the catalogue.
    #[arg(long)]
    pub(crate) model: Option<String>,
    /// Serial number.
    #[arg(long)]
    pub(crate) serial: Option<String>,
    /// Column of the readings, by its header or number.
    #[arg(long, value_name = "COLUMN")]
    pub(crate) reading: Option<String>,
    /// Local gravity, m/s².
    #[arg(long, value_name = "M/S2", conflicts_with_all = ["latitude", "height"])]
    pub(crate) gravity: Option<f64>,
    /// Latitude of the bench, degrees.
    #[arg(long, value_name = "DEG", requires = "height", allow_hyphen_values = true)]
    pub(crate) latitude: Option<f64>,
    /// Height of the bench, m.
    #[arg(long, value_name = "M", requires = "latitude", allow_hyphen_values = true)]
    pub(crate) height: Option<f64>,
    /// Nominal scale factor, m/s² per LSB (or per unit of the readings).
    #[arg(long, value_name = "M/S2")]
    pub(crate) scale: Option<f64>,
    /// Random error of setting an angle, standard, for instance 3arcmin.
    #[arg(long, value_name = "ANGLE", value_parser = quantity::angle)]
    pub(crate) scatter: Option<Angle>,
    /// Print experiment.toml instead of writing it.
    #[arg(long)]
    pub(crate) print: bool,
    /// Replace an experiment.toml that is there; the old one is kept beside it.
    #[arg(long)]
    pub(crate) replace: bool,
    /// Print nothing but errors.
    #[arg(long)]
    pub(crate) quiet: bool,
}

#[derive(Debug, Args)]
#[command(after_help = "\
A table of the dwells: angle, samples, recorded rate, missing samples, mean,
noise of single readings, temperature, distance from a plain line through the
run. `off line` and `noise` are in the unit of the readings (LSB for codes).

Examples:
  tumble check my-sensor
  tumble check my-sensor --json | jq '.runs[0].dwells[] | .angle_deg'")]
pub(crate) struct CheckArgs {
    /// Experiment folder (with an experiment.toml).
    #[arg(value_name = "FOLDER")]
    pub(crate) folder: PathBuf,
    /// Print as JSON.
    #[arg(long)]
    pub(crate) json: bool,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum MethodArg {
    /// The paper's: linear in the small unknowns, unweighted.
    Paper,
    /// Exact for errors of any size, on averages.
    Exact,
    /// Two-level likelihood: codes within a dwell, scatter between dwells.
    Likelihood,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum WeightsArg {
    /// All positions alike.
    Equal,
    /// By what an error of the angle does at each position.
    Angle,
    /// The stated angle uncertainty is taken as known (likelihood only).
    Stated,
}

#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  tumble certify examples/adxl203-3
  tumble certify my-sensor --out my-sensor/passport
  tumble certify unit-1 unit-2 --out passports   # a subfolder a serial
  tumble certify my-sensor --leave-out run-2:7,12
  tumble certify my-sensor --json | jq .result.bias")]
pub(crate) struct CertifyArgs {
    /// Experiment folders (each with an experiment.toml).
    #[arg(required = true, value_name = "FOLDER")]
    pub(crate) folders: Vec<PathBuf>,
    /// Write passport.json, passport.html and figures here.
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    /// Estimator.
    #[arg(long, value_enum, default_value = "likelihood")]
    pub(crate) method: MethodArg,
    /// Weights of the positions [default: angle; the paper's method has none].
    #[arg(long, value_enum)]
    pub(crate) weights: Option<WeightsArg>,
    /// Level of confidence of all intervals.
    #[arg(long, default_value_t = 0.95, value_parser = level)]
    pub(crate) level: f64,
    /// Digits of U that Monte Carlo is to settle (JCGM 101): 1, 2, or 0 for no draws.
    #[arg(long, value_name = "DIGITS", default_value_t = 2, value_parser = clap::value_parser!(u32).range(0..=2))]
    pub(crate) monte_carlo: u32,
    /// Leave positions out of the adjustment (repeatable); the passport says so.
    #[arg(long, value_name = "RUN:POSITION[,…]", value_parser = leave_out)]
    pub(crate) leave_out: Vec<LeaveOut>,
    /// Further terms: none, auto, or of k2,k3,scale-sign,temp-bias,temp-scale [default: none; all are tried].
    #[arg(long, value_name = "TERMS", value_parser = terms)]
    pub(crate) terms: Option<TermChoice>,
    /// Your own types of sensors, over the folder's catalogue.toml and the built-in ones.
    #[arg(long, value_name = "FILE")]
    pub(crate) catalogue: Option<PathBuf>,
    /// Number of the certificate.
    #[arg(long)]
    pub(crate) id: Option<String>,
    /// Day of issue, for instance 2026-11-23. Never taken from the clock.
    #[arg(long, value_name = "DATE", value_parser = date)]
    pub(crate) issued: Option<String>,
    /// Print the passport as JSON (one line each, for several folders).
    #[arg(long)]
    pub(crate) json: bool,
    /// Print nothing but errors.
    #[arg(long, conflicts_with = "json")]
    pub(crate) quiet: bool,
    /// Exit with 3 when accepted with warnings.
    #[arg(long)]
    pub(crate) strict: bool,
    /// Replace another result in the output folder; the old one is kept beside it.
    #[arg(long)]
    pub(crate) replace: bool,
}

/// Positions of one run, by their numbers in measured order.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct LeaveOut {
    pub(crate) run: String,
    pub(crate) positions: Vec<usize>,
}

/// `run-2:7,12`; names of runs may hold colons.
fn leave_out(text: &str) -> Result<LeaveOut, String> {
    let expected = || "give RUN:POSITION[,POSITION...], for instance run-2:7,12".to_owned();
    let (run, list) = text.rsplit_once(':').ok_or_else(expected)?;
    let positions: Result<Vec<usize>, _> = list.split(',').map(|n| n.trim().parse()).collect();
    match positions {
        Ok(positions) if !run.is_empty() => Ok(LeaveOut { run: run.to_owned(), positions }),
        _ => Err(expected()),
    }
}

/// `auto`, `none`, or names of terms.
fn terms(text: &str) -> Result<TermChoice, String> {
    match text.trim() {
        "auto" => return Ok(TermChoice::Auto),
        "none" => return Ok(TermChoice::Named(TermSet::EMPTY)),
        _ => {}
    }
    let of = |name: &str| {
        Term::from_name(name).ok_or_else(|| {
            let all: Vec<&str> = Term::ALL.iter().map(|t| t.name()).collect();
            format!(
                "no term is called `{}`; did you mean {}? There are {}, or auto, or none",
                name.trim().escape_debug(),
                Term::nearest(name).name(),
                all.join(", ")
            )
        })
    };
    text.split(',').map(of).collect::<Result<TermSet, String>>().map(TermChoice::Named)
}

fn level(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(v) if (0.5..1.0).contains(&v) => Ok(v),
        _ => Err("give a level between 0.5 and 1, for instance 0.95".into()),
    }
}

/// A temperature that readings can have.
fn degc(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(v) if (-273.15..=1000.0).contains(&v) => Ok(v),
        _ => Err("give degrees Celsius, for instance 21.5".into()),
    }
}

/// A day of the calendar as ISO 8601 writes it.
fn date(text: &str) -> Result<String, String> {
    tumble_io::is_iso_date(text)
        .then(|| text.to_owned())
        .ok_or_else(|| "give a day as YYYY-MM-DD, for instance 2026-11-23".into())
}

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

#[derive(Debug, Args)]
#[command(after_help = "\
Input: CSV with a column `code` (and perhaps `t_s`), or bare codes, one a line.
Output: [t_s,]code,acceleration_m_s2,u_calibration_m_s2,u_reading_m_s2
  u_calibration is common to all readings of this unit; u_reading (noise and
  resolution of one reading) falls with averaging. Both are standard (k = 1).
  Codes at the converter's end are no measurement: their cells stay empty.

Examples:
  echo 100 | tumble compensate out/passport.json
  tumble compensate out/passport.json flight.csv > flight-m-s2.csv")]
pub(crate) struct CompensateArgs {
    /// The unit's passport.json.
    #[arg(value_name = "PASSPORT")]
    pub(crate) passport: PathBuf,
    /// File with codes [default: standard input].
    #[arg(value_name = "CSV")]
    pub(crate) input: Option<PathBuf>,
    /// Use coefficients whose reproducibility is not shown.
    #[arg(long)]
    pub(crate) unproven: bool,
    /// Temperature of all readings, °C, where they have no column `temperature_degc`.
    #[arg(long, value_name = "DEGC", allow_hyphen_values = true, value_parser = degc)]
    pub(crate) temperature: Option<f64>,
    /// No remarks on standard error.
    #[arg(long)]
    pub(crate) quiet: bool,
}

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

#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  tumble explain T0205
  tumble explain t205 312        # several; case and leading T0 do not matter
  tumble explain                 # all of them, a line each
  tumble explain --markdown > findings.md")]
pub(crate) struct ExplainArgs {
    /// Ids of findings, for instance T0205; without one all are listed.
    #[arg(value_name = "ID")]
    pub(crate) ids: Vec<String>,
    /// Print the page of all findings in Markdown.
    #[arg(long, conflicts_with_all = ["ids", "json"])]
    pub(crate) markdown: bool,
    /// Print JSON: a list of findings with their texts.
    #[arg(long)]
    pub(crate) json: bool,
}

#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  tumble completions bash > ~/.local/share/bash-completion/completions/tumble
  tumble completions fish > ~/.config/fish/completions/tumble.fish
  tumble completions zsh > ~/.zfunc/_tumble   # ~/.zfunc stands in $fpath")]
pub(crate) struct CompletionsArgs {
    /// The shell.
    #[arg(value_enum)]
    pub(crate) shell: clap_complete::Shell,
}

#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  tumble man | man -l -
  tumble man --out ~/.local/share/man/man1")]
pub(crate) struct ManArgs {
    /// Write tumble.1 and a page a command into this folder; other files stay.
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    /// Overwrite pages of the same names that differ.
    #[arg(long, requires = "out")]
    pub(crate) replace: bool,
}

#[derive(Debug, Args)]
#[command(after_help = "\
Limits of a sensor's type warn in `certify` (T0125) where [sensor] model names
an entry; they never reject. Every number says whether it is verified.

Examples:
  tumble catalogue
  tumble catalogue ADXL203
  tumble catalogue --catalogue my-parts.toml my-board
  tumble catalogue MPU-6050 --json | jq .modes")]
pub(crate) struct CatalogueArgs {
    /// One model in full; case and punctuation do not matter.
    #[arg(value_name = "MODEL")]
    pub(crate) model: Option<String>,
    /// Your own types of sensors, over the built-in ones.
    #[arg(long, value_name = "FILE")]
    pub(crate) catalogue: Option<PathBuf>,
    /// Print JSON.
    #[arg(long)]
    pub(crate) json: bool,
}
