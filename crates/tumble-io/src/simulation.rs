//! Writes a simulated experiment as a folder, with its truth beside it.

use std::fmt::Write as _;
use std::io::Write as _;
use std::path::Path;

use flate2::{Compression, GzBuilder};
use tumble_core::Quantizer;
use tumble_core::simulate::{
    SimulatedPosition, SimulatedRun, Truth, TruthError, simulate_run, simulate_vertical,
};

use crate::output::{Existing, OutputError, OutputFolder, Written};
use crate::passport::quantizer_name;

/// Options of [`write_simulation`].
#[derive(Debug, Clone, PartialEq)]
pub struct SimulationOptions {
    /// Model, serial and axis for the folder.
    pub model: String,
    /// Serial number.
    pub serial: String,
    /// Pack run files with gzip.
    pub gzip: bool,
    /// Write dwells as averages.
    pub averaged: bool,
    /// What the operator states as the table's setting uncertainty, minutes of arc.
    pub stated_angle_uncertainty_arcmin: f64,
    /// Up/down dwells of 60 s in a power-up of their own, as `[scale]`.
    pub scale_pair: bool,
    /// What to do when the folder is there already.
    pub existing: Existing,
}

/// A simulation that could not be written.
#[derive(Debug)]
pub enum SimulationError {
    /// Cannot be simulated.
    Truth(TruthError),
    /// Could not be written.
    Output(OutputError),
    /// Could not be packed.
    Pack(std::io::Error),
}

impl std::fmt::Display for SimulationError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Truth(e) => e.fmt(f),
            Self::Output(e) => e.fmt(f),
            Self::Pack(e) => write!(f, "gzip: {}", crate::advice(e)),
        }
    }
}

impl std::error::Error for SimulationError {}

/// Simulates an experiment and writes its folder: `experiment.toml`, run files, `truth.toml`. Same truth and
/// options, same bytes.
pub fn write_simulation(
    truth: &Truth,
    options: &SimulationOptions,
    folder: &Path,
    interrupted: &dyn Fn() -> bool,
) -> Result<Written, SimulationError> {
    truth.check().map_err(SimulationError::Truth)?;
    let mut output = OutputFolder::default();
    let ending = if options.gzip { "csv.gz" } else { "csv" };
    let mut add = |name: String, text: String| {
        let bytes = if options.gzip {
            packed(&text).map_err(SimulationError::Pack)?
        } else {
            text.into_bytes()
        };
        output.add(name, bytes);
        Ok::<(), SimulationError>(())
    };
    for run in 0..truth.runs {
        if interrupted() {
            let stopped = OutputError::Interrupted { folder: folder.to_path_buf() };
            return Err(SimulationError::Output(stopped));
        }
        let text = run_text(truth, &simulate_run(truth, run), options);
        add(format!("run-{}.{ending}", run + 1), text)?;
    }
    if options.scale_pair {
        let minute = Truth { dwell_s: 60.0, ..truth.clone() };
        let mut pair = simulate_vertical(&minute).positions.into_iter();
        for name in ["up", "down"] {
            let positions = pair
                .next()
                .into_iter()
                .map(|p| SimulatedPosition { temperature_degc: None, ..p })
                .collect();
            let text = reading_only(truth, &SimulatedRun { positions, bias_m_s2: 0.0 });
            add(format!("{name}.{ending}"), text)?;
        }
    }
    output.add("experiment.toml", experiment_text(truth, options, ending));
    output.add("truth.toml", truth_text(truth));
    output.write(folder, options.existing, interrupted).map_err(SimulationError::Output)
}

/// gzip without a name or a time in its header: the same text gives the same bytes.
fn packed(text: &str) -> std::io::Result<Vec<u8>> {
    let mut encoder = GzBuilder::new().mtime(0).write(Vec::new(), Compression::best());
    encoder.write_all(text.as_bytes())?;
    encoder.finish()
}

fn reading(truth: &Truth, x: f64) -> String {
    match truth.code(x) {
        Some(code) => code.0.to_string(),
        None => format!("{x:.6}"),
    }
}

/// Column of raw readings: codes, or real numbers.
fn column(truth: &Truth) -> &'static str {
    if truth.quantizer == Quantizer::None { "output" } else { "code" }
}

fn run_text(truth: &Truth, run: &SimulatedRun, options: &SimulationOptions) -> String {
    if options.averaged {
        return averaged_text(truth, run);
    }
    let mut text = format!("angle_deg,{}", column(truth));
    text.push_str(if truth.temperature_degc.is_some() { ",temperature_degc\n" } else { "\n" });
    for p in &run.positions {
        let temperature = p.temperature_degc.map_or_else(String::new, |t| format!(",{t:.2}"));
        for x in &p.analogue_lsb {
            // Writing into a String cannot fail.
            let _ = writeln!(text, "{},{}{temperature}", p.angle_deg, reading(truth, *x));
        }
    }
    text
}

fn reading_only(truth: &Truth, run: &SimulatedRun) -> String {
    let mut text = format!("{}\n", column(truth));
    for x in run.positions.iter().flat_map(|p| &p.analogue_lsb) {
        text.push_str(&reading(truth, *x));
        text.push('\n');
    }
    text
}

fn averaged_text(truth: &Truth, run: &SimulatedRun) -> String {
    let mut text = String::from("angle_deg,mean_code,samples,std_code\n");
    for p in &run.positions {
        let readings = tumble_core::simulate::readings(truth, p);
        let _ = writeln!(
            text,
            "{},{:.9},{},{:.9}",
            p.angle_deg,
            readings.mean().unwrap_or_default(),
            readings.samples(),
            readings.std().unwrap_or_default()
        );
    }
    text
}

fn experiment_text(truth: &Truth, options: &SimulationOptions, ending: &str) -> String {
    let quoted = |s: &str| toml::Value::String(s.to_owned()).to_string();
    let mut t = String::from("# Simulated by tumble; the truth is in truth.toml.\nformat = 1\n");
    let _ = writeln!(
        t,
        "\n[sensor]\nmodel = {}\nserial = {}\naxis = \"X\"",
        quoted(&options.model),
        quoted(&options.serial)
    );
    let _ = writeln!(t, "\n[output]\nquantizer = \"{}\"", quantizer_name(truth.quantizer));
    if truth.quantizer == Quantizer::None {
        let _ = writeln!(t, "unit = \"LSB\"");
    }
    let _ = writeln!(t, "nominal_scale = {}   # m/s² per LSB", truth.nominal_scale_m_s2_per_lsb);
    let _ = writeln!(t, "rate_hz = {:?}", truth.rate_hz);
    for (key, end) in [("min_code", truth.ends.min_code), ("max_code", truth.ends.max_code)] {
        if let Some(code) = end {
            let _ = writeln!(t, "{key} = {}", code.0);
        }
    }
    let _ = writeln!(
        t,
        "\n[bench]\ngravity = {:?}   # m/s²\ngravity_uncertainty = 0.0\nangle_uncertainty_arcmin = {:?}",
        truth.gravity_m_s2, options.stated_angle_uncertainty_arcmin
    );
    if options.scale_pair {
        let _ = writeln!(t, "\n[scale]\nup = \"up.{ending}\"\ndown = \"down.{ending}\"");
    }
    for run in 0..truth.runs {
        let _ = writeln!(t, "\n[[run]]\nfile = \"run-{}.{ending}\"\nmounting = \"A\"", run + 1);
    }
    t
}

fn truth_text(truth: &Truth) -> String {
    let mut t = String::from("# What the simulation knows. Units are in the names.\n");
    let mut number = |key: &str, v: f64| {
        let _ = writeln!(t, "{key} = {v:?}");
    };
    number("bias_m_s2", truth.bias_m_s2);
    number("misalignment_rad", truth.misalignment.rad());
    number("scale_error", truth.scale_error);
    number("k2_per_m_s2", truth.k2_per_m_s2);
    number("k3_per_m2_s4", truth.k3_per_m2_s4);
    number("gravity_m_s2", truth.gravity_m_s2);
    number("nominal_scale_m_s2_per_lsb", truth.nominal_scale_m_s2_per_lsb);
    number("noise_m_s2", truth.noise_m_s2);
    number("random_walk_m_s2_rts", truth.random_walk_m_s2_rts);
    number("turn_on_m_s2", truth.turn_on_m_s2);
    number("bias_per_k_m_s2", truth.bias_per_k_m_s2);
    number("setting_scatter_arcmin", truth.setting_scatter.arcmin());
    number("dial_zero_arcmin", truth.dial_zero.arcmin());
    number("dial_scale", truth.dial_scale);
    number("eccentricity_arcmin", truth.eccentricity.arcmin());
    number("eccentricity_phase_deg", truth.eccentricity_phase.deg());
    number("axis_tilt_arcmin", truth.axis_tilt.arcmin());
    number("sensor_lean_arcmin", truth.sensor_lean.arcmin());
    number("vertical_lean_arcmin", truth.vertical_lean.arcmin());
    number("dwell_s", truth.dwell_s);
    number("rate_hz", truth.rate_hz);
    let _ = writeln!(t, "quantizer = \"{}\"", quantizer_name(truth.quantizer));
    let _ = writeln!(t, "runs = {}\nseed = {}", truth.runs, truth.seed);
    let _ = writeln!(t, "angles_deg = {:?}", truth.angles_deg);
    let biases: Vec<f64> =
        (0..truth.runs).map(|r| tumble_core::simulate::run_bias_m_s2(truth, r)).collect();
    let _ = writeln!(t, "run_bias_m_s2 = {biases:?}");
    t
}
