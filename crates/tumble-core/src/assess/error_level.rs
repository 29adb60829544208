//! Error level before and after compensation (the paper's figure 4), in sample and held out.

use super::RunAssessment;
use crate::estimate::{Estimate, Setting, Term};
use crate::stats::{mean, root_mean_square};
use crate::{Finding, FindingKind};

/// Root mean square errors of the positions' means, LSB.
#[derive(Debug, Clone, PartialEq)]
pub struct ErrorLevel {
    /// Before compensation: `N* − g sinφ/k0`.
    pub before_lsb: f64,
    /// After compensation with each run's own coefficients: optimistic.
    pub after_lsb: f64,
    /// After compensation with the mean coefficients of the **other** runs; needs two runs.
    pub after_held_out_lsb: Option<f64>,
    /// The same, run by run, in the order of the runs that count.
    pub runs: Vec<RunErrorLevel>,
}

/// Root mean square errors of one run, LSB.
#[derive(Debug, Clone, PartialEq)]
pub struct RunErrorLevel {
    /// Name of the run.
    pub name: String,
    /// Before compensation.
    pub before_lsb: f64,
    /// After, with its own coefficients.
    pub after_lsb: f64,
    /// After, with the other runs' coefficients.
    pub after_held_out_lsb: Option<f64>,
}

impl ErrorLevel {
    /// Compensation that does not help is worth saying.
    #[must_use]
    pub fn finding(&self) -> Option<Finding> {
        let after = self.after_held_out_lsb.filter(|after| *after > self.before_lsb)?;
        Some(Finding {
            kind: FindingKind::CompensationWorse,
            place: String::new(),
            observed: format!("{after:.2} LSB after, {:.2} LSB before", self.before_lsb),
            limit: "less after than before".into(),
            remedy: "the errors of this unit are smaller than what they repeat to: measure wider angles, or more runs".into(),
        })
    }
}

/// Errors of a run's positions under given coefficients, LSB.
///
/// Upright dwells are left out: they stand on no table angle.
fn errors(
    run: &RunAssessment,
    estimate: &Estimate,
    setting: &Setting<'_>,
    theta: [f64; 3],
    terms: &[(Term, f64)],
) -> Vec<f64> {
    let g = setting.bench.gravity.value_m_s2;
    let reference = estimate.reference_temperature_degc;
    let added = |a: f64, t: Option<f64>| -> f64 {
        let kelvin = t.zip(reference).map_or(0.0, |(t, r)| t - r);
        terms.iter().map(|(term, c)| c * term.basis(a, kelvin)).sum()
    };
    let [bias, misalignment, scale_error] = theta;
    let k = setting.nominal_scale_m_s2_per_lsb * (1.0 + scale_error);
    table_positions(run, estimate, setting)
        .map(|(angle, analogue, t)| {
            let a = g * (angle + misalignment).sin();
            (k * analogue - bias - a - added(a, t)) / k
        })
        .collect()
}

fn table_positions<'a>(
    run: &'a RunAssessment,
    estimate: &'a Estimate,
    setting: &'a Setting<'_>,
) -> impl Iterator<Item = (f64, f64, Option<f64>)> + 'a {
    let upright =
        |deg: f64| setting.bench.seat(crate::Angle::from_deg(deg)).vertical_sign().is_some();
    estimate
        .residuals
        .iter()
        .zip(run.mean_codes.iter().zip(&run.temperatures_degc))
        .filter(move |(r, _)| !upright(r.angle_deg))
        .filter_map(|(r, (mean, t))| {
            Some((r.angle_deg.to_radians(), setting.quantizer.analogue_lsb((*mean)?), *t))
        })
}

/// Error level of an experiment; `None` where no run has all three parameters.
///
/// Held out, a run is compensated with the mean bias and scale of the other runs, and aligned with the mean
/// misalignment of the other runs in its mounting (with its own, where it is alone in its mounting).
///
/// **Source** method section 12.
#[must_use]
pub fn error_level(runs: &[RunAssessment], setting: &Setting<'_>) -> Option<ErrorLevel> {
    let full: Vec<(&RunAssessment, &Estimate, [f64; 3])> = runs
        .iter()
        .filter_map(|r| r.estimate.as_ref().and_then(|e| e.full().map(|t| (r, e, t))))
        .collect();
    let (mut before, mut after, mut held_out) = (Vec::new(), Vec::new(), Vec::new());
    let mut by_run = Vec::new();
    for (i, (run, estimate, theta)) in full.iter().enumerate() {
        let own_before: Vec<f64> = errors(run, estimate, setting, [0.0; 3], &[]);
        let own_terms: Vec<(Term, f64)> =
            estimate.terms.iter().map(|t| (t.term, t.value)).collect();
        let own_after = errors(run, estimate, setting, *theta, &own_terms);
        let others = |index: usize, same_mounting: bool| {
            let values: Vec<f64> = full
                .iter()
                .enumerate()
                .filter(|(j, (r, _, _))| {
                    *j != i && (!same_mounting || r.seating() == run.seating())
                })
                .map(|(_, (_, _, t))| t[index])
                .collect();
            mean(&values)
        };
        let own_held_out = others(0, false).zip(others(2, false)).map(|(bias, scale)| {
            let misalignment = others(1, true).unwrap_or(theta[1]);
            let of_others = |term: Term| {
                let rest = full.iter().enumerate().filter(|(j, _)| *j != i);
                let values: Vec<f64> = rest
                    .filter_map(|(_, (_, e, _))| e.terms.iter().find(|t| t.term == term))
                    .map(|t| t.value)
                    .collect();
                mean(&values).map(|value| (term, value))
            };
            let terms: Vec<(Term, f64)> =
                own_terms.iter().filter_map(|(t, _)| of_others(*t)).collect();
            errors(run, estimate, setting, [bias, misalignment, scale], &terms)
        });
        by_run.extend(
            root_mean_square(own_before.iter().copied())
                .zip(root_mean_square(own_after.iter().copied()))
                .map(|(before_lsb, after_lsb)| RunErrorLevel {
                    name: run.name.clone(),
                    before_lsb,
                    after_lsb,
                    after_held_out_lsb: own_held_out
                        .as_ref()
                        .and_then(|h| root_mean_square(h.iter().copied())),
                }),
        );
        before.extend(own_before);
        after.extend(own_after);
        held_out.extend(own_held_out.into_iter().flatten());
    }
    Some(ErrorLevel {
        before_lsb: root_mean_square(before)?,
        after_lsb: root_mean_square(after)?,
        after_held_out_lsb: root_mean_square(held_out),
        runs: by_run,
    })
}
