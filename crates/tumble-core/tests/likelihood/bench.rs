//! Simulated runs with a known truth, made fast: tens of thousands of them are needed.

use rand_core::SeedableRng;
use rand_distr::{Distribution, StandardNormal, StandardUniform};
use rand_pcg::Pcg64Mcg;
use tumble_core::estimate::Setting;
use tumble_core::{
    Angle, Bench, BlockSums, CodeHistogram, ConverterEnds, Gravity, GravitySource, Position,
    Quantizer, Readings, Seat,
};

pub const GRAVITY: f64 = 9.81;
pub const ARCMIN: f64 = tumble_core::ARCMIN_RAD;

/// A bench and a sensor. Everything in LSB of its own scale, angles in degrees.
#[derive(Debug, Clone)]
pub struct Truth {
    pub angles_deg: Vec<f64>,
    /// Nominal and true scale factor, m/s² per LSB.
    pub nominal: f64,
    pub scale_error: f64,
    pub bias_lsb: f64,
    pub misalignment: f64,
    pub sigma: f64,
    /// Scatter between dwells, LSB.
    pub level: f64,
    /// Scatter of the angles, rad.
    pub angle: f64,
    /// Random walk within a dwell, LSB per √sample, from zero in each dwell.
    pub walk: f64,
    pub quantizer: Quantizer,
    pub samples: usize,
    /// Dwells up and down, leaning by this standard deviation (rad).
    pub upright: Option<f64>,
    pub stated_arcmin: f64,
}

impl Truth {
    pub fn new(angles_deg: Vec<f64>) -> Self {
        Self {
            angles_deg,
            nominal: 0.007_69,
            scale_error: 0.01,
            bias_lsb: 0.37,
            misalignment: 0.0,
            sigma: 1.2,
            level: 0.0,
            angle: 0.0,
            walk: 0.0,
            quantizer: Quantizer::Truncate,
            samples: 1500,
            upright: None,
            stated_arcmin: 3.0,
        }
    }

    /// Bias (m/s²), misalignment (rad), scale error.
    pub fn parameters(&self) -> [f64; 3] {
        let k = self.nominal * (1.0 + self.scale_error);
        [self.bias_lsb * k, self.misalignment, self.scale_error]
    }

    pub fn bench(&self) -> Bench {
        Bench {
            gravity: Gravity {
                value_m_s2: GRAVITY,
                standard_uncertainty_m_s2: 0.0,
                source: GravitySource::Stated,
            },
            angle_uncertainty: (self.stated_arcmin > 0.0)
                .then(|| Angle::from_arcmin(self.stated_arcmin)),
            range: None,
            vertical_lean: Angle::from_rad(self.upright.unwrap_or(0.0)),
        }
    }

    /// The same bench with a bias somewhere in one LSB: where codes change must differ from run to run, for the
    /// figures not to be those of one set of phases.
    pub fn dithered(&self, seed: u64) -> Self {
        let mut rng = Pcg64Mcg::seed_from_u64(seed ^ 0x5eed);
        let phase: f64 = StandardUniform.sample(&mut rng);
        Self { bias_lsb: self.bias_lsb + phase, ..self.clone() }
    }

    /// One run; the same seed gives the same codes.
    pub fn run(&self, seed: u64) -> Vec<Position> {
        let mut rng = Pcg64Mcg::seed_from_u64(seed);
        let mut normal = move || -> f64 { StandardNormal.sample(&mut rng) };
        let full_scale = GRAVITY / (self.nominal * (1.0 + self.scale_error));
        let mut out = Vec::new();
        let upright = self.upright.map(|_| [90.0, -90.0]).into_iter().flatten();
        for deg in upright.chain(self.angles_deg.iter().copied()) {
            let angle = Angle::from_deg(deg);
            let seat = match deg {
                90.0 => Seat::Up,
                -90.0 => Seat::Down,
                _ => Seat::Table,
            };
            let true_angle = match seat {
                Seat::Table => angle.rad() + self.misalignment + self.angle * normal(),
                _ => angle.rad() + self.upright.unwrap_or(0.0) * normal(),
            };
            let level = full_scale * true_angle.sin() + self.bias_lsb + self.level * normal();
            out.push(Position {
                angle,
                seat,
                readings: self.dwell(level, &mut normal),
                temperature_degc: None,
                place: String::new(),
            });
        }
        out
    }

    fn dwell(&self, level: f64, normal: &mut impl FnMut() -> f64) -> Readings {
        let mut blocks = BlockSums::default();
        let mut histogram = CodeHistogram::default();
        let mut walk = 0.0;
        for _ in 0..self.samples {
            if self.walk > 0.0 {
                walk += self.walk * normal();
            }
            let x = level + walk + self.sigma * normal();
            if let Some(code) = self.quantizer.code(x) {
                histogram.record(code);
                blocks.record(i128::from(code.0));
            }
        }
        Readings::Codes { histogram, blocks }
    }
}

pub fn setting<'a>(truth: &Truth, bench: &'a Bench) -> Setting<'a> {
    Setting {
        bench,
        quantizer: truth.quantizer,
        ends: ConverterEnds::default(),
        nominal_scale_m_s2_per_lsb: truth.nominal,
    }
}

/// `count` equal steps from −range to +range.
pub fn equal(range: f64, count: usize) -> Vec<f64> {
    (0..count).map(|i| -range + 2.0 * range * i as f64 / (count - 1) as f64).collect()
}

pub fn paper() -> Vec<f64> {
    (-30..30).map(f64::from).collect()
}
