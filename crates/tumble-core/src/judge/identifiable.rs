//! Identifiability: does the plan tell the parameters apart, and well enough?
//!
//! Condition number and correlations explain, they do not decide. What decides is the expanded uncertainty
//! against its target.

use crate::assess::{PooledParameter, RunAssessment};
use crate::estimate::{Estimate, Parameter};
use crate::systematic::Quantity;
use crate::{Finding, FindingKind, Targets};

/// Condition number (unit columns) from which the correlation is worth a warning. The best plans of a table
/// that reaches ±60° have 5 to 11; the paper's own has 48.
pub(crate) const CONDITION_WARNING: f64 = 30.0;

/// What the number of angles of a run allows.
#[must_use]
pub fn few_angles(run: &str, estimate: &Estimate) -> Vec<Finding> {
    let absent: Vec<&str> = Parameter::ALL
        .into_iter()
        .filter(|p| estimate.values[p.index()].is_none())
        .map(Parameter::words)
        .collect();
    let parameters = 3;
    let seen = format!(
        "{} positions at {} different angles",
        estimate.positions, estimate.distinct_angles
    );
    let finding = |kind, observed: String, limit: &str, remedy: String| Finding {
        kind,
        place: run.to_owned(),
        observed,
        limit: limit.to_owned(),
        remedy,
    };
    if !absent.is_empty() {
        let given = parameters - absent.len();
        return vec![finding(
            FindingKind::RankDeficient,
            format!("{seen}; not determined: {}", absent.join(", ")),
            "three well separated angles on the table",
            if given > 0 && estimate.values[Parameter::Misalignment.index()].is_none() {
                "add dwells on the table on both sides of 0°, for instance at −30°, 0° and 30°"
                    .into()
            } else {
                "add dwells on the table at three or more well separated angles, for instance −60°, 0° and 60°, each several times".into()
            },
        )];
    }
    if estimate.degrees_of_freedom == 0 {
        return vec![finding(
            FindingKind::NoRedundancy,
            seen,
            "more positions than parameters",
            "measure every angle at least twice, or add angles (the more the better: 12 serve, 60 are good)".into(),
        )];
    }
    if estimate.distinct_angles <= parameters {
        return vec![finding(
            FindingKind::NoLackOfFitTest,
            seen,
            "more different angles than parameters",
            "add one or two spare angles in between: only they can show a wrong model".into(),
        )];
    }
    Vec::new()
}

/// Correlation of a run's parameters, in words.
#[must_use]
pub fn determined_run(run: &str, estimate: &Estimate) -> Vec<Finding> {
    let strongest = pairs()
        .into_iter()
        .filter_map(|(a, b)| estimate.correlation(a, b).map(|r| (a, b, r)))
        .max_by(|x, y| x.2.abs().total_cmp(&y.2.abs()));
    match strongest {
        Some((a, b, r)) if estimate.condition > CONDITION_WARNING => vec![Finding {
            kind: FindingKind::IllConditioned,
            place: run.to_owned(),
            observed: format!(
                "condition number {:.0}, correlation of {} and {} {r:+.4}",
                estimate.condition,
                a.words(),
                b.words()
            ),
            limit: format!("condition number {CONDITION_WARNING:.0}"),
            remedy: separating_positions(a, b).into(),
        }],
        _ => Vec::new(),
    }
}

fn pairs() -> [(Parameter, Parameter); 3] {
    use Parameter::{Bias, Misalignment, ScaleError};
    [(Bias, Misalignment), (Bias, ScaleError), (Misalignment, ScaleError)]
}

/// Which positions would tell two parameters apart.
#[must_use]
pub fn separating_positions(a: Parameter, b: Parameter) -> &'static str {
    match (a, b) {
        (Parameter::Bias, Parameter::Misalignment) => {
            "use the table's whole range (dwells near both ends, not only the middle), or add one dwell with the axis up and one with it down in the same power-up"
        }
        (Parameter::Bias, Parameter::ScaleError) => {
            "measure on both sides of 0°: positive and negative angles in equal number"
        }
        _ => "add angles far from those measured, on the other side of 0°",
    }
}

/// Whether a run alone reaches the targets.
fn run_reaches(estimate: &Estimate, parameter: Parameter, target: f64, level: f64) -> bool {
    let factor = estimate.coverage_factor(parameter, level);
    match (factor, estimate.standard_uncertainty(parameter)) {
        (Some(t), Some(u)) => t * u <= target,
        _ => false,
    }
}

/// Whether the result's expanded uncertainties reach the targets.
///
/// Where every run alone reaches them and only the pooled value does not, runs are what is missing, not positions.
#[must_use]
pub fn determined_result(
    pooled: &[PooledParameter],
    runs: &[RunAssessment],
    targets: &Targets,
    level: f64,
) -> Vec<Finding> {
    let mut findings = Vec::new();
    for p in pooled {
        let target = targets.in_order()[p.parameter.index()];
        // Not-a-number counts as not reached.
        if p.expanded_uncertainty <= target {
            continue;
        }
        let enough_positions = runs
            .iter()
            .filter_map(|r| r.estimate.as_ref())
            .all(|e| run_reaches(e, p.parameter, target, level));
        let place = match &p.mounting {
            Some(m) => format!("{}, mounting {m}", p.parameter.words()),
            None => p.parameter.words().to_owned(),
        };
        let observed = format!(
            "expanded uncertainty {} ({:.0} %, k = {:.2})",
            p.parameter.shown(p.expanded_uncertainty),
            level * 100.0,
            p.coverage_factor
        );
        let limit = format!("target {}", p.parameter.shown(target));
        let by_budget = p.u_budget * p.coverage_factor > target;
        findings.push(if by_budget {
            Finding {
                kind: FindingKind::Undetermined,
                place,
                observed,
                limit,
                remedy: match p.dominant {
                    None | Some(Quantity::Gravity) => {
                        "the uncertainty of gravity alone is larger: give latitude_deg and height_m in [bench] (or a measured \
                         gravity with gravity_uncertainty); or state a wider target in [spec]"
                            .into()
                    }
                    Some(q) => format!(
                        "what the bench is not known by is larger than the target, most of it by: {}; measure or state it in \
                         [bench] (docs/budget.md), or state a wider target in [spec]",
                        q.name()
                    ),
                },
            }
        } else if enough_positions && pooled_runs(runs) > 1 {
            Finding {
                kind: FindingKind::RunsTooFew,
                place,
                observed,
                limit,
                remedy: "measure more runs, each with a power-up of its own: the spread between runs is large or known from too few".into(),
            }
        } else {
            let partner = strongest_partner(runs, p.parameter);
            Finding {
                kind: FindingKind::Undetermined,
                place,
                observed,
                limit,
                remedy: format!("{}; or state a wider target in [spec]", partner_remedy(p.parameter, partner)),
            }
        });
    }
    findings
}

fn pooled_runs(runs: &[RunAssessment]) -> usize {
    runs.iter().filter(|r| r.estimate.as_ref().is_some_and(|e| e.covariance.is_some())).count()
}

/// The parameter that one is hardest to tell from, when the correlation is what makes it uncertain.
fn strongest_partner(runs: &[RunAssessment], parameter: Parameter) -> Option<Parameter> {
    let e = runs.iter().find_map(|r| r.estimate.as_ref())?;
    Parameter::ALL
        .into_iter()
        .filter(|q| *q != parameter)
        .filter_map(|q| e.correlation(parameter, q).map(|r| (q, r.abs())))
        .filter(|(_, r)| *r > 0.9)
        .max_by(|x, y| x.1.total_cmp(&y.1))
        .map(|(q, _)| q)
}

fn partner_remedy(parameter: Parameter, partner: Option<Parameter>) -> &'static str {
    match partner {
        Some(q) if q.index() < parameter.index() => separating_positions(q, parameter),
        Some(q) => separating_positions(parameter, q),
        None => {
            "reduce the scatter of the positions (longer dwells, more careful setting) or add positions"
        }
    }
}
