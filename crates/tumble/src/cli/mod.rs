//! Commands, flags and their help; commands with many flags have a file of their own.

mod noise;
mod plan;
mod simulate;

use std::path::PathBuf;

use clap::{Args, CommandFactory as _, FromArgMatches as _, Parser, Subcommand, ValueEnum};
pub(crate) use noise::{DeviationArg, NoiseArgs, TausArg, TimeUnitArg};
pub(crate) use plan::PlanArgs;
pub(crate) use simulate::{PresetArg, QuantizerArg, SimulateArgs};
use tumble_core::Angle;
use tumble_core::estimate::{Term, TermChoice, TermSet};

use crate::quantity;

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
