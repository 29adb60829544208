//! One run: which positions are used, what its data show, its estimate, and what systematic errors do to it.

use super::outliers::{self, Material};
use super::terms::{self, Terms};
use super::{LeftOut, RunAssessment};
use crate::estimate::{
    Estimate, EstimateOptions, Method, Setting, TermSet, Weights, determines_all, estimate,
    estimate_with_terms,
};
use crate::judge;
use crate::systematic::{
    ExtraColumn, Inputs, Quantity, Shape, Sites, SystematicEffect, effects, pattern,
};
use crate::{Experiment, Finding, FindingKind, Orientation, Position, Run, Severity};

/// Runs with the positions of their adjustment: up/down dwells come first in the run that they belong to, and
/// stand as a run of their own where there is no other.
pub(super) fn adjusted_runs(experiment: &Experiment) -> Vec<(Run, Vec<&Position>)> {
    let pair = experiment.vertical.as_ref();
    if experiment.runs.is_empty() {
        return pair
            .map(|p| {
                let run = Run {
                    name: "up/down".into(),
                    mounting: "up/down".into(),
                    orientation: Orientation::Normal,
                    positions: vec![p.up.clone(), p.down.clone()],
                    date: None,
                };
                (run, vec![&p.up, &p.down])
            })
            .into_iter()
            .collect();
    }
    experiment
        .runs
        .iter()
        .map(|run| {
            let own = pair.filter(|p| p.run.as_deref() == Some(run.name.as_str()));
            let positions =
                own.map(|p| [&p.up, &p.down]).into_iter().flatten().chain(&run.positions).collect();
            (run.clone(), positions)
        })
        .collect()
}

/// How runs are estimated: options, and the further terms of this pass.
#[derive(Clone, Copy)]
pub(super) struct With<'a> {
    pub options: &'a EstimateOptions,
    pub inputs: &'a Inputs,
    pub set: TermSet,
    pub reference_degc: Option<f64>,
}

/// Estimates a run, and says what its data and its estimate show.
pub(super) fn assess_run<'a>(
    experiment: &Experiment,
    setting: &Setting<'_>,
    with: With<'_>,
    run: &'a Run,
    (candidates, left_out): (Vec<&'a Position>, &[LeftOut]),
    findings: &mut Vec<Finding>,
) -> (RunAssessment, Material<'a>) {
    let bench = &experiment.bench;
    let options = with.options;
    let k0 = setting.nominal_scale_m_s2_per_lsb;
    // The paper's adjustment uses [scale] for k0 alone.
    let candidates = match options.method {
        Method::Paper if !experiment.runs.is_empty() => run.positions.iter().collect(),
        _ => candidates,
    };
    let Material { used: numbered, left_out: omitted, .. } =
        outliers::split(run, candidates, left_out);
    let candidates: Vec<&Position> = numbered.iter().map(|(_, p)| *p).collect();
    // Bounds refine what the other dwells determine; alone they are no start.
    let whole: Vec<&Position> = candidates
        .iter()
        .copied()
        .filter(|p| p.readings.censored(&experiment.output.ends) == 0)
        .collect();
    let censored = match options.method {
        Method::Likelihood if determines_all(&whole, setting) => judge::Censored::Kept,
        _ => judge::Censored::LeftOut,
    };
    let output = &experiment.output;
    let usable = judge::usable_positions(run, candidates.clone(), output, bench, k0, censored);
    let judge::Hygiene { findings: hygiene, noticed } =
        judge::data_hygiene(&run.name, &candidates, output, bench, &usable.findings);
    let contradicted = hygiene.iter().any(|f| f.kind.severity() == Severity::Reject);
    findings.extend(usable.findings);
    findings.extend(hygiene);
    let positions = usable.positions;
    findings.extend(judge::noise(&run.name, &positions, output, options.method));
    let estimate = adjust(&run.name, &positions, setting, with, findings);
    if let Some(e) = &estimate {
        findings.extend(estimate_findings(experiment, k0, options, &run.name, e, contradicted));
    }
    let variances: Vec<f64> =
        positions.iter().filter_map(|p| p.readings.std()).map(|s| s * s).collect();
    let effects = estimate.as_ref().and_then(|e| run_effects(e, &positions, setting, with));
    let material = Material {
        used: outliers::numbered(&numbered, &positions),
        left_out: omitted,
        noticed: noticed.into_iter().filter_map(|(i, k)| Some((numbered[i].0?, k))).collect(),
    };
    let assessed = RunAssessment {
        effects,
        name: run.name.clone(),
        mounting: run.mounting.clone(),
        orientation: run.orientation,
        estimate,
        mean_codes: positions
            .iter()
            .map(|p| {
                let whole = p.readings.censored(&experiment.output.ends) == 0;
                p.readings.mean().filter(|_| whole)
            })
            .collect(),
        temperatures_degc: positions.iter().map(|p| p.temperature_degc).collect(),
        reading_std_lsb: crate::stats::mean(&variances).map(f64::sqrt),
    };
    (assessed, material)
}

/// Systematic errors on a run's parameters; fitted terms take the place of what they stand for.
fn run_effects(
    estimate: &Estimate,
    positions: &[&Position],
    setting: &Setting<'_>,
    with: With<'_>,
) -> Option<Vec<SystematicEffect>> {
    let sites = Sites::of(estimate, positions, setting, with.inputs.temperature_spread_k)?;
    let fitted = estimate.terms.iter().filter_map(|t| {
        let replaces = terms::replaced(t.term);
        let lsb = pattern(replaces?, &sites)?;
        Some(ExtraColumn { lsb, replaces })
    });
    effects(estimate, positions, setting, with.inputs, &fitted.collect::<Vec<_>>())
}

/// Where all runs together tell K2 or K3 better than the data sheet or a convention does, that is its uncertainty: what was
/// found of it counts in full, for it was not corrected.
pub(super) fn bounded_by_data(run: &mut RunAssessment, terms: &Terms) {
    for effect in run.effects.iter_mut().flatten().filter(|e| e.source != "stated") {
        let of_it = terms.tried.iter().find(|t| terms::replaced(t.term) == Some(effect.quantity));
        let Some(test) = of_it.and_then(|t| t.test) else { continue };
        let shown = test.effect_lsb.hypot(test.standard_uncertainty_lsb);
        if matches!(effect.quantity, Quantity::Quadratic | Quantity::Cubic)
            && shown < effect.standard_uncertainty
        {
            effect.standard_uncertainty = shown;
            effect.shape = Shape::Normal;
            effect.source = format!(
                "these data, which bound it more narrowly than {}",
                effect.source.trim_start_matches("default: ")
            );
        }
    }
}

/// What a run's estimate says. Values from data that are known to be wrong (`contradicted`) are not held against what
/// is possible: their cure is another.
fn estimate_findings(
    experiment: &Experiment,
    nominal_scale: f64,
    options: &EstimateOptions,
    run: &str,
    estimate: &Estimate,
    contradicted: bool,
) -> Vec<Finding> {
    let (bench, output) = (&experiment.bench, &experiment.output);
    let g = bench.gravity.value_m_s2;
    let mut findings = judge::few_angles(run, estimate);
    if !contradicted {
        let scale = (output, nominal_scale);
        findings.extend(judge::plausible(run, estimate, options.method, g, options.level, scale));
    }
    let stated = bench.angle_uncertainty.map(crate::Angle::arcmin);
    findings.extend(judge::table(run, estimate, stated, g / nominal_scale));
    findings.extend(judge::determined_run(run, estimate));
    findings.extend(judge::settled(run, estimate));
    findings.extend(judge::slow_noise(run, estimate));
    findings
}

/// Estimates a run. Where weights and solution find no fixed point, equal weights show what the data hold: the
/// run is rejected all the same, but its residuals can say why.
fn adjust(
    run: &str,
    positions: &[&Position],
    setting: &Setting<'_>,
    with: With<'_>,
    findings: &mut Vec<Finding>,
) -> Option<Estimate> {
    let options = with.options;
    if positions.is_empty() {
        return None;
    }
    let estimated = estimate_with_terms(positions, setting, options, with.set, with.reference_degc);
    let error = match estimated {
        Ok(e) => return Some(e),
        Err(error) => error,
    };
    // Up/down dwells that are exchanged find no fixed point, and that has been said already.
    if findings.iter().any(|f| f.kind == FindingKind::SignReversed && f.place == "[scale]") {
        return None;
    }
    findings.push(Finding {
        kind: FindingKind::NotConverged,
        place: run.to_owned(),
        observed: error.to_string(),
        limit: "a fixed point".into(),
        remedy: "check the run's angles and codes: they do not belong together".into(),
    });
    // Averages at the converter's ends are none.
    let inside: Vec<&Position> =
        positions.iter().copied().filter(|p| p.readings.censored(&setting.ends) == 0).collect();
    let plain = EstimateOptions {
        method: plain_method(options.method),
        weights: Weights::Equal,
        ..*options
    };
    estimate(&inside, setting, &plain).ok()
}

/// The estimator that always has an answer.
fn plain_method(method: Method) -> Method {
    use Method::{Exact, Likelihood, Paper};
    match method {
        Paper => Paper,
        Exact | Likelihood => Exact,
    }
}
