//! From a judged experiment to its passport: names and shapes, no arithmetic.

use tumble_core::assess::{Assessment, Drawn, Interval, PooledParameter, RunAssessment};
use tumble_core::estimate::{
    Estimate as RunFit, EstimateOptions, Method, Parameter, Ranged, Split, Weights,
};
use tumble_core::linalg::Matrix;
use tumble_core::systematic::{Input, Inputs};
use tumble_core::term::TermTest;
use tumble_core::{
    ARCMIN_RAD, Experiment, GravitySource, NominalScaleSource, Quantizer, QuantizerOffset,
};

use super::outliers;
use super::terms::{compensation_terms, run_terms, square, terms, terms_option};
use super::types as wire;
use crate::folder::ExperimentFolder;

/// Builds the passport. `id` and `issued` come from the caller (flags), else from the folder; never from a clock.
#[must_use]
pub fn build(
    folder: &ExperimentFolder,
    assessment: &Assessment,
    options: &EstimateOptions,
    id: Option<&str>,
    issued: Option<&str>,
) -> wire::Passport {
    let experiment = &folder.experiment;
    let findings: Vec<wire::Finding> = assessment.findings.iter().map(finding).collect();
    let of = |severity: &str| -> Vec<String> {
        findings.iter().filter(|f| f.severity == severity).map(sentence).collect()
    };
    wire::Passport {
        schema: super::SCHEMA.into(),
        id: id.or(folder.id.as_deref()).unwrap_or_default().into(),
        issued: issued.or(folder.issued.as_deref()).map(str::to_owned),
        verdict: assessment.verdict.name().into(),
        reasons: of("reject"),
        missing: of("missing"),
        conformity: super::conformity::conformity(
            &assessment.conformity,
            experiment.specification.name.as_deref(),
            options.level,
        ),
        sensor: wire::Sensor {
            model: experiment.sensor.model.clone(),
            serial: experiment.sensor.serial.clone(),
            axis: experiment.sensor.axis.clone(),
            kind: experiment.sensor.kind.as_ref().map(|k| wire::SensorType {
                model: k.model.clone(),
                catalogue: k.catalogue.clone(),
                source: k.source.clone(),
            }),
        },
        output: wire::Output {
            quantizer: quantizer_name(experiment.output.quantizer).into(),
            unit: experiment.output.unit.clone(),
            rate_hz: experiment.output.rate_hz,
            min_code: experiment.output.ends.min_code.map(|c| c.0),
            max_code: experiment.output.ends.max_code.map(|c| c.0),
        },
        bench: bench(experiment, assessment.nominal_scale.value_m_s2_per_lsb),
        method: method_name(options.method).into(),
        nominal_scale_m_s2_per_lsb: assessment.nominal_scale.value_m_s2_per_lsb,
        nominal_scale_source: match assessment.nominal_scale.source {
            NominalScaleSource::Stated => "stated".into(),
            NominalScaleSource::UpDown => "up_down".into(),
        },
        validity: validity(experiment, assessment),
        parameters: Parameter::ALL.iter().map(|p| p.name().to_owned()).collect(),
        result: result(assessment, options.level),
        compensation: compensation(assessment),
        runs: assessment
            .runs
            .iter()
            .enumerate()
            .map(|(i, r)| run(folder, assessment, options, i, r))
            .collect(),
        error_level_lsb: assessment.error_level.as_ref().map(|e| wire::ErrorLevel {
            before: e.before_lsb,
            after: e.after_lsb,
            after_held_out: e.after_held_out_lsb,
        }),
        structure: assessment.structure.map(|s| wire::Structure {
            quadratic: s.quadratic.map(term),
            cubic: s.cubic.map(term),
        }),
        terms: terms(assessment, options.level),
        influence: wire::Influence {
            temperature: assessment.influence.temperature.as_ref().map(influence),
            signal_level: assessment.influence.signal_level.as_ref().map(influence),
        },
        outliers: assessment.outliers.positions.iter().map(outliers::outlier).collect(),
        left_out_comparison: assessment
            .outliers
            .comparison
            .iter()
            .map(outliers::comparison)
            .collect(),
        budget: assessment.budget.iter().map(budget_line).collect(),
        findings,
        inputs: folder
            .inputs
            .iter()
            .map(|i| wire::Input { file: i.file.clone(), sha256: i.sha256.clone() })
            .collect(),
        options: wire::Options {
            method: method_name(options.method).into(),
            weights: match (options.method, options.weights) {
                (Method::Paper, _) | (_, Weights::Equal) => "equal".into(),
                (Method::Likelihood, Weights::Stated) => "stated".into(),
                (_, Weights::Angle | Weights::Stated) => "angle".into(),
            },
            level: options.level,
            monte_carlo_digits: options.monte_carlo_digits,
            terms: Some(terms_option(options)),
            targets: wire::Targets {
                bias_m_s2: experiment.targets.bias_m_s2,
                misalignment_rad: experiment.targets.misalignment_rad,
                scale_error: experiment.targets.scale_error,
            },
            left_out: outliers::left_out(&folder.left_out),
        },
        software: wire::Software {
            name: "tumble".into(),
            version: env!("CARGO_PKG_VERSION").into(),
            target: format!("{}-{}", std::env::consts::ARCH, std::env::consts::OS),
        },
    }
}

fn method_name(method: Method) -> &'static str {
    match method {
        Method::Paper => "paper",
        Method::Exact => "exact",
        Method::Likelihood => "likelihood",
    }
}

pub(crate) fn quantizer_name(quantizer: Quantizer) -> &'static str {
    match quantizer {
        Quantizer::Truncate => "truncate",
        Quantizer::Floor => "floor",
        Quantizer::Round => "round",
        Quantizer::None => "none",
    }
}

fn finding(f: &tumble_core::Finding) -> wire::Finding {
    wire::Finding {
        id: f.kind.id().into(),
        severity: f.kind.severity().name().into(),
        title: f.kind.title().into(),
        place: f.place.clone(),
        observed: f.observed.clone(),
        limit: f.limit.clone(),
        todo: f.remedy.clone(),
    }
}

fn sentence(f: &wire::Finding) -> String {
    let place = if f.place.is_empty() { String::new() } else { format!(" ({})", f.place) };
    format!("{} {}{place}: {}. What to do: {}.", f.id, f.title, f.observed, f.todo)
}

fn bench(experiment: &Experiment, k0: f64) -> wire::Bench {
    let b = &experiment.bench;
    let inputs = Inputs::of(experiment, k0);
    wire::Bench {
        gravity_m_s2: wire::Gravity {
            value: b.gravity.value_m_s2,
            standard_uncertainty: b.gravity.standard_uncertainty_m_s2,
            source: match b.gravity.source {
                GravitySource::Stated => "stated".into(),
                GravitySource::StatedWithoutUncertainty => "stated without uncertainty".into(),
                GravitySource::Normal { latitude_deg, height_m } => {
                    format!("WGS 84 normal gravity at {latitude_deg}° and {height_m} m")
                }
            },
        },
        angle_uncertainty_arcmin: b.angle_uncertainty.map(tumble_core::Angle::arcmin),
        angle_range_deg: b.range.map(|(lo, hi)| [lo.deg(), hi.deg()]),
        updown_lean_arcmin: b.vertical_lean.arcmin(),
        systematics: inputs.lines.iter().map(systematic).collect(),
        temperature_spread_k: Some(inputs.temperature_spread_k),
    }
}

fn systematic(line: &Input) -> wire::Systematic {
    wire::Systematic {
        quantity: line.quantity.name().into(),
        standard_uncertainty: line.standard_uncertainty,
        unit: line.quantity.unit().into(),
        distribution: line.shape.name().into(),
        source: line.source.clone(),
    }
}

fn validity(experiment: &Experiment, assessment: &Assessment) -> wire::Validity {
    let mut dates: Vec<String> = experiment.runs.iter().filter_map(|r| r.date.clone()).collect();
    dates.sort();
    dates.dedup();
    wire::Validity {
        temperature_degc: assessment.influence.temperature_range_degc.map(|(lo, hi)| [lo, hi]),
        dates,
    }
}

fn pair(interval: Interval) -> [f64; 2] {
    [interval.low, interval.high]
}

fn three(m: &Matrix) -> [[f64; 3]; 3] {
    core::array::from_fn(|i| core::array::from_fn(|j| m[(i, j)]))
}

fn finite(v: f64) -> Option<f64> {
    v.is_finite().then_some(v)
}

fn pooled(p: &PooledParameter, k0: f64, level: f64) -> wire::Estimate {
    wire::Estimate {
        value: p.value,
        unit: p.parameter.unit().into(),
        lsb: (p.parameter == Parameter::Bias).then(|| tumble_core::assess::in_lsb(p.value, k0)),
        standard_uncertainty: Some(p.standard_uncertainty),
        u_statistical: Some(p.u_statistical),
        u_budget: Some(p.u_budget),
        expanded_uncertainty: Some(p.expanded_uncertainty),
        coverage_factor: Some(p.coverage_factor),
        degrees_of_freedom: finite(p.degrees_of_freedom),
        level: Some(level),
        interval: Some(pair(p.interval)),
        prediction_interval: p.prediction_interval.map(pair),
        prediction_true_interval: p.prediction_true_interval.map(pair),
        between_run_sd: p.between_run_sd,
        between_runs: p.between_runs.map(|b| wire::BetweenRuns {
            omega: b.omega,
            omega_mandel_paule: b.omega_mandel_paule,
            omega_interval: b.omega_interval,
            cochran_q: b.cochran_q,
            degrees_of_freedom: b.dof,
            p_value: b.p_value,
            i_squared: b.i_squared,
        }),
        intersection_of_runs: p.intersection.map(pair),
        monte_carlo: None,
    }
}

/// What the draws say of a pooled value.
fn monte_carlo(a: &Assessment, p: &PooledParameter) -> Option<wire::MonteCarlo> {
    let of = |d: &&Drawn| d.parameter == p.parameter && d.mounting == p.mounting;
    let d = a.drawn.iter().find(of)?;
    Some(wire::MonteCarlo {
        draws: d.draws,
        stabilized: d.stabilized,
        value: d.output.value,
        standard_uncertainty: d.output.standard_uncertainty,
        interval: pair(d.output.symmetric),
        shortest_interval: pair(d.output.shortest),
        d_low: d.validation.d_low,
        d_high: d.validation.d_high,
        tolerance: d.validation.tolerance,
        validated: d.validation.holds(),
    })
}

fn result(a: &Assessment, level: f64) -> Option<wire::ResultSection> {
    let compensation = a.compensation.as_ref()?;
    let k0 = a.nominal_scale.value_m_s2_per_lsb;
    let with_draws = |p: &PooledParameter| wire::Estimate {
        monte_carlo: monte_carlo(a, p),
        ..pooled(p, k0, level)
    };
    let all = |parameter| a.pooled.iter().filter(move |p| p.parameter == parameter);
    let bias = all(Parameter::Bias).next()?;
    let scale = all(Parameter::ScaleError).next()?;
    let misalignments: Vec<&PooledParameter> = all(Parameter::Misalignment).collect();
    let of_scale_factor = tumble_core::assess::scale_factor(scale, k0);
    let mut scale_factor = pooled(&of_scale_factor, k0, level);
    scale_factor.unit = "m/s2/LSB".into();
    Some(wire::ResultSection {
        bias: with_draws(bias),
        misalignment: match misalignments[..] {
            [only] => Some(with_draws(only)),
            _ => None,
        },
        mountings: match misalignments[..] {
            [_] => Vec::new(),
            _ => misalignments
                .iter()
                .map(|m| wire::Mounting {
                    name: m.mounting.clone().unwrap_or_default(),
                    misalignment: with_draws(m),
                })
                .collect(),
        },
        table_zero: a.table_zero.as_ref().map(|z| pooled(z, k0, level)),
        shared_pair: a.shared_pair.map(|p| wire::SharedPair {
            scale_error: p.scale_error,
            standard_uncertainty: p.standard_uncertainty,
            lean_correction: p.lean_correction,
        }),
        scale_error: with_draws(scale),
        scale_factor,
        covariance: compensation.parameter_covariance.as_ref().map(three),
    })
}

fn compensation(a: &Assessment) -> Option<wire::Compensation> {
    let c = a.compensation.as_ref()?;
    Some(wire::Compensation {
        scale_factor: c.scale_factor_m_s2_per_lsb,
        bias: c.bias_m_s2,
        quantizer_offset: match c.quantizer_offset {
            QuantizerOffset::HalfSign => "half_sign",
            QuantizerOffset::Half => "half",
            QuantizerOffset::None => "none",
        }
        .into(),
        valid_range_lsb: [c.valid_range_lsb.0, c.valid_range_lsb.1],
        covariance: core::array::from_fn(|i| core::array::from_fn(|j| c.covariance[(i, j)])),
        reading_std_lsb: c.reading_std_lsb,
        terms: c.terms.as_ref().map(compensation_terms),
        example: wire::Example { code: c.example.0, acceleration_m_s2: c.example.1 },
    })
}

fn run(
    folder: &ExperimentFolder,
    a: &Assessment,
    options: &EstimateOptions,
    index: usize,
    r: &RunAssessment,
) -> wire::Run {
    let e = r.estimate.as_ref();
    let k0 = a.nominal_scale.value_m_s2_per_lsb;
    let remark = folder.remarks.get(index).cloned().unwrap_or_default();
    let estimate = |p| e.and_then(|e| run_estimate(e, p, k0, options.level));
    let measured = folder.experiment.runs.get(index);
    wire::Run {
        name: r.name.clone(),
        mounting: r.seating(),
        date: measured.and_then(|m| m.date.clone()),
        operator: remark.operator,
        note: remark.note,
        positions: e.map_or(0, |e| e.positions),
        distinct_angles: e.map_or(0, |e| e.distinct_angles),
        estimates: wire::RunEstimates {
            bias: estimate(Parameter::Bias),
            misalignment: estimate(Parameter::Misalignment),
            scale_error: estimate(Parameter::ScaleError),
        },
        covariance: e.and_then(|e| e.covariance.as_ref()).map(three),
        terms: e.map(run_terms).unwrap_or_default(),
        full_covariance: e.and_then(|e| e.full_covariance.as_ref()).map(square).unwrap_or_default(),
        residual_std_lsb: e.and_then(|e| e.residual_std_lsb),
        reading_std_lsb: r.reading_std_lsb,
        condition_number: e.and_then(|e| finite(e.condition)),
        scatter: e.and_then(|e| e.scatter.as_ref()).map(scatter),
        correlations: e.map(correlations).unwrap_or_default(),
        settled_at: e.and_then(|e| e.stabilization.settled_at),
        sequential: e.map(sequential).unwrap_or_default(),
        residuals: r
            .residuals()
            .iter()
            .map(|x| wire::Residual { angle_deg: x.angle_deg, lsb: x.lsb })
            .collect(),
        error_level_lsb: a
            .error_level
            .as_ref()
            .and_then(|l| l.runs.iter().find(|x| x.name == r.name))
            .map(|x| wire::RunErrorLevel {
                before: x.before_lsb,
                after: x.after_lsb,
                after_held_out: x.after_held_out_lsb,
            }),
    }
}

fn run_estimate(e: &RunFit, parameter: Parameter, k0: f64, level: f64) -> Option<wire::Estimate> {
    let value = e.values[parameter.index()]?;
    let u = e.standard_uncertainty(parameter);
    let interval = e.interval(parameter, level);
    Some(wire::Estimate {
        value,
        unit: parameter.unit().into(),
        lsb: (parameter == Parameter::Bias).then(|| tumble_core::assess::in_lsb(value, k0)),
        standard_uncertainty: u,
        degrees_of_freedom: u.and_then(|_| finite(e.effective_dof[parameter.index()])),
        level: interval.map(|_| level),
        interval,
        ..wire::Estimate::default()
    })
}

fn scatter(s: &tumble_core::estimate::Scatter) -> wire::Scatter {
    let ranged = |r: Ranged, unit: f64| wire::Ranged {
        value: r.value / unit,
        interval: [r.low / unit, r.high / unit],
    };
    wire::Scatter {
        noise_lsb: s.noise_lsb.map(|r| ranged(r, 1.0)),
        noise_is_bound: s.noise_is_bound,
        level_lsb: ranged(s.level_lsb, 1.0),
        angle_arcmin: ranged(s.angle_rad, ARCMIN_RAD),
        total_lsb: ranged(s.total_lsb, 1.0),
        total_arcmin: ranged(s.total_rad, ARCMIN_RAD),
        correlation: s.correlation,
        split: match s.split {
            Split::NotAsked => "not_asked",
            Split::Undetermined => "undetermined",
            Split::Determined { level: true, angle: true } => "both",
            Split::Determined { level: true, .. } => "level",
            Split::Determined { .. } => "angle",
        }
        .into(),
        inflation: s.inflation,
    }
}

fn correlations(e: &RunFit) -> Vec<wire::Correlation> {
    let [b, m, s] = Parameter::ALL;
    [(b, m), (b, s), (m, s)]
        .into_iter()
        .filter_map(|(p, q)| {
            e.correlation(p, q).map(|value| wire::Correlation {
                between: [p.name().into(), q.name().into()],
                value,
            })
        })
        .collect()
}

fn sequential(e: &RunFit) -> Vec<wire::Sequential> {
    e.stabilization
        .sequential
        .iter()
        .map(|s| wire::Sequential {
            positions: s.positions,
            bias: s.values[0],
            misalignment: s.values[1],
            scale_error: s.values[2],
        })
        .collect()
}

fn term(t: TermTest) -> wire::StructureTerm {
    wire::StructureTerm { peak_lsb: t.peak_lsb, p_value: t.p_value }
}

fn influence(t: &tumble_core::assess::InfluenceTest) -> wire::InfluenceTest {
    wire::InfluenceTest {
        effect: t.effect,
        unit: t.unit.into(),
        expanded_uncertainty: t.expanded_uncertainty,
        p_value: t.p_value,
        smallest_detectable: t.smallest_detectable,
    }
}

fn budget_line(b: &tumble_core::assess::BudgetLine) -> wire::BudgetLine {
    wire::BudgetLine {
        parameter: b.parameter.name().into(),
        mounting: b.mounting.clone(),
        quantity: b.quantity.into(),
        source: b.source.clone(),
        standard_uncertainty: b.standard_uncertainty,
        unit: b.unit.into(),
        distribution: b.distribution.into(),
        degrees_of_freedom: finite(b.degrees_of_freedom),
        sensitivity: b.sensitivity,
        contribution: b.contribution,
        share: b.share,
    }
}
