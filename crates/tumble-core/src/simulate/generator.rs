//! From a truth to codes.

use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64;

use super::Truth;
use crate::{
    Bench, BlockSums, Code, CodeHistogram, Dial, Experiment, Gravity, GravitySource, Orientation,
    Output, Position, Quantizer, Readings, Record, Run, Sensor, Targets, ValueMoments,
};

/// One simulated dwell.
#[derive(Debug, Clone, PartialEq)]
pub struct SimulatedPosition {
    /// Table angle as an operator would write it, degrees.
    pub angle_deg: f64,
    /// Analogue samples, LSB, in time order; what the converter makes of them is [`Truth::code`].
    pub analogue_lsb: Vec<f64>,
    /// Temperature during the dwell, where it is recorded.
    pub temperature_degc: Option<f64>,
}

/// One simulated run.
#[derive(Debug, Clone, PartialEq)]
pub struct SimulatedRun {
    /// Dwells in order; upright ones first, when taken.
    pub positions: Vec<SimulatedPosition>,
    /// Bias of this power-up, m/s².
    pub bias_m_s2: f64,
}

impl Truth {
    /// What the converter makes of an analogue value: rounded, and held at its ends.
    #[must_use]
    pub fn code(&self, analogue_lsb: f64) -> Option<Code> {
        let code =
            self.quantizer.code(analogue_lsb.clamp(f64::from(i32::MIN), f64::from(i32::MAX)))?;
        let code = self.ends.min_code.map_or(code, |m| code.max(m));
        Some(self.ends.max_code.map_or(code, |m| code.min(m)))
    }

    /// True angle of the sensitive axis (rad) for a dial angle, before its random part.
    fn true_angle_rad(&self, dial_rad: f64) -> f64 {
        dial_rad * (1.0 + self.dial_scale)
            + self.dial_zero.rad()
            + self.eccentricity.rad() * (dial_rad + self.eccentricity_phase.rad()).sin()
            + self.misalignment.rad()
    }

    /// Acceleration along the axis, m/s², of a dwell on the table: its axis tilts by `η`, the sensor leans by `ψ`.
    fn on_table_m_s2(&self, true_angle_rad: f64) -> f64 {
        let (eta, psi) = (self.axis_tilt.rad(), self.sensor_lean.rad());
        self.gravity_m_s2 * (psi.cos() * eta.cos() * true_angle_rad.sin() + psi.sin() * eta.sin())
    }

    /// Noiseless analogue value, LSB, for an acceleration along the axis and a bias.
    fn analogue_lsb(&self, a: f64, bias_m_s2: f64, kelvin: f64) -> f64 {
        let nonlinear = a
            + self.k2_per_m_s2 * a * a
            + self.k3_per_m2_s4 * a * a * a
            + 0.5 * self.scale_sign * a.abs()
            + self.scale_per_k * kelvin * a;
        (nonlinear + bias_m_s2) / self.actual_scale_m_s2_per_lsb()
    }
}

/// Random numbers of one run: runs have streams of their own, so each can be made alone.
///
/// Seed and run are mixed first: neighbouring states of a congruential generator give related streams.
fn stream(truth: &Truth, run: u32) -> Pcg64 {
    let mut state = truth.seed ^ u64::from(run).wrapping_mul(0xd1b5_4a32_d192_ed03);
    let mut mixed =
        || -> u128 { u128::from(split_mix(&mut state)) << 64 | u128::from(split_mix(&mut state)) };
    Pcg64::new(mixed(), mixed())
}

/// SplitMix64 (Steele, Lea, Flood 2014).
fn split_mix(state: &mut u64) -> u64 {
    *state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let mut z = *state;
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

/// Bias of one power-up (counted from zero), m/s².
#[must_use]
pub fn run_bias_m_s2(truth: &Truth, run: u32) -> f64 {
    let turn_on: f64 = StandardNormal.sample(&mut stream(truth, run));
    truth.bias_m_s2 + truth.turn_on_m_s2 * turn_on
}

/// Simulates one run (counted from zero).
#[must_use]
pub fn simulate_run(truth: &Truth, run: u32) -> SimulatedRun {
    let mut rng = stream(truth, run);
    let mut normal = || -> f64 { StandardNormal.sample(&mut rng) };
    let bias_m_s2 = truth.bias_m_s2 + truth.turn_on_m_s2 * normal();
    let mut dials: Vec<(f64, bool)> = // ±90° is stood upright, off the table, as `Bench::seat` takes it.
        truth.angles_deg.iter().map(|a| (*a, a.abs() == 90.0)).collect();
    if truth.upright_in_each_run {
        dials.splice(0..0, [(90.0, true), (-90.0, true)]);
    }
    let samples = truth.samples_per_dwell();
    let per_sample_walk = truth.random_walk_m_s2_rts / truth.rate_hz.sqrt();
    let k = truth.actual_scale_m_s2_per_lsb();
    let middle = truth.temperature_degc.map_or(0.0, |(a, b)| 0.5 * (a + b));
    let steps = dials.len().saturating_sub(1).max(1) as f64;
    let mut walk = 0.0;
    let mut positions = Vec::with_capacity(dials.len());
    for (i, (angle_deg, upright)) in dials.iter().enumerate() {
        let dial = angle_deg.to_radians();
        let acceleration = if *upright {
            // A lean to either side costs the same: the cosine is even.
            truth.gravity_m_s2 * (dial + truth.vertical_lean.rad() * normal()).sin()
        } else {
            truth.on_table_m_s2(truth.true_angle_rad(dial) + truth.setting_scatter.rad() * normal())
        };
        let temperature_degc =
            truth.temperature_degc.map(|(from, to)| from + (to - from) * i as f64 / steps);
        let kelvin = temperature_degc.map_or(0.0, |t| t - middle);
        let bias = bias_m_s2 + truth.bias_per_k_m_s2 * kelvin;
        let level = truth.analogue_lsb(acceleration, bias, kelvin);
        let analogue_lsb = (0..samples)
            .map(|_| {
                if per_sample_walk > 0.0 {
                    walk += per_sample_walk * normal();
                }
                level + (walk + truth.noise_m_s2 * normal()) / k
            })
            .collect();
        positions.push(SimulatedPosition { angle_deg: *angle_deg, analogue_lsb, temperature_degc });
    }
    SimulatedRun { positions, bias_m_s2 }
}

/// Simulates a pair of dwells with the axis up and down, in a power-up of their own.
#[must_use]
pub fn simulate_vertical(truth: &Truth) -> SimulatedRun {
    let alone = Truth { angles_deg: Vec::new(), upright_in_each_run: true, ..truth.clone() };
    simulate_run(&alone, u32::MAX - 1)
}

/// Simulates an experiment without going through files, for statistics.
#[must_use]
pub fn experiment(truth: &Truth) -> Experiment {
    let bench = Bench {
        gravity: Gravity {
            value_m_s2: truth.gravity_m_s2,
            standard_uncertainty_m_s2: 0.0,
            source: GravitySource::Stated,
        },
        angle_uncertainty: Some(truth.setting_scatter).filter(|s| s.rad() > 0.0),
        range: None,
        vertical_lean: truth.vertical_lean,
        systematics: crate::systematic::Systematics::NONE,
    };
    let runs = (0..truth.runs)
        .map(|r| Run {
            name: format!("run-{}", r + 1),
            mounting: "A".into(),
            orientation: Orientation::Normal,
            positions: simulate_run(truth, r)
                .positions
                .iter()
                .map(|p| position(truth, &bench, p))
                .collect(),
            date: None,
        })
        .collect();
    Experiment {
        sensor: Sensor {
            model: "simulated".into(),
            serial: "0".into(),
            axis: "X".into(),
            kind: None,
        },
        output: Output {
            quantizer: truth.quantizer,
            unit: "LSB".into(),
            nominal_scale_m_s2_per_lsb: Some(truth.nominal_scale_m_s2_per_lsb),
            rate_hz: Some(truth.rate_hz),
            ends: truth.ends,
        },
        bench,
        vertical: None,
        runs,
        targets: Targets::default(),
        specification: crate::decision::Specification::default(),
    }
}

/// What the converter records of a dwell.
#[must_use]
pub fn readings(truth: &Truth, p: &SimulatedPosition) -> Readings {
    let mut blocks = BlockSums::default();
    if truth.quantizer == Quantizer::None {
        let mut moments = ValueMoments::default();
        for steps in p.analogue_lsb.iter().filter_map(|x| ValueMoments::steps(*x).ok()) {
            moments.record(steps);
            blocks.record(steps);
        }
        Readings::Values { moments, blocks }
    } else {
        let mut histogram = CodeHistogram::default();
        for code in p.analogue_lsb.iter().filter_map(|x| truth.code(*x)) {
            histogram.record(code);
            blocks.record(i128::from(code.0));
        }
        Readings::Codes { histogram, blocks }
    }
}

fn position(truth: &Truth, bench: &Bench, p: &SimulatedPosition) -> Position {
    let angle = crate::Angle::from_deg(p.angle_deg);
    Position {
        angle,
        seat: bench.seat(angle),
        readings: readings(truth, p),
        temperature_degc: p.temperature_degc,
        place: format!("{}°", p.angle_deg),
        record: Record {
            rows: p.analogue_lsb.len() as u64,
            dial: Some(Dial {
                typed: p.angle_deg.to_string(),
                value: p.angle_deg,
                unit_deg: 1.0,
                direction: 1.0,
            }),
            ..Record::default()
        },
    }
}

#[cfg(test)]
mod tests {
    use super::super::Preset;
    use super::*;

    #[test]
    fn the_same_seed_gives_the_same_codes_and_another_seed_others() {
        let truth = Truth { dwell_s: 0.2, ..Preset::Paper3.truth() };
        assert_eq!(experiment(&truth), experiment(&truth));
        let other = Truth { seed: 2, ..truth.clone() };
        assert_ne!(experiment(&truth), experiment(&other));
        // Runs have streams of their own.
        let runs: Vec<_> = (0..20).map(|r| simulate_run(&truth, r).positions).collect();
        for (i, a) in runs.iter().enumerate() {
            assert!(runs[..i].iter().all(|b| a != b), "run {i} repeats another");
        }
    }

    /// Method section 10: 1° of tilt and of lean takes 305 ppm off the scale and adds 3.0 mm/s², upright dwells apart.
    #[test]
    fn tilt_and_lean_act_on_the_table_alone() {
        let level = Truth {
            angles_deg: vec![60.0, 0.0, 90.0],
            dwell_s: 0.02,
            runs: 1,
            noise_m_s2: 0.0,
            setting_scatter: crate::Angle::from_rad(0.0),
            ..Preset::Paper1.truth()
        };
        let degree = crate::Angle::from_deg(1.0);
        let tilted = Truth { axis_tilt: degree, sensor_lean: degree, ..level.clone() };
        let samples = |t: &Truth| simulate_run(t, 0).positions;
        let k = level.actual_scale_m_s2_per_lsb();
        let gains: Vec<f64> = samples(&tilted)
            .iter()
            .zip(samples(&level))
            .map(|(t, l)| (t.analogue_lsb[0] - l.analogue_lsb[0]) * k)
            .collect();
        assert!((gains[1] - 2.988e-3).abs() < 1e-6, "{gains:?}");
        let scale = (gains[0] - gains[1]) / (9.81 * 60f64.to_radians().sin());
        assert!((scale + 3.046e-4).abs() < 1e-7, "{gains:?}");
        assert_eq!(gains[2], 0.0);
    }

    #[test]
    fn the_converter_holds_at_its_ends() {
        let mut truth = Preset::Paper1.truth();
        truth.ends.max_code = Some(Code(100));
        assert_eq!(truth.code(1e9), Some(Code(100)));
        assert_eq!(truth.code(-3.7), Some(Code(-3)));
    }
}
