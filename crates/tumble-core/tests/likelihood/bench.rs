//! Simulated runs with a known truth, made fast: hundreds of thousands of them are needed.

use rand_core::SeedableRng;
use rand_distr::{Distribution, StandardNormal, StandardUniform};
use rand_pcg::Pcg64Mcg;
use tumble_core::estimate::{Setting, Term};
use tumble_core::{
    ARCMIN_RAD, Angle, Bench, BlockSums, Code, CodeHistogram, ConverterEnds, Gravity,
    GravitySource, Position, Quantizer, Readings, Record, Seat,
};

pub const GRAVITY: f64 = 9.81;
/// The paper's nominal scale, m/s² per LSB.
pub const PAPER_SCALE: f64 = 0.007_69;

/// A bench and a sensor with every error known.
#[derive(Debug, Clone)]
pub struct Truth {
    pub angles_deg: Vec<f64>,
    /// m/s² per LSB.
    pub nominal_scale: f64,
    pub scale_error: f64,
    pub bias_lsb: f64,
    pub misalignment_rad: f64,
    /// Noise of a sample, LSB.
    pub sigma: f64,
    /// Scatter between dwells, LSB.
    pub level: f64,
    /// Scatter of the angles, arcmin.
    pub angle_arcmin: f64,
    /// Random walk within a dwell, LSB per √sample, from zero in each dwell.
    pub walk: f64,
    pub quantizer: Quantizer,
    pub ends: ConverterEnds,
    pub samples: usize,
    /// Dwells up and down, and how far they lean (standard, arcmin).
    pub upright_arcmin: Option<f64>,
    /// What the operator states as `σφ`.
    pub stated_arcmin: Option<f64>,
    /// Further terms, SI.
    pub further: Vec<(Term, f64)>,
    /// Temperatures at the first and the last dwell, °C, recorded.
    pub temperature_degc: Option<(f64, f64)>,
}

/// One run as it was recorded, and what no recorder knows.
pub struct SimulatedRun {
    pub positions: Vec<Position>,
    /// Mean analogue value of each dwell, LSB.
    pub analogue_lsb: Vec<f64>,
}

impl Truth {
    /// The paper's sensor on a perfect table.
    pub fn new(angles_deg: Vec<f64>) -> Self {
        Self {
            angles_deg,
            nominal_scale: PAPER_SCALE,
            scale_error: 0.01,
            bias_lsb: 0.37,
            misalignment_rad: 0.0,
            sigma: 1.2,
            level: 0.0,
            angle_arcmin: 0.0,
            walk: 0.0,
            quantizer: Quantizer::Truncate,
            ends: ConverterEnds::default(),
            samples: 1500,
            upright_arcmin: None,
            stated_arcmin: None,
            further: Vec::new(),
            temperature_degc: None,
        }
    }

    /// `k*`, m/s² per LSB.
    pub fn scale(&self) -> f64 {
        self.nominal_scale * (1.0 + self.scale_error)
    }

    /// `R = g/k*`, LSB.
    pub fn full_scale(&self) -> f64 {
        GRAVITY / self.scale()
    }

    /// Bias (m/s²), misalignment (rad), scale error.
    pub fn parameters(&self) -> [f64; 3] {
        [self.bias_lsb * self.scale(), self.misalignment_rad, self.scale_error]
    }

    /// Variance of a dwell's level about the model at an angle, LSB².
    pub fn scatter_variance(&self, angle_rad: f64) -> f64 {
        let slope = self.full_scale() * (angle_rad + self.misalignment_rad).cos();
        self.level.powi(2) + (slope * self.angle_arcmin * ARCMIN_RAD).powi(2)
    }

    pub fn bench(&self) -> Bench {
        Bench {
            gravity: Gravity {
                value_m_s2: GRAVITY,
                standard_uncertainty_m_s2: 0.0,
                source: GravitySource::Stated,
            },
            angle_uncertainty: self.stated_arcmin.map(Angle::from_arcmin),
            range: None,
            vertical_lean: Angle::from_arcmin(self.upright_arcmin.unwrap_or(0.0)),
            systematics: tumble_core::systematic::Systematics::default(),
        }
    }

    pub fn setting<'a>(&self, bench: &'a Bench) -> Setting<'a> {
        Setting {
            bench,
            quantizer: self.quantizer,
            ends: self.ends,
            nominal_scale_m_s2_per_lsb: self.nominal_scale,
        }
    }

    /// The same bench with a bias anywhere in one LSB: where codes change must differ from run to run, for the figures
    /// not to be those of one set of phases.
    pub fn dithered(&self, seed: u64) -> Self {
        let phase: f64 = StandardUniform.sample(&mut Pcg64Mcg::seed_from_u64(seed ^ 0x5eed));
        Self { bias_lsb: self.bias_lsb + phase, ..self.clone() }
    }

    /// The same bench with a misalignment within ± 2 mrad: positions at +φ and −φ must not have mirrored codes, whose
    /// quantization errors cancel in the bias of a truncating converter.
    pub fn turned(&self, seed: u64) -> Self {
        let share: f64 = StandardUniform.sample(&mut Pcg64Mcg::seed_from_u64(seed ^ 0x7a11));
        Self { misalignment_rad: 0.004 * (share - 0.5), ..self.clone() }
    }

    /// One run; the same seed gives the same codes.
    pub fn run(&self, seed: u64) -> SimulatedRun {
        let mut rng = Pcg64Mcg::seed_from_u64(seed);
        let mut normal = move || -> f64 { StandardNormal.sample(&mut rng) };
        let upright = self.upright_arcmin.map(|_| [90.0, -90.0]).into_iter().flatten();
        let mut out = SimulatedRun { positions: Vec::new(), analogue_lsb: Vec::new() };
        let plan: Vec<f64> = upright.chain(self.angles_deg.iter().copied()).collect();
        for (j, deg) in plan.iter().copied().enumerate() {
            let angle = Angle::from_deg(deg);
            let seat = match deg {
                90.0 => Seat::Up,
                -90.0 => Seat::Down,
                _ => Seat::Table,
            };
            let off_arcmin = match seat {
                Seat::Table => self.angle_arcmin,
                Seat::Up | Seat::Down => self.upright_arcmin.unwrap_or(0.0),
            };
            let misalignment = if seat == Seat::Table { self.misalignment_rad } else { 0.0 };
            let true_rad = angle.rad() + misalignment + off_arcmin * ARCMIN_RAD * normal();
            let share = j as f64 / (plan.len() - 1) as f64;
            let temperature_degc =
                self.temperature_degc.map(|(from, to)| from + (to - from) * share);
            let kelvin =
                self.temperature_degc.map_or(0.0, |(from, to)| (to - from) * (share - 0.5));
            let a = GRAVITY * true_rad.sin();
            let added: f64 = self.further.iter().map(|(t, c)| c * t.basis(a, kelvin)).sum();
            let level = self.full_scale() * true_rad.sin()
                + added / self.scale()
                + self.bias_lsb
                + self.level * normal();
            let (readings, mean) = self.dwell(level, &mut normal);
            out.analogue_lsb.push(mean);
            out.positions.push(Position {
                angle,
                seat,
                readings,
                temperature_degc,
                place: String::new(),
                record: Record::default(),
            });
        }
        out
    }

    fn code(&self, x: f64) -> Option<Code> {
        let code = self.quantizer.code(x)?;
        let code = self.ends.min_code.map_or(code, |m| code.max(m));
        Some(self.ends.max_code.map_or(code, |m| code.min(m)))
    }

    fn dwell(&self, level: f64, normal: &mut impl FnMut() -> f64) -> (Readings, f64) {
        let mut blocks = BlockSums::default();
        let mut histogram = CodeHistogram::default();
        let (mut walk, mut sum) = (0.0, 0.0);
        for _ in 0..self.samples {
            if self.walk > 0.0 {
                walk += self.walk * normal();
            }
            let x = level + walk + self.sigma * normal();
            sum += x;
            if let Some(code) = self.code(x) {
                histogram.record(code);
                blocks.record(i128::from(code.0));
            }
        }
        (Readings::Codes { histogram, blocks }, sum / self.samples as f64)
    }
}

/// `count` equal steps from −range to +range, degrees.
pub fn equal(range: f64, count: usize) -> Vec<f64> {
    (0..count).map(|i| -range + 2.0 * range * i as f64 / (count - 1) as f64).collect()
}

/// The paper's plan.
pub fn paper() -> Vec<f64> {
    (-30..30).map(f64::from).collect()
}

/// `count` positions over ±range, a fifth of them within a few LSB of code zero.
pub fn around_zero(range: f64, count: usize) -> Vec<f64> {
    let near = count / 5;
    let mut plan = equal(range, count - near);
    plan.extend(equal(0.15, near));
    plan
}
