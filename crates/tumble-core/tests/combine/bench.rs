//! Simulated runs through the real estimator, without the judgements of `assess`.

use tumble_core::assess::{PooledParameter, RunAssessment};
use tumble_core::estimate::{EstimateOptions, Parameter, Setting, estimate};
use tumble_core::simulate::{Preset, Truth, experiment};
use tumble_core::{Angle, Experiment, Orientation, Position};

/// The bench of method section 7: 0.2 LSB of scatter a position, in ten samples a dwell.
pub fn quiet_table() -> Truth {
    Truth {
        dwell_s: 0.2,
        noise_m_s2: 0.2 * 0.007_69 * 10f64.sqrt(),
        setting_scatter: Angle::from_rad(0.0),
        misalignment: Angle::from_rad(0.002),
        quantizer: tumble_core::Quantizer::Round,
        ..Preset::Paper3.truth()
    }
}

pub fn setting(e: &Experiment) -> Setting<'_> {
    Setting {
        bench: &e.bench,
        quantizer: e.output.quantizer,
        ends: e.output.ends,
        nominal_scale_m_s2_per_lsb: e.output.nominal_scale_m_s2_per_lsb.unwrap(),
    }
}

/// One run as `assess` would hand it to the pooling.
pub fn run(
    e: &Experiment,
    positions: &[&Position],
    mounting: &str,
    orientation: Orientation,
    options: &EstimateOptions,
) -> RunAssessment {
    RunAssessment {
        effects: None,
        name: mounting.into(),
        mounting: mounting.into(),
        orientation,
        estimate: estimate(positions, &setting(e), options).ok(),
        mean_codes: Vec::new(),
        temperatures_degc: Vec::new(),
        reading_std_lsb: None,
    }
}

/// All runs of a simulated experiment in one mounting.
pub fn runs(
    truth: &Truth,
    orientation: Orientation,
    options: &EstimateOptions,
) -> Vec<RunAssessment> {
    let e = experiment(truth);
    e.runs
        .iter()
        .map(|r| run(&e, &r.positions.iter().collect::<Vec<_>>(), "A", orientation, options))
        .collect()
}

pub fn find(all: &[PooledParameter], parameter: Parameter) -> &PooledParameter {
    all.iter().find(|p| p.parameter == parameter).unwrap()
}

pub fn covers(p: &PooledParameter, truth: f64) -> bool {
    (p.value - truth).abs() <= p.expanded_uncertainty
}

/// Standard error of a fraction.
pub fn fraction_se(p: f64, n: usize) -> f64 {
    (p * (1.0 - p) / n as f64).sqrt()
}
