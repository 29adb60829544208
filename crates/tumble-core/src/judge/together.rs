//! The runs put together: do they differ beyond their own uncertainties, and what did turning the body tell?

use crate::assess::PooledParameter;
use crate::assess::{PooledRuns, RunAssessment};
use crate::estimate::Parameter;
use crate::{Finding, FindingKind, Orientation};

/// Significance of Cochran's Q.
pub(crate) const DIFFER: f64 = 0.01;

/// Parameters whose runs differ by more than their own uncertainties.
///
/// Worth knowing and nothing wrong: a sensor's bias changes between power-ups, and the result holds that.
#[must_use]
pub fn runs_differ(pooled: &[PooledParameter]) -> Vec<Finding> {
    pooled
        .iter()
        .filter_map(|p| {
            let b = p.between_runs.filter(|b| b.p_value < DIFFER)?;
            let place = match &p.mounting {
                Some(m) => format!("{}, mounting {m}", p.parameter.words()),
                None => p.parameter.words().to_owned(),
            };
            let omega = b.omega.unwrap_or(b.omega_mandel_paule);
            Some(Finding {
                kind: FindingKind::RunsDiffer,
                place,
                observed: format!(
                    "Q = {:.1} with {} degrees of freedom, p = {:.1e}; spread between power-ups {}",
                    b.cochran_q,
                    b.dof,
                    b.p_value,
                    p.parameter.shown(omega)
                ),
                limit: format!("p = {DIFFER}"),
                remedy: "nothing, where the type of sensor is like that: the result and its predictions hold it".into(),
            })
        })
        .collect()
}

/// What runs with the body turned tell apart, or why they do not.
#[must_use]
pub fn reversal(runs: &[RunAssessment], together: &PooledRuns) -> Vec<Finding> {
    let mut findings = Vec::new();
    let arcmin = |rad: f64| rad / crate::ARCMIN_RAD;
    if let Some(zero) = &together.table_zero {
        findings.push(Finding {
            kind: FindingKind::ReversalSeparates,
            place: Parameter::Misalignment.words().into(),
            observed: format!(
                "zero and level of the table {:.2}′ ± {:.2}′",
                arcmin(zero.value),
                arcmin(zero.expanded_uncertainty)
            ),
            limit: "runs in both orientations of a mounting".into(),
            remedy: "nothing: the misalignment is what turns with the body, the table's part stands apart".into(),
        });
    }
    let partner = |r: &RunAssessment| {
        runs.iter().any(|o| {
            o.mounting == r.mounting
                && o.orientation == Orientation::Normal
                && o.estimate.as_ref().is_some_and(|e| e.covariance.is_some())
        })
    };
    let alone: Vec<&str> = runs
        .iter()
        .filter(|r| r.orientation == Orientation::Reversed && !partner(r))
        .map(|r| r.name.as_str())
        .collect();
    if !alone.is_empty() {
        findings.push(Finding {
            kind: FindingKind::ReversalAlone,
            place: alone.join(", "),
            observed: "reversed, and no run in normal orientation has the same mounting".into(),
            limit: "a run in each orientation of one mounting".into(),
            remedy: "if the body stayed on its seat when it was turned, give both runs the same mounting; else measure one more run in the normal orientation".into(),
        });
    }
    findings
}
