//! A bench whose truth is known, as files in a folder.

use std::fmt::Write as _;

use tumble_io::passport::Passport;
use tumble_io::{CertifyOptions, certify};

use crate::{G, K0, Noise};

/// Bias of the sensor, LSB.
pub const BIAS_LSB: f64 = 3.4;
/// Its misalignment, rad.
pub const MISALIGNMENT_RAD: f64 = 0.002;
/// Its scale factor, m/s² per LSB.
pub const SCALE: f64 = K0 * 1.01;

/// What the sensor says at a table angle, LSB, before noise.
pub fn level(deg: f64) -> f64 {
    G * (deg.to_radians() + MISALIGNMENT_RAD).sin() / SCALE + BIAS_LSB
}

/// One dwell of averages, before it was written.
#[derive(Debug, Clone, Copy)]
pub struct Dwell {
    pub run: usize,
    pub index: usize,
    /// Where the table stood, degrees.
    pub deg: f64,
    /// What scatters here, LSB.
    pub scatter: f64,
}

/// A column: its name and its value in a dwell.
pub type Column = (&'static str, fn(Dwell) -> f64);
/// Noise of a sample in LSB, and what the converter makes of it.
pub type Raw = (f64, fn(f64) -> f64);

/// A folder of averaged runs.
pub struct Bench {
    pub angles: Vec<f64>,
    pub runs: usize,
    /// Mean code that is written.
    pub code: Box<dyn Fn(Dwell) -> f64>,
    /// Angle that is written.
    pub typed: Box<dyn Fn(Dwell) -> f64>,
    /// Scatter of a position at 0°, LSB.
    pub scatter: f64,
    pub quantizer: &'static str,
    pub nominal_scale: f64,
    /// More of `[output]`, `[bench]`, and tables at the end.
    pub output: &'static str,
    pub bench: &'static str,
    pub tail: String,
    /// More columns: name and value.
    pub column: Option<Column>,
    /// Single codes instead of averages: noise in LSB, and what the converter makes of a sample.
    pub raw: Option<Raw>,
}

impl Bench {
    pub fn new(angles: Vec<f64>) -> Self {
        Self {
            angles,
            runs: 3,
            code: Box::new(|d| level(d.deg) + d.scatter),
            typed: Box::new(|d| d.deg),
            scatter: 0.2,
            quantizer: "round",
            nominal_scale: K0,
            output: "",
            bench: "angle_uncertainty_arcmin = 0.55",
            tail: String::new(),
            column: None,
            raw: None,
        }
    }

    pub fn code(self, code: impl Fn(Dwell) -> f64 + 'static) -> Self {
        Self { code: Box::new(code), ..self }
    }

    pub fn typed(self, typed: impl Fn(Dwell) -> f64 + 'static) -> Self {
        Self { typed: Box::new(typed), ..self }
    }

    fn csv(&self, run: usize) -> String {
        let mut noise = Noise(run as u64 * 7919 + 17);
        let more = self.column.map_or(String::new(), |(name, _)| format!(",{name}"));
        let mut csv = match self.raw {
            Some(_) => format!("position,angle_deg,code{more}\n"),
            None => format!("angle_deg,mean_code,samples,std_code{more}\n"),
        };
        for (index, deg) in self.angles.iter().enumerate() {
            // 0.55′ of angle, as the bench states: it goes with the cosine.
            let scatter = self.scatter * deg.to_radians().cos() * noise.next();
            let d = Dwell { run, index, deg: *deg, scatter };
            let (angle, code) = ((self.typed)(d), (self.code)(d));
            let more = self.column.map_or(String::new(), |(_, f)| format!(",{}", f(d)));
            match self.raw {
                Some((sigma, converter)) => {
                    for _ in 0..200 {
                        let sample = converter(code + sigma * noise.next());
                        let _ = writeln!(csv, "{index},{angle},{sample}{more}");
                    }
                }
                None => {
                    let _ = writeln!(csv, "{angle},{code:.6},1500,1.25{more}");
                }
            }
        }
        csv
    }

    pub fn certify(&self) -> Passport {
        let csv: Vec<String> = (0..self.runs).map(|run| self.csv(run)).collect();
        self.certify_files(&csv)
    }

    /// The same folder with other files for the runs.
    pub fn certify_files(&self, csv: &[String]) -> Passport {
        let dir = tempfile::tempdir().unwrap();
        let mut toml = format!(
            "[sensor]\nmodel = \"\"\nserial = \"x\"\n[output]\nquantizer = \"{}\"\nnominal_scale = {}\n{}\n[bench]\n{}{}\n",
            self.quantizer,
            self.nominal_scale,
            self.output,
            if self.bench.contains("gravity") {
                String::new()
            } else {
                format!("gravity = {G}\ngravity_uncertainty = 0.0003\n")
            },
            self.bench
        );
        for (run, text) in csv.iter().enumerate() {
            let _ = write!(toml, "[[run]]\nfile = \"run-{run}.csv\"\n");
            std::fs::write(dir.path().join(format!("run-{run}.csv")), text).unwrap();
        }
        toml.push_str(&self.tail);
        std::fs::write(dir.path().join("experiment.toml"), toml).unwrap();
        certify(dir.path(), &CertifyOptions::default()).unwrap()
    }

    pub fn files(&self) -> Vec<String> {
        (0..self.runs).map(|run| self.csv(run)).collect()
    }
}
